// What NonSemantic.Shader.DebugInfo.100 says of a module, asked by id. Nothing that it says is trusted: what does not
// exist, is of another kind or leads back to itself is unknown.
#pragma once

#include <spirv/unified1/NonSemanticShaderDebugInfo100.h>

#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "spirv/front/source_tables.h"

namespace vitrine::spirv::front {

class DebugInfo {
 public:
  /// `tables` outlives it.
  DebugInfo(const Module& module, SourceTables& tables);

  /// The instruction of the set that this is; nothing if it is of another set.
  std::optional<NonSemanticShaderDebugInfo100Instructions> instruction(const Inst& inst) const;
  /// Operands behind set and instruction; 0: absent.
  static std::uint32_t argument(const Inst& inst, std::uint32_t index);

  /// The place that a DebugLine names, without a scope.
  SourcePlace line(const Inst& debug_line);
  /// SourceInfo::scopes of a lexical scope, reached through the calls of a DebugInlinedAt (0: none).
  std::uint32_t scope(std::uint32_t scope, std::uint32_t inlined_at) { return scope_at(scope, inlined_at, 0); }
  /// The function of an OpFunction that has a DebugFunctionDefinition, else 0.
  std::uint32_t function_of(std::uint32_t op_function);
  /// File of a DebugSource, else 0.
  std::uint32_t file(std::uint32_t debug_source);

 private:
  using Kind = NonSemanticShaderDebugInfo100Instructions;

  void take_definition(const Inst& inst, const Inst* line, std::uint32_t op_function);
  const Inst* find(std::uint32_t id, Kind kind) const;
  std::uint32_t number(std::uint32_t id) const;
  std::uint32_t enclosing_function(std::uint32_t scope) const;
  std::uint32_t function(std::uint32_t debug_function);
  std::uint32_t scope_at(std::uint32_t scope, std::uint32_t inlined_at, std::uint32_t depth);
  std::uint32_t call(std::uint32_t inlined_at, std::uint32_t depth);

  const Module& module_;
  SourceTables& tables_;
  std::unordered_set<std::uint32_t> sets_;                        ///< ids of OpExtInstImport
  std::unordered_map<std::uint32_t, std::uint32_t> definitions_;  ///< OpFunction -> DebugFunction
  std::unordered_map<std::uint32_t, const Inst*> lines_;          ///< DebugFunction -> OpLine of its OpFunction
  std::unordered_map<std::uint32_t, std::uint32_t> functions_;    ///< DebugFunction -> SourceInfo::functions
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> scopes_;  ///< (scope, DebugInlinedAt)
};

}  // namespace vitrine::spirv::front
