// Floating-point environment: MXCSR on x86, FPCR on AArch64.
#include "base/float_mode.h"

#if defined(__x86_64__) || defined(__i386__)
#include <xmmintrin.h>
#endif

namespace vitrine::base {
namespace {

#if defined(__x86_64__) || defined(__i386__)
constexpr std::uint32_t kMaskAllExceptions = 0x1f80;
constexpr std::uint32_t kFlushToZero = 0x8000;
constexpr std::uint32_t kDenormalsAreZero = 0x0040;

std::uint64_t read_mode() { return _mm_getcsr(); }
void write_mode(std::uint64_t mode) { _mm_setcsr(static_cast<std::uint32_t>(mode)); }
std::uint64_t mode_bits(Denormals denormals) {
  return kMaskAllExceptions | (denormals == Denormals::kFlush ? kFlushToZero | kDenormalsAreZero : 0);
}
#elif defined(__aarch64__)
constexpr std::uint64_t kFlushToZero = std::uint64_t{1} << 24;

std::uint64_t read_mode() {
  std::uint64_t mode;
  asm volatile("mrs %0, fpcr" : "=r"(mode));
  return mode;
}
void write_mode(std::uint64_t mode) { asm volatile("msr fpcr, %0" ::"r"(mode)); }
std::uint64_t mode_bits(Denormals denormals) { return denormals == Denormals::kFlush ? kFlushToZero : 0; }
#endif

}  // namespace

ScopedFloatMode::ScopedFloatMode(Denormals denormals) : saved_(read_mode()) { write_mode(mode_bits(denormals)); }
ScopedFloatMode::~ScopedFloatMode() { write_mode(saved_); }

}  // namespace vitrine::base
