// NonSemantic.Shader.DebugInfo.100: lines, lexical scopes and inlined calls.
#include "spirv/front/debug_info.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

/// Lexical scopes within each other, and calls within each other.
constexpr std::uint32_t kMaxNesting = 256, kMaxCalls = 64;
/// Operands of an OpExtInst before its arguments: the set, the instruction.
constexpr std::uint32_t kFirstArgument = 2;

namespace source {
enum : std::uint32_t { kFile };
}
namespace line_of {
enum : std::uint32_t { kSource, kLine, kLineEnd, kColumn };
}
namespace function_argument {
enum : std::uint32_t { kName, kType, kSource, kLine };
}
namespace block {
enum : std::uint32_t { kSource, kLine, kColumn, kParent };
}
namespace discriminator {
enum : std::uint32_t { kSource, kDiscriminator, kParent };
}
namespace inlined {
enum : std::uint32_t { kLine, kScope, kInlined };
}
namespace definition {
enum : std::uint32_t { kDebugFunction, kFunction };
}

}  // namespace

DebugInfo::DebugInfo(const Module& module, SourceTables& tables) : module_(module), tables_(tables) {
  const Inst* line = nullptr;
  const Inst* function_line = nullptr;
  std::uint32_t function = 0;
  for (const Inst& inst : module.code) switch (inst.op) {
      case Op::OpExtInstImport:
        if (string_at(inst, 0) == "NonSemantic.Shader.DebugInfo.100") sets_.insert(inst.result);
        break;
      case Op::OpLine:
        line = &inst;
        break;
      case Op::OpFunction:
        if (sets_.empty()) return;
        function = inst.result;
        function_line = std::exchange(line, nullptr);
        break;
      case Op::OpExtInst:
        if (instruction(inst) == NonSemanticShaderDebugInfo100DebugFunctionDefinition)
          take_definition(inst, function_line, function);
        break;
      default:
        break;
    }
}

void DebugInfo::take_definition(const Inst& inst, const Inst* line, std::uint32_t op_function) {
  const std::uint32_t debug_function = argument(inst, definition::kDebugFunction);
  definitions_.try_emplace(op_function, debug_function);
  if (line != nullptr) lines_.try_emplace(debug_function, line);
}

std::optional<NonSemanticShaderDebugInfo100Instructions> DebugInfo::instruction(const Inst& inst) const {
  if (sets_.empty() || inst.op != Op::OpExtInst || !inst.has(1) || sets_.count(inst.operand(0)) == 0) return {};
  // Modules may say any number, an enumeration may not.
  if (inst.operand(1) > NonSemanticShaderDebugInfo100InstructionsMax) return {};
  return static_cast<Kind>(inst.operand(1));
}

std::uint32_t DebugInfo::argument(const Inst& inst, std::uint32_t index) {
  return inst.has(kFirstArgument + index) ? inst.operand(kFirstArgument + index) : 0;
}

const Inst* DebugInfo::find(std::uint32_t id, Kind kind) const {
  const auto found = module_.definition.find(id);
  if (found == module_.definition.end()) return nullptr;
  const Inst& inst = module_.code[found->second];
  return instruction(inst) == kind ? &inst : nullptr;
}

/// Lines and columns are ids of 32-bit constants.
std::uint32_t DebugInfo::number(std::uint32_t id) const {
  const auto found = module_.definition.find(id);
  if (found == module_.definition.end()) return 0;
  const Inst& inst = module_.code[found->second];
  return inst.op == Op::OpConstant && inst.count() == 1 ? inst.operand(0) : 0;
}

std::uint32_t DebugInfo::file(std::uint32_t debug_source) {
  const Inst* inst = find(debug_source, NonSemanticShaderDebugInfo100DebugSource);
  return inst == nullptr ? 0 : tables_.file(argument(*inst, source::kFile));
}

SourcePlace DebugInfo::line(const Inst& inst) {
  return {file(argument(inst, line_of::kSource)), number(argument(inst, line_of::kLine)),
          number(argument(inst, line_of::kColumn)), 0};
}

/// DebugFunction around a lexical scope; 0: there is none.
std::uint32_t DebugInfo::enclosing_function(std::uint32_t scope) const {
  for (std::uint32_t i = 0; i < kMaxNesting; ++i) {
    if (find(scope, NonSemanticShaderDebugInfo100DebugFunction) != nullptr) return scope;
    if (const Inst* inst = find(scope, NonSemanticShaderDebugInfo100DebugLexicalBlock); inst != nullptr)
      scope = argument(*inst, block::kParent);
    else if (inst = find(scope, NonSemanticShaderDebugInfo100DebugLexicalBlockDiscriminator); inst != nullptr)
      scope = argument(*inst, discriminator::kParent);
    else
      return 0;
  }
  return 0;
}

std::uint32_t DebugInfo::function(std::uint32_t debug_function) {
  const Inst* inst = find(debug_function, NonSemanticShaderDebugInfo100DebugFunction);
  if (inst == nullptr) return 0;
  const auto [at, added] = functions_.try_emplace(debug_function, 0);
  if (!added) return at->second;
  SourceFunction function;
  function.name = tables_.string(argument(*inst, function_argument::kName));
  function.file = file(argument(*inst, function_argument::kSource));
  function.line = number(argument(*inst, function_argument::kLine));
  // glslang leaves the line out and tells it in front of the OpFunction.
  const auto line = lines_.find(debug_function);
  if (function.line == 0 && line != lines_.end() && line->second->has(1)) function.line = line->second->operand(1);
  return at->second = tables_.function(std::move(function));
}

std::uint32_t DebugInfo::function_of(std::uint32_t op_function) {
  const auto found = definitions_.find(op_function);
  return found == definitions_.end() ? 0 : function(found->second);
}

std::uint32_t DebugInfo::call(std::uint32_t inlined_at, std::uint32_t depth) {
  const Inst* inst = find(inlined_at, NonSemanticShaderDebugInfo100DebugInlinedAt);
  if (inst == nullptr || depth > kMaxCalls) return 0;
  const std::uint32_t scope = argument(*inst, inlined::kScope);
  SourcePlace place;
  place.line = number(argument(*inst, inlined::kLine));
  place.scope = scope_at(scope, argument(*inst, inlined::kInlined), depth);
  // The call does not name its file: it is that of the scope that it stands in.
  if (const Inst* at = find(scope, NonSemanticShaderDebugInfo100DebugLexicalBlock); at != nullptr)
    place.file = file(argument(*at, block::kSource));
  else if (at = find(scope, NonSemanticShaderDebugInfo100DebugFunction); at != nullptr)
    place.file = file(argument(*at, function_argument::kSource));
  return tables_.call(place);
}

std::uint32_t DebugInfo::scope_at(std::uint32_t scope, std::uint32_t inlined_at, std::uint32_t depth) {
  // A scope that is asked for while it is being made is part of a circle: unknown.
  const auto [at, added] = scopes_.try_emplace({scope, inlined_at}, 0);
  if (!added) return at->second;
  const SourceScope made{function(enclosing_function(scope)), call(inlined_at, depth + 1)};
  const std::uint32_t number = made.function == 0 && made.call == 0 ? 0 : tables_.scope(made);
  return scopes_[{scope, inlined_at}] = number;
}

}  // namespace vitrine::spirv::front
