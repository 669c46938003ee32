// Which lanes break a rule, asked of all lanes at once: that none does is found out in a few instructions of SIMD.
#pragma once

#include "glass/sanitize/operands.h"

namespace vitrine::glass::sanitize {

/// A word of an operand in all lanes, side by side.
class WordColumn {
 public:
  explicit WordColumn(const Words& words) {
    if (words.in_register() != nullptr) {
      at_ = words.in_register();
      return;
    }
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) copy_[lane] = words[lane];
    at_ = copy_;
  }
  WordColumn(const WordColumn&) = delete;
  WordColumn& operator=(const WordColumn&) = delete;
  const std::uint32_t* at() const { return at_; }

 private:
  const std::uint32_t* at_;
  alignas(64) std::uint32_t copy_[base::kWaveWidth];
};

/// Whether wrong(words of a lane...) holds in any lane, active or not.
template <class F, class... Column>
bool any_lane(F&& wrong, const Column*... columns) {
  std::uint32_t any = 0;
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
    any |= static_cast<std::uint32_t>(wrong(columns[lane]...));
  return any != 0;
}

/// The lanes of `lanes` for which wrong(words...) holds, of numbers of 32 bits.
template <class F, class... Numbers>
base::LaneMask lanes_where_words(base::LaneMask lanes, F&& wrong, const Numbers&... numbers) {
  if ((numbers.word().is_uniform() && ...)) return wrong(numbers.word()[0]...) ? lanes : 0;
  if (!any_lane(wrong, WordColumn(numbers.word()).at()...)) return 0;
  return lanes_where(lanes, [&](std::size_t lane) { return wrong(numbers.word()[lane]...); });
}

/// The same of floating-point numbers of any width.
template <class F, class... Numbers>
base::LaneMask lanes_where_floats(base::LaneMask lanes, F&& wrong, const Numbers&... numbers) {
  if (((numbers.width() == 32) && ...))
    return lanes_where_words(
        lanes, [&](auto... words) { return wrong(double{std::bit_cast<float>(words)}...); }, numbers...);
  return lanes_where(lanes, [&](std::size_t lane) { return wrong(numbers.as_float(lane)...); });
}

/// The same of integers, zero-extended.
template <class F, class... Numbers>
base::LaneMask lanes_where_bits(base::LaneMask lanes, F&& wrong, const Numbers&... numbers) {
  if (((numbers.width() == 32) && ...)) return lanes_where_words(lanes, wrong, numbers...);
  return lanes_where(lanes, [&](std::size_t lane) { return wrong(numbers.bits(lane)...); });
}

}  // namespace vitrine::glass::sanitize
