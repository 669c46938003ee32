// Memory at an address that it had before (Vulkan 1.3.239, Memory Allocation:
// VkMemoryOpaqueCaptureAddressAllocateInfo).
#include "tests/icd/fixture.h"
#include "tests/sanitized.h"

namespace vitrine::icd::test {
namespace {

class CapturedAddresses : public DeviceTest {
 protected:
  struct Placed {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceAddress address = 0;
    std::uint64_t of_memory = 0, of_buffer = 0;
  };

  VkResult allocate(std::uint64_t address, VkDeviceMemory& memory) {
    auto again = make_struct<VkMemoryOpaqueCaptureAddressAllocateInfo>();
    again.opaqueCaptureAddress = address;
    auto flags = make_struct<VkMemoryAllocateFlagsInfo>();
    flags.pNext = &again;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT | VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT;
    auto info = make_struct<VkMemoryAllocateInfo>();
    info.pNext = &flags;
    info.allocationSize = kSize + kOffset;
    return VK_GET(instance, AllocateMemory)(device, &info, nullptr, &memory);
  }

  /// A buffer in memory of its own; both where they were if `before` says so.
  Placed place(const Placed& before) {
    Placed out;
    EXPECT_EQ(allocate(before.of_memory, out.memory), VK_SUCCESS);
    auto again = make_struct<VkBufferOpaqueCaptureAddressCreateInfo>();
    again.opaqueCaptureAddress = before.of_buffer;
    auto info = make_struct<VkBufferCreateInfo>();
    info.pNext = &again;
    info.flags = VK_BUFFER_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT;
    info.size = kSize;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    EXPECT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &out.buffer), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, out.buffer, out.memory, kOffset), VK_SUCCESS);
    auto of_buffer = make_struct<VkBufferDeviceAddressInfo>();
    of_buffer.buffer = out.buffer;
    auto of_memory = make_struct<VkDeviceMemoryOpaqueCaptureAddressInfo>();
    of_memory.memory = out.memory;
    out.address = VK_GET(instance, GetBufferDeviceAddress)(device, &of_buffer);
    out.of_buffer = VK_GET(instance, GetBufferOpaqueCaptureAddress)(device, &of_buffer);
    out.of_memory = VK_GET(instance, GetDeviceMemoryOpaqueCaptureAddress)(device, &of_memory);
    return out;
  }

  void destroy(const Placed& placed) {
    VK_GET(instance, DestroyBuffer)(device, placed.buffer, nullptr);
    VK_GET(instance, FreeMemory)(device, placed.memory, nullptr);
  }

  static constexpr VkDeviceSize kSize = 10000, kOffset = 256;
};

TEST_F(CapturedAddresses, ComeAgain) {
  const Placed first = place({}), other = place({});
  EXPECT_NE(first.address, other.address);
  destroy(first);
  destroy(other);
  for (const Placed& before : {other, first}) {
    const Placed again = place(before);
    EXPECT_EQ(again.address, before.address);
    EXPECT_EQ(again.of_memory, before.of_memory);
    destroy(again);
  }
}

TEST_F(CapturedAddresses, WhereSomethingLiesAreRefused) {
  if constexpr (vitrine::test::kRacesAreFound) GTEST_SKIP() << "the sanitizer ends processes that map memory elsewhere";
  const Placed there = place({});
  VkDeviceMemory memory = VK_NULL_HANDLE;
  EXPECT_EQ(allocate(there.of_memory, memory), VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS);
  // No place in memory begins there.
  EXPECT_EQ(allocate(there.of_memory + 4, memory), VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS);
  EXPECT_EQ(allocate(~std::uint64_t{0} - 4095, memory), VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS);
  destroy(there);
}

}  // namespace
}  // namespace vitrine::icd::test
