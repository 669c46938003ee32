// See amber_draws.h. Of draws those to whole images, with what the language has words for: it draws to
// all of the attachments, and knows neither culling, masks of colours nor several viewports.
#include "glass/bug/amber_draws.h"

#include <algorithm>
#include <cstring>

#include "glass/bug/contents.h"
#include "texel/format.h"

namespace vitrine::glass::bug {
namespace {

const char* word(const char* const* words, std::size_t count, int number, const char* what) {
  if (number < 0 || static_cast<std::size_t>(number) >= count) throw Unspeakable{what};
  return words[number];
}
template <std::size_t kCount>
const char* word(const char* const (&words)[kCount], int number, const char* what) {
  return word(words, kCount, number, what);
}

// In Vulkan's order.
constexpr const char* kTopologies[] = {"POINT_LIST",
                                       "LINE_LIST",
                                       "LINE_STRIP",
                                       "TRIANGLE_LIST",
                                       "TRIANGLE_STRIP",
                                       "TRIANGLE_FAN",
                                       "LINE_LIST_WITH_ADJACENCY",
                                       "LINE_STRIP_WITH_ADJACENCY",
                                       "TRIANGLE_LIST_WITH_ADJACENCY",
                                       "TRIANGLE_STRIP_WITH_ADJACENCY",
                                       "PATCH_LIST"};
constexpr const char* kStencils[] = {"keep",
                                     "zero",
                                     "replace",
                                     "increment_and_clamp",
                                     "decrement_and_clamp",
                                     "invert",
                                     "increment_and_wrap",
                                     "decrement_and_wrap"};
constexpr const char* kFactors[] = {"zero",
                                    "one",
                                    "src_color",
                                    "one_minus_src_color",
                                    "dst_color",
                                    "one_minus_dst_color",
                                    "src_alpha",
                                    "one_minus_src_alpha",
                                    "dst_alpha",
                                    "one_minus_dst_alpha",
                                    "constant_color",
                                    "one_minus_constant_color",
                                    "constant_alpha",
                                    "one_minus_constant_alpha",
                                    "src_alpha_saturate",
                                    "src1_color",
                                    "one_minus_src1_color",
                                    "src1_alpha",
                                    "one_minus_src1_alpha"};
// As Amber spells them.
constexpr const char* kBlends[] = {"add", "substract", "reverse_substract", "min", "max"};
// From VK_BLEND_OP_ZERO_EXT on.
constexpr const char* kAdvancedBlends[] = {"zero",
                                           "src",
                                           "dst",
                                           "src_over",
                                           "dst_over",
                                           "src_in",
                                           "dst_in",
                                           "src_out",
                                           "dst_out",
                                           "src_atop",
                                           "dst_atop",
                                           "xor",
                                           "multiply",
                                           "screen",
                                           "overlay",
                                           "darken",
                                           "lighten",
                                           "color_dodge",
                                           "color_burn",
                                           "hard_light",
                                           "soft_light",
                                           "difference",
                                           "exclusion",
                                           "invert",
                                           "invert_rgb",
                                           "linear_dodge",
                                           "linear_burn",
                                           "vivid_light",
                                           "linear_light",
                                           "pin_light",
                                           "hard_mix",
                                           "hsl_hue",
                                           "hsl_saturation",
                                           "hsl_color",
                                           "hsl_luminosity",
                                           "plus",
                                           "plus_clamped",
                                           "plus_clamped_alpha",
                                           "plus_darker",
                                           "minus",
                                           "minus_clamped",
                                           "contrast",
                                           "invert_org",
                                           "red",
                                           "green",
                                           "blue"};
constexpr const char* kPolygons[] = {"fill", "line", "point"};

const char* on(bool enabled) { return enabled ? "on" : "off"; }

void demand(bool can, const char* what) {
  if (!can) throw Unspeakable{what};
}

bool has_stage(const Bug& bug, VkShaderStageFlagBits stage) {
  return std::ranges::any_of(bug.stages, [&](const Stage& s) { return s.stage == stage; });
}

/// One draw, however its arguments were given.
struct Run {
  std::uint32_t count = 0, first = 0;  ///< of vertices or indices
  std::int64_t vertex_offset = 0;      ///< added to indices
  std::uint32_t instances = 0, first_instance = 0;
};

std::uint32_t word_at(const Bytes& bytes, std::uint64_t at) {
  demand(at <= bytes.size() && bytes.size() - at >= 4, "arguments outside of their buffer");
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// As VkDrawIndirectCommand and VkDrawIndexedIndirectCommand lie in memory.
std::vector<Run> runs_in_buffer(const Bug& bug) {
  const Command& c = bug.command;
  std::uint32_t count = c.draw_count;
  if (c.count_buffer != kNone)
    count = std::min(count, word_at(contents_of(bug, bug.buffers[c.count_buffer], false), c.count_offset));
  const Bytes bytes = contents_of(bug, bug.buffers[c.arguments], false);
  std::vector<Run> runs;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t at = c.arguments_offset + std::uint64_t{i} * c.stride;
    const auto argument = [&](std::uint32_t n) { return word_at(bytes, at + std::uint64_t{n} * 4); };
    Run run{argument(0), argument(2), 0, argument(1), argument(c.indexed ? 4 : 3)};
    if (c.indexed) run.vertex_offset = static_cast<std::int32_t>(argument(3));
    runs.push_back(run);
  }
  return runs;
}

/// Whether some shader may ask which of several draws runs (Capability DrawParameters).
bool counts_draws(const Bug& bug) {
  constexpr std::uint32_t kOpCapability = 17, kDrawParameters = 4427;
  return std::ranges::any_of(bug.stages, [](const Stage& stage) {
    for (std::size_t at = 20; at + 8 <= stage.words->size(); at += 8) {
      if (word_at(*stage.words, at) != (2u << 16 | kOpCapability)) return false;  // capabilities come first
      if (word_at(*stage.words, at + 4) == kDrawParameters) return true;
    }
    return false;
  });
}

/// Those of which something is left, one at least.
std::vector<Run> runs_of(const Bug& bug) {
  std::vector<Run> runs;
  if (bug.command.arguments != kNone)
    runs = runs_in_buffer(bug);
  else
    for (const Draw& draw : bug.command.draws)
      runs.push_back({draw.count, draw.first, draw.vertex_offset, bug.command.instances, bug.command.first_instance});
  demand(runs.size() <= 1 || !counts_draws(bug), "several draws whose shaders ask which one it is");
  std::erase_if(runs, [](const Run& run) { return run.count == 0 || run.instances == 0; });
  demand(!runs.empty(), "draws of nothing");
  demand(runs.size() <= 64, "so many draws");
  for (const Run& run : runs) demand(run.vertex_offset >= 0, "draws with a negative vertex offset");
  return runs;
}

/// What runs of indices are called.
std::string indices_name(std::size_t run) { return "indices" + (run == 0 ? "" : std::to_string(run)); }

/// The size of all attachments.
VkExtent2D size_of_attachments(const Bug& bug) {
  VkExtent2D size{0, 0};
  const Rendering& r = bug.rendering;
  const auto look = [&](std::uint32_t number) {
    if (number == kNone) return;
    const View& view = bug.views[number];
    const Image& image = bug.images[view.image];
    demand_plain(view, image);
    const texel::Extent extent = extent_shown(image);
    demand(size.width == 0 || (size.width == extent.width && size.height == extent.height),
           "attachments of different sizes");
    size = {extent.width, extent.height};
  };
  for (const std::uint32_t color : r.colors) {
    demand(color != kNone, "attachments that are not used");
    look(color);
  }
  look(r.depth);
  look(r.stencil);
  // Without attachments it is Amber's own, of the render area.
  if (size.width == 0) size = {r.area.offset.x + r.area.extent.width, r.area.offset.y + r.area.extent.height};
  return size;
}

bool draws_lines(const Bug& bug) {
  const VkPrimitiveTopology topology = bug.state.topology;
  // What other stages make of primitives is not looked at.
  return bug.stages.size() > 2 || bug.state.polygon_mode == VK_POLYGON_MODE_LINE ||
         (topology >= VK_PRIMITIVE_TOPOLOGY_LINE_LIST && topology <= VK_PRIMITIVE_TOPOLOGY_LINE_STRIP) ||
         (topology >= VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY &&
          topology <= VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY);
}

void demand_plain_rasterization(const Bug& bug) {
  const raster::State& s = bug.state;
  demand(!s.rasterizer_discard, "draws that are not rasterized");
  demand(s.cull_mode == VK_CULL_MODE_NONE && s.front_face == VK_FRONT_FACE_COUNTER_CLOCKWISE,
         "culling, or front faces that are clockwise");
  const bool plain_lines =
      s.line_width == 1 && !s.line_stipple && s.line_mode == VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;
  demand(plain_lines || !draws_lines(bug), "lines that are wide, stippled or of another kind");
  demand(!(s.primitive_restart && bug.command.indexed) && !s.provoking_vertex_last &&
             !(s.domain_origin_lower_left && s.topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST),
         "primitive restart, last provoking vertices or lower left domain origins");
  demand(s.depth_clip != s.depth_clamp && !s.negative_one_to_one && !s.unrestricted_depth,
         "depth that is clipped or ranges otherwise");
  demand(s.fragment_size.width * s.fragment_size.height == 1 && bug.rendering.rate == kNone &&
             s.rate_combiners[0] == VK_FRAGMENT_SHADING_RATE_COMBINER_OP_KEEP_KHR,
         "fragment shading rates");
  demand(s.discard_count == 0 && s.rasterized_stream == 0 && !s.overestimates,
         "discard rectangles, streams that are rasterized or conservative rasterization");
  demand(s.samples == 1 && !s.sample_shading && (s.sample_mask & 1) && !s.alpha_to_coverage && !s.alpha_to_one &&
             !s.custom_locations,
         "samples");
}

void demand_plain_colors(const Bug& bug) {
  const raster::State& s = bug.state;
  demand(!s.logic_op_enable, "logical operations");
  demand(s.blend_constants == decltype(s.blend_constants){}, "blend constants");
  for (std::size_t i = 0; i < bug.rendering.colors.size(); ++i) {
    const raster::BlendAttachment &a = s.blend[i], &first = s.blend[0];
    demand(a.write_mask == 0xf, "masks of colours");
    demand(a.enable == first.enable, "attachments that blend differently");
    if (!a.enable) continue;
    demand(
        !a.advances() || (a.src_premultiplied && a.dst_premultiplied && a.overlap == VK_BLEND_OVERLAP_UNCORRELATED_EXT),
        "advanced blending of colours that are not premultiplied, or overlap");
    demand(a.src_color == first.src_color && a.dst_color == first.dst_color && a.color_op == first.color_op &&
               a.src_alpha == first.src_alpha && a.dst_alpha == first.dst_alpha && a.alpha_op == first.alpha_op,
           "attachments that blend differently");
  }
}

void demand_whole_area(const Bug& bug, VkExtent2D size) {
  const Rendering& r = bug.rendering;
  const VkRect2D& scissor = bug.state.scissor[0];
  const auto covers = [&](const VkRect2D& rect) {
    return rect.offset.x <= 0 && rect.offset.y <= 0 && std::int64_t{rect.offset.x} + rect.extent.width >= size.width &&
           std::int64_t{rect.offset.y} + rect.extent.height >= size.height;
  };
  demand(bug.state.viewport_count <= 1, "several viewports");
  demand(covers(scissor) && covers(r.area), "scissors and render areas that leave something out");
  demand(r.layers == 1 && r.view_mask == 0, "several layers or views");
}

void write_attachments(std::ostream& out, const Bug& bug, VkExtent2D size) {
  out << "  FRAMEBUFFER_SIZE " << size.width << " " << size.height << "\n";
  for (std::size_t i = 0; i < bug.rendering.colors.size(); ++i)
    out << "  BIND BUFFER image" << bug.views[bug.rendering.colors[i]].image << " AS color LOCATION " << i << "\n";
  const std::uint32_t depth = bug.rendering.depth;
  demand(bug.rendering.stencil == kNone, "stencil attachments");
  if (depth != kNone) out << "  BIND BUFFER image" << bug.views[depth].image << " AS depth_stencil\n";
}

void write_vertices(std::ostream& out, const Bug& bug, std::size_t run) {
  for (std::uint32_t i = 0; i < bug.state.attribute_count; ++i) {
    const raster::VertexAttribute& a = bug.state.attribute[i];
    const auto stream = std::ranges::find(bug.streams, a.binding, &Stream::binding);
    demand(stream != bug.streams.end() && stream->buffer != kNone, "vertices from no buffer");
    demand(stream->divisor == 1, "divisors of instances");
    out << "  VERTEX_DATA buffer" << stream->buffer << " LOCATION " << a.location
        << (stream->per_instance ? " RATE instance" : "") << " FORMAT " << texel::format_desc(a.format).name
        << " OFFSET " << stream->offset + a.offset << " STRIDE " << stream->stride << "\n";
  }
  if (bug.state.attribute_count == 0) out << "  VERTEX_DATA unread LOCATION 0\n";
  if (bug.command.indexed) out << "  INDEX_DATA " << indices_name(run) << "\n";
}

void write_stencil(std::ostream& out, const Bug& bug) {
  // Without an attachment there is nothing to test.
  if (!bug.state.stencil_test || bug.rendering.stencil == kNone) return;
  for (const bool back : {false, true}) {
    const raster::StencilFace& f = back ? bug.state.back : bug.state.front;
    const char* const what = "such a stencil test";
    out << "  STENCIL " << (back ? "back" : "front") << "\n    TEST on\n    FAIL_OP " << word(kStencils, f.fail, what)
        << "\n    PASS_OP " << word(kStencils, f.pass, what) << "\n    DEPTH_FAIL_OP "
        << word(kStencils, f.depth_fail, what) << "\n    COMPARE_OP " << compare_name(f.compare, what)
        << "\n    COMPARE_MASK " << f.compare_mask << "\n    WRITE_MASK " << f.write_mask << "\n    REFERENCE "
        << f.reference << "\n  END\n";
  }
}

void write_depth(std::ostream& out, const Bug& bug) {
  const raster::State& s = bug.state;
  const bool tests = bug.rendering.depth != kNone;
  out << "  DEPTH\n    TEST " << on(tests && s.depth_test) << "\n    WRITE " << on(tests && s.depth_write)
      << "\n    COMPARE_OP " << compare_name(s.depth_compare, "such a depth test") << "\n    CLAMP "
      << on(s.depth_clamp) << "\n";
  if (tests && s.depth_bounds_test)
    out << "    BOUNDS min " << std::to_string(s.min_depth_bounds) << " max " << std::to_string(s.max_depth_bounds)
        << "\n";
  if (s.depth_bias)
    out << "    BIAS constant " << std::to_string(s.depth_bias_constant) << " clamp "
        << std::to_string(s.depth_bias_clamp) << " slope " << std::to_string(s.depth_bias_slope) << "\n";
  out << "  END\n";
}

const char* blend_name(const raster::BlendAttachment& b, VkBlendOp op) {
  const char* const what = "such blending";
  return b.advances() ? word(kAdvancedBlends, op - VK_BLEND_OP_ZERO_EXT, what) : word(kBlends, op, what);
}

bool blends_in_advanced_ways(const Bug& bug) {
  const raster::BlendAttachment& b = bug.state.blend[0];
  return !bug.rendering.colors.empty() && b.enable && b.advances();
}

void write_blend(std::ostream& out, const Bug& bug) {
  const raster::BlendAttachment& b = bug.state.blend[0];
  if (bug.rendering.colors.empty() || !b.enable) return;
  const char* const what = "such blending";
  out << "  BLEND\n    SRC_COLOR_FACTOR " << word(kFactors, b.src_color, what) << "\n    DST_COLOR_FACTOR "
      << word(kFactors, b.dst_color, what) << "\n    COLOR_OP " << blend_name(b, b.color_op)
      << "\n    SRC_ALPHA_FACTOR " << word(kFactors, b.src_alpha, what) << "\n    DST_ALPHA_FACTOR "
      << word(kFactors, b.dst_alpha, what) << "\n    ALPHA_OP " << blend_name(b, b.alpha_op) << "\n  END\n";
}

std::string number_of(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
  return std::string(text).find_first_of(".en") == std::string::npos ? std::string(text) + ".0" : text;
}

}  // namespace

void write_features_of_draw(std::ostream& out, const Bug& bug) {
  const raster::State& s = bug.state;
  if (has_stage(bug, VK_SHADER_STAGE_GEOMETRY_BIT)) out << "DEVICE_FEATURE geometryShader\n";
  if (has_stage(bug, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT)) out << "DEVICE_FEATURE tessellationShader\n";
  if (s.polygon_mode != VK_POLYGON_MODE_FILL) out << "DEVICE_FEATURE fillModeNonSolid\n";
  if (s.depth_clamp) out << "DEVICE_FEATURE depthClamp\n";
  if (blends_in_advanced_ways(bug)) out << "DEVICE_EXTENSION VK_EXT_blend_operation_advanced\n";
  if (s.depth_bounds_test && bug.rendering.depth != kNone) out << "DEVICE_FEATURE depthBounds\n";
  const bool stores = std::ranges::any_of(bug.sets, [](const SetLayout& set) {
    return std::ranges::any_of(set.bindings, [](const Binding& b) {
      return b.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || b.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC ||
             b.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    });
  });
  if (stores) out << "DEVICE_FEATURE vertexPipelineStoresAndAtomics\nDEVICE_FEATURE fragmentStoresAndAtomics\n";
}

std::string pipeline_name(std::size_t run) { return "pipeline" + (run == 0 ? "" : std::to_string(run)); }

std::size_t pipelines_of_draw(const Bug& bug) { return bug.command.indexed ? runs_of(bug).size() : 1; }

void write_buffers_of_draw(std::ostream& out, const Bug& bug) {
  const std::vector<Run> runs = runs_of(bug);
  std::uint64_t most = 1;
  for (const Run& run : runs) most = std::max<std::uint64_t>(most, std::uint64_t{run.first} + run.count);
  demand(most <= 1u << 24, "draws of so many vertices");
  if (bug.state.attribute_count == 0) out << "BUFFER unread DATA_TYPE uint32 STD430 SIZE " << most << " FILL 0\n";
  if (!bug.command.indexed) return;
  const Stream& indices = bug.command.indices;
  demand(indices.buffer != kNone, "indices from no buffer");
  const std::size_t step = bug.command.index_type == VK_INDEX_TYPE_UINT32   ? 4
                           : bug.command.index_type == VK_INDEX_TYPE_UINT16 ? 2
                                                                            : 1;
  const Bytes all = contents_of(bug, bug.buffers[indices.buffer], false);
  demand(indices.size / step >= most, "indices outside of their buffer");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    // START_IDX is what is added to indices, which begin with the first one; Amber counts it to them all the same.
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(indices.offset + std::uint64_t{runs[i].first} * step);
    demand(runs[i].vertex_offset <= 1 << 24, "draws of so many vertices");
    Bytes own(first, first + static_cast<std::ptrdiff_t>(runs[i].count * step));
    own.resize(own.size() + static_cast<std::size_t>(runs[i].vertex_offset) * step);
    write_numbers(out, indices_name(i), own, step);
  }
}

void write_state_of_draw(std::ostream& out, const Bug& bug, std::size_t run) {
  const raster::State& s = bug.state;
  const VkExtent2D size = size_of_attachments(bug);
  demand(bug.feedback.empty(), "transform feedback");
  demand_plain_rasterization(bug);
  demand_plain_colors(bug);
  demand_whole_area(bug, size);
  write_attachments(out, bug, size);
  write_vertices(out, bug, run);
  const VkViewport& v = s.viewport[0];
  out << "  VIEWPORT " << number_of(v.x) << " " << number_of(v.y) << " SIZE " << number_of(v.width) << " "
      << number_of(v.height) << " MIN_DEPTH " << number_of(v.minDepth) << " MAX_DEPTH " << number_of(v.maxDepth)
      << "\n  POLYGON_MODE " << word(kPolygons, s.polygon_mode, "such polygons") << "\n";
  if (s.topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST)
    out << "  PATCH_CONTROL_POINTS " << s.patch_control_points << "\n";
  write_depth(out, bug);
  write_stencil(out, bug);
  write_blend(out, bug);
}

void write_draws(std::ostream& out, const Bug& bug) {
  const std::vector<Run> runs = runs_of(bug);
  const bool indexed = bug.command.indexed;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    out << "RUN " << pipeline_name(indexed ? i : 0) << " DRAW_ARRAY AS "
        << word(kTopologies, bug.state.topology, "such primitives") << (indexed ? " INDEXED" : "") << " START_IDX "
        << (indexed ? static_cast<std::uint64_t>(run.vertex_offset) : run.first) << " COUNT " << run.count
        << " START_INSTANCE " << run.first_instance << " INSTANCE_COUNT " << run.instances << "\n";
  }
  out << "\n";
}

}  // namespace vitrine::glass::bug
