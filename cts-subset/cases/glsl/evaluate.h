// Runs a shader body over thousands of random inputs in the compute, vertex or fragment stage.
#pragma once

#include <string>
#include <vector>

#include "cases/glsl/expression.h"
#include "harness/graphics.h"

namespace vitrine::cts {

enum class Stage { kCompute, kVertex, kFragment };

/// A body that computes named values; each is stored, so that a difference names the value and its line.
struct ShaderBody {
  std::string declarations;        ///< functions and constants before main
  std::string statements;          ///< inside main, after the inputs a, b (vec4), i (ivec4), u (uvec4)
  std::vector<Variable> results;   ///< values to store
  std::vector<std::string> lines;  ///< text shown for each result; may be shorter than results
  bool specials = false;           ///< inputs with NaN, infinities, denormals, ...
};

/// The inputs that bodies may use.
const std::vector<Variable>& shader_inputs();
/// 4096 invocations of the body.
void evaluate(Run& run, Stage stage, const ShaderBody& body);

}  // namespace vitrine::cts
