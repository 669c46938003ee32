// What the parts of the emission share: operands, appending instructions, labels.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spirv/exec/handlers.h"
#include "spirv/lower/emit.h"

namespace vitrine::spirv::lowering {

/// An operand of an instruction: file 'r' varying, 'u' uniform, 'm' mask, ' ' none.
struct Place {
  char file = ' ';
  std::uint32_t offset = kNoOperand;
};

using Label = std::uint32_t;

class Emitter {
 public:
  Emitter(const ScalarFunction& function, const Allocation& allocation, std::string& error);

  // ---- operands

  const ScalarFunction& function() const { return f_; }
  Level level(ScalarId id) const { return f_.scalars[id].level; }
  ScalarId source(const ScalarOp& op, std::uint32_t i) const { return f_.operands[op.src.begin + i]; }
  ScalarId result(const ScalarOp& op, std::uint32_t i) const { return f_.operands[op.dst.begin + i]; }

  /// Register or mask of a varying value, word of any other.
  Place place(ScalarId id);
  /// Register (preset if not varying) or mask (preset likewise).
  Place in_register(ScalarId id);
  bool same_place(ScalarId a, ScalarId b);

  // ---- instructions

  Instruction& append(Handler handler, const char* name, const ir::Instr* instr, Place dst = {}, Place a = {},
                      Place b = {}, Place c = {});
  Label new_label();
  void bind(Label label);
  void append_jump(Handler handler, const char* name, Label to, Place dst = {}, Place a = {}, Place b = {});

  /// Jumps to `to` if the shared condition of `op` does not hold.
  void append_jump_unless(const ScalarOp& op, const char* name, Label to);

  void alu(const ScalarOp& op);
  /// Memory, images, environment; false if `op` is none of these.
  bool intrinsic(const ScalarOp& op);
  /// Parallel moves `to[k] = from[k]`; `masked[k]`: active lanes only.
  struct Move {
    ScalarId to, from;
    bool masked;
  };
  void moves(const std::vector<Move>& moves, const ir::Instr* instr);

  void fail(const char* what) {
    if (error_.empty()) error_ = what;
  }

  std::unique_ptr<Program> program = std::make_unique<Program>();
  bool in_preamble = false;
  std::uint32_t near = 0;  ///< place that instructions without one of their own are told to have: jumps, moves

  /// Patches jumps, fills the interface.
  std::unique_ptr<Program> finish(ShaderInterface& interface);

 private:
  void assign_words();
  void assign_word(ScalarId id);
  void share_counter_words();
  void clear_registers(const ShaderInterface& interface);
  void one_move(Place to, Place from, bool masked, const ir::Instr* instr);
  Place temporary(char file);
  Place word(ScalarId id) const { return {'u', words_[id] * 4}; }

  /// Adds a side table row for the instruction appended last.
  void attach(const ScalarOp& op, const MemoryOp& row, char data = 'r', bool loads = false);
  void attach(const ImageOp& row);
  void memory(const ScalarOp& op, MemoryOp row, std::uint32_t address, Handler wave, Handler uniform, const char* name);
  /// Moves, and selections that control flow became, have the place of what is near unless they have their own.
  void settle_note() {
    if (std::uint32_t& place = note().origin.place; place == 0) place = near;
  }
  InstructionNote& note() { return (in_preamble ? program->preamble_notes : program->notes).back(); }
  void load(const ScalarOp& op);
  void store(const ScalarOp& op);
  void atomic(const ScalarOp& op);
  void global(const ScalarOp& op);
  void atomic_wide(const ScalarOp& op, MemoryOp row, std::uint32_t address);
  void local_array(const ScalarOp& op);
  void image(const ScalarOp& op);
  void environment(const ScalarOp& op);
  void probe(const ScalarOp& op);
  void read_first(const ScalarOp& op);
  void wide(const ScalarOp& op);
  void group(const ScalarOp& op);
  MemoryOp buffer_row(const ScalarOp& op, bool indexed);
  IndexOperand index_operand(ScalarId id, std::uint32_t& slot, std::uint32_t count);

  const ScalarFunction& f_;
  const Allocation& allocation_;
  std::string& error_;
  std::vector<std::uint32_t> words_;        ///< per scalar: word of the uniform file
  std::vector<std::uint32_t> mask_preset_;  ///< per scalar: mask slot kept by bind()
  std::vector<std::uint32_t> array_base_;   ///< per ir array: bytes
  std::uint32_t temporary_[2] = {kNoIndex, kNoIndex};
  std::vector<std::uint32_t> label_;  ///< instruction index
  struct Fixup {
    std::uint32_t instruction;
    Label label;
  };
  std::vector<Fixup> fixups_;
};

}  // namespace vitrine::spirv::lowering
