// Operands, instructions and labels of the emission; parallel moves.
#include "spirv/lower/emitter.h"

#include <algorithm>

#include "spirv/homes.h"

namespace vitrine::spirv::lowering {

Emitter::Emitter(const ScalarFunction& function, const Allocation& allocation, std::string& error)
    : f_(function), allocation_(allocation), error_(error) {
  program->register_count = allocation.register_count;
  program->mask_count = allocation.mask_count;
  mask_preset_.assign(f_.scalars.size(), kNoIndex);
  std::vector<bool> used(f_.ir->arrays.size(), false);
  for (const std::vector<ScalarOp>* list : {&f_.preamble, &f_.body})
    for (const ScalarOp& op : *list)
      if (op.op == ir::Op::kLoadArray || op.op == ir::Op::kStoreArray) used[op.instr->data[0]] = true;
  for (const Probe& probe : f_.ir->probes)
    if (is_home(probe)) used[probe.number - 1] = true;
  for (std::size_t i = 0; i < used.size(); i++) {
    const std::vector<std::uint32_t>& table = f_.ir->arrays[i].table;
    if (used[i] && !table.empty()) {
      array_base_.push_back(static_cast<std::uint32_t>(program->tables.size() * sizeof(std::uint32_t)));
      program->tables.insert(program->tables.end(), table.begin(), table.end());
      program->tables.resize((program->tables.size() + 15) / 16 * 16);
      continue;
    }
    array_base_.push_back(program->array_bytes);
    if (used[i]) program->array_bytes += f_.ir->arrays[i].elements * kRegisterStride;
  }
  assign_words();
  for (const ScalarId id : f_.preset) {
    const std::uint32_t offset = program->register_count++ * kRegisterStride;
    program->register_presets.push_back({offset, word(id).offset});
  }
}

void Emitter::assign_word(ScalarId id) {
  if (id == kNoScalar || words_[id] != kNoIndex || level(id) == Level::kVarying) return;
  words_[id] = program->uniform_words++;
}

/// Calls f(id) for every operand of `op` that is read as a word or register.
template <class F>
void for_each_operand(const ScalarFunction& function, const ScalarOp& op, F&& f) {
  if (op.reads_condition()) f(op.cond);
  for (const ScalarId id : function.of(op.test_sources)) f(id);
  for (const ScalarId id : function.of(op.src)) f(id);
}

void Emitter::assign_words() {
  words_.assign(f_.scalars.size(), kNoIndex);
  const auto visit = [&](const std::vector<ScalarOp>& list, Level wanted) {
    const auto assign = [&](ScalarId id) {
      if (level(id) == wanted) assign_word(id);
    };
    for (const ScalarOp& op : list) {
      if (op.dead) continue;
      for_each_operand(f_, op, assign);
      for (const ScalarId id : f_.of(op.dst)) assign(id);
    }
  };
  visit(f_.preamble, Level::kConstant);
  visit(f_.body, Level::kConstant);
  for (const ScalarId id : f_.preset)
    if (level(id) == Level::kConstant) assign_word(id);
  program->constants.resize(program->uniform_words);
  for (ScalarId id = 0; id < f_.scalars.size(); ++id)
    if (words_[id] != kNoIndex) program->constants[words_[id]] = f_.scalars[id].bits;
  visit(f_.preamble, Level::kUniform);
  program->draw_words = program->uniform_words;
  share_counter_words();
  visit(f_.body, Level::kWave);
}

/// The next value of a loop parameter is computed in the parameter's own word where nothing reads the old value later.
void Emitter::share_counter_words() {
  std::vector<std::uint32_t> uses(f_.scalars.size(), 0), last_use(f_.scalars.size(), 0);
  std::vector<std::uint32_t> definition(f_.scalars.size(), kNoIndex);
  for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
    for_each_operand(f_, f_.body[i], [&](ScalarId id) {
      ++uses[id];
      last_use[id] = i;
    });
    if (f_.body[i].kind == Kind::kAlu) definition[f_.operands[f_.body[i].dst.begin]] = i;
  }
  for (const ScalarOp& op : f_.body) {
    if (op.kind != Kind::kEndLoop) continue;
    for (std::uint32_t k = 0; k < op.src.count; ++k) {
      const ScalarId next = source(op, k), parameter = result(op, k);
      if (level(next) != Level::kWave || level(parameter) != Level::kWave || uses[next] != 1) continue;
      if (definition[next] == kNoIndex || definition[next] < op.partner || last_use[parameter] > definition[next])
        continue;
      assign_word(parameter);
      words_[next] = words_[parameter];
    }
  }
}

Place Emitter::place(ScalarId id) {
  if (level(id) != Level::kVarying) return word(id);
  const std::uint32_t at = allocation_.place[id];
  if (at == kNoIndex) return {};
  return f_.scalars[id].boolean ? Place{'m', at * 8} : Place{'r', at * kRegisterStride};
}

Place Emitter::in_register(ScalarId id) {
  if (level(id) == Level::kVarying) return place(id);
  if (f_.scalars[id].boolean) {
    if (level(id) == Level::kWave) fail("wave-uniform boolean without a mask");
    if (mask_preset_[id] == kNoIndex) {
      mask_preset_[id] = program->mask_count++;
      program->mask_presets.push_back({mask_preset_[id] * 8, word(id).offset});
    }
    return {'m', mask_preset_[id] * 8};
  }
  const auto it = std::find(f_.preset.begin(), f_.preset.end(), id);
  if (it == f_.preset.end()) {
    fail("uniform operand without a register");
    return {};
  }
  return {'r', program->register_presets[static_cast<std::size_t>(it - f_.preset.begin())].to};
}

bool Emitter::same_place(ScalarId a, ScalarId b) {
  const Place x = place(a), y = place(b);
  return x.file == y.file && x.offset == y.offset;
}

Instruction& Emitter::append(Handler handler, const char* name, const ir::Instr* instr, Place dst, Place a, Place b,
                             Place c) {
  if (handler == nullptr) fail("operation without a handler for its operands");
  std::vector<Instruction>& code = in_preamble ? program->preamble : program->code;
  code.push_back({handler, dst.offset, {a.offset, b.offset, c.offset}, {0, 0}});
  const ir::Origin origin = instr ? instr->origin : ir::Origin{0, near};
  (in_preamble ? program->preamble_notes : program->notes)
      .push_back({name, {dst.file, a.file, b.file, c.file}, origin, {}});
  return code.back();
}

Label Emitter::new_label() {
  label_.push_back(kNoIndex);
  return static_cast<Label>(label_.size() - 1);
}

void Emitter::bind(Label label) { label_[label] = static_cast<std::uint32_t>(program->code.size()); }

void Emitter::append_jump(Handler handler, const char* name, Label to, Place dst, Place a, Place b) {
  fixups_.push_back({static_cast<std::uint32_t>(program->code.size()), to});
  append(handler, name, nullptr, dst, a, b);
  program->notes.back().extra = InstructionNote::Extra::kJump;
}

void Emitter::append_jump_unless(const ScalarOp& op, const char* name, Label to) {
  if (op.test == ir::Op::kCount) {
    append_jump(op.negated ? exec::jump_if : exec::jump_unless, name, to, {}, place(op.cond));
    return;
  }
  const auto sources = f_.of(op.test_sources);
  append_jump(exec::jump_compare(op.test, op.negated), name, to, {}, place(sources[0]), place(sources[1]));
}

void Emitter::alu(const ScalarOp& op) {
  const ScalarId result = f_.operands[op.dst.begin];
  std::array<Place, 3> sources;
  if (level(result) != Level::kVarying) {
    for (std::uint32_t i = 0; i < op.src.count; ++i) sources[i] = place(source(op, i));
    append(alu_scalar_handler(op.op), ir::op_name(op.op), op.instr, place(result), sources[0], sources[1], sources[2]);
    return;
  }
  UniformSources uniform = 0;
  for (std::uint32_t i = 0; i < op.src.count; ++i) {
    const ScalarId id = source(op, i);
    if (op.takes_accumulator(i)) continue;
    sources[i] = f_.scalars[id].boolean ? in_register(id) : place(id);
    if (sources[i].file == 'u') uniform = static_cast<UniformSources>(uniform | 1u << i);
  }
  const Handler handler =
      op.in_chain ? exec::chain_handler(op.op, op.accumulator, uniform, op.link) : alu_handler(op.op, uniform);
  append(handler, ir::op_name(op.op), op.instr, place(result), sources[0], sources[1], sources[2]);
  if (ir::is_selection(op.op)) settle_note();
}

Place Emitter::temporary(char file) {
  std::uint32_t& index = temporary_[file == 'm'];
  if (index == kNoIndex) index = file == 'm' ? program->mask_count++ : program->register_count++;
  return file == 'm' ? Place{'m', index * 8} : Place{'r', index * kRegisterStride};
}

void Emitter::one_move(Place to, Place from, bool masked, const ir::Instr* instr) {
  Handler handler = nullptr;
  if (to.file == 'u') {
    handler = alu_scalar_handler(ir::Op::kMov);
  } else if (to.file == 'm') {
    if (from.file == 'm') {
      handler = masked ? exec::move_mask_active : exec::move_mask;
    } else {
      handler = masked ? exec::broadcast_mask_active : exec::broadcast_mask;
    }
  } else if (masked) {
    handler = from.file == 'r' ? exec::move_active() : exec::broadcast_active();
  } else {
    handler = alu_handler(ir::Op::kMov, from.file == 'u' ? 1 : 0);
  }
  append(handler, masked ? "move.active" : "move", instr, to, from);
  settle_note();
}

void Emitter::moves(const std::vector<Move>& list, const ir::Instr* instr) {
  struct Pending {
    Place to, from;
    bool masked;
  };
  std::vector<Pending> pending;
  for (const Move& move : list) {
    const Place to = place(move.to), from = place(move.from);
    if (to.file == ' ' || (to.file == from.file && to.offset == from.offset)) continue;
    pending.push_back({to, from, move.masked});
  }
  const auto is_read = [&](Place place, const Pending* except) {
    return std::any_of(pending.begin(), pending.end(), [&](const Pending& p) {
      return &p != except && p.from.file == place.file && p.from.offset == place.offset;
    });
  };
  while (!pending.empty()) {
    const auto ready =
        std::find_if(pending.begin(), pending.end(), [&](const Pending& p) { return !is_read(p.to, &p); });
    if (ready != pending.end()) {
      one_move(ready->to, ready->from, ready->masked, instr);
      pending.erase(ready);
      continue;
    }
    // Only cycles are left: keep one target's old value aside.
    const Place target = pending.front().to;
    Place spare = temporary(target.file);
    if (target.file == 'u') spare = {'u', program->uniform_words++ * 4};
    one_move(spare, target, false, instr);
    for (Pending& p : pending)
      if (p.from.file == target.file && p.from.offset == target.offset) p.from = spare;
  }
}

/// Lanes that diverged leave registers as they were, and derivatives read them all the same.
void Emitter::clear_registers(const ShaderInterface& interface) {
  const bool diverges = std::any_of(f_.body.begin(), f_.body.end(), [](const ScalarOp& op) { return op.masked; });
  if (!interface.needs_helpers || !diverges) return;
  std::vector<bool> kept(program->register_count + 1, false);
  kept.back() = true;
  for (const InterfaceSlot& slot : interface.inputs) kept[slot.reg] = true;
  for (const Preset& preset : program->register_presets) kept[preset.to / kRegisterStride] = true;
  for (std::uint32_t at = 0, begin = 0; at < kept.size(); ++at) {
    if (!kept[at]) continue;
    if (begin < at) program->cleared.push_back({begin * kRegisterStride, at * kRegisterStride});
    begin = at + 1;
  }
}

std::unique_ptr<Program> Emitter::finish(ShaderInterface& interface) {
  for (const Fixup& fixup : fixups_)
    program->code[fixup.instruction].extra[0] = label_[fixup.label] - fixup.instruction;
  charge_loops(*program);
  std::vector<InterfaceSlot> inputs, outputs;
  for (ScalarId id = 0; id < f_.scalars.size(); ++id) {
    if (f_.scalars[id].input == kNoIndex || place(id).file == ' ') continue;
    inputs.push_back(interface.inputs[f_.scalars[id].input]);
    inputs.back().reg = place(id).offset / kRegisterStride;
  }
  for (std::size_t i = 0; i < f_.outputs.size(); ++i) {
    if (f_.outputs[i] == kNoScalar) continue;
    outputs.push_back(interface.outputs[i]);
    outputs.back().reg = in_register(f_.outputs[i]).offset / kRegisterStride;
  }
  interface.inputs = std::move(inputs);
  interface.outputs = std::move(outputs);
  clear_registers(interface);
  program->probes = f_.ir->probes;
  for (Probe& probe : program->probes)
    if (is_home(probe)) probe.number = array_base_[probe.number - 1] + 1;
  program->uniform_words = std::max(program->uniform_words, program->draw_words);
  return std::move(program);
}

}  // namespace vitrine::spirv::lowering
