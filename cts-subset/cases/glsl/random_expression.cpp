// Random expressions, by part of the language and by stage: each shader evaluates a dozen over 4096 inputs.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

struct Family {
  const char* name;
  Grammar grammar;
  int depth;
  uint32_t count;  ///< cases per stage
};

const Family kFamilies[] = {
    {"arithmetic", {.vectors = false, .functions = false, .integers = false, .conversions = false}, 4, 60},
    {"functions", {.vectors = true, .functions = true, .integers = false, .conversions = false}, 3, 60},
    {"transcendental", {.functions = false, .transcendental = true, .integers = false, .conversions = false}, 2, 50},
    {"integer", {.vectors = true, .functions = false, .integers = true, .conversions = false}, 4, 60},
    {"matrix", {.functions = false, .integers = false, .conversions = false, .matrices = true}, 3, 40},
    {"mixed", {.transcendental = true, .matrices = true}, 4, 80},
};

void random_expressions(Run& run, const Family& family, Stage stage) {
  ExpressionWriter writer(run.random, family.grammar);
  for (const Variable& input : shader_inputs())
    if (family.grammar.integers || input.type.base == Base::kFloat) writer.add(input);
  ShaderBody body;
  body.specials = run.index % 3 == 2;
  for (int k = 0; k < 12; ++k) {
    Variable result{writer.random_type(), "t" + std::to_string(k)};
    const bool precise = run.random.chance(0.1f);
    const std::string line = std::string(precise ? "precise " : "") + type_name(result.type) + " " + result.name +
                             " = " +
                             writer.expression(result.type, 1 + static_cast<int>(run.random.below(family.depth))) + ";";
    body.statements += "  " + line + "\n";
    body.lines.push_back(line);
    body.results.push_back(result);
    writer.add(result);
  }
  evaluate(run, stage, body);
}

const bool kRegistered = [] {
  constexpr std::pair<const char*, Stage> kStages[] = {
      {"compute", Stage::kCompute}, {"vertex", Stage::kVertex}, {"fragment", Stage::kFragment}};
  for (const Family& family : kFamilies)
    for (const auto& [name, stage] : kStages) {
      AddGenerator("glsl", (std::string("random_") + family.name + "." + name).c_str(), family.count,
                   [&family, stage = stage](Run& run) { random_expressions(run, family, stage); });
    }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
