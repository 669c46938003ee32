// The colour of a wave, register by register.
#pragma once

#include <cstddef>

#include "base/lanes.h"

namespace vitrine::raster {

/// The four registers of a colour (RGBA, raw bits), wherever each of them lies; or none.
class ColorRegisters {
 public:
  ColorRegisters(const base::WaveRegister* red, const base::WaveRegister* green, const base::WaveRegister* blue,
                 const base::WaveRegister* alpha)
      : component_{red, green, blue, alpha} {}
  /// Four that lie side by side; null: none.
  ColorRegisters(const base::WaveRegister* four)  // NOLINT(google-explicit-constructor)
      : component_{four, four ? four + 1 : four, four ? four + 2 : four, four ? four + 3 : four} {}

  explicit operator bool() const { return component_[0] != nullptr; }
  const base::WaveRegister& operator[](std::size_t component) const { return *component_[component]; }

 private:
  const base::WaveRegister* component_[4];
};

}  // namespace vitrine::raster
