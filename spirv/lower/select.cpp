// Instruction selection on scalar operations: outputs, and operands that need a register or a mask.
#include <algorithm>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Op;

/// Registers that may hold broadcast constants for the whole draw; more would push the live set out of the L1 cache.
constexpr std::size_t kMaxPresets = 12;

/// How an output slot is stored.
struct OutputStores {
  std::uint32_t count = 0;
  bool conditional = false;  ///< some lanes may miss a store
};

class Selector {
 public:
  explicit Selector(ScalarFunction& function) : f_(function) {}

  void run() {
    f_.outputs.assign(f_.ir->interface.outputs.size(), kNoScalar);
    survey_outputs();
    std::vector<ScalarOp> old;
    old.swap(f_.body);
    f_.body.reserve(old.size() + old.size() / 4);
    std::vector<std::uint32_t> moved(old.size(), kNoIndex);
    zero_outputs();
    for (std::size_t i = 0; i < old.size(); ++i) {
      if (old[i].dead) continue;
      select(old[i]);
      moved[i] = last_;
    }
    for (ScalarOp& op : f_.body)
      if (op.partner != kNoIndex) op.partner = moved[op.partner];
  }

 private:
  Level level(ScalarId id) const { return f_.scalars[id].level; }

  void survey_outputs() {
    stores_.assign(f_.outputs.size(), {});
    std::uint32_t depth = 0;
    bool returned = false;
    for (const ScalarOp& op : f_.body) {
      if (op.dead) continue;
      if (op.kind == Kind::kIf || op.kind == Kind::kLoop) ++depth;
      if (op.kind == Kind::kEndIf || op.kind == Kind::kEndLoop) --depth;
      if (op.kind == Kind::kReturn) returned = true;
      if (op.kind != Kind::kIntrinsic || op.op != Op::kStoreOutput) continue;
      OutputStores& stores = stores_[op.instr->data[0]];
      ++stores.count;
      stores.conditional |= depth != 0 || returned;
    }
  }

  /// Uninitialised outputs read as 0 (lavapipe-shader-math.md section 10).
  void zero_outputs() {
    for (std::size_t i = 0; i < stores_.size(); ++i) {
      if (stores_[i].count == 0 || (stores_[i].count == 1 && !stores_[i].conditional)) continue;
      f_.outputs[i] = new_varying(false);
      if (stores_[i].conditional) push_move(Kind::kMove, f_.outputs[i], zero(), nullptr);
    }
  }

  ScalarId zero() {
    for (ScalarId id = 0; id < f_.scalars.size(); ++id)
      if (level(id) == Level::kConstant && !f_.scalars[id].boolean && f_.scalars[id].bits == 0) return id;
    return f_.add(false, Level::kConstant);
  }

  ScalarId new_varying(bool boolean) { return f_.add(boolean, Level::kVarying); }

  void push(const ScalarOp& op) {
    last_ = static_cast<std::uint32_t>(f_.body.size());
    f_.body.push_back(op);
  }

  void push_move(Kind kind, ScalarId to, ScalarId from, const ir::Instr* instr) {
    ScalarOp op;
    op.kind = kind;
    op.instr = instr;
    op.src = f_.add_operands(std::span(&from, 1));
    op.dst = f_.add_operands(std::span(&to, 1));
    push(op);
  }

  /// `id` as something a handler finds in the varying file (or mask file, for booleans).
  ScalarId in_register(ScalarId id, const ir::Instr* instr) {
    if (level(id) == Level::kVarying) return id;
    const bool boolean = f_.scalars[id].boolean;
    if (level(id) <= Level::kUniform) {
      if (boolean) return id;  // a mask preset, made by the emission
      if (std::find(f_.preset.begin(), f_.preset.end(), id) != f_.preset.end()) return id;
      if (f_.preset.size() < kMaxPresets) {
        f_.preset.push_back(id);
        return id;
      }
    }
    const ScalarId copy = new_varying(boolean);
    push_move(Kind::kMove, copy, id, instr);
    return copy;
  }

  void select(ScalarOp op) {
    switch (op.kind) {
      case Kind::kAlu:
        select_alu(op);
        break;
      case Kind::kIntrinsic:
        select_intrinsic(op);
        break;
      default:
        push(op);
        break;
    }
  }

  void select_alu(ScalarOp op) {
    if (level(f_.operands[op.dst.begin]) == Level::kVarying) {
      for (std::uint32_t i = 0; i < op.src.count; ++i) {
        const ScalarId id = f_.operands[op.src.begin + i];
        if (!f_.scalars[id].boolean) continue;
        const ScalarId mask = in_register(id, op.instr);
        f_.operands[op.src.begin + i] = mask;
      }
    }
    push(op);
  }

  void select_intrinsic(ScalarOp op) {
    std::uint32_t first = 0;  // sources from here on must be registers
    switch (op.op) {
      case Op::kStoreOutput:
        return select_output(op);
      case Op::kStoreStorage:
      case Op::kAtomicStorage:
        first = 2;
        break;
      case Op::kStoreShared:
      case Op::kAtomicShared:
      case Op::kStoreArray:
        first = 1;
        break;
      case Op::kLoadGlobal:
      case Op::kStoreGlobal:
      case Op::kAtomicGlobal:
      case Op::kBallot:
      case Op::kShuffle:
      case Op::kReduce:
        break;
      case Op::kImage:
        first = (op.instr->image->operands & 1) + (op.instr->image->operands >> 1 & 1);
        break;
      default:
        return push(op);
    }
    for (std::uint32_t i = first; i < op.src.count; ++i) {
      const ScalarId id = in_register(f_.operands[op.src.begin + i], op.instr);
      f_.operands[op.src.begin + i] = id;
    }
    push(op);
  }

  void select_output(const ScalarOp& op) {
    const std::uint32_t slot = op.instr->data[0];
    const ScalarId value = f_.operands[op.src.begin];
    if (f_.outputs[slot] != kNoScalar) {
      push_move(stores_[slot].conditional ? Kind::kMaskedMove : Kind::kMove, f_.outputs[slot], value, op.instr);
      return;
    }
    if (level(value) <= Level::kUniform) {  // any number of these: they cost nothing per wave
      if (std::find(f_.preset.begin(), f_.preset.end(), value) == f_.preset.end()) f_.preset.push_back(value);
      f_.outputs[slot] = value;
    } else {
      f_.outputs[slot] = in_register(value, op.instr);
    }
  }

  ScalarFunction& f_;
  std::vector<OutputStores> stores_;
  std::uint32_t last_ = 0;
};

}  // namespace

void select_operations(ScalarFunction& function) { Selector(function).run(); }

}  // namespace vitrine::spirv::lowering
