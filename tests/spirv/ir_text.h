// Text to ir::Function and back, so that a test of a step is a few lines in and a few lines out.
//
// The text is what ir::dump() prints, with less to write: values have any name (%sum), ":1" is left out, %a to %h are
// inputs 0 to 7, scalar constants stand where they are read (floats with a point, integers, true, false), and so may
// operations, with their operands in brackets.
//
//   If FLt(%a, 1.0) -> %r
//     Yield FMul(%a, 2.0)
//   Else
//     Yield %a
//   StoreOutput %r
//
// "Loop params %i init 0 -> %n" has its body below it, then "Continuing %next" and that. "@64" behind an operation's
// name is its width, "!" makes it exact. "Arrays 4 8" on the first line: elements of local arrays 0 and 1.
#pragma once

#include <string>
#include <string_view>

#include "spirv/ir.h"

namespace vitrine::spirv::test {

/// Throws std::runtime_error with the line that it does not understand.
ir::Function parse_ir(std::string_view text);

/// ir::dump() in that form; values are numbered in the order in which they appear.
std::string text_of(const ir::Function& function);

}  // namespace vitrine::spirv::test
