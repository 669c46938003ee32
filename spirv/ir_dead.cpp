// Dead code: marks what effects and outputs need, removes the rest, including loop parameters, results, whole Ifs and
// Loops, and interface slots that are no longer read or written.
#include "spirv/ir_passes.h"
#include "spirv/ir_walk.h"

namespace vitrine::spirv::ir {
namespace {

using Kind = Node::Kind;

/// What defines a value.
struct Definition {
  enum class Role : std::uint8_t { kNone, kInstr, kIfResult, kParam, kContinueParam, kLoopResult } role = Role::kNone;
  std::uint32_t index = 0;
  Node* node = nullptr;
};

bool is_jump(const Instr& instr) {
  return instr.op == Op::kBreak || instr.op == Op::kContinue || instr.op == Op::kKill || instr.op == Op::kReturn;
}

struct Marker {
  Function& function;
  std::vector<Definition> definitions;
  std::vector<bool> live;
  std::vector<bool> array_read;
  std::vector<bool> undefined;  ///< values of Undef
  std::vector<ValueId> work;

  void index(NodeList& list) {
    auto put = [&](const std::vector<ValueId>& values, Definition::Role role, Node* node) {
      for (std::uint32_t i = 0; i < values.size(); i++) definitions[values[i]] = {role, i, node};
    };
    each_node(list, [&](Node& node) {
      if (node.kind == Kind::kInstr) {
        if (node.instr.result != kNoValue) definitions[node.instr.result] = {Definition::Role::kInstr, 0, &node};
        if (node.instr.op == Op::kUndef) undefined[node.instr.result] = true;
        if (node.instr.op == Op::kLoadArray) array_read[node.instr.data[0]] = true;
      }
      put(node.results, node.kind == Kind::kIf ? Definition::Role::kIfResult : Definition::Role::kLoopResult, &node);
      put(node.params, Definition::Role::kParam, &node);
      put(node.continue_params, Definition::Role::kContinueParam, &node);
    });
  }

  /// Must this instruction stay whatever uses its result?
  bool needed(const Instr& instr) const {
    if (instr.op == Op::kStoreOutput && undefined[instr.src[0].value]) return false;  // section 10: dropped
    if (instr.op == Op::kStoreArray && !array_read[instr.data[0]]) return false;
    return has_effect(instr.op, instr.image.get());
  }

  /// Does the list contain something needed, or a jump out of it?
  bool any_needed(const NodeList& list, bool jumps_count) const {
    for (const auto& node : list) {
      if (node->kind == Kind::kInstr) {
        if (needed(node->instr) || (jumps_count && is_jump(node->instr))) return true;
      } else if (node->kind == Kind::kIf) {
        if (any_needed(node->then_list, jumps_count) || any_needed(node->else_list, jumps_count)) return true;
      } else if (any_needed(node->body, false) || any_needed(node->continuing, false)) {
        return true;
      }
    }
    return false;
  }

  /// Loads of words behind which equal ones may read the same value: those of the outermost list stay.
  static bool loads_words(const Instr& instr) {
    return instr.op == Op::kLoadPush || instr.op == Op::kLoadUniform || instr.op == Op::kLoadStorage;
  }

  void keep_loads() {
    for (const auto& node : function.body) {
      if (node->kind != Kind::kInstr || !loads_words(node->instr)) continue;
      live[node->instr.result] = true;
      for (const Src& src : node->instr.src) use(src);
    }
  }

  void use(const Src& src) {
    if (live[src.value]) return;
    live[src.value] = true;
    work.push_back(src.value);
  }

  /// Keeps an If or Loop (marked in its otherwise unused instr) and what its lists need for themselves.
  void need(Node& node) {
    if (node.instr.data[0] == 1) return;
    node.instr.data[0] = 1;
    if (node.kind == Kind::kIf) use(node.condition);
    for (NodeList* part : {&node.then_list, &node.else_list, &node.body, &node.continuing}) mark(*part);
  }

  void mark(NodeList& list) {
    for (auto& node : list) {
      if (node->kind == Kind::kInstr) {
        if (needed(node->instr) && !is_jump(node->instr))
          for (const Src& src : node->instr.src) use(src);
      } else if (node->kind == Kind::kIf) {
        if (any_needed(node->then_list, true) || any_needed(node->else_list, true)) need(*node);
      } else if (any_needed(node->body, false) || any_needed(node->continuing, false)) {
        need(*node);
      }
    }
  }

  void propagate() {
    while (!work.empty()) {
      const Definition def = definitions[work.back()];
      work.pop_back();
      const std::uint32_t i = def.index;
      auto from_yield = [&](NodeList& list) {
        if (const Instr* yield = yield_of(list)) use(yield->src[i]);
      };
      auto from_jumps = [&](NodeList& list, Op op) {
        each_jump(list, [&](Instr& jump) {
          if (jump.op == op) use(jump.src[i]);
        });
      };
      switch (def.role) {
        case Definition::Role::kNone:
          break;
        case Definition::Role::kInstr:
          for (const Src& src : def.node->instr.src) use(src);
          break;
        case Definition::Role::kIfResult:
          need(*def.node);
          from_yield(def.node->then_list);
          from_yield(def.node->else_list);
          break;
        case Definition::Role::kParam:
          use(def.node->init[i]);
          from_yield(def.node->continuing);
          break;
        case Definition::Role::kContinueParam:
          from_yield(def.node->body);
          from_jumps(def.node->body, Op::kContinue);
          break;
        case Definition::Role::kLoopResult:
          need(*def.node);
          from_jumps(def.node->body, Op::kBreak);
          from_jumps(def.node->continuing, Op::kBreak);
          break;
      }
    }
  }

  // ---- sweep

  template <class T>
  void keep(std::vector<T>& items, const std::vector<ValueId>& targets) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < items.size(); i++)
      if (live[targets[i]]) items[kept++] = items[i];
    items.resize(kept);
  }

  void keep_targets(std::vector<ValueId>& targets) const {
    std::erase_if(targets, [&](ValueId value) { return !live[value]; });
  }

  void sweep(NodeList& list) {
    std::erase_if(list, [&](const std::unique_ptr<Node>& node) {
      if (node->kind != Kind::kInstr) return node->instr.data[0] != 1;
      const Instr& instr = node->instr;
      if (is_jump(instr) || instr.op == Op::kYield || needed(instr)) return false;
      return instr.result == kNoValue || !live[instr.result];
    });
    for (auto& node : list) {
      if (node->kind == Kind::kIf) sweep_if(*node);
      if (node->kind == Kind::kLoop) sweep_loop(*node);
    }
  }

  void sweep_if(Node& node) {
    node.instr.data[0] = 0;
    for (NodeList* part : {&node.then_list, &node.else_list}) {
      if (Instr* yield = yield_of(*part)) keep(yield->src, node.results);
      sweep(*part);
    }
    keep_targets(node.results);
  }

  void sweep_loop(Node& node) {
    node.instr.data[0] = 0;
    for (NodeList* part : {&node.body, &node.continuing})
      each_jump(*part,
                [&](Instr& jump) { keep(jump.src, jump.op == Op::kBreak ? node.results : node.continue_params); });
    if (Instr* yield = yield_of(node.body)) keep(yield->src, node.continue_params);
    if (Instr* yield = yield_of(node.continuing)) keep(yield->src, node.params);
    keep(node.init, node.params);
    keep_targets(node.params);
    keep_targets(node.continue_params);
    keep_targets(node.results);
    sweep(node.body);
    sweep(node.continuing);
  }
};

/// Drops the slots that no instruction names any more and renumbers the rest.
void compact_slots(NodeList& body, Op op, std::vector<InterfaceSlot>& slots) {
  std::vector<std::uint32_t> number(slots.size(), UINT32_MAX);
  std::vector<InterfaceSlot> kept;
  each_node(body, [&](Node& node) {
    if (node.kind != Kind::kInstr || node.instr.op != op) return;
    number[node.instr.data[0]] = 0;
  });
  for (std::size_t i = 0; i < slots.size(); i++) {
    if (number[i] == UINT32_MAX) continue;
    number[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(slots[i]);
  }
  each_node(body, [&](Node& node) {
    if (node.kind == Kind::kInstr && node.instr.op == op) node.instr.data[0] = number[node.instr.data[0]];
  });
  slots = std::move(kept);
}

}  // namespace

bool has_effect(Op op, const ImageInfo* image) {
  switch (op) {
    case Op::kStoreOutput:
    case Op::kStoreStorage:
    case Op::kAtomicStorage:
    case Op::kStoreGlobal:
    case Op::kAtomicGlobal:
    case Op::kStoreShared:
    case Op::kAtomicShared:
    case Op::kStoreArray:
    case Op::kBarrier:
    case Op::kMemoryBarrier:
    case Op::kDemote:
    case Op::kProbe:
    case Op::kKill:
    case Op::kReturn:
    case Op::kStoreVar:
      return true;
    case Op::kImage:
      return image->access == ImageAccess::kWrite || image->access == ImageAccess::kAtomic;
    default:
      return false;
  }
}

void remove_dead(Function& function, Loads loads) {
  const std::size_t count = function.values.size();
  Marker marker{function,
                std::vector<Definition>(count),
                std::vector<bool>(count, false),
                std::vector<bool>(function.arrays.size(), false),
                std::vector<bool>(count, false),
                {}};
  marker.index(function.body);
  marker.mark(function.body);
  if (loads == Loads::kKeep) marker.keep_loads();
  marker.propagate();
  marker.sweep(function.body);
  compact_slots(function.body, Op::kLoadInput, function.interface.inputs);
  compact_slots(function.body, Op::kStoreOutput, function.interface.outputs);
}

}  // namespace vitrine::spirv::ir
