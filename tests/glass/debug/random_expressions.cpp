// See random_parts.h: expressions. Wrap-around of integers: GLSL 4.60, 4.1.3; division by constants alone.
#include <algorithm>
#include <cmath>

#include "tests/glass/debug/random_parts.h"

namespace vitrine::glass::debug::test {
namespace {

constexpr float kBound = 64.0f;

std::uint64_t wrap(const RandomType& type, std::uint64_t bits) {
  return type.width == 64 ? bits : static_cast<std::uint32_t>(bits);
}
std::int64_t sign_extended(const RandomType& type, std::uint64_t bits) {
  return type.width == 64 ? static_cast<std::int64_t>(bits) : static_cast<std::int32_t>(bits);
}
bool less(const RandomType& type, std::uint64_t a, std::uint64_t b) {
  if (type.letter == 'F') return float_of(a) < float_of(b);
  return type.letter == 'U' ? a < b : sign_extended(type, a) < sign_extended(type, b);
}

std::uint64_t apply(const RandomType& type, char op, std::uint64_t a, std::uint64_t b) {
  switch (op) {
    case '+':
      return wrap(type, a + b);
    case '-':
      return wrap(type, a - b);
    case '*':
      return wrap(type, a * b);
    case '&':
      return a & b;
    case '|':
      return a | b;
    case '^':
      return a ^ b;
    case '<':
      return wrap(type, a << b);
    case '>':
      return wrap(type, type.letter == 'U' ? a >> b : static_cast<std::uint64_t>(sign_extended(type, a) >> b));
    case 'm':
      return less(type, b, a) ? b : a;
    case 'M':
      return less(type, a, b) ? b : a;
    default:
      return type.letter == 'U'
                 ? a / b
                 : wrap(type, static_cast<std::uint64_t>(sign_extended(type, a) / sign_extended(type, b)));
  }
}

std::uint64_t apply_real(char op, std::uint64_t a, std::uint64_t b) {
  const float x = float_of(a), y = float_of(b);
  switch (op) {
    case '+':
      return bits_of(x + y);
    case '-':
      return bits_of(x - y);
    case '*':
      return bits_of(std::floor(x * y));
    default:
      return bits_of(op == 'm' ? std::min(x, y) : std::max(x, y));
  }
}

Expression choose(Expression condition, Expression yes, Expression no) {
  return {std::string("(") + condition.text + " ? " + yes.text + " : " + no.text + ")",
          [c = condition.value, y = yes.value, n = no.value](Machine& m) { return c(m) != 0 ? y(m) : n(m); }};
}

}  // namespace

const RandomType& ExpressionMaker::any_number() {
  const RandomType* const all[] = {&types.integer, &types.integer, &types.natural, &types.real,
                                   &types.real,    &types.boolean, &types.wide};
  return *all[below(std::size(all))];
}

const RandomType& ExpressionMaker::any_type() {
  const RandomType* const all[] = {&types.ivec3, &types.uvec4, &types.vec2, &types.vec4,
                                   &types.ints,  &types.pair,  &types.pairs};
  return chance(60) ? any_number() : *all[below(std::size(all))];
}

Expression ExpressionMaker::literal(const RandomType& type) {
  const std::uint32_t value = below(40);
  if (type.letter == 'B') return {value % 2 != 0 ? "true" : "false", [value](Machine&) { return value % 2; }};
  if (type.letter == 'U') return {std::to_string(value) + "u", [value](Machine&) { return value; }};
  if (type.letter == 'F') {
    const float real = static_cast<float>(value) * 0.25f;
    return {to_text(make_float(static_cast<double>(real))), [real](Machine&) { return bits_of(real); }};
  }
  const std::string text =
      type.width == 64 ? std::string("int64_t(") + std::to_string(value) + ")" : std::to_string(value);
  return {text, [value](Machine&) { return value; }};
}

Target ExpressionMaker::number_in(const RandomVariable& variable) {
  Target target{variable.name, variable.type, [slot = variable.slot](Machine&) { return slot; }};
  while (target.type->kind != RandomType::Kind::kNumber) {
    const RandomType& type = *target.type;
    if (type.kind == RandomType::Kind::kStruct) {
      const std::uint32_t member = below(static_cast<std::uint32_t>(type.members.size()));
      std::size_t before = 0;
      for (std::uint32_t i = 0; i < member; ++i) before += type.members[i].second->numbers();
      target.text += std::string(".") + type.members[member].first;
      target.slot = [slot = target.slot, before](Machine& m) { return slot(m) + before; };
      target.type = type.members[member].second;
      continue;
    }
    const std::size_t step = type.element->numbers();
    if (type.count != 3 && chance(50)) {
      const Expression index = leaf(types.natural);
      const std::uint32_t mask = type.count - 1;
      target.text += std::string("[") + index.text + " & " + std::to_string(mask) + "u]";
      target.slot = [slot = target.slot, step, mask, value = index.value](Machine& m) {
        return slot(m) + (value(m) & mask) * step;
      };
    } else {
      const std::uint32_t index = below(type.count);
      if (type.kind == RandomType::Kind::kVector)
        target.text.append(".").append(1, "xyzw"[index]);
      else
        target.text.append("[").append(std::to_string(index)).append("]");
      target.slot = [slot = target.slot, step, index](Machine& m) { return slot(m) + index * step; };
    }
    target.type = type.element;
  }
  return target;
}

Expression ExpressionMaker::condition() {
  const Expression inner = deep(types.boolean, 2);
  return {std::string("data[8] > 9u && ") + inner.text, inner.value};
}

Target ExpressionMaker::target() {
  std::vector<const RandomVariable*> all;
  for (const RandomVariable& variable : visible)
    if (std::ranges::find(constant, variable.name) == constant.end()) all.push_back(&variable);
  if (all.empty()) return {};
  return number_in(*all[below(static_cast<std::uint32_t>(all.size()))]);
}

Expression ExpressionMaker::leaf(const RandomType& type) {
  std::vector<const RandomVariable*> all;
  for (const RandomVariable& variable : visible)
    if (variable.type == &type) all.push_back(&variable);
  if (!all.empty() && chance(75)) {
    const RandomVariable& variable = *all[below(static_cast<std::uint32_t>(all.size()))];
    return {variable.name, [slot = variable.slot](Machine& m) { return m.memory[slot]; }};
  }
  if (&type != &types.natural || chance(50)) return literal(type);
  // Memory that nobody writes.
  const Expression index = literal(type);
  return {std::string("data[8u + (") + index.text + " & 7u)]",
          [value = index.value](Machine& m) { return 18 + (value(m) & 7); }};
}

Expression ExpressionMaker::deep(const RandomType& type, int depth) {
  if (type.letter == 'F') return real(depth);
  if (depth > 0 && chance(20) && !visible.empty()) {
    const Target part = number_in(visible[below(static_cast<std::uint32_t>(visible.size()))]);
    if (part.type == &type) return {part.text, [slot = part.slot](Machine& m) { return m.memory[slot(m)]; }};
  }
  if (depth == 0 || chance(20)) return leaf(type);
  if (type.letter == 'B') return boolean(depth);
  return chance(15) ? choose(deep(types.boolean, depth - 1), deep(type, depth - 1), deep(type, depth - 1))
                    : integer(type, depth);
}

Expression ExpressionMaker::boolean(int depth) {
  if (chance(25)) {
    const Expression a = deep(types.boolean, depth - 1), b = deep(types.boolean, depth - 1);
    if (chance(50))
      return {std::string("(") + a.text + " && " + b.text + ")",
              [a = a.value, b = b.value](Machine& m) { return a(m) & b(m); }};
    return {std::string("(") + a.text + " || !" + b.text + ")",
            [a = a.value, b = b.value](Machine& m) { return a(m) | (b(m) ^ 1); }};
  }
  const RandomType& type = chance(40) ? types.real : chance(50) ? types.integer : types.natural;
  const Expression a = deep(type, depth - 1), b = deep(type, depth - 1);
  if (type.letter != 'F' && chance(30))
    return {std::string("(") + a.text + " == " + b.text + ")",
            [a = a.value, b = b.value](Machine& m) { return a(m) == b(m) ? 1u : 0u; }};
  return {std::string("(") + a.text + " < " + b.text + ")",
          [a = a.value, b = b.value, &type](Machine& m) { return less(type, a(m), b(m)) ? 1u : 0u; }};
}

Expression ExpressionMaker::converted(const RandomType& type, int depth) {
  const RandomType& from = type.width == 64 ? types.integer
                           : chance(50)     ? types.wide
                           : chance(50)     ? types.natural
                                            : types.integer;
  const Expression inner = deep(from, depth - 1);
  return {type.name + "(" + inner.text + ")", [value = inner.value, &from, &type](Machine& m) {
            return wrap(type, static_cast<std::uint64_t>(from.letter == 'U' ? static_cast<std::int64_t>(value(m))
                                                                            : sign_extended(from, value(m))));
          }};
}

Expression ExpressionMaker::integer(const RandomType& type, int depth) {
  if (chance(15)) return converted(type, depth);
  if (type.width == 32 && type.letter == 'I' && chance(10)) {
    const Expression inner = real(depth - 1);
    return {
        std::string("int(") + inner.text + ")", [value = inner.value](Machine& m) {
          return static_cast<std::uint64_t>(static_cast<std::uint32_t>(static_cast<std::int32_t>(float_of(value(m)))));
        }};
  }
  constexpr char kOps[] = {'+', '-', '*', '&', '|', '^', '<', '>', 'm', 'M', '/'};
  const char op = kOps[below(std::size(kOps))];
  const Expression a = deep(type, depth - 1);
  Expression b = deep(type, depth - 1);
  const std::uint32_t constant_value = op == '/' ? 1 + below(9) : below(8);
  std::string word(1, op);
  if (op == '<' || op == '>') word += op;
  if (op == '<' || op == '>' || op == '/') {
    b.text = type.width == 64 ? std::string("int64_t(") + std::to_string(constant_value) + ")"
                              : std::to_string(constant_value) + (type.letter == 'U' ? "u" : "");
    b.value = [constant_value](Machine&) { return constant_value; };
  }
  const auto value = [a = a.value, b = b.value, op, &type](Machine& m) { return apply(type, op, a(m), b(m)); };
  if (op == 'm' || op == 'M') return {std::string(op == 'm' ? "min(" : "max(") + a.text + ", " + b.text + ")", value};
  return {std::string("(") + a.text + " " + word + " " + b.text + ")", value};
}

Expression ExpressionMaker::bounded(Expression inner) {
  return {std::string("clamp(") + inner.text + ", -64.0, 64.0)",
          [value = inner.value](Machine& m) { return bits_of(std::clamp(float_of(value(m)), -kBound, kBound)); }};
}

/// Factors are leaves: a product has few bits.
Expression ExpressionMaker::real(int depth) {
  if (depth == 0 || chance(20)) return leaf(types.real);
  if (chance(15)) return choose(deep(types.boolean, depth - 1), real(depth - 1), real(depth - 1));
  if (chance(20)) {
    const Expression inner = deep(types.integer, depth - 1);
    return {std::string("float(") + inner.text + " & 15)",
            [value = inner.value](Machine& m) { return bits_of(static_cast<float>(value(m) & 15)); }};
  }
  constexpr char kOps[] = {'+', '-', '*', 'm', 'M'};
  const char op = kOps[below(std::size(kOps))];
  const Expression a = op == '*' ? leaf(types.real) : real(depth - 1),
                   b = op == '*' ? leaf(types.real) : real(depth - 1);
  const auto value = [a = a.value, b = b.value, op](Machine& m) { return apply_real(op, a(m), b(m)); };
  if (op == '*') return {std::string("floor(") + a.text + " * " + b.text + ")", value};
  if (op == 'm' || op == 'M') return {std::string(op == 'm' ? "min(" : "max(") + a.text + ", " + b.text + ")", value};
  return {std::string("(") + a.text + " " + op + " " + b.text + ")", value};
}

Whole ExpressionMaker::whole(const RandomType& type) {
  if (type.kind == RandomType::Kind::kNumber) {
    const Expression one = number(type);
    return {one.text, [value = one.value](Machine& m) { return std::vector<std::uint64_t>{value(m)}; }};
  }
  for (const RandomVariable& variable : visible)
    if (variable.type == &type && chance(25))
      return {variable.name, [slot = variable.slot, count = type.numbers()](Machine& m) {
                const auto first = m.memory.begin() + static_cast<std::ptrdiff_t>(slot);
                return std::vector<std::uint64_t>(first, first + count);
              }};
  std::vector<Whole> parts;
  for (std::uint32_t i = 0; i < type.count; ++i) parts.push_back(whole(*type.element));
  for (const auto& [name, part] : type.members) parts.push_back(whole(*part));
  std::string text = type.name + "(";
  for (const Whole& part : parts) text.append(&part == parts.data() ? "" : ", ").append(part.text);
  text.append(")");
  return {text, [parts](Machine& m) {
            std::vector<std::uint64_t> all;
            for (const Whole& part : parts) {
              const std::vector<std::uint64_t> one = part.value(m);
              all.insert(all.end(), one.begin(), one.end());
            }
            return all;
          }};
}

}  // namespace vitrine::glass::debug::test
