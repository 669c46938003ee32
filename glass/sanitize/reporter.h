// What the checks of the sanitizer share: places in a program with what was found there, and the way from the lanes of
// a wave to a finding.
#pragma once

#include <array>
#include <bit>
#include <map>
#include <mutex>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "glass/place.h"
#include "spirv/exec/invocation.h"
#include "spirv/observed_command.h"

namespace vitrine::glass::sanitize {

using Id = std::array<std::uint32_t, 3>;  ///< of an invocation, as spirv::exec::invocation_of()

/// What tells the accesses of a program apart: the SPIR-V instruction, or, for stores, which have no id, what they
/// store to, on a line and on its way of calls. So what the compiler makes of one access, by parts or in unrolled
/// rounds of a loop, is one place.
std::uint64_t place_of_access(const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note);

/// What comes first is reported: submission, command, rows of invocations downwards.
using Order = std::tuple<std::uint64_t, std::uint32_t, Id>;

/// Findings of one program, one for each place and rule, until they are taken.
class Places {
 public:
  using Key = std::tuple<std::uint64_t, std::string_view>;  ///< what tells places of a program apart, rule

  /// `make` gives the finding; called for the first invocation only, and for those before it in order.
  template <class F>
  void add(const Key& key, std::uint64_t count, const Order& order, F&& make) {
    const std::lock_guard lock(mutex_);
    const auto [at, added] = findings_.try_emplace(key);
    Entry& entry = at->second;
    entry.count += count;
    if (!added && (entry.delivered || entry.order <= order)) return;
    entry.order = order;
    entry.finding = make();
  }

  /// Whether the finding has been taken: there is nothing more to say about the place.
  bool is_told(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto at = findings_.find(key);
    return at != findings_.end() && at->second.delivered;
  }

  void take(std::vector<Finding>& to) {
    const std::lock_guard lock(mutex_);
    for (auto& [key, entry] : findings_) {
      if (std::exchange(entry.delivered, true)) continue;
      entry.finding.count = entry.count;
      to.push_back(std::move(entry.finding));
    }
  }

 private:
  struct Entry {
    std::uint64_t count = 0;
    Order order;
    Finding finding;
    bool delivered = false;
  };
  std::mutex mutex_;
  std::map<Key, Entry> findings_;
};

/// What the sanitizer keeps of one program.
struct ProgramPlaces {
  ProgramPlaces(const ShaderIdentity& shader, const spirv::Program& program) : context(shader, program) {}
  const ShaderContext context;
  Places places;
};

/// Reports what the lanes of one wave do.
class Reporter {
 public:
  Reporter(ProgramPlaces& program, const spirv::Wave& wave) : program_(program), invocations_(wave) {}

  VkShaderStageFlagBits stage() const { return program_.context.stage; }
  ProgramPlaces& program() const { return program_; }
  Id invocation(const spirv::Wave& wave, std::size_t lane) const { return invocations_(wave, lane); }
  static Order order_of(const spirv::Wave& wave, const Id& id) {
    const spirv::ObservedCommand* command = wave.resources->command;
    return {command ? command->submission : 0, command ? command->command : 0, rows_first(id)};
  }

  /// `lanes` broke a rule at a place: `place` tells it apart, `message` says what the lane that it is given did.
  template <class F>
  void report(const spirv::Wave& wave, std::uint64_t place, const spirv::ir::Origin& origin, const char* rule_id,
              base::LaneMask lanes, F&& message) {
    auto first_lane = static_cast<std::size_t>(std::countr_zero(lanes));
    Id first = invocations_(wave, first_lane);
    base::for_each_lane(lanes, [&](std::size_t lane) {
      const Id id = invocations_(wave, lane);
      if (rows_first(id) < rows_first(first)) first = id, first_lane = lane;
    });
    const auto count = static_cast<std::uint64_t>(std::popcount(lanes));
    program_.places.add({place, rule_id}, count, order_of(wave, first), [&] {
      Finding finding;
      finding.rule = &rule(rule_id);
      finding.message = message(first_lane);
      finding.address = program_.context.address(wave, first, origin.spirv_id, origin.place);
      return finding;
    });
  }

  /// The same for an access.
  template <class F>
  void report(const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note,
              const char* rule_id, base::LaneMask lanes, F&& message) {
    report(wave, place_of_access(wave, i, note), note.origin, rule_id, lanes, std::forward<F>(message));
  }

 private:
  /// Rows down, as Id has x first.
  static Id rows_first(const Id& id) { return {id[2], id[1], id[0]}; }

  ProgramPlaces& program_;
  const spirv::exec::Invocations invocations_;
};

}  // namespace vitrine::glass::sanitize
