// The ways a primitive may take against packed waves alone: the same draws with and without the fast paths leave the
// same bytes, whatever the state, the formats and the number of samples.
#include "raster/tile/rasterize.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <mutex>
#include <random>
#include <vector>

#include "raster/observe.h"
#include "raster/output/blend.h"
#include "raster/pass.h"
#include "raster/stage.h"

namespace vitrine::raster {
namespace {

constexpr std::uint32_t kWidth = 205, kHeight = 141;  // blocks stick out to the right and below

struct Corner {
  float position[4], color[4];
};

base::LaneMask shade_vertices(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                              base::LaneMask active, base::LaneMask) {
  const auto* corners = static_cast<const Corner*>(user);
  base::for_each_lane(active, [&](std::size_t lane) {
    const Corner& corner = corners[in[0].lane[lane]];
    for (std::size_t c = 0; c < 4; ++c) {
      out[c].lane[lane] = std::bit_cast<std::uint32_t>(corner.position[c]);
      out[4 + c].lane[lane] = std::bit_cast<std::uint32_t>(corner.color[c]);
    }
  });
  return active;
}

/// Inputs 0..3 are the colour, 4..7 gl_FragCoord, 8 gl_FrontFacing: everything has to show. Some fragments are dropped
/// if `user` says so.
base::LaneMask shade_fragments(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                               base::LaneMask active, base::LaneMask helpers) {
  base::LaneMask kept = active & ~helpers;
  base::for_each_lane(active, [&](std::size_t lane) {
    const auto value = [&](std::size_t reg) { return std::bit_cast<float>(in[reg].lane[lane]); };
    const float red = value(0) + value(4) * 0.001f + value(6) * 0.1f;
    const float green = value(1) + value(5) * 0.001f + value(7) * 0.05f;
    if (*static_cast<const bool*>(user) && (in[0].lane[lane] >> 12 & 3) == 0) kept &= ~(base::LaneMask{1} << lane);
    out[0].lane[lane] = std::bit_cast<std::uint32_t>(red);
    out[1].lane[lane] = std::bit_cast<std::uint32_t>(green);
    out[2].lane[lane] = in[8].lane[lane] ? in[2].lane[lane] : in[3].lane[lane];
    out[3].lane[lane] = in[3].lane[lane];
  });
  return kept;
}

spirv::InterfaceSlot slot(spirv::BuiltIn built_in, std::uint32_t component, std::uint32_t reg) {
  spirv::InterfaceSlot result;
  result.built_in = built_in;
  result.component = static_cast<std::uint8_t>(component);
  result.reg = reg;
  return result;
}

/// An attachment with its memory.
struct Attachment {
  texel::ImageLayout layout;
  std::vector<std::byte> memory;
  texel::ImageView view;

  Attachment(VkFormat format, std::uint32_t samples) {
    texel::ImageDesc desc;
    desc.format = format;
    desc.extent = {kWidth, kHeight, 1};
    desc.samples = samples;
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    memory.resize(layout.size);  // no byte more: reads beyond the image are found by the sanitizer
    texel::ImageViewDesc view_desc;
    view_desc.format = format;
    view = texel::make_image_view(layout, memory.data(), view_desc);
  }
};

/// Draws of one random state.
struct Scene {
  State state;
  NativeShader vertex, fragment;
  std::vector<Corner> corners;
  std::array<std::uint32_t, 4> constants{};
  VkFormat color_format, depth_format;
  std::uint32_t samples;
  bool drops;
  DrawObserver* observer = nullptr;

  explicit Scene(std::mt19937& random) {
    const VkFormat colors[] = {VK_FORMAT_R8G8B8A8_UNORM,      VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_A8B8G8R8_UNORM_PACK32,
                               VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8_UNORM,       VK_FORMAT_R16G16B16A16_SFLOAT,
                               VK_FORMAT_R8G8B8A8_SRGB};
    const VkFormat depths[] = {VK_FORMAT_UNDEFINED, VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32,
                               VK_FORMAT_D32_SFLOAT};
    color_format = colors[random() % (random() % 2 ? 3 : std::size(colors))];
    depth_format = depths[random() % std::size(depths)];
    samples = random() % 3 ? 1 : 4;
    drops = random() % 3 == 0;
    set_state(random);
    set_shaders(random);
    for (std::uint32_t i = 0; i < 12; ++i) add_triangle(random, i % 4 == 0 ? 4.0f : 0.9f);
    for (std::uint32_t i = 0; i < 80; ++i) add_triangle(random, 0.05f);  // a few pixels
    for (std::uint32_t i = 0; i < 80; ++i) add_triangle(random, 0.18f);  // up to 16x16
  }

  void draw(bool general, Attachment& color, Attachment* depth, std::uint64_t& passed) {
    PassDesc desc;
    desc.color[0] = color.view;
    desc.color_count = 1;
    if (depth) desc.depth = depth->view;
    desc.render_area = {{0, 0}, {kWidth, kHeight}};
    desc.samples = samples;
    std::atomic<std::uint64_t> count{0};
    {
      Pass pass(desc);
      pass.draw(call(general, count));
    }
    passed = count;
  }

  DrawCall call(bool general, std::atomic<std::uint64_t>& count) {
    DrawCall call;
    call.state = &state;
    vertex.user = corners.data();
    fragment.constants = fragment.run == keep_all ? constants.data() : nullptr;
    fragment.user = &drops;
    call.native_vertex = &vertex;
    call.native_fragment = &fragment;
    call.count = static_cast<std::uint32_t>(corners.size());
    call.general_path = general;
    call.queries.occlusion = &count;
    call.observer = observer;
    return call;
  }

  /// A triangle over everything, its depth `z` and `slope` more from side to side.
  void add_layer(float z, float slope) {
    for (int k = 0; k < 3; ++k)
      corners.push_back({{k == 1 ? 3.0f : -1.0f, k == 2 ? 3.0f : -1.0f, z + slope * static_cast<float>(k), 1.0f},
                         {z, 0.1f * static_cast<float>(k), 0.5f, 1.0f}});
  }

  void add_triangle(std::mt19937& random, float size) {
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const bool flat = random() % 3 == 0;  // w = 1 everywhere
    const float cx = unit(random) * 2 - 1, cy = unit(random) * 2 - 1;
    for (int k = 0; k < 3; ++k) {
      Corner c;
      const float w = flat ? 1.0f : 0.5f + unit(random) * 2;
      c.position[0] = (cx + (unit(random) - 0.5f) * size) * w;
      c.position[1] = (cy + (unit(random) - 0.5f) * size) * w;
      c.position[2] = (unit(random) * 1.2f - 0.1f) * w;
      c.position[3] = w;
      for (float& value : c.color) value = unit(random);
      corners.push_back(c);
    }
  }

 private:
  void set_state(std::mt19937& random) {
    state.viewport[0] = {0, 0, kWidth, kHeight, random() % 2 ? 0.0f : 0.9f, random() % 2 ? 1.0f : 0.2f};
    state.scissor[0] = {{0, 0}, {kWidth, kHeight}};
    if (random() % 2)
      state.scissor[0] = {{static_cast<std::int32_t>(random() % 64), static_cast<std::int32_t>(random() % 64)},
                          {141, 77}};
    state.samples = samples;
    state.sample_mask = random() % 4 ? ~0u : static_cast<std::uint32_t>(random());
    state.depth_clamp = random() % 2;
    state.depth_clip = !state.depth_clamp;
    state.depth_test = random() % 4 != 0;
    state.depth_write = random() % 2;
    state.depth_compare = static_cast<VkCompareOp>(random() % 8);
    if (random() % 3 == 0) {
      state.depth_bias = true;
      state.depth_bias_constant = static_cast<float>(random() % 100) - 50;
      state.depth_bias_slope = static_cast<float>(random() % 10) * 0.25f;
    }
    for (float& constant : state.blend_constants) constant = static_cast<float>(random() % 256) / 255;
    BlendAttachment& blend = state.blend[0];
    blend.enable = random() % 2;
    blend.src_color = static_cast<VkBlendFactor>(random() % 15);
    blend.dst_color = static_cast<VkBlendFactor>(random() % 15);
    blend.src_alpha = random() % 2 ? blend.src_color : static_cast<VkBlendFactor>(random() % 15);
    blend.dst_alpha = random() % 2 ? blend.dst_color : static_cast<VkBlendFactor>(random() % 15);
    blend.color_op = kBlendOps[random() % kBlendOps.size()];
    blend.alpha_op = random() % 2 ? blend.color_op : kBlendOps[random() % kBlendOps.size()];
    blend.write_mask = random() % 3 ? 0xf : random() % 16;
    state.logic_op_enable = random() % 10 == 0;
    state.logic_op = static_cast<VkLogicOp>(random() % 16);
    state.overestimates = random() % 8 == 0;
    state.discard_count = random() % 6 ? 0 : 1 + random() % kMaxDiscardRectangles;
    state.discard_inside = random() % 2;
    for (VkRect2D& rect : state.discard)
      rect = {{static_cast<std::int32_t>(random() % kWidth), static_cast<std::int32_t>(random() % kHeight)},
              {static_cast<std::uint32_t>(random() % kWidth), static_cast<std::uint32_t>(random() % kHeight)}};
  }

  void set_shaders(std::mt19937& random) {
    vertex.interface.inputs = {slot(spirv::BuiltIn::kVertexIndex, 0, 0)};
    vertex.run = shade_vertices;
    fragment.run = shade_fragments;
    const bool solid = random() % 3 == 0;
    for (std::uint32_t c = 0; c < 4; ++c) {
      vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kPosition, c, c));
      vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, 4 + c));
      fragment.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
      constants[c] = std::bit_cast<std::uint32_t>(static_cast<float>(random() % 1000) / 900);
      if (solid) continue;
      fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
      fragment.interface.inputs.back().interpolation = static_cast<spirv::Interpolation>(random() % 3);
    }
    if (solid) {
      fragment.constants = constants.data();
      fragment.run = keep_all;
      drops = false;
      return;
    }
    for (std::uint32_t c = 0; c < 4; ++c)
      fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kFragCoord, c, 4 + c));
    fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kFrontFacing, 0, 8));
    fragment.interface.uses_discard = drops;
    fragment.interface.early_fragment_tests = random() % 3 == 0;
    fragment.interface.needs_helpers = random() % 2;
  }

  static base::LaneMask keep_all(const void*, const base::WaveRegister*, base::WaveRegister*, base::LaneMask active,
                                 base::LaneMask helpers) {
    return active & ~helpers;
  }
};

std::uint64_t bits_of(base::LaneMask lanes) { return static_cast<std::uint64_t>(std::popcount(lanes)); }

/// What becomes of samples; of fragments, as those are told who take numbers, and how they are shaded.
struct FragmentSums : DrawObserver {
  explicit FragmentSums(bool takes) : takes_numbers(takes) {}
  const bool takes_numbers;
  std::atomic<std::uint64_t> generated{0}, lost{0}, passed{0};
  std::mutex mutex;
  FragmentNumbers numbers;
  std::uint64_t invocations = 0, helpers = 0, waves = 0;

  struct Watch : DrawWatch {
    explicit Watch(FragmentSums& sums) : out(sums) {}
    ~Watch() override {
      const std::lock_guard lock(out.mutex);
      out.numbers.generated += mine.generated;
      for (std::size_t i = 0; i < kFragmentTests; ++i) out.numbers.ended[i] += mine.ended[i];
      out.numbers.passed += mine.passed;
      out.numbers.texels += mine.texels;
      out.numbers.bytes += mine.bytes;
      out.invocations += invocations;
      out.helpers += helpers;
      out.waves += waves;
    }
    void generated(const FragmentGroup&, SampleLanes lanes) override {
      add(out.generated, lanes);
      mine.generated += fragments(lanes);
    }
    void failed(const FragmentGroup&, FragmentTest test, SampleLanes lost, SampleLanes left) override {
      add(out.lost, lost);
      mine.ended[static_cast<std::size_t>(test)] += bits_of(any_of(lost) & ~any_of(left));
    }
    void shaded(const FragmentGroup&, base::LaneMask used, base::LaneMask helping) override {
      invocations += bits_of(used);
      helpers += bits_of(helping);
      ++waves;
    }
    void passed(const FragmentGroup&, SampleLanes lanes) override {
      add(out.passed, lanes);
      mine.passed += fragments(lanes);
    }
    void written(const FragmentGroup&, const texel::ImageView& view, SampleLanes lanes) override {
      for (const base::LaneMask mask : lanes) {
        mine.texels += bits_of(mask);
        mine.bytes += bits_of(mask) * view.format->block_bytes;
      }
    }
    bool takes_numbers() const override { return out.takes_numbers; }
    void numbers(const FragmentNumbers& numbers) override { mine = numbers; }
    void shaded_blocks(base::LaneMask places) override {
      invocations += bits_of(places) * base::kWaveWidth;
      waves += bits_of(places);
    }

    static base::LaneMask any_of(SampleLanes lanes) {
      base::LaneMask any = 0;
      for (const base::LaneMask mask : lanes) any |= mask;
      return any;
    }
    static std::uint64_t fragments(SampleLanes lanes) { return bits_of(any_of(lanes)); }
    static void add(std::atomic<std::uint64_t>& sum, SampleLanes lanes) {
      for (const base::LaneMask mask : lanes) sum += bits_of(mask);
    }
    FragmentSums& out;
    FragmentNumbers mine;
    std::uint64_t invocations = 0, helpers = 0, waves = 0;
  };
  std::unique_ptr<DrawWatch> watch_chunk(const spirv::ObservedCommand*) override { return nullptr; }
  std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand*, std::uint32_t) override {
    return std::make_unique<Watch>(*this);
  }
};

void expect_same(const FragmentSums& one, const FragmentSums& other, int scene) {
  EXPECT_EQ(one.numbers.generated, other.numbers.generated) << "case " << scene;
  EXPECT_EQ(one.numbers.ended, other.numbers.ended) << "case " << scene;
  EXPECT_EQ(one.numbers.passed, other.numbers.passed) << "case " << scene;
  EXPECT_EQ(one.numbers.texels, other.numbers.texels) << "case " << scene;
  EXPECT_EQ(one.numbers.bytes, other.numbers.bytes) << "case " << scene;
  EXPECT_EQ(one.invocations, other.invocations) << "case " << scene;
  EXPECT_EQ(one.helpers, other.helpers) << "case " << scene;
  EXPECT_EQ(one.waves, other.waves) << "case " << scene;
}

Attachment copy_of(const Attachment& attachment, VkFormat format, std::uint32_t samples) {
  Attachment copy(format, samples);
  std::copy(attachment.memory.begin(), attachment.memory.end(), copy.memory.begin());
  return copy;
}

TEST(Routes, FastPathsAndObservedDrawsEqualTheGeneralOne) {
  std::mt19937 random(11);
  std::uint32_t drawn = 0;
  for (int n = 0; n < 300; ++n) {
    Scene scene(random);
    Attachment color[2] = {{scene.color_format, scene.samples}, {scene.color_format, scene.samples}};
    for (std::size_t i = 0; i < color[0].memory.size(); ++i)
      color[0].memory[i] = color[1].memory[i] = static_cast<std::byte>(random() & 0x3f);
    const bool has_depth = scene.depth_format != VK_FORMAT_UNDEFINED;
    const VkFormat depth_format = has_depth ? scene.depth_format : VK_FORMAT_D16_UNORM;
    Attachment depth[2] = {{depth_format, scene.samples}, {depth_format, scene.samples}};
    for (std::size_t i = 0; i + 4 <= depth[0].memory.size(); i += 4) {
      std::uint32_t word = std::bit_cast<std::uint32_t>(static_cast<float>(random() % 1000) / 1000);
      if (depth_format == VK_FORMAT_X8_D24_UNORM_PACK32) word = static_cast<std::uint32_t>(random()) & 0xffffff;
      if (depth_format == VK_FORMAT_D16_UNORM) word = static_cast<std::uint32_t>(random());
      for (Attachment& attachment : depth) std::memcpy(attachment.memory.data() + i, &word, 4);
    }
    const std::vector<std::byte> before = color[0].memory;
    const Attachment first_color = copy_of(color[0], scene.color_format, scene.samples);
    const Attachment first_depth = copy_of(depth[0], depth_format, scene.samples);
    std::uint64_t passed[3];
    for (std::size_t i = 0; i < 2; ++i) scene.draw(i == 1, color[i], has_depth ? &depth[i] : nullptr, passed[i]);
    ASSERT_EQ(color[0].memory, color[1].memory) << "case " << n << ", format " << scene.color_format;
    ASSERT_EQ(depth[0].memory, depth[1].memory) << "case " << n << ", format " << depth_format;
    ASSERT_EQ(passed[0], passed[1]) << "case " << n;
    FragmentSums sums(false), numbers(true);
    for (FragmentSums* observer : {&numbers, &sums}) {
      Attachment observed_color = copy_of(first_color, scene.color_format, scene.samples);
      Attachment observed_depth = copy_of(first_depth, depth_format, scene.samples);
      scene.observer = observer;
      scene.draw(false, observed_color, has_depth ? &observed_depth : nullptr, passed[2]);
      ASSERT_EQ(color[0].memory, observed_color.memory) << "observed, case " << n;
      ASSERT_EQ(depth[0].memory, observed_depth.memory) << "observed, case " << n;
      ASSERT_EQ(passed[0], passed[2]) << "observed, case " << n;
    }
    expect_same(sums, numbers, n);
    ASSERT_EQ(sums.generated, sums.lost + sums.passed) << "case " << n;
    const bool counts_before = scene.fragment.interface.early_fragment_tests;
    ASSERT_TRUE(counts_before || sums.passed == passed[0]) << "case " << n;
    drawn += color[0].memory != before;
  }
  EXPECT_GT(drawn, 170u);
}

/// Draws with all kinds of depth tests and clears in between, in one pass: what has been learnt of the stored depths
/// never rejects what the general path draws.
TEST(Routes, HierarchicalRejectionIsNotNoticed) {
  std::mt19937 random(23);
  const auto unit = [&] { return static_cast<float>(random() % 1001) / 1000; };
  for (int n = 0; n < 60; ++n) {
    std::vector<Scene> scenes;
    for (std::size_t i = 0; i < 8; ++i) {
      Scene& scene = scenes.emplace_back(random);
      State& state = scene.state;
      state.depth_test = random() % 8 != 0;
      state.depth_write = random() % 3 != 0;
      const VkCompareOp likely = n % 2 ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_GREATER_OR_EQUAL;
      if (random() % 4 != 0) state.depth_compare = likely;
      state.unrestricted_depth = random() % 16 == 0;
      scene.corners.clear();
      for (int k = 0; k < 10; ++k) scene.add_layer(unit(), random() % 2 ? unit() * 0.1f : 0.0f);
      for (int k = 0; k < 30; ++k) scene.add_triangle(random, 0.3f);
    }
    const VkFormat formats[] = {VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT};
    const VkFormat color_format = VK_FORMAT_R8G8B8A8_UNORM, depth_format = formats[n % 3];
    const std::uint32_t samples = n % 4 == 0 ? 4 : 1;
    Attachment color[2] = {{color_format, samples}, {color_format, samples}};
    Attachment depth[2] = {{depth_format, samples}, {depth_format, samples}};
    const float clears[] = {unit(), 0.0f, 1.0f, unit()};
    std::uint64_t passed[2][8];
    for (std::size_t i = 0; i < 2; ++i) {
      PassDesc desc;
      desc.color[0] = color[i].view;
      desc.color_count = 1;
      desc.depth = depth[i].view;
      desc.render_area = {{0, 0}, {kWidth, kHeight}};
      desc.samples = samples;
      std::atomic<std::uint64_t> counts[8] = {};
      {
        Pass pass(desc);
        for (std::size_t k = 0; k < scenes.size(); ++k) {
          if (k % 3 == 0)
            pass.clear_depth_stencil(VK_IMAGE_ASPECT_DEPTH_BIT, {clears[k / 3 + static_cast<std::size_t>(n % 2)], 0},
                                     {{k == 0 ? 0 : 20, 0}, {kWidth, 100}}, 0, 1);
          Scene& scene = scenes[k];
          scene.state.samples = samples;
          pass.draw(scene.call(i == 1, counts[k]));
        }
      }
      for (std::size_t k = 0; k < scenes.size(); ++k) passed[i][k] = counts[k];
    }
    ASSERT_EQ(color[0].memory, color[1].memory) << "case " << n;
    ASSERT_EQ(depth[0].memory, depth[1].memory) << "case " << n;
    for (std::size_t k = 0; k < scenes.size(); ++k) ASSERT_EQ(passed[0][k], passed[1][k]) << "case " << n << ' ' << k;
  }
}

}  // namespace
}  // namespace vitrine::raster
