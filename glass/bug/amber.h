// A bug file as AmberScript (github.com/google/amber), for any driver that Amber runs on.
#pragma once

#include <string>

#include "base/result.h"
#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

/// The script, with data and what is expected behind the command; or what AmberScript has no words for.
base::Result<std::string> to_amber(const Bug& bug);

}  // namespace vitrine::glass::bug
