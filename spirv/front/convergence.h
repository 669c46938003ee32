// Where the branches of a selection meet before its merge block. Internal to front/.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "spirv/front/module.h"

namespace vitrine::spirv::front {

/// Label of a selection's header -> label of the block that joins several of its branches and that every path to its
/// merge block passes.
using MeetingPoints = std::unordered_map<std::uint32_t, std::uint32_t>;

/// Labels of the blocks that may follow, in the order of the terminator's operands.
std::vector<std::uint32_t> successors_of(const Module& module, const Block& block);

/// `entry`: label of a function's first block.
MeetingPoints find_meeting_points(const Module& module, std::uint32_t entry);

}  // namespace vitrine::spirv::front
