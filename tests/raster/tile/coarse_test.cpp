// Fragments of several pixels against fragments of one whose shader works out for itself which fragment it would be a
// part of: the same bytes, whatever pipeline, primitives and attachment ask for.
#include "raster/tile/coarse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>
#include <vector>

#include "raster/observe.h"
#include "raster/pass.h"
#include "raster/stage.h"

namespace vitrine::raster {
namespace {

constexpr std::uint32_t kWidth = 141, kHeight = 77;  // fragments stick out to the right and below
constexpr VkExtent2D kTexel{16, 8};
constexpr std::uint32_t kColumns = (kWidth + 15) / 16 - 1, kRows = (kHeight + 7) / 8;  // the last column is missing

struct Corner {
  float position[4];
  std::uint32_t color, rate;
};

base::LaneMask shade_vertices(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                              base::LaneMask active, base::LaneMask) {
  const auto* corners = static_cast<const Corner*>(user);
  base::for_each_lane(active, [&](std::size_t lane) {
    const Corner& corner = corners[in[0].lane[lane]];
    for (std::size_t c = 0; c < 4; ++c) out[c].lane[lane] = std::bit_cast<std::uint32_t>(corner.position[c]);
    out[4].lane[lane] = corner.color;
    out[5].lane[lane] = corner.rate;  // as a varying, and as the rate
  });
  return active;
}

spirv::InterfaceSlot slot(spirv::BuiltIn built_in, std::uint32_t component, std::uint32_t reg) {
  spirv::InterfaceSlot result;
  result.built_in = built_in;
  result.component = static_cast<std::uint8_t>(component);
  result.reg = reg;
  result.type = built_in == spirv::BuiltIn::kNone ? spirv::BaseType::kUint : spirv::BaseType::kFloat;
  return result;
}

struct Attachment {
  texel::ImageLayout layout;
  std::vector<std::byte> memory;
  texel::ImageView view;

  Attachment(VkFormat format, std::uint32_t samples, std::uint32_t width = kWidth, std::uint32_t height = kHeight) {
    texel::ImageDesc desc;
    desc.format = format;
    desc.extent = {width, height, 1};
    desc.samples = samples;
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    memory.resize(layout.size);  // no byte more: reads beyond the image are found by the sanitizer
    texel::ImageViewDesc view_desc;
    view_desc.format = format;
    view = texel::make_image_view(layout, memory.data(), view_desc);
  }
};

/// What the fragment shader knows. Of the model all, of the others nothing but what drops fragments.
struct Knowledge {
  bool model = false;
  bool drops = false, writes_depth = false;
  FragmentRates rates;
  const Attachment* texels = nullptr;

  std::uint32_t rate_at(std::uint32_t primitive, std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t column = x / kTexel.width, row = y / kTexel.height;
    const bool has = texels && column < kColumns && row < kRows;
    const auto texel = has ? std::to_integer<std::uint32_t>(*texels->view.block(0, 0, 0, column, row, 0)) : 0;
    return rates.with_attachment(rates.with_primitive(primitive), texel);
  }
};

/// Inputs: FragCoord.xy, colour, rate of the primitive, ShadingRate. What is written tells the fragment's centre, its
/// primitive and its rate.
base::LaneMask shade_fragments(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                               base::LaneMask active, base::LaneMask helpers) {
  const auto& knows = *static_cast<const Knowledge*>(user);
  base::LaneMask kept = active & ~helpers;
  base::for_each_lane(active, [&](std::size_t lane) {
    float x = std::bit_cast<float>(in[0].lane[lane]), y = std::bit_cast<float>(in[1].lane[lane]);
    std::uint32_t rate = knows.model ? 0 : in[4].lane[lane];
    if (knows.model) {
      const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
      rate = knows.rate_at(in[3].lane[lane], column, row);
      const std::uint32_t width = 1u << (rate >> 2), height = 1u << (rate & 3);
      x = static_cast<float>(column / width * width) + static_cast<float>(width) / 2;
      y = static_cast<float>(row / height * height) + static_cast<float>(height) / 2;
    }
    const auto hash = static_cast<std::uint32_t>(2 * x) * 2654435761u ^ static_cast<std::uint32_t>(2 * y) * 40503u;
    if (knows.drops && (hash >> 9 & 3) == 0) kept &= ~(base::LaneMask{1} << lane);
    out[0].lane[lane] = static_cast<std::uint32_t>(2 * x);
    out[1].lane[lane] = static_cast<std::uint32_t>(2 * y);
    out[2].lane[lane] = rate + 1;
    out[3].lane[lane] = in[2].lane[lane];
    if (knows.writes_depth) out[4].lane[lane] = std::bit_cast<std::uint32_t>(static_cast<float>(hash % 1000) / 1000);
  });
  return kept;
}

struct Invocations : DrawObserver {
  std::atomic<std::uint64_t> count{0};

  struct Watch : DrawWatch {
    explicit Watch(Invocations& sums) : out(sums) {}
    void shaded(const FragmentGroup&, base::LaneMask used, base::LaneMask) override {
      out.count += static_cast<std::uint64_t>(std::popcount(used));
    }
    Invocations& out;
  };
  std::unique_ptr<DrawWatch> watch_chunk(const spirv::ObservedCommand*) override { return nullptr; }
  std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand*, std::uint32_t) override {
    return std::make_unique<Watch>(*this);
  }
};

/// Draws of one random state.
struct Scene {
  State state;
  NativeShader vertex, fragment;
  std::vector<Corner> corners;
  Knowledge knows;
  std::uint32_t samples = 1;
  bool of_primitives = false, attached = false;
  Attachment texels{VK_FORMAT_R8_UINT, 1, kColumns, kRows};
  DrawObserver* observer = nullptr;

  explicit Scene(std::mt19937& random) {
    samples = 1u << random() % 4;
    of_primitives = random() % 2;
    attached = random() % 2;
    for (std::byte& texel : texels.memory) texel = static_cast<std::byte>((random() % 3) << 2 | random() % 3);
    set_state(random);
    set_shaders(random);
    for (std::uint32_t i = 0; i < 40; ++i) add_triangle(random, i % 8 == 0 ? 3.0f : i % 2 ? 0.3f : 0.06f);
  }

  void set_state(std::mt19937& random) {
    state.viewport[0] = {0, 0, kWidth, kHeight, 0, 1};
    state.scissor[0] = {{0, 0}, {kWidth, kHeight}};
    if (random() % 2) state.scissor[0] = {{static_cast<std::int32_t>(random() % 32), 5}, {91, 53}};
    state.samples = samples;
    state.sample_mask = random() % 4 || samples == 1 ? ~0u : static_cast<std::uint32_t>(random());
    state.depth_test = random() % 4 != 0;
    state.depth_write = random() % 2;
    state.depth_compare = random() % 2 ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_GREATER_OR_EQUAL;
    state.polygon_mode = random() % 6 ? VK_POLYGON_MODE_FILL : VK_POLYGON_MODE_LINE;
    state.overestimates = random() % 8 == 0;
    state.discard_count = random() % 6 ? 0 : 1;
    state.discard[0] = {{40, 13}, {33, 41}};
    state.fragment_size = {1u << random() % 3, 1u << random() % 3};
    for (auto& op : state.rate_combiners) op = static_cast<VkFragmentShadingRateCombinerOpKHR>(random() % 5);
  }

  void set_shaders(std::mt19937& random) {
    vertex.interface.inputs = {slot(spirv::BuiltIn::kVertexIndex, 0, 0)};
    vertex.run = shade_vertices;
    fragment.run = shade_fragments;
    for (std::uint32_t c = 0; c < 4; ++c) {
      vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kPosition, c, c));
      fragment.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
    }
    for (std::uint32_t c = 0; c < 2; ++c) {
      vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, 4 + c));
      fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kFragCoord, c, c));
    }
    for (std::uint32_t c = 0; c < 2; ++c) fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kNone, c, 2 + c));
    knows.writes_depth = random() % 4 == 0;
    knows.drops = random() % 2;
    if (knows.writes_depth) fragment.interface.outputs.push_back(slot(spirv::BuiltIn::kFragDepth, 0, 4));
    fragment.interface.uses_discard = knows.drops;
    fragment.interface.early_fragment_tests = random() % 3 == 0;
    fragment.interface.needs_helpers = random() % 2;
    fragment.interface.writes_memory = random() % 4 == 0;  // primitive by primitive
  }

  void add_triangle(std::mt19937& random, float size) {
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const float cx = unit(random) * 2 - 1, cy = unit(random) * 2 - 1;
    const auto color = static_cast<std::uint32_t>(corners.size());
    for (int k = 0; k < 3; ++k)
      corners.push_back({{cx + (unit(random) - 0.5f) * size, cy + (unit(random) - 0.5f) * size, unit(random), 1.0f},
                         color,
                         static_cast<std::uint32_t>(random() % 3 << 2 | random() % 3)});
  }

  /// Draws by the rates, or as the model.
  std::uint64_t draw(bool model, Attachment& color, Attachment& depth) {
    PassDesc desc;
    desc.color[0] = color.view;
    desc.color_count = 1;
    desc.depth = depth.view;
    desc.render_area = {{0, 0}, {kWidth, kHeight}};
    desc.samples = samples;
    if (attached && !model) {
      desc.shading_rate = &texels.view;
      desc.shading_rate_texel = kTexel;
    }
    State used = state;
    NativeShader before = vertex, after = fragment;
    knows.model = model;
    knows.texels = attached ? &texels : nullptr;
    knows.rates.samples = samples;
    knows.rates.pipeline = clamp_rate(rate_of_size(state.fragment_size.width, state.fragment_size.height), samples);
    knows.rates.primitive_op = state.rate_combiners[0];
    knows.rates.attachment_op = state.rate_combiners[1];
    if (model) {
      used.fragment_size = {1, 1};
    } else {
      after.interface.inputs.push_back(slot(spirv::BuiltIn::kShadingRate, 0, 4));
      if (of_primitives) before.interface.outputs.push_back(slot(spirv::BuiltIn::kPrimitiveShadingRate, 0, 5));
    }
    before.user = corners.data();
    after.user = &knows;
    std::atomic<std::uint64_t> count{0};
    DrawCall call;
    call.state = &used;
    call.native_vertex = &before;
    call.native_fragment = &after;
    call.count = static_cast<std::uint32_t>(corners.size());
    call.queries.occlusion = &count;
    call.observer = observer;
    {
      Pass pass(desc);
      pass.draw(call);
    }
    return count;
  }
};

void fill(Attachment& color, Attachment& depth) {
  std::fill(color.memory.begin(), color.memory.end(), std::byte{0});
  const float half = 0.5f;
  for (std::size_t i = 0; i + 4 <= depth.memory.size(); i += 4) std::memcpy(depth.memory.data() + i, &half, 4);
}

TEST(CoarseFragments, ArePixelsThatKnowTheirFragment) {
  std::mt19937 random(5);
  std::uint32_t coarse = 0, drawn = 0;
  for (int n = 0; n < 200; ++n) {
    Scene scene(random);
    if (!scene.of_primitives)
      for (Corner& corner : scene.corners) corner.rate = 0;
    Attachment color[3] = {{VK_FORMAT_R16G16B16A16_UINT, scene.samples},
                           {VK_FORMAT_R16G16B16A16_UINT, scene.samples},
                           {VK_FORMAT_R16G16B16A16_UINT, scene.samples}};
    Attachment depth[3] = {{VK_FORMAT_D32_SFLOAT, scene.samples},
                           {VK_FORMAT_D32_SFLOAT, scene.samples},
                           {VK_FORMAT_D32_SFLOAT, scene.samples}};
    std::uint64_t passed[3];
    Invocations observer;
    for (std::size_t i = 0; i < 3; ++i) {
      fill(color[i], depth[i]);
      scene.observer = i == 2 ? &observer : nullptr;
      passed[i] = scene.draw(i == 1, color[i], depth[i]);
    }
    for (std::size_t i = 1; i < 3; ++i) {
      ASSERT_EQ(color[0].memory, color[i].memory) << "case " << n << " of " << scene.samples << " samples, " << i;
      ASSERT_EQ(depth[0].memory, depth[i].memory) << "case " << n << " of " << scene.samples << " samples, " << i;
      ASSERT_EQ(passed[0], passed[i]) << "case " << n << ", " << i;
    }
    drawn += std::any_of(color[0].memory.begin(), color[0].memory.end(), [](std::byte b) { return b != std::byte{0}; });
    const texel::ImageView& view = color[0].view;
    for (std::uint32_t x = 0, found = 0; x < kWidth && !found; ++x) {
      std::uint16_t rate;
      std::memcpy(&rate, view.block(0, 0, 0, x, kHeight / 2, 0) + 4, 2);
      found = rate > 1;
      coarse += found;
    }
  }
  EXPECT_GT(drawn, 180u);
  EXPECT_GT(coarse, 80u);
}

/// A triangle over all of the framebuffer, none of which is clipped: of two, fragments on the edge would be twice.
void cover(Scene& scene) {
  scene.corners = {{{-1, -1, 0, 1}, 7, 0}, {{1, -1, 0, 1}, 7, 0}, {{-1, 1, 0, 1}, 7, 0}};
  scene.state = {};
  scene.state.viewport[0] = {0, 0, 3 * kWidth, 3 * kHeight, 0, 1};
  scene.state.scissor[0] = {{0, 0}, {kWidth, kHeight}};
  scene.state.samples = scene.samples;
  scene.of_primitives = scene.attached = scene.knows.drops = scene.knows.writes_depth = false;
}

TEST(CoarseFragments, AreShadedOnce) {
  std::mt19937 random(6);
  for (std::uint32_t rate = 0; rate < kFragmentRates; ++rate) {
    if (make_rate(rate >> 2, rate & 3) != rate) continue;
    Scene scene(random);
    scene.samples = 1;
    cover(scene);
    const std::uint32_t width = 1u << (rate >> 2), height = 1u << (rate & 3);
    scene.state.fragment_size = {width, height};
    Attachment color(VK_FORMAT_R16G16B16A16_UINT, 1), depth(VK_FORMAT_D32_SFLOAT, 1);
    Invocations observer;
    scene.observer = &observer;
    EXPECT_EQ(scene.draw(false, color, depth), kWidth * kHeight);
    EXPECT_EQ(observer.count, ((kWidth + width - 1) / width) * ((kHeight + height - 1) / height));
  }
}

/// Sample shading, and shaders that ask for it, know no larger fragments.
TEST(CoarseFragments, AreOfOnePixelWithSampleShading) {
  std::mt19937 random(7);
  for (int n = 0; n < 4; ++n) {
    Scene scene(random);
    scene.samples = n % 2 ? 4 : 1;
    cover(scene);
    scene.state.fragment_size = {2, 2};
    if (n < 2)
      scene.state.sample_shading = true;
    else
      scene.fragment.interface.per_sample = true;
    Attachment color(VK_FORMAT_R16G16B16A16_UINT, scene.samples), depth(VK_FORMAT_D32_SFLOAT, scene.samples);
    Invocations observer;
    scene.observer = &observer;
    scene.draw(false, color, depth);
    EXPECT_EQ(observer.count, kWidth * kHeight * (n == 3 ? 4 : 1)) << n;
    std::uint16_t rate;
    std::memcpy(&rate, color.memory.data() + 4, 2);
    EXPECT_EQ(rate, 1) << n;
  }
}

/// Vulkan 1.3.239, Sample Mask Test: bit 0 of the mask is that of the only sample.
TEST(CoarseFragments, HeedTheMaskOfOneSample) {
  std::mt19937 random(9);
  for (const std::uint32_t mask : {1u, 2u}) {
    Scene scene(random);
    scene.samples = 1;
    cover(scene);
    scene.state.fragment_size = {2, 2};
    scene.state.sample_mask = mask;
    Attachment color(VK_FORMAT_R16G16B16A16_UINT, 1), depth(VK_FORMAT_D32_SFLOAT, 1);
    EXPECT_EQ(scene.draw(false, color, depth), mask == 1 ? kWidth * kHeight : 0) << mask;
  }
}

/// What a fragment shader for masks gets and gives: out[0] is the mask, out[1] what it is to be.
struct Masks {
  std::uint32_t keep;
};

base::LaneMask shade_masks(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                           base::LaneMask active, base::LaneMask helpers) {
  base::for_each_lane(active, [&](std::size_t lane) {
    out[0].lane[lane] = in[0].lane[lane];
    out[1].lane[lane] = static_cast<const Masks*>(user)->keep;
  });
  return active & ~helpers;
}

/// Vulkan 1.3.239, Multisampling: sample i of pixel p of r samples and n pixels is bit i + r (n - 1 - p).
TEST(CoarseFragments, HaveMasksOfAllSamples) {
  std::mt19937 random(8);
  for (const std::uint32_t samples : {1u, 4u}) {
    Scene scene(random);
    scene.samples = samples;
    cover(scene);
    scene.state.fragment_size = {2, 2};
    scene.state.scissor[0] = {{0, 0}, {5, 3}};
    const Masks keep{samples == 1 ? 0b1011u : 0xf1ffu};
    scene.fragment = {};
    scene.fragment.run = shade_masks;
    scene.fragment.user = &keep;
    scene.fragment.interface.inputs = {slot(spirv::BuiltIn::kSampleMask, 0, 0)};
    scene.fragment.interface.outputs = {slot(spirv::BuiltIn::kNone, 0, 0), slot(spirv::BuiltIn::kSampleMask, 0, 1)};
    Attachment color(VK_FORMAT_R32_UINT, samples);
    PassDesc desc;
    desc.color[0] = color.view;
    desc.color_count = 1;
    desc.render_area = {{0, 0}, {kWidth, kHeight}};
    desc.samples = samples;
    scene.vertex.user = scene.corners.data();
    DrawCall call;
    call.state = &scene.state;
    call.native_vertex = &scene.vertex;
    call.native_fragment = &scene.fragment;
    call.count = 3;
    {
      Pass pass(desc);
      pass.draw(call);
    }
    const std::uint32_t pixel = (1u << samples) - 1;
    for (std::uint32_t y = 0; y < 4; ++y)
      for (std::uint32_t x = 0; x < 6; ++x)
        for (std::uint32_t s = 0; s < samples; ++s) {
          std::uint32_t expected = 0;
          for (std::uint32_t p = 0; p < 4; ++p)
            if ((x & ~1u) + p % 2 < 5 && (y & ~1u) + p / 2 < 3) expected |= pixel << samples * (3 - p);
          const std::uint32_t bit = s + samples * (3 - (x % 2 + 2 * (y % 2)));
          if (x >= 5 || y >= 3 || (keep.keep >> bit & 1) == 0) expected = 0;
          std::uint32_t found;
          std::memcpy(&found, color.view.block(0, 0, s, x, y, 0), 4);
          EXPECT_EQ(found, expected) << samples << " samples, " << x << ' ' << y << ' ' << s;
        }
  }
}

base::LaneMask shade_place(const void*, const base::WaveRegister* in, base::WaveRegister* out, base::LaneMask active,
                           base::LaneMask helpers) {
  base::for_each_lane(active, [&](std::size_t lane) {
    for (std::size_t c = 0; c < 4; ++c) out[c].lane[lane] = in[c].lane[lane];
  });
  return active & ~helpers;
}

base::LaneMask place_vertices(const void*, const base::WaveRegister* in, base::WaveRegister* out, base::LaneMask active,
                              base::LaneMask) {
  base::for_each_lane(active, [&](std::size_t lane) {
    const std::uint32_t i = in[0].lane[lane];
    const float x = i == 1 ? 1.0f : -1.0f, y = i == 2 ? 1.0f : -1.0f;
    const float values[] = {x, y, 0, 1, (x + 1) * 128, (y + 1) * 128, (x + 1) * 128, (y + 1) * 128};
    for (std::size_t c = 0; c < 8; ++c) out[c].lane[lane] = std::bit_cast<std::uint32_t>(values[c]);
  });
  return active;
}

/// Varyings at the centre of the fragment and, where it is not wholly covered, at the centroid in a covered pixel.
TEST(CoarseFragments, InterpolateAtTheirCentres) {
  State state;
  state.viewport[0] = {0, 0, 256, 256, 0, 1};
  state.scissor[0] = {{3, 0}, {64, 64}};
  state.fragment_size = {4, 2};
  NativeShader vertex, fragment;
  vertex.run = place_vertices;
  fragment.run = shade_place;
  vertex.interface.inputs = {slot(spirv::BuiltIn::kVertexIndex, 0, 0)};
  for (std::uint32_t c = 0; c < 4; ++c) {
    vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kPosition, c, c));
    vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, 4 + c));
    fragment.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
    fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
    fragment.interface.inputs.back().type = spirv::BaseType::kFloat;
    if (c >= 2) fragment.interface.inputs.back().sample_location = spirv::SampleLocation::kCentroid;
  }
  Attachment color(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 64, 64);
  PassDesc desc;
  desc.color[0] = color.view;
  desc.color_count = 1;
  desc.render_area = {{0, 0}, {64, 64}};
  DrawCall call;
  call.state = &state;
  call.native_vertex = &vertex;
  call.native_fragment = &fragment;
  call.count = 3;
  {
    Pass pass(desc);
    pass.draw(call);
  }
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 3; x < 64; ++x) {
      float found[4];
      std::memcpy(found, color.view.block(0, 0, 0, x, y, 0), 16);
      const float cx = static_cast<float>(x & ~3u) + 2, cy = static_cast<float>(y & ~1u) + 1;
      ASSERT_NEAR(found[0], cx, 1e-4) << x << ' ' << y;
      ASSERT_NEAR(found[1], cy, 1e-4) << x << ' ' << y;
      ASSERT_NEAR(found[2], x == 3 ? 3.5f : cx, 1e-4) << x << ' ' << y;
      ASSERT_NEAR(found[3], x == 3 ? cy - 0.5f : cy, 1e-4) << x << ' ' << y;
    }
}

TEST(FragmentRates, AreClampedToWhatTheSamplesAllow) {
  EXPECT_EQ(clamp_rate(make_rate(2, 2), 1), make_rate(2, 2));
  EXPECT_EQ(clamp_rate(make_rate(2, 2), 4), make_rate(2, 1));  // 4x2 and 2x4 are as large: the wide one
  EXPECT_EQ(clamp_rate(make_rate(2, 2), 8), make_rate(1, 1));
  EXPECT_EQ(clamp_rate(make_rate(2, 1), 8), make_rate(1, 1));  // 4x1 is as large and longer
  EXPECT_EQ(clamp_rate(make_rate(0, 2), 8), make_rate(0, 2));
  EXPECT_EQ(rate_of_size(4, 2), make_rate(2, 1));
}

TEST(FragmentRates, AreCombinedSideBySide) {
  const FragmentRate wide = make_rate(2, 0), high = make_rate(0, 1);
  EXPECT_EQ(combine_rates(VK_FRAGMENT_SHADING_RATE_COMBINER_OP_KEEP_KHR, wide, high), wide);
  EXPECT_EQ(combine_rates(VK_FRAGMENT_SHADING_RATE_COMBINER_OP_REPLACE_KHR, wide, high), high);
  EXPECT_EQ(combine_rates(VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MIN_KHR, wide, high), make_rate(0, 0));
  EXPECT_EQ(combine_rates(VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MAX_KHR, wide, high), make_rate(2, 1));
  EXPECT_EQ(combine_rates(VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MUL_KHR, high, high), make_rate(0, 2));
  EXPECT_EQ(combine_rates(VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MUL_KHR, wide, wide), wide);
}

}  // namespace
}  // namespace vitrine::raster
