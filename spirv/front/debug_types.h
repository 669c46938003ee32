// The types of a module as a person sees them, and the names of its ids.
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "spirv/front/module.h"
#include "spirv/source_variables.h"

namespace vitrine::spirv::front {

class DebugTypes {
 public:
  /// Rows go to `tables`, which lives as long.
  DebugTypes(const Module& module, SourceVariables& tables);

  /// SourceVariables::types of a type of the module; made when first asked for.
  std::uint32_t number(std::uint32_t type_id);
  /// As OpName says it, else "%12".
  std::string id_name(std::uint32_t id) const;
  /// As OpName says it; empty: it does not.
  std::string name(std::uint32_t id) const;
  /// As OpMemberName says it, else "_2".
  std::string member_name(std::uint32_t type_id, std::uint32_t member) const;

 private:
  SourceType make(std::uint32_t type_id);
  void add_members(std::uint32_t type_id, SourceType& type);

  const Module& module_;
  SourceVariables& tables_;
  std::unordered_map<std::uint32_t, std::string> names_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> member_names_;
  std::unordered_map<std::uint32_t, std::uint32_t> numbers_;
};

}  // namespace vitrine::spirv::front
