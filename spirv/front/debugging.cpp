// Probes for debuggers: lines, and what variables get, under the names that OpName and NonSemantic.Shader.DebugInfo.100
// (DebugDeclare, DebugValue) give them.
#include "spirv/front/debugging.h"

#include <spirv/unified1/NonSemanticShaderDebugInfo100.h>

#include <algorithm>

#include "spirv/front/debug_types.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {

using spv::Op;

struct Debugging {
  struct Declared {
    std::string name;
    std::uint32_t line = 0;
  };
  struct Line {
    std::uint32_t file = 0, line = 0, scope = 0;
    bool operator==(const Line&) const = default;
  };

  explicit Debugging(const Module& module) : types(module, tables) {}

  SourceVariables tables;
  DebugTypes types;
  std::unordered_map<std::uint32_t, Declared> locals;      ///< DebugLocalVariable -> what it says
  std::unordered_map<std::uint32_t, Declared> declared;    ///< OpVariable or parameter -> by DebugDeclare
  std::unordered_map<std::uint32_t, std::uint32_t> cells;  ///< Translator::locals -> first cell
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> values;  ///< (id, scope) -> first cell
  bool ids = false;       ///< the module names no lines: results are shown by their ids
  bool entering = false;  ///< the next line is its function's first
  Line last;              ///< of the block
};

namespace {

/// Cells of all variables, and of one: what goes beyond is not shown.
constexpr std::uint32_t kMaxCells = 1u << 14, kMaxCellsOfOne = 1u << 12, kMaxWordsOfProbe = 256;
constexpr std::uint32_t kNoCell = ~std::uint32_t{0};
/// Operands of an OpExtInst before its arguments.
constexpr std::uint32_t kFirstArgument = 2;

namespace local_variable {
enum : std::uint32_t { kName, kType, kSource, kLine };
}
namespace declare {
enum : std::uint32_t { kLocalVariable, kVariable };
}
namespace value {
enum : std::uint32_t { kLocalVariable, kValue, kExpression, kIndexes };
}

std::uint32_t argument(const Inst& inst, std::uint32_t index) {
  return inst.has(kFirstArgument + index) ? inst.operand(kFirstArgument + index) : 0;
}

std::string text_of(const Module& module, std::uint32_t id) {
  const auto found = module.definition.find(id);
  if (found == module.definition.end() || module.code[found->second].op != Op::OpString) return {};
  return string_at(module.code[found->second], 0);
}

std::uint32_t number_of(const Module& module, std::uint32_t id) {
  const Constant* constant = module.constant(id);
  return constant != nullptr && !constant->words.empty() ? constant->words[0] : 0;
}

/// Takes what DebugLocalVariable and DebugDeclare say.
void read_declarations(const Module& module, Debugging& debugging) {
  for (const Inst& inst : module.code) {
    if (inst.op != Op::OpExtInst || !inst.has(1)) continue;
    const auto set = module.ext_imports.find(inst.operand(0));
    if (set == module.ext_imports.end() || set->second != kExtDebugInfo) continue;
    if (inst.operand(1) == NonSemanticShaderDebugInfo100DebugLocalVariable) {
      debugging.locals[inst.result] = {text_of(module, argument(inst, local_variable::kName)),
                                       number_of(module, argument(inst, local_variable::kLine))};
    } else if (inst.operand(1) == NonSemanticShaderDebugInfo100DebugDeclare) {
      const auto local = debugging.locals.find(argument(inst, declare::kLocalVariable));
      if (local != debugging.locals.end())
        debugging.declared.try_emplace(argument(inst, declare::kVariable), local->second);
    }
  }
}

bool is_line(const Translator& t, const Inst& inst) {
  switch (inst.op) {
    case Op::OpVariable:
    case Op::OpPhi:
    case Op::OpLine:
    case Op::OpNoLine:
    case Op::OpLoopMerge:
    case Op::OpSelectionMerge:
    case Op::OpBranch:
    case Op::OpUndef:
      return false;
    case Op::OpExtInst: {
      const auto set = t.module.ext_imports.find(inst.operand(0));
      return set != t.module.ext_imports.end() && set->second == kExtGlsl450;
    }
    default:
      return true;
  }
}

Debugging::Line line_of(Translator& t, const Inst& inst) {
  const SourcePlace& place = t.sources.place(inlined_place(t, inst.origin.place));
  return {place.file, place.line, place.scope};
}

void emit_step(Translator& t, StepKind kind) {
  Probe probe;
  probe.kind = Probe::Kind::kStep;
  probe.number = static_cast<std::uint32_t>(kind);
  probe.id = t.inst->origin.spirv_id;
  probe.enters = std::exchange(t.debugging->entering, false);
  emit_probe(t, std::move(probe), {});
}

/// SourceInfo::scopes of the running instance of a function; 0: it names no place.
std::uint32_t scope_of(Translator& t, const Function& function) {
  const auto begin = t.module.definition.find(function.id);
  if (begin == t.module.definition.end()) return 0;
  for (std::size_t i = begin->second; i < t.module.code.size(); ++i) {
    const Inst& inst = t.module.code[i];
    if (inst.op == Op::OpFunctionEnd) break;
    if (inst.op != Op::OpFunction && inst.origin.place != 0)
      return t.sources.place(inlined_place(t, inst.origin.place)).scope;
  }
  return 0;
}

/// `count` more cells; kNoCell: they are too many.
std::uint32_t take_cells(Debugging& debugging, std::uint32_t count) {
  SourceVariables& tables = debugging.tables;
  if (count == 0 || count > kMaxCellsOfOne || count > kMaxCells - tables.cells) return kNoCell;
  tables.cells += count;
  return tables.cells - count;
}

std::uint32_t cells_of_local(Translator& t, std::uint32_t local) {
  Debugging& debugging = *t.debugging;
  if (t.locals[local].type == 0) return kNoCell;
  const auto [at, added] = debugging.cells.try_emplace(local, kNoCell);
  if (added)
    at->second = take_cells(debugging, debugging.tables.types[debugging.types.number(t.locals[local].type)].cells);
  return at->second;
}

/// Words of a value in the order of cells. False: it has none to show.
bool append_words(const Translator& t, std::uint32_t type_id, const Value& value, std::size_t& leaf,
                  std::vector<ir::Src>& words) {
  const Type& type = t.module.type(type_id);
  switch (type.kind) {
    case Type::Kind::kBool:
    case Type::Kind::kInt:
    case Type::Kind::kFloat:
    case Type::Kind::kVector: {
      if (leaf + type.leaves > value.leaves.size()) return false;
      const std::uint32_t count = components(t, value.leaves[leaf]);
      for (std::uint8_t c = 0; c < count; ++c)
        for (std::uint32_t part = 0; part < type.leaves; ++part) words.push_back(splat(value.leaves[leaf + part], c));
      leaf += type.leaves;
      return true;
    }
    case Type::Kind::kMatrix:
    case Type::Kind::kArray:
      for (std::uint32_t i = 0; i < type.count; ++i)
        if (!append_words(t, type.element, value, leaf, words)) return false;
      return true;
    case Type::Kind::kStruct:
      for (const std::uint32_t member : type.members)
        if (!append_words(t, member, value, leaf, words)) return false;
      return true;
    default:
      leaf += type.leaves;
      return true;
  }
}

struct Target {
  std::uint32_t cell = 0;
  std::vector<std::array<std::uint32_t, 2>> steps;
  std::vector<ir::Src> indices;
};

void add_step(Target& target, const Step& step, std::uint32_t cells, std::uint32_t count) {
  if (!step.dynamic) {
    target.cell += step.index * cells;
    return;
  }
  target.steps.push_back({cells, count});
  target.indices.push_back(whole(step.value));
}

/// Follows the path of a pointer; kNoCell: it leads to nothing that is shown.
Target find_target(Translator& t, const Pointer& pointer) {
  Target target;
  target.cell = cells_of_local(t, pointer.local);
  if (target.cell == kNoCell) return target;
  const SourceVariables& tables = t.debugging->tables;
  std::uint32_t number = t.debugging->types.number(t.locals[pointer.local].type);
  const auto follow = [&](const Step& step) {
    const SourceType& type = tables.types[number];
    if (type.kind == SourceType::Kind::kStruct) {
      if (step.index >= type.members.size()) throw Failure("operand does not fit its type");
      for (std::uint32_t i = 0; i < step.index; ++i) target.cell += tables.types[type.members[i].type].cells;
      number = type.members[step.index].type;
      return;
    }
    add_step(target, step, tables.types[type.element].cells, type.count);
    number = type.element;
  };
  for (const Step& step : pointer.path) follow(step);
  if (pointer.component) follow(*pointer.component);
  return target;
}

void emit_assignments(Translator& t, const Target& target, std::span<const ir::Src> words) {
  for (std::size_t first = 0; first < words.size(); first += kMaxWordsOfProbe) {
    const auto part = words.subspan(first, std::min<std::size_t>(words.size() - first, kMaxWordsOfProbe));
    Probe probe;
    probe.kind = Probe::Kind::kAssign;
    probe.first_cell = target.cell + static_cast<std::uint32_t>(first);
    probe.cells = static_cast<std::uint32_t>(part.size());
    probe.steps = target.steps;
    std::vector<ir::Src> operands = target.indices;
    operands.insert(operands.end(), part.begin(), part.end());
    emit_probe(t, std::move(probe), std::move(operands));
  }
}

void assign(Translator& t, const Target& target, const Value& value) {
  if (target.cell == kNoCell) return;
  std::vector<ir::Src> words;
  std::size_t leaf = 0;
  if (append_words(t, value.type, value, leaf, words)) emit_assignments(t, target, words);
}

Debugging::Declared name_of(const Translator& t, std::uint32_t id) {
  const auto declared = t.debugging->declared.find(id);
  if (declared != t.debugging->declared.end() && !declared->second.name.empty()) return declared->second;
  // What a compiler makes besides the variables that it declares.
  if (!t.debugging->declared.empty()) return {};
  return {t.debugging->types.name(id), 0};
}

/// A row for a variable of the running function instance, unless nobody has named it.
void add_row(Translator& t, Debugging::Declared name, std::uint32_t type, std::uint32_t cell, std::uint32_t scope) {
  if (name.name.empty() || cell == kNoCell) return;
  SourceVariable row;
  row.name = std::move(name.name);
  row.line = name.line;
  row.type = type;
  row.scope = scope;
  row.first_cell = cell;
  t.debugging->tables.variables.push_back(std::move(row));
}

/// A value under a name: what has no memory.
void show_value(Translator& t, Debugging::Declared name, std::uint32_t id, const Value& value, std::uint32_t scope) {
  Debugging& debugging = *t.debugging;
  const auto [at, added] = debugging.values.try_emplace({id, scope}, kNoCell);
  if (added) {
    const std::uint32_t type = debugging.types.number(value.type);
    at->second = take_cells(debugging, debugging.tables.types[type].cells);
    add_row(t, std::move(name), type, at->second, scope);
  }
  assign(t, {at->second, {}, {}}, value);
}

/// Variables outside of functions, as far as the shader uses them.
void add_global(Translator& t, const Inst& variable, const Pointer& pointer) {
  Debugging& debugging = *t.debugging;
  SourceVariable row;
  row.name = debugging.types.name(variable.result);
  if (row.name.empty()) row.name = '%' + std::to_string(variable.result);
  row.type = debugging.types.number(pointer.type);
  switch (pointer.kind) {
    case Pointer::Kind::kLocal:
      row.first_cell = cells_of_local(t, pointer.local);
      if (row.first_cell == kNoCell) return;
      break;
    case Pointer::Kind::kUniform:
    case Pointer::Kind::kStorage:
      row.memory = SourceVariable::Memory::kBuffer;
      row.set = pointer.binding.set;
      row.slot = pointer.binding.slot;
      if (pointer.descriptor_array) {
        row.descriptors = pointer.binding.count;
        row.type = debugging.types.number(t.module.type(pointer.type).element);
      }
      break;
    case Pointer::Kind::kPush:
      row.memory = SourceVariable::Memory::kPush;
      break;
    case Pointer::Kind::kShared:
      if (pointer.stage) return;
      row.memory = SourceVariable::Memory::kShared;
      row.offset = pointer.constant_offset;
      row.word_layout = pointer.word_layout();
      break;
    default:
      row.memory = SourceVariable::Memory::kOpaque;
      if (pointer.kind != Pointer::Kind::kDescriptor) break;
      row.set = pointer.binding.set;
      row.slot = pointer.binding.slot;
      row.descriptors = pointer.descriptor_array ? pointer.binding.count : 0;
      break;
  }
  debugging.tables.variables.push_back(std::move(row));
}

/// Rows for the variables that can have homes, by the number of the local so far (resolve_arrays()).
void add_homes(Translator& t) {
  for (const auto& [local, cell] : t.debugging->cells) {
    if (cell == kNoCell || t.locals[local].storage == spv::StorageClass::Input) continue;
    Probe home;
    home.kind = Probe::Kind::kAssign;
    home.first_cell = cell;
    home.cells = t.debugging->tables.types[t.debugging->types.number(t.locals[local].type)].cells;
    home.number = local + 1;
    t.function.probes.push_back(std::move(home));
  }
}

}  // namespace

std::shared_ptr<Debugging> begin_debugging(const Module& module, const SourceInfo& sources) {
  auto debugging = std::make_shared<Debugging>(module);
  read_declarations(module, *debugging);
  const std::vector<SourceFile>& files = sources.files;
  debugging->ids = !files.empty() && files.back().name.ends_with(".spvasm");
  return debugging;
}

void end_debugging(Translator& t) {
  if (!t.debugging) return;
  for (const std::uint32_t index : t.module.globals) {
    const Inst& variable = t.module.code[index];
    if (const auto pointer = t.pointers.find(variable.result); pointer != t.pointers.end())
      add_global(t, variable, pointer->second);
  }
  // An interest in rehearsals, of what is a rehearsal: nothing else than the debugger sees its results.
  if (t.interest.rehearsal) add_homes(t);
  t.sources.variables = std::make_shared<const SourceVariables>(std::move(t.debugging->tables));
  t.debugging.reset();
}

void begin_lines(Translator& t) {
  if (t.debugging) t.debugging->last = {};
}

void step_to(Translator& t, const Inst& inst) {
  if (!t.debugging || inst.origin.place == 0 || !is_line(t, inst)) return;
  const Debugging::Line line = line_of(t, inst);
  if (line == t.debugging->last) return;
  t.debugging->last = line;
  emit_step(t, StepKind::kLine);
}

void step_back(Translator& t, const Inst& call) {
  if (!t.debugging) return;
  show_result(t, call);
  if (call.origin.place == 0) return;
  t.debugging->last = line_of(t, call);
  t.debugging->entering = false;
  emit_step(t, StepKind::kReturn);
}

void enter_function(Translator& t, const Function& function) {
  if (!t.debugging) return;
  t.debugging->entering = true;
  const std::uint32_t scope = scope_of(t, function);
  for (const std::uint32_t param : function.params) {
    Debugging::Declared name = name_of(t, param);
    if (const auto value = t.values.find(param); value != t.values.end()) {
      show_value(t, std::move(name), param, value->second, scope);
    } else if (const auto pointer = t.pointers.find(param);
               pointer != t.pointers.end() && pointer->second.kind == Pointer::Kind::kLocal) {
      const Target target = find_target(t, pointer->second);
      if (target.steps.empty())
        add_row(t, std::move(name), t.debugging->types.number(pointer->second.type), target.cell, scope);
    }
  }
}

void show_variable(Translator& t, const Pointer& pointer, std::uint32_t id) {
  if (!t.debugging) return;
  add_row(t, name_of(t, id), t.debugging->types.number(pointer.type), cells_of_local(t, pointer.local),
          scope_of(t, *t.frames.back().function));
}

void show_assignment(Translator& t, const Pointer& pointer, const Value& value) {
  if (t.debugging && pointer.kind == Pointer::Kind::kLocal) assign(t, find_target(t, pointer), value);
}

void show_input(Translator& t, const Pointer& pointer, const Value& value) {
  if (!t.debugging || pointer.kind != Pointer::Kind::kLocal) return;
  if (t.locals[pointer.local].storage == spv::StorageClass::Input) show_assignment(t, pointer, value);
}

void show_result(Translator& t, const Inst& inst) {
  if (!t.debugging || !t.debugging->ids || inst.result == 0) return;
  const auto value = t.values.find(inst.result);
  if (value == t.values.end()) return;
  show_value(t, {t.debugging->types.id_name(inst.result), 0}, inst.result, value->second, 0);
}

void show_debug_value(Translator& t, const Inst& inst) {
  if (!t.debugging || inst.operand(1) != NonSemanticShaderDebugInfo100DebugValue) return;
  if (inst.has(kFirstArgument + value::kIndexes)) return;
  const std::uint32_t variable = argument(inst, value::kLocalVariable), id = argument(inst, value::kValue);
  const auto local = t.debugging->locals.find(variable);
  if (local == t.debugging->locals.end() || t.images.count(id) != 0 || t.pointers.count(id) != 0) return;
  if (t.values.count(id) == 0 && t.module.constant(id) == nullptr) return;
  show_value(t, local->second, variable, value_of(t, id), t.sources.place(inlined_place(t, inst.origin.place)).scope);
}

void show_break(Translator& t, const Inst& inst) {
  if (t.debugging && string_at(t.module.def(inst.operand(0)), 0) == "NonSemantic.DebugBreak")
    emit_step(t, StepKind::kBreak);
}

}  // namespace vitrine::spirv::front
