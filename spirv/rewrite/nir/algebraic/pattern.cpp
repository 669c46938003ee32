// Parses the rule table.
#include "spirv/rewrite/nir/algebraic/pattern.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string>

#include "base/check.h"

namespace vitrine::spirv::rewriting {
namespace {

using ir::Op;

struct ConditionName {
  std::string_view name;
  Condition condition;
};

constexpr ConditionName kConditions[] = {
    {"once", Condition::kOnce},
    {"float_only", Condition::kFloatOnly},
    {"used", Condition::kUsed},
    {"not_for_if", Condition::kNotForIf},
    {"bits16", Condition::kBits16},
    {"bits32", Condition::kBits32},
    {"bits64", Condition::kBits64},
    {"not_const", Condition::kNotConst},
    {"fmul", Condition::kFmul},
    {"not_fmul", Condition::kNotFmul},
    {"pos_pow2", Condition::kPosPow2},
    {"neg_pow2", Condition::kNegPow2},
    {"shifts2", Condition::kShifts2},
    {"below32", Condition::kBelow32},
    {"multiple2", Condition::kMultiple2},
    {"multiple4", Condition::kMultiple4},
    {"multiple8", Condition::kMultiple8},
    {"multiple16", Condition::kMultiple16},
    {"multiple32", Condition::kMultiple32},
    {"multiple64", Condition::kMultiple64},
    {"number", Condition::kNumber},
    {"finite", Condition::kFinite},
    {"integral", Condition::kIntegral},
    {"not_negative", Condition::kNotNegative},
    {"not_positive", Condition::kNotPositive},
    {"not_zero", Condition::kNotZero},
    {"gt0", Condition::kGt0},
    {"lt0", Condition::kLt0},
    {"number_not_negative", Condition::kNumberNotNegative},
    {"number_not_positive", Condition::kNumberNotPositive},
    {"number_gt0", Condition::kNumberGt0},
    {"number_lt0", Condition::kNumberLt0},
};

/// Names of the ops, hashed when this is compiled: the table is parsed in front of the first pipeline.
struct OpNames {
  static constexpr std::size_t kSize = 1024;  ///< a power of two, several times the number of ops
  std::array<Op, kSize> slots{};

  static constexpr std::size_t hash(std::string_view word) {
    std::uint32_t h = 2166136261u;
    for (const char c : word) h = (h ^ static_cast<std::uint8_t>(c)) * 16777619u;
    return (h ^ h >> 16) % kSize;
  }

  constexpr OpNames() {
    slots.fill(Op::kAluCount);
    for (std::size_t i = 0; i < std::size(kNames); ++i) {
      std::size_t at = hash(kNames[i]);
      while (slots[at] != Op::kAluCount) at = (at + 1) % kSize;
      slots[at] = static_cast<Op>(i);
    }
  }

  /// kAluCount: no such op.
  constexpr Op find(std::string_view word) const {
    std::size_t at = hash(word);
    while (slots[at] != Op::kAluCount && kNames[static_cast<std::size_t>(slots[at])] != word) at = (at + 1) % kSize;
    return slots[at];
  }

  static constexpr std::string_view kNames[] = {
#define VITRINE_ALU(name, sources, result, operands, swap, chain, effect) #name,
#include "spirv/ops.def"
#define VITRINE_NIR(name, sources, result, operands, swap, reads, effect) #name,
#include "spirv/ops.def"
  };
};
constexpr OpNames kOpNames;

/// Of names and numbers, with their exponents.
bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
         c == '-' || c == '+';
}

class Parser {
 public:
  Parser(Rules& rules, std::string_view text) : rules_(rules), text_(text) {}

  bool ok() const { return ok_ && text_.empty(); }

  std::uint16_t expression() {
    const auto index = static_cast<std::uint16_t>(rules_.patterns.size());
    rules_.patterns.emplace_back();
    Pattern pattern;
    pattern.inexact = take('~');
    pattern.exact = take('!');
    pattern.constant = take('#');
    const std::string_view word = take_word();
    if (word.empty() && !pattern.constant) ok_ = false;
    if (ok_ && !word.empty()) classify(pattern, word);
    if (take(':')) pattern.condition = condition(take_word());
    if (pattern.kind == Pattern::Kind::kOp) operands(pattern);
    rules_.patterns[index] = pattern;
    return index;
  }

 private:
  bool take(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }

  std::string_view take_word() {
    std::size_t length = 0;
    while (length < text_.size() && is_word(text_[length])) ++length;
    const std::string_view word = text_.substr(0, length);
    text_.remove_prefix(length);
    return word;
  }

  void classify(Pattern& pattern, std::string_view word) {
    const char first = word.front();
    if (word == "true" || word == "false") {
      pattern.kind = Pattern::Kind::kBoolean;
      pattern.bits = word == "true" ? 1 : 0;
    } else if (first >= 'A' && first <= 'Z') {
      pattern.kind = Pattern::Kind::kOp;
      pattern.op = op_named(word);
    } else if (first >= 'a' && first <= 'h' && (word.size() == 1 || word[1] == '.')) {
      pattern.variable = static_cast<std::uint8_t>(first - 'a');
      if (word.size() > 1) pattern.component = component(word.substr(2));
    } else if (word.find('.') != std::string_view::npos) {
      pattern.kind = Pattern::Kind::kFloat;
      const char* const end = word.data() + word.size();
      ok_ = ok_ && std::from_chars(word.data(), end, pattern.number).ptr == end;
    } else {
      pattern.kind = Pattern::Kind::kInteger;
      const std::string text(word);
      char* end = nullptr;
      pattern.bits = static_cast<std::uint32_t>(std::strtoll(text.c_str(), &end, 0));
      ok_ = ok_ && end == text.c_str() + text.size();
    }
  }

  std::int8_t component(std::string_view name) {
    const std::size_t number = std::string_view("xyzw").find(name);
    ok_ = ok_ && name.size() == 1 && number != std::string_view::npos;
    return static_cast<std::int8_t>(number);
  }

  Op op_named(std::string_view word) {
    if (word == "Vec") return Op::kVec;
    const Op op = kOpNames.find(word);
    ok_ = ok_ && op != Op::kAluCount;
    return op == Op::kAluCount ? Op::kMov : op;
  }

  Condition condition(std::string_view word) {
    for (const ConditionName& entry : kConditions)
      if (entry.name == word) return entry.condition;
    ok_ = false;
    return Condition::kNone;
  }

  void operands(Pattern& pattern) {
    ok_ = ok_ && take('(');
    while (ok_ && pattern.children < kMaxChildren) {
      pattern.child[pattern.children++] = expression();
      if (!take(',')) break;
    }
    ok_ = ok_ && take(')');
    if (ok_ && pattern.op != Op::kVec) ok_ = pattern.children == ir::alu_info(pattern.op).sources;
  }

  Rules& rules_;
  std::string_view text_;
  bool ok_ = true;
};

/// The same tree, variable for variable.
bool same_tree(const Rules& rules, std::uint16_t a, std::uint16_t b) {
  const Pattern& x = rules.patterns[a];
  const Pattern& y = rules.patterns[b];
  if (x.kind != y.kind || x.op != y.op || x.variable != y.variable || x.component != y.component ||
      x.children != y.children || x.number != y.number || x.bits != y.bits)
    return false;
  for (unsigned i = 0; i < x.children; ++i)
    if (!same_tree(rules, x.child[i], y.child[i])) return false;
  return true;
}

/// Numbers the commutative operations in pre-order; equal operands need no second order.
std::uint8_t number_commutative(Rules& rules, std::uint16_t index, std::uint8_t next) {
  const Pattern pattern = rules.patterns[index];
  if (pattern.kind != Pattern::Kind::kOp) return next;
  if (is_commutative(pattern.op) && !same_tree(rules, pattern.child[0], pattern.child[1]))
    rules.patterns[index].commutative = static_cast<std::int8_t>(next++);
  for (unsigned i = 0; i < pattern.children; ++i) next = number_commutative(rules, pattern.child[i], next);
  return next;
}

std::uint16_t shape_of(Rules& rules, std::uint16_t index) {
  const Pattern pattern = rules.patterns[index];
  switch (pattern.kind) {
    case Pattern::Kind::kVariable:
      return pattern.constant ? kConstShape : kAnyShape;
    case Pattern::Kind::kOp:
      if (pattern.op == Op::kVec)
        return kAnyShape;  // a dot product is taken apart at its first visit: nothing wakes it
      break;
    default:
      return kConstShape;
  }
  Shape shape;
  const Op op = shape_op(pattern.op);
  shape.children = pattern.children;
  shape.commutative = is_commutative(pattern.op);
  for (unsigned i = 0; i < pattern.children; ++i) shape.child[i] = shape_of(rules, pattern.child[i]);
  auto& same_op = rules.shapes[static_cast<std::size_t>(op)];
  const auto known = std::find_if(same_op.begin(), same_op.end(), [&](const Shape& other) {
    return std::equal(shape.child, shape.child + shape.children, other.child);
  });
  const std::uint16_t number = shape_number(op, static_cast<std::size_t>(known - same_op.begin()));
  if (known == same_op.end()) same_op.push_back(shape);
  if (same_op.size() > kMaxShapes) VITRINE_UNREACHABLE("too many shapes of rules");
  return rules.patterns[index].shape = number;
}

void add_rule(Rules& rules, std::string_view search, std::string_view replacement, char flag) {
  const std::size_t before = rules.patterns.size();
  Rule rule;
  Parser left(rules, search);
  rule.search = left.expression();
  Parser right(rules, replacement);
  rule.replacement = right.expression();
  if (!left.ok() || !right.ok() || rules.patterns[rule.search].kind != Pattern::Kind::kOp) {
    VITRINE_UNREACHABLE(std::string(search).c_str());
    rules.ill_formed.emplace_back(search);
    rules.patterns.resize(before);
    return;
  }
  rule.commutative = number_commutative(rules, rule.search, 0);
  rule.needs_free_zeros = flag == 'z';
  shape_of(rules, rule.search);
  const Pattern& root = rules.patterns[rule.search];
  rules.by_op[static_cast<std::size_t>(root.op)].push_back(
      {root.shape, static_cast<std::uint16_t>(rules.rules.size())});
  rules.rules.push_back(rule);
}

void add_shape(Rules& rules, const char* text) {
  const std::size_t before = rules.patterns.size();
  Parser parser(rules, text);
  const std::uint16_t index = parser.expression();
  if (parser.ok()) {
    shape_of(rules, index);
  } else {
    VITRINE_UNREACHABLE(text);
    rules.ill_formed.emplace_back(text);
  }
  rules.patterns.resize(before);
}

std::string with_op(std::string text, std::string_view op) {
  for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$')) text.replace(at, 1, op);
  return text;
}

}  // namespace

bool is_commutative(Op op) { return op < Op::kAluCount && ir::alu_info(op).swap != '_'; }

ir::Op shape_op(ir::Op op) {
  switch (op) {
    case Op::kAndB:
      return Op::kAnd;
    case Op::kOrB:
      return Op::kOr;
    case Op::kXorB:
      return Op::kINe;
    case Op::kEqB:
      return Op::kIEq;
    case Op::kNotB:
      return Op::kNot;
    case Op::kSelectB:
      return Op::kSelect;
    default:
      return op;
  }
}

Rules parse_rules(std::span<const RuleText> texts, std::span<const char* const> shapes) {
  Rules rules;
  rules.patterns.reserve(texts.size() * 16);
  rules.rules.reserve(texts.size() * 2);
  for (const RuleText& text : texts) {
    std::string_view ops = text.ops;
    if (ops.empty()) add_rule(rules, text.search, text.replacement, text.flag);
    while (!ops.empty()) {
      const std::size_t end = std::min(ops.find(' '), ops.size());
      const std::string_view op = ops.substr(0, end);
      add_rule(rules, with_op(text.search, op), with_op(text.replacement, op), text.flag);
      ops.remove_prefix(std::min(end + 1, ops.size()));
    }
  }
  for (const char* shape : shapes) add_shape(rules, shape);
  return rules;
}

}  // namespace vitrine::spirv::rewriting
