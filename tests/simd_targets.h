// Runs a test's body once for every SIMD target of this CPU that the rooms are built for.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "base/simd.h"

namespace vitrine::base {

#ifdef __aarch64__
inline constexpr auto kSimdTargets = {HWY_NEON};
#else
inline constexpr auto kSimdTargets = {HWY_SSE4, HWY_AVX2, HWY_AVX3};
#endif

/// Calls body() with each of these targets as the target of HWY_DYNAMIC_DISPATCH, then restores the usual one.
template <class Body>
void for_each_simd_target(Body body) {
  select_simd_target();  // once per process: the choice below then stays
  hwy::DisableTargets(0);
  const auto supported = hwy::SupportedTargets();
  ASSERT_NE(supported & *kSimdTargets.begin(), 0);
  for (const auto target : kSimdTargets) {
    if ((supported & target) == 0) continue;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace vitrine::base
