// Descriptor set layouts and pipeline layouts (Vulkan 1.3.239, Resource Descriptors: Descriptor Set Layout, Pipeline
// Layouts).
#include <algorithm>
#include <tuple>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/descriptor_bytes.h"
#include "icd/object/image.h"

namespace vitrine::icd {
namespace {

template <class T>
std::shared_ptr<T> make_shape(const HostMemory& memory) {
  return std::allocate_shared<T>(HostAllocator<T>(memory), memory);
}

bool takes_sampler(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_SAMPLER || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

/// Copies the immutable samplers of all bindings into the shape and points the bindings at them.
void copy_immutable_samplers(const VkDescriptorSetLayoutCreateInfo& info, SetShape& shape) {
  const auto samplers_of = [&](const SetBinding& b) -> const VkSampler* {
    const auto* source = std::find_if(info.pBindings, info.pBindings + info.bindingCount,
                                      [&](const VkDescriptorSetLayoutBinding& s) { return s.binding == b.binding; });
    return takes_sampler(b.type) ? source->pImmutableSamplers : nullptr;
  };
  for (const SetBinding& b : shape.bindings) {
    const VkSampler* samplers = samplers_of(b);
    for (std::uint32_t i = 0; samplers && i < b.count; ++i) {
      shape.samplers.push_back(from_handle<Sampler>(samplers[i]).state);
    }
  }
  for (const texel::Sampler& sampler : shape.samplers) shape.sampler_pointers.push_back(&sampler);
  std::size_t next = 0;
  for (SetBinding& b : shape.bindings) {
    if (!samplers_of(b)) continue;
    b.immutable_samplers = shape.sampler_pointers.data() + next;
    next += b.count;
  }
}

/// Gives each binding its slots; inline uniform blocks have one and their bytes beside.
void assign_slots(SetShape& shape) {
  for (SetBinding& b : shape.bindings) {
    std::uint32_t& counter = is_dynamic(b.type) ? shape.dynamic_count : shape.slot_count;
    b.first_slot = counter;
    if (!is_inline_block(b.type)) {
      counter += b.count;
    } else if (b.count) {
      ++counter;
      shape.inline_bytes += (b.count + kInlineBlockAlignment - 1) & ~(kInlineBlockAlignment - 1);
    }
  }
}

/// Bytes of an element in a descriptor buffer. `types`: those that a mutable descriptor may take on, or null: any.
std::uint32_t stride_of(VkDescriptorType type, const VkMutableDescriptorTypeListEXT* types) {
  if (!is_mutable(type)) return descriptor_bytes(type);
  if (!types) return descriptor_bytes(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);  // the largest
  std::uint32_t most = 0;
  for (std::uint32_t i = 0; i < types->descriptorTypeCount; ++i)
    most = std::max(most, descriptor_bytes(types->pDescriptorTypes[i]));
  return most;
}

/// As SetBinding::types.
std::uint32_t bits_of(const VkMutableDescriptorTypeListEXT& types) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < types.descriptorTypeCount; ++i)
    if (types.pDescriptorTypes[i] <= VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT) bits |= 1u << types.pDescriptorTypes[i];
  return bits;
}

/// Where bindings lie in a descriptor buffer: one after the other.
void assign_offsets(SetShape& shape) {
  for (SetBinding& b : shape.bindings) {
    const std::uint64_t alignment = is_inline_block(b.type) ? kInlineBlockAlignment : kDescriptorByteAlignment;
    b.buffer_offset = (shape.buffer_bytes + alignment - 1) & ~(alignment - 1);
    shape.buffer_bytes = b.buffer_offset + std::uint64_t{b.count} * (is_inline_block(b.type) ? 1 : b.stride);
  }
}

std::shared_ptr<const SetShape> make_set_shape(const HostMemory& memory, const VkDescriptorSetLayoutCreateInfo& info) {
  std::shared_ptr<SetShape> shape = make_shape<SetShape>(memory);
  shape->flags = info.flags;
  const auto* flags = find_in_chain<VkDescriptorSetLayoutBindingFlagsCreateInfo>(info.pNext);
  const auto* types = find_in_chain<VkMutableDescriptorTypeCreateInfoEXT>(info.pNext);
  for (std::uint32_t i = 0; i < info.bindingCount; ++i) {
    const VkDescriptorSetLayoutBinding& source = info.pBindings[i];
    SetBinding b;
    b.binding = source.binding;
    b.type = source.descriptorType;
    b.stages = source.stageFlags;
    b.count = source.descriptorCount;
    if (flags && i < flags->bindingCount) b.flags = flags->pBindingFlags[i];
    const bool listed = types && i < types->mutableDescriptorTypeListCount;
    b.stride = stride_of(b.type, listed ? &types->pMutableDescriptorTypeLists[i] : nullptr);
    if (is_mutable(b.type) && listed) b.types = bits_of(types->pMutableDescriptorTypeLists[i]);
    shape->bindings.push_back(b);
  }
  std::sort(shape->bindings.begin(), shape->bindings.end(),
            [](const SetBinding& a, const SetBinding& b) { return a.binding < b.binding; });
  assign_slots(*shape);
  assign_offsets(*shape);
  copy_immutable_samplers(info, *shape);
  return shape;
}

}  // namespace

std::vector<spirv::SetLayoutInfo> set_layout_infos(const PipelineLayoutShape& layout) {
  std::vector<spirv::SetLayoutInfo> infos(layout.sets.size());
  for (std::uint32_t set = 0; set < layout.sets.size(); ++set) {
    if (!layout.sets[set]) continue;
    for (const SetBinding& b : layout.sets[set]->bindings) {
      if (b.count == 0) continue;
      spirv::BindingInfo info;
      info.binding = b.binding;
      info.type = b.type;
      info.set = is_dynamic(b.type) ? spirv::kDynamicSet : set;
      info.first_slot = is_dynamic(b.type) ? layout.first_dynamic[set] + b.first_slot : b.first_slot;
      info.count = is_inline_block(b.type) ? 1 : b.count;
      info.immutable_samplers = b.immutable_samplers;
      infos[set].bindings.push_back(info);
    }
  }
  return infos;
}

std::shared_ptr<const PipelineLayoutShape> make_layout_shape(const HostMemory& memory,
                                                             std::span<const VkDescriptorSetLayout> sets,
                                                             std::span<const VkPushConstantRange> push_ranges) {
  std::shared_ptr<PipelineLayoutShape> shape = make_shape<PipelineLayoutShape>(memory);
  for (const VkDescriptorSetLayout handle : sets) {
    const auto* set = from_nullable<DescriptorSetLayout>(handle);
    shape->sets.push_back(set ? set->shape : nullptr);
    shape->first_dynamic.push_back(shape->dynamic_count);
    if (set) shape->dynamic_count += set->shape->dynamic_count;
  }
  shape->push_ranges.assign(push_ranges.begin(), push_ranges.end());
  std::sort(shape->push_ranges.begin(), shape->push_ranges.end(), [](const auto& a, const auto& b) {
    return std::tie(a.offset, a.size, a.stageFlags) < std::tie(b.offset, b.size, b.stageFlags);
  });
  return shape;
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateDescriptorSetLayout(VkDevice device, const VkDescriptorSetLayoutCreateInfo* info,
                                                         const VkAllocationCallbacks* allocator,
                                                         VkDescriptorSetLayout* layout) {
  Device& d = from_handle<Device>(device);
  Owned<DescriptorSetLayout> object(create_object<DescriptorSetLayout>(d.memory, allocator));
  object->shape = make_set_shape(d.memory, *info);
  *layout = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyDescriptorSetLayout(VkDevice, VkDescriptorSetLayout layout,
                                                      const VkAllocationCallbacks*) {
  destroy_handle<DescriptorSetLayout>(layout);
}

VKAPI_ATTR void VKAPI_CALL GetDescriptorSetLayoutSizeEXT(VkDevice, VkDescriptorSetLayout layout, VkDeviceSize* bytes) {
  *bytes = from_handle<DescriptorSetLayout>(layout).shape->buffer_bytes;
}

VKAPI_ATTR void VKAPI_CALL GetDescriptorSetLayoutBindingOffsetEXT(VkDevice, VkDescriptorSetLayout layout,
                                                                  std::uint32_t number, VkDeviceSize* offset) {
  const Vector<SetBinding>& bindings = from_handle<DescriptorSetLayout>(layout).shape->bindings;
  const auto at = std::ranges::find(bindings, number, &SetBinding::binding);
  *offset = at == bindings.end() ? 0 : at->buffer_offset;
}

VKAPI_ATTR VkResult VKAPI_CALL CreatePipelineLayout(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                                                    const VkAllocationCallbacks* allocator, VkPipelineLayout* layout) {
  Device& d = from_handle<Device>(device);
  Owned<PipelineLayout> object(create_object<PipelineLayout>(d.memory, allocator));
  object->shape = make_layout_shape(d.memory, {info->pSetLayouts, info->setLayoutCount},
                                    {info->pPushConstantRanges, info->pushConstantRangeCount});
  *layout = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyPipelineLayout(VkDevice, VkPipelineLayout layout, const VkAllocationCallbacks*) {
  destroy_handle<PipelineLayout>(layout);
}

}  // namespace entry
}  // namespace vitrine::icd
