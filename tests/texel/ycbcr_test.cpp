// Y'CbCr conversions against the formulas of the specification in double precision (Vulkan 1.3.239, Image Operations:
// Chroma Reconstruction, Sampler Y'CbCr Range Expansion, Sampler Y'CbCr Model Conversion), for every format that
// requires a conversion. The model reads memory by the format's name alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/texel/ycbcr_model.h"
#include "texel/sampler.h"
#include "texel/transfer.h"
#include "texel/view.h"

namespace vitrine::texel {
namespace {

using test::YcbcrModel;
using test::YcbcrName;

constexpr std::uint32_t kWidth = 14, kHeight = 10, kLayers = 2;

std::vector<const FormatDesc*> conversion_formats() {
  std::vector<const FormatDesc*> found;
  const auto add = [&](int first, int last) {
    for (int f = first; f <= last; ++f) {
      const FormatDesc& desc = format_desc(static_cast<VkFormat>(f));
      if (desc.requires_conversion()) found.push_back(&desc);
    }
  };
  add(VK_FORMAT_G8B8G8R8_422_UNORM, VK_FORMAT_G16_B16_R16_3PLANE_444_UNORM);
  add(VK_FORMAT_G8_B8R8_2PLANE_444_UNORM, VK_FORMAT_G16_B16R16_2PLANE_444_UNORM);
  return found;
}

/// An image full of random bytes, with the memory of its planes apart where it is disjoint.
struct TestImage {
  TestImage(const FormatDesc& format, bool disjoint, std::mt19937& random) : named(format.name) {
    ImageDesc desc;
    desc.format = format.format;
    desc.extent = {kWidth, kHeight, 1};
    desc.layers = kLayers;
    desc.disjoint = disjoint;
    EXPECT_TRUE(make_image_layout(desc, layout));
    for (std::uint32_t p = 0; p < (disjoint ? layout.plane_count : 1); ++p) {
      memory[p].resize(disjoint ? layout.plane[p].size + 64 : layout.size);
      for (std::byte& b : memory[p]) b = static_cast<std::byte>(random());
    }
  }

  std::byte* memory_of(std::uint32_t plane) { return memory[layout.desc.disjoint ? plane : 0].data(); }

  ImageView view() {
    ImageViewDesc desc;
    desc.type = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    desc.format = layout.desc.format;
    desc.layer_count = kLayers;
    const FormatDesc& format = format_desc(desc.format);
    for (std::uint32_t i = 0; i < format.sampled_planes; ++i) {
      const std::uint32_t memory_plane = format.plane_count > 1 ? i : 0;
      planes.push_back(make_sampled_plane(layout, memory_of(memory_plane), desc, i));
    }
    ImageView whole = make_image_view(layout, memory_of(0), desc);
    whole.planes = planes.data();
    return whole;
  }

  /// Element `index` of the row of a plane, normalised.
  double element(std::uint32_t plane, std::uint32_t layer, std::uint32_t y, std::uint32_t index) {
    const PlaneLayout& p = layout.plane[plane];
    const std::byte* at = memory_of(plane) + p.offset + layer * p.layer_stride + y * p.level[0].row_pitch +
                          index * static_cast<std::uint32_t>(named.bytes);
    std::uint32_t word = 0;
    std::memcpy(&word, at, static_cast<std::size_t>(named.bytes));
    word >>= 8 * named.bytes - named.bits;
    return word / (std::ldexp(1.0, named.bits) - 1);
  }

  YcbcrName named;
  ImageLayout layout;
  std::vector<std::byte> memory[3];
  std::vector<ImageView> planes;
};

/// The model's picture of a test image.
YcbcrModel model_of(TestImage& image, const Sampler& sampler) {
  const YcbcrConversion& c = sampler.conversion;
  YcbcrModel model{image.named, kWidth, kHeight};
  model.element = [&image](int plane, std::uint32_t layer, std::uint32_t y, std::uint32_t index) {
    return image.element(static_cast<std::uint32_t>(plane), layer, y, index);
  };
  model.model = c.model;
  model.range = c.range;
  model.swizzle = c.swizzle;
  model.linear = sampler.mag_filter == VK_FILTER_LINEAR;
  model.chroma_linear = c.chroma_filter == VK_FILTER_LINEAR;
  model.x_cosited = c.x_cosited;
  model.y_cosited = c.y_cosited;
  return model;
}

void expected(TestImage& image, const Sampler& sampler, double s, double t, std::uint32_t layer, double out[4]) {
  model_of(image, sampler).sample(s, t, layer, out);
}

Sampler random_sampler(std::mt19937& random) {
  Sampler sampler;
  sampler.address.fill(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  sampler.mag_filter = sampler.min_filter = random() % 2 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  YcbcrConversion& conversion = sampler.conversion;
  conversion.enabled = true;
  conversion.model = static_cast<VkSamplerYcbcrModelConversion>(random() % 5);
  conversion.range = static_cast<VkSamplerYcbcrRange>(random() % 2);
  conversion.x_cosited = random() % 2;
  conversion.y_cosited = random() % 2;
  conversion.chroma_filter = random() % 2 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  if (random() % 4 == 0) {
    for (std::uint8_t& s : conversion.swizzle) s = static_cast<std::uint8_t>(random() % 6);
  }
  return sampler;
}

/// Coordinates a quarter of a texel away from where a nearest texel changes, also outside the image.
float coordinate(std::mt19937& random, std::uint32_t size) {
  const int texel = static_cast<int>(random() % (size + 4)) - 2;
  const double inside = 0.25 + 0.5 * (random() % 1000) / 1000.0;
  return static_cast<float>((texel + inside) / size);
}

void check_wave(TestImage& image, const ImageView& view, const Sampler& sampler, std::mt19937& random) {
  base::WaveRegister coord[3], result[4];
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    coord[0].lane[lane] = std::bit_cast<std::uint32_t>(coordinate(random, kWidth));
    coord[1].lane[lane] = std::bit_cast<std::uint32_t>(coordinate(random, kHeight));
    coord[2].lane[lane] = std::bit_cast<std::uint32_t>(static_cast<float>(random() % kLayers));
    for (base::WaveRegister& r : result) r.lane[lane] = 0xdeadbeef;
  }
  SampleRequest request;
  request.lod_mode = LodMode::kZero;
  request.active = 0x7fffffff12345678u;
  request.coord = {&coord[0], &coord[1], &coord[2], nullptr};
  sample(view, sampler, request, result);
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    const auto at = [&](std::size_t i) { return std::bit_cast<float>(coord[i].lane[lane]); };
    double want[4];
    expected(image, sampler, at(0), at(1), static_cast<std::uint32_t>(at(2)), want);
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(request.active >> lane & 1)) {
        EXPECT_EQ(result[c].lane[lane], 0xdeadbeefu);
        continue;
      }
      ASSERT_NEAR(std::bit_cast<float>(result[c].lane[lane]), want[c], 2e-5)
          << image.named.name << " component " << c << " at " << at(0) * kWidth << ", " << at(1) * kHeight << " model "
          << sampler.conversion.model << " range " << sampler.conversion.range << " filter " << sampler.mag_filter
          << " chroma " << sampler.conversion.chroma_filter << " cosited " << sampler.conversion.x_cosited
          << sampler.conversion.y_cosited << " swizzle " << int{sampler.conversion.swizzle[0]}
          << int{sampler.conversion.swizzle[1]} << int{sampler.conversion.swizzle[2]};
    }
  }
}

TEST(Ycbcr, ConversionsFollowTheFormulas) {
  std::mt19937 random(1);
  const std::vector<const FormatDesc*> formats = conversion_formats();
  ASSERT_EQ(formats.size(), 34u);
  for (const FormatDesc* format : formats) {
    for (const bool disjoint : {false, true}) {
      TestImage image(*format, disjoint && format->plane_count > 1, random);
      const ImageView view = image.view();
      for (int i = 0; i < 40; ++i) ASSERT_NO_FATAL_FAILURE(check_wave(image, view, random_sampler(random), random));
    }
  }
}

/// The filter for minification differs from the one for magnification; chroma has its own.
TEST(Ycbcr, FiltersOfLumaAndChromaAreSeparate) {
  std::mt19937 random(2);
  for (const FormatDesc* format : conversion_formats()) {
    TestImage image(*format, false, random);
    const ImageView view = image.view();
    for (int i = 0; i < 8; ++i) {
      Sampler sampler = random_sampler(random);
      sampler.max_lod = 16;
      sampler.min_filter = VK_FILTER_LINEAR;
      sampler.mag_filter = VK_FILTER_NEAREST;
      base::WaveRegister s, t, layer, lod, result[4];
      for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
        s.lane[lane] = std::bit_cast<std::uint32_t>(coordinate(random, kWidth));
        t.lane[lane] = std::bit_cast<std::uint32_t>(coordinate(random, kHeight));
        layer.lane[lane] = 0;
        lod.lane[lane] = std::bit_cast<std::uint32_t>(lane % 2 ? 1.0f : -1.0f);
      }
      SampleRequest request;
      request.lod_mode = LodMode::kExplicit;
      request.lod = &lod;
      request.coord = {&s, &t, &layer, nullptr};
      sample(view, sampler, request, result);
      for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
        Sampler one = sampler;
        one.mag_filter = lane % 2 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
        double want[4];
        expected(image, one, std::bit_cast<float>(s.lane[lane]), std::bit_cast<float>(t.lane[lane]), 0, want);
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_NEAR(std::bit_cast<float>(result[c].lane[lane]), want[c], 2e-5)
              << image.named.name << " lane " << lane;
        }
      }
    }
  }
}

TEST(Ycbcr, CopiesMovePlanes) {
  std::mt19937 random(3);
  for (const FormatDesc* format : conversion_formats()) {
    if (format->plane_count == 1) continue;
    TestImage from(*format, true, random), to(*format, false, random);
    ImageDesc single;
    single.format = format->plane[1].format;
    single.extent = {kWidth + 3, kHeight, 1};
    ImageLayout single_layout;
    ASSERT_TRUE(make_image_layout(single, single_layout));
    std::vector<std::byte> single_memory(single_layout.size);
    const ImageMemory middle{&single_layout, single_memory.data()};
    std::array<std::byte*, 3> parts{};
    for (std::uint32_t p = 0; p < 3; ++p) parts[p] = from.memory[p].data();
    const ImageMemory source{&from.layout, nullptr, &parts}, target{&to.layout, to.memory[0].data()};
    const Extent extent = from.layout.plane[1].level[0].extent;
    const VkExtent3D size{extent.width - 1, extent.height - 2, 1};
    // Plane 1 of layer 1 to a plain image, and on to plane 1 of layer 0.
    copy_image(
        source, middle,
        {{VK_IMAGE_ASPECT_PLANE_1_BIT, 0, 1, 1}, {1, 2, 0}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {3, 1, 0}, size});
    copy_image(
        middle, target,
        {{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {3, 1, 0}, {VK_IMAGE_ASPECT_PLANE_1_BIT, 0, 0, 1}, {0, 0, 0}, size});
    const std::uint32_t bytes = format_desc(single.format).block_bytes;
    std::vector<std::byte> buffer(std::size_t{size.width} * size.height * bytes);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_PLANE_1_BIT, 0, 0, 1};
    region.imageExtent = size;
    copy_image_to_buffer(target, buffer, region);
    const PlaneLayout& plane = from.layout.plane[1];
    for (std::uint32_t y = 0; y < size.height; ++y) {
      const std::byte* want = parts[1] + plane.layer_stride + (y + 2) * plane.level[0].row_pitch + bytes;
      ASSERT_EQ(std::memcmp(&buffer[std::size_t{y} * size.width * bytes], want, std::size_t{size.width} * bytes), 0)
          << format->name << " row " << y;
    }
  }
}

/// What no valid program does must not touch memory that is not there.
TEST(Ycbcr, SamplesWithoutConversionReadLuma) {
  std::mt19937 random(4);
  for (const FormatDesc* format : conversion_formats()) {
    TestImage image(*format, false, random);
    const ImageView view = image.view();
    base::WaveRegister zero{}, result[4];
    SampleRequest request;
    request.lod_mode = LodMode::kZero;
    request.coord = {&zero, &zero, &zero, nullptr};
    sample(view, Sampler{}, request, result);
    FetchRequest at;
    at.coord = {&zero, &zero, &zero};
    fetch(view, at, {&result[0], &result[1], &result[2], &result[3]});
    clear_color_image({&image.layout, image.memory[0].data()}, {}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1});
  }
}

}  // namespace
}  // namespace vitrine::texel
