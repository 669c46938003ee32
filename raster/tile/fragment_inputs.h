// Inputs of the fragment shader that every way of shading sets: flat varyings, FragCoord, FrontFacing, PrimitiveId. A
// way says where its fragments are and whose they are; what goes into which register is said here once.
#pragma once

#include <algorithm>

#include "base/lanes.h"
#include "base/numeric.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

inline float* as_floats(base::WaveRegister& reg) { return reinterpret_cast<float*>(reg.lane); }

inline void splat(base::WaveRegister& out, std::uint32_t value) { std::fill_n(out.lane, base::kWaveWidth, value); }

/// Whether fragments need 1/w to interpolate.
inline bool has_perspective(const PipelinePlan& plan) {
  return plan.perspective_count != 0 || plan.frag.point_coord[0] != kNoReg || plan.frag.point_coord[1] != kNoReg;
}

/// What perspective planes are multiplied with, in worker.reciprocal_w; null: 1 everywhere. For `Fragments` see below.
template <class Fragments>
const float* perspective_scale(TileWorker& worker, const Fragments& fragments) {
  if (fragments.has_unit_w()) return nullptr;
  fragments.reciprocal_w(worker.reciprocal_w);  // 1/w is what is linear on the screen
  reciprocal(worker.reciprocal_w, worker.reciprocal_w);
  return worker.reciprocal_w;
}

/// Of all fragments of a primitive.
inline std::uint32_t flat_word(const Primitive& p, const VaryingRead& read) {
  return base::bits_of(p.v[p.provoking][4 + read.varying]);
}

/// `Fragments` are the 64 lanes of one run of the shader:
///   has_unit_w()              1/w is 1 for all of them
///   reciprocal_w(out)         1/w at the pixels' centres
///   position(x, y)            FragCoord.xy; null: not wanted
///   depth(out)                FragCoord.z
///   per_primitive(out, word)  word(primitive) of each lane's primitive
template <class Fragments>
void set_common_inputs(TileWorker& worker, const Fragments& fragments) {
  const PipelinePlan& plan = *worker.draw->plan;
  const FragmentRegisters& frag = plan.frag;
  StageRunner& runner = worker.runner;
  const std::uint32_t smooth = plan.perspective_count + plan.linear_count;
  for (std::uint32_t i = 0; i < plan.read_count; ++i)
    if (const VaryingRead& read = plan.read[i]; read.varying >= smooth)
      fragments.per_primitive(runner.input(read.reg), [&](const Primitive& p) { return flat_word(p, read); });
  const auto& position = frag.frag_coord;
  const auto floats = [&](std::uint32_t reg) { return reg != kNoReg ? as_floats(runner.input(reg)) : nullptr; };
  if (position[0] != kNoReg || position[1] != kNoReg) fragments.position(floats(position[0]), floats(position[1]));
  if (position[2] != kNoReg) fragments.depth(floats(position[2]));
  if (position[3] != kNoReg) fragments.reciprocal_w(floats(position[3]));
  if (frag.front_facing != kNoReg)
    fragments.per_primitive(runner.input(frag.front_facing), [](const Primitive& p) { return p.front ? ~0u : 0u; });
  if (frag.primitive_id != kNoReg)
    fragments.per_primitive(runner.input(frag.primitive_id), [](const Primitive& p) { return p.id; });
}

}  // namespace vitrine::raster
