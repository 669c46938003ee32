// See byte_set.h.
#include "glass/sync/byte_set.h"

#include <algorithm>
#include <bit>

namespace vitrine::glass::sync {

void ByteSet::add(const ByteSet& other) {
  for (const auto& [number, words] : other.pages_) {
    Words& mine = page(number);
    for (std::size_t i = 0; i < words.size(); ++i) mine[i] |= words[i];
  }
}

std::vector<Range> ByteSet::ranges() const {
  std::vector<std::uint64_t> numbers;
  for (const auto& [number, words] : pages_) numbers.push_back(number);
  std::ranges::sort(numbers);
  std::vector<Range> ranges;
  for (const std::uint64_t number : numbers) {
    std::uintptr_t first = number * kPageBytes;
    for (std::uint64_t word : pages_.at(number)) {
      for (std::uint32_t at = 0; word != 0;) {
        const auto gap = static_cast<std::uint32_t>(std::countr_zero(word));
        at += gap;
        word >>= gap;
        const auto run = static_cast<std::uint32_t>(std::countr_one(word));
        append(ranges, first + at, first + at + run);
        at += run;
        word = run == 64 ? 0 : word >> run;
      }
      first += 64;
    }
  }
  return ranges;
}

}  // namespace vitrine::glass::sync
