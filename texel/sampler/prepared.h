// A view, a sampler and an operation made ready for many waves: the plan, tables for lookups by lane, and the function
// that samples whole waves. Built once per draw and image instruction.
#pragma once

#include "texel/sampler/plan.h"

namespace vitrine::texel {

/// Where the levels of a view lie, for lookups by lane. Extents in texels, the rest in bytes.
struct LevelTable {
  alignas(64) std::int32_t width[kMaxLevels];
  alignas(64) std::int32_t height[kMaxLevels];
  alignas(64) std::int32_t depth[kMaxLevels];
  alignas(64) std::int32_t row_pitch[kMaxLevels];
  alignas(64) std::int32_t slice_pitch[kMaxLevels];
  alignas(64) std::int32_t offset[kMaxLevels];
};

struct PreparedSampler {
  using Kernel = void (*)(const PreparedSampler&, const SampleRequest&, const SampleResult&);

  Plan plan;  ///< points to the view and the sampler, which must live as long
  LevelTable level;
  Kernel kernel = nullptr;
  bool one_level = false;     ///< every lane reads level 0 of the view
  bool needs_levels = false;  ///< levels of detail decide the result
};

void prepare(const ImageView& view, const Sampler& sampler, SampleOp op, LodMode lod_mode, PreparedSampler& out);

/// The same without the 8-bit path and without a conversion: planes of Y'CbCr formats.
void prepare_floats(const ImageView& view, const Sampler& sampler, SampleOp op, LodMode lod_mode, PreparedSampler& out);

/// Whether some lanes take no part: no pixel of their quad does, or there are no quads. Those may hold anything.
inline bool has_idle_lanes(const SampleRequest& request) {
  if (request.active == base::kAllLanes) return false;
  return !request.quads || base::quads_of_lanes(request.active) != base::kFirstOfQuads;
}

/// The same with idle lanes where busy ones are: wherever else they read, another tile may be writing.
void sample_with_idle_lanes(const PreparedSampler& prepared, const SampleRequest& request, const SampleResult& result);

/// Samples, gathers or queries for every active lane. Other lanes of the results keep what they hold.
inline void sample(const PreparedSampler& prepared, const SampleRequest& request, const SampleResult& result) {
  if (has_idle_lanes(request)) return sample_with_idle_lanes(prepared, request, result);
  prepared.kernel(prepared, request, result);
}

/// The kernels. Vector ones give the bits of the scalar one.
void sample_by_lane(const PreparedSampler& prepared, const SampleRequest& request, const SampleResult& result);
void sample_converted(const PreparedSampler& prepared, const SampleRequest& request, const SampleResult& result);
PreparedSampler::Kernel byte_kernel(const Plan& plan);  ///< Plan::aos
PreparedSampler::Kernel float_kernel(
    const Plan& plan);                         ///< samples and gathers of everything else, but not anisotropic
PreparedSampler::Kernel query_kernel();        ///< levels of detail
PreparedSampler::Kernel anisotropic_kernel();  ///< two-dimensional, and cubes
PreparedSampler::Kernel cubic_kernel();        ///< Plan::min_cubic, Plan::mag_cubic, or both

}  // namespace vitrine::texel
