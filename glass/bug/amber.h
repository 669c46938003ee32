// A bug file as AmberScript (github.com/google/amber), for any driver that Amber runs on.
#pragma once

#include <string>

#include "base/result.h"
#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

/// The script, with data and what is expected behind the command; or what AmberScript has no words for.
base::Result<std::string> to_amber(const Bug& bug);

/// The bytes of a buffer before the command, or behind it; what the bug does not know of it is zero.
Bytes contents_of(const Bug& bug, const Buffer& buffer, bool after);

}  // namespace vitrine::glass::bug
