// See shared_log.h.
#include "glass/race/shared_log.h"

namespace vitrine::glass::race {
namespace {

constexpr std::uint32_t kPartBytes = 512;

/// Of bytes [first, end), one at least; what lies behind the last part counts as all of them.
SharedLog::Parts parts_of(std::uint64_t first, std::uint64_t end) {
  if (end > std::uint64_t{64} * kPartBytes) return ~SharedLog::Parts{0};
  return base::first_lanes((end - 1) / kPartBytes + 1) & ~base::first_lanes(first / kPartBytes);
}

}  // namespace

bool SharedLog::met(Kind kind, Parts parts) const {
  Parts others = marks_[static_cast<std::size_t>(Kind::kStore)];
  if (kind != Kind::kLoad) others |= marks_[static_cast<std::size_t>(Kind::kLoad)];
  if (kind != Kind::kAtomic) others |= marks_[static_cast<std::size_t>(Kind::kAtomic)];
  return (others & parts) != 0;
}

void SharedLog::look_at_pending() {
  std::uint32_t offsets[base::kWaveWidth];
  for (; looked_at_ < count_; ++looked_at_) {
    Entry& entry = entries_[looked_at_];
    if (!entry.even) entry.spread = spread_of(unpack(entry, offsets), entry.lanes);
    marks_[static_cast<std::size_t>(entry.kind)] |= parts_of(std::uint64_t{entry.spread.least} + entry.site_first,
                                                             std::uint64_t{entry.spread.most} + entry.site_end);
  }
}

bool SharedLog::meets(Kind kind, std::uint64_t first, std::uint64_t end) {
  look_at_pending();
  const Parts parts = parts_of(first, end);
  const bool result = met(kind, parts);
  marks_[static_cast<std::size_t>(kind)] |= parts;
  return result;
}

bool SharedLog::meets_written(Kind kind, const Doing& by, base::LaneMask lanes, const Spread& spread,
                              std::uint32_t site_first, std::uint32_t site_end) {
  constexpr std::uint32_t kFew = 32;
  if (count_ > kFew) return true;
  look_at_pending();
  const auto lane_0 = [](const Spread& of, base::LaneMask active, std::uint32_t first) {
    return of.least + first - static_cast<std::uint32_t>(std::countr_zero(active)) * of.step;
  };
  const std::uint64_t first = std::uint64_t{spread.least} + site_first, end = std::uint64_t{spread.most} + site_end;
  const std::uint32_t bytes = site_end - site_first;
  for (std::uint32_t i = 0; i < count_; ++i) {
    const Entry& entry = entries_[i];
    if (entry.kind == kind && kind != Kind::kStore) continue;
    if (std::uint64_t{entry.spread.least} + entry.site_first >= end ||
        first >= std::uint64_t{entry.spread.most} + entry.site_end)
      continue;
    const bool own = by.wave.names == nullptr && entry.first == by.wave.first && entry.even && spread.step != 0 &&
                     entry.spread.step == spread.step && bytes <= spread.step &&
                     entry.site_end - entry.site_first == bytes &&
                     lane_0(entry.spread, entry.lanes, entry.site_first) == lane_0(spread, lanes, site_first);
    if (!own) return true;
  }
  return false;
}

bool SharedLog::add_looking(Kind kind, const Doing& by, base::LaneMask lanes, const Offsets& offsets,
                            std::uint32_t site_first, std::uint32_t site_end) {
  look_at_pending();
  const Spread spread = spread_of(offsets, lanes);
  if (met(kind, parts_of(spread.least + site_first, std::uint64_t{spread.most} + site_end))) return false;
  return push(kind, by, lanes, offsets, site_first, site_end);
}

}  // namespace vitrine::glass::race
