// What Highway's dispatch asks of its library: which targets the CPU has, and which one is chosen. Defined here instead
// of linking the library, because that one calibrates a timer when it is loaded (2.8 ms, more than everything else of a
// start of this driver), and because the headers are all that is needed otherwise.
#include "base/simd.h"

#include <hwy/targets.h>

#include <atomic>
#include <initializer_list>

#include "base/check.h"

#ifndef __aarch64__
#include <cpuid.h>
#endif

namespace vitrine::base {
namespace {

#ifdef __aarch64__
std::int64_t detect_targets() { return HWY_NEON; }
#else
struct Registers {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
};

Registers cpuid(unsigned leaf) {
  Registers r;
  if (!__get_cpuid_count(leaf, 0, &r.eax, &r.ebx, &r.ecx, &r.edx)) return {};
  return r;
}

bool has(unsigned reg, std::initializer_list<int> bits) {
  for (const int bit : bits) {
    if ((reg >> bit & 1) == 0) return false;
  }
  return true;
}

/// Register state that the operating system saves (XCR0).
unsigned saved_state() {
  unsigned low, high;
  asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

/// Bits of Highway's targets whose whole instruction set (hwy/ops/set_macros-inl.h) this CPU and system have.
std::int64_t detect_targets() {
  const Registers leaf1 = cpuid(1);
  const Registers leaf7 = cpuid(7);
  std::int64_t targets = 0;
  const bool sse4 = has(leaf1.ecx, {1 /* PCLMUL */, 9 /* SSSE3 */, 19 /* SSE4.1 */, 20 /* SSE4.2 */, 25 /* AES */});
  if (sse4) targets |= HWY_SSE4;
  const bool saves_ymm = has(leaf1.ecx, {27 /* OSXSAVE */}) && has(saved_state(), {1, 2});
  const bool avx2 = sse4 && saves_ymm && has(leaf1.ecx, {12 /* FMA */, 28 /* AVX */, 29 /* F16C */}) &&
                    has(leaf7.ebx, {3 /* BMI1 */, 5 /* AVX2 */, 8 /* BMI2 */});
  if (avx2) targets |= HWY_AVX2;
  const bool saves_zmm = saves_ymm && has(saved_state(), {5, 6, 7});
  if (avx2 && saves_zmm && has(leaf7.ebx, {16 /* F */, 17 /* DQ */, 30 /* BW */, 31 /* VL */})) targets |= HWY_AVX3;
  return targets;
}
#endif

std::atomic<std::int64_t> disabled_targets{0};
std::atomic<std::int64_t> forced_targets{0};

}  // namespace
}  // namespace vitrine::base

namespace hwy {

std::int64_t SupportedTargets() {
  static const std::int64_t detected = vitrine::base::detect_targets();
  const std::int64_t forced = vitrine::base::forced_targets.load();
  const std::int64_t usable = (forced ? forced : detected) & ~vitrine::base::disabled_targets.load();
  return usable ? usable : HWY_STATIC_TARGET;
}

void DisableTargets(std::int64_t targets) {
  vitrine::base::disabled_targets.store(targets);
  GetChosenTarget().DeInit();
}

void SetSupportedTargetsForTest(std::int64_t targets) { vitrine::base::forced_targets.store(targets); }

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

HWY_NORETURN void Abort(const char* file, int line, const char* format, ...) {
  vitrine::base::assertion_failed(format, file, line);
}

}  // namespace hwy
