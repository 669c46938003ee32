// One invocation of a shader, instruction by instruction with the values that it reads and writes (VITRINE_TRACE).
//
//   vitrine: trace: compute 5,0,0 (workgroup 0,0,0, lane 5)
//   preamble
//       0  load_uniform      u3 = 3f800000 1 <- u0 00000000 0  set 0 slot 1
//   code
//       2  FAdd              r2 = 40400000 3 <- r0 3f800000 1, u3 40000000 2  ; %45 line 12 of a.comp
//   outputs
//       location 0.x         r2 = 40400000 3
//
// Values are bits and, behind them, the float that they are, or the integer where that is small; booleans are 0 or 1.
// Instructions that run while the lane is inactive are left out.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "spirv/exec/observe.h"

namespace vitrine::spirv::exec {

/// Which invocations. Compute: GlobalInvocationId. Vertex: VertexIndex, or VertexIndex and InstanceIndex. Fragment: the
/// pixel, every sample and every primitive on it.
struct TraceTarget {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
  std::array<std::uint32_t, 3> id{};
  std::size_t count = 0;  ///< numbers of `id` that were given
};

/// "compute:5,0,0", "vertex:3", "vertex:3,1" or "fragment:10,20".
std::optional<TraceTarget> parse_trace_target(std::string_view text);

/// Takes the text of one run of one invocation, from any thread.
using TraceWriter = std::function<void(std::string_view text)>;

std::shared_ptr<const Observer> make_tracer(const TraceTarget& target, TraceWriter writer);

/// The tracer that VITRINE_TRACE asks for in this stage, or null: "TARGET" writes to stderr, "TARGET@FILE" appends to a
/// file. Read once per process.
std::shared_ptr<const Observer> requested_tracer(VkShaderStageFlagBits stage);

}  // namespace vitrine::spirv::exec
