// Processes that fork() while they have a device: the child ends, has a device of its own, and finds the inherited one
// lost; the parent goes on.
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/icd/small_program.h"
#include "tests/sanitized.h"

namespace vitrine::icd::test {
namespace {

/// How a child ends that does this; -1: by a signal, the alarm's among them.
template <class F>
int in_child(F&& f) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    f();
    std::exit(::testing::Test::HasFailure() ? 1 : 0);  // with the exit handlers of the driver
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class Fork : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run(parent_), VK_SUCCESS);
    check_results(parent_);
  }
  void TearDown() override {
    check_results(parent_);
    destroy(parent_);
  }
  Program parent_;
};

TEST_F(Fork, TheChildEndsThoughThreadsOfItsParentAreGone) {
  EXPECT_EQ(in_child([] {}), 0);
}

TEST_F(Fork, TheChildHasADeviceOfItsOwn) {
  if constexpr (vitrine::test::kRacesAreFound)
    GTEST_SKIP() << "the sanitizer lets children of a process with threads start none";
  EXPECT_EQ(in_child([] {
              Program own;
              EXPECT_EQ(run(own), VK_SUCCESS);
              check_results(own);
              destroy(own);
            }),
            0);
}

TEST_F(Fork, TheInheritedDeviceIsLostAndCanBeDestroyed) {
  EXPECT_EQ(in_child([&] {
              Program& p = parent_;
              EXPECT_EQ(submit(p), VK_ERROR_DEVICE_LOST);
              EXPECT_EQ(VK_GET(p.instance, DeviceWaitIdle)(p.device), VK_ERROR_DEVICE_LOST);
              destroy(p);
            }),
            0);
}

/// Records a wait for an event that the host sets.
VkCommandBuffer record_wait(Program& p, VkEvent event) {
  VkCommandBuffer commands = VK_NULL_HANDLE;
  EXPECT_EQ(begin_commands(p, commands), VK_SUCCESS);
  VK_GET(p.instance, CmdWaitEvents)
  (commands, 1, &event, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, nullptr, 0, nullptr, 0,
   nullptr);
  EXPECT_EQ(VK_GET(p.instance, EndCommandBuffer)(commands), VK_SUCCESS);
  return commands;
}

TEST_F(Fork, AQueueThatWaitsGoesOnInTheParentAlone) {
  const VkInstance instance = parent_.instance;
  const auto event_info = make_struct<VkEventCreateInfo>();
  VkEvent event = VK_NULL_HANDLE;
  ASSERT_EQ(VK_GET(instance, CreateEvent)(parent_.device, &event_info, nullptr, &event), VK_SUCCESS);
  const VkCommandBuffer commands = record_wait(parent_, event);
  VkQueue queue;
  VK_GET(instance, GetDeviceQueue)(parent_.device, 0, 0, &queue);
  auto info = make_struct<VkSubmitInfo>();
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  ASSERT_EQ(VK_GET(instance, QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(in_child([&] {
                EXPECT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_ERROR_DEVICE_LOST);
                VK_GET(instance, DestroyEvent)(parent_.device, event, nullptr);
                destroy(parent_);
              }),
              0);
  }
  ASSERT_EQ(VK_GET(instance, SetEvent)(parent_.device, event), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  VK_GET(instance, DestroyEvent)(parent_.device, event, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
