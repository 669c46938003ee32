// Where instructions come from, in the words of the person who wrote the shader: files, functions, lines, and the calls
// through which an inlined function was reached. Read from the module's debug instructions (spirv/front/), shared by
// everything that is made of it. Number 0 of every table stands for "unknown".
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vitrine::spirv {

struct SourceFile {
  std::string name;  ///< as the module says it; empty: unknown
  std::string text;  ///< empty: not in the module
};

struct SourceFunction {
  std::string name;
  std::uint32_t file = 0, line = 0;  ///< where it begins
};

/// One instance of a function: every call that is inlined makes one.
struct SourceScope {
  std::uint32_t function = 0;
  std::uint32_t call = 0;  ///< place of the call; 0: the entry point
};

struct SourcePlace {
  std::uint32_t file = 0, line = 0, column = 0;  ///< lines and columns count from 1; 0: unknown
  std::uint32_t scope = 0;
  bool operator==(const SourcePlace&) const = default;
};

struct SourceVariables;  // spirv/source_variables.h

struct SourceInfo {
  std::vector<SourceFile> files{1};
  std::vector<SourceFunction> functions{1};
  std::vector<SourceScope> scopes{1};
  std::vector<SourcePlace> places{1};
  std::shared_ptr<const SourceVariables> variables;  ///< null: nobody asked for them (Interest::debug)

  const SourcePlace& place(std::uint32_t number) const { return places[number < places.size() ? number : 0]; }
  /// "file:line:column" as far as it is known; empty: nothing is.
  std::string text(std::uint32_t place) const;
  /// The same with the function and the calls that lead there: "a.comp:5 in f, called at a.comp:9 in main".
  std::string stack(std::uint32_t place) const;
};

}  // namespace vitrine::spirv
