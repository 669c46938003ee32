// Ranges and images of which every byte has been written: what shaders do there need not be looked at lane by lane. A
// thread remembers what it has found out, until anything is given up in that memory.
#pragma once

#include "glass/memory_shadow.h"
#include "texel/view.h"

namespace vitrine::glass {

/// Whether all bytes of a buffer's range are known to be written. False: perhaps not. `command`: on whose behalf; null:
/// nobody has named it. What is not all written is looked at again for other commands only.
bool is_all_written(const ShadowRegion& region, const std::byte* first, std::uint64_t bytes, const void* command);

/// The same for all texels of a view: levels, layers, samples, slices.
bool is_all_written(const ShadowRegion& region, const texel::ImageView& view, const void* command);

}  // namespace vitrine::glass
