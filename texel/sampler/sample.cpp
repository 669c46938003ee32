// Entry of the sampler: one decision per wave, then the fastest path that has the same bits as the scalar one.
#include "texel/sampler.h"
#include "texel/sampler/plan.h"
#include "texel/sampler/wave_2d.h"

namespace vitrine::texel {

void sample(const ImageView& view, const Sampler& sampler, const SampleRequest& request, base::WaveRegister result[4]) {
  const Plan plan = make_plan(view, sampler, request.op, request.lod_mode);
  if (!sample_wave_2d(plan, request, result)) sample_scalar(plan, request, result);
}

}  // namespace vitrine::texel
