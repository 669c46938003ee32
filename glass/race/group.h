// One workgroup at a time of one thread, or all of a dispatch whose workgroups run in order: what its invocations
// access is held against what has been recorded. Of draws, one wave, whose invocations nothing orders.
#pragma once

#include "base/lanes.h"
#include "glass/race/log.h"
#include "glass/race/order.h"
#include "glass/race/shadow.h"

namespace vitrine::glass::race {

/// Bytes of one access of one lane, in a word.
struct Touch {
  std::uint64_t word = 0;    ///< address / 4; of shared memory, offset / 4
  std::uint32_t bytes = 15;  ///< of the word, a bit each
  std::uint32_t value = 0;   ///< that a store writes
};

class Group {
 public:
  explicit Group(Pairs& pairs) : pairs_(pairs) {}

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
  const Told& program() const { return *program_; }

  Order& order() { return order_; }
  /// The number of the workgroup's invocation 0.
  std::uint32_t base() const { return base_; }

  /// An access of one lane to a word.
  void touch(std::uint32_t site, std::uint32_t who, const Touch& touch);
  /// The same of 64 lanes and adjacent words, for a load or store of whole words. `values`: of stores; or null.
  void touch_row(std::uint32_t site, std::uint32_t first, std::uint64_t word, const std::uint32_t* values);
  /// The same of the words `words` of `lanes`; invocations are `names`, or `first` and those behind it.
  void touch_words(std::uint32_t site, base::LaneMask lanes, const std::uint64_t* words, std::uint32_t first,
                   const std::uint32_t* names, const std::uint32_t* values);
  /// Whether fragments of a pixel are in their critical section.
  void interlock(bool inside) { interlocked_ = inside; }

  // ---- waves of a workgroup
  /// A wave goes on behind its n-th barrier.
  void resume(std::uint32_t wave);
  void arrive(std::uint32_t wave, const spirv::MemoryOrder& order, bool alone);
  void fence(std::uint32_t wave, const spirv::MemoryOrder& order, std::uint32_t first, base::LaneMask lanes);

 private:
  struct WaveState {
    std::uint32_t rounds = 0;  ///< barriers that it has come by
    std::uint32_t fenced = 0;  ///< kinds of memory, a bit each, since the last
  };

  Page& page_of(const Site& site, std::uint64_t word);
  bool fast(const Site& site) const;
  /// Writes before this are visible to a load: those that are private never are.
  std::uint32_t writes_from(const Site& site) const;
  /// The common case: nobody else has touched the word since the last barrier. False: it is not.
  static bool load_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t from,
                           std::uint32_t writes_from);
  static bool operate_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t from);
  static bool store_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t value, std::uint32_t from);
  void check(const Slots& slots, std::uint32_t k, std::uint32_t site, std::uint32_t who, const Touch& touch,
             const Page& page);
  void tell(const Record& earlier, std::uint32_t site, std::uint32_t who, const Touch& touch, Conflict::Kind kind,
            bool equal);
  Access access_of(std::uint32_t site, std::uint32_t who) const;
  WaveState& state(std::uint32_t wave);

  Pairs& pairs_;
  const Told* program_ = nullptr;
  const spirv::ObservedCommand* command_ = nullptr;
  bool whole_ = false, interlocked_ = false;
  std::uint32_t size_ = 1, base_ = 0, generation_ = 0;
  std::vector<Who> groups_;  ///< that have begun since begin() of a whole dispatch; else one
  Order order_;
  Shadow device_;
  std::vector<Page> shared_;
  std::vector<WaveState> waves_;
  std::uint32_t rounds_ = 0;
  spirv::MemoryOrder arrived_;
  std::uint32_t arrived_fenced_ = 0;
};

}  // namespace vitrine::glass::race
