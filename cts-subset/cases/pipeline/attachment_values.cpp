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

/// sRGB attachments of one and two channels, which the reference lacks: what is fetched of them is what it has in those
/// channels of four.
void store_few(Run& run, VkFormat format, bool blends, bool blits) {
  constexpr VkFormatFeatureFlags kFeatures =
      VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
  run.require((gpus().device.features_of(format) & kFeatures) == kFeatures, "blending and blits to it");
  run.require(reference_cpu().srgb_comparable, "a comparable sRGB encoding");
  const bool has = (run.gpu.features_of(format) & kFeatures) == kFeatures;
  ImageSpec image_spec;
  image_spec.format = has ? format : VK_FORMAT_R8G8B8A8_SRGB;
  image_spec.extent = {128, 128, 1};
  image_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image image = run.image(image_spec);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "layout(location = 0) out vec4 v;\nvoid main() {\n"
      "  float x = (gl_FragCoord.y * 128.0 + gl_FragCoord.x) * (1.5 / 16384.0) - 0.2;\n"
      "  v = vec4(x, x * x, 0.0, 0.6);\n}\n";
  const Target target = make_target_of(run, image);
  if (blits) {
    image_spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    image_spec.extent = {90, 70, 1};
    const Image from = run.image(image_spec);
    run.fill_random(from);
    VkImageBlit region{from.layers(), {{0, 0, 0}, {90, 70, 1}}, image.layers(), {{0, 0, 0}, {128, 128, 1}}};
    run.once([&](VkCommandBuffer cmd) {
      vkCmdBlitImage(cmd, from.handle, VK_IMAGE_LAYOUT_GENERAL, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region,
                     VK_FILTER_LINEAR);
    });
  } else {
    const VkClearColorValue clear{{0.3f, 0.7f, 0, 1}};
    const VkImageSubresourceRange range = image.range();
    run.once([&](VkCommandBuffer cmd) {
      vkCmdClearColorImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &clear, 1, &range);
    });
    if (blends)
      spec.blends = {{VK_TRUE, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR, VK_BLEND_OP_ADD,
                      VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ZERO, VK_BLEND_OP_ADD, 0xf}};
    draw_once(run, target, make_pipeline(run, spec, target));
  }
  const Resources resources = run.resources({sampled(0, image, run.sampler(VK_FILTER_NEAREST))});
  GraphicsSpec fetch;
  fetch.layout = resources.layout;
  fetch.vertex = kFullScreenVertex;
  fetch.fragment = std::string(
                       "layout(binding = 0) uniform sampler2D t;\nlayout(location = 0) out vec4 v;\n"
                       "void main() { v = vec4(texelFetch(t, ivec2(gl_FragCoord.xy), 0).") +
                   (format == VK_FORMAT_R8_SRGB ? "rr" : "rg") + ", 0.0, 1.0); }\n";
  TargetSpec seen_spec;
  seen_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  seen_spec.width = seen_spec.height = 128;
  const Target seen = make_target(run, seen_spec);
  draw_once(run, seen, make_pipeline(run, fetch, seen), &resources);
  run.out("texels", seen.colors[0]);
}

const bool kFewChannels = [] {
  for (const VkFormat format : {VK_FORMAT_R8_SRGB, VK_FORMAT_R8G8_SRGB}) {
    const std::string name = format == VK_FORMAT_R8_SRGB ? "R8_SRGB" : "R8G8_SRGB";
    AddCase("pipeline", "srgb_channels." + name, [format](Run& run) { store_few(run, format, false, false); });
    AddCase("pipeline", "srgb_channels." + name + "_blended",
            [format](Run& run) { store_few(run, format, true, false); });
    AddCase("pipeline", "srgb_channels." + name + "_blitted",
            [format](Run& run) { store_few(run, format, false, true); });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
