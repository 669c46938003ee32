// SSA construction over the tree: every slot of variables.cpp has a current value; If yields what its branches changed,
// Loop carries what its body changes. Unused parameters and results are removed later by ir::remove_dead.
#include <algorithm>
#include <unordered_set>

#include "spirv/front/context.h"

namespace vitrine::spirv::front {
namespace {

using Kind = ir::Node::Kind;
using Slots = std::vector<std::uint32_t>;

bool ends_in_jump(const ir::NodeList& list) {
  if (list.empty() || list.back()->kind != Kind::kInstr) return false;
  const ir::Op op = list.back()->instr.op;
  return op == ir::Op::kBreak || op == ir::Op::kContinue || op == ir::Op::kKill || op == ir::Op::kReturn;
}

struct Builder {
  Translator& t;
  std::vector<ir::ValueId> current;      ///< per slot
  std::vector<ir::ValueInfo> info;       ///< per slot
  std::vector<ir::ValueId> replacement;  ///< of a LoadVar's result
  /// Vectors of loaded words, each of which an earlier load may have brought, and composed vectors.
  std::unordered_set<ir::ValueId> words;
  std::unordered_set<ir::ValueId> supplied;  ///< components of inputs, as declared or interpolated elsewhere
  std::unordered_map<const ir::Node*, Slots> stored;
  /// The loop around the current list.
  struct Loop {
    const Slots* all = nullptr;      ///< slots that results carry
    const Slots* in_body = nullptr;  ///< slots that continue_params carry
  } loop;

  ir::ValueId value(std::uint32_t slot) {
    if (current[slot] == ir::kNoValue) current[slot] = undefined(t, info[slot].components, info[slot].boolean);
    return current[slot];
  }

  void resolve(ir::Src& src) {
    if (src.value < replacement.size() && replacement[src.value] != ir::kNoValue) src.value = replacement[src.value];
  }

  /// Slots stored in a list; remembers those of nested nodes.
  void collect(const ir::NodeList& list, Slots& slots) {
    for (const auto& node : list) {
      if (node->kind == Kind::kInstr) {
        if (node->instr.op == ir::Op::kStoreVar) slots.push_back(node->instr.data[1]);
        note(node->instr);
        continue;
      }
      Slots inside;
      for (const ir::NodeList* part : {&node->then_list, &node->else_list, &node->body, &node->continuing})
        collect(*part, inside);
      std::sort(inside.begin(), inside.end());
      inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
      slots.insert(slots.end(), inside.begin(), inside.end());
      stored[node.get()] = std::move(inside);
    }
  }

  void note(const ir::Instr& instr) {
    if (instr.op != ir::Op::kLoadVar && instr.op != ir::Op::kStoreVar) return;
    const std::uint32_t slot = instr.data[1];
    if (slot >= current.size()) {
      current.resize(slot + 1, ir::kNoValue);
      info.resize(slot + 1);
    }
    info[slot] = t.function.values[instr.op == ir::Op::kLoadVar ? instr.result : instr.src[0].value];
  }

  void count_arguments(std::size_t count) {
    t.arguments += count;
    if (t.arguments > kMaxArguments) throw Failure("too many variables live across the control flow");
  }

  std::vector<ir::Src> values(const Slots& slots) {
    count_arguments(slots.size());
    std::vector<ir::Src> sources;
    for (std::uint32_t slot : slots) sources.push_back(whole(value(slot)));
    return sources;
  }

  static void end_list(ir::NodeList& list, std::vector<ir::Src> sources) {
    auto node = std::make_unique<ir::Node>();
    node->instr.op = ir::Op::kYield;
    node->instr.components = 0;
    node->instr.src = std::move(sources);
    list.push_back(std::move(node));
  }

  void process(ir::NodeList& list) {
    ir::NodeList old = std::move(list);
    list.clear();
    for (auto& node : old) {
      switch (node->kind) {
        case Kind::kIf:
          process_if(*node);
          break;
        case Kind::kLoop:
          process_loop(*node);
          break;
        case Kind::kInstr:
          for (ir::Src& src : node->instr.src) resolve(src);
          if (process_instr(node->instr)) continue;
          break;
      }
      list.push_back(std::move(node));
      if (ends_in_jump(list)) return;
    }
  }

  /// True when the instruction disappears.
  bool process_instr(ir::Instr& instr) {
    switch (instr.op) {
      case ir::Op::kLoadVar:
        return !becomes_copy(instr);
      case ir::Op::kStoreVar:
        current[instr.data[1]] = instr.src[0].value;
        return true;
      case ir::Op::kBreak:
        instr.src = values(*loop.all);
        return false;
      case ir::Op::kContinue:
        instr.src = values(*loop.in_body);
        return false;
      case ir::Op::kLoadPush:
      case ir::Op::kLoadUniform:
      case ir::Op::kLoadStorage:
        if (instr.components > 1) words.insert(instr.result);
        return false;
      case ir::Op::kLoadInput:
      case ir::Op::kFFused:
        supplied.insert(instr.result);
        return false;
      case ir::Op::kVec:
        if (is_composed(instr)) words.insert(instr.result);
        return false;
      case ir::Op::kMov:
        if (instr.components > 1 && words.count(instr.src[0].value) != 0) words.insert(instr.result);
        return false;
      default:
        return false;
    }
  }

  /// Whether a vector is composed in the reference, too, and has all its components. One of an input's components
  /// stands for one load; copies of it, and of what is in part undefined, would keep inputs and outputs that nothing
  /// uses.
  bool is_composed(const ir::Instr& vec) const {
    const auto holds = [&](const std::unordered_set<ir::ValueId>& ids) {
      return [&](const ir::Src& part) { return ids.count(part.value) != 0; };
    };
    return !std::all_of(vec.src.begin(), vec.src.end(), holds(supplied)) &&
           std::none_of(vec.src.begin(), vec.src.end(), holds(t.undefined_ids));
  }

  /// Each load of a variable that holds loaded words or a composed vector is a copy of it: rewrite() may compose loaded
  /// words of several values, and the first rules of the reference tell each composed vector from its copies.
  bool becomes_copy(ir::Instr& instr) {
    const ir::ValueId loaded = value(instr.data[1]);
    if (words.count(loaded) == 0) {
      replacement.resize(t.function.values.size(), ir::kNoValue);
      replacement[instr.result] = loaded;
      return false;
    }
    words.insert(instr.result);
    instr.op = is_boolean(t, loaded) ? ir::Op::kCopyVarB : ir::Op::kCopyVar;
    instr.src = {whole(loaded)};
    std::fill(std::begin(instr.data), std::end(instr.data), 0u);
    return true;
  }

  /// A value that both sides of an If may see: one of them when the other is undefined, as the reference removes such
  /// phis (lavapipe-shader-math.md 10); kNoValue when a result is needed.
  ir::ValueId common(ir::ValueId before, ir::ValueId a, ir::ValueId b) const {
    if (a == b) return a;
    auto outside = [&](ir::ValueId v) { return v == before || t.constant_words.count(v) != 0; };
    if (t.undefined_ids.count(a) != 0 && outside(b)) return b;
    if (t.undefined_ids.count(b) != 0 && outside(a)) return a;
    return ir::kNoValue;
  }

  void process_if(ir::Node& node) {
    resolve(node.condition);
    const Slots slots = stored[&node];
    count_arguments(slots.size());
    std::vector<ir::ValueId> before, after_then, after_else;
    for (std::uint32_t slot : slots) before.push_back(value(slot));
    auto branch = [&](ir::NodeList& list, std::vector<ir::ValueId>& after) {
      process(list);
      for (std::size_t i = 0; i < slots.size(); i++) {
        after.push_back(value(slots[i]));
        current[slots[i]] = before[i];
      }
      return ends_in_jump(list);
    };
    const bool then_jumps = branch(node.then_list, after_then), else_jumps = branch(node.else_list, after_else);
    std::vector<ir::Src> then_yield, else_yield;
    for (std::size_t i = 0; i < slots.size() && !(then_jumps && else_jumps); i++) {
      const ir::ValueId a = then_jumps ? after_else[i] : after_then[i], b = else_jumps ? after_then[i] : after_else[i];
      const bool one_side = then_jumps || else_jumps;
      ir::ValueId joined =
          one_side && a != before[i] && t.constant_words.count(a) == 0 ? ir::kNoValue : common(before[i], a, b);
      if (joined == ir::kNoValue) {
        joined = t.function.new_value(info[slots[i]].components, info[slots[i]].boolean);
        node.results.push_back(joined);
        then_yield.push_back(whole(a));
        else_yield.push_back(whole(b));
      }
      current[slots[i]] = joined;
    }
    if (!then_jumps) end_list(node.then_list, std::move(then_yield));
    if (!else_jumps) end_list(node.else_list, std::move(else_yield));
  }

  std::vector<ir::ValueId> fresh(const Slots& slots) {
    std::vector<ir::ValueId> made;
    for (std::uint32_t slot : slots) {
      made.push_back(t.function.new_value(info[slot].components, info[slot].boolean));
      current[slot] = made.back();
    }
    return made;
  }

  void process_loop(ir::Node& node) {
    const Slots all = stored[&node];
    Slots in_body;
    collect(node.body, in_body);
    std::sort(in_body.begin(), in_body.end());
    in_body.erase(std::unique(in_body.begin(), in_body.end()), in_body.end());
    const Loop outer = std::exchange(loop, Loop{&all, &in_body});
    node.init = values(all);
    node.params = fresh(all);
    process(node.body);
    if (!ends_in_jump(node.body)) end_list(node.body, values(in_body));
    for (std::size_t i = 0; i < all.size(); i++) current[all[i]] = node.params[i];
    node.continue_params = fresh(in_body);
    process(node.continuing);
    if (!ends_in_jump(node.continuing)) end_list(node.continuing, values(all));
    node.results = fresh(all);
    loop = outer;
  }
};

}  // namespace

void build_ssa(Translator& t) {
  Builder builder{t, {}, {}, {}, {}, {}, {}, {}};
  t.list = &t.function.body;
  Slots all;
  builder.collect(t.function.body, all);
  builder.process(t.function.body);
}

}  // namespace vitrine::spirv::front
