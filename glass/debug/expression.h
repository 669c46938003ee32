// GLSL-like expressions over the variables of a stopped shader: names, members, swizzles, indices, operators, the
// constructors of scalars and a few functions. Nothing that it computes is stored anywhere.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "glass/debug/value.h"

namespace vitrine::glass::debug {

/// Looks names up.
class Names {
 public:
  virtual ~Names() = default;
  /// Nothing: there is no such variable.
  virtual std::optional<Place> find(std::string_view name) const = 0;
};

struct ExpressionNode;

/// One that has been read, and can be evaluated for many invocations. Copies share it.
class Expression {
 public:
  static base::Result<Expression> read(std::string_view text);
  base::Result<Value> evaluate(const Viewer& viewer, const Names& names) const;

 private:
  explicit Expression(std::shared_ptr<const ExpressionNode> root) : root_(std::move(root)) {}
  std::shared_ptr<const ExpressionNode> root_;
};

/// Reads and evaluates.
base::Result<Value> evaluate(std::string_view text, const Viewer& viewer, const Names& names);

}  // namespace vitrine::glass::debug
