// Memory of draws and their chunks (design.md section 6): rows of whole vectors, which may be loaded past their end.
#pragma once

#include "base/arena.h"

namespace vitrine::raster {

using Arena = base::Arena<base::ArenaShape{
    .alignment = 64, .slack = 128, .first_block = std::size_t{64} << 10, .largest_block = std::size_t{1} << 20}>;

}  // namespace vitrine::raster
