// Small things about text that the debugger's files share.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace vitrine::glass::debug {

inline std::string quoted(std::string_view text) {
  std::string result(1, '\'');
  return result.append(text).append(1, '\'');
}

/// Without blanks at its ends.
inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

}  // namespace vitrine::glass::debug
