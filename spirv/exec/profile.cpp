// A record per program: runs and nanoseconds by instruction name, collected per call and merged under a lock.
#include "spirv/exec/profile.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/lasting.h"
#include "base/log.h"

namespace vitrine::spirv::exec {
namespace {

struct Count {
  std::uint64_t runs = 0, nanoseconds = 0;
};
using Record = std::map<std::string_view, Count>;

struct Records {
  std::mutex mutex;
  std::unordered_map<const Program*, Record> programs;
};

Records& records() {
  static Records& instance = base::lasting([] { return Records(); });
  return instance;
}

std::uint64_t now() {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
          .count());
}

bool is_in(const std::vector<Instruction>& code, const Instruction* instruction) {
  return instruction >= code.data() && instruction < code.data() + code.size();
}

/// A preamble's instructions count as their own kind.
std::string_view name_of(const Program& program, const Instruction* instruction) {
  if (is_in(program.code, instruction))
    return program.notes[static_cast<std::size_t>(instruction - program.code.data())].name;
  return "(preamble)";
}

}  // namespace

bool profile_enabled() {
  static const bool enabled = base::log_enabled("shader-profile");
  return enabled;
}

void execute_profiled(Wave& wave, const Instruction* start) {
  Record record;
  wave.status = Wave::Status::kRunning;
  for (const Instruction* next = start; next != nullptr;) {
    Count& count = record[name_of(*wave.program, next)];
    const std::uint64_t before = now();
    next = next->handler(wave, next);
    count.nanoseconds += now() - before;
    ++count.runs;
  }
  Records& all = records();
  const std::lock_guard lock(all.mutex);
  Record& total = all.programs[wave.program];
  for (const auto& [name, count] : record) {
    total[name].runs += count.runs;
    total[name].nanoseconds += count.nanoseconds;
  }
}

std::string take_profile(const Program& program) {
  Record record;
  {
    Records& all = records();
    const std::lock_guard lock(all.mutex);
    const auto found = all.programs.find(&program);
    if (found == all.programs.end()) return {};
    record = std::move(found->second);
    all.programs.erase(found);
  }
  std::vector<std::pair<std::string_view, Count>> rows(record.begin(), record.end());
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.second.nanoseconds > b.second.nanoseconds; });
  std::uint64_t sum = 0;
  for (const auto& [name, count] : rows) sum += count.nanoseconds;
  std::string text = "instruction              runs       us  share\n";
  for (const auto& [name, count] : rows) {
    char line[128];
    std::snprintf(line, sizeof(line), "%-18.*s %10llu %8.1f %5.1f%%\n", static_cast<int>(name.size()), name.data(),
                  static_cast<unsigned long long>(count.runs), static_cast<double>(count.nanoseconds) * 1e-3,
                  sum == 0 ? 0.0 : 100.0 * static_cast<double>(count.nanoseconds) / static_cast<double>(sum));
    text += line;
  }
  return text;
}

}  // namespace vitrine::spirv::exec
