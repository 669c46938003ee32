// The floating-point environment of a stretch of work: round to nearest even always; denormals flushed (FTZ and DAZ)
// in vertex and fragment work, honoured in compute (lavapipe-shader-math.md section 1).
#pragma once

#include <cstdint>

namespace vitrine::base {

enum class Denormals : std::uint8_t { kHonour, kFlush };

/// Sets the mode of the calling thread and restores what it found on destruction. Also masks all exceptions, so that
/// an application that unmasked them does not trap inside our arithmetic.
class ScopedFloatMode {
 public:
  explicit ScopedFloatMode(Denormals denormals);
  ~ScopedFloatMode();
  ScopedFloatMode(const ScopedFloatMode&) = delete;
  ScopedFloatMode& operator=(const ScopedFloatMode&) = delete;

 private:
  std::uint64_t saved_;
};

}  // namespace vitrine::base
