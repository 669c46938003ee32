// Cubic filtering against the formulas of the specification (Vulkan 1.3.239, Texel Filtering and Wrapping Operation),
// in double precision. That whole waves have the bits of single lanes, tests/texel/sampler_test.cpp tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "base/numeric.h"
#include "tests/simd_targets.h"
#include "texel/sampler.h"
#include "texel/transfer.h"

namespace vitrine::texel {
namespace {

constexpr VkSamplerAddressMode kModes[] = {
    VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE};
constexpr float kBorder = 0.75f;

/// An image of random floats, and the specification's filter of it.
class Picture {
 public:
  Picture(std::uint32_t width, std::uint32_t height, std::uint32_t layers, unsigned seed) : width_(width) {
    ImageDesc desc;
    desc.format = VK_FORMAT_R32_SFLOAT;
    desc.extent = {width, height, 1};
    desc.layers = layers;
    EXPECT_TRUE(make_image_layout(desc, layout_));
    memory_.resize(layout_.size);
    ImageViewDesc view_desc;
    view_desc.type = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    view_desc.format = desc.format;
    view_desc.layer_count = layers;
    view_ = make_image_view(layout_, memory_.data(), view_desc);
    std::mt19937 random(seed);
    for (std::uint32_t layer = 0; layer < layers; ++layer)
      for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
          const float value = static_cast<float>(random() % 1000) * 0.01f - 3;
          std::memcpy(view_.block(0, layer, 0, x, y, 0), &value, 4);
        }
  }

  const ImageView& view() const { return view_; }
  ImageMemory image() { return {&layout_, memory_.data(), nullptr}; }

  double texel(VkSamplerAddressMode mode, std::int64_t x, std::int64_t y, std::uint32_t layer) const {
    const auto inside = [&](std::int64_t& i, std::int64_t size) {
      const auto mirrored = [](std::int64_t n) { return n >= 0 ? n : -(1 + n); };
      const auto modulo = [](std::int64_t n, std::int64_t by) { return ((n % by) + by) % by; };
      if (mode == VK_SAMPLER_ADDRESS_MODE_REPEAT) i = modulo(i, size);
      if (mode == VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT) i = size - 1 - mirrored(modulo(i, 2 * size) - size);
      if (mode == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE) i = std::clamp<std::int64_t>(i, 0, size - 1);
      if (mode == VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE) i = std::clamp<std::int64_t>(mirrored(i), 0, size - 1);
      return i >= 0 && i < size;
    };
    const bool in_x = inside(x, width_), in_y = inside(y, view_.level[0].extent.height);
    if (!in_x || !in_y) return static_cast<double>(kBorder);
    float value = 0;
    std::memcpy(&value, view_.block(0, layer, 0, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0), 4);
    return static_cast<double>(value);
  }

  /// Four values at -1, 0, 1, 2 and a point between the middle ones: the row (1, a, a^2, a^3) times the matrix.
  static double between(double a, const double v[4]) {
    constexpr double kMatrix[4][4] = {{0, 2, 0, 0}, {-1, 0, 1, 0}, {2, -5, 4, -1}, {-1, 3, -3, 1}};
    double result = 0, power = 1;
    for (const auto& row : kMatrix) {
      for (int i = 0; i < 4; ++i) result += power * row[i] * v[i];
      power *= a;
    }
    return result / 2;
  }

  /// At (u, v) in texels.
  double filtered(VkSamplerAddressMode mode, double u, double v, std::uint32_t layer) const {
    const double fu = std::floor(u - 0.5), fv = std::floor(v - 0.5);
    double column[4];
    for (int j = 0; j < 4; ++j) {
      double row[4];
      for (int i = 0; i < 4; ++i)
        row[i] = texel(mode, static_cast<std::int64_t>(fu) - 1 + i, static_cast<std::int64_t>(fv) - 1 + j, layer);
      column[j] = between(u - 0.5 - fu, row);
    }
    return between(v - 0.5 - fv, column);
  }

 private:
  std::int64_t width_;
  ImageLayout layout_;
  std::vector<std::byte> memory_;
  ImageView view_;
};

Sampler cubic_sampler(VkSamplerAddressMode mode) {
  Sampler sampler;
  sampler.mag_filter = sampler.min_filter = VK_FILTER_CUBIC_EXT;
  sampler.address.fill(mode);
  sampler.border = {base::bits_of(kBorder), 0, 0, 0};
  return sampler;
}

/// The first component at coordinates of all lanes.
std::vector<float> sample_all(const ImageView& view, const Sampler& sampler, const base::WaveRegister coord[3]) {
  SampleRequest request;
  request.lod_mode = LodMode::kZero;
  request.coord = {&coord[0], &coord[1], &coord[2], nullptr};
  base::WaveRegister result[4];
  sample(view, sampler, request, result);
  std::vector<float> out;
  for (const std::uint32_t lane : result[0].lane) out.push_back(base::float_of(lane));
  return out;
}

TEST(CubicFilter, FollowsTheSpecification) {
  base::for_each_simd_target([] {
    std::mt19937 random(11);
    const auto between = [&](float a, float b) { return a + (b - a) * static_cast<float>(random() % 65536) / 65536; };
    for (const VkSamplerAddressMode mode : kModes) {
      for (const auto& [width, height] : {std::pair{16u, 8u}, {13u, 5u}, {1u, 3u}, {2u, 1u}}) {
        const Picture picture(width, height, 3, width);
        base::WaveRegister coord[3];
        for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
          coord[0].lane[lane] = base::bits_of(between(-2.5f, 3.5f));
          coord[1].lane[lane] = base::bits_of(between(-1.5f, 2.5f));
          coord[2].lane[lane] = base::bits_of(static_cast<float>(lane % 3));
        }
        const std::vector<float> seen = sample_all(picture.view(), cubic_sampler(mode), coord);
        for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
          const auto at = [&](std::size_t i, std::uint32_t size) {
            return static_cast<double>(base::float_of(coord[i].lane[lane])) * size;
          };
          const double expected =
              picture.filtered(mode, at(0, width), at(1, height), static_cast<std::uint32_t>(lane % 3));
          EXPECT_NEAR(static_cast<double>(seen[lane]), expected, 2e-3) << "mode " << mode << " lane " << lane;
        }
      }
    }
  });
}

TEST(CubicFilter, MiddlesOfTexelsAreTheTexels) {
  const Picture picture(7, 7, 1, 5);
  base::WaveRegister coord[3]{};
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    coord[0].lane[lane] = base::bits_of((static_cast<float>(lane % 7) + 0.5f));
    coord[1].lane[lane] = base::bits_of((static_cast<float>(lane / 7 % 7) + 0.5f));
  }
  Sampler sampler = cubic_sampler(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  sampler.unnormalized = true;
  const std::vector<float> seen = sample_all(picture.view(), sampler, coord);
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    const auto x = static_cast<std::int64_t>(lane % 7), y = static_cast<std::int64_t>(lane / 7 % 7);
    EXPECT_EQ(static_cast<double>(seen[lane]), picture.texel(sampler.address[0], x, y, 0));
  }
}

TEST(CubicFilter, ExtremesAreThoseOfTexelsWithWeight) {
  const Picture picture(9, 9, 1, 6);
  for (const VkSamplerReductionMode mode : {VK_SAMPLER_REDUCTION_MODE_MIN, VK_SAMPLER_REDUCTION_MODE_MAX}) {
    Sampler sampler = cubic_sampler(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    sampler.reduction = mode;
    base::WaveRegister coord[3]{};
    sampler.unnormalized = true;
    // The first lanes are middles of texels along x: only one column counts.
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
      const float fraction = lane < 8 ? 0.5f : 0.25f;
      coord[0].lane[lane] = base::bits_of(static_cast<float>(lane % 9) + fraction);
      coord[1].lane[lane] = base::bits_of(3.75f);
    }
    const std::vector<float> seen = sample_all(picture.view(), sampler, coord);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
      const auto middle = static_cast<std::int64_t>(lane % 9);
      const bool one = lane < 8;
      double least = std::numeric_limits<double>::infinity(), greatest = -least;
      for (std::int64_t y = 2; y <= 5; ++y)
        for (std::int64_t x = one ? middle : middle - 2; x <= (one ? middle : middle + 1); ++x) {
          least = std::min(least, picture.texel(sampler.address[0], x, y, 0));
          greatest = std::max(greatest, picture.texel(sampler.address[0], x, y, 0));
        }
      EXPECT_EQ(static_cast<double>(seen[lane]), mode == VK_SAMPLER_REDUCTION_MODE_MIN ? least : greatest) << lane;
    }
  }
}

/// Coordinates that are nowhere stay in the image.
TEST(CubicFilter, CoordinatesWithoutSenseAreHarmless) {
  base::for_each_simd_target([] {
    const Picture picture(16, 16, 1, 7);
    for (const VkSamplerAddressMode mode : kModes) {
      for (const bool unnormalized : {false, true}) {
        base::WaveRegister coord[3]{};
        const float hostile[] = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e9f, -1e9f, 65535.9f};
        for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
          coord[0].lane[lane] = base::bits_of(hostile[lane % 8]);
          coord[1].lane[lane] = base::bits_of(hostile[lane / 8]);
        }
        Sampler sampler = cubic_sampler(mode);
        sampler.unnormalized = unnormalized;
        EXPECT_EQ(sample_all(picture.view(), sampler, coord).size(), base::kWaveWidth);
      }
    }
  });
}

TEST(CubicFilter, BlitsScaleByIt) {
  Picture from(12, 6, 1, 8), to(30, 9, 1, 9);
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = {12, 6, 1};
  region.dstOffsets[0] = {30, 0, 0};  // turned round
  region.dstOffsets[1] = {0, 9, 1};
  blit_image(from.image(), to.image(), region, VK_FILTER_CUBIC_EXT);
  constexpr auto kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  for (std::int64_t y = 0; y < 9; ++y)
    for (std::int64_t x = 0; x < 30; ++x) {
      const double u = (30 - (static_cast<double>(x) + 0.5)) * 12 / 30, v = (static_cast<double>(y) + 0.5) * 6 / 9;
      EXPECT_NEAR(to.texel(kClamp, x, y, 0), from.filtered(kClamp, u, v, 0), 2e-3) << x << " " << y;
    }
}

}  // namespace
}  // namespace vitrine::texel
