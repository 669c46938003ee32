// Where an invocation stands, with the calls that lead there, and which variables are visible there.
#pragma once

#include <string>
#include <vector>

#include "glass/debug/expression.h"
#include "glass/debug/value.h"

namespace vitrine::glass::debug {

struct CodeFrame {
  spirv::SourcePlace place;
  std::string function, file;
};

/// Innermost first; empty: the invocation has not begun.
std::vector<CodeFrame> frames_at(const Run& run, std::size_t lane);
/// "main at a.comp:12".
std::string to_text(const CodeFrame& frame);
/// Text of a line of a file of the module, empty: it is not there.
std::string line_text(const spirv::SourceInfo& sources, std::uint32_t file, std::uint32_t line);
/// "invocation (4, 0, 0)", "pixel (3, 7)", "vertex 3 of instance 0".
std::string invocation_text(const Run& run, std::size_t lane);

/// Variables that are visible in a frame.
class FrameNames : public Names {
 public:
  FrameNames(const Run& run, const CodeFrame* frame) : run_(run), frame_(frame) {}

  std::optional<Place> find(std::string_view name) const override;
  /// Of the function, in the order of their declarations; each name once.
  std::vector<const spirv::SourceVariable*> locals() const;
  std::vector<const spirv::SourceVariable*> globals() const;

 private:
  bool is_local(const spirv::SourceVariable& variable) const;

  const Run& run_;
  const CodeFrame* frame_;  ///< null: none, only what is visible everywhere
};

}  // namespace vitrine::glass::debug
