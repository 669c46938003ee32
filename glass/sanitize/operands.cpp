// Values that a probe reads, by lane.
#include "glass/sanitize/operands.h"

#include <bit>
#include <cstdio>

#include "base/numeric.h"

namespace vitrine::glass::sanitize {

std::uint64_t Number::bits(std::size_t lane) const {
  if (width_ == 64) return std::uint64_t{high_[lane]} << 32 | low_[lane];
  return width_ == 32 ? low_[lane] : low_[lane] & ((1u << width_) - 1);
}

std::int64_t Number::as_signed(std::size_t lane) const {
  const unsigned unused = 64 - width_;
  return static_cast<std::int64_t>(bits(lane) << unused) >> unused;
}

double Number::as_float(std::size_t lane) const {
  if (width_ == 64) return std::bit_cast<double>(bits(lane));
  if (width_ == 16) return base::half_to_float(static_cast<std::uint16_t>(bits(lane)));
  return std::bit_cast<float>(low_[lane]);
}

std::string Number::text(std::size_t lane) const {
  if (type_ == 'I') return std::to_string(as_signed(lane));
  if (type_ != 'F') return std::to_string(bits(lane));
  char text[40];
  std::snprintf(text, sizeof text, width_ == 64 ? "%.17g" : "%.9g", as_float(lane));
  return text;
}

}  // namespace vitrine::glass::sanitize
