// Builds the tables of a SourceInfo: equal rows are one, strings come from the module, and what it repeats without end
// is cut.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "spirv/front/module.h"

namespace vitrine::spirv::front {

class SourceTables {
 public:
  /// Rows go to module.sources.
  explicit SourceTables(Module& module);

  /// Text of an OpString. Empty: it is none, or the texts asked for are longer than several modules.
  std::string string(std::uint32_t id);
  /// The file that an OpString names; 0: it is none.
  std::uint32_t file(std::uint32_t id);
  std::uint32_t function(SourceFunction function);
  std::uint32_t scope(SourceScope scope);
  /// 0 if the line is unknown or beyond all reason.
  std::uint32_t place(SourcePlace place);
  /// The same, but never 0: what stands there is a call.
  std::uint32_t call(SourcePlace place);

  /// The text of a file, unless it is longer than what is left of the module.
  void append_text(std::uint32_t file, std::string_view text);

 private:
  const Module& module_;
  SourceInfo& sources_;
  std::size_t left_ = 0;  ///< bytes of text that may still be copied
  std::unordered_map<std::uint32_t, std::uint32_t> files_by_id_;
  std::unordered_map<std::string, std::uint32_t> files_by_name_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> scopes_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> places_;
};

}  // namespace vitrine::spirv::front
