// What a file may say: numbers of objects that there are, memory inside of memory. Whoever replays relies on it; what
// Vulkan asks for beyond that is the driver's to refuse.
#include <algorithm>

#include "glass/bug/file.h"

namespace vitrine::glass::bug {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 40;

bool inside(std::uint64_t offset, std::uint64_t size, std::uint64_t whole) {
  return offset <= whole && size <= whole - offset;
}
template <class T>
bool names(const std::vector<T>& objects, std::uint32_t number) {
  return number == kNone || number < objects.size();
}

std::string fault_of_memory(const Memory& memory) {
  if (memory.size > kMostBytes) return "memory that no machine has";
  std::uint64_t end = 0;
  for (const Piece& piece : memory.pieces) {
    if (!piece.before || piece.offset < end || !inside(piece.offset, piece.before->size(), memory.size))
      return "bytes outside of their memory";
    if (piece.after && piece.after->size() != piece.before->size()) return "bytes that change their number";
    end = piece.offset + piece.before->size();
  }
  return {};
}

std::string fault_of_image(const Image& image) {
  const bool levels = image.levels > 0 && image.levels <= texel::kMaxLevels;
  if (!levels || image.layers == 0 || image.samples == 0 || image.samples > 64) return "an image that cannot be";
  for (const std::uint32_t side : {image.extent.width, image.extent.height, image.extent.depth})
    if (side == 0 || side > 1u << (texel::kMaxLevels - 1)) return "an image that cannot be";
  for (const Texels& texels : image.texels) {
    const bool there =
        texels.level < image.levels && texels.layers > 0 && inside(texels.layer, texels.layers, image.layers);
    if (!texels.before || !there) return "texels that the image does not have";
    if (texels.after && texels.after->size() != texels.before->size()) return "texels that change their number";
  }
  return {};
}

bool has_live_buffer(const Bug& bug, std::uint32_t memory) {
  return std::ranges::any_of(bug.buffers, [&](const Buffer& b) { return b.memory == memory && !b.gone; });
}

std::string fault_of_objects(const Bug& bug) {
  for (const Memory& memory : bug.memories)
    if (std::string fault = fault_of_memory(memory); !fault.empty()) return fault;
  for (const Buffer& b : bug.buffers) {
    if (b.memory >= bug.memories.size() || b.size == 0) return "a buffer without memory";
    if (!inside(b.offset, b.size, bug.memories[b.memory].size)) return "a buffer outside of its memory";
    if (b.gone && !bug.memories[b.memory].pieces.empty() && !has_live_buffer(bug, b.memory))
      return "contents of memory that is gone";
  }
  for (const std::uint32_t number : bug.addressed)
    if (number >= bug.buffers.size()) return "a buffer that there is not";
  for (const Image& image : bug.images)
    if (std::string fault = fault_of_image(image); !fault.empty()) return fault;
  for (const View& view : bug.views) {
    if (view.image >= bug.images.size()) return "a view of no image";
    for (const std::uint8_t component : view.swizzle)
      if (component > 5) return "a component that there is not";
  }
  for (const BufferView& view : bug.buffer_views)
    if (view.buffer >= bug.buffers.size() || !inside(view.offset, view.range, bug.buffers[view.buffer].size))
      return "a view outside of its buffer";
  return {};
}

std::string fault_of_stages(const Bug& bug) {
  if (bug.stages.empty()) return "no shader";
  for (const Stage& stage : bug.stages) {
    if (size_of(stage.words) % 4 != 0 || size_of(stage.words) < 20) return "a shader that is none";
    for (const VkSpecializationMapEntry& entry : stage.constants)
      if (!inside(entry.offset, entry.size, size_of(stage.constant_data))) return "a constant without a value";
  }
  return {};
}

const Binding* find_binding(const SetLayout& set, std::uint32_t number) {
  const auto at = std::ranges::find(set.bindings, number, &Binding::binding);
  return at == set.bindings.end() ? nullptr : &*at;
}

std::string fault_of_descriptors(const Bug& bug) {
  for (const SetLayout& set : bug.sets)
    for (const Binding& binding : set.bindings) {
      if (binding.count > 1u << 24) return "more descriptors than there can be";
      if (!binding.samplers.empty() && binding.samplers.size() != binding.count) return "too few samplers";
      for (const std::uint32_t sampler : binding.samplers)
        if (sampler >= bug.samplers.size()) return "a sampler that there is not";
    }
  for (const Descriptor& d : bug.descriptors) {
    const Binding* binding = d.set < bug.sets.size() ? find_binding(bug.sets[d.set], d.binding) : nullptr;
    if (!binding) return "a binding that there is not";
    const bool block = kind_of(binding->type) == ResourceKind::kBytes;
    if (block ? size_of(d.bytes) > binding->count : d.element >= binding->count) return "an element that there is not";
    const bool taken = binding->types.empty() || std::ranges::find(binding->types, d.type) != binding->types.end();
    if (!taken || !is_complete(d, type_of(d, *binding))) return "a descriptor of another type";
    if (!names(bug.buffers, d.buffer) || !names(bug.views, d.view) || !names(bug.samplers, d.sampler) ||
        !names(bug.buffer_views, d.texels))
      return "a descriptor of something that there is not";
    if (d.buffer != kNone && !inside(d.offset, d.range, bug.buffers[d.buffer].size))
      return "a descriptor outside of its buffer";
  }
  return {};
}

bool fits(const Bug& bug, const Stream& stream) {
  return names(bug.buffers, stream.buffer) &&
         (stream.buffer == kNone || inside(stream.offset, stream.size, bug.buffers[stream.buffer].size));
}

std::string fault_of_command(const Bug& bug) {
  const Command& c = bug.command;
  const auto all_fit = [&](const std::vector<Stream>& streams) {
    return std::ranges::all_of(streams, [&](const Stream& stream) { return fits(bug, stream); });
  };
  if (!all_fit(bug.streams) || !all_fit(bug.feedback) || !fits(bug, c.indices) || !names(bug.buffers, c.arguments) ||
      !names(bug.buffers, c.count_buffer))
    return "a buffer that there is not";
  for (const Stream& stream : bug.streams)
    if (stream.binding >= raster::kMaxVertexBindings) return "a vertex binding that there is not";
  for (const Stream& stream : bug.feedback)
    if (stream.binding >= spirv::kMaxXfbBuffers || stream.buffer == kNone)
      return "a buffer of transform feedback that there is not";
  std::vector<std::uint32_t> views = bug.rendering.colors;
  views.insert(views.end(), {bug.rendering.depth, bug.rendering.stencil, bug.rendering.rate});
  if (bug.rendering.colors.size() > raster::kMaxColorAttachments) return "too many attachments";
  for (const std::uint32_t view : views)
    if (!names(bug.views, view)) return "an attachment that there is not";
  const raster::State& state = bug.state;
  if (state.attribute_count > raster::kMaxVertexAttributes || state.viewport_count > raster::kMaxViewports ||
      state.locations.count > raster::kMaxSamples)
    return "more state than there is";
  for (const VkPushConstantRange& range : bug.push_ranges)
    if (!inside(range.offset, range.size, spirv::kMaxPushConstantBytes)) return "too many push constants";
  return size_of(bug.push_constants) > spirv::kMaxPushConstantBytes ? "too many push constants" : "";
}

}  // namespace

std::string fault_of(const Bug& bug) {
  for (const auto& part : {fault_of_objects, fault_of_stages, fault_of_descriptors, fault_of_command, fault_of_values})
    if (std::string fault = part(bug); !fault.empty()) return fault;
  return {};
}

}  // namespace vitrine::glass::bug
