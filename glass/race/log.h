// What workgroups of a dispatch, or waves of a draw, did to device memory, held against each other when the command's
// work is done: in the order of workgroups, whatever threads ran them.
#pragma once

#include <cstdint>
#include <vector>

#include "glass/race/pairs.h"
#include "glass/race/shadow.h"

namespace vitrine::glass::race {

/// The last access of a kind to a word, of one workgroup.
struct Detail {
  std::uint32_t who = 0, site = 0, value = 0;  ///< site: as Slots has it
};

/// Set in Detail::who's site where fragments of a pixel were in their critical section.
inline constexpr std::uint32_t kInterlocked = 1u << 31;

/// A page of one workgroup: by kind the words, and details in the order of the bits.
struct PageEntry {
  std::uint64_t page = 0;
  Who who;  ///< of the workgroup; of draws, the first of the wave
  const Told* program = nullptr;
  std::uint64_t writes = 0, reads = 0, atomics = 0;
  std::size_t first = 0;  ///< in CommandLog::details: those of writes, of reads, of atomics
  /// Of a kind, where its words are a row: as many details, for words k by k % period and relative to k / period. Else
  /// 0, one for each.
  std::uint8_t period[3] = {};
  std::size_t values = 0;  ///< in CommandLog::values: of writes that are a row, a word each
};

/// By one thread at a time.
class CommandLog {
 public:
  void add(const Told& program, const Who& who, Shadow& shadow);
  /// Takes what another one has, which is empty then.
  void take(CommandLog& other);
  /// Finds what different workgroups did to the same bytes.
  void settle(Pairs& pairs, const spirv::ObservedCommand* command);
  /// Whether it has not become so large that its memory should be given back.
  bool is_small() const;
  /// Of a dispatch.
  bool compute() const { return compute_; }
  bool empty() const { return entries_.empty(); }

 private:
  void clear();
  /// The order of workgroups.
  bool less(const PageEntry& a, const PageEntry& b) const;
  std::vector<PageEntry> entries_;
  std::vector<Detail> details_;
  std::vector<std::uint32_t> values_;
  bool compute_ = false;
};

}  // namespace vitrine::glass::race
