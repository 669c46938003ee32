// Floats of every width in the words of literals.
#include "spirv/rewrite/graph/literals.h"

#include <bit>

#include "base/numeric.h"

namespace vitrine::spirv::rewriting {

double literal_number(const Inst& constant, const std::array<std::uint8_t, 4>& swizzle, unsigned width) {
  const std::uint32_t low = constant.imm[swizzle[0]];
  if (width == 16) return static_cast<double>(base::half_to_float(static_cast<std::uint16_t>(low)));
  if (width == 32) return static_cast<double>(base::float_of(low));
  return std::bit_cast<double>(std::uint64_t{constant.imm[swizzle[1]]} << 32 | low);
}

void literal_words(double number, unsigned width, std::uint32_t words[2]) {
  words[1] = 0;
  if (width == 64) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    words[0] = static_cast<std::uint32_t>(bits);
    words[1] = static_cast<std::uint32_t>(bits >> 32);
  } else {
    const auto single = static_cast<float>(number);
    words[0] = width == 16 ? base::float_to_half_nearest(single) : base::bits_of(single);
  }
}

}  // namespace vitrine::spirv::rewriting
