// VkDescriptorSetLayout, VkDescriptorPool, VkDescriptorSet, VkPipelineLayout: which resources shaders see.
//
// Layouts are short-lived handles around shared, immutable shapes: sets and pipelines outlive the layouts they were
// made from (Vulkan 1.3.239, Object Lifetime), so they hold the shape.
#pragma once

#include <memory>
#include <span>

#include "icd/object/device.h"
#include "spirv/compile.h"
#include "spirv/resources.h"

namespace vitrine::icd {

/// One binding of a set. Slots of dynamic buffers count apart from the others.
struct SetBinding {
  std::uint32_t binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLER;
  VkShaderStageFlags stages = 0;
  /// Array elements, or bytes of an inline uniform block (one slot); 0 is a hole. Of a binding with a variable count:
  /// at most.
  std::uint32_t count = 0;
  VkDescriptorBindingFlags flags = 0;
  std::uint32_t first_slot = 0;                               ///< among the set's slots, or among its dynamic buffers
  const texel::Sampler* const* immutable_samplers = nullptr;  ///< `count` of them, or null
  std::uint32_t types =
      0;  ///< that mutable descriptors may take on as the layout lists them: 1 << VkDescriptorType each
  /// In a descriptor buffer: bytes of an element, and from the set's first byte to the first element.
  std::uint32_t stride = 0;
  std::uint64_t buffer_offset = 0;
};

inline bool is_dynamic(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}

inline bool is_inline_block(VkDescriptorType type) { return type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK; }

/// Whether descriptors of any type but those above may be written (VK_EXT_mutable_descriptor_type): slots have room for
/// each, so that the list of types that a binding declares is of no account.
inline bool is_mutable(VkDescriptorType type) { return type == VK_DESCRIPTOR_TYPE_MUTABLE_EXT; }

/// Whether a descriptor of a type may be written to, or copied to or from, a binding of another.
inline bool takes_type(VkDescriptorType binding, VkDescriptorType type) {
  return binding == type || (is_mutable(binding) && !is_dynamic(type) && !is_inline_block(type)) ||
         (is_mutable(type) && !is_dynamic(binding) && !is_inline_block(binding));
}

struct SetShape {
  explicit SetShape(const HostMemory& m) : bindings(m), samplers(m), sampler_pointers(m) {}

  Vector<SetBinding> bindings;      ///< ascending binding numbers
  Vector<texel::Sampler> samplers;  ///< copies of the immutable ones
  Vector<const texel::Sampler*> sampler_pointers;
  std::uint32_t slot_count = 0;
  std::uint32_t dynamic_count = 0;
  std::uint32_t inline_bytes = 0;  ///< of all inline uniform blocks, each aligned to kInlineBlockAlignment
  std::uint64_t buffer_bytes = 0;  ///< in a descriptor buffer
  VkDescriptorSetLayoutCreateFlags flags = 0;

  /// The binding whose count each set chooses, or null.
  const SetBinding* variable_binding() const {
    const bool variable =
        !bindings.empty() && (bindings.back().flags & VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT);
    return variable ? &bindings.back() : nullptr;
  }
};
inline constexpr std::uint32_t kInlineBlockAlignment = 16;

struct DescriptorSetLayout : Object<VkDescriptorSetLayout, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT> {
  using Object::Object;
  std::shared_ptr<const SetShape> shape;
};

struct PipelineLayoutShape {
  explicit PipelineLayoutShape(const HostMemory& m) : sets(m), first_dynamic(m), push_ranges(m) {}

  Vector<std::shared_ptr<const SetShape>> sets;  ///< by set number; may hold nulls
  Vector<std::uint32_t> first_dynamic;           ///< kDynamicSet slot of each set's first dynamic buffer
  std::uint32_t dynamic_count = 0;
  Vector<VkPushConstantRange> push_ranges;  ///< in an order of their own: layouts with the same ones are compatible
};

struct PipelineLayout : Object<VkPipelineLayout, VK_OBJECT_TYPE_PIPELINE_LAYOUT> {
  using Object::Object;
  std::shared_ptr<const PipelineLayoutShape> shape;
};

/// The shape of a pipeline layout, or of what a shader object has in its place.
std::shared_ptr<const PipelineLayoutShape> make_layout_shape(const HostMemory& memory,
                                                             std::span<const VkDescriptorSetLayout> sets,
                                                             std::span<const VkPushConstantRange> push_ranges);

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
  DescriptorPool* pool = nullptr;     ///< null: pushed, lies in a command buffer
  std::uint32_t variable_count = 0;   ///< elements (or bytes) of the shape's variable binding
  std::uint32_t slot_count = 0;       ///< without the elements that a variable binding does not have here
  DescriptorSet* previous = nullptr;  ///< the pool's list of live sets
  DescriptorSet* next = nullptr;
  spirv::Descriptor* slots = nullptr;
  DynamicBuffer* dynamic = nullptr;
  std::byte* inline_data = nullptr;
  /// When each slot, then each dynamic buffer, was written, by AddressBook::clock(); null: no tool is on.
  std::uint64_t* written = nullptr;

  std::uint64_t& written_slot(std::uint32_t slot) { return written[slot]; }
  std::uint64_t& written_dynamic(std::uint32_t number) { return written[slot_count + number]; }
  /// Elements (or bytes) that this set has of a binding of its shape.
  std::uint32_t count_of(const SetBinding& binding) const {
    return &binding == shape->variable_binding() ? variable_count : binding.count;
  }
};

/// Bytes of a set of this shape, and a set in that many bytes of memory: every descriptor null but for immutable
/// samplers. `variable_count` as in DescriptorSet.
std::size_t set_bytes(const SetShape& shape, std::uint32_t variable_count);
DescriptorSet* construct_set(void* storage, const HostMemory& memory, const std::shared_ptr<const SetShape>& shape,
                             std::uint32_t variable_count);

/// vkUpdateDescriptorSets' writes, to `set` instead of dstSet.
void write_descriptors(const VkWriteDescriptorSet& write, DescriptorSet& set);

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
