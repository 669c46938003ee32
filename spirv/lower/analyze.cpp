// Dead code and wave-uniformity of a ScalarFunction.
#include "spirv/ir_walk.h"
#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Op;

bool has_effect(const ScalarOp& op) {
  if (op.kind == Kind::kAlu || op.kind == Kind::kMove) return false;
  if (op.kind != Kind::kIntrinsic) return true;
  return ir::has_effect(op.op, op.instr->image.get());
}

bool is_control(const ScalarOp& op) {
  return op.kind != Kind::kAlu && op.kind != Kind::kIntrinsic && op.kind != Kind::kMove && op.kind != Kind::kMaskedMove;
}

class Liveness {
 public:
  explicit Liveness(ScalarFunction& function) : f_(function), needed_(function.scalars.size(), 0) {
    definition_.assign(f_.scalars.size(), nullptr);
    record(f_.preamble);
    record(f_.body);
  }

  void run() {
    for (ScalarOp& op : f_.body) {
      if (op.dead) continue;
      if (op.reads_condition()) need(op.cond);
      for (const ScalarId id : f_.of(op.test_sources)) need(id);
      if (!is_control(op) && has_effect(op)) need_sources(op);
    }
    while (!work_.empty()) {
      const ScalarId id = work_.back();
      work_.pop_back();
      if (definition_[id]) need_sources(*definition_[id]);
      for (const ScalarId source : f_.join_sources[id]) need(source);
    }
    remove(f_.preamble);
    remove(f_.body);
  }

 private:
  void record(std::vector<ScalarOp>& list) {
    for (ScalarOp& op : list)
      if (!is_control(op) && !op.dead)
        for (const ScalarId id : f_.of(op.dst)) definition_[id] = &op;
  }
  void need(ScalarId id) {
    if (needed_[id]) return;
    needed_[id] = 1;
    work_.push_back(id);
  }
  void need_sources(const ScalarOp& op) {
    for (const ScalarId id : f_.of(op.src)) need(id);
  }

  void remove(std::vector<ScalarOp>& list) {
    for (ScalarOp& op : list) {
      if (is_control(op)) {
        remove_joins(op);
      } else if (!has_effect(op)) {
        bool used = false;
        for (const ScalarId id : f_.of(op.dst)) used |= needed_[id] != 0;
        op.dead |= !used;
      }
    }
  }

  void remove_joins(ScalarOp& op) {
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < op.dst.count; ++i) {
      if (!needed_[f_.operands[op.dst.begin + i]]) continue;
      f_.operands[op.dst.begin + kept] = f_.operands[op.dst.begin + i];
      f_.operands[op.src.begin + kept] = f_.operands[op.src.begin + i];
      ++kept;
    }
    op.dst.count = kept;
    if (op.src.count != 0) op.src.count = kept;
  }

  ScalarFunction& f_;
  std::vector<std::uint8_t> needed_;
  std::vector<ScalarOp*> definition_;
  std::vector<ScalarId> work_;
};

/// Optimistic fixpoint: everything starts wave-uniform and only ever becomes varying.
class Uniformity {
 public:
  explicit Uniformity(ScalarFunction& function) : f_(function) {}

  void run() {
    for (Scalar& scalar : f_.scalars)
      if (scalar.level == Level::kVarying && scalar.input == kNoIndex) scalar.level = Level::kWave;
    do {
      changed_ = false;
      divergent_ = 0;
      for (ScalarOp& op : f_.body)
        if (!op.dead) visit(op);
    } while (changed_);
  }

 private:
  struct Construct {
    ScalarOp* op;
    std::uint32_t outer_divergence;
  };

  bool varying(ScalarId id) const { return f_.scalars[id].level == Level::kVarying; }
  void vary(Range range) {
    for (const ScalarId id : f_.of(range)) {
      if (varying(id)) continue;
      f_.scalars[id].level = Level::kVarying;
      changed_ = true;
    }
  }
  void join(const ScalarOp& op, bool separate) {
    for (std::uint32_t i = 0; i < op.dst.count && i < op.src.count; ++i) {
      const ScalarId to = f_.operands[op.dst.begin + i];
      // A boolean word would need a mask companion at every join: joins of booleans are masks always.
      if (!separate && !varying(f_.operands[op.src.begin + i]) && !f_.scalars[to].boolean) continue;
      vary({op.dst.begin + i, 1});
    }
  }
  void set_masked(ScalarOp& op) {
    if (op.masked) return;
    op.masked = true;
    changed_ = true;
  }

  void visit(ScalarOp& op) {
    switch (op.kind) {
      case Kind::kAlu:
        for (const ScalarId id : f_.of(op.src))
          if (varying(id)) vary(op.dst);
        break;
      case Kind::kMove:
      case Kind::kMaskedMove:
        vary(op.dst);
        break;
      case Kind::kIntrinsic:
        if (intrinsic_varies(op)) vary(op.dst);
        break;
      case Kind::kIf:
        if (varying(op.cond)) set_masked(op);
        constructs_.push_back({&op, divergent_});
        if (op.masked) ++divergent_;
        break;
      case Kind::kElse:
        join(op, constructs_.back().op->masked);
        break;
      case Kind::kEndIf:
        join(op, constructs_.back().op->masked);
        divergent_ = constructs_.back().outer_divergence;
        constructs_.pop_back();
        break;
      case Kind::kLoop:
        join(op, false);
        constructs_.push_back({&op, divergent_});
        divergent_ = 0;  // counted from the innermost loop
        break;
      case Kind::kContinuing:
        join(op, constructs_.back().op->masked);
        break;
      case Kind::kEndLoop:
        join(op, false);
        divergent_ = constructs_.back().outer_divergence;
        constructs_.pop_back();
        break;
      case Kind::kBreak:
      case Kind::kContinue: {
        ScalarOp& loop = f_.body[op.partner];
        if (divergent_ != 0 || (op.cond != kNoScalar && varying(op.cond))) set_masked(loop);
        join(op, loop.masked);
        break;
      }
      case Kind::kTurn:
      case Kind::kReturn:
      case Kind::kKill:
        break;
    }
  }

  bool any_source_varies(const ScalarOp& op) const {
    for (const ScalarId id : f_.of(op.src))
      if (varying(id)) return true;
    return false;
  }

  bool intrinsic_varies(const ScalarOp& op) const {
    if (ir::is_wide(op.op)) return any_source_varies(op);
    switch (op.op) {
      case Op::kLoadArray:
        return f_.ir->arrays[op.instr->data[0]].table.empty() || any_source_varies(op);
      case Op::kWorkgroupId:
      case Op::kNumWorkgroups:
      case Op::kSubgroupId:
      case Op::kReadFirst:
      case Op::kReadClock:
        return false;
      case Op::kBallot:
        return op.instr->data[0] != base::kWaveWidth;
      case Op::kReduce:
        return op.src.count > 1 || op.instr->data[0] != base::kWaveWidth ||
               op.instr->data[2] != static_cast<std::uint32_t>(ir::GroupMode::kReduce);
      case Op::kLoadPush:
      case Op::kLoadUniform:
      case Op::kLoadStorage:
      case Op::kLoadShared:
      case Op::kArrayLength:
        return any_source_varies(op);
      default:
        return true;
    }
  }

  ScalarFunction& f_;
  bool changed_ = false;
  std::uint32_t divergent_ = 0;  ///< divergent Ifs around the current operation, inside the innermost loop
  std::vector<Construct> constructs_;
};

}  // namespace

void remove_dead(ScalarFunction& function) { Liveness(function).run(); }
void find_wave_uniform(ScalarFunction& function) { Uniformity(function).run(); }

}  // namespace vitrine::spirv::lowering
