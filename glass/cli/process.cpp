// Runs an application (posix_spawn(3)) and waits for it and for signals at the same time.
#include "glass/cli/process.h"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vitrine::glass::cli {
namespace {

constexpr int kForwarded[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};

/// Holds signals back, so that wait_for() sees them.
class HeldSignals {
 public:
  HeldSignals() {
    ::sigemptyset(&held_);
    ::sigaddset(&held_, SIGCHLD);
    for (const int number : kForwarded) ::sigaddset(&held_, number);
    ::sigprocmask(SIG_BLOCK, &held_, &before_);
  }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
  ~HeldSignals() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }

  const sigset_t& held() const { return held_; }
  const sigset_t& before() const { return before_; }

 private:
  sigset_t held_, before_;
};

/// Our environment with the additions: "NAME=value".
std::vector<std::string> merged(const Environment& additions) {
  std::vector<std::string> result;
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text = *entry;
    if (!additions.contains(std::string(text.substr(0, text.find('='))))) result.emplace_back(text);
  }
  for (const auto& [name, value] : additions) result.push_back(name + "=" + value);
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// The error of posix_spawnp; 0: none.
int spawn(pid_t& child, std::vector<std::string> command, const Environment& environment, const sigset_t& mask) {
  std::vector<std::string> variables = merged(environment);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setsigmask(&attributes, &mask);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int error = ::posix_spawnp(&child, command[0].c_str(), nullptr, &attributes, pointers(command).data(),
                                   pointers(variables).data());
  ::posix_spawnattr_destroy(&attributes);
  return error;
}

/// A child inherits that a signal is ignored.
class IgnoredInterrupt {
 public:
  explicit IgnoredInterrupt(bool ignored) : ignored_(ignored) {
    if (!ignored_) return;
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGINT, &ignore, &before_);
  }
  IgnoredInterrupt(const IgnoredInterrupt&) = delete;
  IgnoredInterrupt& operator=(const IgnoredInterrupt&) = delete;
  ~IgnoredInterrupt() {
    if (ignored_) ::sigaction(SIGINT, &before_, nullptr);
  }

 private:
  bool ignored_;
  struct sigaction before_ {};
};

Ending wait_for(pid_t child, const sigset_t& held, const Interrupted& interrupted) {
  for (;;) {
    siginfo_t info{};
    const int number = ::sigwaitinfo(&held, &info);
    // Signals of the terminal (SI_KERNEL) go to all of its foreground processes.
    if (number == SIGINT && interrupted) {
      if (!interrupted()) ::kill(child, SIGTERM);
    } else if (number > 0 && number != SIGCHLD && info.si_code <= 0) {
      ::kill(child, number);
    }
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) != child) continue;
    if (WIFEXITED(status)) return {"", WEXITSTATUS(status), 0};
    return {"", 128 + WTERMSIG(status), WTERMSIG(status)};
  }
}

}  // namespace

Ending run_to_end(const std::vector<std::string>& command, const Environment& environment,
                  const Interrupted& interrupted) {
  const HeldSignals signals;
  pid_t child = 0;
  {
    const IgnoredInterrupt ignored(interrupted != nullptr);
    if (const int error = spawn(child, command, environment, signals.before())) return {std::strerror(error), 0, 0};
  }
  return wait_for(child, signals.held(), interrupted);
}

}  // namespace vitrine::glass::cli
