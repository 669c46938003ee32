// Depth that fragments give beyond [0, 1] and beyond their viewport's range, with and without depth clamp
// (VK_EXT_depth_clamp_zero_one). The reference does the same without being asked.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

CTS_RANDOM("clipping", "depth_clamp_zero_one", 12) {
  run.require(gpus().device.extension_features.depthClampZeroOne, "depthClampZeroOne");
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R8G8B8A8_UNORM};
  target_spec.depth = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT});
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  const bool written = random.chance(0.7f);
  spec.fragment =
      "layout(location = 0) out vec4 result;\nvoid main() {\n  result = vec4(1.0);\n" +
      std::string(written ? "  gl_FragDepth = (gl_FragCoord.x + 64.0 * gl_FragCoord.y) / 1024.0 - 1.5;\n" : "") + "}\n";
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = random.pick({VK_COMPARE_OP_ALWAYS, VK_COMPARE_OP_LESS_OR_EQUAL});
  spec.raster.depthClampEnable = random.chance(0.5f);
  spec.raster.depthBiasEnable = random.chance(0.5f);
  spec.raster.depthBiasConstantFactor = random.pick({-20000000.0f, 20000000.0f});
  spec.viewports = {{0, 0, 64, 64, random.real(0, 0.4f), random.real(0.6f, 1)}};
  draw_once(run, target, make_pipeline(run, spec, target));
  out_target(run, target);
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
