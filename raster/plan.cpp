// Derives a draw's plan from its state and shader interfaces.
#include "raster/plan.h"

#include <algorithm>
#include <cmath>

#include "raster/front/feedback.h"
#include "raster/tile/hierarchical_depth.h"
#include "spirv/stage_memory.h"
#include "texel/format.h"

namespace vitrine::raster {
namespace {

/// Vertices that a patch is expected to become, and primitives of a chunk at least.
constexpr std::uint32_t kTessellationGrowth = 256, kMinPrimitives = 64;

using spirv::BuiltIn;
using spirv::InterfaceSlot;
using spirv::Interpolation;
using spirv::ShaderInterface;

const ShaderInterface* interface_of(const spirv::Shader* shader, const NativeShader* native) {
  if (native) return &native->interface;
  return shader ? &shader->interface() : nullptr;
}

VertexInput::Source source_of(BuiltIn built_in) {
  switch (built_in) {
    case BuiltIn::kVertexIndex:
      return VertexInput::Source::kVertexIndex;
    case BuiltIn::kInstanceIndex:
      return VertexInput::Source::kInstanceIndex;
    case BuiltIn::kBaseVertex:
      return VertexInput::Source::kBaseVertex;
    case BuiltIn::kBaseInstance:
      return VertexInput::Source::kBaseInstance;
    case BuiltIn::kDrawIndex:
      return VertexInput::Source::kDrawIndex;
    case BuiltIn::kViewIndex:
      return VertexInput::Source::kViewIndex;
    default:
      return VertexInput::Source::kZero;
  }
}

void plan_vertex_inputs(PipelinePlan& plan) {
  const State& state = *plan.state;
  for (const InterfaceSlot& slot : plan.vertex->inputs) {
    if (plan.vertex_input_count == plan.vertex_input.size()) break;
    VertexInput& input = plan.vertex_input[plan.vertex_input_count++];
    input = {};
    input.reg = slot.reg;
    input.component = slot.component;
    if (slot.built_in != BuiltIn::kNone) {
      input.source = source_of(slot.built_in);
      continue;
    }
    for (std::uint32_t i = 0; i < state.attribute_count; ++i) {
      const std::uint32_t first = state.attribute[i].location;
      // Three or four 64-bit components take two locations.
      const bool second = slot.location == first + 1 && texel::format_desc(state.attribute[i].format).block_bytes > 16;
      if (slot.location != first && !second) continue;
      input.source = VertexInput::Source::kAttribute;
      input.attribute = static_cast<std::uint8_t>(i);
      input.component = static_cast<std::uint8_t>(slot.component + (second ? 4 : 0));
    }
  }
  // Components of one attribute next to each other: it is fetched once.
  std::stable_sort(plan.vertex_input.begin(), plan.vertex_input.begin() + plan.vertex_input_count,
                   [](const VertexInput& a, const VertexInput& b) {
                     if (a.source != b.source) return a.source < b.source;
                     return a.attribute < b.attribute;
                   });
}

void plan_vertex_outputs(PipelinePlan& plan) {
  VertexOutputs& out = plan.out;
  out = {};
  out.position.fill(kNoReg);
  out.clip_distance.fill(kNoReg);
  out.cull_distance.fill(kNoReg);
  for (const InterfaceSlot& slot : *plan.outputs) {
    if (slot.stream != 0) continue;
    switch (slot.built_in) {
      case BuiltIn::kPosition:
        out.position[slot.component & 3] = slot.reg;
        break;
      case BuiltIn::kPointSize:
        out.point_size = slot.reg;
        break;
      case BuiltIn::kClipDistance:
        out.clip_distance[slot.component & 7] = slot.reg;
        out.clip_count = std::max<std::uint32_t>(out.clip_count, (slot.component & 7u) + 1);
        break;
      case BuiltIn::kCullDistance:
        out.cull_distance[slot.component & 7] = slot.reg;
        out.cull_count = std::max<std::uint32_t>(out.cull_count, (slot.component & 7u) + 1);
        break;
      case BuiltIn::kLayer:
        out.layer = slot.reg;
        break;
      case BuiltIn::kViewportIndex:
        out.viewport_index = slot.reg;
        break;
      case BuiltIn::kPrimitiveId:
        out.primitive_id = slot.reg;
        break;
      default:
        break;
    }
  }
}

bool is_varying(const InterfaceSlot& slot) {
  switch (slot.built_in) {
    case BuiltIn::kNone:
    case BuiltIn::kClipDistance:
    case BuiltIn::kCullDistance:
    case BuiltIn::kLayer:
    case BuiltIn::kViewportIndex:
      return true;
    default:
      return false;
  }
}

std::uint32_t matching_output(const std::vector<InterfaceSlot>& outputs, const InterfaceSlot& input) {
  for (const InterfaceSlot& slot : outputs) {
    const bool same = slot.stream == 0 && slot.built_in == input.built_in && slot.component == input.component;
    if (same && (slot.built_in != BuiltIn::kNone || slot.location == input.location)) return slot.reg;
  }
  return kNoReg;
}

Interpolation interpolation_of(const InterfaceSlot& slot) {
  const bool raw = slot.built_in == BuiltIn::kLayer || slot.built_in == BuiltIn::kViewportIndex;
  return raw || slot.type != spirv::BaseType::kFloat ? Interpolation::kFlat : slot.interpolation;
}

bool same_varying(const InterfaceSlot& a, const InterfaceSlot& b) {
  return a.built_in == b.built_in && a.component == b.component && a.location == b.location &&
         interpolation_of(a) == interpolation_of(b);
}

/// Slots that name the same component share a varying.
void add_varyings(PipelinePlan& plan, Interpolation interpolation, std::uint32_t& count) {
  const std::vector<InterfaceSlot>& inputs = plan.fragment->inputs;
  const std::uint32_t first_read = plan.read_count;
  std::array<std::uint16_t, kMaxVaryingReads> source;  // index in inputs, per read
  for (std::size_t i = 0; i < inputs.size() && plan.read_count < kMaxVaryingReads; ++i) {
    const InterfaceSlot& slot = inputs[i];
    if (!is_varying(slot) || interpolation_of(slot) != interpolation) continue;
    std::uint32_t known = first_read;
    while (known < plan.read_count && !same_varying(inputs[source[known]], slot)) ++known;
    const bool added = known == plan.read_count;
    if (added && plan.varying_count() == kMaxVaryings) continue;
    const std::uint32_t varying = added ? plan.varying_count() : plan.read[known].varying;
    if (added) {
      plan.varying[varying] = {matching_output(*plan.outputs, slot), interpolation};
      ++count;
    }
    source[plan.read_count] = static_cast<std::uint16_t>(i);
    plan.read[plan.read_count++] = {slot.reg, static_cast<std::uint16_t>(varying), slot.sample_location, slot.part};
  }
}

void plan_fragment_inputs(PipelinePlan& plan) {
  FragmentRegisters& frag = plan.frag;
  for (const InterfaceSlot& slot : plan.fragment->inputs) {
    switch (slot.built_in) {
      case BuiltIn::kFragCoord:
        frag.frag_coord[slot.component & 3] = slot.reg;
        break;
      case BuiltIn::kPointCoord:
        frag.point_coord[slot.component & 1] = slot.reg;
        break;
      case BuiltIn::kSamplePosition:
        frag.sample_position[slot.component & 1] = slot.reg;
        break;
      case BuiltIn::kInterpolationCenter:
        frag.interpolation_center[slot.component & 1] = slot.reg;
        break;
      case BuiltIn::kInterpolationSample:
        if (slot.component < frag.interpolation_sample.size()) frag.interpolation_sample[slot.component] = slot.reg;
        break;
      case BuiltIn::kInterpolationScale:
        frag.interpolation_scale = slot.reg;
        break;
      case BuiltIn::kFrontFacing:
        frag.front_facing = slot.reg;
        break;
      case BuiltIn::kSampleId:
        frag.sample_id = slot.reg;
        break;
      case BuiltIn::kSampleMask:
        frag.sample_mask_in = slot.reg;
        break;
      case BuiltIn::kPrimitiveId:
        frag.primitive_id = slot.reg;
        break;
      case BuiltIn::kHelperInvocation:
        frag.helper = slot.reg;
        break;
      case BuiltIn::kViewIndex:
        frag.view_index = slot.reg;
        break;
      default:
        break;
    }
  }
  for (const InterfaceSlot& slot : plan.fragment->outputs) {
    switch (slot.built_in) {
      case BuiltIn::kNone:
        if (slot.index == 1)
          frag.color_second[slot.component & 3] = slot.reg;
        else if (slot.location < kMaxColorAttachments)
          frag.color[slot.location][slot.component & 3] = slot.reg;
        break;
      case BuiltIn::kFragDepth:
        frag.depth = slot.reg;
        break;
      case BuiltIn::kFragStencilRef:
        frag.stencil = slot.reg;
        break;
      case BuiltIn::kSampleMask:
        frag.sample_mask = slot.reg;
        break;
      default:
        break;
    }
  }
}

/// gl_PointSize travels with the vertices through the clipper, like an output no fragment shader reads
/// (lavapipe-rasterization.md 1.5).
void add_point_size(PipelinePlan& plan) {
  const State& state = *plan.state;
  const bool points = plan.corners == 1 || state.polygon_mode == VK_POLYGON_MODE_POINT;
  plan.point_size_word = kNoReg;
  if (!points || plan.out.point_size == kNoReg || plan.perspective_count == kMaxVaryings) return;
  plan.varying[plan.perspective_count] = {plan.out.point_size, Interpolation::kPerspective};
  plan.point_size_word = 4 + plan.perspective_count++;
}

void plan_varyings(PipelinePlan& plan) {
  plan.perspective_count = plan.linear_count = plan.flat_count = plan.read_count = 0;
  FragmentRegisters& frag = plan.frag;
  frag = {};
  frag.frag_coord.fill(kNoReg);
  frag.point_coord.fill(kNoReg);
  frag.sample_position.fill(kNoReg);
  frag.interpolation_center.fill(kNoReg);
  frag.interpolation_sample.fill(kNoReg);
  for (auto& color : frag.color) color.fill(kNoReg);
  frag.color_second.fill(kNoReg);
  if (plan.fragment) {
    plan_fragment_inputs(plan);
    add_varyings(plan, Interpolation::kPerspective, plan.perspective_count);
  }
  add_point_size(plan);
  plan.smooth_lines &= plan.varying_count() + 4 <= kMaxVaryings;
  for (std::uint32_t i = 0; i < (plan.smooth_lines ? 4u : 0u); ++i)
    plan.varying[plan.perspective_count++] = {kNoReg, Interpolation::kPerspective};
  if (plan.fragment) {
    add_varyings(plan, Interpolation::kLinear, plan.linear_count);
    add_varyings(plan, Interpolation::kFlat, plan.flat_count);
  }
  std::stable_sort(plan.read.begin(), plan.read.begin() + plan.read_count,
                   [](const VaryingRead& a, const VaryingRead& b) {
                     if (a.part != b.part) return a.part < b.part;
                     return a.location < b.location;
                   });
  plan.vertex_stride = (4 + plan.varying_count() + 3) & ~3u;
}

/// lavapipe-rasterization.md 1.1.
ViewportTransform viewport_transform(const VkViewport& viewport, bool negative_one_to_one) {
  ViewportTransform t;
  t.sx = 0.5f * viewport.width;
  t.tx = t.sx + viewport.x;
  t.sy = 0.5f * viewport.height;
  t.ty = t.sy + viewport.y;
  const double min = viewport.minDepth, max = viewport.maxDepth;
  if (negative_one_to_one) {
    t.sz = static_cast<float>(0.5 * (max - min));
    t.tz = static_cast<float>(0.5 * (min + max));
  } else {
    t.sz = static_cast<float>(max - min);
    t.tz = viewport.minDepth;
  }
  const float a = negative_one_to_one ? t.tz - t.sz : t.tz, b = t.tz + t.sz;
  t.z_min = std::min(a, b);
  t.z_max = std::max(a, b);
  return t;
}

PixelRect rect_of(const VkRect2D& rect) {
  const auto end = [](std::int32_t offset, std::uint32_t extent) {
    return static_cast<int>(std::min<std::int64_t>(std::int64_t{offset} + extent, 1 << 20)) - 1;
  };
  return {rect.offset.x, rect.offset.y, end(rect.offset.x, rect.extent.width), end(rect.offset.y, rect.extent.height)};
}

/// 3.3: the pixels of a viewport.
PixelRect rect_of(const ViewportTransform& viewport) {
  const auto first = [](float offset) { return static_cast<int>(offset + 0.499f); };
  const auto last = [](float offset, float half) { return static_cast<int>(half * 2.0f + offset - 0.501f); };
  const float half = std::fabs(viewport.sy), x = viewport.tx - viewport.sx, y = viewport.ty - half;
  return {first(x), first(y), last(x, viewport.sx), last(y, half)};
}

void plan_viewports(PipelinePlan& plan, const PassDesc& pass) {
  PixelRect framebuffer = rect_of(pass.render_area);
  framebuffer.x0 = framebuffer.y0 = 0;  // 3.3: the render area's offset does not clip
  const std::uint32_t count = std::clamp<std::uint32_t>(plan.state->viewport_count, 1, kMaxViewports);
  for (std::uint32_t i = 0; i < kMaxViewports; ++i) {
    const std::uint32_t source = i < count ? i : 0;
    plan.viewport[i] = viewport_transform(plan.state->viewport[source], plan.state->negative_one_to_one);
    plan.region[i] = intersect(framebuffer, rect_of(plan.state->scissor[source]));
  }
  plan.wide_region = intersect(plan.region[0], rect_of(plan.viewport[0]));
  plan.per_vertex_viewport = plan.out.viewport_index != kNoReg;
  plan.fused_transform = !plan.stages.any();
}

/// Locations of a vertex, in words behind its header.
std::uint32_t vertex_words(const std::vector<InterfaceSlot>& outputs, const ShaderInterface& reader) {
  std::uint32_t locations = reader.modes.input_locations;
  for (const InterfaceSlot& slot : outputs)
    if (slot.built_in == BuiltIn::kNone) locations = std::max<std::uint32_t>(locations, slot.location + 1u);
  return spirv::kVertexHeaderWords + 4 * locations;
}

/// "The tessellation modes may be specified in either stage" (Vulkan 1.3.239, Tessellation).
spirv::StageModes merge_modes(const spirv::StageModes& control, const spirv::StageModes& evaluation) {
  spirv::StageModes modes = evaluation;
  if (!modes.has_domain) modes.domain = control.domain;
  // Where neither stage says, which Vulkan forbids, this is what the reference makes of it.
  if (!modes.has_spacing) modes.spacing = control.has_spacing ? control.spacing : spirv::TessSpacing::kFractionalEven;
  if (!modes.has_order) modes.clockwise = !control.has_order || control.clockwise;
  modes.point_mode |= control.point_mode;
  modes.control_points = std::max(control.control_points, evaluation.control_points);
  modes.vertex_words = control.vertex_words;
  modes.patch_words = control.patch_words;
  return modes;
}

bool reads(const ShaderInterface& shader, BuiltIn built_in) {
  return std::any_of(shader.inputs.begin(), shader.inputs.end(),
                     [=](const InterfaceSlot& slot) { return slot.built_in == built_in; });
}

std::uint32_t corners_of_output(VkPrimitiveTopology output) {
  return output == VK_PRIMITIVE_TOPOLOGY_POINT_LIST ? 1 : output == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP ? 2 : 3;
}

/// Stages between vertex shader and rasterization. False if nothing can be drawn.
bool plan_stages(const DrawCall& draw, PipelinePlan& plan) {
  StagePlan& stages = plan.stages;
  stages.control = draw.control ? &draw.control->interface() : nullptr;
  stages.evaluation = draw.control && draw.evaluation ? &draw.evaluation->interface() : nullptr;
  stages.geometry = draw.geometry ? &draw.geometry->interface() : nullptr;
  plan.shape = topology_shape(draw);
  plan.corners = plan.shape.corners;
  plan.outputs = &plan.vertex->outputs;
  plan.chunk_positions = kChunkPositions;
  plan.position_weight = 1;
  plan.counts_primitives = false;
  if (!stages.any()) return true;
  if (plan.corners == 0) return false;
  std::uint32_t growth = 1;
  if (stages.evaluation) {
    stages.vertex_words = vertex_words(plan.vertex->outputs, *stages.control);
    stages.tessellation = merge_modes(stages.control->modes, stages.evaluation->modes);
    if (stages.tessellation.control_points == 0) return false;
    plan.outputs = &stages.evaluation->outputs;
    const bool lines = stages.tessellation.domain == spirv::TessDomain::kIsolines;
    plan.corners = stages.tessellation.point_mode ? 1 : lines ? 2 : 3;
    growth = kTessellationGrowth;
  }
  if (stages.geometry) {
    const spirv::StageModes& modes = stages.geometry->modes;
    (stages.evaluation ? stages.evaluation_words : stages.vertex_words) = vertex_words(*plan.outputs, *stages.geometry);
    plan.outputs = &stages.geometry->emitted;
    plan.corners = corners_of_output(modes.output);
    // "The index is incremented after every individual point, line, or triangle primitive is processed" (Vulkan
    // 1.3.239, PrimitiveId): those of the tessellator, not patches.
    plan.counts_primitives = stages.evaluation && reads(*stages.geometry, BuiltIn::kPrimitiveId);
    growth *= std::max<std::uint32_t>(modes.max_vertices * modes.invocations, 1);
  }
  plan.position_weight = std::max(growth / plan.shape.step, 1u);
  plan.chunk_positions = std::max(kChunkPositions / plan.position_weight, kMinPrimitives * plan.shape.step);
  return true;
}

bool stencil_writes(const StencilFace& face) { return face.write_mask != 0; }

bool reads_at_centroid(const PipelinePlan& plan) {
  return std::any_of(plan.read.begin(), plan.read.begin() + plan.read_count,
                     [](const VaryingRead& read) { return read.location == spirv::SampleLocation::kCentroid; });
}

/// lavapipe-rasterization.md 5.2, 5.4. What ends late there and could be tested early without being seen is rejected
/// early and decided late here.
void plan_tests(PipelinePlan& plan, const PassDesc& pass) {
  const State& state = *plan.state;
  plan.depth_test = state.depth_test && pass.depth.format != nullptr;
  plan.depth_write = plan.depth_test && state.depth_write;
  plan.depth_bounds = state.depth_bounds_test && pass.depth.format != nullptr;
  plan.stencil_test = state.stencil_test && pass.stencil.format != nullptr;
  const ShaderInterface* fragment = plan.fragment;
  const texel::FormatDesc* depth_format = pass.depth.format;
  plan.restricts_depth = !state.unrestricted_depth || depth_format == nullptr ||
                         depth_format->channel[0].numeric != texel::Numeric::kSfloat;
  // Numbers of fixed point stay in [0, 1] after the depth clamp, too.
  if (state.unrestricted_depth && plan.restricts_depth)
    for (ViewportTransform& viewport : plan.viewport) {
      viewport.z_min = std::clamp(viewport.z_min, 0.0f, 1.0f);
      viewport.z_max = std::clamp(viewport.z_max, 0.0f, 1.0f);
    }
  plan.may_kill = state.alpha_to_coverage || (fragment && (fragment->uses_discard || plan.frag.sample_mask != kNoReg));
  plan.depth_order = TestOrder::kNone;
  plan.early_reject = false;
  plan.in_order = fragment && fragment->writes_memory;
  if (!plan.depth_test && !plan.depth_bounds && !plan.stencil_test) return;
  plan.depth_order = TestOrder::kEarly;
  if (!fragment || fragment->early_fragment_tests) return;
  if (state.ordered_attachment_access || fragment->reads_attachment) {
    plan.depth_order = TestOrder::kLate;  // the fragment may see the depth before its own
    return;
  }
  const bool replaces = plan.frag.depth != kNoReg || plan.frag.stencil != kNoReg;
  if (!replaces && !fragment->writes_memory && !plan.may_kill) return;
  plan.depth_order = TestOrder::kLate;
  const bool stencil_changes = plan.stencil_test && (stencil_writes(state.front) || stencil_writes(state.back));
  if (replaces || fragment->writes_memory || stencil_changes) return;
  const bool sees_rejects = plan.raster_samples > 1 && reads_at_centroid(plan);
  plan.in_order |= sees_rejects;
  plan.early_reject = sees_rejects || (!plan.stencil_test && !plan.depth_bounds &&
                                       (has_limit(state.depth_compare) || !plan.depth_write));
}

void plan_rasterization(PipelinePlan& plan, const PassDesc& pass) {
  const State& state = *plan.state;
  plan.draws_points = plan.corners == 1;
  plan.draws_lines = plan.corners == 2;
  plan.samples = std::max<std::uint32_t>(pass.samples, 1);
  // Vulkan 1.3.239, VkGraphicsPipelineCreateInfo: without attachments the pipeline's sample count holds.
  const auto is_used = [](const texel::ImageView& view) { return view.format != nullptr; };
  const bool attached = is_used(pass.depth) || is_used(pass.stencil) ||
                        std::any_of(pass.color.begin(), pass.color.begin() + pass.color_count, is_used);
  if (!attached) plan.samples = std::clamp<std::uint32_t>(state.samples, 1, kMaxSamples);
  plan.raster_samples = plan.samples;
  const bool single = state.line_mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT ||
                      state.line_mode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
  if (plan.draws_lines && single) plan.raster_samples = 1;
  const bool custom = state.custom_locations && plan.raster_samples > 1 && state.locations.count == plan.raster_samples;
  plan.locations = custom ? &state.locations : &standard_locations(plan.raster_samples);
  plan.smooth_lines = state.line_mode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT &&
                      plan.raster_samples == 1 &&
                      (plan.draws_lines || (state.polygon_mode == VK_POLYGON_MODE_LINE && !plan.draws_points));
  plan.pixel_offset = plan.raster_samples > 1 ? 0.0f : 0.5f;
  plan.sample_mask = state.sample_mask & ((1u << plan.samples) - 1);
  const bool wants = state.sample_shading && std::ceil(static_cast<float>(plan.samples) * state.min_sample_shading) > 1;
  plan.sample_shading = plan.raster_samples > 1 && plan.fragment && (wants || plan.fragment->per_sample);
  plan.depth_bias = state.depth_bias && (state.depth_bias_slope != 0 || state.depth_bias_constant != 0);
  plan.bias_in_vertices = state.polygon_mode != VK_POLYGON_MODE_FILL && !plan.draws_lines && !plan.draws_points;
}

/// A fragment shader whose results nobody sees is not run.
void plan_colors(PipelinePlan& plan, const PassDesc& pass, bool general) {
  plan.color_count = std::min(pass.color_count, kMaxColorAttachments);
  const ShaderInterface* fragment = plan.fragment;
  plan.shades = fragment &&
                (fragment->writes_memory || plan.may_kill || plan.frag.depth != kNoReg || plan.frag.stencil != kNoReg);
  plan.replaces_colors = fragment && !plan.may_kill && !fragment->writes_memory && plan.color_count != 0 &&
                         plan.depth_order == TestOrder::kNone && plan.sample_mask == (1u << plan.samples) - 1;
  const auto& second = plan.frag.color_second;
  plan.dual_source = std::any_of(second.begin(), second.end(), [](std::uint32_t reg) { return reg != kNoReg; });
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    plan.writer[i] = {};
    if (!pass.color[i].format) continue;
    const auto& color = plan.frag.color[i];
    const bool written = std::any_of(color.begin(), color.end(), [](std::uint32_t reg) { return reg != kNoReg; });
    const texel::FormatDesc* format = pass.color[i].format;
    if (!fragment || !written) {
      plan.replaces_colors = false;
      continue;
    }
    plan.writer[i] =
        (general ? make_general_color_writer : make_color_writer)(format->format, plan.state->blend[i], *plan.state);
    plan.shades |= plan.writer[i].function != nullptr;
    plan.replaces_colors &= plan.writer[i].function != nullptr && !plan.writer[i].reads_destination();
  }
}

/// Whether a varying is wanted elsewhere than at the centre, or its plane.
bool reads_elsewhere(const PipelinePlan& plan) {
  return std::any_of(plan.read.begin(), plan.read.begin() + plan.read_count, [&](const VaryingRead& read) {
    return read.part != spirv::InputPart::kValue ||
           (read.location != spirv::SampleLocation::kCenter && plan.raster_samples > 1);
  });
}

/// What the block path leaves to packed waves: whatever is rare and needs more than varyings and FragCoord.
void plan_blocks(PipelinePlan& plan, bool general) {
  plan.windows = !general && plan.samples == 1 && plan.raster_samples == 1 && plan.sample_mask != 0;
  plan.tests_rows = !general && !plan.stencil_test && !plan.depth_bounds;
  // Depths beyond [0, 1] wrap in formats of fixed point.
  const bool clamps_inside = std::all_of(plan.viewport.begin(), plan.viewport.end(),
                                         [](const ViewportTransform& t) { return t.z_min >= 0 && t.z_max <= 1; });
  plan.hides_blocks =
      plan.tests_rows && plan.depth_test && (plan.depth_order == TestOrder::kEarly || plan.early_reject) &&
      has_limit(plan.state->depth_compare) && plan.restricts_depth && (!plan.state->depth_clamp || clamps_inside);
  const FragmentRegisters& frag = plan.frag;
  const bool rare_inputs = frag.point_coord[0] != kNoReg || frag.point_coord[1] != kNoReg || frag.sample_id != kNoReg ||
                           frag.sample_position[0] != kNoReg || frag.sample_position[1] != kNoReg ||
                           frag.sample_mask_in != kNoReg || frag.helper != kNoReg || frag.layer != kNoReg ||
                           frag.view_index != kNoReg || reads_elsewhere(plan);
  const bool rare_outputs = frag.depth != kNoReg || frag.stencil != kNoReg || frag.sample_mask != kNoReg ||
                            plan.smooth_lines || plan.dual_source || plan.state->alpha_to_coverage ||
                            plan.state->alpha_to_one;
  const bool late_stencil = (plan.stencil_test || plan.depth_bounds) && plan.depth_order == TestOrder::kLate;
  plan.shades_blocks =
      !general && plan.shades && !plan.sample_shading && !rare_inputs && !rare_outputs && !late_stencil;
}

}  // namespace

bool make_plan(const DrawCall& draw, const PassDesc& pass, PipelinePlan& plan) {
  plan.state = draw.state;
  plan.vertex = interface_of(draw.vertex, draw.native_vertex);
  plan.fragment = interface_of(draw.fragment, draw.native_fragment);
  if (!plan.vertex || pass.samples > kMaxSamples) return false;
  if (!plan_stages(draw, plan)) return false;
  plan_captures(plan);
  plan.vertex_input_count = 0;
  plan_vertex_inputs(plan);
  plan_vertex_outputs(plan);
  plan_rasterization(plan, pass);
  plan_varyings(plan);
  plan_viewports(plan, pass);
  // 8.2: with one sample only a mask of all zeros has an effect.
  if (plan.samples == 1 && draw.state->sample_mask != 0) plan.sample_mask = 1;
  plan_tests(plan, pass);
  plan_colors(plan, pass, draw.general_path);
  plan_blocks(plan, draw.general_path);
  return true;
}

TopologyShape topology_shape(const DrawCall& draw) {
  switch (draw.state->topology) {
    case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
      return {1, 1, 1, false, false};
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
      return {2, 2, 2, false, false};
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
      return {2, 1, 2, false, false};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
      return {3, 3, 3, false, false};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
      return {3, 1, 3, false, false};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN:
      return {3, 1, 3, true, false};
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
      return {4, 4, 2, false, false};
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
      return {4, 1, 2, false, false};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
      return {6, 6, 3, false, false};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
      return {6, 2, 3, false, draw.geometry != nullptr};
    case VK_PRIMITIVE_TOPOLOGY_PATCH_LIST: {
      const std::uint32_t points = draw.evaluation ? std::min(draw.state->patch_control_points, kMaxPatchVertices) : 0;
      return {std::max(points, 1u), std::max(points, 1u), points, false, false};
    }
    default:
      return {1, 1, 0, false, false};
  }
}

}  // namespace vitrine::raster
