// The parent of the benchmark of a corpus: a child per module, then geometric mean, percentiles, and the slowest
// modules with the kinds of instructions that they spend their time with.
#include "corpus/corpus.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

namespace vitrine::bench {
namespace {

struct ModuleTimes {
  std::string name;
  double device = 0, reference = 0;                  ///< seconds per dispatch or draw
  double device_compile = 0, reference_compile = 0;  ///< seconds of the first beyond that
  bool same = true;
  double ratio() const { return reference / device; }
};

/// What a child printed; the rest is lost where it takes longer than `seconds`.
std::string output_of(const std::vector<std::string>& arguments, unsigned seconds, bool profile) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    if (const int nothing = open("/dev/null", O_WRONLY); profile) dup2(nothing, STDOUT_FILENO);
    dup2(ends[1], profile ? STDERR_FILENO : STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    if (profile) setenv("VITRINE_LOG", "shader-profile", 1);
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv("/proc/self/exe", argv.data());
    _exit(127);
  }
  close(ends[1]);
  std::string text;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  char block[4096];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd wait{ends[0], POLLIN, 0};
    if (left.count() <= 0 || poll(&wait, 1, static_cast<int>(left.count())) <= 0) break;
    const ssize_t count = read(ends[0], block, sizeof(block));
    if (count <= 0) break;
    text.append(block, static_cast<std::size_t>(count));
  }
  kill(child, SIGKILL);
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return text;
}

std::vector<std::string> child_arguments(const CorpusOptions& options, const std::string& path, int rounds) {
  return {"vitrine_bench", "--rounds=" + std::to_string(rounds), "--icd=device=" + options.manifest,
          "--corpus-module=" + path};
}

std::vector<std::string> modules_of(const CorpusOptions& options) {
  std::vector<std::string> all, some;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(options.folder))
    if (entry.path().extension() == ".spv") all.push_back(entry.path().string());
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); i += options.every) some.push_back(all[i]);
  return some;
}

struct Counts {
  int unsupported = 0, failed = 0, silent = 0, different = 0;
};

std::vector<ModuleTimes> time_modules(const CorpusOptions& options, Counts& counts) {
  std::vector<ModuleTimes> all;
  for (const std::string& path : modules_of(options)) {
    std::istringstream text(output_of(child_arguments(options, path, options.rounds), options.timeout_s, false));
    std::string what;
    ModuleTimes times;
    times.name = path;
    text >> what;
    if (what == "unsupported") {
      ++counts.unsupported;
    } else if (what == "times" && text >> times.device >> times.reference >> times.device_compile >>
                                      times.reference_compile >> times.same) {
      counts.different += !times.same;
      if (!times.same) std::printf("outputs differ: %s\n", path.c_str());
      if (std::isfinite(times.ratio()) && times.ratio() > 0) all.push_back(times);
    } else {
      ++(what == "failed" ? counts.failed : counts.silent);
      std::printf("%s: %s\n", what == "failed" ? "failed" : "crashed or hung", path.c_str());
    }
    std::fflush(stdout);
  }
  return all;
}

template <class Value>
double geometric_mean(const std::vector<ModuleTimes>& all, Value&& value) {
  double sum = 0;
  std::size_t count = 0;
  for (const ModuleTimes& times : all) {
    if (value(times) <= 0) continue;
    sum += std::log(value(times));
    ++count;
  }
  return std::exp(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
}

/// The kinds of instructions with the greatest shares, as the driver's own profile tells them.
std::string shares_of(const CorpusOptions& options, const std::string& path) {
  std::istringstream text(output_of(child_arguments(options, path, 1), options.timeout_s, true));
  std::vector<std::pair<double, std::string>> shares;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string name;
    double runs, us, share;
    char percent;
    if (words >> name >> runs >> us >> share >> percent && percent == '%') shares.emplace_back(us, name);
  }
  double sum = 0;
  for (const auto& [us, name] : shares) sum += us;
  std::sort(shares.rbegin(), shares.rend());
  std::ostringstream out;
  for (std::size_t i = 0; i < shares.size() && i < 5; ++i)
    out << (i == 0 ? "" : ", ") << shares[i].second << ' ' << std::lround(100 * shares[i].first / sum) << '%';
  return out.str();
}

void print_summary(const std::vector<ModuleTimes>& sorted, const Counts& counts) {
  std::printf("%zu modules timed, %d not runnable here, %d failed, %d crashed or hung, %d with different outputs\n",
              sorted.size(), counts.unsupported, counts.failed, counts.silent, counts.different);
  if (sorted.empty()) return;
  std::printf("times lavapipe: geometric mean %.2f", geometric_mean(sorted, [](const auto& t) { return t.ratio(); }));
  for (const int percentile : {5, 25, 50, 75, 95})
    std::printf(", %d%%: %.2f", percentile,
                sorted[(sorted.size() - 1) * static_cast<std::size_t>(percentile) / 100].ratio());
  std::printf("\nfirst submission beyond that, with its pipeline: %.2f ms, lavapipe %.2f ms (geometric means)\n",
              geometric_mean(sorted, [](const auto& t) { return t.device_compile; }) * 1e3,
              geometric_mean(sorted, [](const auto& t) { return t.reference_compile; }) * 1e3);
}

}  // namespace

int run_corpus(const CorpusOptions& options) {
  Counts counts;
  std::vector<ModuleTimes> all = time_modules(options, counts);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.ratio() < b.ratio(); });
  print_summary(all, counts);
  for (std::size_t i = 0; i < all.size() && i < 30; ++i) {
    std::printf("%5.2f %8.1f us %8.1f us  %s: %s\n", all[i].ratio(), all[i].device * 1e6, all[i].reference * 1e6,
                std::filesystem::path(all[i].name).stem().c_str(), shares_of(options, all[i].name).c_str());
    std::fflush(stdout);
  }
  return counts.different == 0 ? 0 : 1;
}

}  // namespace vitrine::bench
