// The driver as a library that is loaded and unloaded, and that lives where the system gives no more memory, threads or
// files: an error or the right result each time, and nothing left behind. usage: loaded_test LIBVITRINE_ICD_SO
#include <dirent.h>
#include <dlfcn.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>

#include "tests/icd/small_program.h"
#include "tests/sanitized.h"

namespace {

const char* library;
PFN_vkGetInstanceProcAddr get_of_driver;

}  // namespace

/// What the program calls: the loaded driver's own.
extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance, const char* name) {
  return get_of_driver(instance, name);
}

namespace vitrine::icd::test {
namespace {

class Driver {
 public:
  Driver() : handle_(dlopen(library, RTLD_NOW | RTLD_LOCAL)) {
    if (!handle_) {
      ADD_FAILURE() << dlerror();
      std::exit(1);
    }
    get_of_driver = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(handle_, "vk_icdGetInstanceProcAddr"));
  }
  ~Driver() {
    get_of_driver = nullptr;
    EXPECT_EQ(dlclose(handle_), 0);
    EXPECT_EQ(dlopen(library, RTLD_NOW | RTLD_NOLOAD), nullptr) << "it is still loaded";
  }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

 private:
  void* handle_;
};

/// What the process has of the system.
struct Holdings {
  long kibibytes = 0, threads = 0, files = 0;
  long most_kibibytes = 0;  ///< so far
};

Holdings holdings() {
  Holdings found;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> found.kibibytes;
    if (word == "VmHWM:") status >> found.most_kibibytes;
    if (word == "Threads:") status >> found.threads;
  }
  DIR* const folder = opendir("/proc/self/fd");
  while (readdir(folder)) ++found.files;
  closedir(folder);
  return found;
}

/// No more than before, but for what the C library keeps of freed memory.
void expect_same(const Holdings& before, const Holdings& after) {
  if (!vitrine::test::kSanitized) {
    EXPECT_LE(after.kibibytes, before.kibibytes + 4096);
  }
  EXPECT_EQ(after.threads, before.threads);
  EXPECT_EQ(after.files, before.files);
}

void run_once() {
  Program p;
  ASSERT_EQ(run(p), VK_SUCCESS);
  check_results(p);
  destroy(p);
}

TEST(Loaded, AThousandTimes) {
  Holdings before;
  for (int i = 0; i < 1000; ++i) {
    {
      const Driver driver;
      ASSERT_NO_FATAL_FAILURE(run_once());
    }
    if (i == 20) before = holdings();
  }
  expect_same(before, holdings());
}

TEST(Loaded, TenThousandOfEachObjectLeaveNothingBehind) {
  const Driver driver;
  Program p;
  ASSERT_EQ(run(p), VK_SUCCESS);
  Holdings before;
  for (int i = 0; i < 10'000; ++i) {
    Program again = p;
    again.image = VK_NULL_HANDLE;
    again.memory = VK_NULL_HANDLE;
    ASSERT_EQ(make_resources(again), VK_SUCCESS);
    ASSERT_EQ(make_pipelines(again), VK_SUCCESS);
    ASSERT_EQ(record(again), VK_SUCCESS);
    destroy_recorded(again);
    const VkInstance instance = p.instance;
    VK_GET(instance, DestroyImageView)(p.device, again.view, nullptr);
    VK_GET(instance, DestroyImage)(p.device, again.image, nullptr);
    VK_GET(instance, DestroyBuffer)(p.device, again.buffer, nullptr);
    VK_GET(instance, FreeMemory)(p.device, again.memory, nullptr);
    if (i == 1000) before = holdings();
  }
  expect_same(before, holdings());
  check_results(p);
  destroy(p);
}

TEST(Loaded, QueriesThatAreNotUsedTakeNoMemory) {
  const Driver driver;
  Program p;
  ASSERT_EQ(make_device(p), VK_SUCCESS);
  const Holdings before = holdings();
  auto info = make_struct<VkQueryPoolCreateInfo>();
  info.queryType = VK_QUERY_TYPE_OCCLUSION;
  for (const std::uint32_t count : {100'000'000u, ~0u}) {
    info.queryCount = count;
    VkQueryPool pool = VK_NULL_HANDLE;
    const VkResult result = VK_GET(p.instance, CreateQueryPool)(p.device, &info, nullptr, &pool);
    // Where the system does not give as much as it has not.
    EXPECT_TRUE(result == VK_SUCCESS || result == VK_ERROR_OUT_OF_HOST_MEMORY) << result;
    if (!vitrine::test::kSanitized) {
      EXPECT_LE(holdings().most_kibibytes, before.most_kibibytes + 4096);
    }
    std::uint64_t counter = 7;
    if (result == VK_SUCCESS) {
      EXPECT_EQ(VK_GET(p.instance, GetQueryPoolResults)(p.device, pool, count - 1, 1, sizeof counter, &counter, 8,
                                                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_PARTIAL_BIT),
                VK_NOT_READY);
      EXPECT_EQ(counter, 0u);
    }
    VK_GET(p.instance, DestroyQueryPool)(p.device, pool, nullptr);
  }
  destroy(p);
}

/// Records a render pass with one draw.
VkCommandBuffer record_draw(Program& p, std::uint32_t vertices, std::uint32_t instances) {
  VkCommandBuffer commands = VK_NULL_HANDLE;
  EXPECT_EQ(begin_commands(p, commands), VK_SUCCESS);
  const VkClearValue clear{};
  auto render = make_struct<VkRenderPassBeginInfo>();
  render.renderPass = p.render_pass;
  render.framebuffer = p.framebuffer;
  render.renderArea.extent = {64, 64};
  render.clearValueCount = 1;
  render.pClearValues = &clear;
  VK_GET(p.instance, CmdBeginRenderPass)(commands, &render, VK_SUBPASS_CONTENTS_INLINE);
  VK_GET(p.instance, CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p.pipelines[1]);
  VK_GET(p.instance, CmdDraw)(commands, vertices, instances, 0, 0);
  VK_GET(p.instance, CmdEndRenderPass)(commands);
  EXPECT_EQ(VK_GET(p.instance, EndCommandBuffer)(commands), VK_SUCCESS);
  return commands;
}

TEST(Loaded, MemoryDoesNotGrowWithADraw) {
  const Driver driver;
  Program p;
  ASSERT_EQ(run(p), VK_SUCCESS);
  VkQueue queue;
  VK_GET(p.instance, GetDeviceQueue)(p.device, 0, 0, &queue);
  const auto draw = [&](std::uint32_t vertices, std::uint32_t instances) {
    p.commands = record_draw(p, vertices, instances);
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &p.commands;
    ASSERT_EQ(VK_GET(p.instance, QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
    ASSERT_EQ(VK_GET(p.instance, QueueWaitIdle)(queue), VK_SUCCESS);
  };
  ASSERT_NO_FATAL_FAILURE(draw(300'000, 1));
  const Holdings before = holdings();
  ASSERT_NO_FATAL_FAILURE(draw(12'000'000, 1));
  ASSERT_NO_FATAL_FAILURE(draw(3, 4'000'000));
  EXPECT_LE(holdings().most_kibibytes, before.most_kibibytes + 98304);
  destroy(p);
}

/// How a child ends that runs the program behind `prepare`: 0: it ran, 1: an error or a wrong result, -1: a signal.
enum class End { kRan, kError, kWrong, kSignal };
template <class F>
End run_in_child(F&& prepare) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    prepare();
    Program p;
    const VkResult result = run(p);
    if (result == VK_SUCCESS) check_results(p);
    destroy(p);
    std::_Exit(::testing::Test::HasFailure() ? 2 : result == VK_SUCCESS ? 0 : 1);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? static_cast<End>(WEXITSTATUS(status)) : End::kSignal;
}

/// The soft limit of a resource.
void limit(decltype(RLIMIT_AS) resource, rlim_t value) {
  rlimit limits{};
  getrlimit(resource, &limits);
  limits.rlim_cur = value;
  setrlimit(resource, &limits);
}

rlim_t address_space() {
  std::ifstream status("/proc/self/statm");
  rlim_t pages = 0;
  status >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

TEST(Loaded, AnyAmountOfMemoryIsEnoughForAnError) {
  if (vitrine::test::kSanitized) GTEST_SKIP() << "the sanitizer ends the process without memory";
  const Driver driver;
  int errors = 0, ran = 0;
  for (rlim_t more = 0; more < (rlim_t{4} << 20); more += rlim_t{12} << 10) {
    const End end = run_in_child([&] { limit(RLIMIT_AS, address_space() + more); });
    ASSERT_TRUE(end == End::kRan || end == End::kError) << static_cast<int>(end) << " with " << more << " bytes";
    ++(end == End::kRan ? ran : errors);
  }
  EXPECT_GT(errors, 3);
  EXPECT_GT(ran, 3);
}

TEST(Loaded, AnyNumberOfFilesIsEnough) {
  const Driver driver;
  for (rlim_t files = 3; files < 8; ++files) {
    const End end = run_in_child([&] { limit(RLIMIT_NOFILE, files); });
    EXPECT_TRUE(end == End::kRan || end == End::kError) << static_cast<int>(end) << " with " << files;
  }
}

/// A system call fails from here on, for all threads.
void refuse(int call, int error) {
  sock_filter filter[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                          BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1),
                          BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error)),
                          BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
  const sock_fprog program{std::size(filter), filter};
  ASSERT_EQ(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), 0);
  ASSERT_EQ(syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program), 0);
}

TEST(Loaded, WithoutThreadsTheCallerDraws) {
  const Driver driver;
  EXPECT_EQ(run_in_child([] {
              refuse(SYS_clone3, EAGAIN);
              refuse(SYS_clone, EAGAIN);
            }),
            End::kRan);
}

TEST(Loaded, WithoutMappingsThereIsAnError) {
  const Driver driver;
  const End end = run_in_child([] { refuse(SYS_mmap, ENOMEM); });
  EXPECT_TRUE(end == End::kRan || end == End::kError) << static_cast<int>(end);
}

}  // namespace
}  // namespace vitrine::icd::test

int main(int count, char** words) {
  ::testing::InitGoogleTest(&count, words);
  if (count != 2) return std::fprintf(stderr, "usage: loaded_test LIBVITRINE_ICD_SO\n"), 2;
  library = words[1];
  return RUN_ALL_TESTS();
}
