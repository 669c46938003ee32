// Fences and semaphores that another device, and another process, sees.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

constexpr std::uint64_t kForever = ~std::uint64_t{0};

/// A device of an instance of its own, and short forms of what the tests do with it.
struct Side {
  Side() {
    EXPECT_EQ(create_instance(&instance), VK_SUCCESS);
    std::uint32_t count = 1;
    EXPECT_EQ(VK_GET(instance, EnumeratePhysicalDevices)(instance, &count, &physical_device), VK_SUCCESS);
    EXPECT_EQ(create_device(instance, physical_device, &device), VK_SUCCESS);
    VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
  }
  ~Side() {
    VK_GET(instance, DeviceWaitIdle)(device);
    for (const VkSemaphore semaphore : semaphores) VK_GET(instance, DestroySemaphore)(device, semaphore, nullptr);
    for (const VkFence fence : fences) VK_GET(instance, DestroyFence)(device, fence, nullptr);
    VK_GET(instance, DestroyDevice)(device, nullptr);
    VK_GET(instance, DestroyInstance)(instance, nullptr);
  }

  VkSemaphore semaphore(bool timeline, bool exported, std::uint64_t value = 0) {
    auto types = make_struct<VkExportSemaphoreCreateInfo>();
    types.handleTypes = exported ? VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT : 0;
    auto type = make_struct<VkSemaphoreTypeCreateInfo>(&types);
    type.semaphoreType = timeline ? VK_SEMAPHORE_TYPE_TIMELINE : VK_SEMAPHORE_TYPE_BINARY;
    type.initialValue = value;
    const auto info = make_struct<VkSemaphoreCreateInfo>(&type);
    EXPECT_EQ(VK_GET(instance, CreateSemaphore)(device, &info, nullptr, &semaphores.emplace_back()), VK_SUCCESS);
    return semaphores.back();
  }
  VkFence fence(bool exported) {
    auto types = make_struct<VkExportFenceCreateInfo>();
    types.handleTypes = exported ? VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT : 0;
    const auto info = make_struct<VkFenceCreateInfo>(&types);
    EXPECT_EQ(VK_GET(instance, CreateFence)(device, &info, nullptr, &fences.emplace_back()), VK_SUCCESS);
    return fences.back();
  }
  int descriptor(VkSemaphore semaphore,
                 VkExternalSemaphoreHandleTypeFlagBits type = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT) {
    auto info = make_struct<VkSemaphoreGetFdInfoKHR>();
    info.semaphore = semaphore;
    info.handleType = type;
    int out = -2;
    EXPECT_EQ(VK_GET(instance, GetSemaphoreFdKHR)(device, &info, &out), VK_SUCCESS);
    return out;
  }
  int descriptor(VkFence fence, VkExternalFenceHandleTypeFlagBits type) {
    auto info = make_struct<VkFenceGetFdInfoKHR>();
    info.fence = fence;
    info.handleType = type;
    int out = -2;
    EXPECT_EQ(VK_GET(instance, GetFenceFdKHR)(device, &info, &out), VK_SUCCESS);
    return out;
  }
  VkResult import(VkSemaphore semaphore, int descriptor, VkSemaphoreImportFlags flags = 0,
                  VkExternalSemaphoreHandleTypeFlagBits type = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT) {
    auto info = make_struct<VkImportSemaphoreFdInfoKHR>();
    info.semaphore = semaphore;
    info.flags = flags;
    info.handleType = type;
    info.fd = descriptor;
    return VK_GET(instance, ImportSemaphoreFdKHR)(device, &info);
  }
  VkResult import(VkFence fence, int descriptor, VkExternalFenceHandleTypeFlagBits type, VkFenceImportFlags flags = 0) {
    auto info = make_struct<VkImportFenceFdInfoKHR>();
    info.fence = fence;
    info.flags = flags;
    info.handleType = type;
    info.fd = descriptor;
    return VK_GET(instance, ImportFenceFdKHR)(device, &info);
  }
  /// A batch that waits, then signals; null: it does not.
  void submit(VkSemaphore wait, std::uint64_t wait_value, VkSemaphore signal, std::uint64_t signal_value,
              VkFence fence = VK_NULL_HANDLE) {
    auto values = make_struct<VkTimelineSemaphoreSubmitInfo>();
    values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
    values.pWaitSemaphoreValues = &wait_value;
    values.pSignalSemaphoreValues = &signal_value;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    auto info = make_struct<VkSubmitInfo>(&values);
    info.waitSemaphoreCount = wait != VK_NULL_HANDLE;
    info.signalSemaphoreCount = signal != VK_NULL_HANDLE;
    info.pWaitSemaphores = &wait;
    info.pSignalSemaphores = &signal;
    info.pWaitDstStageMask = &stage;
    EXPECT_EQ(VK_GET(instance, QueueSubmit)(queue, 1, &info, fence), VK_SUCCESS);
  }
  VkResult wait(VkSemaphore semaphore, std::uint64_t value, std::uint64_t timeout) {
    auto info = make_struct<VkSemaphoreWaitInfo>();
    info.semaphoreCount = 1;
    info.pSemaphores = &semaphore;
    info.pValues = &value;
    return VK_GET(instance, WaitSemaphoresKHR)(device, &info, timeout);
  }
  VkResult wait(VkFence fence, std::uint64_t timeout) {
    return VK_GET(instance, WaitForFences)(device, 1, &fence, VK_TRUE, timeout);
  }
  void signal(VkSemaphore semaphore, std::uint64_t value) {
    auto info = make_struct<VkSemaphoreSignalInfo>();
    info.semaphore = semaphore;
    info.value = value;
    EXPECT_EQ(VK_GET(instance, SignalSemaphoreKHR)(device, &info), VK_SUCCESS);
  }

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::vector<VkSemaphore> semaphores;
  std::vector<VkFence> fences;
};

TEST(ExternalSemaphore, TimelinesCountForBothDevices) {
  Side one, two;
  const VkSemaphore a = one.semaphore(true, true, 3), b = two.semaphore(true, false);
  ASSERT_EQ(two.import(b, one.descriptor(a)), VK_SUCCESS);
  EXPECT_EQ(two.wait(b, 3, 0), VK_SUCCESS);
  EXPECT_EQ(two.wait(b, 4, 1'000'000), VK_TIMEOUT);
  two.submit(b, 5, b, 6);
  std::thread signaller([&] { one.signal(a, 5); });
  EXPECT_EQ(one.wait(a, 6, kForever), VK_SUCCESS);
  signaller.join();
}

TEST(ExternalSemaphore, DevicesTakeTurnsOnTheirQueues) {
  Side one, two;
  const VkSemaphore a = one.semaphore(false, true), b = one.semaphore(false, true);
  const VkSemaphore a2 = two.semaphore(false, false), b2 = two.semaphore(false, false);
  ASSERT_EQ(two.import(a2, one.descriptor(a)), VK_SUCCESS);
  ASSERT_EQ(two.import(b2, one.descriptor(b)), VK_SUCCESS);
  const VkFence done = one.fence(false);
  for (int i = 0; i < 50; ++i) {
    one.submit(VK_NULL_HANDLE, 0, a, 0);
    two.submit(a2, 0, b2, 0);
    one.submit(b, 0, VK_NULL_HANDLE, 0, i == 49 ? done : VK_NULL_HANDLE);
  }
  EXPECT_EQ(one.wait(done, kForever), VK_SUCCESS);
}

TEST(ExternalSemaphore, ATemporaryPayloadIsForOneWait) {
  Side one, two;
  const VkSemaphore a = one.semaphore(false, true), b = two.semaphore(false, false);
  two.submit(VK_NULL_HANDLE, 0, b, 0);  // its own payload is signalled
  ASSERT_EQ(two.import(b, one.descriptor(a), VK_SEMAPHORE_IMPORT_TEMPORARY_BIT), VK_SUCCESS);
  const VkFence first = two.fence(false), second = two.fence(false);
  two.submit(b, 0, VK_NULL_HANDLE, 0, first);
  EXPECT_EQ(two.wait(first, 1'000'000), VK_TIMEOUT) << "the other payload is not signalled";
  two.submit(b, 0, VK_NULL_HANDLE, 0, second);
  one.submit(VK_NULL_HANDLE, 0, a, 0);
  EXPECT_EQ(two.wait(first, kForever), VK_SUCCESS);
  EXPECT_EQ(two.wait(second, kForever), VK_SUCCESS) << "its own payload is back";
}

TEST(ExternalSemaphore, SyncFilesAreWaitedForAndGivenAsSignalled) {
  constexpr auto kSyncFile = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_SYNC_FD_BIT;
  Side side;
  const VkSemaphore semaphore = side.semaphore(false, false);
  side.submit(VK_NULL_HANDLE, 0, semaphore, 0);
  EXPECT_EQ(side.descriptor(semaphore, kSyncFile), -1);
  ASSERT_EQ(side.import(semaphore, -1, VK_SEMAPHORE_IMPORT_TEMPORARY_BIT, kSyncFile), VK_SUCCESS);
  const VkFence first = side.fence(false), second = side.fence(false);
  side.submit(semaphore, 0, VK_NULL_HANDLE, 0, first);
  EXPECT_EQ(side.wait(first, kForever), VK_SUCCESS);
  // As a sync file, a pipe can be read once it is signalled.
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(side.import(semaphore, ends[0], VK_SEMAPHORE_IMPORT_TEMPORARY_BIT, kSyncFile), VK_SUCCESS);
  side.submit(semaphore, 0, VK_NULL_HANDLE, 0, second);
  EXPECT_EQ(side.wait(second, 3'000'000), VK_TIMEOUT);
  EXPECT_EQ(write(ends[1], "x", 1), 1);
  EXPECT_EQ(side.wait(second, kForever), VK_SUCCESS);
  close(ends[1]);
}

TEST(ExternalSemaphore, WhatIsNoPayloadIsRefused) {
  Side side;
  const VkSemaphore binary = side.semaphore(false, true), timeline = side.semaphore(true, false);
  const int of_binary = side.descriptor(binary);
  EXPECT_EQ(side.import(timeline, of_binary), VK_ERROR_INVALID_EXTERNAL_HANDLE) << "of another type";
  EXPECT_EQ(close(of_binary), 0) << "not taken";
  const int unsealed = memfd_create("test", 0);
  ASSERT_EQ(ftruncate(unsealed, 4096), 0);
  EXPECT_EQ(side.import(binary, unsealed), VK_ERROR_INVALID_EXTERNAL_HANDLE) << "its owner could take the page away";
  EXPECT_EQ(close(unsealed), 0);
  const int empty = open("/dev/null", O_RDWR);
  EXPECT_EQ(side.import(binary, empty), VK_ERROR_INVALID_EXTERNAL_HANDLE);
  EXPECT_EQ(close(empty), 0);
}

TEST(ExternalFence, SignalsAndResetsAreSeenByBoth) {
  constexpr auto kOpaque = VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT;
  Side one, two;
  const VkFence a = one.fence(true), b = two.fence(false);
  ASSERT_EQ(two.import(b, one.descriptor(a, kOpaque), kOpaque), VK_SUCCESS);
  EXPECT_EQ(two.wait(b, 1'000'000), VK_TIMEOUT);
  one.submit(VK_NULL_HANDLE, 0, VK_NULL_HANDLE, 0, a);
  EXPECT_EQ(two.wait(b, kForever), VK_SUCCESS);
  EXPECT_EQ(VK_GET(two.instance, ResetFences)(two.device, 1, &b), VK_SUCCESS);
  EXPECT_EQ(VK_GET(one.instance, GetFenceStatus)(one.device, a), VK_NOT_READY);
}

TEST(ExternalFence, TemporaryPayloadsLastUntilTheReset) {
  constexpr auto kSyncFile = VK_EXTERNAL_FENCE_HANDLE_TYPE_SYNC_FD_BIT;
  Side side;
  const VkFence fence = side.fence(false);
  ASSERT_EQ(side.import(fence, -1, kSyncFile, VK_FENCE_IMPORT_TEMPORARY_BIT), VK_SUCCESS);
  EXPECT_EQ(side.wait(fence, 0), VK_SUCCESS);
  EXPECT_EQ(VK_GET(side.instance, ResetFences)(side.device, 1, &fence), VK_SUCCESS);
  EXPECT_EQ(side.wait(fence, 0), VK_TIMEOUT);
  side.submit(VK_NULL_HANDLE, 0, VK_NULL_HANDLE, 0, fence);
  EXPECT_EQ(side.descriptor(fence, kSyncFile), -1);
  EXPECT_EQ(side.wait(fence, 0), VK_TIMEOUT) << "giving it away resets it";
}

void send_descriptor(int socket, int descriptor) {
  char byte = 0, control[CMSG_SPACE(sizeof(int))]{};
  iovec data{&byte, 1};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof(control);
  cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof(int));
  *reinterpret_cast<int*>(CMSG_DATA(header)) = descriptor;
  EXPECT_EQ(sendmsg(socket, &message, 0), 1);
  close(descriptor);
}

int receive_descriptor(int socket) {
  char byte = 0, control[CMSG_SPACE(sizeof(int))]{};
  iovec data{&byte, 1};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof(control);
  if (recvmsg(socket, &message, 0) != 1) return -1;
  return *reinterpret_cast<int*>(CMSG_DATA(CMSG_FIRSTHDR(&message)));
}

TEST(ExternalSemaphore, ProcessesWaitForEachOther) {
  int sockets[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, sockets), 0);
  const pid_t child = fork();
  if (child == 0) {
    close(sockets[0]);
    const int descriptor = receive_descriptor(sockets[1]);
    bool good = false;
    {
      Side side;
      const VkSemaphore semaphore = side.semaphore(true, false);
      good = side.import(semaphore, descriptor) == VK_SUCCESS;
      side.submit(semaphore, 1, semaphore, 2);
      good = good && side.wait(semaphore, 3, kForever) == VK_SUCCESS;
      side.signal(semaphore, 4);
    }
    _exit(good ? 0 : 1);
  }
  close(sockets[1]);
  Side side;
  const VkSemaphore semaphore = side.semaphore(true, true);
  send_descriptor(sockets[0], side.descriptor(semaphore));
  side.signal(semaphore, 1);
  side.submit(semaphore, 2, semaphore, 3);
  EXPECT_EQ(side.wait(semaphore, 4, 20'000'000'000), VK_SUCCESS);
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  close(sockets[0]);
}

}  // namespace
}  // namespace vitrine::icd::test
