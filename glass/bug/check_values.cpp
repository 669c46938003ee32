// Numbers that Vulkan gives a meaning to: a file may only say those, since whoever replays it hands them to a driver,
// and drivers need not look (Vulkan 1.3.239, Fundamentals: Valid Usage).
#include <algorithm>
#include <bit>
#include <set>

#include "glass/bug/file.h"
#include "texel/format.h"

namespace vitrine::glass::bug {
namespace {

bool inside(std::uint64_t offset, std::uint64_t size, std::uint64_t whole) {
  return offset <= whole && size <= whole - offset;
}

template <class E>
bool up_to(E value, E last) {
  return value >= 0 && value <= last;
}

bool is_format(VkFormat format) { return texel::format_desc(format).block_bytes != 0; }

bool can_be(const Image& image) {
  const texel::FormatDesc& format = texel::format_desc(image.format);
  const texel::Extent& e = image.extent;
  const std::uint32_t longest = std::max({e.width, e.height, e.depth});
  const bool flat = image.type != VK_IMAGE_TYPE_3D, line = image.type == VK_IMAGE_TYPE_1D;
  const bool cube = image.flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  return is_format(image.format) && up_to(image.type, VK_IMAGE_TYPE_3D) &&
         up_to(image.tiling, VK_IMAGE_TILING_LINEAR) && std::has_single_bit(image.samples) && image.samples <= 16 &&
         image.levels <= static_cast<std::uint32_t>(std::bit_width(longest)) && image.layers <= 2048 &&
         (!flat || e.depth == 1) && (!line || e.height == 1) && (flat || image.layers == 1) &&
         (image.samples == 1 || (image.levels == 1 && image.type == VK_IMAGE_TYPE_2D)) &&
         (!cube || (e.width == e.height && image.layers >= 6 && image.type == VK_IMAGE_TYPE_2D)) &&
         std::ranges::all_of(image.texels, [&](const Texels& t) {
           return std::has_single_bit(static_cast<std::uint32_t>(t.aspect)) && (t.aspect & format.aspects);
         });
}

bool is_array(VkImageViewType type) { return type >= VK_IMAGE_VIEW_TYPE_1D_ARRAY; }

bool is_of(VkImageViewType view, const Image& image) {
  switch (view) {
    case VK_IMAGE_VIEW_TYPE_1D:
    case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
      return image.type == VK_IMAGE_TYPE_1D;
    case VK_IMAGE_VIEW_TYPE_2D:
    case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
      return image.type == VK_IMAGE_TYPE_2D || image.type == VK_IMAGE_TYPE_3D;
    case VK_IMAGE_VIEW_TYPE_3D:
      return image.type == VK_IMAGE_TYPE_3D;
    default:
      return image.type == VK_IMAGE_TYPE_2D && (image.flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT);
  }
}

bool can_be(const View& view, const Image& image) {
  const VkImageSubresourceRange& r = view.range;
  const texel::FormatDesc& of_view = texel::format_desc(view.format);
  const texel::FormatDesc& of_image = texel::format_desc(image.format);
  // Slices of a 3D image are layers of its 2D views.
  const bool slices = image.type == VK_IMAGE_TYPE_3D && view.type != VK_IMAGE_VIEW_TYPE_3D;
  const std::uint32_t layers =
      slices ? std::max(image.extent.depth >> std::min(r.baseMipLevel, 31u), 1u) : image.layers;
  const bool cube = view.type == VK_IMAGE_VIEW_TYPE_CUBE || view.type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
  const VkImageAspectFlags planes = VK_IMAGE_ASPECT_COLOR_BIT | VK_IMAGE_ASPECT_PLANE_0_BIT |
                                    VK_IMAGE_ASPECT_PLANE_1_BIT | VK_IMAGE_ASPECT_PLANE_2_BIT;
  const VkImageAspectFlags aspects =
      of_image.plane_count > 1 && !of_image.is_depth_stencil() ? planes : of_image.aspects;
  const bool alike = of_image.is_depth_stencil() ? view.format == image.format
                                                 : of_view.block_bytes == of_image.block_bytes ||
                                                       of_image.is_compressed() || of_image.plane_count > 1;
  return up_to(view.type, VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) && is_of(view.type, image) && is_format(view.format) &&
         alike && r.levelCount > 0 && r.layerCount > 0 && inside(r.baseMipLevel, r.levelCount, image.levels) &&
         inside(r.baseArrayLayer, r.layerCount, layers) && (is_array(view.type) || cube || r.layerCount == 1) &&
         (!cube || r.layerCount % 6 == 0) && (view.type != VK_IMAGE_VIEW_TYPE_CUBE || r.layerCount == 6) &&
         r.aspectMask != 0 && (r.aspectMask & ~aspects) == 0;
}

bool can_be(const texel::Sampler& s) {
  const auto filter = [](VkFilter f) { return up_to(f, VK_FILTER_LINEAR) || f == VK_FILTER_CUBIC_EXT; };
  return filter(s.mag_filter) && filter(s.min_filter) && up_to(s.mip_mode, VK_SAMPLER_MIPMAP_MODE_LINEAR) &&
         std::ranges::all_of(s.address,
                             [](auto mode) { return up_to(mode, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE); }) &&
         up_to(s.compare_op, VK_COMPARE_OP_ALWAYS) && up_to(s.reduction, VK_SAMPLER_REDUCTION_MODE_MAX);
}

bool can_be(const raster::StencilFace& f) {
  return up_to(f.fail, VK_STENCIL_OP_DECREMENT_AND_WRAP) && up_to(f.pass, VK_STENCIL_OP_DECREMENT_AND_WRAP) &&
         up_to(f.depth_fail, VK_STENCIL_OP_DECREMENT_AND_WRAP) && up_to(f.compare, VK_COMPARE_OP_ALWAYS);
}

bool can_be(const raster::BlendAttachment& b) {
  const auto factor = [](VkBlendFactor f) { return up_to(f, VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA); };
  return factor(b.src_color) && factor(b.dst_color) && factor(b.src_alpha) && factor(b.dst_alpha) &&
         (up_to(b.color_op, VK_BLEND_OP_MAX) || b.advances()) &&
         (up_to(b.alpha_op, VK_BLEND_OP_MAX) || b.alpha_op == b.color_op) &&
         up_to(b.overlap, VK_BLEND_OVERLAP_CONJOINT_EXT) && b.write_mask <= 0xf;
}

bool can_be(const VkRect2D& r) {
  return r.offset.x >= 0 && r.offset.y >= 0 && r.extent.width <= INT32_MAX - static_cast<std::uint32_t>(r.offset.x) &&
         r.extent.height <= INT32_MAX - static_cast<std::uint32_t>(r.offset.y);
}

bool is_fragment_size(VkExtent2D size) {
  const auto side = [](std::uint32_t pixels) {
    return std::has_single_bit(pixels) && pixels <= raster::kLargestFragment;
  };
  return side(size.width) && side(size.height);
}

bool can_be(const raster::State& s) {
  std::set<std::uint32_t> locations;
  for (std::uint32_t i = 0; i < s.attribute_count; ++i) {
    const raster::VertexAttribute& a = s.attribute[i];
    if (a.location >= raster::kMaxVertexAttributes || a.binding >= raster::kMaxVertexBindings || !is_format(a.format) ||
        a.offset > 2047 || !locations.insert(a.location).second)
      return false;
  }
  return up_to(s.topology, VK_PRIMITIVE_TOPOLOGY_PATCH_LIST) && s.patch_control_points <= 32 &&
         (s.topology != VK_PRIMITIVE_TOPOLOGY_PATCH_LIST || s.patch_control_points > 0) &&
         up_to(s.polygon_mode, VK_POLYGON_MODE_POINT) && s.cull_mode <= VK_CULL_MODE_FRONT_AND_BACK &&
         up_to(s.front_face, VK_FRONT_FACE_CLOCKWISE) &&
         up_to(s.line_mode, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT) &&
         (!s.line_stipple || (s.line_stipple_factor >= 1 && s.line_stipple_factor <= 256)) && s.line_width >= 0 &&
         s.line_width < 256 && std::has_single_bit(s.samples) && s.samples <= raster::kMaxSamples &&
         up_to(s.depth_compare, VK_COMPARE_OP_ALWAYS) && can_be(s.front) && can_be(s.back) &&
         s.discard_count <= raster::kMaxDiscardRectangles && is_fragment_size(s.fragment_size) &&
         up_to(s.rate_combiners[0], VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MUL_KHR) &&
         up_to(s.rate_combiners[1], VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MUL_KHR) &&
         s.rasterized_stream < raster::kMaxStreams && up_to(s.logic_op, VK_LOGIC_OP_SET) &&
         std::ranges::all_of(s.blend, [](const auto& b) { return can_be(b); }) &&
         std::ranges::all_of(s.scissor, [](const auto& r) { return can_be(r); }) &&
         std::ranges::all_of(s.discard, [](const auto& r) { return can_be(r); });
}

/// A shading rate attachment has bytes for all of the area (Vulkan 1.3.239, Attachment Fragment Shading Rate).
bool has_rates(const Rendering& r, const Bug& bug) {
  constexpr std::uint32_t kMost = 256;
  if (r.rate == kNone) return true;
  const View& view = bug.views[r.rate];
  const Image& image = bug.images[view.image];
  const auto texels = [&](std::uint32_t whole) { return std::max(whole >> view.range.baseMipLevel, 1u); };
  const auto covers = [](std::uint32_t count, std::uint32_t pixels, std::int32_t first, std::uint32_t size) {
    return std::has_single_bit(pixels) && pixels <= kMost &&
           inside(static_cast<std::uint32_t>(first), size, std::uint64_t{count} * pixels);
  };
  const std::uint32_t layers = std::max(r.layers, static_cast<std::uint32_t>(std::bit_width(r.view_mask)));
  return view.format == VK_FORMAT_R8_UINT && view.range.levelCount == 1 && image.samples == 1 &&
         (view.range.layerCount == 1 || layers <= view.range.layerCount) &&
         covers(texels(image.extent.width), r.rate_texel.width, r.area.offset.x, r.area.extent.width) &&
         covers(texels(image.extent.height), r.rate_texel.height, r.area.offset.y, r.area.extent.height);
}

/// What is drawn to has the area, the layers and the samples.
bool can_be(const Rendering& r, const Bug& bug) {
  if (!can_be(r.area) || r.layers == 0 || r.area.extent.width == 0 || r.area.extent.height == 0) return false;
  if (!has_rates(r, bug)) return false;
  std::vector<std::uint32_t> numbers = r.colors;
  numbers.insert(numbers.end(), {r.depth, r.stencil});
  return std::ranges::all_of(numbers, [&](std::uint32_t number) {
    if (number == kNone) return r.area.extent.width <= 1u << 15 && r.area.extent.height <= 1u << 15 && r.layers <= 2048;
    const View& view = bug.views[number];
    const Image& image = bug.images[view.image];
    const auto side = [&](std::uint32_t whole) { return std::max(whole >> view.range.baseMipLevel, 1u); };
    const std::uint32_t layers = std::max(r.layers, static_cast<std::uint32_t>(std::bit_width(r.view_mask)));
    return view.range.levelCount == 1 && layers <= view.range.layerCount &&
           inside(static_cast<std::uint32_t>(r.area.offset.x), r.area.extent.width, side(image.extent.width)) &&
           inside(static_cast<std::uint32_t>(r.area.offset.y), r.area.extent.height, side(image.extent.height)) &&
           image.samples == bug.state.samples;
  });
}

std::string fault_of_stages(const Bug& bug) {
  std::uint32_t stages = 0;
  for (const Stage& stage : bug.stages) {
    const auto bit = static_cast<std::uint32_t>(stage.stage);
    if (!std::has_single_bit(bit) || bit > VK_SHADER_STAGE_COMPUTE_BIT || (stages & bit))
      return "a stage twice, or none";
    if (stage.subgroup_size != 0 && (!std::has_single_bit(stage.subgroup_size) || stage.subgroup_size > 128))
      return "a subgroup of no size";
    stages |= bit;
  }
  const std::uint32_t patches = VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT | VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT;
  const bool computes = stages == VK_SHADER_STAGE_COMPUTE_BIT;
  const bool draws = (stages & VK_SHADER_STAGE_VERTEX_BIT) && !(stages & VK_SHADER_STAGE_COMPUTE_BIT);
  if (!computes && !draws) return "stages that make no pipeline";
  if ((stages & patches) != 0 && (stages & patches) != patches) return "half of a tessellation";
  if (draws && ((stages & patches) != 0) != (bug.state.topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST))
    return "patches without tessellation";
  return {};
}

/// A mutable binding says what its descriptors may be (VK_EXT_mutable_descriptor_type), no other does.
bool has_types(const Binding& b) {
  if (b.type != VK_DESCRIPTOR_TYPE_MUTABLE_EXT)
    return b.types.empty() &&
           (up_to(b.type, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT) || b.type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK);
  const auto may_be = [](VkDescriptorType t) {
    return up_to(t, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT) && !is_dynamic(t);
  };
  return !b.types.empty() && b.samplers.empty() && std::ranges::all_of(b.types, may_be) &&
         std::set<VkDescriptorType>(b.types.begin(), b.types.end()).size() == b.types.size();
}

std::string fault_of_layout(const Bug& bug) {
  for (const SetLayout& set : bug.sets) {
    std::set<std::uint32_t> numbers;
    for (const Binding& b : set.bindings) {
      const bool block = b.type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
      if (!has_types(b) || b.binding > 1u << 24 || !numbers.insert(b.binding).second || (block && b.count % 4 != 0))
        return "a binding that cannot be";
    }
  }
  for (const VkPushConstantRange& r : bug.push_ranges)
    if (r.offset % 4 != 0 || r.size % 4 != 0 || r.size == 0 || r.stageFlags == 0)
      return "push constants that cannot be";
  return bug.sets.size() > spirv::kMaxSets ? "more sets than there can be" : "";
}

/// Bytes of a buffer that an indirect command reads.
bool has_bytes(const Bug& bug, std::uint32_t buffer, std::uint64_t offset, std::uint64_t size) {
  return buffer == kNone || (offset % 4 == 0 && inside(offset, size, bug.buffers[buffer].size));
}

std::string fault_of_command(const Bug& bug) {
  const Command& c = bug.command;
  const std::uint64_t one = bug.dispatches() ? sizeof(VkDispatchIndirectCommand)
                            : c.indexed      ? sizeof(VkDrawIndexedIndirectCommand)
                                             : sizeof(VkDrawIndirectCommand);
  const std::uint64_t last = c.draw_count > 1 ? std::uint64_t{c.draw_count - 1} * c.stride : 0;
  if (!has_bytes(bug, c.arguments, c.arguments_offset, last + one) ||
      !has_bytes(bug, c.count_buffer, c.count_offset, 4) || (c.draw_count > 1 && (c.stride % 4 != 0 || c.stride < one)))
    return "arguments outside of their buffer";
  for (std::size_t i = 0; i < 3; ++i)
    if (!inside(c.base[i], c.groups[i], 65535)) return "more workgroups than there can be";
  if (bug.dispatches()) return {};
  if (c.index_type != VK_INDEX_TYPE_UINT16 && c.index_type != VK_INDEX_TYPE_UINT32 &&
      c.index_type != VK_INDEX_TYPE_UINT8_EXT)
    return "indices that cannot be";
  for (const Stream& s : bug.streams)
    if (s.stride > 2048) return "vertices that are too far apart";
  for (const Stream& s : bug.feedback)
    if (s.offset % 4 != 0 || s.size == 0 ||
        !(bug.buffers[s.buffer].usage & VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT))
      return "transform feedback that cannot be";
  return {};
}

}  // namespace

std::string fault_of_values(const Bug& bug) {
  for (const Image& image : bug.images)
    if (!can_be(image)) return "an image that cannot be";
  for (const View& view : bug.views)
    if (!can_be(view, bug.images[view.image])) return "a view that cannot be";
  for (const BufferView& view : bug.buffer_views)
    if (!is_format(view.format) || view.range == 0) return "a view of a buffer that cannot be";
  for (const Sampler& sampler : bug.samplers)
    if (!can_be(sampler.state)) return "a sampler that cannot be";
  for (const auto& part : {fault_of_stages, fault_of_layout, fault_of_command})
    if (std::string fault = part(bug); !fault.empty()) return fault;
  if (bug.dispatches()) return {};
  if (!can_be(bug.state)) return "state that cannot be";
  return can_be(bug.rendering, bug) ? "" : "attachments that do not fit what is drawn";
}

}  // namespace vitrine::glass::bug
