// What a workgroup has read of shared memory since its last barrier, written down as it came and looked at only when
// somebody writes there before the next one: most never do. Atomic operations that order nothing likewise.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>

#include "glass/race/rows.h"
#include "glass/race/span.h"

namespace vitrine::glass::race {

class SharedLog {
 public:
  enum class Kind : std::uint8_t { kLoad, kStore, kAtomic };
  /// Parts of shared memory, a bit each.
  using Parts = std::uint64_t;

  /// A barrier has ordered what came before.
  void clear() {
    forget();
    marks_ = {};
  }
  /// Whether something that an access of this kind to these bytes, [first, end), may race with has come since clear().
  /// The access counts as one that has come.
  bool meets(Kind kind, std::uint64_t first, std::uint64_t end);
  /// Whether that is something which has been written down: not where other bytes of the part are meant, or each lane
  /// comes to what it alone has come to. If much has, it may be.
  bool meets_written(Kind kind, const Doing& by, base::LaneMask lanes, const Spread& spread, std::uint32_t site_first,
                     std::uint32_t site_end);

  bool empty() const { return count_ == 0; }
  bool has_atomics() const { return pending_[static_cast<std::size_t>(Kind::kAtomic)]; }
  bool is_full() const { return used_ + base::kWaveWidth > kRoom; }
  /// A load or an atomic operation, of bytes [site_first, site_end) behind offsets, is written down. False, and it is
  /// not: it may race with something, or offsets reach 2^16. Not if the log is full.
  bool add(Kind kind, const Doing& by, base::LaneMask lanes, const Offsets& offsets, std::uint32_t site_first,
           std::uint32_t site_end) {
    if (!quiet(kind)) return add_looking(kind, by, lanes, offsets, site_first, site_end);
    return push(kind, by, lanes, offsets, site_first, site_end);
  }
  /// Forgets what has been written down, but for that it has come.
  void forget() {
    count_ = used_ = looked_at_ = 0;
    pending_ = {};
  }
  /// Calls f(span, spread) for each access, in order.
  template <class F>
  void for_each(std::uint64_t size, F&& f) {
    look_at_pending();
    std::uint32_t offsets[base::kWaveWidth];
    for (std::uint32_t i = 0; i < count_; ++i) {
      const Entry& entry = entries_[i];
      f(Span{{entry.site, {entry.first, nullptr}, entry.time}, entry.lanes, unpack(entry, offsets), 0, size},
        entry.spread);
    }
  }

 private:
  struct Entry {
    std::uint32_t site, first, time;
    std::uint32_t offset;  ///< where in `packed_` those of lanes begin, if they are not even
    std::uint32_t site_first, site_end;
    base::LaneMask lanes;
    Kind kind;
    bool even;      ///< all lanes have the same offset, or they are a row: its spread has them
    Spread spread;  ///< if it is even, or has been looked at
  };
  static constexpr std::uint32_t kRoom = 16384;

  /// Whether nothing at all has come that an access of this kind, no store, may race with.
  bool quiet(Kind kind) const {
    const auto store = static_cast<std::size_t>(Kind::kStore);
    const auto other = static_cast<std::size_t>(kind == Kind::kLoad ? Kind::kAtomic : Kind::kLoad);
    return (marks_[store] | marks_[other]) == 0 && !pending_[other];
  }
  bool push(Kind kind, const Doing& by, base::LaneMask lanes, const Offsets& offsets, std::uint32_t site_first,
            std::uint32_t site_end) {
    // Written where it stays: a copy of what has just been written in parts waits for all of them.
    Entry& entry = entries_[count_];
    entry.site = by.site;
    entry.first = by.wave.first;
    entry.time = by.time;
    entry.offset = used_;
    entry.site_first = site_first;
    entry.site_end = site_end;
    entry.lanes = lanes;
    entry.kind = kind;
    if (!make_even(entry, offsets)) {
      if (!pack_offsets(offsets.words, lanes, packed_.get() + used_)) return false;
      used_ += static_cast<std::uint32_t>(base::kWaveWidth);
    } else if (entry.spread.most > UINT16_MAX || entry.spread.most < entry.spread.least) {
      return false;
    }
    ++used_;
    ++count_;
    pending_[static_cast<std::size_t>(kind)] = true;
    return true;
  }
  bool add_looking(Kind kind, const Doing& by, base::LaneMask lanes, const Offsets& offsets, std::uint32_t site_first,
                   std::uint32_t site_end);
  Offsets unpack(const Entry& entry, std::uint32_t (&offsets)[base::kWaveWidth]) const {
    const auto first = static_cast<std::uint32_t>(std::countr_zero(entry.lanes));
    if (entry.even) return {nullptr, entry.spread.least - first * entry.spread.step, entry.spread.step};
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) offsets[lane] = packed_[entry.offset + lane];
    return {offsets};
  }
  static bool make_even(Entry& entry, const Offsets& offsets) {
    const auto first = static_cast<std::uint32_t>(std::countr_zero(entry.lanes));
    const auto last =
        static_cast<std::uint32_t>(base::kWaveWidth - 1) - static_cast<std::uint32_t>(std::countl_zero(entry.lanes));
    const bool same = offsets.words == nullptr;
    const std::uint32_t step = same ? first == last ? 4 : 0 : step_of(offsets.words, entry.lanes);
    const std::uint32_t least = offsets[first];
    entry.even = same || step != 0;
    entry.spread.least = least;
    entry.spread.most = same ? least : least + (last - first) * step;
    entry.spread.step = step;
    return entry.even;
  }
  void look_at_pending();
  bool met(Kind kind, Parts parts) const;

  std::unique_ptr<Entry[]> entries_{new Entry[kRoom]};  // NOLINT(modernize-make-unique): without values
  std::uint32_t count_ = 0;                             ///< of entries
  std::unique_ptr<std::uint16_t[]> packed_ = std::make_unique<std::uint16_t[]>(kRoom);
  std::uint32_t used_ = 0;
  std::uint32_t looked_at_ = 0;       ///< of entries, whose parts are in `marks_`
  std::array<bool, 3> pending_ = {};  ///< kinds of entries
  std::array<Parts, 3> marks_ = {};   ///< by kind
};

}  // namespace vitrine::glass::race
