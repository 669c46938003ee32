// Passes over ir::Function that carry no arithmetic rule: used by the front end, the rewrites and tests.
#pragma once

#include <cstdint>
#include <string>

#include "spirv/ir.h"

namespace vitrine::spirv::ir {

/// Whether the text says behind each instruction which SPIR-V id and source line it comes from.
enum class Origins : std::uint8_t { kHide, kShow };

/// Text form for tests and logs: one instruction per line, nesting by indentation.
std::string dump(const Function& function, Origins origins = Origins::kHide);

/// Where values may be used: in the list that defines them and below; or also, between the rewrites, behind a loop if
/// they are visible at all of its ways out, and behind an If of which the other side leaves.
enum class Scope : std::uint8_t { kLists, kBehindExits };

/// Checks the invariants of ir.h (operands defined in an enclosing list before use, component counts, arities of
/// Yield / Break / Continue, jumps only at the end of a list). Empty: valid; otherwise what is wrong.
std::string verify(const Function& function, Scope scope = Scope::kLists);

/// Replaces uses of Mov / MovB / Vec by their sources, removes loop parameters and results that always carry one value.
void propagate_copies(Function& function);

/// Gathers what Yield, Break, Continue and Loop inits hand over into whole values of the width of their targets, which
/// is what lower() takes; passes in between may leave swizzles there.
void make_joins_whole(Function& function);

/// Whether loads of push constants and buffers outside of branches and loops stay though nothing uses them: rewrite()
/// lets later loads of the same words become those, as the reference does.
enum class Loads { kRemove, kKeep };

/// Removes instructions, loop parameters, results and inputs that nothing uses.
void remove_dead(Function& function, Loads loads = Loads::kRemove);

}  // namespace vitrine::spirv::ir
