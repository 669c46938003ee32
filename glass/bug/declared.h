// The descriptors that stages declare: read off the decorations and types of SPIR-V (SPIR-V 3.20), without a look at
// who uses them.
#pragma once

#include <map>
#include <span>
#include <utility>

#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

/// Types of descriptors by set and binding: a bit for each that some variable there may be, 1 << VkDescriptorType. Of
/// what is no descriptor that is known, none. Modules may be anything.
using Declared = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>;

void add_declared(std::span<const std::uint32_t> words, Declared& declared);
Declared declared_in(const Bug& bug);

}  // namespace vitrine::glass::bug
