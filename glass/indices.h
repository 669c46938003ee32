// Indices of a draw as fixed function reads them (Vulkan 1.3.239, Programmable Primitive Shading).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "raster/draw.h"

namespace vitrine::glass {

/// Of one index.
inline std::uint32_t index_bytes(const raster::DrawCall& call) {
  return call.index_type == VK_INDEX_TYPE_UINT32 ? 4 : call.index_type == VK_INDEX_TYPE_UINT16 ? 2 : 1;
}

template <class T>
std::uint32_t index_at(const raster::DrawCall& call, std::uint64_t position) {
  T index = 0;
  std::memcpy(&index, call.index_data + position * sizeof(T), sizeof(T));
  return index;
}

template <class T, class F>
void for_each_index(const raster::DrawCall& call, F&& f) {
  const std::uint64_t there = call.index_bytes / sizeof(T);
  const std::uint64_t end = std::min(std::uint64_t{call.first} + call.count, there);
  const bool restarts = call.state->primitive_restart;
  for (std::uint64_t p = call.first; p < end; ++p) {
    const std::uint32_t index = index_at<T>(call, p);
    if (!restarts || index != static_cast<T>(~T{0})) f(index + static_cast<std::uint32_t>(call.vertex_offset));
  }
}

/// Calls f(VertexIndex) for the indices of a draw that are there, but for those that restart a primitive.
template <class F>
void for_each_vertex(const raster::DrawCall& call, F&& f) {
  if (call.index_type == VK_INDEX_TYPE_UINT32) return for_each_index<std::uint32_t>(call, f);
  if (call.index_type == VK_INDEX_TYPE_UINT16) return for_each_index<std::uint16_t>(call, f);
  for_each_index<std::uint8_t>(call, f);
}

}  // namespace vitrine::glass
