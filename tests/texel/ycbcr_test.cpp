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

#include "texel/sampler.h"
#include "texel/transfer.h"
#include "texel/view.h"

namespace vitrine::texel {
namespace {

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

/// What the name of a format says.
struct Named {
  explicit Named(const FormatDesc& format) : name(format.name) {
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

/// An image full of random bytes, with the memory of its planes apart where it is disjoint.
struct TestImage {
  TestImage(const FormatDesc& format, bool disjoint, std::mt19937& random) : named(format) {
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

  /// Component 'R', 'G', 'B' or 'A' at a texel of its own grid, clamped to the edge.
  double component(char c, std::uint32_t layer, int x, int y) {
    const bool luma = c == 'G' || c == 'A';
    const int w = kWidth / (!luma && named.halved_x ? 2 : 1), h = kHeight / (!luma && named.halved_y ? 2 : 1);
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

  Named named;
  ImageLayout layout;
  std::vector<std::byte> memory[3];
  std::vector<ImageView> planes;
};

double mix(double a, double b, double weight) { return a + (b - a) * weight; }

/// Bilinear or nearest at texel coordinates of a grid.
template <class Read>
double filter(double u, double v, bool linear, Read read) {
  if (!linear) return read(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)));
  const int i = static_cast<int>(std::floor(u - 0.5)), j = static_cast<int>(std::floor(v - 0.5));
  const double a = u - 0.5 - i, b = v - 0.5 - j;
  return mix(mix(read(i, j), read(i + 1, j), a), mix(read(i, j + 1), read(i + 1, j + 1), a), b);
}

/// Where the chroma sample of luma texel i lies between two of its own grid.
struct Position {
  int first;
  double weight;
};
Position position(int i, bool halved, bool cosited, bool linear) {
  if (!halved) return {i, 0.0};
  const double at = linear ? (cosited ? i * 0.5 : i * 0.5 - 0.25) : std::floor(i * 0.5);
  return {static_cast<int>(std::floor(at)), at - std::floor(at)};
}

double sampled_component(TestImage& image, const Sampler& sampler, char c, double s, double t, std::uint32_t layer) {
  const YcbcrConversion& conversion = sampler.conversion;
  const Named& named = image.named;
  const double u = s * kWidth, v = t * kHeight;
  const bool linear = sampler.mag_filter == VK_FILTER_LINEAR, chroma_linear = conversion.chroma_filter != 0;
  const auto read = [&](int x, int y) { return image.component(c, layer, x, y); };
  if (c == 'G' || c == 'A' || !named.halved_x) return filter(u, v, linear, read);
  if (conversion.explicit_reconstruction) {
    return filter(u, v, linear, [&](int i, int j) {
      const Position x = position(i, named.halved_x, conversion.x_cosited, chroma_linear);
      const Position y = position(j, named.halved_y, conversion.y_cosited, chroma_linear);
      return mix(mix(read(x.first, y.first), read(x.first + 1, y.first), x.weight),
                 mix(read(x.first, y.first + 1), read(x.first + 1, y.first + 1), x.weight), y.weight);
    });
  }
  const auto scale = [&](double at, bool halved, bool cosited) {
    return halved ? 0.5 * (at + (cosited && chroma_linear ? 0.5 : 0.0)) : at;
  };
  return filter(scale(u, named.halved_x, conversion.x_cosited), scale(v, named.halved_y, conversion.y_cosited),
                chroma_linear, read);
}

void expected(TestImage& image, const Sampler& sampler, double s, double t, std::uint32_t layer, double out[4]) {
  const YcbcrConversion& conversion = sampler.conversion;
  for (std::size_t c = 0; c < 4; ++c) {
    const std::uint8_t source = conversion.swizzle[c];
    out[c] = source > 3 ? source - 4.0 : sampled_component(image, sampler, "RGBA"[source], s, t, layer);
  }
  if (conversion.model == VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY) return;
  const double n = image.named.bits, largest = std::exp2(n) - 1;
  double y = out[1], cb = out[2], cr = out[0];
  if (conversion.range == VK_SAMPLER_YCBCR_RANGE_ITU_FULL) {
    cb -= std::exp2(n - 1) / largest;
    cr -= std::exp2(n - 1) / largest;
  } else {
    y = (y * largest - 16 * std::exp2(n - 8)) / (219 * std::exp2(n - 8));
    cb = (cb * largest - 128 * std::exp2(n - 8)) / (224 * std::exp2(n - 8));
    cr = (cr * largest - 128 * std::exp2(n - 8)) / (224 * std::exp2(n - 8));
  }
  out[0] = cr, out[1] = y, out[2] = cb;
  switch (conversion.model) {
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
  conversion.explicit_reconstruction = random() % 2;
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
          << " chroma " << sampler.conversion.chroma_filter << " explicit "
          << sampler.conversion.explicit_reconstruction << " cosited " << sampler.conversion.x_cosited
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
    fetch(view, at, result);
    clear_color_image({&image.layout, image.memory[0].data()}, {}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1});
  }
}

}  // namespace
}  // namespace vitrine::texel
