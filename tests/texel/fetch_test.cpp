// Reads and writes by integer coordinates: the vector paths against the codecs, texel by texel, for every plain format
// on every SIMD target.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "tests/simd_targets.h"
#include "texel/capabilities.h"
#include "texel/codec.h"
#include "texel/load_store/prepared_access.h"
#include "texel/load_store/shape.h"
#include "texel/sampler.h"
#include "texel/sampler/plan.h"

namespace vitrine::texel {
namespace {

struct TestImage {
  ImageLayout layout;
  std::vector<std::byte> memory;
  ImageView view;
};

TestImage make_image(const FormatDesc& format, VkImageViewType type, std::uint32_t samples) {
  TestImage image;
  const Shape shape = shape_of(type);
  ImageDesc desc;
  if (shape.dims == 1) desc.type = VK_IMAGE_TYPE_1D;
  if (shape.dims == 3) desc.type = VK_IMAGE_TYPE_3D;
  desc.format = format.format;
  desc.extent = {37, shape.dims > 1 ? 37u : 1u, shape.dims > 2 ? 5u : 1u};
  desc.levels = samples > 1 ? 1 : 3;
  desc.layers = shape.layered ? 6 : 1;
  desc.samples = samples;
  EXPECT_TRUE(make_image_layout(desc, image.layout));
  image.memory.resize(image.layout.size);
  ImageViewDesc view;
  view.type = type;
  view.format = format.format;
  view.level_count = desc.levels;
  view.layer_count = desc.layers;
  view.aspect = format.has_depth()     ? VK_IMAGE_ASPECT_DEPTH_BIT
                : format.has_stencil() ? VK_IMAGE_ASPECT_STENCIL_BIT
                                       : VK_IMAGE_ASPECT_COLOR_BIT;
  image.view = make_image_view(image.layout, image.memory.data(), view);
  return image;
}

/// Numbers of every kind: around the limits of the formats, and any bits.
std::uint32_t random_value(std::mt19937& random) {
  const auto any = static_cast<std::uint32_t>(random());
  switch (random() % 8) {
    case 0:
      return any;
    case 1:
      return any % 1024 - 512;
    case 2:
      return any & 0x807fffffu;  // a denormal
    case 3:
      return base::bits_of(static_cast<float>(static_cast<std::int32_t>(any)) * 0x1p-15f);
    default:
      return base::bits_of(static_cast<float>(static_cast<std::int32_t>(any)) * 0x1.4p-31f);
  }
}

struct Wave {
  base::WaveRegister coord[3], lod, sample, value[4];
  base::LaneMask active = 0;
};

/// Coordinates in rows of 4, 8, 16 or 64 texels, some of them partly outside, and now and then a lane that is
/// elsewhere; or anywhere.
Wave random_wave(std::mt19937& random) {
  Wave wave;
  wave.active = random() % 2 != 0 ? base::kAllLanes : random() * base::LaneMask{0x9E3779B97F4A7C15u};
  const bool rows = random() % 3 != 0, one_level = random() % 2 != 0;
  constexpr std::uint32_t kLengths[] = {4, 8, 16, 64};
  const std::uint32_t length = kLengths[random() % 4], left = random() % 40 - 4, top = random() % 38 - 1;
  const std::uint32_t level = random() % 3;
  for (std::uint32_t i = 0; i < base::kWaveWidth; ++i) {
    wave.coord[0].lane[i] = rows ? left + i % length : random() % 41 - 2;
    wave.coord[1].lane[i] = rows ? top + i / length : random() % 41 - 2;
    wave.coord[2].lane[i] = rows ? top % 4 : random() % 8 - 1;
    wave.lod.lane[i] = one_level ? level : random() % 5 - 1;
    wave.sample.lane[i] = rows ? top % 4 : random() % 5;
    for (base::WaveRegister& value : wave.value) value.lane[i] = random_value(random);
  }
  if (random() % 3 == 0) wave.coord[random() % 2].lane[random() % base::kWaveWidth] = random() % 41 - 2;
  return wave;
}

FetchRequest request_of(const Wave& wave, const ImageView& view) {
  FetchRequest request;
  request.active = wave.active;
  request.coord = {&wave.coord[0], &wave.coord[1], &wave.coord[2]};
  if (shape_of(view.type).dims == 1) request.coord[2] = nullptr;
  if (view.samples > 1) {
    request.sample = &wave.sample;
  } else {
    request.lod = &wave.lod;
  }
  return request;
}

/// Null: outside.
std::byte* texel_at(const ImageView& view, const FetchRequest& request, std::size_t lane) {
  const Shape shape = shape_of(view.type);
  const std::uint32_t level = request.lod != nullptr ? request.lod->lane[lane] : 0;
  const std::uint32_t sample = request.sample != nullptr ? request.sample->lane[lane] : 0;
  if (level >= view.level_count || sample >= view.samples) return nullptr;
  const Extent& extent = view.level[level].extent;
  std::uint32_t at[3] = {};
  for (std::uint32_t i = 0; i < shape.dims; ++i) at[i] = request.coord[i]->lane[lane];
  const std::uint32_t layer = shape.layered ? request.coord[shape.dims]->lane[lane] : 0;
  if (at[0] >= extent.width || at[1] >= extent.height || at[2] >= extent.depth || layer >= view.layer_count)
    return nullptr;
  return view.block(level, layer, sample, at[0], at[1], at[2]);
}

Texel expected_texel(const FormatDesc& format, const std::byte* at) {
  Texel texel{0, 0, 0, format.rgba[3] < 0 ? (format.is_integer() ? 1u : 0x3f800000u) : 0u};
  if (at != nullptr) texel_decoder(format)(format, at, texel);
  return texel;
}

bool same_value(const FormatDesc& format, std::uint32_t a, std::uint32_t b) {
  const float x = base::float_of(a), y = base::float_of(b);
  return a == b || (!format.is_integer() && x != x && y != y);
}

constexpr std::uint32_t kUntouched = 0xDEADBEEFu;

struct Results {
  base::WaveRegister of[4];
  Results() { std::fill_n(of[0].lane, 4 * base::kWaveWidth, kUntouched); }
  SampleResult all() { return {&of[0], &of[1], &of[2], &of[3]}; }
};

void check_results(const FormatDesc& format, const Wave& wave, const base::WaveRegister result[4],
                   const std::function<const std::byte*(std::size_t)>& at, const ImageView* view) {
  base::for_each_lane(wave.active, [&](std::size_t lane) {
    Texel expected = expected_texel(format, at(lane));
    if (view != nullptr) apply_swizzle(*view, expected);
    for (std::size_t c = 0; c < 4 && !testing::Test::HasFailure(); ++c) {
      EXPECT_TRUE(same_value(format, expected[c], result[c].lane[lane]))
          << format.name << " component " << c << " lane " << lane << std::hex << " expected " << expected[c]
          << " found " << result[c].lane[lane];
    }
  });
  base::for_each_lane(~wave.active, [&](std::size_t lane) {
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(kUntouched, result[c].lane[lane]) << format.name;
  });
}

void store_by_lane(const FormatDesc& format, const Wave& wave, const std::function<std::byte*(std::size_t)>& at) {
  base::for_each_lane(wave.active, [&](std::size_t lane) {
    const Texel texel{wave.value[0].lane[lane], wave.value[1].lane[lane], wave.value[2].lane[lane],
                      wave.value[3].lane[lane]};
    if (std::byte* to = at(lane)) texel_encoder(format, Encoding::kStore)(format, texel, to);
  });
}

StoredValue value_of(const Wave& wave) { return {&wave.value[0], &wave.value[1], &wave.value[2], &wave.value[3]}; }

void check_image(const FormatDesc& format, VkImageViewType type, std::uint32_t samples, std::mt19937& random) {
  TestImage image = make_image(format, type, samples);
  for (std::byte& b : image.memory) b = static_cast<std::byte>(random());
  const Wave wave = random_wave(random);
  FetchRequest request = request_of(wave, image.view);
  if (random() % 2 == 0) request.lod = nullptr;
  Results result;
  fetch(image.view, request, result.all());
  check_results(
      format, wave, result.of, [&](std::size_t lane) { return texel_at(image.view, request, lane); }, &image.view);
  if (!can_store(format)) return;
  const std::vector<std::byte> before = image.memory;
  store(image.view, request, value_of(wave));
  const std::vector<std::byte> stored = image.memory;
  image.memory.assign(before.begin(), before.end());
  store_by_lane(format, wave, [&](std::size_t lane) { return texel_at(image.view, request, lane); });
  EXPECT_EQ(stored, image.memory) << format.name << " type " << type << " samples " << samples;
}

void check_buffer(const FormatDesc& format, std::mt19937& random) {
  constexpr std::uint32_t kTexels = 61;
  std::vector<std::byte> memory(std::size_t{kTexels} * format.block_bytes);  // and nothing behind it
  for (std::byte& b : memory) b = static_cast<std::byte>(random());
  const BufferTexelView view{memory.data(), kTexels, &format};
  const Wave wave = random_wave(random);
  const auto at = [&](std::size_t lane) {
    const std::size_t i = wave.coord[0].lane[lane];
    return i < kTexels ? memory.data() + i * format.block_bytes : nullptr;
  };
  Results result;
  fetch_buffer(view, wave.active, wave.coord[0], result.all());
  check_results(format, wave, result.of, at, nullptr);
  if (!can_store(format)) return;
  const std::vector<std::byte> before = memory;
  store_buffer(view, wave.active, wave.coord[0], value_of(wave));
  const std::vector<std::byte> stored = memory;
  memory.assign(before.begin(), before.end());
  store_by_lane(format, wave, at);
  EXPECT_EQ(stored, memory) << format.name;
}

void check_formats() {
  std::mt19937 random(11);
  for (std::uint32_t i = 1; i <= VK_FORMAT_X8_D24_UNORM_PACK32 + 10; ++i) {
    const FormatDesc& format = format_desc(static_cast<VkFormat>(i));
    if (!can_decode(format)) continue;
    for (const base::Denormals denormals : {base::Denormals::kFlush, base::Denormals::kHonour}) {
      const base::ScopedFloatMode mode(denormals);
      for (const VkImageViewType type :
           {VK_IMAGE_VIEW_TYPE_1D, VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_VIEW_TYPE_3D, VK_IMAGE_VIEW_TYPE_CUBE,
            VK_IMAGE_VIEW_TYPE_1D_ARRAY, VK_IMAGE_VIEW_TYPE_2D_ARRAY}) {
        check_image(format, type, 1, random);
      }
      check_image(format, VK_IMAGE_VIEW_TYPE_2D, 4, random);
      for (int repeat = 0; repeat < 8; ++repeat) check_image(format, VK_IMAGE_VIEW_TYPE_2D, 1, random);
      for (int repeat = 0; repeat < 8; ++repeat) check_buffer(format, random);
      if (testing::Test::HasFailure()) return;
    }
  }
}

/// Fetches whose results are the registers of their coordinates.
bool check_overwriting(const FormatDesc& format, VkImageViewType type, std::mt19937& random) {
  TestImage image = make_image(format, type, 1);
  for (std::byte& b : image.memory) b = static_cast<std::byte>(random());
  Wave wave = random_wave(random);
  FetchRequest request = request_of(wave, image.view);
  request.lod = nullptr;
  base::WaveRegister expected[4], found[4];
  fetch(image.view, request, {&expected[0], &expected[1], &expected[2], &expected[3]});
  SampleResult result{&found[0], &found[1], &found[2], &found[3]};
  result[random() % 3] = &wave.coord[0];
  if (shape_of(image.view.type).dims > 1) result[3] = &wave.coord[1];
  const PreparedFetch prepared = prepare_fetch(image.view, request, result);
  if (!prepared.is_ready()) return false;
  fetch(prepared, wave.active);
  for (std::size_t c = 0; c < 4; ++c) {
    base::for_each_lane(wave.active, [&](std::size_t lane) {
      EXPECT_EQ(expected[c].lane[lane], result[c]->lane[lane]) << format.name << " type " << type;
    });
  }
  return true;
}

TEST(Fetch, ResultsMayOverwriteCoordinates) {
  base::for_each_simd_target([] {
    std::mt19937 random(12);
    int ready = 0;
    for (std::uint32_t i = 1; i <= VK_FORMAT_X8_D24_UNORM_PACK32 + 10 && !testing::Test::HasFailure(); ++i) {
      const FormatDesc& format = format_desc(static_cast<VkFormat>(i));
      if (!can_decode(format)) continue;
      for (const VkImageViewType type :
           {VK_IMAGE_VIEW_TYPE_1D, VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_VIEW_TYPE_3D, VK_IMAGE_VIEW_TYPE_2D_ARRAY})
        for (int repeat = 0; repeat < 4; ++repeat) ready += check_overwriting(format, type, random);
    }
    EXPECT_GT(ready, 500);
  });
}

TEST(Fetch, WavesEqualTheCodecs) {
  base::for_each_simd_target([] { check_formats(); });
}

}  // namespace
}  // namespace vitrine::texel
