// Entry of the sampler: one decision per draw, then the fastest path that has the same bits as the scalar one.
#include "texel/sampler.h"

#include <algorithm>
#include <bit>

#include "texel/sampler/prepared.h"

namespace vitrine::texel {
namespace {

void fill_table(const ImageView& view, LevelTable& table) {
  for (std::uint32_t i = 0; i < view.level_count; ++i) {
    const LevelLayout& level = view.level[i];
    table.width[i] = static_cast<std::int32_t>(level.extent.width);
    table.height[i] = static_cast<std::int32_t>(level.extent.height);
    table.depth[i] = static_cast<std::int32_t>(level.extent.depth);
    table.row_pitch[i] = static_cast<std::int32_t>(level.row_pitch);
    table.slice_pitch[i] = static_cast<std::int32_t>(level.slice_pitch);
    table.offset[i] = static_cast<std::int32_t>(level.offset);
  }
}

/// Byte offsets of all texels must fit a signed 32-bit lane.
bool small_enough(const ImageView& view) {
  const LevelLayout& last = view.level[view.level_count - 1];
  const std::uint64_t span = (view.layer_count - 1) * view.layer_stride + last.offset + last.sample_stride;
  return span < (std::uint64_t{1} << 31) - 64 && view.level[0].sample_stride < (std::uint64_t{1} << 31) - 64;
}

/// With one level and one filter there is nothing to choose; but a linear mip filter of floats is applied to equal
/// levels too, where infinities make a difference.
bool levels_matter(const Plan& plan) {
  if (!plan.lod_needed || plan.view->level_count > 1) return plan.lod_needed;
  return plan.anisotropic || plan.two_filters || (plan.mip == MipFilter::kLinear && !plan.aos);
}

PreparedSampler::Kernel choose_kernel(const Plan& plan, SampleOp op) {
  if (op == SampleOp::kQueryLod) return plan.zero ? sample_by_lane : query_kernel();
  if (plan.zero || !small_enough(*plan.view)) return sample_by_lane;
  if (plan.anisotropic) return anisotropic_kernel();
  if (plan.min_cubic || plan.mag_cubic) return cubic_kernel();
  return plan.aos ? byte_kernel(plan) : float_kernel(plan);
}

/// What follows from out.plan.
void choose(SampleOp op, PreparedSampler& out) {
  const ImageView& view = *out.plan.view;
  out.one_level = !out.plan.lod_needed || view.level_count == 1;
  out.needs_levels = op == SampleOp::kQueryLod || levels_matter(out.plan);
  out.kernel = choose_kernel(out.plan, op);
  if (out.kernel != sample_by_lane) fill_table(view, out.level);
}

/// Lanes in groups that take part together: quads, or single lanes.
constexpr std::size_t group_size(const SampleRequest& request) { return request.quads ? base::kQuadSize : 1; }

/// A register in which groups without an active lane hold what the first group with one does.
void share_values(const SampleRequest& request, const base::WaveRegister& from, base::WaveRegister& to) {
  const std::size_t size = group_size(request);
  const base::LaneMask group = base::first_lanes(size);
  const std::size_t source = static_cast<std::size_t>(std::countr_zero(request.active)) / size * size;
  to = from;
  for (std::size_t first = 0; first < base::kWaveWidth; first += size) {
    if ((request.active >> first & group) == 0) std::copy_n(from.lane + source, size, to.lane + first);
  }
}

}  // namespace

void sample_with_idle_lanes(const PreparedSampler& prepared, const SampleRequest& request, const SampleResult& result) {
  if (request.active == 0) return;
  constexpr std::size_t kOperands = 15;
  base::WaveRegister values[kOperands];
  std::size_t used = 0;
  SampleRequest shared = request;
  const auto share = [&](const base::WaveRegister*& operand) {
    if (operand == nullptr) return;
    share_values(request, *operand, values[used]);
    operand = &values[used++];
  };
  for (const base::WaveRegister*& operand : shared.coord) share(operand);
  share(shared.lod);
  share(shared.min_lod);
  for (auto* operands : {&shared.ddx, &shared.ddy, &shared.offset}) {
    for (const base::WaveRegister*& operand : *operands) share(operand);
  }
  prepared.kernel(prepared, shared, result);
}

void prepare(const ImageView& view, const Sampler& sampler, SampleOp op, LodMode lod_mode, PreparedSampler& out) {
  if (sampler.conversion.enabled && op == SampleOp::kSample) {
    out.plan.view = &view;
    out.plan.sampler = &sampler;
    out.kernel = sample_converted;
    return;
  }
  out.plan = make_plan(view.planes ? *view.planes : view, sampler, op, lod_mode);
  choose(op, out);
}

void prepare_floats(const ImageView& view, const Sampler& sampler, SampleOp op, LodMode lod_mode,
                    PreparedSampler& out) {
  out.plan = make_plan(view, sampler, op, lod_mode);
  out.plan.aos = false;
  choose(op, out);
}

void sample_by_lane(const PreparedSampler& prepared, const SampleRequest& request, const SampleResult& result) {
  base::WaveRegister all[4];
  sample_scalar(prepared.plan, request, all);
  const std::size_t components = request.op == SampleOp::kQueryLod ? 2 : 4;
  for (std::size_t c = 0; c < components; ++c) {
    if (result[c] == nullptr) continue;
    base::for_each_lane(request.active, [&](std::size_t lane) { result[c]->lane[lane] = all[c].lane[lane]; });
  }
}

void sample(const ImageView& view, const Sampler& sampler, const SampleRequest& request, base::WaveRegister result[4]) {
  PreparedSampler prepared;
  prepare(view, sampler, request.op, request.lod_mode, prepared);
  sample(prepared, request, {&result[0], &result[1], &result[2], &result[3]});
}

}  // namespace vitrine::texel
