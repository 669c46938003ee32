// Control flow of the body as masks and jumps. A condition that all active lanes share is a plain jump.
#include "spirv/lower/emitter.h"

namespace vitrine::spirv::lowering {
namespace {

class BodyEmitter {
 public:
  BodyEmitter(const ScalarFunction& function, const Allocation& allocation, Emitter& emitter)
      : f_(function), slots_(allocation.slots), out_(emitter), end_(emitter.new_label()) {}

  void run() {
    has_continue_.assign(f_.body.size(), 0);
    for (const ScalarOp& op : f_.body)
      if (op.kind == Kind::kContinue) has_continue_[op.partner] = 1;
    if (out_.program->array_bytes != 0) out_.append(exec::clear_arrays, "clear_arrays", nullptr);
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) emit(i);
    out_.bind(end_);
    out_.append(exec::end_program, "end", nullptr);
  }

 private:
  struct Open {
    const ScalarOp* op;
    std::uint32_t index;
    bool is_loop;
    bool second = false;   ///< in the else-branch / in the continuing part
    bool jumps = false;    ///< lanes leave it by a jump to further out
    bool returns = false;  ///< lanes end inside
    Label middle = 0;      ///< else / continue target
    Label end = 0;         ///< behind the construct; loops: the back edge
    Label top = 0, exit = 0;
  };

  bool varying(ScalarId id) const { return f_.scalars[id].level == Level::kVarying; }
  Place mask_slot(std::uint32_t op, int which) const { return {'m', slots_[op].slot[which] * 8}; }

  /// Where the next lanes wait when none is active.
  Label next_join() const {
    if (open_.empty()) return end_;
    const Open& open = open_.back();
    if (!open.is_loop) return open.op->masked && !open.second ? open.middle : open.end;
    if (!open.op->masked) return open.exit;
    return open.second ? open.end : open.middle;
  }

  void emit(std::uint32_t i) {
    const ScalarOp& op = f_.body[i];
    if (op.instr != nullptr && op.instr->origin.place != 0) out_.near = op.instr->origin.place;
    switch (op.kind) {
      case Kind::kAlu:
        return out_.alu(op);
      case Kind::kIntrinsic:
        return emit_intrinsic(op);
      case Kind::kMove:
      case Kind::kMaskedMove:
        return out_.moves({{out_.result(op, 0), out_.source(op, 0), op.kind == Kind::kMaskedMove}}, op.instr);
      case Kind::kIf:
        return emit_if(op, i);
      case Kind::kElse:
        return emit_else(op, i);
      case Kind::kEndIf:
        return emit_endif(op, i);
      case Kind::kLoop:
        return emit_loop(op, i);
      case Kind::kContinuing:
        return emit_continuing(op);
      case Kind::kEndLoop:
        return emit_end_loop(op);
      case Kind::kTurn:
        return;
      case Kind::kBreak:
      case Kind::kContinue:
        return emit_leave(op, i);
      case Kind::kReturn:
        return emit_return(op);
      case Kind::kKill:
        return emit_kill(op);
    }
  }

  void emit_intrinsic(const ScalarOp& op) {
    if (op.op == ir::Op::kDemote) {
      out_.append(exec::demote_all, "demote", op.instr);
    } else if (!out_.intrinsic(op)) {
      out_.fail("intrinsic without a handler");
    }
  }

  void move_all(const ScalarOp& op, bool masked) {
    std::vector<Emitter::Move> moves;
    for (std::uint32_t k = 0; k < op.src.count; ++k) moves.push_back({out_.result(op, k), out_.source(op, k), masked});
    out_.moves(moves, op.instr);
  }

  // ---- if

  void emit_if(const ScalarOp& op, std::uint32_t i) {
    Open open{&op, i, false};
    open.middle = out_.new_label();
    open.end = out_.new_label();
    if (op.masked) {
      out_.append_jump(exec::if_mask, "if", open.middle, mask_slot(i, 0), out_.in_register(op.cond));
    } else {
      out_.append_jump_unless(op, "if.uniform", open.middle);
    }
    open_.push_back(open);
  }

  void emit_else(const ScalarOp& op, std::uint32_t) {
    Open& open = open_.back();
    const ScalarOp& end_if = f_.body[op.partner];
    std::vector<Emitter::Move> moves;
    for (std::uint32_t k = 0; k < op.src.count; ++k) {
      const ScalarId to = out_.result(op, k);
      // The result's register already holds the value of the other lanes when the two were merged.
      const bool kept = open.op->masked && out_.same_place(to, out_.source(end_if, k));
      const bool boolean = f_.scalars[to].boolean;
      moves.push_back({to, out_.source(op, k), kept && !boolean});
    }
    out_.moves(moves, nullptr);
    if (open.op->masked) {
      out_.bind(open.middle);
      out_.append_jump(exec::else_mask, "else", open.end, mask_slot(open.index, 0));
    } else {
      if (op.falls) out_.append_jump(exec::jump, "jump", open.end);
      out_.bind(open.middle);
    }
    open.second = true;
  }

  void emit_endif(const ScalarOp& op, std::uint32_t) {
    const Open open = open_.back();
    move_all(op, open.op->masked);
    out_.bind(open.end);
    if (open.op->masked) out_.append(exec::endif_mask, "endif", nullptr, {}, mask_slot(open.index, 0));
    close(open);
  }

  /// After a construct that lanes left for good, nothing may be active.
  void close(const Open& open) {
    open_.pop_back();
    const bool leaves = open.is_loop ? open.returns : open.jumps || open.returns;
    if (!leaves) return;
    out_.append_jump(exec::skip_if_empty, "skip_if_empty", next_join());
    if (open_.empty()) return;
    open_.back().jumps |= !open.is_loop && open.jumps;
    open_.back().returns |= open.returns;
  }

  // ---- loops

  void emit_loop(const ScalarOp& op, std::uint32_t i) {
    Open open{&op, i, true};
    open.middle = out_.new_label();
    open.end = out_.new_label();
    open.top = out_.new_label();
    open.exit = out_.new_label();
    move_all(op, false);
    if (op.masked) {
      out_.append(exec::clear_mask, "clear", nullptr, mask_slot(i, 0));
      if (has_continue_[i]) out_.append(exec::clear_mask, "clear", nullptr, mask_slot(i, 1));
    }
    out_.bind(open.top);
    open_.push_back(open);
  }

  void emit_continuing(const ScalarOp& op) {
    Open& open = open_.back();
    move_all(op, open.op->masked);
    out_.bind(open.middle);
    if (open.op->masked && has_continue_[open.index])
      out_.append_jump(exec::rejoin, "rejoin", open.end, mask_slot(open.index, 1));
    open.second = true;
  }

  void emit_end_loop(const ScalarOp& op) {
    const Open open = open_.back();
    move_all(op, false);
    out_.bind(open.end);
    if (open.op->masked) {
      out_.append_jump(exec::loop_back_mask, "loop", open.top, {}, mask_slot(open.index, 0));
    } else if (op.falls) {
      out_.append_jump(exec::loop_back, "loop.uniform", open.top);
    }
    out_.bind(open.exit);
    close(open);
  }

  Open& innermost_loop() {
    std::size_t i = open_.size() - 1;
    while (!open_[i].is_loop) --i;
    return open_[i];
  }

  void mark_jumps() {
    for (std::size_t i = open_.size(); i-- > 0 && !open_[i].is_loop;) open_[i].jumps = true;
  }

  void emit_leave(const ScalarOp& op, std::uint32_t i) {
    const Open loop = innermost_loop();
    const bool is_break = op.kind == Kind::kBreak;
    const Label after = out_.new_label();
    const bool uniform = op.cond != kNoScalar && !varying(op.cond);
    if (!loop.op->masked) {
      const Label to = is_break ? loop.exit : loop.middle;
      if (uniform) out_.append_jump_unless(op, "unless", after);
      move_all(op, false);
      out_.append_jump(exec::jump, is_break ? "break.uniform" : "continue.uniform", to);
      out_.bind(after);
      return;
    }
    mark_jumps();
    const Place waiting = mask_slot(loop.index, is_break ? 0 : 1);
    if (uniform || op.cond == kNoScalar) {
      if (uniform) out_.append_jump_unless(op, "unless", after);
      move_all(op, true);
      out_.append_jump(exec::leave_all, is_break ? "break" : "continue", next_join(), waiting);
    } else if (op.dst.count == 0) {
      out_.append_jump(exec::leave_if, is_break ? "break_if" : "continue_if", next_join(), waiting,
                       out_.in_register(op.cond));
    } else {
      out_.append_jump(exec::leave_begin, "leave_begin", after, mask_slot(i, 0), out_.in_register(op.cond));
      move_all(op, true);
      out_.append_jump(exec::leave_end, is_break ? "break_if" : "continue_if", next_join(), waiting, mask_slot(i, 0));
    }
    out_.bind(after);
  }

  // ---- ends of invocations

  void mark_returns() {
    for (Open& open : open_) open.returns = true;
  }

  void emit_return(const ScalarOp& op) {
    if (open_.empty() && op.cond == kNoScalar) {
      if (&op != &f_.body.back()) out_.append_jump(exec::jump, "return", end_);
      return;
    }
    mark_returns();
    if (op.cond != kNoScalar && varying(op.cond)) {
      out_.append_jump(exec::return_if, "return_if", next_join(), {}, out_.in_register(op.cond));
      return;
    }
    const Label after = out_.new_label();
    if (op.cond != kNoScalar) out_.append_jump_unless(op, "unless", after);
    out_.append_jump(exec::return_all, "return", next_join());
    out_.bind(after);
  }

  /// Killed lanes go on as helpers (lavapipe-shader-math.md section 9), so that derivatives behind the discard have
  /// their neighbours; inside a loop they end, because nothing else may make them leave it. They end, too, where a
  /// terminated invocation must not pass for a helper.
  void emit_kill(const ScalarOp& op) {
    bool ends = op.instr != nullptr && op.instr->data[0] != 0;
    for (const Open& open : open_) ends |= open.is_loop;
    const Label after = out_.new_label();
    if (op.cond != kNoScalar && varying(op.cond)) {
      out_.append(exec::demote_if, "discard_if", op.instr, {}, out_.in_register(op.cond));
    } else {
      if (op.cond != kNoScalar) out_.append_jump_unless(op, "unless", after);
      out_.append(exec::demote_all, "discard", op.instr);
      // Uniformly dead: with every lane of the wave a helper, the handler has ended the wave.
    }
    if (ends) {
      ScalarOp end = op;
      end.kind = Kind::kReturn;
      if (op.cond != kNoScalar && !varying(op.cond)) end.cond = kNoScalar;
      emit_return(end);
    }
    out_.bind(after);
  }

  const ScalarFunction& f_;
  const std::vector<ControlSlots>& slots_;
  Emitter& out_;
  Label end_;
  std::vector<Open> open_;
  std::vector<std::uint8_t> has_continue_;  ///< per kLoop
};

}  // namespace

std::unique_ptr<Program> emit(const ScalarFunction& function, const Allocation& allocation, ShaderInterface& interface,
                              std::string& error) {
  Emitter emitter(function, allocation, error);
  emitter.in_preamble = true;
  for (const ScalarOp& op : function.preamble) {
    if (op.dead) continue;
    if (op.kind == Kind::kAlu) {
      emitter.alu(op);
    } else if (!emitter.intrinsic(op)) {
      emitter.fail("intrinsic without a handler in the preamble");
    }
  }
  emitter.append(exec::end_program, "end", nullptr);
  emitter.in_preamble = false;
  BodyEmitter(function, allocation, emitter).run();
  return emitter.finish(interface);
}

}  // namespace vitrine::spirv::lowering
