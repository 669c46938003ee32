// Where to stop.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "glass/debug/expression.h"
#include "glass/debug/run.h"

namespace vitrine::glass::debug {

struct Breakpoint {
  enum class Kind : std::uint8_t {
    kLine,
    kFunction,
    kPixel,       ///< fragments of a pixel begin
    kVertex,      ///< a vertex begins, of any instance
    kWorkgroup,   ///< a workgroup begins
    kInvocation,  ///< an invocation of a compute shader begins
  } kind = Kind::kLine;
  int number = 0;
  std::string file;  ///< kLine; empty: any
  std::uint32_t line = 0;
  std::string function;
  std::array<std::uint32_t, 3> id{};
  std::string condition;                                   ///< empty: always
  std::optional<base::Result<Expression>> read_condition;  ///< once it has been asked for
  std::string hits_wanted;  ///< "5" and ">= 5": from the fifth on; "== 5"; "% 5": every fifth; empty: always
  std::string message;      ///< a log point: {expressions} are replaced; empty: it stops
  bool once = false;        ///< it is gone when it has stopped
  std::string owner;        ///< who has set it: requests replace their own
  std::uint64_t hits = 0;   ///< invocations that came by while the condition held
};

/// "a.comp:12 if x > 3", "12", "main", "pixel 3,7", "vertex 3", "workgroup 1,0,0", "invocation 5,0,0".
base::Result<Breakpoint> parse_breakpoint(std::string_view text);
std::string to_text(const Breakpoint& breakpoint);
/// Whether the hits so far are as many as are wanted.
bool wants_hit(const Breakpoint& breakpoint);

/// The steps of a shader at which it may stop: of a line that has none, those of the next one that has.
std::vector<std::uint32_t> steps_of(const Breakpoint& breakpoint, const Subject& subject);
/// Whether it is about where invocations begin, and about this one.
bool begins(const Breakpoint& breakpoint, const Run& run, std::size_t lane);
bool is_about_beginning(const Breakpoint& breakpoint);

}  // namespace vitrine::glass::debug
