// What becomes of one primitive of every draw to watched texels: why it did not reach them.
#pragma once

#include "glass/pixel/pixels.h"
#include "raster/observe.h"

namespace vitrine::glass::pixel {

/// Observes the front end alone. Draws that it is given are observed everywhere (raster/observe.h), so that the scissor
/// is told of, too.
class PrimitiveObserver final : public raster::DrawObserver {
 public:
  explicit PrimitiveObserver(Pixels& pixels) : pixels_(pixels) {}
  std::unique_ptr<raster::DrawWatch> watch_chunk(const spirv::ObservedCommand* command) override;
  std::unique_ptr<raster::DrawWatch> watch_tile(const spirv::ObservedCommand*, std::uint32_t) override {
    return nullptr;
  }

 private:
  Pixels& pixels_;
};

}  // namespace vitrine::glass::pixel
