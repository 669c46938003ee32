// What workgroups without races did to shared memory, step by step: one that does the same, step by step, has no races
// there either, and nothing of it need be recorded. Most workgroups of most dispatches do what the first one did, also
// where nobody can tell that from the shader (spirv/lower/alike.h): behind a bound that holds for all but the last
// ones, or with offsets from data that says the same everywhere.
//
// What is told of a workgroup that leaves the way of another is the same as if it had never been on it: what it did
// since the last barrier is recorded before it goes on; everything before the barrier is ordered.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/lanes.h"
#include "glass/race/conflict.h"
#include "glass/race/rows.h"
#include "glass/race/span.h"

namespace vitrine::glass::race {

/// Of one thread. It keeps the ways of one program.
class Follower {
 public:
  enum class Way : std::uint8_t {
    kSame,  ///< that of another workgroup, which had no races: the access need not be recorded
    kLeft,  ///< no longer: what came since the last barrier is to be recorded first (for_each_since_barrier())
    kOwn,   ///< the access is recorded
  };
  /// That a store writes, by component; or null.
  using Values = const std::uint32_t* [4];

  /// A workgroup begins, whose accesses to shared memory nothing but barriers orders. `bytes`: of the memory.
  void begin(const Told& program, std::uint32_t bytes);
  /// One that does not follow and is not followed.
  void skip() { state_ = State::kAlone; }
  /// It has ended. `quiet`: nothing of it has raced in shared memory.
  void end(bool quiet);
  /// Whether access() may say something else than Way::kOwn, or has to be told.
  bool is_on() const { return state_ != State::kAlone; }

  /// `lanes`, one at least, of the wave whose lane 0 is invocation `first` come to a site that accesses shared memory.
  Way access(std::uint32_t site, std::uint32_t first, base::LaneMask lanes, const Offsets& offsets,
             const Values& values) {
    if (state_ == State::kFollows && at_ < ways_[way_].size()) {
      const Step& next = ways_[way_][at_];
      if (is(next, site, first, lanes, offsets)) {
        if (next.stored != 0) keep(values);
        ++at_;
        return Way::kSame;
      }
    }
    return access_other(site, first, lanes, offsets, values);
  }
  /// A barrier has ordered shared memory.
  void barrier();
  /// Something that ways do not have comes next: no workgroup of the program follows from now on. True: this one did,
  /// as Way::kLeft.
  bool give_up();

  /// Calls f(site, first, lanes, offsets, values) for each access since the last barrier.
  template <class F>
  void for_each_since_barrier(F&& f) const {
    std::uint32_t words[base::kWaveWidth];
    std::size_t kept = 0;
    for (std::size_t i = since_barrier_; i < at_; ++i) {
      const Step& step = ways_[way_][i];
      Values values = {};
      for (std::uint32_t c = 0; c < 4; ++c)
        if ((step.stored >> c & 1) != 0) values[c] = values_[kept++].lane;
      for (std::size_t lane = 0; lane < base::kWaveWidth && step.more != nullptr; ++lane)
        words[lane] = step.base + step.more[lane];
      const Offsets offsets = step.more != nullptr ? Offsets{words} : Offsets{nullptr, step.base, 0};
      f(step.site, step.first, step.lanes, offsets, values);
    }
  }

 private:
  enum class State : std::uint8_t { kAlone, kFollows, kLeads };
  struct Step {
    std::uint32_t site = 0;    ///< or kBarrier
    std::uint32_t first = 0;   ///< invocation of lane 0
    std::uint32_t base = 0;    ///< offset of the first of `lanes`
    std::uint32_t stored = 0;  ///< components, a bit each
    base::LaneMask lanes = 0;
    const std::uint32_t* more = nullptr;  ///< than `base`, in `patterns_`: offsets by lane; null: they are all the same
    bool operator==(const Step&) const = default;
  };
  using Steps = std::vector<Step>;
  static constexpr std::uint32_t kBarrier = ~0u;
  // What a program's ways may take; beyond it, or if hardly anybody follows, nobody does.
  static constexpr std::size_t kMostWays = 4, kMostSteps = 1 << 15, kMostPatterns = 256, kMostValues = 1024;
  static constexpr std::uint32_t kMostFailures = 16;

  static bool is(const Step& step, std::uint32_t site, std::uint32_t first, base::LaneMask lanes,
                 const Offsets& offsets) {
    if (step.site != site || step.first != first || step.lanes != lanes) return false;
    if (offsets.words == nullptr || step.more == nullptr)
      return offsets.words == nullptr && step.more == nullptr && step.base == offsets.lane_0;
    return are_behind(offsets.words, lanes, step.base, step.more);
  }
  Way access_other(std::uint32_t site, std::uint32_t first, base::LaneMask lanes, const Offsets& offsets,
                   const Values& values);
  /// Another way that has been the same up to here and goes on with a step that fits. False: there is none.
  template <class F>
  bool find_other(F&& fits);
  /// The workgroup goes on alone, or leads.
  void leave();
  /// False: there are too many.
  bool find_pattern(const Offsets& offsets, base::LaneMask lanes, Step& step);
  void lead(const Step& step);
  void keep(const Values& values);

  const Told* program_ = nullptr;
  std::uint32_t bytes_ = 0, failures_ = 0;
  State state_ = State::kAlone;
  std::vector<Steps> ways_;
  std::vector<base::WaveRegister> patterns_;  ///< they stay where they are
  std::size_t way_ = 0;                       ///< that is followed
  std::size_t at_ = 0, since_barrier_ = 0;    ///< steps of it
  Steps own_;                                 ///< of one that leads
  std::vector<base::WaveRegister> values_;    ///< that one which follows has stored since the last barrier
  std::size_t stores_ = 0;                    ///< components that one which leads has stored since then
};

}  // namespace vitrine::glass::race
