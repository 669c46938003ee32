// Advanced blend operations (Vulkan 1.3.239, Advanced Blend Operations), in the order of its tables.
#include "raster/output/advanced_blend.h"

#include <algorithm>
#include <cmath>

namespace vitrine::raster {
namespace {

using Rgb = std::array<float, 3>;
using Rgba = std::array<float, 4>;

/// X, Y and Z of the table "f/X/Y/Z Advanced Blend Operations".
struct Terms {
  float x, y, z;
};

Terms terms_of(VkBlendOp op) {
  switch (op) {
    case VK_BLEND_OP_ZERO_EXT:
      return {0, 0, 0};
    case VK_BLEND_OP_SRC_EXT:
    case VK_BLEND_OP_DST_ATOP_EXT:
      return {1, 1, 0};
    case VK_BLEND_OP_DST_EXT:
    case VK_BLEND_OP_SRC_ATOP_EXT:
    case VK_BLEND_OP_INVERT_EXT:
    case VK_BLEND_OP_INVERT_RGB_EXT:
      return {1, 0, 1};
    case VK_BLEND_OP_SRC_IN_EXT:
    case VK_BLEND_OP_DST_IN_EXT:
      return {1, 0, 0};
    case VK_BLEND_OP_SRC_OUT_EXT:
      return {0, 1, 0};
    case VK_BLEND_OP_DST_OUT_EXT:
      return {0, 0, 1};
    case VK_BLEND_OP_XOR_EXT:
      return {0, 1, 1};
    default:
      return {1, 1, 1};
  }
}

float hard_light(float s, float d) { return s <= 0.5f ? 2 * s * d : 1 - 2 * (1 - s) * (1 - d); }

float color_dodge(float s, float d) {
  if (d <= 0) return 0;
  return s < 1 ? std::min(1.0f, d / (1 - s)) : 1.0f;
}

float color_burn(float s, float d) {
  if (d >= 1) return 1;
  return s > 0 ? 1 - std::min(1.0f, (1 - d) / s) : 0.0f;
}

float soft_light(float s, float d) {
  if (s <= 0.5f) return d - (1 - 2 * s) * d * (1 - d);
  if (d <= 0.25f) return d + (2 * s - 1) * d * ((16 * d - 12) * d + 3);
  return d + (2 * s - 1) * (std::sqrt(d) - d);
}

float vivid_light(float s, float d) {
  if (s <= 0) return 0;
  if (s < 0.5f) return 1 - std::min(1.0f, (1 - d) / (2 * s));
  return s < 1 ? std::min(1.0f, d / (2 * (1 - s))) : 1.0f;
}

float pin_light(float s, float d) {
  if (2 * s - 1 > d) return s < 0.5f ? 0.0f : 2 * s - 1;
  return s < 0.5f * d ? 2 * s : d;
}

/// f of one component.
float mix_component(VkBlendOp op, float s, float d) {
  switch (op) {
    case VK_BLEND_OP_SRC_EXT:
    case VK_BLEND_OP_SRC_OVER_EXT:
    case VK_BLEND_OP_SRC_IN_EXT:
    case VK_BLEND_OP_SRC_ATOP_EXT:
      return s;
    case VK_BLEND_OP_DST_EXT:
    case VK_BLEND_OP_DST_OVER_EXT:
    case VK_BLEND_OP_DST_IN_EXT:
    case VK_BLEND_OP_DST_ATOP_EXT:
      return d;
    case VK_BLEND_OP_MULTIPLY_EXT:
      return s * d;
    case VK_BLEND_OP_SCREEN_EXT:
      return s + d - s * d;
    case VK_BLEND_OP_OVERLAY_EXT:
      return hard_light(d, s);
    case VK_BLEND_OP_DARKEN_EXT:
      return std::min(s, d);
    case VK_BLEND_OP_LIGHTEN_EXT:
      return std::max(s, d);
    case VK_BLEND_OP_COLORDODGE_EXT:
      return color_dodge(s, d);
    case VK_BLEND_OP_COLORBURN_EXT:
      return color_burn(s, d);
    case VK_BLEND_OP_HARDLIGHT_EXT:
      return hard_light(s, d);
    case VK_BLEND_OP_SOFTLIGHT_EXT:
      return soft_light(s, d);
    case VK_BLEND_OP_DIFFERENCE_EXT:
      return std::fabs(d - s);
    case VK_BLEND_OP_EXCLUSION_EXT:
      return s + d - 2 * s * d;
    case VK_BLEND_OP_INVERT_EXT:
      return 1 - d;
    case VK_BLEND_OP_INVERT_RGB_EXT:
      return s * (1 - d);
    case VK_BLEND_OP_LINEARDODGE_EXT:
      return std::min(s + d, 1.0f);
    case VK_BLEND_OP_LINEARBURN_EXT:
      return std::max(s + d - 1, 0.0f);
    case VK_BLEND_OP_VIVIDLIGHT_EXT:
      return vivid_light(s, d);
    case VK_BLEND_OP_LINEARLIGHT_EXT:
      return std::clamp(2 * s + d - 1, 0.0f, 1.0f);
    case VK_BLEND_OP_PINLIGHT_EXT:
      return pin_light(s, d);
    case VK_BLEND_OP_HARDMIX_EXT:
      return s + d < 1 ? 0.0f : 1.0f;
    default:  // ZERO, SRC_OUT, DST_OUT, XOR
      return 0;
  }
}

float least(const Rgb& c) { return std::min({c[0], c[1], c[2]}); }
float greatest(const Rgb& c) { return std::max({c[0], c[1], c[2]}); }
float luminosity(const Rgb& c) { return 0.30f * c[0] + 0.59f * c[1] + 0.11f * c[2]; }

/// Moves the components into [0, 1] and keeps the luminosity.
Rgb clip_color(Rgb color) {
  const float lum = luminosity(color), low = least(color), high = greatest(color);
  for (float& c : color) {
    if (low < 0) c = lum + (c - lum) * lum / (lum - low);
    if (high > 1) c = lum + (c - lum) * (1 - lum) / (high - lum);
  }
  return color;
}

/// `base` with the luminosity of `lum`.
Rgb set_luminosity(Rgb base, const Rgb& lum) {
  const float difference = luminosity(lum) - luminosity(base);
  for (float& c : base) c += difference;
  return clip_color(base);
}

/// `base` with the saturation of one colour, then with the luminosity of another.
Rgb set_saturation(const Rgb& base, const Rgb& saturation, const Rgb& lum) {
  const float low = least(base), own = greatest(base) - low, wanted = greatest(saturation) - least(saturation);
  Rgb color{};
  for (std::size_t c = 0; c < 3 && own > 0; ++c) color[c] = (base[c] - low) * wanted / own;
  return set_luminosity(color, lum);
}

/// f of a colour.
Rgb mix(VkBlendOp op, const Rgb& s, const Rgb& d) {
  switch (op) {
    case VK_BLEND_OP_HSL_HUE_EXT:
      return set_saturation(s, d, d);
    case VK_BLEND_OP_HSL_SATURATION_EXT:
      return set_saturation(d, s, d);
    case VK_BLEND_OP_HSL_COLOR_EXT:
      return set_luminosity(s, d);
    case VK_BLEND_OP_HSL_LUMINOSITY_EXT:
      return set_luminosity(d, s);
    default:
      return {mix_component(op, s[0], d[0]), mix_component(op, s[1], d[1]), mix_component(op, s[2], d[2])};
  }
}

/// p0, p1 and p2: what both cover, the source alone, the destination alone.
std::array<float, 3> weights_of(VkBlendOverlapEXT overlap, float s, float d) {
  switch (overlap) {
    case VK_BLEND_OVERLAP_CONJOINT_EXT:
      return {std::min(s, d), std::max(s - d, 0.0f), std::max(d - s, 0.0f)};
    case VK_BLEND_OVERLAP_DISJOINT_EXT:
      return {std::max(s + d - 1, 0.0f), std::min(s, 1 - d), std::min(d, 1 - s)};
    default:
      return {s * d, s * (1 - d), d * (1 - s)};
  }
}

Rgb divided(const Rgba& color) {
  if (color[3] == 0) return {};
  return {color[0] / color[3], color[1] / color[3], color[2] / color[3]};
}
Rgb multiplied(const Rgba& color) { return {color[0] * color[3], color[1] * color[3], color[2] * color[3]}; }
Rgb rgb_of(const Rgba& color) { return {color[0], color[1], color[2]}; }

/// Operations of the first two tables.
Rgba blend_weighted(const BlendAttachment& state, const Rgba& src, const Rgba& dst) {
  const Rgb s = state.src_premultiplied ? divided(src) : rgb_of(src);
  const Rgb d = state.dst_premultiplied ? divided(dst) : rgb_of(dst);
  const Rgb f = mix(state.color_op, s, d);
  const Terms terms = terms_of(state.color_op);
  const auto [both, source, destination] = weights_of(state.overlap, src[3], dst[3]);
  Rgba out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = f[c] * both + terms.y * s[c] * source + terms.z * d[c] * destination;
  out[3] = terms.x * both + terms.y * source + terms.z * destination;
  return out;
}

/// A component of the table "Additional RGB Blend Operations"; both colours are premultiplied. Number 3 is alpha.
float add_component(VkBlendOp op, std::size_t c, float s, float d, float sa, float da) {
  const float sum = std::min(1.0f, sa + da);
  switch (op) {
    case VK_BLEND_OP_PLUS_EXT:
      return s + d;
    case VK_BLEND_OP_PLUS_CLAMPED_EXT:
      return std::min(1.0f, s + d);
    case VK_BLEND_OP_PLUS_CLAMPED_ALPHA_EXT:
      return std::min(sum, s + d);
    case VK_BLEND_OP_PLUS_DARKER_EXT:
      return c == 3 ? sum : std::max(0.0f, sum - ((sa - s) + (da - d)));
    case VK_BLEND_OP_MINUS_EXT:
      return d - s;
    case VK_BLEND_OP_MINUS_CLAMPED_EXT:
      return std::max(0.0f, d - s);
    case VK_BLEND_OP_CONTRAST_EXT:
      return c == 3 ? da : da / 2 + 2 * (d - da / 2) * (s - sa / 2);
    case VK_BLEND_OP_INVERT_OVG_EXT:
      return c == 3 ? sa + da - sa * da : sa * (1 - d) + (1 - sa) * d;
    default:  // RED, GREEN, BLUE
      return c == static_cast<std::size_t>(op - VK_BLEND_OP_RED_EXT) ? s : d;
  }
}

Rgba blend_added(const BlendAttachment& state, const Rgba& src, const Rgba& dst) {
  const Rgb s = state.src_premultiplied ? rgb_of(src) : multiplied(src);
  const Rgb d = state.dst_premultiplied ? rgb_of(dst) : multiplied(dst);
  Rgba out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = add_component(state.color_op, c, s[c], d[c], src[3], dst[3]);
  out[3] = add_component(state.color_op, 3, src[3], dst[3], src[3], dst[3]);
  return out;
}

}  // namespace

Rgba blend_advanced(const BlendAttachment& state, const Rgba& src, const Rgba& dst) {
  Rgba out = (state.color_op >= VK_BLEND_OP_PLUS_EXT ? blend_added : blend_weighted)(state, src, dst);
  if (!state.dst_premultiplied) {
    const Rgb plain = divided(out);
    std::copy(plain.begin(), plain.end(), out.begin());
  }
  for (float& c : out)
    if (state.clamped) c = std::clamp(c, 0.0f, 1.0f);
  return out;
}

}  // namespace vitrine::raster
