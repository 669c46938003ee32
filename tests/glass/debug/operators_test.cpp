// Operators and functions of the debugger's expressions against the host's own arithmetic.
#include "glass/debug/operators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace vitrine::glass::debug {
namespace {

using Scalars = std::vector<Scalar>;

Scalars applied(std::string_view op, const Scalars& a, const Scalars& b) {
  Scalars result;
  std::string error;
  EXPECT_TRUE(apply(op, a, b, result, error)) << op << ": " << error;
  return result;
}

std::string refused(std::string_view op, const Scalars& a, const Scalars& b) {
  Scalars result;
  std::string error;
  EXPECT_FALSE(apply(op, a, b, result, error)) << op;
  return error;
}

Scalars called(std::string_view name, const std::vector<Scalars>& arguments) {
  Scalars result;
  std::string error;
  EXPECT_TRUE(call_function(name, arguments, result, error)) << name << ": " << error;
  return result;
}

std::string text(const Scalars& scalars) {
  std::string all;
  for (const Scalar& scalar : scalars) {
    if (!all.empty()) all += ' ';
    all += to_text(scalar);
  }
  return all;
}

constexpr std::int32_t kInts[] = {0, 1, -1, 7, -7, 100, INT32_MAX, INT32_MIN};

TEST(Operators, SignedIntegers) {
  for (const std::int32_t a : kInts) {
    for (const std::int32_t b : kInts) {
      const auto of = [&](const char* op) {
        return static_cast<std::int32_t>(to_int(applied(op, {make_int(a)}, {make_int(b)}).at(0)));
      };
      const auto u = static_cast<std::uint32_t>(a), v = static_cast<std::uint32_t>(b);
      EXPECT_EQ(of("+"), static_cast<std::int32_t>(u + v));
      EXPECT_EQ(of("-"), static_cast<std::int32_t>(u - v));
      EXPECT_EQ(of("*"), static_cast<std::int32_t>(u * v));
      EXPECT_EQ(of("&"), a & b);
      EXPECT_EQ(of("|"), a | b);
      EXPECT_EQ(of("^"), a ^ b);
      if (b == 0 || b == -1) continue;
      EXPECT_EQ(of("/"), a / b);
      EXPECT_EQ(of("%"), a % b);
    }
    EXPECT_EQ(to_int(applied(">>", {make_int(a)}, {make_int(3)}).at(0)), a >> 3);
    EXPECT_NE(refused("/", {make_int(a)}, {make_int(0)}), "");
    EXPECT_NE(refused("<<", {make_int(a)}, {make_int(32)}), "");
  }
}

TEST(Operators, UnsignedIntegers) {
  for (const std::uint32_t a : {0u, 7u, 0x80000000u, 0xffffffffu}) {
    for (const std::uint32_t b : {1u, 3u, 0xfffffff0u}) {
      const auto of = [&](const char* op) { return applied(op, {make_uint(a)}, {make_uint(b)}).at(0).bits; };
      EXPECT_EQ(of("/"), a / b);
      EXPECT_EQ(of("%"), a % b);
      EXPECT_EQ(of("<") != 0, a < b);
      EXPECT_EQ(of(">=") != 0, a >= b);
    }
    EXPECT_EQ(applied(">>", {make_uint(a)}, {make_int(3)}).at(0).bits, a >> 3);
    EXPECT_EQ(applied("<<", {make_uint(a)}, {make_int(3)}).at(0).bits, a << 3);
    // Unsigned wins: -1 is the largest number.
    EXPECT_EQ(applied("<", {make_uint(a)}, {make_int(-1)}).at(0).bits != 0, a < 0xffffffffu);
  }
}

TEST(Operators, Floats) {
  for (const float a : {0.0f, 1.5f, -2.25f, 1e30f}) {
    for (const float b : {0.5f, -3.0f, 1e-30f}) {
      const auto of = [&](const char* op) { return to_double(applied(op, {make_float(a)}, {make_float(b)}).at(0)); };
      EXPECT_EQ(of("+"), a + b);
      EXPECT_EQ(of("-"), a - b);
      EXPECT_EQ(of("*"), a * b);
      EXPECT_EQ(of("/"), a / b);
      EXPECT_EQ(of("<=") != 0, a <= b);
      EXPECT_EQ(of(">") != 0, a > b);
    }
  }
  EXPECT_EQ(to_double(applied("%", {make_float(-1)}, {make_float(3)}).at(0)), 2);
  EXPECT_EQ(text(applied("+", {make_int(1)}, {make_float(0.5)})), "1.5");
  EXPECT_NE(refused("&", {make_float(1)}, {make_float(2)}), "");
}

TEST(Operators, Booleans) {
  for (const bool a : {false, true}) {
    for (const bool b : {false, true}) {
      const auto of = [&](const char* op) { return to_bool(applied(op, {make_bool(a)}, {make_bool(b)}).at(0)); };
      EXPECT_EQ(of("&&"), a && b);
      EXPECT_EQ(of("||"), a || b);
      EXPECT_EQ(of("^^"), a != b);
    }
    EXPECT_EQ(to_bool(negate('!', make_bool(a))), !a);
  }
  EXPECT_EQ(to_int(negate('-', make_int(5))), -5);
  EXPECT_EQ(to_int(negate('+', make_int(5))), 5);
  EXPECT_EQ(to_int(negate('~', make_int(5))), ~5);
  EXPECT_EQ(to_double(negate('-', make_float(5))), -5);
}

TEST(Operators, Vectors) {
  const Scalars pair{make_int(1), make_int(2)}, other{make_int(1), make_int(3)};
  EXPECT_EQ(text(applied("+", pair, {make_int(10)})), "11 12");
  EXPECT_EQ(text(applied("*", {make_int(2)}, other)), "2 6");
  EXPECT_EQ(text(applied("==", pair, pair)), "true");
  EXPECT_EQ(text(applied("==", pair, other)), "false");
  EXPECT_EQ(text(applied("!=", pair, other)), "true");
  EXPECT_EQ(refused("+", pair, {make_int(1), make_int(2), make_int(3)}), "vectors of different sizes");
}

TEST(Operators, Functions) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(text(called("abs", {{make_int(-3), make_int(3), make_float(-1.5), make_uint(4)}})), "3 3 1.5 4");
  EXPECT_EQ(to_double(called("floor", {{make_float(-1.5)}}).at(0)), -2);
  EXPECT_EQ(text(called("isnan", {{make_float(std::nan("")), make_float(1)}})), "true false");
  EXPECT_EQ(text(called("isinf", {{make_float(-infinity), make_float(1)}})), "true false");
  EXPECT_EQ(to_double(called("length", {{make_float(3), make_float(4)}}).at(0)), 5);
  EXPECT_EQ(to_double(called("dot", {{make_int(1), make_int(2)}, {make_int(3), make_int(4)}}).at(0)), 11);
  EXPECT_EQ(text(called("any", {{make_bool(false), make_bool(true)}})), "true");
  EXPECT_EQ(text(called("all", {{make_bool(false), make_bool(true)}})), "false");
  EXPECT_EQ(text(called("min", {{make_int(1), make_int(5)}, {make_int(2), make_int(3)}})), "1 3");
  EXPECT_EQ(text(called("max", {{make_int(1), make_int(5)}, {make_int(2), make_int(3)}})), "2 5");
  EXPECT_EQ(text(called("int", {{make_float(-2.75)}})), "-2");
  EXPECT_EQ(called("uint", {{make_int(-1)}}).at(0).bits, 0xffffffffu);
  EXPECT_EQ(text(called("bool", {{make_int(2)}})), "true");
  EXPECT_EQ(called("double", {{make_float(0.5)}}).at(0).width, 64u);
  EXPECT_EQ(text(called("ivec2", {{make_float(1.5)}})), "1 1");
  EXPECT_EQ(called("vec4", {{make_int(1), make_int(2)}, {make_int(3)}, {make_int(4)}}).size(), 4u);
  Scalars result;
  std::string error;
  EXPECT_FALSE(call_function("vec3", {{make_int(1), make_int(2)}}, result, error));
  EXPECT_FALSE(call_function("sine", {{make_int(1)}}, result, error));
  EXPECT_EQ(error, "there is no function 'sine' with 1 arguments");
  EXPECT_FALSE(call_function("min", {{make_int(1)}, {make_int(1), make_int(2)}}, result, error));
  EXPECT_FALSE(call_function("dot", {{make_int(1)}, {make_int(1)}, {make_int(1)}}, result, error));
}

}  // namespace
}  // namespace vitrine::glass::debug
