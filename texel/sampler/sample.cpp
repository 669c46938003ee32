// Entry of the sampler: one decision per wave, then the fastest path that has the same bits as the scalar one.
#include "texel/sampler.h"
#include "texel/sampler/plan.h"

namespace vitrine::texel {

void sample(const ImageView& view, const Sampler& sampler, const SampleRequest& request, base::WaveRegister result[4]) {
  sample_scalar(make_plan(view, sampler, request.op, request.lod_mode), request, result);
}

}  // namespace vitrine::texel
