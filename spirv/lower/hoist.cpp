// Work that does not change from one iteration to the next moves in front of the loop; uniform conditions move into the
// jumps that they decide.
#include <algorithm>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Op;

class Hoister {
 public:
  explicit Hoister(ScalarFunction& function) : f_(function), depth_(function.scalars.size(), 0) {}

  void run() {
    before_.resize(f_.body.size());
    std::vector<std::uint8_t> moved(f_.body.size(), 0);
    bool any = false;
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
      const ScalarOp& op = f_.body[i];
      if (op.dead) continue;
      if (op.kind == Kind::kLoop) loops_.push_back(i);
      if (op.kind == Kind::kEndLoop) loops_.pop_back();
      moved[i] = visit(op, i);
      any |= moved[i] != 0;
    }
    if (any) rebuild(moved);
  }

 private:
  bool is_pure(const ScalarOp& op) const {
    return op.kind == Kind::kAlu ||
           (op.kind == Kind::kIntrinsic && !f_.accesses_stay && (op.op == Op::kLoadUniform || op.op == Op::kLoadPush));
  }

  bool visit(const ScalarOp& op, std::uint32_t i) {
    auto depth = static_cast<std::uint32_t>(loops_.size());
    if (is_pure(op)) {
      std::uint32_t needed = 0;
      for (const ScalarId id : f_.of(op.src)) needed = std::max(needed, depth_[id]);
      if (needed < depth) before_[loops_[needed]].push_back(i);
      depth = needed;
    }
    const bool leaves = op.kind == Kind::kBreak;  // its values are results of the loop: defined outside
    for (const ScalarId id : f_.of(op.dst)) depth_[id] = leaves ? depth - 1 : depth;
    return is_pure(op) && depth < loops_.size();
  }

  void rebuild(const std::vector<std::uint8_t>& moved) {
    std::vector<ScalarOp> body;
    body.reserve(f_.body.size());
    std::vector<std::uint32_t> place(f_.body.size(), kNoIndex);
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
      for (const std::uint32_t early : before_[i]) body.push_back(f_.body[early]);
      if (moved[i] || f_.body[i].dead) continue;
      place[i] = static_cast<std::uint32_t>(body.size());
      body.push_back(f_.body[i]);
    }
    for (ScalarOp& op : body)
      if (op.partner != kNoIndex) op.partner = place[op.partner];
    f_.body = std::move(body);
  }

  ScalarFunction& f_;
  std::vector<std::uint32_t> depth_;                ///< per scalar: loops around its definition
  std::vector<std::uint32_t> loops_;                ///< open ones
  std::vector<std::vector<std::uint32_t>> before_;  ///< per kLoop: operations that move in front of it
};

bool is_integer_test(Op op) {
  switch (op) {
    case Op::kIEq:
    case Op::kINe:
    case Op::kILt:
    case Op::kIGe:
    case Op::kULt:
    case Op::kUGe:
      return true;
    default:
      return false;
  }
}

class TestFuser {
 public:
  explicit TestFuser(ScalarFunction& function) : f_(function), definition_(function.scalars.size(), kNoIndex) {}

  void run() {
    for (std::uint32_t i = 0; i < f_.body.size(); ++i)
      if (!f_.body[i].dead && f_.body[i].kind == Kind::kAlu) definition_[f_.operands[f_.body[i].dst.begin]] = i;
    for (ScalarOp& op : f_.body)
      if (!op.dead && op.cond != kNoScalar && f_.scalars[op.cond].level != Level::kVarying) fuse(op);
  }

 private:
  void fuse(ScalarOp& op) {
    while (const ScalarOp* negation = definition_of(op.cond, Op::kNotB)) {
      op.cond = f_.operands[negation->src.begin];
      op.negated = !op.negated;
    }
    if (definition_[op.cond] == kNoIndex) return;
    const ScalarOp& test = f_.body[definition_[op.cond]];
    if (!is_integer_test(test.op)) return;
    op.test = test.op;
    op.test_sources = test.src;
  }

  const ScalarOp* definition_of(ScalarId id, Op wanted) const {
    if (definition_[id] == kNoIndex || f_.body[definition_[id]].op != wanted) return nullptr;
    return &f_.body[definition_[id]];
  }

  ScalarFunction& f_;
  std::vector<std::uint32_t> definition_;
};

}  // namespace

void hoist_invariants(ScalarFunction& function) { Hoister(function).run(); }
void fuse_tests(ScalarFunction& function) { TestFuser(function).run(); }

}  // namespace vitrine::spirv::lowering
