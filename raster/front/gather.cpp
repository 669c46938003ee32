// Index de-duplication: a table by distance from the lowest index, or a hash table.
#include "raster/front/gather.h"

#include <algorithm>
#include <cstring>

#include "raster/front/assembly.h"

namespace vitrine::raster {

namespace {

constexpr std::uint32_t kHashSize = 4096;
constexpr std::uint64_t kEmptyKey = ~std::uint64_t{0};
constexpr std::uint16_t kNoSlot = 0xffff;

/// The slot of (index, instance), a new one if it was not seen in this chunk. The table is at most half full: chunks
/// that are larger skip it.
std::uint32_t find_slot(VertexScratch& s, std::uint32_t index, std::uint32_t instance, std::uint32_t& count) {
  const std::uint64_t key = std::uint64_t{instance} << 32 | index;
  std::uint32_t at = (index * 0x9e3779b1u + instance * 0x85ebca6bu) >> 20;
  for (;; at = (at + 1) & (kHashSize - 1)) {
    if (s.hash_key[at] == key) return s.hash_slot[at];
    if (s.hash_key[at] == kEmptyKey) break;
  }
  s.hash_key[at] = key;
  s.hash_slot[at] = static_cast<std::uint16_t>(count);
  s.vertex[count] = index;
  s.instance[count] = instance;
  return count++;
}

/// The index buffer of a draw; positions beyond its end read 0.
template <class T>
struct Indices {
  const std::byte* data;
  std::uint64_t count;
  std::uint32_t offset;

  std::uint32_t operator[](std::uint64_t position) const {
    T value = 0;
    if (position < count) std::memcpy(&value, data + position * sizeof(T), sizeof(T));
    return value + offset;
  }

  /// Extends a range by the indices at `positions` positions from `first` on.
  void extend(std::uint64_t first, std::uint32_t positions, std::uint32_t& lowest, std::uint32_t& highest) const {
    std::uint32_t low = lowest, high = highest;
    for_each(first, positions, [&](std::uint32_t index) {
      low = std::min(low, index);
      high = std::max(high, index);
    });
    lowest = low;
    highest = high;
  }

  /// Calls f(index) for these positions.
  template <class F>
  void for_each(std::uint64_t first, std::uint32_t positions, F&& f) const {
    if (first + positions > count) {
      for (std::uint32_t i = 0; i < positions; ++i) f((*this)[first + i]);
      return;
    }
    const std::byte* from = data + first * sizeof(T);
    for (std::uint32_t i = 0; i < positions; ++i) {  // without a check for each, so that it may become SIMD code
      T value;
      std::memcpy(&value, from + i * sizeof(T), sizeof(T));
      f(value + offset);
    }
  }
};

struct Gather {
  const Chunk& chunk;
  VertexScratch& scratch;
  std::uint32_t entry = 0, count = 0;

  /// One slot per position.
  void add_linear() {
    const DrawCall& call = chunk.draw->call;
    for_each_position([&](const Run& run, std::uint32_t position) { add_new(call.first + run.start + position, run); });
  }

  /// One slot per distinct (index, instance), unless the chunk is too large for the tables.
  template <class T>
  void add_indexed(std::uint32_t positions) {
    const DrawCall& call = chunk.draw->call;
    const Indices<T> indices{call.index_data, call.index_bytes / sizeof(T),
                             static_cast<std::uint32_t>(call.vertex_offset)};
    const auto each = [&](auto&& add) {
      for_each_position([&](const Run& run, std::uint32_t position) {
        add(indices[std::uint64_t{call.first} + run.start + position], run);
      });
    };
    if (positions > kHashSize / 2) return each([&](std::uint32_t index, const Run& run) { add_new(index, run); });
    std::uint32_t lowest = ~0u, highest = 0;
    const TopologyShape& shape = chunk.draw->plan->shape;
    for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
      const RunSpan span = run_span(shape, chunk.runs[r]);
      const std::uint64_t first = std::uint64_t{call.first} + chunk.runs[r].start;
      if (span.center) indices.extend(first, 1, lowest, highest);
      indices.extend(first + span.low, span.high - span.low, lowest, highest);
    }
    const bool one_instance = chunk.runs[0].instance == chunk.runs[chunk.run_count - 1].instance;
    scratch.hash_slot.resize(kHashSize);
    if (one_instance && highest - lowest < kHashSize) {
      std::fill_n(scratch.hash_slot.begin(), highest - lowest + 1, kNoSlot);
      return add_in_range(indices, lowest);
    }
    scratch.hash_key.assign(kHashSize, kEmptyKey);
    each([&](std::uint32_t index, const Run& run) {
      scratch.slot[entry++] = static_cast<std::uint16_t>(find_slot(scratch, index, run.instance, count));
    });
  }

 private:
  template <class F>
  void for_each_position(F&& add) {
    const TopologyShape& shape = chunk.draw->plan->shape;
    for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
      const RunSpan span = run_span(shape, chunk.runs[r]);
      if (span.center) add(chunk.runs[r], 0);
      for (std::uint32_t p = span.low; p < span.high; ++p) add(chunk.runs[r], p);
    }
  }

  /// hash_slot is a table of the slots of all indices of the chunk, by distance from the lowest. Which indices are new
  /// nobody can predict: what is said of a vertex is said again, behind the last one, where it is an old one.
  template <class T>
  void add_in_range(const Indices<T>& indices, std::uint32_t lowest) {
    std::uint16_t *const table = scratch.hash_slot.data(), *to = scratch.slot.data();
    std::uint32_t* const vertex = scratch.vertex.data();
    std::uint32_t vertices = 0;
    const auto add = [&](std::uint32_t index) {
      std::uint16_t& place = table[index - lowest];
      const std::uint32_t fresh = place == kNoSlot ? 1 : 0;
      const auto slot = static_cast<std::uint16_t>(fresh != 0 ? vertices : place);
      place = slot;
      vertex[vertices] = index;
      *to++ = slot;
      vertices += fresh;
    };
    for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
      const RunSpan span = run_span(chunk.draw->plan->shape, chunk.runs[r]);
      const std::uint64_t first = std::uint64_t{chunk.draw->call.first} + chunk.runs[r].start;
      if (span.center) add(indices[first]);
      indices.for_each(first + span.low, span.high - span.low, add);
    }
    std::fill_n(scratch.instance.begin(), vertices, chunk.runs[0].instance);
    count = vertices;
  }

  void add_new(std::uint32_t index, const Run& run) {
    scratch.vertex[count] = index;
    scratch.instance[count] = run.instance;
    scratch.slot[entry++] = static_cast<std::uint16_t>(count++);
  }
};

}  // namespace

void reserve_vertices(VertexScratch& s, std::uint32_t count) {
  const std::size_t vertices = (count + base::kWaveWidth - 1) / base::kWaveWidth * base::kWaveWidth;
  if (s.vertex.size() >= vertices) return;
  s.vertex.resize(vertices);
  s.instance.resize(vertices);
  s.clip.resize(vertices * 4);
  s.clip_distance.resize(vertices * kMaxClipDistances);
  s.cull_distance.resize(vertices * kMaxClipDistances);
  s.layer.resize(vertices);
  s.viewport_index.resize(vertices);
  s.shading_rate.resize(vertices);
  s.code.resize(vertices);
  s.snapped.resize(vertices * 2);
}

std::uint32_t gather_vertices(const Chunk& chunk, VertexScratch& s) {
  const DrawCall& call = chunk.draw->call;
  const std::uint32_t positions = positions_of(chunk);
  if (s.slot.size() < positions) s.slot.resize(positions);
  reserve_vertices(s, positions);
  Gather gather{chunk, s};
  if (!call.index_data) {
    gather.add_linear();
    return gather.count;
  }
  if (call.index_type == VK_INDEX_TYPE_UINT32)
    gather.add_indexed<std::uint32_t>(positions);
  else if (call.index_type == VK_INDEX_TYPE_UINT16)
    gather.add_indexed<std::uint16_t>(positions);
  else
    gather.add_indexed<std::uint8_t>(positions);
  return gather.count;
}

}  // namespace vitrine::raster
