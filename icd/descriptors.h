// VkDescriptorSetLayout, VkDescriptorPool, VkDescriptorSet, VkPipelineLayout: which resources shaders see.
//
// Layouts are short-lived handles around shared, immutable shapes: sets and pipelines outlive the layouts they were
// made from (Vulkan 1.3.239, Object Lifetime), so they hold the shape.
#pragma once

#include <memory>
#include <span>

#include "icd/device.h"
#include "spirv/compile.h"
#include "spirv/resources.h"

namespace vitrine::icd {

/// One binding of a set. Slots of dynamic buffers count apart from the others.
struct SetBinding {
  std::uint32_t binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLER;
  VkShaderStageFlags stages = 0;
  std::uint32_t count = 0;                                    ///< array elements; 0 is a hole
  std::uint32_t first_slot = 0;                               ///< among the set's slots, or among its dynamic buffers
  const texel::Sampler* const* immutable_samplers = nullptr;  ///< `count` of them, or null
};

inline bool is_dynamic(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}

struct SetShape {
  explicit SetShape(const HostMemory& m) : bindings(m), samplers(m), sampler_pointers(m) {}

  Vector<SetBinding> bindings;      ///< ascending binding numbers
  Vector<texel::Sampler> samplers;  ///< copies of the immutable ones
  Vector<const texel::Sampler*> sampler_pointers;
  std::uint32_t slot_count = 0;
  std::uint32_t dynamic_count = 0;
};

struct DescriptorSetLayout : Object<VkDescriptorSetLayout, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT> {
  using Object::Object;
  std::shared_ptr<const SetShape> shape;
};

struct PipelineLayoutShape {
  explicit PipelineLayoutShape(const HostMemory& m) : sets(m), first_dynamic(m) {}

  Vector<std::shared_ptr<const SetShape>> sets;  ///< by set number; may hold nulls
  Vector<std::uint32_t> first_dynamic;           ///< kDynamicSet slot of each set's first dynamic buffer
  std::uint32_t dynamic_count = 0;
};

struct PipelineLayout : Object<VkPipelineLayout, VK_OBJECT_TYPE_PIPELINE_LAYOUT> {
  using Object::Object;
  std::shared_ptr<const PipelineLayoutShape> shape;
};

/// The layout as spirv::compile() wants it.
std::vector<spirv::SetLayoutInfo> set_layout_infos(const PipelineLayoutShape& layout);

/// A dynamic buffer as written: the dynamic offset is still to come.
struct DynamicBuffer {
  std::byte* data = nullptr;
  std::uint64_t range = 0;      ///< bytes, or VK_WHOLE_SIZE
  std::uint64_t available = 0;  ///< bytes from `data` to the end of the buffer
};

/// What shaders see of a dynamic buffer at `offset`. Never reaches past the buffer.
spirv::Descriptor apply_offset(const DynamicBuffer& buffer, std::uint32_t offset);

struct DescriptorPool;

/// Header of one allocation of the pool; slots and dynamic buffers follow it in the same memory.
struct DescriptorSet : Object<VkDescriptorSet, VK_OBJECT_TYPE_DESCRIPTOR_SET> {
  using Object::Object;

  std::shared_ptr<const SetShape> shape;
  DescriptorPool* pool = nullptr;
  DescriptorSet* previous = nullptr;  ///< the pool's list of live sets
  DescriptorSet* next = nullptr;
  spirv::Descriptor* slots = nullptr;
  DynamicBuffer* dynamic = nullptr;
};

/// Counts what is allocated against what the application asked for at creation; memory itself is the heap's, so a pool
/// never fragments.
struct DescriptorPool : Object<VkDescriptorPool, VK_OBJECT_TYPE_DESCRIPTOR_POOL> {
  explicit DescriptorPool(const HostMemory& m) : Object(m), capacity(m) {}
  ~DescriptorPool();

  struct Capacity {
    VkDescriptorType type;
    std::uint32_t free;
    std::uint32_t total;
  };
  Vector<Capacity> capacity;  ///< one per descriptor type of the pool
  std::uint32_t free_sets = 0;
  DescriptorSet* sets = nullptr;
};

}  // namespace vitrine::icd
