// Chooses the SIMD target once per process.
#include "base/simd.h"

#include <hwy/targets.h>

#include <cstdlib>
#include <string_view>

namespace vitrine::base {
namespace {

#ifdef __aarch64__
auto wanted_targets() { return HWY_NEON; }
#else
constexpr auto kUsed = HWY_SSE4 | HWY_AVX2 | HWY_AVX3;

auto wanted_targets() {
  const char* value = std::getenv("VITRINE_TARGET");
  const std::string_view name = value ? value : "";
  if (name == "sse4") return HWY_SSE4;
  if (name == "avx2") return HWY_SSE4 | HWY_AVX2;
  return kUsed;
}
#endif

}  // namespace

void select_simd_target() {
  // Not std::call_once, which costs calls even when all is done: every fetch of a wave comes here.
  static const bool selected = [] {
    hwy::DisableTargets(~wanted_targets());
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return true;
  }();
  static_cast<void>(selected);
}

const char* simd_target_name() {
  select_simd_target();
  const auto supported = hwy::SupportedTargets();
  return hwy::TargetName(supported & -supported);
}

}  // namespace vitrine::base
