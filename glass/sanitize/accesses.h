// Accesses to memory in words.
#pragma once

#include <algorithm>
#include <string>

#include "spirv/program.h"

namespace vitrine::glass::sanitize {

using spirv::Access;
using spirv::MemoryOp;

/// The bytes of one lane's access: [first, first + size) behind its address.
struct Extent {
  std::uint32_t first = ~0u, end = 0;
};

/// What a memory instruction touches behind its address, besides MemoryOp::added.
inline Extent extent_of(const MemoryOp& row, Access access) {
  const std::uint32_t bytes = row.element_bytes;
  if (access == Access::kAtomic) return {0, bytes};
  Extent extent;
  for (std::uint32_t c = 0; c < 4; ++c) {
    const bool used = access == Access::kLoad ? c < row.components && row.data[c] != spirv::kNoOperand
                                              : (row.write_mask >> c & 1) != 0;
    if (!used) continue;
    const std::uint32_t at = access == Access::kLoad ? row.at[c] : c * bytes;
    extent.first = std::min(extent.first, at);
    extent.end = std::max(extent.end, at + bytes);
  }
  return extent;
}

/// What one lane's access touches behind its address: one row per component.
struct Touched {
  std::uint32_t at[4] = {};
  std::uint32_t count = 0;
};

inline Touched touched_by(const MemoryOp& row, Access access) {
  Touched touched;
  const auto add = [&](std::uint32_t at) { touched.at[touched.count++] = row.added + at; };
  if (access == Access::kAtomic) {
    add(0);
  } else if (access == Access::kLoad) {
    for (std::uint32_t c = 0; c < row.components && c < 4; ++c)
      if (row.data[c] != spirv::kNoOperand) add(row.at[c]);
  } else {
    for (std::uint32_t c = 0; c < 4; ++c)
      if ((row.write_mask >> c & 1) != 0) add(c * row.element_bytes);
  }
  return touched;
}

inline bool reads(const MemoryOp& row, Access access) {
  if (access != Access::kAtomic) return access == Access::kLoad;
  return row.atomic != spirv::ir::AtomicOp::kStore && row.atomic != spirv::ir::AtomicOp::kExchange;
}

inline bool writes(const MemoryOp& row, Access access) {
  return access == Access::kStore || (access == Access::kAtomic && row.atomic != spirv::ir::AtomicOp::kLoad);
}

inline std::string bytes_text(std::uint64_t size, std::uint64_t offset) {
  std::string text = std::to_string(size);
  text += size == 1 ? " byte at offset " : " bytes at offset ";
  return text += std::to_string(offset);
}

inline const char* verb_of(Access access) {
  return access == Access::kLoad ? "load of " : access == Access::kStore ? "store of " : "atomic operation on ";
}

}  // namespace vitrine::glass::sanitize
