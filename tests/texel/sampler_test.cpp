// The sampler: known values by hand, and the vector paths against their scalar twin, bit by bit, on every SIMD target.
#include "texel/sampler.h"

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "tests/simd_targets.h"
#include "texel/sampler/model/anisotropic.h"
#include "texel/sampler/prepared.h"

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;

struct TestView {
  ImageLayout layout;
  std::vector<std::byte> memory;
  ImageView view;

  TestView(VkFormat format, Extent extent, std::uint32_t levels, std::uint32_t layers, VkImageViewType type) {
    ImageDesc desc;
    if (type == VK_IMAGE_VIEW_TYPE_3D) desc.type = VK_IMAGE_TYPE_3D;
    if (type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY) desc.type = VK_IMAGE_TYPE_1D;
    desc.format = format;
    desc.extent = extent;
    desc.levels = levels;
    desc.layers = layers;
    EXPECT_TRUE(make_image_layout(desc, layout));
    memory.resize(layout.size);
    ImageViewDesc vd;
    vd.type = type;
    vd.format = format;
    vd.level_count = levels;
    vd.layer_count = layers;
    vd.aspect = format_desc(format).has_depth() ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    view = make_image_view(layout, memory.data(), vd);
  }
};

base::WaveRegister constant(float value) {
  base::WaveRegister wave;
  for (std::uint32_t& lane : wave.lane) lane = bits_of(value);
  return wave;
}

std::array<float, 4> sample_one(const ImageView& view, const Sampler& sampler, float s, float t) {
  const base::WaveRegister coord[2] = {constant(s), constant(t)};
  base::WaveRegister result[4];
  SampleRequest request;
  request.lod_mode = LodMode::kZero;
  request.coord = {&coord[0], &coord[1], nullptr, nullptr};
  sample(view, sampler, request, result);
  return {float_of(result[0].lane[5]), float_of(result[1].lane[5]), float_of(result[2].lane[5]),
          float_of(result[3].lane[5])};
}

TEST(Sampler, LinearWeighsFourTexels) {
  TestView image(VK_FORMAT_R32_SFLOAT, {2, 2, 1}, 1, 1, VK_IMAGE_VIEW_TYPE_2D);
  const float texels[4] = {0, 1, 2, 3};
  for (std::uint32_t i = 0; i < 4; ++i) std::memcpy(image.view.block(0, 0, 0, i % 2, i / 2, 0), &texels[i], 4);
  Sampler sampler;
  sampler.mag_filter = sampler.min_filter = VK_FILTER_LINEAR;
  sampler.address.fill(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  EXPECT_EQ(sample_one(image.view, sampler, 0.5f, 0.5f), (std::array<float, 4>{1.5f, 0, 0, 1}));
  EXPECT_EQ(sample_one(image.view, sampler, 9.0f, -9.0f)[0], 1.0f);
  sampler.address.fill(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER);
  sampler.border = {bits_of(7.0f), 0, 0, 0};
  EXPECT_EQ(sample_one(image.view, sampler, 9.0f, 0.25f), (std::array<float, 4>{7.0f, 0, 0, 1}));
  sampler.address.fill(VK_SAMPLER_ADDRESS_MODE_REPEAT);
  EXPECT_EQ(sample_one(image.view, sampler, 1.0f, 0.25f)[0], 0.5f);
}

TEST(Sampler, BytesInterpolateIn8Bits) {
  TestView image(VK_FORMAT_R8_UNORM, {2, 1, 1}, 1, 1, VK_IMAGE_VIEW_TYPE_2D);
  *image.view.block(0, 0, 0, 1, 0, 0) = std::byte{255};
  Sampler sampler;
  sampler.mag_filter = sampler.min_filter = VK_FILTER_LINEAR;
  sampler.address.fill(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  // Weight 128 of 256: (128 * 255 + 128) >> 8 = 128.
  EXPECT_EQ(sample_one(image.view, sampler, 0.5f, 0.5f)[0], 128.0f * (1.0f / 255.0f));
}

TEST(Sampler, IntegersAreNotFiltered) {
  TestView image(VK_FORMAT_R32_UINT, {1, 1, 1}, 1, 1, VK_IMAGE_VIEW_TYPE_2D);
  const std::uint32_t value = 5;
  std::memcpy(image.view.block(0, 0, 0, 0, 0, 0), &value, 4);
  Sampler sampler;
  EXPECT_EQ(bits_of(sample_one(image.view, sampler, 0.5f, 0.5f)[0]), 5u);
  sampler.mag_filter = sampler.min_filter = VK_FILTER_LINEAR;
  EXPECT_EQ(bits_of(sample_one(image.view, sampler, 0.5f, 0.5f)[0]), 0u);
}

/// A format without a peer in the reference, one of the same values with one, and the texel of the other.
struct SameValues {
  VkFormat format, peer;
  std::uint32_t (*convert)(std::uint32_t texel);
};

constexpr SameValues kSameValues[] = {
    {VK_FORMAT_R8_SRGB, VK_FORMAT_R8G8B8A8_SRGB, [](std::uint32_t t) { return t | 0xff000000u; }},
    {VK_FORMAT_R8G8_SRGB, VK_FORMAT_R8G8B8A8_SRGB, [](std::uint32_t t) { return t | 0xff000000u; }},
    {VK_FORMAT_D16_UNORM, VK_FORMAT_R16_UNORM, [](std::uint32_t t) { return t; }},
    {VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_R32_SFLOAT,
     [](std::uint32_t t) { return bits_of(static_cast<float>(t & 0xffffff) * static_cast<float>(1.0 / 0xffffff)); }},
    {VK_FORMAT_D32_SFLOAT, VK_FORMAT_R32_SFLOAT, [](std::uint32_t t) { return t; }},
    {VK_FORMAT_R4G4B4A4_UNORM_PACK16, VK_FORMAT_B4G4R4A4_UNORM_PACK16,
     [](std::uint32_t t) { return (t & 0x0f0fu) | (t >> 8 & 0xf0u) | (t & 0xf0u) << 8; }},
#ifdef VK_VERSION_1_4
    {VK_FORMAT_A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, [](std::uint32_t t) { return t << 24; }},
    {VK_FORMAT_A1B5G5R5_UNORM_PACK16, VK_FORMAT_A1R5G5B5_UNORM_PACK16,
     [](std::uint32_t t) { return (t & 0x83e0u) | (t >> 10 & 0x1fu) | (t & 0x1fu) << 10; }},
#endif
};

TEST(Sampler, FormatsOfTheSameValuesFilterAlike) {
  std::mt19937 random(3);
  constexpr Extent kExtent{13, 9, 1};
  for (const SameValues& row : kSameValues) {
    TestView image(row.format, kExtent, 1, 1, VK_IMAGE_VIEW_TYPE_2D),
        peer(row.peer, kExtent, 1, 1, VK_IMAGE_VIEW_TYPE_2D);
    for (std::uint32_t i = 0; i < kExtent.width * kExtent.height; ++i) {
      std::uint32_t texel = static_cast<std::uint32_t>(random());
      if (row.format == VK_FORMAT_D32_SFLOAT) texel = bits_of(static_cast<float>(texel >> 8) * 0x1p-24f);
      const std::uint32_t bytes = image.view.format->block_bytes;
      if (bytes < 4) texel &= (1u << (8 * bytes)) - 1;
      const std::uint32_t other = row.convert(texel), x = i % kExtent.width, y = i / kExtent.width;
      std::memcpy(image.view.block(0, 0, 0, x, y, 0), &texel, bytes);
      std::memcpy(peer.view.block(0, 0, 0, x, y, 0), &other, peer.view.format->block_bytes);
    }
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR, VK_FILTER_CUBIC_EXT}) {
      Sampler sampler;
      sampler.mag_filter = sampler.min_filter = filter;
      for (int i = 0; i < 200; ++i) {
        const float s = static_cast<float>(random()) * 0x1p-31f - 0.5f, t = static_cast<float>(random()) * 0x1p-31f;
        ASSERT_EQ(sample_one(image.view, sampler, s, t), sample_one(peer.view, sampler, s, t))
            << image.view.format->name << " filter " << filter << " at " << s << " " << t;
      }
    }
  }
}

/// Random state of one comparison.
struct Random {
  std::mt19937 generator;
  explicit Random(unsigned seed) : generator(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(generator() % n); }
  float between(float a, float b) { return a + (b - a) * static_cast<float>(generator()) / 4294967296.0f; }
};

constexpr VkFormat kFormats[] = {
    VK_FORMAT_R8_UNORM,
    VK_FORMAT_R8G8_UNORM,
    VK_FORMAT_R8G8B8A8_UNORM,
    VK_FORMAT_B8G8R8A8_UNORM,
    VK_FORMAT_R8G8B8A8_SNORM,
    VK_FORMAT_R8G8B8A8_SRGB,
    VK_FORMAT_B8G8R8A8_SRGB,
    VK_FORMAT_R16_UNORM,
    VK_FORMAT_R16G16B16A16_UNORM,
    VK_FORMAT_R16G16_SNORM,
    VK_FORMAT_R16_SFLOAT,
    VK_FORMAT_R16G16B16A16_SFLOAT,
    VK_FORMAT_R32_SFLOAT,
    VK_FORMAT_R32G32_SFLOAT,
    VK_FORMAT_R32G32B32A32_SFLOAT,
    VK_FORMAT_A2B10G10R10_UNORM_PACK32,
    VK_FORMAT_A2R10G10B10_SNORM_PACK32,
    VK_FORMAT_B10G11R11_UFLOAT_PACK32,
    VK_FORMAT_R5G6B5_UNORM_PACK16,
    VK_FORMAT_D16_UNORM,
    VK_FORMAT_X8_D24_UNORM_PACK32,
    VK_FORMAT_D32_SFLOAT,
    VK_FORMAT_E5B9G9R9_UFLOAT_PACK32,
    VK_FORMAT_BC1_RGBA_UNORM_BLOCK,
    VK_FORMAT_BC3_SRGB_BLOCK,
    VK_FORMAT_BC5_SNORM_BLOCK,
    VK_FORMAT_BC7_UNORM_BLOCK,
    VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK,
    VK_FORMAT_EAC_R11G11_SNORM_BLOCK,
    VK_FORMAT_ASTC_8x5_UNORM_BLOCK,
    VK_FORMAT_ASTC_12x12_SRGB_BLOCK,
    VK_FORMAT_R8G8B8A8_UINT,
    VK_FORMAT_R16G16_SINT,
    VK_FORMAT_B4G4R4A4_UNORM_PACK16,
    VK_FORMAT_R5G5B5A1_UNORM_PACK16,
    VK_FORMAT_R4G4B4A4_UNORM_PACK16,
    VK_FORMAT_R8_SRGB,
    VK_FORMAT_R8G8_SRGB,
#ifdef VK_VERSION_1_4
    VK_FORMAT_A8_UNORM,
    VK_FORMAT_A1B5G5R5_UNORM_PACK16,
#endif
};

Sampler random_sampler(Random& random, bool depth) {
  constexpr VkSamplerAddressMode kModes[] = {
      VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
      VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE};
  Sampler sampler;
  const std::uint32_t modes = random.below(2) ? 5 : 2;
  for (VkSamplerAddressMode& mode : sampler.address) mode = kModes[random.below(modes)];
  sampler.mag_filter = sampler.min_filter = static_cast<VkFilter>(random.below(2));
  if (random.below(3) == 0) sampler.min_filter = static_cast<VkFilter>(random.below(2));
  if (random.below(5) == 0) sampler.mag_filter = VK_FILTER_CUBIC_EXT;
  if (random.below(6) == 0) sampler.min_filter = VK_FILTER_CUBIC_EXT;
  if (random.below(8) == 0) sampler.mag_filter = sampler.min_filter = VK_FILTER_CUBIC_EXT;
  sampler.mip_mode = static_cast<VkSamplerMipmapMode>(random.below(2));
  sampler.mip_lod_bias = random.below(2) ? random.between(-2, 2) : 0.0f;
  sampler.min_lod = random.below(3) ? 0.0f : random.between(0, 2);
  sampler.max_lod = random.below(3) ? 1000.0f : sampler.min_lod + random.between(0, 3);
  sampler.compare = depth && random.below(2);
  sampler.compare_op = static_cast<VkCompareOp>(random.below(8));
  sampler.border = {bits_of(random.between(-1, 2)), bits_of(0.5f), bits_of(0.0f), bits_of(1.0f)};
  if (random.below(4) == 0) sampler.reduction = static_cast<VkSamplerReductionMode>(random.below(3));
  if (random.below(6) == 0) sampler.max_anisotropy = 8.0f;
  return sampler;
}

struct Inputs {
  base::WaveRegister coord[4], lod, dref, ddx[3], ddy[3], offset[3];
};

Inputs random_inputs(Random& random) {
  Inputs in;
  const float step = std::exp2(random.between(-9, 1));
  const bool smooth = random.below(2) != 0;  // neighbours in all coordinates, as on a surface
  const float depth = random.between(-1, 2);
  for (std::uint32_t i = 0; i < base::kWaveWidth; ++i) {
    const float x = static_cast<float>((i / 4 * 2) + (i & 1)), y = static_cast<float>(i >> 1 & 1);
    in.coord[0].lane[i] = bits_of(smooth || random.below(60) ? x * step - 1.0f : float_of(0x7fc00000u));
    in.coord[1].lane[i] = bits_of(y * step + random.between(-0.01f, 0.01f) + 0.3f);
    in.coord[2].lane[i] = bits_of(smooth ? depth + (x + y) * step * 0.1f : random.between(-1, 4));
    in.coord[3].lane[i] = bits_of(random.between(-1, 4));
    in.lod.lane[i] = bits_of(random.between(-2, 6));
    in.dref.lane[i] = bits_of(random.between(-0.2f, 1.2f));
    for (std::size_t c = 0; c < 3; ++c) {
      in.ddx[c].lane[i] = bits_of(random.between(-0.2f, 0.2f));
      in.ddy[c].lane[i] = bits_of(random.between(-0.2f, 0.2f));
      in.offset[c].lane[i] = random.below(16) - 8;
    }
  }
  return in;
}

void fill_texels(TestView& image, Random& random, bool finite) {
  for (std::byte& b : image.memory) b = static_cast<std::byte>(random.generator());
  if (!finite) return;
  const Channel& channel = image.view.format->channel[0];
  if (channel.numeric != Numeric::kSfloat && channel.numeric != Numeric::kUfloat) return;
  // Keep exponents small: infinities make NaN, whose bits no one promises.
  for (std::size_t i = 0; i + 4 <= image.memory.size(); i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, &image.memory[i], 4);
    word = channel.bits == 32 ? (word & 0x87ffffffu) | 0x38000000u
                              : word & 0xbfffbfffu & ~(1u << 10 | 1u << 21 | 1u << 31);
    std::memcpy(&image.memory[i], &word, 4);
  }
}

/// A view type with what it needs: dimensions of its coordinates, layers of its image.
struct Shape {
  VkImageViewType type;
  std::uint32_t coordinates;  ///< without the layer
  std::uint32_t layers;
  bool arrayed;
};

constexpr Shape kShapes[] = {
    {VK_IMAGE_VIEW_TYPE_2D, 2, 1, false},      {VK_IMAGE_VIEW_TYPE_2D, 2, 1, false},
    {VK_IMAGE_VIEW_TYPE_2D_ARRAY, 2, 3, true}, {VK_IMAGE_VIEW_TYPE_1D, 1, 1, false},
    {VK_IMAGE_VIEW_TYPE_1D_ARRAY, 1, 4, true}, {VK_IMAGE_VIEW_TYPE_3D, 3, 1, false},
    {VK_IMAGE_VIEW_TYPE_CUBE, 3, 6, false},    {VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, 3, 12, true},
};

Extent random_extent(Random& random, const Shape& shape, bool compressed) {
  const std::uint32_t sizes[] = {1, 5, 13, 16, 37, 64};
  Extent extent{sizes[random.below(6)], sizes[random.below(6)], sizes[random.below(3)]};
  if (shape.coordinates == 1) extent.height = 1;
  if (shape.type != VK_IMAGE_VIEW_TYPE_3D || compressed) extent.depth = 1;
  if (shape.layers >= 6) extent.height = extent.width;
  return extent;
}

constexpr std::array<std::array<std::int32_t, 2>, 4> kGatherOffsets{{{0, 1}, {-8, 3}, {7, -8}, {2, 0}}};

/// One random configuration: scalar twin against vector path. Returns whether there was a vector path.
bool compare_paths(unsigned seed, bool anisotropic = false) {
  Random random(seed);
  const VkFormat format = kFormats[random.below(std::size(kFormats))];
  Shape shape = kShapes[random.below(std::size(kShapes))];
  const bool compressed = format_desc(format).is_compressed();
  if (compressed && shape.coordinates == 1) shape = kShapes[0];
  const Extent extent = random_extent(random, shape, compressed);
  const std::uint32_t levels =
      random.below(2) ? static_cast<std::uint32_t>(std::bit_width(std::max(extent.width, extent.height))) : 1;
  TestView image(format, extent, levels, shape.layers, shape.type);
  if (random.below(3) == 0) image.view.swizzle = {2, 5, 0, 4};
  fill_texels(image, random, !anisotropic || random.below(4) != 0);
  Sampler sampler = random_sampler(random, image.view.format->has_depth());
  if (anisotropic) sampler.max_anisotropy = 2.0f;
  Inputs in = random_inputs(random);
  SampleRequest request;
  request.lod_mode = static_cast<LodMode>(random.below(5));
  if (random.below(4) == 0 && shape.coordinates > 1 && shape.type != VK_IMAGE_VIEW_TYPE_3D) {
    request.op = SampleOp::kGather;
    request.lod_mode = LodMode::kZero;
    request.gather_component = random.below(4);
    if (shape.layers < 6 && random.below(3) == 0) request.gather_offsets = &kGatherOffsets;
  } else if (random.below(8) == 0) {
    request.op = SampleOp::kQueryLod;
  }
  for (std::uint32_t i = 0; i < shape.coordinates + (shape.arrayed ? 1 : 0); ++i) request.coord[i] = &in.coord[i];
  const bool derived = request.lod_mode == LodMode::kImplicit || request.lod_mode == LodMode::kBias;
  request.quads = derived || request.op == SampleOp::kQueryLod || random.below(2) != 0;
  request.lod = &in.lod;
  request.ddx = {&in.ddx[0], &in.ddx[1], &in.ddx[2]};
  request.ddy = {&in.ddy[0], &in.ddy[1], &in.ddy[2]};
  if (random.below(2) && shape.layers < 6 && request.gather_offsets == nullptr) {
    const bool same_offset = random.below(2) != 0;
    for (std::uint32_t i = 0; i < shape.coordinates; ++i) {
      request.offset[i] = &in.offset[i];
      if (same_offset) std::fill_n(in.offset[i].lane, base::kWaveWidth, in.offset[i].lane[0]);
    }
  }
  if (sampler.compare) request.dref = &in.dref;
  const base::ScopedFloatMode mode(random.below(2) ? base::Denormals::kFlush : base::Denormals::kHonour);
  request.active = random.below(2) ? base::kAllLanes : random.generator() * base::LaneMask{0x9E3779B97F4A7C15u};
  PreparedSampler prepared;
  prepare(image.view, sampler, request.op, request.lod_mode, prepared);
  if (prepared.kernel == sample_by_lane) return false;
  base::WaveRegister expected[4] = {}, result[4] = {};
  sample_scalar(prepared.plan, request, expected);
  SampleResult wanted{};
  for (std::size_t c = 0; c < 4; ++c) wanted[c] = random.below(4) ? &result[c] : nullptr;
  sample(prepared, request, wanted);
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t lane = 0; wanted[c] != nullptr && lane < base::kWaveWidth; ++lane) {
      const std::uint32_t a = expected[c].lane[lane], b = result[c].lane[lane];
      const bool both_nan = float_of(a) != float_of(a) && float_of(b) != float_of(b);
      EXPECT_TRUE(a == b || both_nan) << "seed " << seed << " " << image.view.format->name << " type " << shape.type
                                      << " component " << c << " lane " << lane << std::hex << " scalar " << a
                                      << " vector " << b;
      if (testing::Test::HasFailure()) return true;
    }
  }
  return true;
}

void compare_paths_of_every_target(unsigned seeds, bool anisotropic) {
  base::for_each_simd_target([&] {
    unsigned compared = 0;
    for (unsigned seed = 0; seed < seeds && !testing::Test::HasFailure(); ++seed)
      compared += compare_paths(seed, anisotropic);
    EXPECT_GT(compared, seeds * 3 / 4);
  });
}

TEST(Sampler, VectorPathsEqualTheScalarOne) { compare_paths_of_every_target(2000, false); }
TEST(Sampler, AnisotropicVectorPathsEqualTheScalarOne) { compare_paths_of_every_target(1500, true); }

TEST(Sampler, EwaWeightsFollowFromTheirFactors) {
  const EwaFactors& f = kEwaFactors;
  for (std::size_t i = 0; i < kEwaWeights.size(); ++i) {
    const float whole = f.whole[i / 32];
    const float millionths = whole + std::nearbyint(std::fma(whole, f.less[i % 32], f.rest[i / 32]));
    const float weight = std::fma(millionths, EwaFactors::kMillionth, millionths * EwaFactors::kMillionthRest);
    EXPECT_EQ(weight, kEwaWeights[i]) << i;
  }
}

/// Pages of memory with none before and behind them.
class LonePages {
 public:
  explicit LonePages(std::size_t bytes) : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    size_ = (bytes + page_ - 1) / page_ * page_;
    memory_ = static_cast<std::byte*>(mmap(nullptr, size_ + 2 * page_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    open(0, size_);
  }
  LonePages(const LonePages&) = delete;
  LonePages& operator=(const LonePages&) = delete;
  ~LonePages() { munmap(memory_, size_ + 2 * page_); }

  std::byte* begin() { return memory_ + page_; }
  std::byte* end() { return begin() + size_; }
  std::size_t page() const { return page_; }
  void close(std::size_t first, std::size_t bytes) { mprotect(begin() + first, bytes, PROT_NONE); }
  void open(std::size_t first, std::size_t bytes) { mprotect(begin() + first, bytes, PROT_READ | PROT_WRITE); }

 private:
  std::size_t page_, size_ = 0;
  std::byte* memory_ = nullptr;
};

constexpr VkFormat kGuardedFormats[] = {
    VK_FORMAT_R8_UNORM,      VK_FORMAT_R8G8_UNORM, VK_FORMAT_R5G6B5_UNORM_PACK16, VK_FORMAT_R8G8B8A8_UNORM,
    VK_FORMAT_R8G8B8A8_UINT, VK_FORMAT_R16_UNORM,  VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};

TEST(Sampler, LanesWithoutAQuadTouchNothing) {
  base::for_each_simd_target([] {
    for (const VkFormat format : kGuardedFormats) {
      TestView image(format, {64, 1024, 1}, 1, 1, VK_IMAGE_VIEW_TYPE_2D);
      LonePages pages(image.layout.size);
      image.view.base = pages.begin();
      const std::size_t rows = std::size_t{1} << 9;  // in their lower half nothing may be read
      const std::size_t half = rows * image.view.level[0].row_pitch / pages.page() * pages.page();
      pages.close(half, pages.page() * ((image.layout.size - half) / pages.page()));
      for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR, VK_FILTER_CUBIC_EXT}) {
        for (const SampleOp op : {SampleOp::kSample, SampleOp::kGather}) {
          Sampler sampler;
          sampler.mag_filter = sampler.min_filter = filter;
          base::WaveRegister coord[2] = {constant(0.4f), constant(0.1f)}, result[4];
          std::fill_n(coord[1].lane + 24, 20, bits_of(0.9f));
          SampleRequest request;
          request.op = op;
          request.coord = {&coord[0], &coord[1], nullptr, nullptr};
          request.active = ~(base::first_lanes(44) & ~base::first_lanes(24));
          sample(image.view, sampler, request, result);
        }
      }
    }
  });
}

TEST(Sampler, NothingIsReadBehindTheLastTexel) {
  base::for_each_simd_target([] {
    for (const VkFormat format : kGuardedFormats) {
      TestView image(format, {64, 64, 1}, 1, 1, VK_IMAGE_VIEW_TYPE_2D);
      const LevelLayout& level = image.view.level[0];
      const std::size_t bytes = 63 * level.row_pitch + 64 * image.view.format->block_bytes;
      LonePages pages(bytes);
      image.view.base = pages.end() - bytes;
      for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR, VK_FILTER_CUBIC_EXT}) {
        for (const VkSamplerAddressMode mode :
             {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
              VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER}) {
          Sampler sampler;
          sampler.mag_filter = sampler.min_filter = filter;
          sampler.address.fill(mode);
          base::WaveRegister coord[2], result[4];
          for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
            coord[0].lane[lane] = bits_of(0.93f + 0.001f * static_cast<float>(lane));
            coord[1].lane[lane] = bits_of(0.999f);
          }
          SampleRequest request;
          request.lod_mode = LodMode::kZero;
          request.coord = {&coord[0], &coord[1], nullptr, nullptr};
          sample(image.view, sampler, request, result);
        }
      }
    }
  });
}

}  // namespace
}  // namespace vitrine::texel
