// What buffers of a bug hold.
#pragma once

#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

/// The bytes of a buffer before the command, or behind it; what the bug does not know of it is zero.
Bytes contents_of(const Bug& bug, const Buffer& buffer, bool after);

}  // namespace vitrine::glass::bug
