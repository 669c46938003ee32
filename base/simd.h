// The SIMD targets of this library and how code picks one. Include this before <hwy/...> in every file with Highway
// code.
//
// Files with SIMD code follow Highway's foreach_target pattern. Three targets: SSE4, AVX2, AVX3 (AVX-512 F/BW/DQ/VL);
// on AArch64 one, NEON. Every target gives the same bits: an FMA is written lanes_fma() below, never hn::MulAdd,
// because Highway's MulAdd rounds twice where the CPU has no FMA (SSE4).
#pragma once

// These must be set before Highway is first seen. SSE4 is the baseline, although the compiler's flags say less (Highway
// would add a scalar target otherwise): each target's code carries its own target attribute.
#ifndef HWY_DISABLED_TARGETS
#ifdef __aarch64__
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE_256 | HWY_SVE2 | HWY_SVE2_128)
#elif defined(VITRINE_ONE_SIMD_TARGET)  // sanitizer builds: the instrumented code takes long enough to compile once
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#endif
#endif
#ifndef HWY_BASELINE_TARGETS
#ifdef __aarch64__
#define HWY_BASELINE_TARGETS HWY_NEON
#define TOOLCHAIN_MISS_SYS_AUXV_H  // no choice at run time: no target attributes, which would ask for +crypto
#else
#define HWY_BASELINE_TARGETS HWY_SSE4
#endif
#endif

#include <hwy/detect_targets.h>

namespace vitrine::base {

/// Applies VITRINE_TARGET (sse4, avx2 or avx3; unset: the best the CPU has; AArch64: NEON always) to Highway's
/// dispatch. Idempotent, thread-safe; called once before the first SIMD dispatch of a process.
void select_simd_target();

/// Name of the target in use, for the device summary and the benchmark.
const char* simd_target_name();

}  // namespace vitrine::base
