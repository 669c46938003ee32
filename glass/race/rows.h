// What a wave does to words, all lanes at once: 64 words of a page, and 64 offsets.
#pragma once

#include "base/lanes.h"
#include "glass/race/span.h"

namespace vitrine::glass::race {

/// Words of one page, and invocations one behind the other: one for each word, or for each two or four.
struct Row {
  std::uint64_t words = 0;  ///< of the page, a bit each
  std::uint32_t who = 0;    ///< the invocation of the page's word 0, whether it takes part or not
  std::uint32_t shift = 0;  ///< that of word k is who + (k >> shift)
  std::uint32_t time = 0, site = 0;
};

/// Words k of a page with k % (1 << shift) == residue.
constexpr std::uint64_t row_words(std::uint32_t residue, std::uint32_t shift) {
  return (shift == 0 ? ~std::uint64_t{0} : shift == 1 ? 0x5555555555555555 : 0x1111111111111111) << residue;
}

/// The words of a row to which another invocation has done something since `from`.
std::uint64_t others(const Slots& slots, const Row& row, std::uint32_t from);
/// Records the row.
void put(Slots& slots, const Row& row);
/// to[k] = from[lane_0 + (k >> shift)] for each of `words`; the sum wraps.
void put_words(std::uint32_t* to, std::uint64_t words, const std::uint32_t* from, std::uint32_t lane_0,
               std::uint32_t shift);
/// Whether the invocations of `words`, one at least, are a row with this shift, and their places depend on
/// k % (1 << shift) alone. Its time and site mean nothing.
bool is_row(const Slots& slots, std::uint64_t words, std::uint32_t shift, Row& row);

/// What offsets of some lanes have in common.
struct Spread {
  std::uint32_t least = 0, most = 0;
  std::uint32_t step = 0;  ///< from each lane to the next one: 4, 8 or 16; 0: it is another one, or none
};

/// `lanes`: one at least. Without words all offsets are the same.
Spread spread_of(const Offsets& offsets, base::LaneMask lanes);
/// Spread::step alone.
std::uint32_t step_of(const std::uint32_t* offsets, base::LaneMask lanes);
/// Whether offsets of lanes are `base` and what `more` has for them; all of it wraps.
bool are_behind(const std::uint32_t* offsets, base::LaneMask lanes, std::uint32_t base, const std::uint32_t* more);
/// Offsets go to `packed`. False: one of the lanes' is not below 2^16.
bool pack_offsets(const std::uint32_t* offsets, base::LaneMask lanes, std::uint16_t* packed);

}  // namespace vitrine::glass::race
