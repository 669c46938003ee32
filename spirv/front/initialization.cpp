// Which parts of variables have been written where they are read.
#include "spirv/front/initialization.h"

#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>

#include "spirv/front/functions.h"
#include "spirv/newer_numbers.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

/// Part of a variable.
struct Cells {
  bool tracked = false;
  std::uint32_t local = 0, first = 0, count = 0;
  std::uint32_t variable_first = 0, variable_count = 0;  ///< of the whole variable
  std::vector<std::pair<ir::ValueId, std::array<std::uint32_t, 2>>> steps;
};

/// Scalars of a value of this type, of any width; 0: it has a kind that is not looked at.
std::uint32_t scalars_of(const Translator& t, std::uint32_t type_id) {
  const Type& type = t.module.type(type_id);
  switch (type.kind) {
    case Type::Kind::kBool:
    case Type::Kind::kInt:
    case Type::Kind::kFloat:
      return 1;
    case Type::Kind::kVector:
    case Type::Kind::kMatrix:
    case Type::Kind::kArray:
      return static_cast<std::uint32_t>(
          std::min(std::uint64_t{type.count} * scalars_of(t, type.element), std::uint64_t{kMaxScalars}));
    case Type::Kind::kStruct: {
      std::uint64_t sum = 0;
      for (const std::uint32_t member : type.members) {
        const std::uint32_t scalars = scalars_of(t, member);
        if (scalars == 0) return 0;
        sum += scalars;
      }
      return static_cast<std::uint32_t>(std::min(sum, std::uint64_t{kMaxScalars}));
    }
    default:
      return 0;
  }
}

/// Number of the first scalar of a member or element, and its type.
std::uint32_t enter(const Translator& t, std::uint32_t& type_id, std::uint32_t index) {
  const Type& type = t.module.type(type_id);
  std::uint32_t first = 0;
  if (type.kind == Type::Kind::kStruct) {
    for (std::uint32_t i = 0; i < index; ++i) first += scalars_of(t, type.members.at(i));
    type_id = type.members.at(index);
  } else {
    type_id = type.element;
    first = index * scalars_of(t, type_id);
  }
  return first;
}

bool is_tracked(const Translator& t, const Local& local) {
  if (local.type == 0) return false;
  if (local.storage == spv::StorageClass::Input) return false;
  const bool initialised =
      local.variable != 0 && t.module.def(local.variable).has(1) && local.storage != spv::StorageClass::Function;
  return !initialised;
}

/// First cell of a local; kUntracked: it has none.
std::uint32_t first_cell_of(Translator& t, std::uint32_t local) {
  Initialization& state = *t.initialization;
  const auto [at, added] = state.first_cell.try_emplace(local, Initialization::kUntracked);
  if (!added || !is_tracked(t, t.locals[local])) return at->second;
  const std::uint32_t count = scalars_of(t, t.locals[local].type);
  if (count == 0 || count > Initialization::kMaxCells) return at->second;
  at->second = state.cells;
  state.cells += count;
  return at->second;
}

void step_in(Cells& cells, const Translator& t, std::uint32_t& type_id, const Step& step) {
  const std::uint32_t length = t.module.type(type_id).count;
  if (step.dynamic) {
    enter(t, type_id, 0);
    cells.steps.push_back({step.value, {scalars_of(t, type_id), length}});
  } else {
    cells.first += enter(t, type_id, step.index);
  }
}

Cells cells_of(Translator& t, const Pointer& pointer) {
  Cells cells;
  if (pointer.kind != Pointer::Kind::kLocal) return cells;
  const std::uint32_t first = first_cell_of(t, pointer.local);
  if (first == Initialization::kUntracked) return cells;
  std::uint32_t type = t.locals[pointer.local].type;
  cells.tracked = true;
  cells.local = pointer.local;
  cells.first = cells.variable_first = first;
  cells.variable_count = scalars_of(t, type);
  for (const Step& step : pointer.path) step_in(cells, t, type, step);
  if (pointer.component) step_in(cells, t, type, *pointer.component);
  cells.count = scalars_of(t, type);
  return cells;
}

void emit_cells(Translator& t, Probe probe, const Cells& cells) {
  probe.first_cell = cells.first;
  probe.cells = cells.count;
  std::vector<ir::Src> words;
  for (const auto& [value, step] : cells.steps) {
    words.push_back(splat(value));
    probe.steps.push_back(step);
  }
  emit_probe(t, std::move(probe), std::move(words));
}

/// Whether all cells that a read may touch have been written.
bool certainly_written(const Initialization& state, const Cells& cells) {
  const bool anywhere = !cells.steps.empty();
  const std::uint32_t first = anywhere ? cells.variable_first : cells.first;
  const std::uint32_t count = anywhere ? cells.variable_count : cells.count;
  for (std::uint32_t c = 0; c < count; ++c)
    if (!state.here.has(first + c)) return false;
  return true;
}

void set_slots(Translator& t, std::uint32_t id, SlotsOf slots) {
  const bool defined = std::all_of(slots.begin(), slots.end(), [](const Slots& s) { return s.empty(); });
  if (defined) {
    t.initialization->values.erase(id);
  } else {
    t.initialization->values[id] = std::move(slots);
  }
}

/// Of the value of `id`.
SlotsOf slots_of(const Translator& t, std::uint32_t id) {
  const auto found = t.initialization->values.find(id);
  if (found != t.initialization->values.end()) return found->second;
  const auto definition = t.module.definition.find(id);
  if (definition == t.module.definition.end()) return {};
  const Inst& inst = t.module.code[definition->second];
  if (inst.op != Op::OpUndef) return {};
  return SlotsOf(scalars_of(t, inst.result_type), Slots{0});
}

void unite(Slots& into, const Slots& more) {
  Slots both;
  std::set_union(into.begin(), into.end(), more.begin(), more.end(), std::back_inserter(both));
  into = std::move(both);
}

Slots all_of(const SlotsOf& slots) {
  Slots all;
  for (const Slots& s : slots) unite(all, s);
  return all;
}

void read_cells(Translator& t, std::uint32_t id, const Cells& cells) {
  Initialization& state = *t.initialization;
  if (!cells.tracked || cells.count == 0 || certainly_written(state, cells)) return set_slots(t, id, {});
  Probe probe;
  probe.kind = Probe::Kind::kRead;
  probe.id = id;
  probe.first_slot = state.slots;
  SlotsOf slots;
  for (std::uint32_t i = 0; i < cells.count; ++i) {
    slots.push_back({state.slots++});
    const auto source = state.source_of_cell.find(cells.first + i);
    const bool copied = source != state.source_of_cell.end();
    state.variable_of_slot.push_back(copied ? source->second : t.locals[cells.local].variable);
  }
  emit_cells(t, std::move(probe), cells);
  set_slots(t, id, std::move(slots));
  if (state.read.size() <= cells.local) state.read.resize(cells.local + 1);
  state.read[cells.local] = true;
}

/// `slots`: of what is written; empty: it is defined.
void write_cells(Translator& t, const Cells& cells, SlotsOf slots) {
  if (!cells.tracked || cells.count == 0) return;
  Initialization& state = *t.initialization;
  if (!slots.empty()) slots.resize(cells.count);
  for (std::uint32_t c = 0; c < slots.size(); ++c)
    if (!slots[c].empty() && slots[c].back() != 0)
      state.source_of_cell[cells.first + c] = state.variable_of_slot[slots[c].back()];
  if (cells.steps.empty()) {
    for (std::uint32_t c = 0; c < cells.count; ++c) state.here.set(cells.first + c, slots.empty() || slots[c].empty());
  } else if (!slots.empty()) {
    for (std::uint32_t c = 0; c < cells.variable_count; ++c) state.here.set(cells.variable_first + c, false);
  }
  Probe probe;
  probe.kind = Probe::Kind::kWrite;
  probe.slots = std::move(slots);
  emit_cells(t, std::move(probe), cells);
  state.local_of_probe.resize(t.function.probes.size());
  state.local_of_probe.back() = cells.local;
}

std::string name_of(const Translator& t, const Slots& slots) {
  for (const std::uint32_t slot : slots) {
    const std::uint32_t variable = t.initialization->variable_of_slot[slot];
    const auto name = t.initialization->names.find(variable);
    if (name != t.initialization->names.end() && !name->second.empty()) return "variable '" + name->second + "'";
    if (variable != 0) return "variable %" + std::to_string(variable);
  }
  return "a value";
}

void use(Translator& t, const Slots& slots, const char* what) {
  if (slots.empty()) return;
  Probe probe;
  probe.kind = Probe::Kind::kUse;
  probe.id = t.inst->result;
  probe.slots = {slots};
  probe.format = std::string(what) + " depends on " + name_of(t, slots) + ", which has not been written";
  emit_probe(t, std::move(probe), {});
}

void use_value(Translator& t, std::uint32_t id, const char* what) { use(t, all_of(slots_of(t, id)), what); }

// ---- values that are handed on

SlotsOf of_parts(const Translator& t, const Inst& inst) {
  SlotsOf slots;
  for (std::uint32_t i = 0; inst.has(i); ++i) {
    const SlotsOf part = slots_of(t, inst.operand(i));
    const std::uint32_t count = scalars_of(t, t.module.def(inst.operand(i)).result_type);
    for (std::uint32_t c = 0; c < count; ++c) slots.push_back(part.empty() ? Slots{} : part.at(c));
  }
  return slots;
}

/// First scalar and number of scalars of the part that literal operands from `first` on lead to.
std::pair<std::uint32_t, std::uint32_t> part_of(const Translator& t, const Inst& inst, std::uint32_t type,
                                                std::uint32_t first) {
  std::uint32_t at = 0;
  for (std::uint32_t i = first; inst.has(i); ++i) at += enter(t, type, inst.operand(i));
  return {at, scalars_of(t, type)};
}

SlotsOf of_extract(const Translator& t, const Inst& inst) {
  const SlotsOf whole = slots_of(t, inst.operand(0));
  if (whole.empty()) return {};
  const auto [at, count] = part_of(t, inst, t.module.def(inst.operand(0)).result_type, 1);
  if (std::uint64_t{at} + count > whole.size()) return {};
  return {whole.begin() + at, whole.begin() + at + count};
}

SlotsOf of_insert(const Translator& t, const Inst& inst) {
  SlotsOf whole = slots_of(t, inst.operand(1));
  const SlotsOf part = slots_of(t, inst.operand(0));
  if (whole.empty() && part.empty()) return {};
  whole.resize(scalars_of(t, inst.result_type));
  const auto [at, count] = part_of(t, inst, inst.result_type, 2);
  for (std::uint32_t c = 0; c < count && at + c < whole.size(); ++c)
    whole[at + c] = part.empty() ? Slots{} : part.at(c);
  return whole;
}

SlotsOf of_shuffle(const Translator& t, const Inst& inst) {
  const SlotsOf a = slots_of(t, inst.operand(0)), b = slots_of(t, inst.operand(1));
  const std::uint32_t first = scalars_of(t, t.module.def(inst.operand(0)).result_type);
  SlotsOf slots;
  for (std::uint32_t i = 2; inst.has(i); ++i) {
    const std::uint32_t from = inst.operand(i);
    const SlotsOf& source = from < first ? a : b;
    const std::uint32_t at = from < first ? from : from - first;
    slots.push_back(at < source.size() ? source[at] : Slots{});
  }
  return slots;
}

/// Component by component where the operands have as many as the result, else all of them.
SlotsOf of_operation(const Translator& t, const Inst& inst, std::uint32_t first, bool by_component) {
  const std::uint32_t count = scalars_of(t, inst.result_type);
  SlotsOf slots(count);
  for (std::uint32_t i = first; inst.has(i); ++i) {
    const SlotsOf operand = slots_of(t, inst.operand(i));
    if (operand.empty()) continue;
    const Slots all = all_of(operand);
    for (std::uint32_t c = 0; c < count; ++c)
      unite(slots[c], by_component && operand.size() == count ? operand[c] : all);
  }
  return slots;
}

/// Operations all of whose operands are values.
bool is_operation(Op op) {
  const auto in = [op](Op first, Op last) { return op >= first && op <= last; };
  return in(Op::OpConvertFToU, Op::OpQuantizeToF16) || op == Op::OpBitcast || in(Op::OpSNegate, Op::OpSMulExtended) ||
         in(Op::OpAny, Op::OpNot) || in(Op::OpBitFieldInsert, Op::OpBitCount) || in(Op::OpDPdx, Op::OpFwidthCoarse) ||
         op == Op::OpTranspose || op == Op::OpVectorExtractDynamic || op == Op::OpVectorInsertDynamic;
}

bool mixes_components(Op op) {
  return (op >= Op::OpMatrixTimesScalar && op <= Op::OpDot) || op == Op::OpTranspose || op == Op::OpAny ||
         op == Op::OpAll || op == Op::OpVectorInsertDynamic;
}

bool mixes_components(std::uint32_t function) {
  return function == GLSLstd450MatrixInverse || (function >= GLSLstd450Length && function <= GLSLstd450Refract);
}

/// Functions that write a second result through a pointer.
bool writes_pointer(std::uint32_t function) { return function == GLSLstd450Modf || function == GLSLstd450Frexp; }

void after_function(Translator& t, const Inst& inst) {
  const auto set = t.module.ext_imports.find(inst.operand(0));
  if (set == t.module.ext_imports.end() || set->second != kExtGlsl450) return;
  const std::uint32_t function = inst.operand(1);
  if (writes_pointer(function)) write_cells(t, cells_of(t, pointer_of(t, inst.operand(3))), {});
  const bool reads_pointer = function >= GLSLstd450InterpolateAtCentroid && function <= GLSLstd450InterpolateAtOffset;
  if (!reads_pointer && !writes_pointer(function))
    set_slots(t, inst.result, of_operation(t, inst, 2, !mixes_components(function)));
}

/// One part in every place.
SlotsOf of_replicas(const Translator& t, const Inst& inst) {
  const SlotsOf part = slots_of(t, inst.operand(0));
  SlotsOf slots;
  for (std::uint32_t i = 0; !part.empty() && i < constituents(t.module.type(inst.result_type)); ++i)
    slots.insert(slots.end(), part.begin(), part.end());
  return slots;
}

SlotsOf slots_of_result(const Translator& t, const Inst& inst) {
  if (inst.op == newer::kCompositeConstructReplicate) return of_replicas(t, inst);
  switch (inst.op) {
    case Op::OpCopyObject:
    case Op::OpCopyLogical:
    case Op::OpExpectKHR:
      return slots_of(t, inst.operand(0));
    case Op::OpCompositeConstruct:
      return of_parts(t, inst);
    case Op::OpCompositeExtract:
      return of_extract(t, inst);
    case Op::OpCompositeInsert:
      return of_insert(t, inst);
    case Op::OpVectorShuffle:
      return of_shuffle(t, inst);
    default:
      return is_operation(inst.op) ? of_operation(t, inst, 0, !mixes_components(inst.op)) : SlotsOf{};
  }
}

// ---- what depends on values

/// Number of the operand that says where an image is accessed; 0: none does.
std::uint32_t coordinate_of(Op op) {
  const bool samples = op >= Op::OpImageSampleImplicitLod && op <= Op::OpImageWrite;
  return samples || op == Op::OpImageTexelPointer ? 1 : 0;
}

/// Whether scalar `at` of the value `id` is scalar `own` of what was loaded from `pointer`.
bool is_copy_of(const Translator& t, std::uint32_t id, std::uint32_t at, std::uint32_t pointer, std::uint32_t own) {
  const auto definition = t.module.definition.find(id);
  if (definition == t.module.definition.end()) return false;
  const Inst& inst = t.module.code[definition->second];
  if (inst.op == Op::OpLoad) return inst.operand(0) == pointer && at == own;
  if (inst.op == Op::OpCompositeInsert) {
    const auto [first, count] = part_of(t, inst, inst.result_type, 2);
    if (at - first < count) return is_copy_of(t, inst.operand(0), at - first, pointer, own);
    return is_copy_of(t, inst.operand(1), at, pointer, own);
  }
  if (inst.op != Op::OpVectorShuffle || !inst.has(2 + at)) return false;
  const std::uint32_t from = inst.operand(2 + at), first = scalars_of(t, t.module.def(inst.operand(0)).result_type);
  if (from < first) return is_copy_of(t, inst.operand(0), from, pointer, own);
  return is_copy_of(t, inst.operand(1), from - first, pointer, own);
}

/// Where a shader writes some components of an output, compilers load it, insert them and store the whole: the others
/// stay what they were, which is no use of them.
void use_store(Translator& t, const Inst& inst) {
  const Pointer pointer = pointer_of(t, inst.operand(0));
  const bool local = pointer.kind == Pointer::Kind::kLocal;
  if (local && t.locals[pointer.local].storage != spv::StorageClass::Output) return;
  SlotsOf slots = slots_of(t, inst.operand(1));
  for (std::uint32_t c = 0; local && c < slots.size(); ++c)
    if (!slots[c].empty() && is_copy_of(t, inst.operand(1), c, inst.operand(0), c)) slots[c].clear();
  use(t, all_of(slots), "what is stored");
}

void use_indices(Translator& t, const Inst& inst) {
  for (std::uint32_t i = 1; inst.has(i); ++i) use_value(t, inst.operand(i), "an index");
}

bool is_atomic(Op op) {
  return (op >= Op::OpAtomicStore && op <= Op::OpAtomicXor) || op == Op::OpAtomicFAddEXT || op == Op::OpAtomicFMinEXT ||
         op == Op::OpAtomicFMaxEXT;
}

/// Literals are no ids of values: those that a module could mistake for one are left out.
void use_operands(Translator& t, const Inst& inst) {
  switch (inst.op) {
    case Op::OpStore:
      return use_store(t, inst);
    case Op::OpAccessChain:
    case Op::OpInBoundsAccessChain:
    case Op::OpPtrAccessChain:
    case Op::OpInBoundsPtrAccessChain:
      return use_indices(t, inst);
    case Op::OpImageWrite:
      use_value(t, inst.operand(2), "what is stored");
      break;
    default:
      break;
  }
  if (const std::uint32_t at = coordinate_of(inst.op)) use_value(t, inst.operand(at), "a coordinate");
  if (is_atomic(inst.op) && inst.has(3)) use_value(t, inst.operand(3), "an atomic operation");
}

bool in_loop(const Translator& t) {
  return std::any_of(t.scopes.begin(), t.scopes.end(), [](const Scope& s) { return s.kind == Scope::Kind::kLoop; });
}

/// A variable begins: its cells are what its initializer says, or undefined once more.
void begin_variable(Translator& t, const Inst& inst) {
  const Cells cells = cells_of(t, t.pointers.at(inst.result));
  if (!cells.tracked) return;
  if (inst.has(1)) {
    write_cells(t, cells, slots_of(t, inst.operand(1)));
  } else if (in_loop(t)) {
    write_cells(t, cells, SlotsOf(cells.count, Slots{0}));
  }
}

void copy_memory(Translator& t, const Inst& inst) {
  const Cells to = cells_of(t, pointer_of(t, inst.operand(0))), from = cells_of(t, pointer_of(t, inst.operand(1)));
  constexpr std::uint32_t kNoId = 0;
  read_cells(t, kNoId, from);
  if (to.tracked) {
    write_cells(t, to, slots_of(t, kNoId));
  } else {
    use_value(t, kNoId, "what is stored");
  }
}

/// OpSelect of scalars, vectors or composites (whose condition is a scalar): which value it is, is known at run time.
void choose(Translator& t, const Inst& inst) {
  const std::uint32_t count = scalars_of(t, inst.result_type);
  const SlotsOf conditions = slots_of(t, inst.operand(0));
  SlotsOf holds = slots_of(t, inst.operand(1)), else_ = slots_of(t, inst.operand(2));
  if (holds.empty() && else_.empty() && conditions.empty()) return set_slots(t, inst.result, {});
  holds.resize(count), else_.resize(count);
  Initialization& state = *t.initialization;
  Probe probe;
  probe.kind = Probe::Kind::kChoose;
  probe.id = inst.result;
  probe.cells = count;
  probe.first_slot = state.slots;
  std::vector<ir::Src> words;
  const ProbeValue condition = probe_value(t, inst, inst.operand(0), words);
  if (condition.components == 1) words.resize(count, words.front());
  SlotsOf slots;
  for (std::uint32_t c = 0; c < count; ++c) {
    slots.push_back({state.slots++});
    if (!conditions.empty()) unite(slots.back(), conditions[conditions.size() == 1 ? 0 : c]);
    const Slots& source = holds[c].empty() ? else_[c] : holds[c];
    state.variable_of_slot.push_back(source.empty() ? 0 : state.variable_of_slot[source.front()]);
    probe.slots.push_back(std::move(holds[c]));
    probe.slots.push_back(std::move(else_[c]));
  }
  emit_probe(t, std::move(probe), std::move(words));
  set_slots(t, inst.result, std::move(slots));
}

bool is_idle_write(const Translator& t, const ir::Node& node) {
  if (node.kind != ir::Node::Kind::kInstr || node.instr.op != ir::Op::kProbe) return false;
  const std::uint32_t number = node.instr.data[0];
  if (t.function.probes[number].kind != Probe::Kind::kWrite) return false;
  const std::uint32_t local = t.initialization->local_of_probe[number];
  return local >= t.initialization->read.size() || !t.initialization->read[local];
}

void drop_in(const Translator& t, ir::NodeList& list) {
  std::erase_if(list, [&](const auto& node) { return is_idle_write(t, *node); });
  for (const auto& node : list)
    for (ir::NodeList* inner : {&node->then_list, &node->else_list, &node->body, &node->continuing}) drop_in(t, *inner);
}

}  // namespace

void Assigned::set(std::uint32_t cell, bool written) {
  if (cells.size() <= cell) cells.resize(std::size_t{cell} + 1);
  cells[cell] = written;
}

std::shared_ptr<Initialization> begin_initialization(const Module& module) {
  auto state = std::make_shared<Initialization>();
  for (const Inst& inst : module.code)
    if (inst.op == Op::OpName && inst.has(1)) state->names[inst.operand(0)] = string_at(inst, 1);
  return state;
}

Assigned meet(const Assigned& a, const Assigned& b) {
  if (!a.reachable) return b;
  if (!b.reachable) return a;
  Assigned both = a.cells.size() < b.cells.size() ? a : b;
  const Assigned& other = a.cells.size() < b.cells.size() ? b : a;
  for (std::size_t c = 0; c < both.cells.size(); ++c) both.cells[c] = both.cells[c] && other.cells[c];
  return both;
}

Assigned assigned_here(const Translator& t) { return t.initialization ? t.initialization->here : Assigned{}; }

Assigned go_on_from(Translator& t, const Assigned& place) {
  if (!t.initialization) return {};
  return std::exchange(t.initialization->here, place);
}

void jump_to_end(Translator& t, Scope* scope) {
  if (!t.initialization) return;
  Assigned& here = t.initialization->here;
  if (scope != nullptr) scope->left = std::make_shared<Assigned>(scope->left ? meet(*scope->left, here) : here);
  here.reachable = false;
}

void arrive(Translator& t, const Scope& scope) {
  if (t.initialization && scope.left) t.initialization->here = meet(t.initialization->here, *scope.left);
}

void before_instruction(Translator& t, const Inst& inst) {
  if (t.initialization) use_operands(t, inst);
}

void after_instruction(Translator& t, const Inst& inst) {
  if (!t.initialization) return;
  switch (inst.op) {
    case Op::OpVariable:
      return begin_variable(t, inst);
    case Op::OpLoad:
      return read_cells(t, inst.result, cells_of(t, pointer_of(t, inst.operand(0))));
    case Op::OpStore:
      return write_cells(t, cells_of(t, pointer_of(t, inst.operand(0))), slots_of(t, inst.operand(1)));
    case Op::OpCopyMemory:
      return copy_memory(t, inst);
    case Op::OpSelect:
      return choose(t, inst);
    case Op::OpExtInst:
      return after_function(t, inst);
    default:
      if (inst.result != 0) set_slots(t, inst.result, slots_of_result(t, inst));
  }
}

void use_in_branch(Translator& t, std::uint32_t id) {
  if (t.initialization) use_value(t, id, "a branch");
}

void copy_to_local(Translator& t, std::uint32_t local, std::uint32_t id) {
  if (t.initialization) write_cells(t, cells_of(t, local_pointer(t, local)), slots_of(t, id));
}

void copy_from_local(Translator& t, std::uint32_t id, std::uint32_t local) {
  if (t.initialization) read_cells(t, id, cells_of(t, local_pointer(t, local)));
}

void copy_value(Translator& t, std::uint32_t to, std::uint32_t from) {
  if (t.initialization) set_slots(t, to, slots_of(t, from));
}

void drop_idle_writes(Translator& t) {
  if (!t.initialization) return;
  t.initialization->local_of_probe.resize(t.function.probes.size());
  drop_in(t, t.function.body);
}

}  // namespace vitrine::spirv::front
