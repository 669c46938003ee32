// What a fragment shader's numbers become in an attachment of every format: a ramp over and beyond the range.
#include "cases/api/random_transfer.h"
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

void store_ramp(Run& run, const FormatInfo& info) {
  run.require(reference_has(info.format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT), "color attachment");
  if (info.numeric == Numeric::kSrgb) run.require(reference_cpu().srgb_comparable, "a comparable sRGB encoding");
  TargetSpec target_spec;
  target_spec.colors = {info.format};
  target_spec.width = target_spec.height = 128;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  const std::string type = info.numeric == Numeric::kUint ? "uvec4" : info.numeric == Numeric::kSint ? "ivec4" : "vec4";
  const std::string value =
      is_integer(info) ? type + "(at * 263, 70 - at, at * at, at / 7)" : "vec4(x, -x, x * 0.5 + 0.3, x * x - 0.2)";
  spec.fragment = "layout(location = 0) out " + type +
                  " v;\nvoid main() {\n  int at = int(gl_FragCoord.y) * 128 + int(gl_FragCoord.x);\n"
                  "  float x = float(at) * (2.5 / 16384.0) - 1.25;\n  v = " +
                  value + ";\n}\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  run.out("color", target.colors[0]);
}

const bool kFormats = [] {
  for (const FormatInfo& info : all_formats())
    // Signed 10-bit channels: deviations.md, snorm10-attachments.
    if (info.numeric != Numeric::kDepth && info.numeric != Numeric::kBlock &&
        !(info.numeric == Numeric::kSnorm && info.bits[0] == 10))
      AddCase("pipeline", std::string("attachment_values.") + info.name, [&info](Run& run) { store_ramp(run, info); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
