// Rules in their parsed form (lavapipe-shader-math.md section 4, lavapipe-optimizer.md section 4).
//
// A rule is written "search => replacement" in functional notation over the names of ops.def:
//   a ... h    a variable: any value, the same one at each place      #a   a constant
//   a:cond     a variable with a condition; Op:cond(...)              the conditions of Condition below
//   ~Op        inexact: the rule applies only if no matched instruction is exact
//   !Op        (replacement) the new instruction is exact
//   a.x        (replacement) a component of what the variable stands for
//   Vec(...)   components put together
//   1.5        float constant, compared as a number; 3, -1, 0xff integer bits; true, false
// Commutative operations of a search are tried in both operand orders.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spirv/ir.h"

namespace vitrine::spirv::rewriting {

enum class Condition : std::uint8_t {
  kNone,
  // of an instruction
  kOnce,       ///< its result has one use
  kFloatOnly,  ///< all uses are float operands of arithmetic
  kUsed,       ///< it has a use other than by FSat
  kNotForIf,   ///< no If decides by it
  kBits16,     ///< its numbers have 16 bits
  kBits32,
  kBits64,
  // of an operand
  kNotConst,
  kFmul,  ///< a product, or the negation of one
  kNotFmul,
  kPosPow2,
  kNegPow2,
  kShifts2,  ///< the lowest five bits are two or more
  kBelow32,
  kMultiple2,
  kMultiple4,
  kMultiple8,
  kMultiple16,
  kMultiple32,
  kMultiple64,
  kNumber,  ///< range analysis: cannot be NaN
  kFinite,
  kIntegral,
  kNotNegative,
  kNotPositive,
  kNotZero,
  kGt0,
  kLt0,
  kNumberNotNegative,
  kNumberNotPositive,
  kNumberGt0,
  kNumberLt0,
};

inline constexpr unsigned kMaxChildren = 4;

/// A node of a search or replacement tree.
struct Pattern {
  enum class Kind : std::uint8_t { kOp, kVariable, kFloat, kInteger, kBoolean } kind = Kind::kVariable;
  ir::Op op = ir::Op::kMov;
  Condition condition = Condition::kNone;
  bool inexact = false;
  bool exact = false;
  bool constant = false;         ///< variable that matches constants only
  std::int8_t commutative = -1;  ///< number among the commutative operations of the search, in pre-order
  std::uint8_t variable = 0;     ///< 0 = a
  std::int8_t component = -1;    ///< of the variable, in replacements; -1: all, in their order
  std::uint8_t children = 0;
  std::uint16_t child[kMaxChildren] = {};  ///< indices in Rules::patterns
  std::uint16_t shape = 0;                 ///< operations of searches: number of the structural pattern (see Shape)
  double number = 0.0;
  std::uint32_t bits = 0;
};

struct Rule {
  std::uint16_t search = 0, replacement = 0;
  std::uint8_t commutative = 0;   ///< commutative operations in the search
  bool needs_free_zeros = false;  ///< off when SignedZeroInfNanPreserve is declared
};

/// A search tree with variables made anonymous: what can be told without comparing values. An instruction's set of
/// matching shapes is its state; when a replacement changes the state of a user, the user is visited again (4.1).
struct Shape {
  std::uint8_t children = 0;
  bool commutative = false;
  std::uint16_t child[kMaxChildren] = {};  ///< kAnyShape, kConstShape or a shape's number
};
inline constexpr std::uint16_t kAnyShape = 0xffff, kConstShape = 0xfffe;
inline constexpr std::size_t kMaxShapes = 64;  ///< of one operation: bits of a state

/// Of the shape at `index` among those of an operation.
constexpr std::uint16_t shape_number(ir::Op op, std::size_t index) {
  return static_cast<std::uint16_t>(static_cast<std::size_t>(op) * kMaxShapes + index);
}

/// A rule of an operation, with the shape that what it applies to has.
struct Candidate {
  std::uint16_t shape = 0;
  std::uint16_t rule = 0;
};

struct Rules {
  std::vector<Pattern> patterns;
  std::vector<Rule> rules;
  std::vector<Candidate> by_op[static_cast<std::size_t>(ir::Op::kAluCount)];  ///< in table order
  std::vector<Shape> shapes[static_cast<std::size_t>(ir::Op::kAluCount)];     ///< of each operation
  std::vector<std::string> ill_formed;                                        ///< rules and shapes left out
};

/// How a rule is written in the table; `ops`: names separated by blanks, each put for every $ in turn; flags: 'z'
/// needs_free_zeros.
struct RuleText {
  const char* search;
  const char* replacement;
  const char* ops = "";
  char flag = 0;
};

/// Parses a table, and shapes that no rule of it has. An ill-formed rule is a defect: it is logged and left out.
Rules parse_rules(std::span<const RuleText> texts, std::span<const char* const> shapes);

/// Shapes of rules that never apply (shapes.cpp).
std::span<const char* const> main_shapes();
std::span<const char* const> late_shapes();

/// The tables, parsed at first use.
const Rules& main_rules();
const Rules& late_rules();

bool is_commutative(ir::Op op);

/// The op that shapes know: those of booleans are those of bits, as the reference has one op for both.
ir::Op shape_op(ir::Op op);

}  // namespace vitrine::spirv::rewriting
