// See alike.h.
#include "spirv/lower/alike.h"

#include <algorithm>
#include <unordered_map>

#include "spirv/ir_walk.h"
#include "spirv/memory_order.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Instr;
using ir::Node;
using ir::Op;
using ir::Src;

constexpr std::uint16_t kOpMemoryBarrier = 225;

/// What a value depends on, beside the invocation's place in its workgroup.
enum class Level : std::uint8_t {
  kNothing,
  kCommand,  ///< what the command gives all workgroups, if nothing of it writes that
  kGroup,    ///< anything
};

bool is_shared(Op op) { return op == Op::kLoadShared || op == Op::kStoreShared || op == Op::kAtomicShared; }
bool is_atomic(Op op) { return op == Op::kAtomicShared || op == Op::kAtomicStorage || op == Op::kAtomicGlobal; }
bool loads_given(Op op) { return op == Op::kLoadUniform || op == Op::kLoadStorage || op == Op::kLoadGlobal; }

/// Optimistic fixpoint: everything starts as kNothing and only ever grows.
class Alike {
 public:
  explicit Alike(const ir::Function& function)
      : f_(function), values_(function.values.size()), arrays_(function.arrays.size()) {}

  /// What accesses to shared memory, and barriers, depend on.
  Level run() {
    do {
      changed_ = false;
      ended_ = Level::kNothing;
      walk(f_.body, Level::kNothing);
    } while (changed_ && needed_ != Level::kGroup);
    return fences_ && atomics_ ? Level::kGroup : needed_;
  }
  Level operator[](ir::ValueId id) const { return values_[id]; }

 private:
  Level of(const Src& src) const { return values_[src.value]; }
  Level of(const std::vector<Src>& sources) const {
    Level level = Level::kNothing;
    for (const Src& src : sources) level = std::max(level, of(src));
    return level;
  }
  void raise(Level& level, Level to) {
    if (level >= to) return;
    level = to;
    changed_ = true;
  }
  void raise_each(const std::vector<ir::ValueId>& to, const std::vector<Src>& from, Level control) {
    for (std::size_t i = 0; i < to.size() && i < from.size(); ++i)
      raise(values_[to[i]], std::max(of(from[i]), control));
  }
  void raise_yielded(const std::vector<ir::ValueId>& to, const ir::NodeList& list, Level control) {
    if (list.empty() || list.back()->kind != Node::Kind::kInstr || list.back()->instr.op != Op::kYield) return;
    raise_each(to, list.back()->instr.src, control);
  }

  void walk(const ir::NodeList& list, Level control) {
    for (const auto& node : list) {
      const Level here = std::max(control, ended_);
      switch (node->kind) {
        case Node::Kind::kInstr:
          visit(node->instr, here);
          break;
        case Node::Kind::kIf: {
          const Level inside = std::max(here, of(node->condition));
          walk(node->then_list, inside);
          walk(node->else_list, inside);
          raise_yielded(node->results, node->then_list, inside);
          raise_yielded(node->results, node->else_list, inside);
          break;
        }
        case Node::Kind::kLoop:
          walk_loop(*node, here);
          break;
      }
    }
  }

  void walk_loop(const Node& node, Level control) {
    const Level inside = std::max(control, left_[&node]);
    loops_.push_back(&node);
    raise_each(node.params, node.init, inside);
    walk(node.body, inside);
    raise_yielded(node.continue_params, node.body, inside);
    walk(node.continuing, inside);
    raise_yielded(node.params, node.continuing, inside);
    loops_.pop_back();
  }

  void jump(const Instr& instr, Level control) {
    const Node& loop = *loops_.back();
    raise(left_[&loop], control);
    raise_each(instr.op == Op::kBreak ? loop.results : loop.continue_params, instr.src, left_[&loop]);
  }

  /// Some invocations end: others come alone to what is behind, and to further turns of the loops around.
  void end(Level control) {
    ended_ = std::max(ended_, control);
    for (const Node* loop : loops_) raise(left_[loop], control);
  }

  void visit(const Instr& instr, Level control) {
    if (instr.op == Op::kBreak || instr.op == Op::kContinue) return jump(instr, control);
    if (instr.op == Op::kReturn || instr.op == Op::kKill || instr.op == Op::kDemote) return end(control);
    if (instr.op == Op::kProbe) return visit_probe(instr, control);
    if (instr.op == Op::kBarrier) raise(needed_, control);
    if (is_shared(instr.op)) raise(needed_, std::max(control, of(instr.src[0])));
    if (is_atomic(instr.op)) {
      const MemoryOrder order = MemoryOrder::of(instr.origin.order);
      atomics_ = true;
      fences_ |= order.acquires() || order.releases();
    }
    if (instr.op == Op::kStoreArray) {
      const Level level = std::max(control, of(instr.src));
      return raise(arrays_[instr.data[0]], level);
    }
    if (instr.result != ir::kNoValue) raise(values_[instr.result], level_of(instr));
  }

  void visit_probe(const Instr& instr, Level control) {
    const Probe& probe = f_.probes[instr.data[0]];
    if (probe.kind != Probe::Kind::kOrder) return;
    fences_ |= probe.opcode == kOpMemoryBarrier;
    raise(needed_, std::max(control, of(instr.src)));
  }

  Level level_of(const Instr& instr) const {
    const Level sources = of(instr.src);
    if (instr.op < Op::kAluCount || ir::is_wide(instr.op)) return sources;
    switch (instr.op) {
      case Op::kConst:
      case Op::kUndef:  // zeros
      case Op::kVec:
      case Op::kLocalInvocationId:
      case Op::kLocalInvocationIndex:
      case Op::kSubgroupInvocation:
      case Op::kSubgroupId:
      case Op::kElect:
      case Op::kReadFirst:
      case Op::kBallot:
      case Op::kShuffle:
      case Op::kReduce:
        return sources;
      case Op::kLoadArray:
        return std::max(sources, arrays_[instr.data[0]]);
      case Op::kNumWorkgroups:
      case Op::kLoadPush:
      case Op::kArrayLength:
      case Op::kLoadUniform:
      case Op::kLoadStorage:
      case Op::kLoadGlobal:
        return std::max(sources, Level::kCommand);
      default:
        return Level::kGroup;
    }
  }

  const ir::Function& f_;
  std::vector<Level> values_, arrays_;
  std::unordered_map<const Node*, Level> left_;  ///< what jumps inside of a loop depend on
  std::vector<const Node*> loops_;               ///< around what is visited
  Level needed_ = Level::kNothing;
  Level ended_ = Level::kNothing;  ///< what those ends of invocations depend on that have been visited
  bool changed_ = false, fences_ = false, atomics_ = false;
};

void add(ir::Origin& origin, MemoryOrder order) {
  MemoryOrder known = MemoryOrder::of(origin.order);
  known.alike |= order.alike;
  known.given |= order.given;
  origin.order = known.word();
}

}  // namespace

void mark_alike(ir::Function& function) {
  bool shared = false;
  ir::each_node(function.body,
                [&](Node& node) { shared |= node.kind == Node::Kind::kInstr && is_shared(node.instr.op); });
  if (!shared || function.interface.stage != VK_SHADER_STAGE_COMPUTE_BIT) return;
  Alike alike(function);
  const Level level = alike.run();
  if (level == Level::kGroup) return;
  ir::each_node(function.body, [&](Node& node) {
    if (node.kind != Node::Kind::kInstr) return;
    Instr& instr = node.instr;
    const bool given = level == Level::kCommand;
    if (is_shared(instr.op)) add(instr.origin, {.alike = true, .given = given});
    if (given && loads_given(instr.op) && alike[instr.result] == Level::kCommand) add(instr.origin, {.given = true});
  });
}

}  // namespace vitrine::spirv::lowering
