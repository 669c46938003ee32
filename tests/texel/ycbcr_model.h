// Samples through Y'CbCr conversions by the specification's formulas, in double precision (Vulkan 1.3.239, Image
// Operations: Chroma Reconstruction, Sampler Y'CbCr Range Expansion, Sampler Y'CbCr Model Conversion). The model reads
// texels by the format's name alone.
#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

namespace vitrine::test {

/// What the name of a format says (without VK_FORMAT_).
struct YcbcrName {
  explicit YcbcrName(const std::string& format) : name(format) {
    bits = std::stoi(name.substr(1));
    bytes = bits == 8 ? 1 : 2;
    has_alpha = name.find("A1") != std::string::npos;
    planes = name.find("3PLANE") != std::string::npos ? 3 : name.find("2PLANE") != std::string::npos ? 2 : 1;
    halved_x = name.find("_420_") != std::string::npos || name.find("_422_") != std::string::npos;
    halved_y = name.find("_420_") != std::string::npos;
  }
  std::string name;
  int bits = 0, bytes = 0, planes = 1;
  bool has_alpha = false, halved_x = false, halved_y = false;
};

struct YcbcrModel {
  YcbcrName named;
  std::uint32_t width, height;  ///< texels of luma
  /// Element `index` of row y of a plane, normalised.
  std::function<double(int plane, std::uint32_t layer, std::uint32_t y, std::uint32_t index)> element = nullptr;
  VkSamplerYcbcrModelConversion model = VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY;
  VkSamplerYcbcrRange range = VK_SAMPLER_YCBCR_RANGE_ITU_FULL;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};  ///< 4 = zero, 5 = one
  bool linear = false, chroma_linear = false, x_cosited = false, y_cosited = false;

  /// At normalised coordinates, clamped to the edge.
  void sample(double s, double t, std::uint32_t layer, double out[4]) const {
    for (std::size_t c = 0; c < 4; ++c) {
      out[c] = swizzle[c] > 3 ? swizzle[c] - 4.0 : sampled_component("RGBA"[swizzle[c]], s, t, layer);
    }
    if (model != VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY) convert(out);
  }

 private:
  static double mix(double a, double b, double weight) { return a + (b - a) * weight; }

  /// Component 'R', 'G', 'B' or 'A' at a texel of its own grid, clamped to the edge.
  double component(char c, std::uint32_t layer, int x, int y) const {
    const bool luma = c == 'G' || c == 'A';
    const int w = static_cast<int>(width) / (!luma && named.halved_x ? 2 : 1);
    const int h = static_cast<int>(height) / (!luma && named.halved_y ? 2 : 1);
    const auto i = static_cast<std::uint32_t>(std::clamp(x, 0, w - 1));
    const auto j = static_cast<std::uint32_t>(std::clamp(y, 0, h - 1));
    if (c == 'A' && !named.has_alpha) return 1.0;
    if (named.has_alpha) return element(0, layer, j, i * 4 + static_cast<std::uint32_t>(std::string("RGBA").find(c)));
    if (named.planes == 3) return element(c == 'G' ? 0 : c == 'B' ? 1 : 2, layer, j, i);
    if (named.planes == 2) return c == 'G' ? element(0, layer, j, i) : element(1, layer, j, i * 2 + (c == 'R'));
    const std::uint32_t luma_at = named.name[0] == 'G' ? 0 : 1;
    if (c == 'G') return element(0, layer, j, i * 2 + luma_at);
    return element(0, layer, j, i * 4 + (c == 'R' ? 2 : 0) + 1 - luma_at);
  }

  /// Bilinear or nearest at texel coordinates of a grid.
  template <class Read>
  static double filter(double u, double v, bool linear, Read read) {
    if (!linear) return read(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)));
    const int i = static_cast<int>(std::floor(u - 0.5)), j = static_cast<int>(std::floor(v - 0.5));
    const double a = u - 0.5 - i, b = v - 0.5 - j;
    return mix(mix(read(i, j), read(i + 1, j), a), mix(read(i, j + 1), read(i + 1, j + 1), a), b);
  }

  double sampled_component(char c, double s, double t, std::uint32_t layer) const {
    const double u = s * width, v = t * height;
    const auto read = [&](int x, int y) { return component(c, layer, x, y); };
    if (c == 'G' || c == 'A' || !named.halved_x) return filter(u, v, linear, read);
    const auto scale = [&](double at, bool halved, bool cosited) {
      return halved ? 0.5 * (at + (cosited && chroma_linear ? 0.5 : 0.0)) : at;
    };
    return filter(scale(u, named.halved_x, x_cosited), scale(v, named.halved_y, y_cosited), chroma_linear, read);
  }

  void convert(double out[4]) const {
    const double n = named.bits, largest = std::exp2(n) - 1;
    double y = out[1], cb = out[2], cr = out[0];
    if (range == VK_SAMPLER_YCBCR_RANGE_ITU_FULL) {
      cb -= std::exp2(n - 1) / largest;
      cr -= std::exp2(n - 1) / largest;
    } else {
      y = (y * largest - 16 * std::exp2(n - 8)) / (219 * std::exp2(n - 8));
      cb = (cb * largest - 128 * std::exp2(n - 8)) / (224 * std::exp2(n - 8));
      cr = (cr * largest - 128 * std::exp2(n - 8)) / (224 * std::exp2(n - 8));
    }
    out[0] = cr, out[1] = y, out[2] = cb;
    switch (model) {
      case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_601:
        out[0] = y + 1.402 * cr, out[1] = y - (0.202008 * cb + 0.419198 * cr) / 0.587, out[2] = y + 1.772 * cb;
        break;
      case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_709:
        out[0] = y + 1.5748 * cr, out[1] = y - (0.13397432 * cb + 0.33480248 * cr) / 0.7152, out[2] = y + 1.8556 * cb;
        break;
      case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_2020:
        out[0] = y + 1.4746 * cr, out[1] = y - (0.11156702 * cb + 0.38737742 * cr) / 0.6780, out[2] = y + 1.8814 * cb;
        break;
      default:
        break;
    }
  }
};

}  // namespace vitrine::test
