// Descriptor pools and the allocation of sets (Vulkan 1.3.239, Resource Descriptors: Allocation of Descriptor Sets).
#include <algorithm>

#include "icd/descriptors.h"
#include "icd/entry_points.h"
#include "icd/util.h"

namespace vitrine::icd {
namespace {

DescriptorPool::Capacity* find_capacity(DescriptorPool& pool, VkDescriptorType type) {
  for (DescriptorPool::Capacity& c : pool.capacity) {
    if (c.type == type) return &c;
  }
  return nullptr;
}

void give_back(DescriptorPool& pool, const SetShape& shape, std::size_t binding_count) {
  for (std::size_t i = 0; i < binding_count; ++i) {
    if (shape.bindings[i].count) find_capacity(pool, shape.bindings[i].type)->free += shape.bindings[i].count;
  }
}

/// Takes a set's descriptors out of the pool's counts. False, with nothing taken, if there are not enough.
bool take_capacity(DescriptorPool& pool, const SetShape& shape) {
  if (pool.free_sets == 0) return false;
  for (std::size_t i = 0; i < shape.bindings.size(); ++i) {
    const SetBinding& b = shape.bindings[i];
    if (b.count == 0) continue;
    DescriptorPool::Capacity* c = find_capacity(pool, b.type);
    if (!c || c->free < b.count) {
      give_back(pool, shape, i);
      return false;
    }
    c->free -= b.count;
  }
  --pool.free_sets;
  return true;
}

void write_immutable_samplers(DescriptorSet& set) {
  for (const SetBinding& b : set.shape->bindings) {
    for (std::uint32_t i = 0; b.immutable_samplers && i < b.count; ++i) {
      set.slots[b.first_slot + i].sampler = b.immutable_samplers[i];
    }
  }
}

DescriptorSet* make_set(DescriptorPool& pool, const std::shared_ptr<const SetShape>& shape) {
  static_assert(sizeof(DescriptorSet) % alignof(spirv::Descriptor) == 0);
  const std::size_t slot_bytes = sizeof(spirv::Descriptor) * shape->slot_count;
  const std::size_t dynamic_bytes = sizeof(DynamicBuffer) * shape->dynamic_count;
  auto* storage = static_cast<std::byte*>(pool.memory.allocate(
      sizeof(DescriptorSet) + slot_bytes + dynamic_bytes, alignof(DescriptorSet), VK_SYSTEM_ALLOCATION_SCOPE_OBJECT));
  auto* set = ::new (storage) DescriptorSet(pool.memory);
  set->shape = shape;
  set->pool = &pool;
  set->slots = reinterpret_cast<spirv::Descriptor*>(storage + sizeof(DescriptorSet));
  set->dynamic = reinterpret_cast<DynamicBuffer*>(storage + sizeof(DescriptorSet) + slot_bytes);
  std::uninitialized_fill_n(set->slots, shape->slot_count, spirv::Descriptor{});
  std::uninitialized_fill_n(set->dynamic, shape->dynamic_count, DynamicBuffer{});
  write_immutable_samplers(*set);
  set->next = pool.sets;
  if (pool.sets) pool.sets->previous = set;
  pool.sets = set;
  return set;
}

void free_set(DescriptorSet* set) {
  DescriptorPool& pool = *set->pool;
  give_back(pool, *set->shape, set->shape->bindings.size());
  ++pool.free_sets;
  (set->previous ? set->previous->next : pool.sets) = set->next;
  if (set->next) set->next->previous = set->previous;
  destroy_object(set);
}

VkResult allocate_sets(DescriptorPool& pool, const VkDescriptorSetAllocateInfo& info, VkDescriptorSet* sets) {
  for (std::uint32_t i = 0; i < info.descriptorSetCount; ++i) {
    const std::shared_ptr<const SetShape>& shape = from_handle<DescriptorSetLayout>(info.pSetLayouts[i]).shape;
    if (!take_capacity(pool, *shape)) return VK_ERROR_OUT_OF_POOL_MEMORY;
    try {
      sets[i] = to_handle(make_set(pool, shape));
    } catch (const std::bad_alloc&) {
      give_back(pool, *shape, shape->bindings.size());
      ++pool.free_sets;
      return VK_ERROR_OUT_OF_HOST_MEMORY;
    }
  }
  return VK_SUCCESS;
}

}  // namespace

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
