// Random control flow: nested ifs, loops with data-dependent trip counts, switches, early returns, functions with
// inout parameters, local arrays, discard. The final state of every variable is compared.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

class StatementWriter {
 public:
  StatementWriter(Random& random, bool fragment)
      : random_(random), expressions_(random, {.vectors = true, .functions = true}), fragment_(fragment) {}

  /// Local state that statements change, and functions that they call.
  ShaderBody body(uint32_t statements) {
    ShaderBody result;
    result.declarations = functions();
    for (const Variable& input : shader_inputs()) expressions_.add(input);
    for (int k = 0; k < 6; ++k) {
      Variable v{random_.pick<Type>({{Base::kFloat, 1}, {Base::kInt, 1}, {Base::kUint, 1}, {Base::kFloat, 4}}),
                 "s" + std::to_string(k)};
      result.statements += "  " + type_name(v.type) + " " + v.name + " = " + expressions_.expression(v.type, 1) + ";\n";
      state_.push_back(v);
      expressions_.add(v);
    }
    result.statements += "  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n  int steps = 0;\n";
    for (uint32_t n = 0; n < statements; ++n) result.statements += statement(3, 1);
    result.statements += "  float sum = 0.0;\n  for (int k = 0; k < 7; ++k) sum += array[k];\n";
    result.results = state_;
    result.results.push_back({{Base::kFloat, 1}, "sum"});
    result.results.push_back({{Base::kInt, 1}, "steps"});
    return result;
  }

 private:
  std::string indent(int level) { return std::string(static_cast<size_t>(level) * 2, ' '); }
  std::string condition() { return expressions_.expression({Base::kBool, 1}, 2); }

  std::string assignment(int level) {
    const Variable& v = random_.pick(state_);
    if (random_.chance(0.15f)) {
      const std::string value = expressions_.expression({Base::kFloat, 1}, 2);
      return indent(level) + "array[(" + expressions_.expression({Base::kInt, 1}, 1) +
             " & 0x7fffffff) % 7] = " + value + ";\n";
    }
    if (random_.chance(0.1f) && v.type == Type{Base::kFloat, 1})
      return indent(level) + v.name + " = array[(" + expressions_.expression({Base::kInt, 1}, 1) +
             " & 0x7fffffff) % 7];\n";
    if (random_.chance(0.15f) && v.type.size == 1 && v.type.base != Base::kUint)
      return indent(level) + v.name + (v.type.base == Base::kInt ? " = walk(" : " = shape(") + v.name + ", " +
             expressions_.expression({v.type.base, 1}, 1) + ");\n";
    return indent(level) + v.name + " = " + expressions_.expression(v.type, 2) + ";\n";
  }

  std::string block(int depth, int level) {
    std::string text = "{\n";
    for (uint32_t n = 1 + random_.below(3); n > 0; --n) text += statement(depth - 1, level + 1);
    return text + indent(level) + "}";
  }

  std::string loop_exit(int level) {
    if (!random_.chance(0.5f)) return "";
    const std::string exit = random_.pick({"break", "continue"});
    return indent(level) + "if (" + condition() + ") " + exit + ";\n";
  }

  std::string loop(int depth, int level) {
    const std::string k = "k" + std::to_string(next_name_++);
    const std::string trips = random_.chance(0.3f) ? std::to_string(1 + random_.below(6))
                                                   : "(" + expressions_.expression({Base::kInt, 1}, 1) + " & 7)";
    const std::string inner = block(depth, level);
    const std::string guarded = "{\n" + indent(level + 1) + "++steps;\n" + loop_exit(level + 1) + inner.substr(2);
    switch (random_.below(3)) {
      case 0:
        return indent(level) + "for (int " + k + " = 0, n" + k + " = " + trips + "; " + k + " < n" + k + "; ++" + k +
               ") " + guarded + "\n";
      case 1:
        return indent(level) + "int " + k + " = " + trips + ";\n" + indent(level) + "while (" + k + "-- > 0) " +
               guarded + "\n";
      default:  // all invocations leave together: deviation value-leaves-loop
        return indent(level) + "int " + k + " = (pi." + "xyzw"[next_name_ % 4] + " & 7);\n" + indent(level) + "do " +
               guarded + " while (--" + k + " > 0);\n";
    }
  }

  std::string selection(int level, int depth) {
    std::string text = indent(level) + "switch (" + expressions_.expression({Base::kInt, 1}, 2) + " & 3) {\n";
    for (const char* label : {"case 0:", "case 2:", "default:"}) {
      text += indent(level + 1) + label + "\n" + statement(depth - 1, level + 2);
      if (label[0] == 'd' || random_.chance(0.7f)) text += indent(level + 2) + "break;\n";
    }
    return text + indent(level) + "}\n";
  }

  std::string statement(int depth, int level) {
    if (depth <= 0) return assignment(level);
    switch (random_.below(8)) {
      case 0: {
        const std::string then = block(depth, level);
        return indent(level) + "if (" + condition() + ") " + then + "\n";
      }
      case 1: {
        const std::string otherwise = block(depth, level), then = block(depth, level);
        return indent(level) + "if (" + condition() + ") " + then + " else " + otherwise + "\n";
      }
      case 2:
      case 3:
        return loop(depth, level);
      case 4:
        return selection(level, depth);
      case 5:
        if (fragment_ && level == 1 && random_.chance(0.3f))
          return indent(level) + "if (" + condition() + ") discard;\n";
        [[fallthrough]];
      default:
        return assignment(level);
    }
  }

  /// Two functions with loops and early returns, one of them changing its argument.
  std::string functions() {
    return "void twist(inout float x, in float y) {\n"
           "  if (x > y) { x = y - x * 0.5; return; }\n"
           "  x += y;\n"
           "}\n"
           "float shape(float x, float y) {\n"
           "  for (int k = 0; k < 5; ++k) {\n"
           "    if (x > 4.0) return x - y;\n"
           "    twist(x, y);\n"
           "    y = y * 0.75 + 1.0;\n"
           "  }\n"
           "  return x * y;\n"
           "}\n"
           "int walk(int x, int y) {\n"
           "  int n = 0;\n"
           "  while ((x & 15) != 0) {\n"
           "    if (++n > 20) return -1;\n"
           "    x = (x & 1) != 0 ? x + y : x >> 1;\n"
           "  }\n"
           "  return x ^ n;\n"
           "}\n";
  }

  Random& random_;
  ExpressionWriter expressions_;
  bool fragment_;
  std::vector<Variable> state_;
  int next_name_ = 0;
};

void random_control_flow(Run& run, Stage stage) {
  StatementWriter writer(run.random, stage == Stage::kFragment);
  evaluate(run, stage, writer.body(4 + run.random.below(6)));
}

const AddGenerator kCompute("glsl", "random_control_flow.compute", 120,
                            [](Run& run) { random_control_flow(run, Stage::kCompute); });
const AddGenerator kVertex("glsl", "random_control_flow.vertex", 60,
                           [](Run& run) { random_control_flow(run, Stage::kVertex); });
const AddGenerator kFragment("glsl", "random_control_flow.fragment", 80,
                             [](Run& run) { random_control_flow(run, Stage::kFragment); });

}  // namespace
}  // namespace vitrine::cts
