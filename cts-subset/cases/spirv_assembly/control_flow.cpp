// Random structured control flow at the level of SPIR-V, beyond what a GLSL compiler writes: switches that fall
// through, breaks and continues across several constructs, phis at every kind of join, loops that exchange values,
// conditional back edges, continue targets and merge blocks that nothing reaches, returns from anywhere.
#include "harness/case.h"
#include "harness/run.h"
#include "harness/shader.h"
#include "tests/spirv/compute_text.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kInvocations = 64;

/// A block that several others branch to, with the value that each of them brings.
struct Target {
  std::string label;
  std::vector<std::pair<std::string, std::string>> from;  ///< value, label of the predecessor
};

/// Where a branch may lead besides straight on.
struct Around {
  Target* loop_merge = nullptr;
  Target* loop_continue = nullptr;
  Target* switch_merge = nullptr;  ///< of a switch inside the innermost loop
  Target* next_case = nullptr;
};

class Generator {
 public:
  explicit Generator(Random& random) : random_(random) {}

  std::string module() {
    text_ = "%f = OpFunction %uint None %f_type\n%x = OpFunctionParameter %uint\n";
    begin("%f_entry");
    text_ += "%r = OpVariable %uint_local Function\nOpStore %r %x\n";
    if (list(4, {})) leave();
    text_ += "OpFunctionEnd\n";
    ComputeText module;
    module.uniform = true;
    module.declarations = "%f_type = OpTypeFunction %uint %uint\n%uint_local = OpTypePointer Function %uint\n";
    for (uint32_t i = 2; i < kConstants; i++)
      module.declarations += "%u" + std::to_string(i) + " = OpConstant %uint " + std::to_string(i) + "\n";
    module.body = load_word("%x_main", "in") +
                  "%result = OpFunctionCall %uint %f %x_main\n%different = OpIAdd %uint %result %n\n" +
                  store_word("%different", "out");
    module.functions = text_;
    return module.text();
  }

 private:
  static constexpr uint32_t kConstants = 40;

  std::string fresh(const char* prefix) { return std::string("%") + prefix + std::to_string(next_++); }
  std::string number() { return "%u" + std::to_string(random_.below(kConstants)); }

  void begin(const std::string& label) {
    text_ += label + " = OpLabel\n";
    current_ = label;
  }

  std::string emit(const std::string& operation) {
    const std::string id = fresh("v");
    text_ += id + " = " + operation + "\n";
    return id;
  }

  std::string value() {
    switch (random_.below(3)) {
      case 0:
        return "%x";
      case 1:
        return number();
      default:
        return emit("OpLoad %uint %r");
    }
  }

  void mix(const std::string& id) {
    const std::string scaled = emit("OpIMul %uint " + emit("OpLoad %uint %r") + " %u31");
    text_ += "OpStore %r " + emit("OpIAdd %uint " + scaled + " " + id) + "\n";
  }

  std::string bits(uint32_t mask) {
    const std::string by = std::to_string(random_.below(12));
    const std::string shifted = emit("OpShiftRightLogical %uint " + value() + " " + "%u" + by);
    return emit("OpBitwiseAnd %uint " + shifted + " %u" + std::to_string(mask));
  }

  std::string condition() { return emit("OpIEqual %bool " + bits(random_.pick({1u, 1u, 3u})) + " %u0"); }

  void leave() { text_ += "OpReturnValue " + value() + "\n"; }

  /// Branches to a target with a value of this block.
  void jump(Target& target) {
    const std::string added = number();
    target.from.emplace_back(emit("OpIAdd %uint " + value() + " " + added), current_);
    text_ += "OpBranch " + target.label + "\n";
  }

  /// Begins the target's block. False if nothing leads there: it is closed at once.
  bool join(Target& target) {
    begin(target.label);
    if (target.from.empty()) {
      text_ += "OpUnreachable\n";
      return false;
    }
    std::string phi = "OpPhi %uint";
    for (const auto& [id, label] : target.from) phi += " " + id + " " + label;
    mix(emit(phi));
    return true;
  }

  /// Statements into the open block. False if it ended in a jump.
  bool list(int depth, const Around& around) {
    const uint32_t count = 1 + random_.below(3);
    for (uint32_t i = 0; i < count; i++) {
      const uint32_t kind = depth > 0 ? random_.below(8) : 0;
      bool open = true;
      if (kind <= 1)
        mix(number());
      else if (kind <= 4)
        open = selection(depth - 1, around);
      else if (kind <= 5)
        open = switches(depth - 1, around);
      else
        open = loop(depth - 1, around);
      if (!open) return false;
    }
    return true;
  }

  /// A branch of a construct: statements, then to `merge` or further out.
  void branch(const std::string& label, Target& merge, int depth, const Around& around) {
    begin(label);
    if (!list(depth, around)) return;
    if (random_.chance(0.3f)) {
      std::vector<Target*> ways;
      for (Target* way : {around.loop_merge, around.loop_continue, around.switch_merge, around.next_case})
        if (way) ways.push_back(way);
      if (ways.empty() || random_.chance(0.15f)) return leave();
      return jump(*random_.pick(ways));
    }
    jump(merge);
  }

  bool selection(int depth, Around around) {
    Target merge{fresh("merge"), {}};
    const std::string yes = fresh("yes"), no = fresh("no");
    const bool only_yes = random_.chance(0.3f);
    around.next_case = nullptr;  // a case falls through from its own blocks only
    const std::string chooser = condition(), value_around = value();
    text_ += "OpSelectionMerge " + merge.label + " None\nOpBranchConditional " + chooser + " " + yes + " " +
             (only_yes ? merge.label : no) + "\n";
    if (only_yes) merge.from.emplace_back(value_around, current_);
    branch(yes, merge, depth, around);
    if (!only_yes) branch(no, merge, depth, around);
    return join(merge);
  }

  bool switches(int depth, Around around) {
    Target merge{fresh("end"), {}};
    const uint32_t count = 2 + random_.below(3);
    std::vector<Target> cases(count);
    const std::string selector = bits(3), brought = value();
    text_ += "OpSelectionMerge " + merge.label + " None\nOpSwitch " + selector + " ";
    const bool empty_default = random_.chance(0.3f);
    for (uint32_t i = 0; i < count; i++) cases[i].label = fresh("case");
    text_ += empty_default ? merge.label : cases[count - 1].label;
    for (uint32_t i = 0; i + 1 < count; i++) text_ += " " + std::to_string(i) + " " + cases[i].label;
    if (empty_default) text_ += " " + std::to_string(count - 1) + " " + cases[count - 1].label;
    text_ += "\n";
    const std::string header = current_;
    if (empty_default) merge.from.emplace_back(brought, header);
    around.switch_merge = &merge;
    for (uint32_t i = 0; i < count; i++) {
      cases[i].from.emplace_back(brought, header);
      join(cases[i]);
      around.next_case = i + 1 < count ? &cases[i + 1] : nullptr;
      if (!list(depth, around)) continue;
      jump(around.next_case && random_.chance(0.4f) ? *around.next_case : merge);
    }
    return join(merge);
  }

  bool loop(int depth, const Around&) {
    const std::string header = fresh("head"), body = fresh("body"), before = current_;
    const std::string k = fresh("k"), next = fresh("k"), p = fresh("p"), q = fresh("q");
    const std::string p0 = value(), q0 = value();
    Target merge{fresh("exit"), {}}, again{fresh("again"), {}};
    text_ += "OpBranch " + header + "\n";
    begin(header);
    const std::string back = " " + again.label + "\n";
    text_ += k + " = OpPhi %uint %u0 " + before + " " + next + back;
    text_ += p + " = OpPhi %uint " + p0 + " " + before + " " + q + back;
    text_ += q + " = OpPhi %uint " + q0 + " " + before + " " + p + back;
    const bool test_first = random_.chance(0.7f);
    const std::string more = emit("OpULessThan %bool " + k + " %u" + std::to_string(1 + random_.below(5)));
    text_ += "OpLoopMerge " + merge.label + " " + again.label + " None\n";
    if (test_first) {
      merge.from.emplace_back(p, current_);
      text_ += "OpBranchConditional " + more + " " + body + " " + merge.label + "\n";
    } else {
      text_ += "OpBranch " + body + "\n";
    }
    begin(body);
    mix(p);
    Around inside;
    inside.loop_merge = &merge;
    inside.loop_continue = &again;
    if (list(depth, inside)) jump(again);
    begin(again.label);
    if (!again.from.empty()) {
      std::string phi = "OpPhi %uint";
      for (const auto& [id, label] : again.from) phi += " " + id + " " + label;
      mix(emit(phi));
    }
    text_ += next + " = OpIAdd %uint " + k + " %u1\n";
    if (test_first && random_.chance(0.7f)) {
      text_ += "OpBranch " + header + "\n";
    } else {
      merge.from.emplace_back(next, current_);
      const std::string repeat = emit("OpULessThan %bool " + next + " %u" + std::to_string(1 + random_.below(5)));
      text_ += "OpBranchConditional " + repeat + " " + header + " " + merge.label + "\n";
    }
    return join(merge);
  }

  Random& random_;
  std::string text_, current_;
  uint32_t next_ = 0;
};

CTS_RANDOM("spirv_assembly", "random_control_flow", 40) {
  const std::string text = Generator(run.random).module();
  run.note("assembly", text);
  std::vector<uint32_t> words(kInvocations);
  for (uint32_t& word : words) word = run.random.bits();
  const Buffer in = run.buffer_of(words), out = run.buffer(kInvocations * 4);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.module(assemble_spirv(text)));
  run.dispatch(res, pipeline, 1);
  run.out("out", out);
}

}  // namespace
}  // namespace vitrine::cts
