// See rows.h. Every target gives the same results: nothing is rounded.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "glass/race/rows.cpp"
#include "glass/race/rows.h"

#include "base/simd.h"

#include <hwy/foreach_target.h>

#include "base/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::glass::race::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace lanes = vitrine::base::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint32_t, 16>;
using Signed = hn::RebindToSigned<Words>;

HWY_INLINE hn::Vec<Words> numbers_from(std::size_t first) {
  const Words d;
  return hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::uint32_t>(first)));
}

/// The invocations of words k and those behind it.
HWY_INLINE hn::Vec<Words> who_at(std::uint32_t who, std::uint32_t shift, std::size_t k) {
  return hn::Add(hn::ShiftRightSame(numbers_from(k), static_cast<int>(shift)), hn::Set(Words(), who));
}

/// Calls f(k, part) for each vector of a page that holds some of `words`: part is theirs, from bit 0 on.
template <class F>
HWY_INLINE void for_each_vector(std::uint64_t words, F&& f) {
  const std::size_t step = hn::Lanes(Words());
  const std::uint64_t all = base::first_lanes(step);
  for (std::size_t k = 0; k < kPageWords; k += step)
    if (const std::uint64_t part = words >> k & all; part != 0) f(k, part);
}

std::uint64_t others_target(const Slots& slots, const Row& row, std::uint32_t from) {
  const Words d;
  const Signed ds;
  const auto since = hn::Set(ds, static_cast<std::int32_t>(from) - 1);  // times stay far below 2^31
  std::uint64_t found = 0;
  for_each_vector(row.words, [&](std::size_t k, std::uint64_t part) {
    const auto recent = hn::Gt(hn::BitCast(ds, hn::Load(d, slots.time + k)), since);
    const auto who = who_at(row.who, row.shift, k);
    const auto other = hn::And(hn::RebindMask(d, recent), hn::Ne(hn::Load(d, slots.who + k), who));
    if (!hn::AllFalse(d, other)) found |= (lanes::lanes_mask_bits(d, other) & part) << k;
  });
  return found;
}

void put_target(Slots& slots, const Row& row) {
  const Words d;
  const auto time = hn::Set(d, row.time), site = hn::Set(d, row.site);
  const std::uint64_t all = base::first_lanes(hn::Lanes(d));
  for_each_vector(row.words, [&](std::size_t k, std::uint64_t part) {
    const auto who = who_at(row.who, row.shift, k);
    if (part == all) {
      hn::Store(who, d, slots.who + k);
      hn::Store(time, d, slots.time + k);
      hn::Store(site, d, slots.site + k);
      return;
    }
    const auto taken = lanes::lanes_mask_from_bits(d, part);
    hn::BlendedStore(who, taken, d, slots.who + k);
    hn::BlendedStore(time, taken, d, slots.time + k);
    hn::BlendedStore(site, taken, d, slots.site + k);
  });
}

void put_words_target(std::uint32_t* to, std::uint64_t words, const std::uint32_t* from, std::uint32_t lane_0,
                      std::uint32_t shift) {
  const Words d;
  const std::uint64_t all = base::first_lanes(hn::Lanes(d));
  for_each_vector(words, [&](std::size_t at, std::uint64_t part) {
    const auto k = static_cast<std::uint32_t>(at);
    if (part == all && shift == 0) return hn::Store(hn::LoadU(d, from + (lane_0 + k)), d, to + k);
    base::for_each_lane(part, [&](std::size_t i) {
      const std::uint32_t word = k + static_cast<std::uint32_t>(i);
      to[word] = from[lane_0 + (word >> shift)];
    });
  });
}

bool is_row_target(const Slots& slots, std::uint64_t words, std::uint32_t shift, Row& row) {
  const Words d;
  const auto first = static_cast<std::uint32_t>(std::countr_zero(words));
  row = {words, slots.who[first] - (first >> shift), shift, 0, 0};
  const std::uint32_t period = 1u << shift;
  alignas(64) std::uint32_t sites[16] = {};
  for (std::uint32_t k = 0; k < 16; ++k) {
    const std::uint64_t there = words & row_words(k % period, shift);
    if (there != 0) sites[k] = slots.site[std::countr_zero(there)];
  }
  const auto site = hn::Load(d, sites);
  std::uint64_t wrong = 0;
  for_each_vector(words, [&](std::size_t k, std::uint64_t part) {
    if (wrong != 0) return;
    const auto apart = hn::Or(hn::Xor(hn::Load(d, slots.who + k), who_at(row.who, shift, k)),
                              hn::Xor(hn::Load(d, slots.site + k), site));
    wrong = lanes::lanes_mask_bits(d, hn::Ne(apart, hn::Zero(d))) & part;
  });
  return wrong == 0;
}

/// What adjacent lanes differ by, going by the first two; 4 of a single one.
HWY_INLINE std::uint32_t first_step(const std::uint32_t* offsets, base::LaneMask active) {
  const int first = std::countr_zero(active);
  const base::LaneMask rest = active & (active - 1);
  if (rest == 0) return 4;
  const int second = std::countr_zero(rest);
  return (offsets[second] - offsets[first]) / static_cast<std::uint32_t>(second - first);
}

Spread spread_of_target(const std::uint32_t* offsets, base::LaneMask active) {
  const Words d;
  const auto first = static_cast<std::uint32_t>(std::countr_zero(active));
  const std::uint32_t start = offsets[first], step = first_step(offsets, active), of_lane_0 = start - first * step;
  const std::uint64_t all = base::first_lanes(hn::Lanes(d));
  auto least = hn::Set(d, start), most = least, apart = hn::Zero(d);
  for_each_vector(active, [&](std::size_t k, std::uint64_t part) {
    const auto row = hn::Add(hn::Set(d, of_lane_0), hn::Mul(numbers_from(k), hn::Set(d, step)));
    auto words = hn::LoadU(d, offsets + k);
    auto wrong = hn::Xor(words, row);
    if (part != all) {
      const auto taken = lanes::lanes_mask_from_bits(d, part);
      words = hn::IfThenElse(taken, words, hn::Set(d, start));
      wrong = hn::IfThenElseZero(taken, wrong);
    }
    least = hn::Min(least, words);
    most = hn::Max(most, words);
    apart = hn::Or(apart, wrong);
  });
  Spread spread{hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, most)), 0};
  const bool even = hn::AllTrue(d, hn::Eq(apart, hn::Zero(d)));
  if (even && (step == 4 || step == 8 || step == 16)) spread.step = step;
  return spread;
}

std::uint32_t step_of_target(const std::uint32_t* offsets, base::LaneMask active) {
  const Words d;
  const std::uint32_t step = first_step(offsets, active);
  if (step != 4 && step != 8 && step != 16) return 0;
  const auto first = static_cast<std::uint32_t>(std::countr_zero(active));
  const std::uint32_t of_lane_0 = offsets[first] - first * step;
  const std::uint64_t all = base::first_lanes(hn::Lanes(d));
  for (std::size_t k = 0; k < base::kWaveWidth; k += hn::Lanes(d)) {
    const auto row = hn::Add(hn::Set(d, of_lane_0), hn::Mul(numbers_from(k), hn::Set(d, step)));
    const auto wrong = hn::Ne(hn::LoadU(d, offsets + k), row);
    if (!hn::AllFalse(d, wrong) && (lanes::lanes_mask_bits(d, wrong) & (active >> k & all)) != 0) return 0;
  }
  return step;
}

bool are_behind_target(const std::uint32_t* offsets, base::LaneMask active, std::uint32_t base,
                       const std::uint32_t* more) {
  const Words d;
  const auto start = hn::Set(d, base);
  const auto wrong = [&](std::size_t k) {
    return hn::Xor(hn::LoadU(d, offsets + k), hn::Add(hn::LoadU(d, more + k), start));
  };
  auto apart = hn::Zero(d);
  if (active == base::kAllLanes)
    for (std::size_t k = 0; k < base::kWaveWidth; k += hn::Lanes(d)) apart = hn::Or(apart, wrong(k));
  else
    for_each_vector(active, [&](std::size_t k, std::uint64_t part) {
      apart = hn::Or(apart, hn::IfThenElseZero(lanes::lanes_mask_from_bits(d, part), wrong(k)));
    });
  return hn::AllTrue(d, hn::Eq(apart, hn::Zero(d)));
}

bool pack_offsets_target(const std::uint32_t* offsets, base::LaneMask active, std::uint16_t* packed) {
  const Words d;
  const hn::Rebind<std::uint16_t, Words> half;
  const std::uint64_t all = base::first_lanes(hn::Lanes(d));
  auto bits = hn::Zero(d);
  for (std::size_t k = 0; k < base::kWaveWidth; k += hn::Lanes(d)) {
    auto words = hn::LoadU(d, offsets + k);
    const std::uint64_t part = active >> k & all;
    if (part != all) words = hn::IfThenElseZero(lanes::lanes_mask_from_bits(d, part), words);
    bits = hn::Or(bits, words);
    hn::StoreU(hn::DemoteTo(half, hn::BitCast(Signed(), words)), half, packed + k);
  }
  return hn::AllTrue(d, hn::Eq(hn::ShiftRight<16>(bits), hn::Zero(d)));
}

}  // namespace vitrine::glass::race::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::glass::race {

HWY_EXPORT(others_target);
HWY_EXPORT(put_target);
HWY_EXPORT(put_words_target);
HWY_EXPORT(is_row_target);
HWY_EXPORT(spread_of_target);
HWY_EXPORT(step_of_target);
HWY_EXPORT(pack_offsets_target);
HWY_EXPORT(are_behind_target);

std::uint64_t others(const Slots& slots, const Row& row, std::uint32_t from) {
  return (slots.used & row.words) != 0 ? HWY_DYNAMIC_DISPATCH(others_target)(slots, row, from) : 0;
}
void put(Slots& slots, const Row& row) {
  slots.used |= row.words;
  HWY_DYNAMIC_DISPATCH(put_target)(slots, row);
}
void put_words(std::uint32_t* to, std::uint64_t words, const std::uint32_t* from, std::uint32_t lane_0,
               std::uint32_t shift) {
  HWY_DYNAMIC_DISPATCH(put_words_target)(to, words, from, lane_0, shift);
}
bool is_row(const Slots& slots, std::uint64_t words, std::uint32_t shift, Row& row) {
  return HWY_DYNAMIC_DISPATCH(is_row_target)(slots, words, shift, row);
}
Spread spread_of(const Offsets& offsets, base::LaneMask lanes) {
  if (offsets.words == nullptr) return {offsets.lane_0, offsets.lane_0, (lanes & (lanes - 1)) == 0 ? 4u : 0u};
  return HWY_DYNAMIC_DISPATCH(spread_of_target)(offsets.words, lanes);
}
std::uint32_t step_of(const std::uint32_t* offsets, base::LaneMask lanes) {
  return HWY_DYNAMIC_DISPATCH(step_of_target)(offsets, lanes);
}
bool are_behind(const std::uint32_t* offsets, base::LaneMask lanes, std::uint32_t base, const std::uint32_t* more) {
  return HWY_DYNAMIC_DISPATCH(are_behind_target)(offsets, lanes, base, more);
}
bool pack_offsets(const std::uint32_t* offsets, base::LaneMask lanes, std::uint16_t* packed) {
  return HWY_DYNAMIC_DISPATCH(pack_offsets_target)(offsets, lanes, packed);
}

}  // namespace vitrine::glass::race
#endif
