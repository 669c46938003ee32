// State that a pipeline may leave to commands (Vulkan 1.3.239, Pipelines: Dynamic State): which there is
// (dynamic_state.def), and its values as last set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "raster/draw.h"

namespace vitrine::icd {

/// What can be dynamic.
enum class DynamicState : std::uint8_t {
#define VITRINE_DYNAMIC_STATE(name, vulkan, part, ...) k##name,
#include "icd/record/dynamic_state.def"
  kCount
};

/// A set of DynamicState.
class DynamicStates {
 public:
  constexpr bool test(DynamicState s) const { return bits_ >> static_cast<unsigned>(s) & 1; }
  constexpr void set(DynamicState s) { bits_ |= std::uint64_t{1} << static_cast<unsigned>(s); }
  static constexpr DynamicStates all() {
    DynamicStates states;
    states.bits_ = (std::uint64_t{1} << static_cast<unsigned>(DynamicState::kCount)) - 1;
    return states;
  }
  constexpr bool none() const { return bits_ == 0; }
  constexpr DynamicStates& operator|=(const DynamicStates& other) {
    bits_ |= other.bits_;
    return *this;
  }
  constexpr bool operator==(const DynamicStates&) const = default;

 private:
  static_assert(static_cast<unsigned>(DynamicState::kCount) < 64);
  std::uint64_t bits_ = 0;
};

/// DynamicState::kCount for what is not known.
DynamicState dynamic_state_of(VkDynamicState state);

struct VertexStream {
  std::uint32_t stride = 0;
  std::uint32_t divisor = 1;
  bool per_instance = false;
  bool used = false;
};
using VertexStreams = std::array<VertexStream, raster::kMaxVertexBindings>;

/// Bit i: whether colour attachment i is written at all (VK_EXT_color_write_enable).
using ColorWrites = std::uint32_t;
inline constexpr ColorWrites kAllColorWrites = (1u << raster::kMaxColorAttachments) - 1;

/// Values as last set by commands: of `state`, the members that commands have written count.
struct DynamicValues {
  raster::State state;
  VertexStreams streams{};
  ColorWrites color_writes = kAllColorWrites;
};

/// The part of a graphics pipeline that a state belongs to (VK_EXT_graphics_pipeline_library).
VkGraphicsPipelineLibraryFlagBitsEXT part_of(DynamicState state);

/// Sets a state that is one word (icd/record/dynamic_state.def), as its command has it; a float by its bits.
void set_value(raster::State& state, DynamicState which, std::uint32_t value);

/// Copies one state, whatever it consists of, but for those that raster::State does not have.
void copy_state(const raster::State& from, DynamicState which, raster::State& to);

/// Locations as fixed point; outside of sampleLocationCoordinateRange they are moved into it. Of a sample count that is
/// not supported: the standard ones.
raster::SampleLocations sample_locations(const VkSampleLocationsInfoEXT& info);

/// Closes the write masks of attachments that are not written.
void apply_color_writes(raster::State& state, ColorWrites writes);

}  // namespace vitrine::icd
