// GLSL.std.450: inverse trigonometric and hyperbolic functions as the reference's polynomials
// (lavapipe-shader-math.md 5.4), determinant and inverse (5.1), packing (8).
#include "spirv/front/functions.h"
#include "spirv/front/glsl450.h"

namespace vitrine::spirv::front::glsl {
namespace {

constexpr float kHalfPi = 1.57079632679489661923f;
constexpr float kQuarterPi = 0.78539816339744830962f;

/// binary16 would lose too much in the polynomials of asin: the reference computes them in binary32.
Expr single_of(const Expr& x) { return x.width == 16 ? convert_float(x, 32) : x; }

/// Main formula of asin, good to first order at 0 and +-1 for any p0, p1.
Expr asin_main(Expr x, float p0, float p1) {
  Translator& t = *x.t;
  const Expr size = abs(x);
  Expr tail = multiply_add(size, p1, p0);
  tail = multiply_add(size, tail, kQuarterPi - 1.0f);
  tail = multiply_add(size, tail, kHalfPi);
  const Expr direction = sign(x);
  const Expr root = sqrt(imm(t, 1.0f) - size);
  return direction * multiply_add(-root, tail, kHalfPi);
}

Expr asin_small(Expr x) {
  const Expr x2 = x * x;
  Expr p = multiply_add(x2, -8.6563630030e-03f, -4.2743422091e-02f);
  p = multiply_add(x2, p, 1.6666586697e-01f);
  p = x2 * p;
  const Expr q = multiply_add(x2, -7.0662963390e-01f, 1.0f);
  return multiply_add(x, p / q, x);
}

Expr atan_of(Expr y) {
  Translator& t = *y.t;
  const Expr size = abs(y), one = imm(t, 1.0f);
  const Expr least = min(size, one);
  const Expr x = least / max(size, one);
  const Expr x2 = x * x, x3 = x2 * x, x5 = x3 * x2, x7 = x5 * x2, x9 = x7 * x2, x11 = x9 * x2;
  const Expr terms[] = {x * 0.9999793128310355f,   x3 * -0.3326756418091246f, x5 * 0.1938924977115610f,
                        x7 * -0.1173503194786851f, x9 * 0.0536813784310406f,  x11 * -0.0121323213173444f};
  Expr sum = terms[0];
  for (int i = 1; i < 6; i++) sum = sum + terms[i];
  const Expr steep = bool_to_float(one < size, y.width);
  sum = multiply_add(steep, multiply_add(sum, -2.0f, kHalfPi), sum);
  const Expr signed_sum = sum * sign(y);
  if (!t.exact && !t.function.signed_zero_inf_nan_preserve) return signed_sum;
  // Precise code keeps NaN, which min and max above filter out.
  const ExactScope exact(t);
  const Expr is_number = apply(ir::Op::kFEq, {y, y});
  return select(is_number, signed_sum, y * 1.0f);
}

Expr determinant_of(Translator& t, const std::vector<Expr>& columns);

/// Determinant of the matrix without one row and one column.
Expr minor_of(Translator& t, const std::vector<Expr>& columns, std::uint32_t row, std::uint32_t column) {
  const auto size = static_cast<std::uint32_t>(columns.size());
  if (size == 2) return columns[1 - column][1 - row];
  std::vector<Expr> rest;
  for (std::uint32_t c = 0; c < size; c++) {
    if (c == column) continue;
    std::vector<Expr> parts;
    for (std::uint8_t r = 0; r < size; r++)
      if (r != row) parts.push_back(columns[c].at(r));
    rest.push_back(vector_of(parts));
  }
  return determinant_of(t, rest);
}

Expr determinant_of(Translator& t, const std::vector<Expr>& columns) {
  std::vector<Expr> minors;
  for (std::uint32_t i = 0; i < columns.size(); i++) minors.push_back(minor_of(t, columns, i, 0));
  const Expr products = columns[0] * vector_of(minors);
  Expr sum{&t, ir::kNoValue};
  for (std::uint32_t i = 0; i < columns.size(); i += 2) {
    const Expr term = i + 1 < columns.size() ? products[i] - products[i + 1] : products[i];
    sum = i == 0 ? term : sum + term;
  }
  return sum;
}

std::vector<Expr> matrix_argument(Translator& t, const Inst& inst) {
  const std::vector<Expr> columns = leaf_numbers(t, value_of(t, inst.operand(2)));
  for (const Expr& column : columns)
    if (columns.size() < 2 || column.size() != columns.size()) fail(inst, "operand is not a square matrix");
  return columns;
}

std::uint32_t result_count(const Translator& t, const Inst& inst) { return leaf_info(t, inst.result_type).components; }

}  // namespace

void asin(Translator& t, const Inst& inst, ir::Op) {
  const Expr given = arg(t, inst, 0);
  const Expr x = single_of(given);
  const Expr main = asin_main(x, 0.086566724f, -0.03102955f);
  const Expr small = asin_small(x);
  result(t, inst, convert_float(select(abs(x) < imm(t, 0.5f), small, main), given.width));
}

void acos(Translator& t, const Inst& inst, ir::Op) {
  const Expr x = arg(t, inst, 0);
  const Expr arc = asin_main(single_of(x), 0.08132463f, -0.02363318f);
  result(t, inst, imm(t, kHalfPi) - convert_float(arc, x.width));
}

void atan(Translator& t, const Inst& inst, ir::Op) { result(t, inst, atan_of(arg(t, inst, 0))); }

void atan2(Translator& t, const Inst& inst, ir::Op) {
  const Expr y = arg(t, inst, 0), x = arg(t, inst, 1);
  const Expr zero = imm(t, 0.0f), one = imm(t, 1.0f);
  const Expr flip = zero >= x;
  const Expr size = abs(x);
  const Expr s = select(flip, size, y), d = select(flip, y, size);
  // Both choices are literals, which take their width from what they meet.
  Expr scale = select(abs(d) >= imm(t, x.width == 16 ? 16384.0f : 1e18f), imm(t, 0.25f), one);
  scale = convert_float(scale, x.width);
  const Expr reciprocal = apply(ir::Op::kFRcp, {d * scale});
  const Expr quotient = (s * scale) * reciprocal;
  const Expr diagonal = apply(ir::Op::kFEq, {size, abs(y)});
  const Expr tangent = select(diagonal, one, abs(quotient));
  const Expr arc = multiply_add(bool_to_float(flip, x.width), kHalfPi, atan_of(tangent));
  result(t, inst, select(min(y, reciprocal) < zero, -arc, arc));
}

void sinh_cosh(Translator& t, const Inst& inst, ir::Op op) {
  const Expr x = arg(t, inst, 0);
  const Expr grow = natural_exp(x), shrink = natural_exp(-x);
  result(t, inst, apply(op, {grow, shrink}) * 0.5f);
}

void tanh(Translator& t, const Inst& inst, ir::Op) {
  const Expr s = arg(t, inst, 0);
  const float limit = s.width == 16 ? 4.2f : 10.0f;
  const Expr x = min(max(s, imm(t, -limit)), imm(t, limit));
  Expr is_regular{&t, ir::kNoValue}, flushed = is_regular;
  {
    const ExactScope exact(t);
    is_regular = imm(t, 0.0f) < abs(s);
    flushed = s * 1.0f;
  }
  const Expr difference = natural_exp(x) - natural_exp(-x);
  const Expr sum = natural_exp(x) + natural_exp(-x);
  result(t, inst, select(is_regular, difference / sum, flushed));
}

void asinh(Translator& t, const Inst& inst, ir::Op) {
  const Expr x = arg(t, inst, 0);
  const Expr direction = sign(x);
  const Expr root = sqrt(multiply_add(x, x, 1.0f));
  result(t, inst, direction * natural_log(abs(x) + root));
}

void acosh(Translator& t, const Inst& inst, ir::Op) {
  const Expr x = arg(t, inst, 0);
  result(t, inst, natural_log(x + sqrt(multiply_add(x, x, -1.0f))));
}

void atanh(Translator& t, const Inst& inst, ir::Op) {
  const Expr x = arg(t, inst, 0), one = imm(t, 1.0f);
  const Expr above = x + one;
  result(t, inst, natural_log(above / (one - x)) * 0.5f);
}

void determinant(Translator& t, const Inst& inst, ir::Op) {
  result(t, inst, determinant_of(t, matrix_argument(t, inst)));
}

void inverse(Translator& t, const Inst& inst, ir::Op) {
  const std::vector<Expr> columns = matrix_argument(t, inst);
  const auto size = static_cast<std::uint32_t>(columns.size());
  std::vector<Expr> adjugate;
  for (std::uint32_t c = 0; c < size; c++) {
    std::vector<Expr> parts;
    for (std::uint32_t r = 0; r < size; r++) {
      const Expr minor = minor_of(t, columns, c, r);
      parts.push_back((r + c) % 2 != 0 ? -minor : minor);
    }
    adjugate.push_back(vector_of(parts));
  }
  const Expr scale = apply(ir::Op::kFRcp, {determinant_of(t, columns)});
  std::vector<Expr> result_columns;
  for (const Expr& column : adjugate) result_columns.push_back(column * scale);
  set_numbers(t, inst, result_columns);
}

void pack(Translator& t, const Inst& inst, ir::Op op) {
  const Expr v = arg(t, inst, 0);
  if (v.width != 32 || v.size() != ir::alu_info(op).reads) fail(inst, "operand does not fit its type");
  result(t, inst, {&t, emit(t, op, 1, false, {v.src()})});
}

void unpack(Translator& t, const Inst& inst, ir::Op op) {
  const bool bytes = op == ir::Op::kUnpackUnorm4x8 || op == ir::Op::kUnpackSnorm4x8;
  const std::uint32_t count = bytes ? 4 : 2;
  if (result_count(t, inst) != count) fail(inst, "result does not fit its type");
  result(t, inst, {&t, emit(t, op, count, false, {arg(t, inst, 0).src()})});
}

}  // namespace vitrine::spirv::front::glsl
