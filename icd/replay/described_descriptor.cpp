// Descriptors in words, for findings: kind, name, where it is bound, how large it is.
#include "icd/object/address_book.h"
#include "icd/object/image.h"
#include "icd/object/memory.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {
namespace {

const char* kind_of(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return "sampler";
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
      return "combined image sampler";
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return "sampled image";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "storage image";
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
      return "uniform texel buffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      return "storage texel buffer";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
      return "uniform buffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      return "storage buffer";
    case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
      return "input attachment";
    case VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK:
      return "inline uniform block";
    case VK_DESCRIPTOR_TYPE_MUTABLE_EXT:
      return "mutable descriptor";
    default:
      return "descriptor";
  }
}

/// What is known of the thing behind a descriptor.
struct Thing {
  std::string name, size;
};

/// The object that a descriptor points into; null: unknown.
template <class T>
const T* find_object(const Device& device, const void* first, std::uint64_t bytes) {
  const ObjectRef found = device.addresses ? device.addresses->find(first, bytes) : ObjectRef{};
  return found.handle && found.type == T::kType ? reinterpret_cast<const T*>(found.handle) : nullptr;
}

template <class T>
std::string name_of(const Device& device, const T* object) {
  return object ? icd::name_of(device.physical_device.instance, ref(*object)) : std::string();
}

Thing describe_buffer(const Device& device, const spirv::Descriptor& descriptor) {
  const auto* buffer = find_object<Buffer>(device, descriptor.data, descriptor.size);
  Thing out{name_of(device, buffer), std::to_string(descriptor.size) + " bytes"};
  if (buffer && descriptor.data != buffer->data)
    out.size.append(" at offset ").append(std::to_string(descriptor.data - buffer->data));
  return out;
}

Thing describe_texels(const Device& device, const texel::BufferTexelView& texels) {
  const auto* view = find_object<BufferView>(device, &texels, sizeof texels);
  Thing out{name_of(device, view), std::to_string(texels.count) + " texels of " + texels.format->name};
  const std::uint64_t bytes = std::uint64_t{texels.count} * texels.format->block_bytes;
  if (out.name.empty()) out.name = name_of(device, find_object<Buffer>(device, texels.data, bytes));
  return out;
}

std::string extent_of(const ImageView& view) {
  const texel::Extent& extent = view.view.level[0].extent;
  std::string out = std::to_string(extent.width);
  if (view.image->desc().type != VK_IMAGE_TYPE_1D) out.append("x").append(std::to_string(extent.height));
  if (view.image->desc().type == VK_IMAGE_TYPE_3D) out.append("x").append(std::to_string(extent.depth));
  if (view.range.layerCount > 1) out.append(", ").append(std::to_string(view.range.layerCount)).append(" layers");
  if (view.range.levelCount > 1) out.append(", ").append(std::to_string(view.range.levelCount)).append(" levels");
  return out.append(", ").append(texel::format_desc(view.format).name);
}

Thing describe_image(const Device& device, const texel::ImageView& image) {
  const auto* view = find_object<ImageView>(device, &image, sizeof image);
  if (!view) return {};
  const std::string name = name_of(device, view);
  return {name.empty() ? name_of(device, view->image) : name, extent_of(*view)};
}

Thing describe_thing(const Device& device, const SetBinding& binding, const spirv::Descriptor& descriptor) {
  if (is_inline_block(binding.type)) return {{}, std::to_string(descriptor.size) + " bytes"};
  if (descriptor.data) return describe_buffer(device, descriptor);
  if (descriptor.texels) return describe_texels(device, *descriptor.texels);
  if (descriptor.image) return describe_image(device, *descriptor.image);
  if (descriptor.sampler) {
    return {name_of(device, find_object<Sampler>(device, descriptor.sampler, sizeof *descriptor.sampler)), {}};
  }
  return {{}, "no resource"};
}

}  // namespace

std::string describe_bytes(const Device& device, const std::byte* first, std::uint64_t size) {
  const auto* buffer = first ? find_object<Buffer>(device, first, size) : nullptr;
  const std::string name = name_of(device, buffer);
  std::string out = name.empty() ? "(" : "'" + name + "' (";
  out.append(std::to_string(size)).append(" bytes");
  if (buffer && first != buffer->data) out.append(" at offset ").append(std::to_string(first - buffer->data));
  return out.append(")");
}

std::string describe_descriptor(const Device& device, std::uint32_t set, const SetBinding& binding,
                                std::uint32_t element, const spirv::Descriptor* descriptor,
                                const std::string& departed) {
  const Thing thing = !departed.empty() ? Thing{{}, departed}
                      : descriptor      ? describe_thing(device, binding, *descriptor)
                                        : Thing{{}, "nothing is bound"};
  std::string out = kind_of(binding.type);
  if (!thing.name.empty()) out.append(" '").append(thing.name).append("'");
  out.append(" (set ").append(std::to_string(set)).append(", binding ").append(std::to_string(binding.binding));
  if (binding.count > 1 && !is_inline_block(binding.type)) out.append("[").append(std::to_string(element)).append("]");
  if (!thing.size.empty()) out.append(", ").append(thing.size);
  return out.append(")");
}

}  // namespace vitrine::icd
