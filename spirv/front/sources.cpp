// OpLine, OpNoLine (SPIR-V 3.52.2, Debug Instructions) and what NonSemantic.Shader.DebugInfo.100 has for the same.
#include "spirv/front/sources.h"

#include <optional>
#include <unordered_map>

#include "spirv/front/debug_info.h"
#include "spirv/front/source_tables.h"
#include "spirv/front/source_text.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

/// Walks over a module's instructions in their order.
class Reader {
 public:
  Reader(Module& module, SourceTables& tables, DebugInfo& debug) : module_(module), tables_(tables), debug_(debug) {}

  void take(Inst& inst);
  /// The same, of an instruction that stands there whatever was in force before.
  void take_at(Inst& inst, const SourcePlace& line) {
    line_ = line;
    take(inst);
  }

 private:
  void enter(const Inst& function);
  bool take_marker(const Inst& inst);
  void take_debug(const Inst& inst, NonSemanticShaderDebugInfo100Instructions kind);
  std::uint32_t function_scope();
  const std::string& name_of(std::uint32_t function);

  Module& module_;
  SourceTables& tables_;
  DebugInfo& debug_;
  SourcePlace line_;                                                     ///< in force
  std::uint32_t scope_ = 0;                                              ///< of a DebugScope in force
  std::uint32_t function_ = 0;                                           ///< OpFunction
  std::uint32_t call_place_ = 0;                                         ///< of a call that no line is in force for
  SourcePlace function_line_;                                            ///< in force there
  std::optional<std::uint32_t> function_scope_;                          ///< made when asked for
  std::optional<std::unordered_map<std::uint32_t, std::string>> names_;  ///< of functions
};

void Reader::enter(const Inst& function) {
  function_ = function.result;
  function_line_ = line_;
  function_scope_.reset();
  scope_ = 0;
}

/// Name of an OpFunction: as OpName says it without the parameters that glslang adds, or of the entry point.
const std::string& Reader::name_of(std::uint32_t function) {
  if (!names_) {
    names_.emplace();
    for (const Inst& inst : module_.code) {
      if (inst.op == Op::OpFunction) break;
      if (inst.op == Op::OpEntryPoint && inst.has(1)) names_->try_emplace(inst.operand(1), string_at(inst, 2));
      if (inst.op != Op::OpName || !inst.has(0)) continue;
      const std::string name = string_at(inst, 1);
      if (!name.empty()) (*names_)[inst.operand(0)] = name.substr(0, name.find('('));
    }
  }
  std::string& name = (*names_)[function];
  if (name.empty()) name = '%' + std::to_string(function);
  return name;
}

/// Scope of instructions that no DebugScope is in force for.
std::uint32_t Reader::function_scope() {
  if (function_ == 0) return 0;
  if (function_scope_) return *function_scope_;
  std::uint32_t function = debug_.function_of(function_);
  if (function == 0) function = tables_.function({name_of(function_), function_line_.file, function_line_.line});
  function_scope_ = tables_.scope({function, 0});
  return *function_scope_;
}

void Reader::take_debug(const Inst& inst, NonSemanticShaderDebugInfo100Instructions kind) {
  switch (kind) {
    case NonSemanticShaderDebugInfo100DebugLine:
      line_ = debug_.line(inst);
      break;
    case NonSemanticShaderDebugInfo100DebugNoLine:
      line_ = {};
      break;
    case NonSemanticShaderDebugInfo100DebugScope:
      scope_ = debug_.scope(DebugInfo::argument(inst, 0), DebugInfo::argument(inst, 1));
      break;
    case NonSemanticShaderDebugInfo100DebugNoScope:
      scope_ = 0;
      break;
    default:
      break;
  }
}

/// Whether the instruction only says something of those behind it; then that is in force.
bool Reader::take_marker(const Inst& inst) {
  switch (inst.op) {
    case Op::OpLine:
      line_ =
          inst.has(2) ? SourcePlace{tables_.file(inst.operand(0)), inst.operand(1), inst.operand(2), 0} : SourcePlace{};
      return true;
    case Op::OpNoLine:
      line_ = {};
      return true;
    case Op::OpExtInst:
      if (const auto kind = debug_.instruction(inst)) return take_debug(inst, *kind), true;
      return false;
    default:
      return false;
  }
}

void Reader::take(Inst& inst) {
  if (take_marker(inst)) return;
  if (inst.op == Op::OpFunction) enter(inst);
  if (line_.line != 0) {
    line_.scope = scope_ != 0 ? scope_ : function_scope();
    inst.origin.place = tables_.place(line_);
    inst.line = module_.sources.place(inst.origin.place).line;
    call_place_ = inst.origin.place;
  } else if (inst.op == Op::OpFunctionCall) {
    // A line ends with its block, and glslang does not begin it again behind `? :` in arguments: what lies in front of
    // a call leads to what it calls.
    inst.origin.place = call_place_;
  }
  if (inst.op == Op::OpFunctionEnd) call_place_ = 0;
  if (!is_block_end(inst.op) && inst.op != Op::OpFunctionEnd) return;
  line_ = {};
  scope_ = 0;
  if (inst.op == Op::OpFunctionEnd) function_ = 0;
}

/// The disassembly is the source: instruction i has the i-th of `lines`.
void place_in_disassembly(Module& module, SourceTables& tables, DebugInfo& debug, SourceFile file,
                          const std::vector<std::uint32_t>& lines) {
  const auto number = static_cast<std::uint32_t>(module.sources.files.size());
  module.sources.files.push_back(std::move(file));
  Reader reader(module, tables, debug);
  for (std::size_t i = 0; i < module.code.size(); ++i) reader.take_at(module.code[i], {number, lines[i], 0, 0});
}

}  // namespace

void read_sources(Module& module, std::span<const std::uint32_t> words, const std::string& entry_point,
                  SourceTexts texts) {
  SourceTables tables(module);
  DebugInfo debug(module, tables);
  Reader reader(module, tables, debug);
  for (Inst& inst : module.code) reader.take(inst);
  if (texts == SourceTexts::kDrop) return;
  if (module.sources.places.size() > 1) return read_texts(module, tables, debug);
  const Disassembly text = disassemble(words, module.code.size());
  if (!text.lines.empty())
    place_in_disassembly(module, tables, debug, {entry_point + ".spvasm", text.text}, text.lines);
}

}  // namespace vitrine::spirv::front
