// The four words for "not done" (design.md section 6) and the assertion of debug builds. None of them ever ends the
// host process in release: they log, and the caller returns the error value that follows.
#pragma once

#include "base/log.h"

/// Not claimed by the manifest: an application that gets here broke a rule of the API.
#define VITRINE_UNSUPPORTED(what) ::vitrine::base::log_defect("UNSUPPORTED", what, __FILE__, __LINE__)
/// Claimed but missing: a bug of ours.
#define VITRINE_UNIMPLEMENTED(what) ::vitrine::base::log_defect("UNIMPLEMENTED", what, __FILE__, __LINE__)
/// Our own reasoning is wrong if this line runs.
#define VITRINE_UNREACHABLE(what) ::vitrine::base::log_defect("UNREACHABLE", what, __FILE__, __LINE__)
/// Works, slowly. Expands to nothing; greppable.
#define VITRINE_UNOPTIMIZED(what) static_cast<void>(0)

#ifdef NDEBUG
#define VITRINE_ASSERT(condition) static_cast<void>(0)
#else
#define VITRINE_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::vitrine::base::assertion_failed(#condition, __FILE__, __LINE__))
#endif
