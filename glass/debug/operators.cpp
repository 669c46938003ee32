// See operators.h. Floats are computed in binary64 and rounded to the width of the operands.
#include "glass/debug/operators.h"
#include "glass/debug/words.h"

#include <algorithm>
#include <cmath>

namespace vitrine::glass::debug {
namespace {

/// The type that two operands meet in: floats over integers, unsigned over signed, the wider one.
Scalar common(const Scalar& a, const Scalar& b) {
  Scalar type{'I', std::max(a.width, b.width), 0};
  if (a.type == 'U' || b.type == 'U') type.type = 'U';
  if (a.type == 'F' || b.type == 'F') {
    type.type = 'F';
    type.width = std::max(a.type == 'F' ? a.width : 0, b.type == 'F' ? b.width : 0);
  }
  return type;
}

Scalar integer(const Scalar& type, std::uint64_t bits) {
  Scalar result = make_uint(bits, type.width);
  result.type = type.type;
  return result;
}

bool compare(std::string_view op, const Scalar& a, const Scalar& b) {
  const Scalar type = common(a, b);
  const auto holds = [&](auto x, auto y) {
    return op == "=="   ? x == y
           : op == "!=" ? x != y
           : op == "<"  ? x < y
           : op == ">"  ? x > y
           : op == "<=" ? x <= y
                        : x >= y;
  };
  if (type.type == 'F') return holds(to_double(a), to_double(b));
  if (type.type == 'U')
    return holds(integer(type, static_cast<std::uint64_t>(to_int(a))).bits,
                 integer(type, static_cast<std::uint64_t>(to_int(b))).bits);
  return holds(to_int(a), to_int(b));
}

double compute(char op, double a, double b) {
  return op == '+' ? a + b : op == '-' ? a - b : op == '*' ? a * b : op == '/' ? a / b : a - b * std::floor(a / b);
}

/// False: nothing defines the result.
bool compute_integer(std::string_view op, const Scalar& type, const Scalar& a, const Scalar& b, Scalar& result) {
  const std::int64_t x = to_int(a), y = to_int(b);
  const auto u = static_cast<std::uint64_t>(x), v = static_cast<std::uint64_t>(y);
  const bool is_unsigned = type.type == 'U';
  const std::uint64_t p = integer(type, u).bits, q = integer(type, v).bits;
  switch (op[0]) {
    case '+':
      return result = integer(type, u + v), true;
    case '-':
      return result = integer(type, u - v), true;
    case '*':
      return result = integer(type, u * v), true;
    case '&':
      return result = integer(type, u & v), true;
    case '|':
      return result = integer(type, u | v), true;
    case '^':
      return result = integer(type, u ^ v), true;
    case '<':
    case '>':
      if (v >= type.width) return false;
      result = integer(type, op[0] == '<' ? u << v : is_unsigned ? p >> v : static_cast<std::uint64_t>(x >> v));
      return true;
    default:
      if (y == 0 || (x == INT64_MIN && y == -1)) return false;
      if (is_unsigned)
        result = integer(type, op[0] == '/' ? p / q : p % q);
      else
        result = integer(type, static_cast<std::uint64_t>(op[0] == '/' ? x / y : x % y));
      return true;
  }
}

bool apply_one(std::string_view op, const Scalar& a, const Scalar& b, Scalar& result) {
  if (op == "&&" || op == "||" || op == "^^") {
    const bool x = to_bool(a), y = to_bool(b);
    result = make_bool(op == "&&" ? x && y : op == "||" ? x || y : x != y);
    return true;
  }
  if (op == "==" || op == "!=" || op[0] == '<' || op[0] == '>') {
    if (op != "<<" && op != ">>") return result = make_bool(compare(op, a, b)), true;
  }
  const Scalar type = common(a, b);
  if (type.type != 'F') return compute_integer(op, op == "<<" || op == ">>" ? a : type, a, b, result);
  if (std::string_view("+-*/%").find(op) == std::string_view::npos) return false;
  result = make_float(compute(op[0], to_double(a), to_double(b)), type.width);
  return true;
}

bool convert(std::string_view name, const Scalar& from, Scalar& to) {
  if (name == "float")
    to = make_float(to_double(from));
  else if (name == "double")
    to = make_float(to_double(from), 64);
  else if (name == "int")
    to = make_int(to_int(from));
  else if (name == "uint")
    to = make_uint(static_cast<std::uint64_t>(to_int(from)));
  else if (name == "bool")
    to = make_bool(to_bool(from));
  else
    return false;
  return true;
}

bool of_each(std::string_view name, const Scalar& from, Scalar& to) {
  const double value = to_double(from);
  if (name == "abs")
    to = from.type == 'F'                ? make_float(std::abs(value), from.width)
         : from.type == 'I' && value < 0 ? negate('-', from)
                                         : from;
  else if (name == "floor")
    to = make_float(std::floor(value), from.type == 'F' ? from.width : 32);
  else if (name == "isnan")
    to = make_bool(std::isnan(value));
  else if (name == "isinf")
    to = make_bool(std::isinf(value));
  else
    return convert(name, from, to);
  return true;
}

/// The scalar constructor that a vector's constructor is made of, and how many numbers it makes; 0: it is none.
std::uint32_t vector_constructor(std::string_view name, std::string_view& scalar) {
  if (name.empty() || name.back() < '2' || name.back() > '4') return 0;
  const std::string_view stem = name.substr(0, name.size() - 1);
  scalar = stem == "vec"    ? "float"
           : stem == "ivec" ? "int"
           : stem == "uvec" ? "uint"
           : stem == "dvec" ? "double"
           : stem == "bvec" ? "bool"
                            : "";
  return scalar.empty() ? 0 : static_cast<std::uint32_t>(name.back() - '0');
}

/// False: the arguments are too few or too many.
bool make_vector(std::string_view scalar, std::uint32_t count, const std::vector<std::vector<Scalar>>& arguments,
                 std::vector<Scalar>& result) {
  for (const std::vector<Scalar>& argument : arguments)
    for (const Scalar& number : argument) convert(scalar, number, result.emplace_back());
  if (result.size() == 1) result.resize(count, result[0]);
  return result.size() == count;
}

double product(const std::vector<Scalar>& a, const std::vector<Scalar>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) sum += to_double(a[i]) * to_double(b[i]);
  return sum;
}

}  // namespace

bool apply(std::string_view op, const std::vector<Scalar>& left, const std::vector<Scalar>& right,
           std::vector<Scalar>& result, std::string& error) {
  const std::size_t count = std::max(left.size(), right.size());
  if ((left.size() != 1 && left.size() != count) || (right.size() != 1 && right.size() != count))
    return error = "vectors of different sizes", false;
  for (std::size_t i = 0; i < count; ++i) {
    Scalar one;
    if (!apply_one(op, left[left.size() == 1 ? 0 : i], right[right.size() == 1 ? 0 : i], one))
      return error = quoted(op) + " is not defined for these operands", false;
    result.push_back(one);
  }
  if (op != "==" && op != "!=") return true;
  const auto holds = [](const Scalar& scalar) { return scalar.bits != 0; };
  const bool all = op == "==" ? std::ranges::all_of(result, holds) : std::ranges::any_of(result, holds);
  result = {make_bool(all)};
  return true;
}

Scalar negate(char sign, const Scalar& scalar) {
  if (sign == '!') return make_bool(!to_bool(scalar));
  if (sign == '+') return scalar;
  if (scalar.type == 'F') return make_float(-to_double(scalar), scalar.width);
  return integer(scalar, sign == '~' ? ~scalar.bits : 0 - scalar.bits);
}

bool call_function(std::string_view name, const std::vector<std::vector<Scalar>>& arguments,
                   std::vector<Scalar>& result, std::string& error) {
  error = "there is no function '" + std::string(name) + "' with " + std::to_string(arguments.size()) + " arguments";
  const auto holds = [](const Scalar& scalar) { return to_bool(scalar); };
  std::string_view scalar;
  if (const std::uint32_t count = vector_constructor(name, scalar); count != 0)
    return make_vector(scalar, count, arguments, result);
  if (arguments.size() == 1) {
    const std::vector<Scalar>& a = arguments[0];
    if (name == "length") return result = {make_float(std::sqrt(product(a, a)))}, true;
    if (name == "any") return result = {make_bool(std::ranges::any_of(a, holds))}, true;
    if (name == "all") return result = {make_bool(std::ranges::all_of(a, holds))}, true;
    for (const Scalar& scalar : a) {
      Scalar one;
      if (!of_each(name, scalar, one)) return false;
      result.push_back(one);
    }
    return true;
  }
  if (arguments.size() != 2) return false;
  const std::vector<Scalar>&a = arguments[0], &b = arguments[1];
  if (name == "dot") return result = {make_float(product(a, b))}, true;
  if ((name != "min" && name != "max") || a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    result.push_back((compare("<", a[i], b[i]) == (name == "min")) ? a[i] : b[i]);
  return true;
}

}  // namespace vitrine::glass::debug
