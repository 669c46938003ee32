// Local arrays that stayed in memory: element e of lane l lies at array_base + e*256 + l*4. Indices are clamped to the
// last element (lavapipe-shader-math.md section 10). Tables: arrays whose elements are known.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/exec/arrays.cpp"
#include <algorithm>

#include "base/simd.h"

#include <hwy/foreach_target.h>

#include "base/lane_math-inl.h"
#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::exec::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::uint32_t* element(Wave& wave, const MemoryOp& row, std::uint32_t index) {
  const std::uint32_t clamped = std::min(index + row.added, row.array_elements - 1);
  return reinterpret_cast<std::uint32_t*>(wave.arrays + row.array_base) + std::size_t{clamped} * base::kWaveWidth;
}

const Instruction* load_array_uniform(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::memcpy(reg(wave, i->dst).lane, element(wave, row, uniform_word(wave, i->src[0])), sizeof(base::WaveRegister));
  return i + 1;
}

/// Stores load(element, first lane) for every vector of elements that the lanes ask for.
template <class F>
HWY_INLINE void load_elements(Wave& wave, const Instruction* i, const MemoryOp& row, F&& load) {
  const hn::ScalableTag<std::uint32_t> d;
  std::uint32_t* to = reg(wave, i->dst).lane;
  const std::uint32_t* index = reg(wave, i->src[0]).lane;
  const auto added = hn::Set(d, row.added), last = hn::Set(d, row.array_elements - 1);
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(d))
    hn::Store(load(hn::Min(hn::Add(hn::Load(d, index + lane), added), last), lane), d, to + lane);
}

const Instruction* load_array_lanes(Wave& wave, const Instruction* i) {
  const hn::ScalableTag<std::uint32_t> d;
  const hn::RebindToSigned<decltype(d)> di;
  const MemoryOp& row = memory_op(wave, i);
  const auto* words = reinterpret_cast<const std::uint32_t*>(wave.arrays + row.array_base);
  load_elements(wave, i, row, [&](auto element, std::size_t lane) HWY_ATTR {
    static_assert(base::kWaveWidth == 64);
    const auto word = hn::Add(hn::ShiftLeft<6>(element), hn::Iota(d, static_cast<std::uint32_t>(lane)));
    return hn::GatherIndex(d, words, hn::BitCast(di, word));
  });
  return i + 1;
}

const Instruction* store_array_uniform(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  const std::uint32_t* from = reg(wave, i->src[1]).lane;
  std::uint32_t* to = element(wave, row, uniform_word(wave, i->src[0]));
  if (wave.active == base::kAllLanes) {
    std::memcpy(to, from, sizeof(base::WaveRegister));
  } else {
    base::for_each_lane(wave.active, [&](std::size_t lane) { to[lane] = from[lane]; });
  }
  return i + 1;
}

const Instruction* store_array_lanes(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  const std::uint32_t* from = reg(wave, i->src[1]).lane;
  const std::uint32_t* index = reg(wave, i->src[0]).lane;
  base::for_each_lane(wave.active, [&](std::size_t lane) { element(wave, row, index[lane])[lane] = from[lane]; });
  return i + 1;
}

const Instruction* store_array_whole(Wave& wave, const Instruction* i) {
  std::memcpy(element(wave, memory_op(wave, i), uniform_word(wave, i->src[0])), reg(wave, i->src[1]).lane,
              sizeof(base::WaveRegister));
  return i + 1;
}

const std::uint32_t* table_of(const Wave& wave, const MemoryOp& row) {
  return wave.program->tables.data() + row.array_base / sizeof(std::uint32_t);
}

const Instruction* load_table_uniform(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  const std::uint32_t index = uniform_word(wave, i->src[0]) + row.added;
  uniform_word(wave, i->dst) = table_of(wave, row)[std::min(index, row.array_elements - 1)];
  return i + 1;
}

const Instruction* load_table_lanes(Wave& wave, const Instruction* i) {
  const hn::ScalableTag<std::uint32_t> d;
  const hn::RebindToSigned<decltype(d)> di;
  const MemoryOp& row = memory_op(wave, i);
  const std::uint32_t* table = table_of(wave, row);
  if (row.array_elements <= hn::Lanes(d)) {
    const auto all = hn::LoadU(d, table);
    load_elements(wave, i, row, [&](auto element, std::size_t) HWY_ATTR {
      return hn::TableLookupLanes(all, hn::IndicesFromVec(d, element));
    });
  } else {
    load_elements(wave, i, row, [&](auto element, std::size_t) HWY_ATTR {
      return hn::GatherIndex(d, table, hn::BitCast(di, element));
    });
  }
  return i + 1;
}

Handler load_table_handler(bool uniform) { return uniform ? load_table_uniform : load_table_lanes; }
Handler load_array_handler(bool uniform) { return uniform ? load_array_uniform : load_array_lanes; }
Handler store_array_handler(bool uniform, bool whole) {
  if (whole && uniform) return store_array_whole;
  return uniform ? store_array_uniform : store_array_lanes;
}

}  // namespace vitrine::spirv::exec::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::exec {

HWY_EXPORT(load_array_handler);
HWY_EXPORT(load_table_handler);
HWY_EXPORT(store_array_handler);

const Instruction* clear_arrays(Wave& wave, const Instruction* i) {
  std::memset(wave.arrays, 0, wave.program->array_bytes);
  return i + 1;
}

Handler load_array(bool uniform) { return HWY_DYNAMIC_DISPATCH(load_array_handler)(uniform); }
Handler load_table(bool uniform) { return HWY_DYNAMIC_DISPATCH(load_table_handler)(uniform); }
Handler store_array(bool uniform, bool whole) { return HWY_DYNAMIC_DISPATCH(store_array_handler)(uniform, whole); }

}  // namespace vitrine::spirv::exec
#endif
