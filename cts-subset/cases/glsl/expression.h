// Random GLSL: typed expressions, statements with control flow, and whole shader bodies.
#pragma once

#include <string>
#include <vector>

#include "harness/random.h"

namespace vitrine::cts {

enum class Base { kFloat, kInt, kUint, kBool };

struct Type {
  Base base = Base::kFloat;
  uint32_t size = 1;  ///< 1..4 components
  bool operator==(const Type&) const = default;
};
std::string type_name(Type type);

struct Variable {
  Type type;
  std::string name;
};

/// Which parts of the language expressions may use; narrow sets make differences easy to read.
struct Grammar {
  bool vectors = true;
  bool functions = true;        ///< GLSL.std.450 without polynomials: min, floor, sqrt, dot, ...
  bool transcendental = false;  ///< sin, exp, pow, atan, ...
  bool integers = true;
  bool conversions = true;
  bool matrices = false;
};

class ExpressionWriter {
 public:
  ExpressionWriter(Random& random, Grammar grammar) : random_(random), grammar_(grammar) {}

  void add(Variable variable) { variables_.push_back(std::move(variable)); }
  void forget_after(size_t count) { variables_.resize(count); }
  size_t known() const { return variables_.size(); }
  /// An expression of the type, at most `depth` operators deep.
  std::string expression(Type type, int depth);
  Type random_type();
  Random& random() { return random_; }
  const Grammar& grammar() const { return grammar_; }

 private:
  std::string leaf(Type type);
  std::string literal(Type type);
  std::string floats(Type type, int depth);
  std::string float_function(Type type, int depth);
  std::string transcendental(Type type, int depth);
  std::string vector_function(Type type, int depth);
  std::string divisor(Type type, int depth);
  std::string matrix_product(uint32_t size, int depth);
  std::string integers(Type type, int depth);
  std::string integer_function(Type type, int depth);
  std::string booleans(Type type, int depth);
  std::string converted(Type type, int depth);
  std::string swizzled_or_built(Type type, int depth);

  Random& random_;
  Grammar grammar_;
  std::vector<Variable> variables_;
};

}  // namespace vitrine::cts
