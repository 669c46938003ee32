// The functions that tools.def names.
#pragma once

#include <memory>

#include "glass/tool.h"

namespace vitrine::glass {

#define VITRINE_TOOL(name, make, effect) std::unique_ptr<Tool> make();
#include "glass/tools.def"
#undef VITRINE_TOOL

}  // namespace vitrine::glass
