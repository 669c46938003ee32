// The rates of a draw (Vulkan 1.3.239, Fragment Shading Rates).
#include "raster/plan/fragment_rates.h"

namespace vitrine::raster {

void plan_fragment_rates(PipelinePlan& plan, const PassDesc& pass) {
  const State& state = *plan.state;
  FragmentRates& rates = plan.rates;
  rates = {};
  const bool attached = pass.shading_rate != nullptr;
  const bool written = plan.out.shading_rate != kNoReg;
  if (state.fragment_size.width * state.fragment_size.height == 1 && !attached && !written) return;
  // Combining the Fragment Shading Rates: sample shading sets the rate to one pixel, whatever the number of samples.
  if (!plan.fragment || plan.fragment->per_sample || state.sample_shading) return;
  rates.samples = plan.samples;
  rates.pipeline = clamp_rate(rate_of_size(state.fragment_size.width, state.fragment_size.height), plan.samples);
  rates.primitive_op = state.rate_combiners[0];
  rates.attachment_op = state.rate_combiners[1];
  rates.any = attached || written || rates.with_attachment(rates.with_primitive(0), 0) != 0;
}

}  // namespace vitrine::raster
