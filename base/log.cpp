// Diagnostics to stderr, gated by VITRINE_LOG.
#include "base/log.h"

#include <cstdio>
#include <cstdlib>

namespace vitrine::base {
namespace {

/// Topics that slow shaders down or print a lot are not meant by "all".
bool is_only_by_name(std::string_view topic) {
  return topic == "shader-profile" || topic == "ir" || topic == "validator";
}

std::string_view requested_topics() {
  const char* value = std::getenv("VITRINE_LOG");
  return value ? std::string_view(value) : std::string_view();
}

}  // namespace

bool log_enabled(std::string_view topic) {
  static const std::string_view topics = requested_topics();
  std::string_view rest = topics;
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    if (item == topic || (item == "all" && !is_only_by_name(topic))) return true;
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  return false;
}

void log(std::string_view topic, std::string_view message) {
  if (!log_enabled(topic)) return;
  std::fprintf(stderr, "vitrine: %.*s: %.*s\n", static_cast<int>(topic.size()), topic.data(),
               static_cast<int>(message.size()), message.data());
}

void log_defect(const char* kind, const char* what, const char* file, int line) {
  if (!log_enabled("defect")) return;
  std::fprintf(stderr, "vitrine: %s: %s (%s:%d)\n", kind, what, file, line);
}

void assertion_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "vitrine: assertion failed: %s (%s:%d)\n", condition, file, line);
  __builtin_trap();
}

}  // namespace vitrine::base
