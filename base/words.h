// Lists in the environment: words separated by commas.
#pragma once

#include <algorithm>
#include <string_view>

namespace vitrine::base {

/// Calls f(word) for each word of the list, in order; not for empty ones.
template <class F>
void for_each_word(std::string_view list, const F& f) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    if (comma != 0) f(list.substr(0, comma));
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
}

/// Whether the list has the word.
inline bool has_word(std::string_view list, std::string_view word) {
  bool found = false;
  for_each_word(list, [&](std::string_view one) { found |= one == word; });
  return found;
}

}  // namespace vitrine::base
