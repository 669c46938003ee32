// The driver in a process that has locked itself in: after vkCreateDevice only the system calls that docs/security.md
// lists are left, and no page may become executable.
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "tests/icd/small_program.h"
#include "tests/sanitized.h"

namespace vitrine::icd::test {
namespace {

// docs/security.md has the same list. What the C library does for the process itself stands last.
constexpr int kNeeded[] = {SYS_futex,           SYS_mmap,         SYS_munmap,
                           SYS_madvise,         SYS_brk,          SYS_mprotect,
                           SYS_clone3,          SYS_prctl,        SYS_sched_getaffinity,
                           SYS_rt_sigprocmask,  SYS_rt_sigaction, SYS_rseq,
                           SYS_set_robust_list, SYS_exit,         SYS_write,
                           SYS_exit_group};

sock_filter load(std::size_t offset) { return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)); }
sock_filter answer(std::uint32_t value) { return BPF_STMT(BPF_RET | BPF_K, value); }

/// Refuses pages that are executable (the low half of the third argument of mmap and mprotect), and all calls that are
/// not among `allowed`, with SIGSYS.
std::vector<sock_filter> filter_of(const std::vector<int>& allowed) {
  std::vector<sock_filter> filter = {load(offsetof(seccomp_data, nr))};
  for (const int call : {SYS_mmap, SYS_mprotect}) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 4));
    filter.push_back(load(offsetof(seccomp_data, args) + 2 * sizeof(std::uint64_t)));
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, PROT_EXEC, 0, 1));
    filter.push_back(answer(SECCOMP_RET_TRAP));
    filter.push_back(load(offsetof(seccomp_data, nr)));
  }
  for (const int call : allowed) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1));
    filter.push_back(answer(SECCOMP_RET_ALLOW));
  }
  filter.push_back(answer(SECCOMP_RET_TRAP));
  return filter;
}

constexpr int kLocked = 1, kRefusedCall = 3;

extern "C" void on_refused_call(int, siginfo_t* info, void*) {
  char text[80];
  const int length = std::snprintf(text, sizeof text, "system call %d is refused\n", info->si_syscall);
  if (write(STDERR_FILENO, text, static_cast<std::size_t>(length)) < 0) _exit(kRefusedCall);
  _exit(kRefusedCall);
}

/// For all threads of the process, for good.
bool lock_in(const std::vector<int>& allowed) {
  struct sigaction action {};
  action.sa_sigaction = on_refused_call;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  std::vector<sock_filter> filter = filter_of(allowed);
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program) == 0;
}

/// The program, locked in as soon as it has its device; ends the process with 0 if it computed what it should.
[[noreturn]] void run_locked_in(const std::vector<int>& allowed) {
  Program p;
  if (make_device(p) != VK_SUCCESS) std::_Exit(kLocked);
  if (!lock_in(allowed)) std::_Exit(kLocked);
  for (const auto step : {make_resources, make_descriptors, make_render_pass, make_pipelines, record, submit})
    if (step(p) != VK_SUCCESS) std::_Exit(kLocked);
  check_results(p);
  destroy(p);
  std::_Exit(::testing::Test::HasFailure() ? kLocked : 0);
}

class Sandbox : public ::testing::Test {
 protected:
  void SetUp() override {
    if (vitrine::test::kSanitized) GTEST_SKIP() << "sanitizers make calls of their own";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
  }
};

TEST_F(Sandbox, DrawsWithTheListedSystemCallsAlone) {
  EXPECT_EXIT(run_locked_in({std::begin(kNeeded), std::end(kNeeded)}), ::testing::ExitedWithCode(0), "");
}

TEST_F(Sandbox, TheLockHolds) {
  EXPECT_EXIT(
      {
        if (lock_in({std::begin(kNeeded), std::end(kNeeded)})) getppid();
        std::_Exit(0);
      },
      ::testing::ExitedWithCode(kRefusedCall), "system call 110 is refused");
  EXPECT_EXIT(
      {
        if (lock_in({std::begin(kNeeded), std::end(kNeeded)}))
          mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        std::_Exit(0);
      },
      ::testing::ExitedWithCode(kRefusedCall), "system call 9 is refused");
}

}  // namespace
}  // namespace vitrine::icd::test
