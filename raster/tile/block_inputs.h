// Inputs of the fragment shader for the fragments of an observed block, whether it runs for them or not.
#pragma once

#include "raster/tile/worker.h"

namespace vitrine::raster {

class BlockInputs final : public FragmentInputs {
 public:
  /// The block at (x, y); `covered`: by sample. While it is in use nothing else uses the worker's block and points.
  BlockInputs(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& covered)
      : worker_(worker), primitive_(primitive), x_(x), y_(y), covered_(covered) {}
  const spirv::Shader& shader() const override { return *worker_.draw->call.fragment; }
  std::optional<std::uint32_t> word(std::uint32_t reg, std::size_t lane) override;

 private:
  TileWorker& worker_;
  const Primitive& primitive_;
  const int x_, y_;
  const BlockCoverage& covered_;
};

}  // namespace vitrine::raster
