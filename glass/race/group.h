// One workgroup at a time of one thread, or all of a dispatch whose workgroups run in order: what its invocations
// access is held against what has been recorded. Of draws, one wave, whose invocations nothing orders.
#pragma once

#include "base/lanes.h"
#include "glass/race/follow.h"
#include "glass/race/log.h"
#include "glass/race/order.h"
#include "glass/race/rows.h"
#include "glass/race/shared_log.h"

namespace vitrine::glass::race {

/// Bytes of one access of one lane, in a word.
struct Touch {
  std::uint64_t word = 0;    ///< address / 4; of shared memory, offset / 4
  std::uint32_t bytes = 15;  ///< of the word, a bit each
  std::uint32_t value = 0;   ///< that a store writes
};

class Group {
 public:
  /// `by_word`: nothing is looked at all at once or later. It finds the same.
  explicit Group(Pairs& pairs, bool by_word = false) : pairs_(pairs), by_word_(by_word) {}

  /// A workgroup or wave of `program` begins. `whole`: its workgroups run in order and may order each other, so that
  /// what earlier ones did is kept.
  void begin(const Told& program, const spirv::ObservedCommand* command, const Who& who, bool whole,
             std::uint32_t shared_bytes);
  /// What has been recorded goes into a log, to be held against what other workgroups did; it is forgotten.
  void end(CommandLog& log);
  bool is_open() const { return program_ != nullptr; }
  bool is_whole() const { return whole_; }
  /// Whether it is what begin() was called with last.
  bool runs(const Told& program, const spirv::ObservedCommand* command) const {
    return program_ == &program && command_ == command;
  }
  const spirv::ObservedCommand* command() const { return command_; }
  /// Whether nothing has raced in shared memory since begin().
  bool shared_is_quiet() const { return shared_is_quiet_; }
  const Told& program() const { return *program_; }

  const Order& order() const { return order_; }
  /// The number of the workgroup's invocation 0.
  std::uint32_t base() const { return base_; }

  /// An access of one lane to a word.
  void touch(const Doing& by, std::uint32_t who, const Touch& touch);
  /// The same of some bytes.
  void touch_bytes(const Doing& by, std::uint32_t who, std::uint64_t address, std::uint32_t count, std::uint32_t value);
  /// The same of what an instruction does to memory; what lies outside of it is another tool's.
  void touch_span(const Span& span);
  /// The same of shared memory, where it is no load or atomic operation that log_shared() takes.
  void touch_shared(const Span& span);
  /// A load or atomic operation of shared memory is written down, to be looked at when somebody can race with it.
  /// False: that may be so now.
  bool log_shared(const Doing& by, base::LaneMask lanes, const Offsets& offsets);
  /// Whether the workgroup does what another one did that had no races in shared memory, so far: then an access of it
  /// need not be recorded. `lanes`: one at least.
  bool follows(std::uint32_t site, std::uint32_t first, base::LaneMask lanes, const Offsets& offsets,
               const Follower::Values& values) {
    const Follower::Way way = follower_.access(site, first, lanes, offsets, values);
    if (way == Follower::Way::kSame) return true;
    if (way == Follower::Way::kLeft) record_followed();
    return false;
  }
  /// Something comes next that is not followed.
  void stop_following();
  /// Whether follows() has to be asked.
  bool may_follow() const { return follower_.is_on(); }
  /// Whether fragments of a pixel are in their critical section.
  void interlock(bool inside) { interlocked_ = inside; }

  // ---- waves of a workgroup
  /// A wave goes on behind its n-th barrier.
  void resume(std::uint32_t wave);
  void arrive(std::uint32_t wave, const spirv::MemoryOrder& order, bool alone);
  void fence(std::uint32_t wave, const spirv::MemoryOrder& order, const WaveNames& names, base::LaneMask lanes);
  void subgroup_barrier(const spirv::MemoryOrder& order, std::uint32_t first);

 private:
  struct WaveState {
    std::uint32_t rounds = 0;  ///< barriers that it has come by
    std::uint32_t fenced = 0;  ///< kinds of memory, a bit each, since the last
  };

  Page& page_of(const Site& site, std::uint64_t word);
  /// What has been written down of shared memory is recorded.
  void settle_shared();
  /// What the workgroup did since the last barrier, while it followed another one, is recorded.
  void record_followed();
  /// All of the workgroup have come by a barrier.
  void pass_barrier(std::uint32_t rounds);
  bool fast(const Site& site) const;
  /// Writes before this are visible to a load: those that are private never are.
  std::uint32_t writes_from(const Site& site) const;
  void touch_spread(const Span& span, const Spread& spread);
  /// Words at even distances, or some for each of the lanes. False: they are not.
  bool touch_rows(const Span& span, const Spread& spread);
  /// `offset`: of the first lane.
  void touch_row(const Span& span, std::uint32_t offset, std::uint32_t step, const std::uint32_t* values);
  /// The part of it in a page, whose word 0 is `word`. `values`: of stores, by lane.
  void touch_page(const Doing& by, Page& page, std::uint64_t word, const Row& row, const std::uint32_t* values);
  void touch_part(const Span& span, std::uint32_t part);
  /// Whole words of lanes.
  void touch_words(const Doing& by, base::LaneMask lanes, const std::uint64_t* words, const std::uint32_t* values);
  /// The common case: nobody else has touched the word since the last barrier. False: it is not.
  bool touch_quickly(const Site& site, const Record& record, std::uint64_t word, std::uint32_t value);
  void check(const Slots& slots, std::uint32_t k, std::uint32_t site, std::uint32_t who, const Touch& touch,
             const Page& page);
  void tell(const Record& earlier, std::uint32_t site, std::uint32_t who, const Touch& touch, Conflict::Kind kind,
            bool equal);
  Access access_of(std::uint32_t site, std::uint32_t who) const;
  WaveState& state(std::uint32_t wave);

  Pairs& pairs_;
  const bool by_word_;
  const Told* program_ = nullptr;
  const spirv::ObservedCommand* command_ = nullptr;
  bool whole_ = false, interlocked_ = false;
  std::uint32_t size_ = 1, base_ = 0, generation_ = 0;
  std::vector<Who> groups_;  ///< that have begun since begin() of a whole dispatch; else one
  Order order_;
  Shadow device_;
  std::vector<Page> shared_;
  std::uint32_t shared_bytes_ = 0;
  bool shared_is_quiet_ = true;
  bool logs_loads_ = false;  ///< fast() of loads of shared memory
  SharedLog log_;
  Follower follower_;
  std::vector<WaveState> waves_;
  std::uint32_t rounds_ = 0;
  spirv::MemoryOrder arrived_;
  std::uint32_t arrived_fenced_ = 0;
};

}  // namespace vitrine::glass::race
