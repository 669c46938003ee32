// The parent of --isolate: children run the cases and report through a pipe; a child that dies costs one case.
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "harness/options.h"
#include "harness/recorded.h"
#include "harness/report.h"

namespace vitrine::cts {
namespace {

using Clock = std::chrono::steady_clock;

struct Worker {
  pid_t pid = -1;
  int pipe = -1;
  uint32_t first = 0, stride = 1;
  std::string buffer;   ///< received, not yet a whole line
  std::string running;  ///< full name of the case begun and not ended
  uint32_t running_index = 0;
  bool on_reference = false;  ///< the reference runs it
  std::string retried;        ///< full name of the last case that was begun again
  Clock::time_point since;
  bool done = false, killed = false;
};

void start(Worker& worker, const std::vector<std::string>& command) {
  int ends[2];
  if (pipe(ends) != 0) std::abort();
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  worker.pipe = ends[0];
  worker.buffer.clear();
  worker.running.clear();
  worker.since = Clock::now();
  worker.killed = false;
  worker.pid = fork();
  if (worker.pid == 0) {
    for (const char* name : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX", "GTEST_SHARD_STATUS_FILE"}) unsetenv(name);
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, 1);
    std::vector<std::string> words = command;
    words.push_back("--child-first=" + std::to_string(worker.first));
    words.push_back("--child-stride=" + std::to_string(worker.stride));
    words.push_back("--child-progress=" + std::to_string(ends[1]));
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv("/proc/self/exe", pointers.data());
    _exit(127);
  }
  close(ends[1]);
}

void report_failure(const std::string& name, const std::string& message) {
  std::string text = message;
  for (char& c : text)
    if (c == '\x1f') c = '\n';
  std::printf("FAILED %s\n%s  reproduce: %s\n", name.c_str(), text.c_str(), command_of(name).c_str());
  std::fflush(stdout);
}

std::string group_of(const std::string& name) { return name.substr(0, name.find('.')); }

/// A line of tell_parent.
void handle_line(Worker& worker, const std::string& line, Counts& counts) {
  if (line[0] == 'B') {
    char* end;
    worker.running_index = static_cast<uint32_t>(std::strtoul(line.c_str() + 2, &end, 10));
    worker.running = end + 1;
    worker.since = Clock::now();
    worker.on_reference = true;
    return;
  }
  if (line[0] == 'D' || line[0] == 'R') {
    worker.on_reference = line[0] == 'R';
    return;
  }
  if (line[0] == 'L') return keep_recorded_line(line.substr(2));
  Judgement judgement;
  judgement.verdict = static_cast<Verdict>(line[2] - '0');
  judgement.nan_bits = line[4] == '1';
  judgement.blank = line[6] == '1';
  judgement.message = line.substr(8);
  count(counts, group_of(worker.running), judgement);
  if (is_failure(judgement.verdict)) report_failure(worker.running, judgement.message);
  worker.running.clear();
  worker.since = Clock::now();
}

void count_crash(Worker& worker, int status, Counts& counts) {
  Judgement judgement;
  const bool of_reference = options().mutate && worker.on_reference;  // it trusts shaders; what they read is theirs
  judgement.verdict = of_reference ? Verdict::kUnsupported : Verdict::kCrashed;
  const std::string why = worker.killed         ? "  took too long\n"
                          : WIFSIGNALED(status) ? "  crashed: " + std::string(strsignal(WTERMSIG(status))) + "\n"
                                                : "  ended with status " + std::to_string(WEXITSTATUS(status)) + "\n";
  const std::string name = worker.running.empty() ? "process.start_or_exit" : worker.running;
  count(counts, group_of(name), judgement);
  if (!of_reference) report_failure(name, why);
}

/// Called at the end of a child: counts a crash and starts the next child, or is done.
void finish(Worker& worker, Counts& counts, const std::vector<std::string>& command) {
  int status = 0;
  waitpid(worker.pid, &status, 0);
  close(worker.pipe);
  const bool failed = !WIFEXITED(status) || WEXITSTATUS(status) > 1 || worker.killed;
  const bool in_case = !worker.running.empty();
  // Some long sequences of cases crash the reference (a pointer that nothing set): once more in a fresh process.
  if (in_case && worker.on_reference && !worker.killed && worker.retried != worker.running) {
    worker.retried = worker.running;
    worker.first = worker.running_index;
    start(worker, command);
    return;
  }
  if (failed || in_case) count_crash(worker, status, counts);
  if (!in_case) {
    worker.done = true;
    return;
  }
  worker.first = worker.running_index + worker.stride;
  start(worker, command);
}

void receive(Worker& worker, Counts& counts, const std::vector<std::string>& command) {
  char bytes[4096];
  const ssize_t got = read(worker.pipe, bytes, sizeof bytes);
  if (got <= 0) return finish(worker, counts, command);
  worker.buffer.append(bytes, static_cast<size_t>(got));
  for (size_t end; (end = worker.buffer.find('\n')) != std::string::npos;) {
    handle_line(worker, worker.buffer.substr(0, end), counts);
    worker.buffer.erase(0, end + 1);
  }
}

uint32_t number_from(const char* variable, uint32_t fallback) {
  const char* text = std::getenv(variable);
  return text ? static_cast<uint32_t>(std::strtoul(text, nullptr, 10)) : fallback;
}

}  // namespace

int run_isolated(const std::vector<std::string>& command) {
  const uint32_t shards = number_from("GTEST_TOTAL_SHARDS", 1), shard = number_from("GTEST_SHARD_INDEX", 0);
  std::vector<Worker> workers(options().jobs);
  for (uint32_t i = 0; i < workers.size(); ++i) {
    workers[i].first = shard + shards * i;
    workers[i].stride = shards * options().jobs;
    start(workers[i], command);
  }
  Counts counts;
  for (;;) {
    std::vector<pollfd> polls;
    std::vector<Worker*> live;
    for (Worker& worker : workers) {
      if (worker.done) continue;
      polls.push_back({worker.pipe, POLLIN, 0});
      live.push_back(&worker);
    }
    if (live.empty()) break;
    poll(polls.data(), polls.size(), 1000);
    for (size_t i = 0; i < live.size(); ++i) {
      if (polls[i].revents)
        receive(*live[i], counts, command);
      else if (Clock::now() - live[i]->since > std::chrono::seconds(options().timeout_s) && !live[i]->killed) {
        live[i]->killed = true;
        kill(live[i]->pid, SIGKILL);
      }
    }
  }
  return print_counts(counts) ? 0 : 1;
}

}  // namespace vitrine::cts
