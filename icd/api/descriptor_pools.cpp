// Descriptor pools and the allocation of sets (Vulkan 1.3.239, Resource Descriptors: Allocation of Descriptor Sets).
#include <algorithm>

#include "glass/session.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/descriptors.h"

namespace vitrine::icd {
namespace {

DescriptorPool::Capacity* find_capacity(DescriptorPool& pool, VkDescriptorType type) {
  for (DescriptorPool::Capacity& c : pool.capacity) {
    if (c.type == type) return &c;
  }
  return nullptr;
}

void give_back(DescriptorPool& pool, const DescriptorSet& set) {
  for (const SetBinding& b : set.shape->bindings) {
    const std::uint32_t count = set.count_of(b);
    if (count == 0) continue;
    if (DescriptorPool::Capacity* c = find_capacity(pool, b.type)) c->free += count;
  }
  ++pool.free_sets;
}

/// Whether the pool has the descriptors of a set left. Bindings of one type add up. Inline uniform blocks are counted
/// in bytes alone: a block needs nothing else, and applications pass too few bindings unnoticed on other drivers.
bool has_capacity(DescriptorPool& pool, const SetShape& shape, std::uint32_t variable_count) {
  if (pool.free_sets == 0) return false;
  for (const SetBinding& b : shape.bindings) {
    std::uint64_t wanted = 0;
    for (const SetBinding& other : shape.bindings) {
      const bool variable = &other == shape.variable_binding();
      if (other.type == b.type) wanted += variable ? variable_count : other.count;
    }
    const DescriptorPool::Capacity* c = find_capacity(pool, b.type);
    if (wanted > (c ? c->free : 0)) return false;
  }
  return true;
}

void take(DescriptorPool& pool, const DescriptorSet& set) {
  for (const SetBinding& b : set.shape->bindings) {
    const std::uint32_t count = set.count_of(b);
    if (count == 0) continue;
    find_capacity(pool, b.type)->free -= count;
  }
  --pool.free_sets;
}

/// What a set of this shape has in place of the shape's own counts.
struct SetSizes {
  std::uint32_t slots, dynamic, inline_bytes;
  std::uint32_t times = 0;  ///< tools are on: when each was written
};

SetSizes sizes_of(const SetShape& shape, std::uint32_t variable_count) {
  SetSizes sizes{shape.slot_count, shape.dynamic_count, shape.inline_bytes};
  const SetBinding* variable = shape.variable_binding();
  // The last binding has the last slots. Blocks keep their bytes: the slot says how many count.
  if (variable && !is_inline_block(variable->type) && variable_count < variable->count) {
    sizes.slots -= variable->count - variable_count;
  }
  if (!glass::session().idle()) sizes.times = sizes.slots + sizes.dynamic;
  return sizes;
}

/// Points the slots of inline uniform blocks at their bytes.
void place_inline_blocks(DescriptorSet& set) {
  std::uint32_t offset = 0;
  for (const SetBinding& b : set.shape->bindings) {
    if (!is_inline_block(b.type) || b.count == 0) continue;
    spirv::Descriptor& slot = set.slots[b.first_slot];
    slot.data = set.inline_data + offset;
    slot.size = set.count_of(b);
    offset += (b.count + kInlineBlockAlignment - 1) & ~(kInlineBlockAlignment - 1);
  }
}

void write_immutable_samplers(DescriptorSet& set) {
  for (const SetBinding& b : set.shape->bindings) {
    for (std::uint32_t i = 0; b.immutable_samplers && i < set.count_of(b); ++i) {
      set.slots[b.first_slot + i].sampler = b.immutable_samplers[i];
    }
  }
}

DescriptorSet* make_set(DescriptorPool& pool, const std::shared_ptr<const SetShape>& shape,
                        std::uint32_t variable_count) {
  void* storage = pool.memory.allocate(set_bytes(*shape, variable_count), alignof(DescriptorSet),
                                       VK_SYSTEM_ALLOCATION_SCOPE_OBJECT);
  DescriptorSet* set = construct_set(storage, pool.memory, shape, variable_count);
  set->pool = &pool;
  set->next = pool.sets;
  if (pool.sets) pool.sets->previous = set;
  pool.sets = set;
  take(pool, *set);
  return set;
}

void free_set(DescriptorSet* set) {
  DescriptorPool& pool = *set->pool;
  give_back(pool, *set);
  (set->previous ? set->previous->next : pool.sets) = set->next;
  if (set->next) set->next->previous = set->previous;
  destroy_object(set);
}

VkResult allocate_sets(DescriptorPool& pool, const VkDescriptorSetAllocateInfo& info, VkDescriptorSet* sets) {
  const auto* counts = find_in_chain<VkDescriptorSetVariableDescriptorCountAllocateInfo>(info.pNext);
  for (std::uint32_t i = 0; i < info.descriptorSetCount; ++i) {
    const std::shared_ptr<const SetShape>& shape = from_handle<DescriptorSetLayout>(info.pSetLayouts[i]).shape;
    std::uint32_t variable_count = counts && i < counts->descriptorSetCount ? counts->pDescriptorCounts[i] : 0;
    if (const SetBinding* b = shape->variable_binding()) variable_count = std::min(variable_count, b->count);
    if (!has_capacity(pool, *shape, variable_count)) return VK_ERROR_OUT_OF_POOL_MEMORY;
    try {
      sets[i] = to_handle(make_set(pool, shape, variable_count));
    } catch (const std::bad_alloc&) {
      return VK_ERROR_OUT_OF_HOST_MEMORY;
    }
  }
  return VK_SUCCESS;
}

}  // namespace

std::size_t set_bytes(const SetShape& shape, std::uint32_t variable_count) {
  const SetSizes sizes = sizes_of(shape, variable_count);
  return sizeof(DescriptorSet) + sizes.inline_bytes + sizeof(spirv::Descriptor) * sizes.slots +
         sizeof(DynamicBuffer) * sizes.dynamic + sizeof(std::uint64_t) * sizes.times;
}

DescriptorSet* construct_set(void* storage, const HostMemory& memory, const std::shared_ptr<const SetShape>& shape,
                             std::uint32_t variable_count) {
  static_assert(sizeof(DescriptorSet) % alignof(spirv::Descriptor) == 0 &&
                kInlineBlockAlignment % alignof(spirv::Descriptor) == 0);
  const SetSizes sizes = sizes_of(*shape, variable_count);
  auto* bytes = static_cast<std::byte*>(storage);
  auto* set = ::new (storage) DescriptorSet(memory);
  set->shape = shape;
  set->variable_count = variable_count;
  set->slot_count = sizes.slots;
  set->inline_data = bytes + sizeof(DescriptorSet);
  set->slots = reinterpret_cast<spirv::Descriptor*>(set->inline_data + sizes.inline_bytes);
  set->dynamic = reinterpret_cast<DynamicBuffer*>(set->slots + sizes.slots);
  std::fill_n(set->inline_data, sizes.inline_bytes, std::byte{});
  std::uninitialized_fill_n(set->slots, sizes.slots, spirv::Descriptor{});
  std::uninitialized_fill_n(set->dynamic, sizes.dynamic, DynamicBuffer{});
  if (sizes.times) {
    set->written = reinterpret_cast<std::uint64_t*>(set->dynamic + sizes.dynamic);
    std::uninitialized_fill_n(set->written, sizes.times, std::uint64_t{0});
  }
  place_inline_blocks(*set);
  write_immutable_samplers(*set);
  return set;
}

DescriptorPool::~DescriptorPool() {
  while (sets) free_set(sets);
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateDescriptorPool(VkDevice device, const VkDescriptorPoolCreateInfo* info,
                                                    const VkAllocationCallbacks* allocator, VkDescriptorPool* pool) {
  Owned<DescriptorPool> object(create_object<DescriptorPool>(from_handle<Device>(device).memory, allocator));
  for (std::uint32_t i = 0; i < info->poolSizeCount; ++i) {
    const VkDescriptorPoolSize& size = info->pPoolSizes[i];
    DescriptorPool::Capacity* c = find_capacity(*object, size.type);
    if (!c) c = &object->capacity.emplace_back(DescriptorPool::Capacity{size.type, 0, 0});
    c->total += size.descriptorCount;
    c->free = c->total;
  }
  object->free_sets = info->maxSets;
  *pool = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyDescriptorPool(VkDevice, VkDescriptorPool pool, const VkAllocationCallbacks*) {
  destroy_handle<DescriptorPool>(pool);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetDescriptorPool(VkDevice, VkDescriptorPool pool, VkDescriptorPoolResetFlags) {
  DescriptorPool& p = from_handle<DescriptorPool>(pool);
  while (p.sets) free_set(p.sets);
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL AllocateDescriptorSets(VkDevice, const VkDescriptorSetAllocateInfo* info,
                                                      VkDescriptorSet* sets) {
  std::fill_n(sets, info->descriptorSetCount, VkDescriptorSet{});
  const VkResult result = allocate_sets(from_handle<DescriptorPool>(info->descriptorPool), *info, sets);
  if (result == VK_SUCCESS) return result;
  // "all of the descriptor sets successfully created ... are freed, and all entries ... set to VK_NULL_HANDLE"
  for (std::uint32_t i = 0; i < info->descriptorSetCount; ++i) {
    if (sets[i]) free_set(from_nullable<DescriptorSet>(sets[i]));
    sets[i] = VK_NULL_HANDLE;
  }
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL FreeDescriptorSets(VkDevice, VkDescriptorPool, std::uint32_t count,
                                                  const VkDescriptorSet* sets) {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (sets[i]) free_set(from_nullable<DescriptorSet>(sets[i]));
  }
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd
