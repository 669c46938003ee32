// Runs steps of the rewrites on a shader's text: vitrine_step STEP... < TEXT prints what is left. The text is what
// VITRINE_LOG=ir prints, or shorter (tests/spirv/ir_text.h); the steps are rows of spirv/rewrite/passes.def. A rule of
// opt_algebraic: echo 'StoreOutput FAdd(FMul(%a, %b), FMul(%b, %c))' | vitrine_step opt_algebraic opt_dce
#include <cstdio>
#include <exception>
#include <iostream>
#include <iterator>
#include <string>

#include "spirv/ir_passes.h"
#include "spirv/rewrite/passes.h"
#include "tests/spirv/ir_text.h"

namespace vitrine::spirv {
namespace {

int list_steps() {
  std::fputs("usage: vitrine_step STEP... < TEXT (its form: tests/spirv/ir_text.h)\nsteps:", stderr);
  for (const rewriting::Pass& pass : rewriting::passes())
    if (rewriting::find_pass(pass.name) == &pass) std::fprintf(stderr, " %s", pass.name);
  std::fputs("\n", stderr);
  return 2;
}

int run(int argc, char** argv) {
  if (argc < 2) return list_steps();
  for (int i = 1; i < argc; ++i) {
    if (rewriting::find_pass(argv[i]) != nullptr) continue;
    std::fprintf(stderr, "vitrine_step: no step is called %s\n", argv[i]);
    return list_steps();
  }
  const std::string text((std::istreambuf_iterator<char>(std::cin)), {});
  ir::Function function = test::parse_ir(text);
  rewriting::Graph graph(function);
  for (int i = 1; i < argc; ++i) rewriting::find_pass(argv[i])->run(graph);
  std::fputs(ir::dump(rewriting::snapshot(graph), ir::Origins::kShow).c_str(), stdout);
  return 0;
}

}  // namespace
}  // namespace vitrine::spirv

int main(int argc, char** argv) {
  try {
    return vitrine::spirv::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vitrine_step: %s\n", error.what());
    return 2;
  }
}
