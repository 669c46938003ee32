// See descriptor_bytes.h. A descriptor is words of 64 bits: its kind in the top byte of the first, below it an address
// or a name; then the range of a buffer, or the name of the sampler of a combined image sampler; then the format of a
// texel buffer.
#include "icd/object/descriptor_bytes.h"

#include <algorithm>
#include <cstring>

#include "icd/properties.h"
#include "spirv/addresses.h"

namespace vitrine::icd {
namespace {

enum class Kind : std::uint8_t { kNone, kSampler, kImage, kStorageImage, kBuffer, kTexels };

constexpr unsigned kKindShift = 56;
constexpr std::uint64_t kValueMask = (std::uint64_t{1} << kKindShift) - 1;

using Words = std::array<std::uint64_t, 3>;

std::uint64_t first_word(Kind kind, std::uint64_t value) {
  return value == 0 ? 0 : std::uint64_t{static_cast<std::uint8_t>(kind)} << kKindShift | (value & kValueMask);
}

Kind kind_of(std::uint64_t word) { return static_cast<Kind>(word >> kKindShift); }

/// 0 for a null handle.
template <class T>
std::uint64_t name_of(NamedObjects<T>& objects, typename T::Handle handle) {
  T* const object = from_nullable<T>(handle);
  return object ? objects.name_of(*object) : 0;
}

Words buffer_words(Kind kind, const VkDescriptorAddressInfoEXT* info) {
  if (!info || info->address == 0) return {};
  return {first_word(kind, info->address), info->range, static_cast<std::uint32_t>(info->format)};
}

Words words_of(DescribedObjects& objects, const VkDescriptorGetInfoEXT& info) {
  const VkDescriptorDataEXT& data = info.data;
  const auto image = [&](Kind kind, const VkDescriptorImageInfo* of) -> Words {
    return {of ? first_word(kind, name_of(objects.views, of->imageView)) : 0};
  };
  switch (info.type) {
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return {data.pSampler ? first_word(Kind::kSampler, name_of(objects.samplers, *data.pSampler)) : 0};
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER: {
      Words words = image(Kind::kImage, data.pCombinedImageSampler);
      if (const auto* of = data.pCombinedImageSampler)
        words[1] = first_word(Kind::kSampler, name_of(objects.samplers, of->sampler));
      return words;
    }
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return image(Kind::kImage, data.pSampledImage);
    case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
      return image(Kind::kImage, data.pInputAttachmentImage);
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return image(Kind::kStorageImage, data.pStorageImage);
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
      return buffer_words(Kind::kTexels, data.pUniformTexelBuffer);
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      return buffer_words(Kind::kTexels, data.pStorageTexelBuffer);
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return buffer_words(Kind::kBuffer, data.pUniformBuffer);
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return buffer_words(Kind::kBuffer, data.pStorageBuffer);
    default:
      return {};
  }
}

/// The memory at an address, as far as it reaches and `range` asks.
spirv::AddressRange memory_at(std::uint64_t address, std::uint64_t range) {
  const spirv::AddressRange memory = spirv::find_addresses(address);
  if (address < memory.begin || address >= memory.end) return {};
  return {address, address + std::min(range, memory.end - address)};
}

void read_buffer(const Words& words, spirv::Descriptor& slot) {
  const spirv::AddressRange memory = memory_at(words[0] & kValueMask, words[1]);
  slot.data = reinterpret_cast<std::byte*>(memory.begin);
  slot.size = memory.end - memory.begin;
}

void read_texels(const Words& words, texel::BufferTexelView& view, spirv::Descriptor& slot) {
  const texel::FormatDesc& format = texel::view_format_desc(static_cast<VkFormat>(words[2]));
  if (format.block_bytes == 0) return;
  const spirv::AddressRange memory = memory_at(words[0] & kValueMask, words[1]);
  view = {};
  view.data = reinterpret_cast<std::byte*>(memory.begin);
  view.count = (memory.end - memory.begin) / format.block_bytes;
  view.format = &format;
  slot.texels = &view;
}

/// What a binding of this type takes of the words: what is of another kind is null.
bool takes(VkDescriptorType type, Kind kind) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return kind == Kind::kSampler;
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
    case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
      return kind == Kind::kImage;
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return kind == Kind::kStorageImage;
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      return kind == Kind::kTexels;
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return kind == Kind::kBuffer;
    case VK_DESCRIPTOR_TYPE_MUTABLE_EXT:
      return kind <= Kind::kTexels;
    default:
      return false;
  }
}

/// Reads the elements of bindings.
class SetReader {
 public:
  SetReader(const DescribedObjects& objects, DescriptorBytes bytes, DescriptorSet& set, texel::BufferTexelView* texels)
      : views_(objects.views), samplers_(objects.samplers), bytes_(bytes), set_(set), texels_(texels) {}

  /// Slots [first, end) as far as they are the binding's.
  void read(const SetBinding& binding, std::uint32_t first, std::uint32_t end) const {
    if (is_inline_block(binding.type)) {
      if (binding.count && first <= binding.first_slot && binding.first_slot < end) read_block(binding);
      return;
    }
    first = std::max(first, binding.first_slot);
    end = std::min({end, binding.first_slot + binding.count, set_.slot_count});
    for (std::uint32_t slot = first; slot < end; ++slot) read_element(binding, slot);
  }

 private:
  void read_block(const SetBinding& binding) const {
    spirv::Descriptor& slot = set_.slots[binding.first_slot];
    const bool there = binding.buffer_offset < bytes_.size;
    slot.data = there ? const_cast<std::byte*>(bytes_.first) + binding.buffer_offset : nullptr;
    slot.size = there ? std::min<std::uint64_t>(binding.count, bytes_.size - binding.buffer_offset) : 0;
  }

  void read_element(const SetBinding& binding, std::uint32_t slot) const {
    spirv::Descriptor& out = set_.slots[slot];
    const std::uint32_t element = slot - binding.first_slot;
    out = {};
    if (binding.immutable_samplers) out.sampler = binding.immutable_samplers[element];
    const std::uint64_t offset = binding.buffer_offset + std::uint64_t{element} * binding.stride;
    if (offset + binding.stride > bytes_.size) return;
    Words words{};
    std::memcpy(words.data(), bytes_.first + offset, std::min<std::size_t>(binding.stride, sizeof words));
    if (takes(binding.type, kind_of(words[0]))) read_resource(words, slot, out);
    const bool combined = binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER || is_mutable(binding.type);
    if (combined && !binding.immutable_samplers && kind_of(words[1]) == Kind::kSampler) out.sampler = sampler(words[1]);
  }

  void read_resource(const Words& words, std::uint32_t slot, spirv::Descriptor& out) const {
    switch (kind_of(words[0])) {
      case Kind::kSampler:
        if (!out.sampler) out.sampler = sampler(words[0]);
        return;
      case Kind::kImage:
        if (const ImageView* view = this->view(words[0])) out.image = &view->view;
        return;
      case Kind::kStorageImage:
        if (const ImageView* view = this->view(words[0])) out.image = &view->stored();
        return;
      case Kind::kBuffer:
        return read_buffer(words, out);
      case Kind::kTexels:
        if (texels_) read_texels(words, texels_[slot], out);
        return;
      default:
        return;
    }
  }

  const ImageView* view(std::uint64_t word) const { return views_.find(word & kValueMask); }
  const texel::Sampler* sampler(std::uint64_t word) const {
    const Sampler* object = samplers_.find(word & kValueMask);
    return object ? &object->state : nullptr;
  }

  NamedObjects<ImageView>::Reader views_;
  NamedObjects<Sampler>::Reader samplers_;
  DescriptorBytes bytes_;
  DescriptorSet& set_;
  texel::BufferTexelView* texels_;
};

}  // namespace

std::uint32_t descriptor_bytes(VkDescriptorType type) {
  constexpr const auto& claimed = kClaimedPhysicalDeviceDescriptorBufferPropertiesEXT;
  static_assert(claimed.uniformTexelBufferDescriptorSize == sizeof(Words), "the largest");
  const auto size = [&] {
    switch (type) {
      case VK_DESCRIPTOR_TYPE_SAMPLER:
        return claimed.samplerDescriptorSize;
      case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
        return claimed.sampledImageDescriptorSize;
      case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
        return claimed.storageImageDescriptorSize;
      case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
        return claimed.inputAttachmentDescriptorSize;
      case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
        return claimed.combinedImageSamplerDescriptorSize;
      case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
        return claimed.uniformBufferDescriptorSize;
      case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
        return claimed.storageBufferDescriptorSize;
      case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
        return claimed.uniformTexelBufferDescriptorSize;
      case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
        return claimed.storageTexelBufferDescriptorSize;
      default:
        return std::size_t{0};
    }
  };
  return static_cast<std::uint32_t>(size());
}

void write_descriptor_bytes(DescribedObjects& objects, const VkDescriptorGetInfoEXT& info, std::size_t size,
                            void* out) {
  const Words words = words_of(objects, info);
  std::memcpy(out, words.data(), std::min<std::size_t>(size, descriptor_bytes(info.type)));
}

void read_descriptor_bytes(const DescribedObjects& objects, DescriptorBytes bytes, DescriptorSet& set,
                           texel::BufferTexelView* texels, std::uint32_t first, std::uint32_t end) {
  const SetReader reader(objects, bytes, set, texels);
  for (const SetBinding& binding : set.shape->bindings) reader.read(binding, first, end);
}

bool may_have_texel_buffers(const SetShape& shape) {
  return std::ranges::any_of(shape.bindings, [](const SetBinding& binding) {
    return binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER ||
           binding.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER || is_mutable(binding.type);
  });
}

}  // namespace vitrine::icd
