// What of a blend equation does not depend on the pixel (lavapipe-texture-blend.md E3, E5).
#include "raster/output/blend.h"

namespace vitrine::raster {

BlendShape::Lerp complementary(VkBlendFactor src, VkBlendFactor dst) {
  // VkBlendFactor lists f and ONE_MINUS_f next to each other from SRC_COLOR on: even is f.
  const auto pair = [](VkBlendFactor plain, VkBlendFactor inverse) {
    if (plain == VK_BLEND_FACTOR_ONE) return inverse == VK_BLEND_FACTOR_ZERO;
    const bool listed = (plain >= VK_BLEND_FACTOR_SRC_COLOR && plain < VK_BLEND_FACTOR_SRC_ALPHA_SATURATE &&
                         (plain - VK_BLEND_FACTOR_SRC_COLOR) % 2 == 0) ||
                        (plain >= VK_BLEND_FACTOR_SRC1_COLOR && (plain - VK_BLEND_FACTOR_SRC1_COLOR) % 2 == 0);
    return listed && inverse == plain + 1;
  };
  if (pair(src, dst)) return BlendShape::Lerp::kSource;
  if (pair(dst, src)) return BlendShape::Lerp::kDestination;
  return BlendShape::Lerp::kNone;
}

BlendShape blend_shape(const ColorWriter& writer) {
  const texel::FormatDesc& format = *writer.format;
  const bool has_alpha = format.rgba[3] >= 0;
  BlendShape shape;
  const auto is_constant = [&](VkBlendFactor rgb, VkBlendFactor alpha, VkBlendFactor wanted) {
    const VkBlendFactor a = alpha == VK_BLEND_FACTOR_SRC_ALPHA_SATURATE ? VK_BLEND_FACTOR_ONE : alpha;
    return rgb == wanted && (!has_alpha || a == wanted);
  };
  shape.src_zero = is_constant(writer.rgb.src, writer.alpha.src, VK_BLEND_FACTOR_ZERO);
  shape.src_one = is_constant(writer.rgb.src, writer.alpha.src, VK_BLEND_FACTOR_ONE);
  shape.dst_zero = is_constant(writer.rgb.dst, writer.alpha.dst, VK_BLEND_FACTOR_ZERO);
  shape.dst_one = is_constant(writer.rgb.dst, writer.alpha.dst, VK_BLEND_FACTOR_ONE);
  const bool single = format.channel_count == 1;
  if (single) shape.lerp = complementary(writer.rgb.src, writer.rgb.dst);
  shape.common_factor = writer.rgb.src == writer.rgb.dst && (single || writer.alpha.src == writer.alpha.dst);
  return shape;
}

bool reads_second_source(const ColorWriter& writer) {
  for (const VkBlendFactor factor : {writer.rgb.src, writer.rgb.dst, writer.alpha.src, writer.alpha.dst}) {
    if (factor >= VK_BLEND_FACTOR_SRC1_COLOR) return true;
  }
  return false;
}

}  // namespace vitrine::raster
