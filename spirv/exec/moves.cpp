// Moves of registers that keep the lanes which are not active: values crossing joins.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/exec/moves.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>

#include "base/lane_math-inl.h"
#include "spirv/exec/handlers.h"
#include "spirv/exec/operands.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::exec::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace lanes = vitrine::base::HWY_NAMESPACE;

const Instruction* move_active_target(Wave& wave, const Instruction* i) {
  const hn::ScalableTag<std::uint32_t> d;
  std::uint32_t* to = reg(wave, i->dst).lane;
  const std::uint32_t* from = reg(wave, i->src[0]).lane;
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(d)) {
    const auto keep = lanes::lanes_mask_from_bits(d, wave.active >> lane);
    hn::Store(hn::IfThenElse(keep, hn::Load(d, from + lane), hn::Load(d, to + lane)), d, to + lane);
  }
  return i + 1;
}

const Instruction* broadcast_active_target(Wave& wave, const Instruction* i) {
  const hn::ScalableTag<std::uint32_t> d;
  std::uint32_t* to = reg(wave, i->dst).lane;
  const auto value = hn::Set(d, uniform_word(wave, i->src[0]));
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(d)) {
    const auto keep = lanes::lanes_mask_from_bits(d, wave.active >> lane);
    hn::Store(hn::IfThenElse(keep, value, hn::Load(d, to + lane)), d, to + lane);
  }
  return i + 1;
}

Handler move_active_handler() { return move_active_target; }
Handler broadcast_active_handler() { return broadcast_active_target; }

}  // namespace vitrine::spirv::exec::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::exec {

HWY_EXPORT(move_active_handler);
HWY_EXPORT(broadcast_active_handler);

Handler move_active() { return HWY_DYNAMIC_DISPATCH(move_active_handler)(); }
Handler broadcast_active() { return HWY_DYNAMIC_DISPATCH(broadcast_active_handler)(); }

}  // namespace vitrine::spirv::exec
#endif
