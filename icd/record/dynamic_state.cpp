// Dynamic state: the table of dynamic_state.def, and values that commands give in another form.
#include "icd/record/dynamic_state.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace vitrine::icd {
namespace {

using raster::State;
using Face = raster::StencilFace;
using Blend = raster::BlendAttachment;

// The column `where` of dynamic_state.def: how a state is copied.

template <auto... kMembers>
struct Members {
  static void copy(const State& from, State& to) { ((to.*kMembers = from.*kMembers), ...); }
};

template <auto... kMembers>
struct OfFaces {
  static void copy(const State& from, State& to) {
    ((to.front.*kMembers = from.front.*kMembers), ...);
    ((to.back.*kMembers = from.back.*kMembers), ...);
  }
};

template <auto... kMembers>
struct OfAttachments {
  static void copy(const State& from, State& to) {
    for (std::size_t i = 0; i < to.blend.size(); ++i) ((to.blend[i].*kMembers = from.blend[i].*kMembers), ...);
  }
};

struct Elsewhere {
  static void copy(const State&, State&) {}
};

template <auto kMember>
void set_word(State& state, std::uint32_t value) {
  using T = std::remove_reference_t<decltype(state.*kMember)>;
  if constexpr (std::is_same_v<T, bool>) {
    state.*kMember = value != 0;
  } else if constexpr (std::is_same_v<T, float>) {
    state.*kMember = std::bit_cast<float>(value);
  } else {
    state.*kMember = static_cast<T>(value);
  }
}

struct Row {
  VkDynamicState vulkan;
  VkGraphicsPipelineLibraryFlagBitsEXT part;
  void (*copy)(const State& from, State& to);
  void (*set)(State& state, std::uint32_t value);  ///< null: is not one word
};

constexpr Row kRows[] = {
#define VITRINE_DYNAMIC_STATE(name, vulkan, part, ...) \
  {VK_DYNAMIC_STATE_##vulkan, VK_GRAPHICS_PIPELINE_LIBRARY_##part##_BIT_EXT, __VA_ARGS__::copy, nullptr},
#define VITRINE_DYNAMIC_VALUE(name, vulkan, part, member)                                                   \
  {VK_DYNAMIC_STATE_##vulkan, VK_GRAPHICS_PIPELINE_LIBRARY_##part##_BIT_EXT, Members<&State::member>::copy, \
   set_word<&State::member>},
#include "icd/record/dynamic_state.def"
};

const Row& row_of(DynamicState state) { return kRows[static_cast<std::size_t>(state)]; }

}  // namespace

DynamicState dynamic_state_of(VkDynamicState state) {
  const auto* found =
      std::find_if(std::begin(kRows), std::end(kRows), [&](const Row& row) { return row.vulkan == state; });
  return static_cast<DynamicState>(found - kRows);
}

VkGraphicsPipelineLibraryFlagBitsEXT part_of(DynamicState state) { return row_of(state).part; }

void set_value(State& state, DynamicState which, std::uint32_t value) { row_of(which).set(state, value); }

void copy_state(const State& from, DynamicState which, State& to) { row_of(which).copy(from, to); }

raster::SampleLocations sample_locations(const VkSampleLocationsInfoEXT& info) {
  const auto count = static_cast<std::uint32_t>(info.sampleLocationsPerPixel);
  if (count == 0 || count > raster::kMaxSamples || info.sampleLocationsCount < count)
    return raster::standard_locations(count);
  raster::SampleLocations out{count, {}, {}};
  const auto place = [](float v) {
    return v > 0 ? 16 * static_cast<std::int32_t>(std::lround(std::min(16 * v, 15.0f))) : 0;
  };
  for (std::uint32_t i = 0; i < raster::kMaxSamples; ++i) {
    const VkSampleLocationEXT& location = info.pSampleLocations[std::min(i, count - 1)];
    out.x[i] = place(location.x);
    out.y[i] = place(location.y);
  }
  return out;
}

void apply_color_writes(raster::State& state, ColorWrites writes) {
  for (std::uint32_t i = 0; i < raster::kMaxColorAttachments; ++i) {
    if (!(writes >> i & 1)) state.blend[i].write_mask = 0;
  }
}

}  // namespace vitrine::icd
