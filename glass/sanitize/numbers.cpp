// The first NaN or infinity: an operation that makes one out of operands that are none.
#include <bit>

#include "glass/sanitize/checks.h"
#include "glass/sanitize/operands.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::Probe;
using spirv::ProbeOp;
using spirv::ProbeValue;
using spirv::Wave;

/// Lanes in which a component is a NaN or an infinity.
base::LaneMask unusual(const Number& number, base::LaneMask lanes) {
  if (number.width() == 32) {
    const Words& words = number.word();
    constexpr std::uint32_t kExponent = 0x7f800000;
    return lanes_where(lanes, [&](std::size_t l) { return (words[l] & kExponent) == kExponent; });
  }
  return lanes_where(lanes, [&](std::size_t l) { return !std::isfinite(number.as_float(l)); });
}

/// What the floating-point operands are.
struct Made {
  base::LaneMask of_numbers = 0;  ///< lanes in which none is a NaN
  base::LaneMask of_finite = 0;   ///< lanes in which none is an infinity either
};

Made made_of(const Wave& wave, const ProbeOp& op, const Probe& probe, base::LaneMask lanes) {
  Made made{lanes, lanes};
  for (std::size_t i = 0; i + 1 < probe.values.size(); ++i) {
    const ProbeValue& value = probe.values[i];
    for (std::uint32_t c = 0; value.type == 'F' && c < value.components; ++c) {
      const Number number(wave, op, value, c);
      const base::LaneMask strange = unusual(number, lanes);
      made.of_finite &= ~strange;
      made.of_numbers &= ~lanes_where(strange, [&](std::size_t l) { return std::isnan(number.as_float(l)); });
    }
  }
  return made;
}

std::string operands_text(const Wave& wave, const ProbeOp& op, const Probe& probe, std::size_t lane) {
  std::string text;
  for (std::size_t i = 0; i + 1 < probe.values.size(); ++i) {
    const ProbeValue& value = probe.values[i];
    text += i == 0 ? "" : ", ";
    if (value.components > 1) text += '(';
    for (std::uint32_t c = 0; c < value.components; ++c)
      text.append(c == 0 ? "" : ", ").append(Number(wave, op, value, c).text(lane));
    if (value.components > 1) text += ')';
  }
  return text;
}

}  // namespace

void check_number(Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe) {
  const ProbeValue& result = probe.values.back();
  const base::LaneMask lanes = real_lanes_at(wave, op);
  base::LaneMask strange = 0, not_numbers = 0;
  for (std::uint32_t c = 0; c < result.components; ++c) {
    const Number number(wave, op, result, c);
    const base::LaneMask here = unusual(number, lanes);
    if (here == 0) continue;
    strange |= here;
    not_numbers |= lanes_where(here, [&](std::size_t l) { return std::isnan(number.as_float(l)); });
  }
  if (strange == 0) return;
  const Made made = made_of(wave, op, probe, strange);
  const auto say = [&](const char* rule, base::LaneMask which, const char* what) {
    if (which == 0) return;
    reporter.report(wave, place_of(op), origin_of(probe), rule, which,
                    [&](std::size_t lane) { return what + operands_text(wave, op, probe, lane); });
  };
  say("not-a-number", made.of_numbers & not_numbers, "NaN made of ");
  say("infinity", made.of_finite & strange & ~not_numbers, "infinity made of ");
}

}  // namespace vitrine::glass::sanitize
