// What shaders do to watched texels: stores to images, discards and lookups of fragments.
#pragma once

#include "glass/pixel/pixels.h"
#include "glass/place.h"

namespace vitrine::glass::pixel {

/// One program.
class PixelProgram final : public ProgramTool {
 public:
  PixelProgram(Pixels& pixels, const ShaderIdentity& shader, const spirv::Program& program);
  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) override;

 private:
  class Watch;

  Pixels& pixels_;
  const ShaderContext context_;
  bool stores_ = false;  ///< it writes images
};

}  // namespace vitrine::glass::pixel
