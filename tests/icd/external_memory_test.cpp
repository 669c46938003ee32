// Memory that is a file or the application's own pages.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cstring>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

constexpr auto kDmaBuf = VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT;

constexpr auto kDmaBufMagic = 0x444d4142;  ///< of their file system

class ExternalMemory : public DeviceTest {
 protected:
  VkResult allocate(VkDeviceSize size, void* next, VkDeviceMemory* memory) {
    auto info = make_struct<VkMemoryAllocateInfo>(next);
    info.allocationSize = size;
    return VK_GET(instance, AllocateMemory)(device, &info, nullptr, memory);
  }
  std::byte* map(VkDeviceMemory memory) {
    void* data = nullptr;
    EXPECT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    return static_cast<std::byte*>(data);
  }
  int descriptor_of(VkDeviceMemory memory, VkExternalMemoryHandleTypeFlagBits type) {
    auto get = make_struct<VkMemoryGetFdInfoKHR>();
    get.memory = memory;
    get.handleType = type;
    int descriptor = -1;
    EXPECT_EQ(VK_GET(instance, GetMemoryFdKHR)(device, &get, &descriptor), VK_SUCCESS);
    return descriptor;
  }
  VkResult import_file(VkDeviceSize size, VkExternalMemoryHandleTypeFlagBits type, int file, VkDeviceMemory* memory) {
    auto import = make_struct<VkImportMemoryFdInfoKHR>();
    import.handleType = type;
    import.fd = file;
    return allocate(size, &import, memory);
  }
  void free(VkDeviceMemory memory) { VK_GET(instance, FreeMemory)(device, memory, nullptr); }
};

TEST_F(ExternalMemory, FilesAreSharedAndOutliveTheirFirstOwner) {
  auto exported = make_struct<VkExportMemoryAllocateInfo>();
  exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  VkDeviceMemory first, second;
  constexpr VkDeviceSize kSize = 100000;
  ASSERT_EQ(allocate(kSize, &exported, &first), VK_SUCCESS);
  auto get = make_struct<VkMemoryGetFdInfoKHR>();
  get.memory = first;
  get.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  int descriptor = -1;
  ASSERT_EQ(VK_GET(instance, GetMemoryFdKHR)(device, &get, &descriptor), VK_SUCCESS);
  auto import = make_struct<VkImportMemoryFdInfoKHR>();
  import.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  import.fd = descriptor;
  EXPECT_EQ(allocate(kSize * 100, &import, &second), VK_ERROR_INVALID_EXTERNAL_HANDLE) << "the file is smaller";
  ASSERT_EQ(allocate(kSize, &import, &second), VK_SUCCESS);
  std::byte* one = map(first);
  std::byte* two = map(second);
  EXPECT_EQ(one[77], std::byte{0});
  std::memset(one, 0x5a, kSize);
  EXPECT_EQ(two[0], std::byte{0x5a});
  EXPECT_EQ(two[kSize - 1], std::byte{0x5a});
  EXPECT_EQ(two[kSize + 63], std::byte{0}) << "the tail can be read";
  free(first);
  EXPECT_EQ(two[kSize / 2], std::byte{0x5a});
  free(second);
}

/// VK_EXT_external_memory_dma_buf: whoever gets the descriptor maps it, and no one can cut it off.
TEST_F(ExternalMemory, DmaBufsAreMappedByOthers) {
  auto exported = make_struct<VkExportMemoryAllocateInfo>();
  exported.handleTypes = kDmaBuf | VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  VkDeviceMemory first, second;
  constexpr VkDeviceSize kSize = 100000;
  ASSERT_EQ(allocate(kSize, &exported, &first), VK_SUCCESS);
  const int descriptor = descriptor_of(first, kDmaBuf);
  ASSERT_GE(descriptor, 0);
  EXPECT_NE(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0);
  struct statfs status {};
  ASSERT_EQ(fstatfs(descriptor, &status), 0);
  EXPECT_EQ(status.f_type == kDmaBufMagic, access("/dev/udmabuf", R_OK | W_OK) == 0)
      << "a dma-buf where the kernel makes them, and where not, a file that is like one";
  EXPECT_GE(lseek(descriptor, 0, SEEK_END), off_t{kSize});
  EXPECT_NE(ftruncate(descriptor, 0), 0);
  void* const mapped = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  ASSERT_NE(mapped, MAP_FAILED);
  std::memset(mapped, 0x33, kSize);
  EXPECT_EQ(map(first)[kSize - 1], std::byte{0x33});
  auto properties = make_struct<VkMemoryFdPropertiesKHR>();
  const auto ask = VK_GET(instance, GetMemoryFdPropertiesKHR);
  EXPECT_EQ(ask(device, kDmaBuf, descriptor, &properties), VK_SUCCESS);
  EXPECT_EQ(properties.memoryTypeBits, 1u);
  EXPECT_EQ(import_file(kSize, kDmaBuf, descriptor, &second), VK_SUCCESS);
  free(first);
  EXPECT_EQ(map(second)[7], std::byte{0x33});
  const int again = descriptor_of(second, kDmaBuf);
  EXPECT_GE(again, 0) << "what was imported can be given on";
  close(again);
  free(second);
  munmap(mapped, kSize);
}

TEST_F(ExternalMemory, FilesThatSomebodyCouldCutOffAreRefused) {
  const auto ask = VK_GET(instance, GetMemoryFdPropertiesKHR);
  auto properties = make_struct<VkMemoryFdPropertiesKHR>();
  int pipes[2];
  ASSERT_EQ(pipe(pipes), 0);
  const int sealed = memfd_create("sealed", MFD_ALLOW_SEALING), closed = memfd_create("closed", 0);
  const int read_only = open("/proc/self/exe", O_RDONLY), zeros = open("/dev/zero", O_RDWR),
            folder = open("/", O_RDONLY);
  ASSERT_EQ(ftruncate(sealed, 8192), 0);
  ASSERT_EQ(ftruncate(closed, 8192), 0);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  for (const int hostile : {pipes[0], closed, read_only, zeros, folder, -1, 1 << 20}) {
    EXPECT_EQ(ask(device, kDmaBuf, hostile, &properties), VK_ERROR_INVALID_EXTERNAL_HANDLE) << hostile;
    for (const auto type : {kDmaBuf, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT})
      EXPECT_EQ(import_file(4096, type, hostile, &memory), VK_ERROR_INVALID_EXTERNAL_HANDLE) << hostile;
  }
  EXPECT_EQ(ask(device, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT, sealed, &properties),
            VK_ERROR_INVALID_EXTERNAL_HANDLE);
  EXPECT_EQ(import_file(8193, kDmaBuf, sealed, &memory), VK_ERROR_INVALID_EXTERNAL_HANDLE) << "the file is smaller";
  const int kept = dup(sealed);
  ASSERT_EQ(import_file(8192, kDmaBuf, sealed, &memory), VK_SUCCESS);
  EXPECT_NE(ftruncate(kept, 0), 0) << "its owner can no longer shrink it";
  map(memory)[8191] = std::byte{1};
  free(memory);
  for (const int descriptor : {pipes[0], pipes[1], closed, read_only, zeros, folder, kept}) close(descriptor);
}

TEST_F(ExternalMemory, PagesOfTheApplicationAreUsedInPlace) {
  constexpr std::size_t kPage = 4096;
  auto* pages =
      static_cast<std::byte*>(mmap(nullptr, 4 * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(static_cast<void*>(pages), MAP_FAILED);
  munmap(pages + 3 * kPage, kPage);  // nothing follows
  pages[5] = std::byte{9};
  auto properties = make_struct<VkMemoryHostPointerPropertiesEXT>();
  constexpr auto kType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
  ASSERT_EQ(VK_GET(instance, GetMemoryHostPointerPropertiesEXT)(device, kType, pages, &properties), VK_SUCCESS);
  EXPECT_EQ(properties.memoryTypeBits, 1u);
  auto import = make_struct<VkImportMemoryHostPointerInfoEXT>();
  import.handleType = kType;
  import.pHostPointer = pages;
  VkDeviceMemory memory;
  ASSERT_EQ(allocate(3 * kPage, &import, &memory), VK_SUCCESS);
  std::byte* data = map(memory);
  EXPECT_EQ(data, pages);
  EXPECT_EQ(data[3 * kPage + 63], std::byte{0}) << "the tail can be read";
  free(memory);
  EXPECT_EQ(pages[5], std::byte{9});
  munmap(pages, 3 * kPage);
}

/// VK_EXT_queue_family_foreign: who has the buffer in between is not of this API; its bytes stay.
TEST_F(ExternalMemory, BuffersGoToForeignQueuesAndComeBack) {
  VkDeviceMemory memory;
  ASSERT_EQ(allocate(4096, nullptr, &memory), VK_SUCCESS);
  auto buffer_info = make_struct<VkBufferCreateInfo>();
  buffer_info.size = 64;
  buffer_info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer;
  ASSERT_EQ(VK_GET(instance, CreateBuffer)(device, &buffer_info, nullptr, &buffer), VK_SUCCESS);
  ASSERT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, 0), VK_SUCCESS);
  auto barrier = make_struct<VkBufferMemoryBarrier>();
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_FOREIGN_EXT;
  barrier.buffer = buffer;
  barrier.size = VK_WHOLE_SIZE;
  run([&](VkCommandBuffer commands) {
    VK_GET(instance, CmdFillBuffer)(commands, buffer, 0, 64, 0x01020304);
    VK_GET(instance, CmdPipelineBarrier)
    (commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 1, &barrier, 0, nullptr);
  });
  std::swap(barrier.srcQueueFamilyIndex, barrier.dstQueueFamilyIndex);
  std::swap(barrier.srcAccessMask, barrier.dstAccessMask);
  run([&](VkCommandBuffer commands) {
    VK_GET(instance, CmdPipelineBarrier)
    (commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 1, &barrier, 0, nullptr);
    VK_GET(instance, CmdFillBuffer)(commands, buffer, 32, 32, 0);
  });
  const std::byte* bytes = map(memory);
  EXPECT_EQ(bytes[31], std::byte{1});
  EXPECT_EQ(bytes[32], std::byte{0});
  VK_GET(instance, DestroyBuffer)(device, buffer, nullptr);
  free(memory);
}

TEST_F(ExternalMemory, CapabilitiesNameTheHandles) {
  const auto features = [&](VkExternalMemoryHandleTypeFlagBits type) {
    auto info = make_struct<VkPhysicalDeviceExternalBufferInfo>();
    info.handleType = type;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    auto out = make_struct<VkExternalBufferProperties>();
    VK_GET(instance, GetPhysicalDeviceExternalBufferProperties)(physical_device, &info, &out);
    return out.externalMemoryProperties.externalMemoryFeatures;
  };
  EXPECT_EQ(features(VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT),
            VkFlags{VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT});
  EXPECT_EQ(features(kDmaBuf),
            VkFlags{VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT});
  EXPECT_EQ(features(VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT),
            VkFlags{VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT});
}

}  // namespace
}  // namespace vitrine::icd::test
