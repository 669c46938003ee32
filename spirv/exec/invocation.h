// Which invocation a lane runs, in numbers that the application knows.
#pragma once

#include <array>
#include <cstdint>

#include "spirv/program.h"

namespace vitrine::spirv::exec {

/// Compute: GlobalInvocationId. Vertex: VertexIndex, InstanceIndex. Fragment: x and y of the pixel. Tessellation and
/// geometry: InvocationId (evaluation: the number of the domain point in its patch; geometry behind tessellation: over
/// all primitives of the patch), PrimitiveId of what came to the stages, and the instance. Of an observed program; but
/// for compute only when it has just started, while its inputs are there.
std::array<std::uint32_t, 3> invocation_of(const Wave& wave, std::size_t lane);

/// Keeps what tells the invocations of a wave apart, from its start on: the wave reuses those registers.
class Invocations {
 public:
  explicit Invocations(const Wave& wave);
  /// As invocation_of() at the start.
  std::array<std::uint32_t, 3> operator()(const Wave& wave, std::size_t lane) const;

 private:
  std::array<base::WaveRegister, 3> inputs_;  ///< unset where the wave has none
  std::uint8_t count_ = 0;                    ///< of inputs
};

}  // namespace vitrine::spirv::exec
