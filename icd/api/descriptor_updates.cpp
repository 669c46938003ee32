// Writing and copying descriptors (Vulkan 1.3.239, Resource Descriptors: Descriptor Set Updates).
#include <algorithm>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/address_book.h"
#include "icd/object/descriptors.h"
#include "icd/object/image.h"
#include "icd/object/memory.h"

namespace vitrine::icd {
namespace {

/// Walks the array elements of a set from one binding on: where a binding ends, the next one that has elements goes on
/// ("consecutive binding updates").
class ElementCursor {
 public:
  ElementCursor(const DescriptorSet& set, std::uint32_t binding, std::uint32_t element)
      : set_(set),
        at_(std::lower_bound(set.shape->bindings.begin(), set.shape->bindings.end(), binding,
                             [](const SetBinding& b, std::uint32_t number) { return b.binding < number; })),
        end_(set.shape->bindings.end()),
        element_(element) {
    settle();
  }

  bool valid() const { return at_ != end_; }
  const SetBinding& binding() const { return *at_; }
  std::uint32_t slot() const { return at_->first_slot + element_; }
  /// Of an inline uniform block, whose elements are bytes.
  std::byte* byte() const { return set_.slots[at_->first_slot].data + element_; }
  void advance() {
    ++element_;
    settle();
  }

 private:
  void settle() {
    while (at_ != end_ && element_ >= set_.count_of(*at_)) {
      element_ -= set_.count_of(*at_);
      ++at_;
    }
  }

  const DescriptorSet& set_;
  Vector<SetBinding>::const_iterator at_, end_;
  std::uint32_t element_;
};

/// `type`: the binding's, or the one that a mutable descriptor takes on.
void write_image(const VkDescriptorImageInfo& info, VkDescriptorType type, const SetBinding& binding,
                 spirv::Descriptor& slot) {
  if (type != VK_DESCRIPTOR_TYPE_SAMPLER) {
    const auto* view = from_nullable<ImageView>(info.imageView);
    slot.image = !view ? nullptr : type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ? &view->stored() : &view->view;
  }
  const bool has_sampler = type == VK_DESCRIPTOR_TYPE_SAMPLER || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  if (has_sampler && !binding.immutable_samplers) {
    const auto* sampler = from_nullable<Sampler>(info.sampler);
    slot.sampler = sampler ? &sampler->state : nullptr;
  }
}

void write_texel_buffer(VkBufferView handle, spirv::Descriptor& slot) {
  const auto* view = from_nullable<BufferView>(handle);
  slot.texels = view ? &view->view : nullptr;
}

void write_buffer(const VkDescriptorBufferInfo& info, spirv::Descriptor& slot) {
  const auto* buffer = from_nullable<Buffer>(info.buffer);
  const bool bound = buffer && buffer->data;
  slot.data = bound ? buffer->data + info.offset : nullptr;
  slot.size = bound ? buffer->resolve_range(info.offset, info.range) : 0;
}

void write_dynamic_buffer(const VkDescriptorBufferInfo& info, DynamicBuffer& out) {
  const auto* buffer = from_nullable<Buffer>(info.buffer);
  out = {};
  if (!buffer || !buffer->data) return;
  out.data = buffer->data + info.offset;
  out.range = info.range;
  out.available = buffer->resolve_range(info.offset, VK_WHOLE_SIZE);
}

void write_element(const VkWriteDescriptorSet& write, std::uint32_t i, const ElementCursor& at, DescriptorSet& set) {
  if (is_mutable(at.binding().type)) set.slots[at.slot()] = {};
  switch (write.descriptorType) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      return write_texel_buffer(write.pTexelBufferView[i], set.slots[at.slot()]);
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return write_buffer(write.pBufferInfo[i], set.slots[at.slot()]);
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      return write_dynamic_buffer(write.pBufferInfo[i], set.dynamic[at.slot()]);
    default:
      return write_image(write.pImageInfo[i], write.descriptorType, at.binding(), set.slots[at.slot()]);
  }
}

/// When the descriptor at the cursor was written.
std::uint64_t& time_of(DescriptorSet& set, const ElementCursor& at) {
  return is_dynamic(at.binding().type) ? set.written_dynamic(at.slot()) : set.written_slot(at.slot());
}

void write_inline_block(const VkWriteDescriptorSet& write, DescriptorSet& set) {
  const auto* block = find_in_chain<VkWriteDescriptorSetInlineUniformBlock>(write.pNext);
  if (!block) return;
  const auto* source = static_cast<const std::byte*>(block->pData);
  ElementCursor at(set, write.dstBinding, write.dstArrayElement);
  for (std::uint32_t i = 0; i < block->dataSize && at.valid(); ++i, at.advance()) {
    if (!is_inline_block(at.binding().type)) return;
    *at.byte() = source[i];
  }
}

void copy_descriptors(const VkCopyDescriptorSet& copy) {
  DescriptorSet& source_set = from_handle<DescriptorSet>(copy.srcSet);
  DescriptorSet& target_set = from_handle<DescriptorSet>(copy.dstSet);
  ElementCursor source(source_set, copy.srcBinding, copy.srcArrayElement);
  ElementCursor target(target_set, copy.dstBinding, copy.dstArrayElement);
  for (std::uint32_t i = 0; i < copy.descriptorCount && source.valid() && target.valid();
       ++i, source.advance(), target.advance()) {
    const VkDescriptorType type = target.binding().type;
    if (!takes_type(type, source.binding().type)) return;
    if (target_set.written && source_set.written && !is_inline_block(type))
      time_of(target_set, target) = time_of(source_set, source);
    if (is_dynamic(type)) {
      target_set.dynamic[target.slot()] = source_set.dynamic[source.slot()];
      continue;
    }
    if (is_inline_block(type)) {
      *target.byte() = *source.byte();
      continue;
    }
    spirv::Descriptor& slot = target_set.slots[target.slot()];
    const texel::Sampler* immutable = target.binding().immutable_samplers ? slot.sampler : nullptr;
    slot = source_set.slots[source.slot()];
    if (immutable) slot.sampler = immutable;
  }
}

}  // namespace

void write_descriptors(const VkWriteDescriptorSet& write, DescriptorSet& set) {
  if (is_inline_block(write.descriptorType)) return write_inline_block(write, set);
  ElementCursor at(set, write.dstBinding, write.dstArrayElement);
  for (std::uint32_t i = 0; i < write.descriptorCount && at.valid(); ++i, at.advance()) {
    // The types agree in every valid call; where they do not, a slot must not change its meaning.
    if (!takes_type(at.binding().type, write.descriptorType)) return;
    write_element(write, i, at, set);
    if (set.written) time_of(set, at) = AddressBook::clock();
  }
}

spirv::Descriptor apply_offset(const DynamicBuffer& buffer, std::uint32_t offset) {
  spirv::Descriptor out;
  if (!buffer.data || offset >= buffer.available) return out;
  out.data = buffer.data + offset;
  out.size = std::min(buffer.range, buffer.available - offset);
  return out;
}

namespace entry {

VKAPI_ATTR void VKAPI_CALL UpdateDescriptorSets(VkDevice, std::uint32_t write_count, const VkWriteDescriptorSet* writes,
                                                std::uint32_t copy_count, const VkCopyDescriptorSet* copies) {
  for (std::uint32_t i = 0; i < write_count; ++i) {
    write_descriptors(writes[i], from_handle<DescriptorSet>(writes[i].dstSet));
  }
  for (std::uint32_t i = 0; i < copy_count; ++i) copy_descriptors(copies[i]);
}

}  // namespace entry
}  // namespace vitrine::icd
