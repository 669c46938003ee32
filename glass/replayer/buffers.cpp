// Memories and buffers of a bug file. Memory of a command that follows device addresses is allocated where it was
// (Vulkan 1.3.239, Memory Allocation: VkMemoryOpaqueCaptureAddressAllocateInfo), since nobody knows all the places that
// addresses lie in.
#include <algorithm>

#include "glass/replayer/resources.h"

namespace vitrine::glass::replayer {
namespace {

constexpr VkBufferUsageFlags kKeptUsage =
    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
    VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
    VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
constexpr VkBufferUsageFlags kTransfer = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr char kElsewhere[] =
    "its shader follows device addresses, and this driver cannot give memory the addresses that it had";

/// By its number; null: its address does not matter.
struct Address {
  VkBufferOpaqueCaptureAddressCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_OPAQUE_CAPTURE_ADDRESS_CREATE_INFO};
  bool matters = false;
};

VkBuffer make_buffer(const Device& d, const bug::Buffer& source, const Address& address) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = source.size;
  info.usage = (source.usage & kKeptUsage) | kTransfer;
  if (address.matters) {
    info.pNext = &address.info;
    info.flags = VK_BUFFER_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT;
    info.usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  }
  VkBuffer buffer = VK_NULL_HANDLE;
  must(vkCreateBuffer(d.device, &info, nullptr, &buffer), "vkCreateBuffer");
  set_name(d, VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer), source.name);
  return buffer;
}

VkDeviceMemory allocate_at(const Device& d, const VkMemoryRequirements& needs, std::uint64_t address) {
  VkMemoryOpaqueCaptureAddressAllocateInfo place{VK_STRUCTURE_TYPE_MEMORY_OPAQUE_CAPTURE_ADDRESS_ALLOCATE_INFO};
  place.opaqueCaptureAddress = address;
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, &place};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT | VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT;
  return allocate(d, needs, false, &flags);
}

void check_address(const Device& d, VkBuffer buffer, std::uint64_t expected) {
  VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  info.buffer = buffer;
  if (vkGetBufferDeviceAddress(d.device, &info) != expected) throw Failure(kElsewhere);
}

}  // namespace

void make_buffers(const Device& d, const bug::Bug& bug, Resources& out) {
  const bool addressed = !bug.addressed.empty();
  if (addressed && (!d.addresses_again || bug.device != d.properties.deviceName)) throw Failure(kElsewhere);
  std::vector<Address> addresses(bug.buffers.size());
  for (const std::uint32_t number : bug.addressed) {
    const bug::Buffer& b = bug.buffers[number];
    addresses[number].matters = true;
    addresses[number].info.opaqueCaptureAddress = bug.memories[b.memory].address + b.offset;
  }
  std::vector<VkMemoryRequirements> needs(bug.memories.size());
  for (std::size_t i = 0; i < needs.size(); ++i) needs[i] = {bug.memories[i].size, 16, ~0u};
  for (std::size_t i = 0; i < bug.buffers.size(); ++i) {
    const bug::Buffer& source = bug.buffers[i];
    const VkBuffer buffer = make_buffer(d, source, addresses[i]);
    VkMemoryRequirements one;
    vkGetBufferMemoryRequirements(d.device, buffer, &one);
    VkMemoryRequirements& all = needs[source.memory];
    all.size = std::max(all.size, source.offset + one.size);
    all.memoryTypeBits &= one.memoryTypeBits;
    if (source.offset % one.alignment != 0) throw Failure("buffers that overlap are not aligned for this driver");
    out.buffers.push_back(buffer);
  }
  for (std::size_t i = 0; i < needs.size(); ++i)
    out.memories.push_back(addressed ? allocate_at(d, needs[i], bug.memories[i].address)
                                     : allocate(d, needs[i], false));
  for (std::size_t i = 0; i < bug.buffers.size(); ++i)
    must(vkBindBufferMemory(d.device, out.buffers[i], out.memories[bug.buffers[i].memory], bug.buffers[i].offset),
         "vkBindBufferMemory");
  for (const std::uint32_t number : bug.addressed)
    check_address(d, out.buffers[number], addresses[number].info.opaqueCaptureAddress);
}

void destroy_gone(const Device& d, const bug::Bug& bug, const Resources& resources) {
  std::vector<bool> lives(bug.memories.size(), false);
  for (std::size_t i = 0; i < bug.buffers.size(); ++i) {
    if (bug.buffers[i].gone)
      vkDestroyBuffer(d.device, resources.buffers[i], nullptr);
    else
      lives[bug.buffers[i].memory] = true;
  }
  for (std::size_t i = 0; i < lives.size(); ++i)
    if (!lives[i]) vkFreeMemory(d.device, resources.memories[i], nullptr);
}

}  // namespace vitrine::glass::replayer
