// Bytes of device memory.
#pragma once

#include <cstdint>
#include <vector>

namespace vitrine::glass::sync {

struct Range {
  std::uintptr_t first = 0, end = 0;
  bool operator==(const Range&) const = default;
};

/// Adds a range behind those that are there; what adjoins the last one becomes part of it.
inline void append(std::vector<Range>& ranges, std::uintptr_t first, std::uintptr_t end) {
  if (first >= end) return;
  if (!ranges.empty() && ranges.back().end == first)
    ranges.back().end = end;
  else
    ranges.push_back({first, end});
}

}  // namespace vitrine::glass::sync
