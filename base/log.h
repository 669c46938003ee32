// Diagnostics to stderr, only when VITRINE_LOG asks (a comma-separated list of topics: error, defect, shader, all...).
// Never stdout. Application-visible messages go through VK_EXT_debug_utils in icd/.
#pragma once

#include <string_view>

namespace vitrine::base {

/// True when VITRINE_LOG names `topic`, or "all" ("shader-profile" and "ir" must be named). Read once per process.
bool log_enabled(std::string_view topic);

/// Writes "vitrine: <topic>: <message>\n" to stderr when the topic is enabled. Thread-safe.
void log(std::string_view topic, std::string_view message);

/// Reports a line that should not have been reached.
void log_defect(const char* kind, const char* what, const char* file, int line);

/// Debug builds only: reports and traps.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace vitrine::base
