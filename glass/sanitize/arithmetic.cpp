// Operations with operands for which the SPIR-V specification (3.49.11 conversions, 3.49.13 arithmetic, 3.49.14 bits)
// or GLSL.std.450 leave open what they give.
#include <spirv/unified1/GLSL.std.450.h>

#include <spirv/unified1/spirv.hpp11>

#include "glass/sanitize/checks.h"
#include "glass/sanitize/lane_tests.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::Probe;
using spirv::ProbeOp;
using spirv::Wave;
using spv::Op;

/// The operands of one component of an operation.
struct Operands {
  const Wave& wave;
  const ProbeOp& op;
  const Probe& probe;
  std::uint32_t component;

  Number operator[](std::size_t i) const {
    const spirv::ProbeValue& value = probe.values[i];
    return {wave, op, value, value.components == 1 ? 0 : component};
  }
};

/// What is wrong in some lanes.
struct Fault {
  const char* rule = nullptr;
  base::LaneMask lanes = 0;
  std::string (*text)(const Operands&, std::size_t lane) = nullptr;
};

std::string of_two(const Operands& operands, std::size_t lane, const char* between) {
  return operands[0].text(lane) + between + operands[1].text(lane);
}

Fault unsigned_division(const Operands& operands, base::LaneMask lanes) {
  const Number divisor = operands[1];
  return {"division-by-zero",
          lanes_where_bits(
              lanes, [](auto by) { return by == 0; }, divisor),
          [](const Operands& o, std::size_t lane) { return of_two(o, lane, " divided by "); }};
}

Fault signed_division(const Operands& operands, base::LaneMask lanes) {
  const Number number = operands[0], divisor = operands[1];
  const std::uint64_t smallest = std::uint64_t{1} << (number.width() - 1), mask = smallest | (smallest - 1);
  const auto wrong = [=](auto by, auto divided) {
    using Bits = decltype(by);
    const bool too_large = (by == static_cast<Bits>(mask)) & (divided == static_cast<Bits>(smallest));
    return (by == 0) | too_large;
  };
  return {"division-by-zero", lanes_where_bits(lanes, wrong, divisor, number), [](const Operands& o, std::size_t lane) {
            return std::to_string(o[0].as_signed(lane)) + " divided by " + std::to_string(o[1].as_signed(lane));
          }};
}

Fault shift(const Operands& operands, base::LaneMask lanes) {
  const Number amount = operands[1];
  const std::uint32_t width = operands[0].width();
  return {"shift-too-far",
          lanes_where_bits(
              lanes, [=](auto by) { return by >= width; }, amount),
          [](const Operands& o, std::size_t lane) {
            return "shift by " + o[1].text(lane) + " of a number of " + std::to_string(o[0].width()) + " bits";
          }};
}

/// Offset and count are the operands from `first` on.
Fault bit_field(const Operands& operands, base::LaneMask lanes, std::size_t first) {
  const Number offset = operands[first], count = operands[first + 1];
  const std::uint32_t width = operands[0].width();
  const auto wrong = [=](auto from, auto bits) { return (from > width) | (bits > width) | (from + bits > width); };
  return {"bit-field-out-of-range", lanes_where_bits(lanes, wrong, offset, count),
          [](const Operands& o, std::size_t lane) {
            const std::size_t at = o.probe.values.size() - 2 - o.probe.has_result;
            return "field of " + o[at + 1].text(lane) + " bits at offset " + o[at].text(lane) + " of a number of " +
                   std::to_string(o[0].width()) + " bits";
          }};
}

std::string conversion_text(const Operands& o, std::size_t lane) {
  return "conversion of " + o[0].text(lane) +
         (o.probe.opcode == static_cast<std::uint16_t>(Op::OpConvertFToU) ? " to an unsigned integer of "
                                                                          : " to a signed integer of ") +
         std::to_string(o.probe.number) + " bits";
}

/// Probe::number is the width of the result.
Fault conversion(const Operands& operands, base::LaneMask lanes, bool is_signed) {
  const Number number = operands[0];
  const int width = static_cast<int>(operands.probe.number);
  // What becomes the lowest number when its fraction is cut off is larger than the next integer below, if doubles have
  // that; or else is the lowest itself.
  const double lowest = is_signed ? -std::ldexp(1.0, width - 1) : 0.0, below = lowest - 1;
  const double end = std::ldexp(1.0, is_signed ? width - 1 : width);
  const auto wrong = [=](double x) { return !((x > below) | (x == lowest)) | !(x < end); };
  return {"conversion-out-of-range", lanes_where_floats(lanes, wrong, number), conversion_text};
}

// ---- functions

std::string arguments_text(const Operands& o, std::size_t lane, const char* name) {
  std::string text = name;
  const std::size_t count = o.probe.values.size() - o.probe.has_result;
  for (std::size_t i = 0; i < count; ++i) text.append(i == 0 ? "(" : ", ").append(o[i].text(lane));
  return text + ")";
}

template <class F>
Fault of_first(const Operands& operands, base::LaneMask lanes, F&& wrong,
               std::string (*text)(const Operands&, std::size_t)) {
  return {"undefined-math", lanes_where_floats(lanes, wrong, operands[0]), text};
}

Fault remainder(const Operands& operands, base::LaneMask lanes) {
  return {"undefined-math",
          lanes_where_floats(
              lanes, [](double by) { return by == 0; }, operands[1]),
          [](const Operands& o, std::size_t lane) { return "remainder of " + of_two(o, lane, " divided by "); }};
}

Fault power(const Operands& operands, base::LaneMask lanes) {
  const auto wrong = [](double x, double y) { return (x < 0) | ((x == 0) & (y <= 0)); };
  return {"undefined-math", lanes_where_floats(lanes, wrong, operands[0], operands[1]),
          [](const Operands& o, std::size_t lane) { return arguments_text(o, lane, "pow"); }};
}

Fault clamp(const Operands& operands, base::LaneMask lanes) {
  const Number low = operands[1], high = operands[2];
  const auto crossed = [](auto low, auto high) { return low > high; };
  base::LaneMask wrong = 0;
  if (low.type() == 'F')
    wrong = lanes_where_floats(lanes, crossed, low, high);
  else if (low.type() == 'I')
    wrong = lanes_where(lanes, [&](std::size_t l) { return low.as_signed(l) > high.as_signed(l); });
  else
    wrong = lanes_where_bits(lanes, crossed, low, high);
  return {"undefined-math", wrong,
          [](const Operands& o, std::size_t lane) { return arguments_text(o, lane, "clamp"); }};
}

Fault smoothstep(const Operands& operands, base::LaneMask lanes) {
  const auto wrong = [](double low, double high) { return low >= high; };
  return {"undefined-math", lanes_where_floats(lanes, wrong, operands[0], operands[1]),
          [](const Operands& o, std::size_t lane) { return arguments_text(o, lane, "smoothstep"); }};
}

#define VITRINE_TEXT(name) [](const Operands& o, std::size_t lane) { return arguments_text(o, lane, name); }

Fault function(const Operands& operands, base::LaneMask lanes) {
  switch (operands.probe.number) {
    case GLSLstd450Asin:
      return of_first(
          operands, lanes, [](double x) { return std::fabs(x) > 1; }, VITRINE_TEXT("asin"));
    case GLSLstd450Acos:
      return of_first(
          operands, lanes, [](double x) { return std::fabs(x) > 1; }, VITRINE_TEXT("acos"));
    case GLSLstd450Acosh:
      return of_first(
          operands, lanes, [](double x) { return x < 1; }, VITRINE_TEXT("acosh"));
    case GLSLstd450Atanh:
      return of_first(
          operands, lanes, [](double x) { return std::fabs(x) >= 1; }, VITRINE_TEXT("atanh"));
    case GLSLstd450Log:
      return of_first(
          operands, lanes, [](double x) { return x <= 0; }, VITRINE_TEXT("log"));
    case GLSLstd450Log2:
      return of_first(
          operands, lanes, [](double x) { return x <= 0; }, VITRINE_TEXT("log2"));
    case GLSLstd450Sqrt:
      return of_first(
          operands, lanes, [](double x) { return x < 0; }, VITRINE_TEXT("sqrt"));
    case GLSLstd450InverseSqrt:
      return of_first(
          operands, lanes, [](double x) { return x <= 0; }, VITRINE_TEXT("inversesqrt"));
    case GLSLstd450Pow:
      return power(operands, lanes);
    case GLSLstd450FClamp:
    case GLSLstd450UClamp:
    case GLSLstd450SClamp:
    case GLSLstd450NClamp:
      return clamp(operands, lanes);
    case GLSLstd450SmoothStep:
      return smoothstep(operands, lanes);
    default:
      return {};
  }
}

#undef VITRINE_TEXT

Fault fault_of(const Operands& operands, base::LaneMask lanes) {
  switch (static_cast<Op>(operands.probe.opcode)) {
    case Op::OpUDiv:
    case Op::OpUMod:
      return unsigned_division(operands, lanes);
    case Op::OpSDiv:
    case Op::OpSRem:
    case Op::OpSMod:
      return signed_division(operands, lanes);
    case Op::OpFRem:
    case Op::OpFMod:
      return remainder(operands, lanes);
    case Op::OpShiftLeftLogical:
    case Op::OpShiftRightLogical:
    case Op::OpShiftRightArithmetic:
      return shift(operands, lanes);
    case Op::OpBitFieldInsert:
      return bit_field(operands, lanes, 2);
    case Op::OpBitFieldSExtract:
    case Op::OpBitFieldUExtract:
      return bit_field(operands, lanes, 1);
    case Op::OpConvertFToU:
      return conversion(operands, lanes, false);
    case Op::OpConvertFToS:
      return conversion(operands, lanes, true);
    case Op::OpExtInst:
      return function(operands, lanes);
    default:
      return {};
  }
}

}  // namespace

void check_operation(Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe) {
  base::LaneMask lanes = real_lanes_at(wave, op);
  for (std::uint32_t c = 0; c < probe.values[0].components && lanes != 0; ++c) {
    const Operands operands{wave, op, probe, c};
    const Fault fault = fault_of(operands, lanes);
    if (fault.lanes == 0) continue;
    reporter.report(wave, place_of(op), origin_of(probe), fault.rule, fault.lanes,
                    [&](std::size_t lane) { return fault.text(operands, lane); });
    lanes &= ~fault.lanes;  // an invocation counts once
  }
}

}  // namespace vitrine::glass::sanitize
