// What observers of draws are told of primitives and fragments, in numbers that can be counted by hand.
#include "raster/observe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "raster/pass.h"
#include "raster/primitive_instances.h"
#include "raster/stage.h"

namespace vitrine::raster {
namespace {

constexpr std::uint32_t kSide = 64;

struct Corner {
  float position[4];
  float cull_distance = 0;
};

/// Outputs 0..3: the position, 4: a cull distance.
base::LaneMask shade_vertices(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                              base::LaneMask active, base::LaneMask) {
  const auto* corners = static_cast<const Corner*>(user);
  base::for_each_lane(active, [&](std::size_t lane) {
    const Corner& corner = corners[in[0].lane[lane]];
    for (std::size_t c = 0; c < 4; ++c) out[c].lane[lane] = std::bit_cast<std::uint32_t>(corner.position[c]);
    out[4].lane[lane] = std::bit_cast<std::uint32_t>(corner.cull_distance);
  });
  return active;
}

/// White, or nothing where x is odd, if `user` says so.
base::LaneMask shade_fragments(const void* user, const base::WaveRegister*, base::WaveRegister* out,
                               base::LaneMask active, base::LaneMask helpers) {
  for (std::size_t c = 0; c < 4; ++c)
    for (std::uint32_t& lane : out[c].lane) lane = std::bit_cast<std::uint32_t>(1.0f);
  const base::LaneMask even = 0x5555555555555555;
  return active & ~helpers & (*static_cast<const bool*>(user) ? even : base::kAllLanes);
}

spirv::InterfaceSlot slot(spirv::BuiltIn built_in, std::uint32_t component, std::uint32_t reg) {
  spirv::InterfaceSlot result;
  result.built_in = built_in;
  result.component = static_cast<std::uint8_t>(component);
  result.reg = reg;
  return result;
}

/// Counts what it is told.
struct Counted : DrawObserver {
  std::mutex mutex;
  bool takes_numbers = false;
  std::uint64_t whole = 0;  ///< blocks
  std::uint64_t vertices = 0, assembled = 0, generated = 0, invocations = 0, helpers = 0, passed = 0, written = 0;
  std::uint64_t bytes = 0;  ///< if it takes numbers
  std::array<std::uint64_t, kPrimitiveFates> primitives{};
  std::array<std::uint64_t, kFragmentTests> lost{}, ended{};  ///< samples, and fragments whose last sample was lost

  std::unique_ptr<DrawWatch> watch_chunk(const spirv::ObservedCommand*) override;
  std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand*, std::uint32_t) override;
  std::uint64_t of(PrimitiveFate fate) const { return primitives[static_cast<std::size_t>(fate)]; }
  std::uint64_t of(FragmentTest test) const { return lost[static_cast<std::size_t>(test)]; }
};

std::uint64_t count(base::LaneMask lanes) { return static_cast<std::uint64_t>(std::popcount(lanes)); }

std::uint64_t samples_in(SampleLanes lanes) {
  std::uint64_t sum = 0;
  for (const base::LaneMask mask : lanes) sum += count(mask);
  return sum;
}

base::LaneMask any_of(SampleLanes lanes) {
  base::LaneMask any = 0;
  for (const base::LaneMask mask : lanes) any |= mask;
  return any;
}

class Counter : public DrawWatch {
 public:
  explicit Counter(Counted& out) : out_(out) {}
  void assembled(std::uint64_t vertices, std::uint64_t primitives) override {
    const std::lock_guard lock(out_.mutex);
    out_.vertices += vertices;
    out_.assembled += primitives;
  }
  void primitive(std::uint32_t, std::optional<std::uint32_t>, PrimitiveFate fate) override {
    add(out_.primitives[static_cast<std::size_t>(fate)], 1);
  }
  void generated(const FragmentGroup&, SampleLanes lanes) override { add(out_.generated, count(any_of(lanes))); }
  void failed(const FragmentGroup&, FragmentTest test, SampleLanes lost, SampleLanes left) override {
    add(out_.lost[static_cast<std::size_t>(test)], samples_in(lost));
    add(out_.ended[static_cast<std::size_t>(test)], count(any_of(lost) & ~any_of(left)));
  }
  void shaded(const FragmentGroup&, base::LaneMask invocations, base::LaneMask helpers) override {
    add(out_.invocations, count(invocations));
    add(out_.helpers, count(helpers));
  }
  bool takes_numbers() const override { return out_.takes_numbers; }
  void numbers(const FragmentNumbers& numbers) override {
    add(out_.generated, numbers.generated);
    for (std::size_t i = 0; i < kFragmentTests; ++i) add(out_.ended[i], numbers.ended[i]);
    add(out_.passed, numbers.passed);
    add(out_.written, numbers.texels);
    add(out_.bytes, numbers.bytes);
  }
  void shaded_blocks(base::LaneMask places) override {
    add(out_.whole, count(places));
    add(out_.invocations, 64 * count(places));
  }
  void passed(const FragmentGroup&, SampleLanes lanes) override { add(out_.passed, count(any_of(lanes))); }
  void written(const FragmentGroup&, const texel::ImageView&, SampleLanes lanes) override {
    add(out_.written, samples_in(lanes));
  }

 private:
  void add(std::uint64_t& counter, std::uint64_t value) {
    const std::lock_guard lock(out_.mutex);
    counter += value;
  }
  Counted& out_;
};

std::unique_ptr<DrawWatch> Counted::watch_chunk(const spirv::ObservedCommand*) {
  return std::make_unique<Counter>(*this);
}
std::unique_ptr<DrawWatch> Counted::watch_tile(const spirv::ObservedCommand*, std::uint32_t) {
  return std::make_unique<Counter>(*this);
}

class Observed : public testing::Test {
 protected:
  Observed() {
    vertex.interface.inputs = {slot(spirv::BuiltIn::kVertexIndex, 0, 0)};
    vertex.run = shade_vertices;
    fragment.run = shade_fragments;
    for (std::uint32_t c = 0; c < 4; ++c) {
      vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kPosition, c, c));
      fragment.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
    }
    vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kCullDistance, 0, 4));
    state.viewport[0] = {0, 0, kSide, kSide, 0, 1};
    state.scissor[0] = {{0, 0}, {kSide, kSide}};
  }

  /// A triangle in pixels, counter-clockwise for Vulkan if given so.
  void add(std::array<float, 6> xy, float z = 0.5f, float cull_distance = 0) {
    for (std::size_t i = 0; i < 6; i += 2)
      corners.push_back({{xy[i] / kSide * 2 - 1, xy[i + 1] / kSide * 2 - 1, z, 1}, cull_distance});
  }
  /// A triangle over everything that nothing clips: the viewport is larger.
  void add_whole(float z = 0.5f) {
    state.viewport[0] = {-8, -8, 4 * kSide, 4 * kSide, 0, 1};
    add({0, 0, 0, kSide, kSide, 0}, z);
  }
  /// Two triangles over everything.
  void add_screen(float z = 0.5f) {
    add({0, 0, 0, kSide, kSide, 0}, z);
    add({kSide, 0, 0, kSide, kSide, kSide}, z);
  }

  static texel::ImageView view(VkFormat format, std::vector<float>& memory) {
    texel::ImageView result;
    result.base = reinterpret_cast<std::byte*>(memory.data());
    result.format = &texel::format_desc(format);
    result.level[0].extent = {kSide, kSide, 1};
    result.level[0].row_pitch = std::uint64_t{kSide} * result.format->block_bytes;
    return result;
  }

  void draw() {
    PassDesc desc;
    desc.color[0] = view(VK_FORMAT_R32G32B32A32_SFLOAT, color);
    desc.color_count = 1;
    if (state.depth_test) desc.depth = view(VK_FORMAT_D32_SFLOAT, depth);
    desc.render_area = {{0, 0}, {kSide, kSide}};
    vertex.user = corners.data();
    fragment.user = &discards;
    fragment.interface.uses_discard = discards;
    DrawCall call;
    call.state = &state;
    call.native_vertex = &vertex;
    call.native_fragment = &fragment;
    call.count = static_cast<std::uint32_t>(corners.size());
    call.observer = &told;
    Pass pass(desc);
    pass.draw(call);
  }

  std::vector<Corner> corners;
  std::vector<float> color = std::vector<float>(std::size_t{kSide} * kSide * 4);
  std::vector<float> depth = std::vector<float>(std::size_t{kSide} * kSide, 0.5f);
  State state;
  NativeShader vertex, fragment;
  bool discards = false;
  Counted told;
};

TEST_F(Observed, TellsWhyPrimitivesAreCulled) {
  state.cull_mode = VK_CULL_MODE_BACK_BIT;
  state.scissor[0] = {{0, 0}, {32, kSide}};
  add({1, 1, 1, 9, 9, 1});                    // rasterized
  add({1, 1, 9, 1, 1, 9});                    // faces away
  add({1, 1, 5, 5, 9, 9});                    // no area
  add({40, 1, 40, 9, 48, 1});                 // outside of the scissor
  add({70, 1, 70, 9, 78, 1});                 // outside of the view volume
  add({-8, 1, 5, 9, 9, 1});                   // clipped, and rasterized
  add({1, 1, 1, 9, 9, 1}, 0.5f, -1.0f);       // outside of the cull distance
  add({1.6f, 1.6f, 1.6f, 1.9f, 1.9f, 1.6f});  // between pixel centres
  draw();
  EXPECT_EQ(told.vertices, 24u);
  EXPECT_EQ(told.assembled, 8u);
  EXPECT_EQ(told.of(PrimitiveFate::kFacing), 1u);
  EXPECT_EQ(told.of(PrimitiveFate::kZeroArea), 1u);
  EXPECT_EQ(told.of(PrimitiveFate::kScissor), 1u);
  EXPECT_EQ(told.of(PrimitiveFate::kOutside), 1u);
  EXPECT_EQ(told.of(PrimitiveFate::kClipped), 1u);
  EXPECT_EQ(told.of(PrimitiveFate::kCulledByDistance), 1u);
  EXPECT_EQ(told.of(PrimitiveFate::kNoSample), 1u);
  // The clipped one has a part of four corners, which are two triangles.
  EXPECT_EQ(told.of(PrimitiveFate::kRasterized), 1u + 2u);
}

TEST_F(Observed, TellsSliversFromWhatIsSeen) {
  add({1, 1, 1, 1.4f, 60, 1.2f});      // between two rows
  add({1, 1.2f, 1, 1.8f, 60, 1.45f});  // takes a centre at its wide end
  draw();
  EXPECT_EQ(told.of(PrimitiveFate::kNoSample), 1u);
  EXPECT_EQ(told.of(PrimitiveFate::kRasterized), 1u);
}

TEST_F(Observed, CountsFragmentsInDiscardRectangles) {
  state.discard_count = 2;
  state.discard_inside = true;
  state.discard[0] = {{0, 0}, {32, 16}};
  state.discard[1] = {{16, 8}, {16, 16}};
  state.scissor[0] = {{0, 0}, {kSide, 32}};
  add_screen();
  draw();
  EXPECT_EQ(told.generated, 64u * 64u);
  EXPECT_EQ(told.of(FragmentTest::kDiscardRectangle), 32u * 16u + 16u * 8u);
  EXPECT_EQ(told.of(FragmentTest::kScissor), 64u * 32u);
  EXPECT_EQ(told.passed, 64u * 32u - 32u * 16u - 16u * 8u);
  EXPECT_EQ(color[0], 0.0f);
  EXPECT_EQ(color[32 * 4], 1.0f);
}
TEST_F(Observed, CountsFragmentsOutsideOfTheScissor) {
  state.scissor[0] = {{16, 0}, {32, kSide}};
  add_screen();
  draw();
  EXPECT_EQ(told.generated, 64u * 64u);
  EXPECT_EQ(told.of(FragmentTest::kScissor), 32u * 64u);
  EXPECT_EQ(told.invocations, 32u * 64u);
  EXPECT_EQ(told.passed, 32u * 64u);
  EXPECT_EQ(told.written, 32u * 64u);
  EXPECT_EQ(color[0], 0.0f);
  EXPECT_EQ(color[16 * 4], 1.0f);
}

TEST_F(Observed, TellsEarlyAndLateDepthTestsApartFromDiscards) {
  state.depth_test = state.depth_write = true;
  state.depth_compare = VK_COMPARE_OP_LESS;
  add_screen(0.75f);  // behind what is there
  add_screen(0.25f);
  draw();
  EXPECT_EQ(told.of(FragmentTest::kDepth), 64u * 64u);
  EXPECT_EQ(told.invocations, 64u * 64u);
  EXPECT_EQ(told.written, 2u * 64u * 64u) << "depth and colour";
  discards = true;
  told.lost = told.ended = {};
  told.passed = 0;
  std::fill(depth.begin(), depth.end(), 0.5f);
  draw();
  EXPECT_EQ(told.of(FragmentTest::kDepth), 64u * 64u);
  EXPECT_EQ(told.of(FragmentTest::kDiscard), 32u * 64u);
  EXPECT_EQ(told.passed, 32u * 64u);
}

TEST_F(Observed, TellsTheSameInNumbers) {
  constexpr std::uint64_t kPixels = std::uint64_t{kSide} * kSide, kBlocks = 64;
  for (const bool numbers : {false, true}) {
    told.takes_numbers = numbers;
    told.generated = told.invocations = told.passed = told.written = 0;
    corners.clear();
    for (int layer = 0; layer < 3; ++layer) add_whole();
    add({4, 4, 4, 12, 12, 4});  // parts of blocks: half of 32 x 32 pixels
    draw();
    const std::uint64_t small = told.generated - 3 * kPixels;
    EXPECT_TRUE(small > 450 && small < 600) << small;
    EXPECT_EQ(told.invocations, told.generated);
    EXPECT_EQ(told.passed, told.generated);
    EXPECT_EQ(told.written, told.generated);
    EXPECT_EQ(std::count(color.begin(), color.end(), 1.0f), 4 * kPixels);
    std::fill(color.begin(), color.end(), 0.0f);
  }
  EXPECT_EQ(told.whole, 3 * kBlocks + 6);  // the small one has six
  EXPECT_EQ(told.bytes, told.written * sizeof(color[0]) * color.size() / kPixels);
}

TEST_F(Observed, TellsOfTestsInNumbers) {
  told.takes_numbers = true;
  add_whole();
  state.scissor[0] = {{16, 0}, {32, kSide}};
  draw();
  EXPECT_EQ(told.ended[static_cast<std::size_t>(FragmentTest::kScissor)], 32u * 64u);
  state.scissor[0] = {{0, 0}, {kSide, kSide}};
  discards = true;
  draw();
  EXPECT_EQ(told.ended[static_cast<std::size_t>(FragmentTest::kDiscard)], 32u * 64u);
}

TEST_F(Observed, TellsTheSameOfDepthInNumbers) {
  state.depth_test = state.depth_write = true;
  state.depth_compare = VK_COMPARE_OP_LESS;
  std::uint64_t generated = 0, ended = 0, passed = 0, written = 0, invocations = 0;
  for (const bool numbers : {false, true}) {
    told.takes_numbers = numbers;
    told.generated = told.passed = told.written = told.invocations = 0;
    told.ended = {};
    corners.clear();
    std::fill(depth.begin(), depth.end(), 1.0f);
    for (const float z : {0.7f, 0.5f, 0.6f, 0.6f, 0.4f}) {  // what is behind learns from what was behind, too
      add({0, 0, 0, 2 * kSide, 2 * kSide, 0}, z);
      add({5, 5, 5, 60, 60, 5}, z - 0.05f);
    }
    draw();
    const std::uint64_t lost = told.ended[static_cast<std::size_t>(FragmentTest::kDepth)];
    EXPECT_EQ(told.generated, told.passed + lost);
    EXPECT_EQ(told.invocations, told.passed);
    EXPECT_EQ(told.written, 2 * told.passed);
    if (numbers) {
      EXPECT_EQ(told.generated, generated);
      EXPECT_EQ(lost, ended);
      EXPECT_EQ(told.passed, passed);
      EXPECT_EQ(told.written, written);
      EXPECT_EQ(told.invocations, invocations);
    }
    generated = told.generated;
    ended = lost;
    passed = told.passed;
    written = told.written;
    invocations = told.invocations;
  }
  EXPECT_GT(ended, 2u * kSide * kSide);
}

TEST_F(Observed, TellsOfSampleMasks) {
  state.sample_mask = 0;
  add_screen();
  draw();
  EXPECT_EQ(told.of(FragmentTest::kSampleMask), 64u * 64u);
  EXPECT_EQ(told.invocations, 0u);
}

constexpr std::uint32_t kFirstInstance = 10;

/// A triangle in the eight columns of each instance; those of odd ones reach out of the view volume.
base::LaneMask shade_instances(const void*, const base::WaveRegister* in, base::WaveRegister* out,
                               base::LaneMask active, base::LaneMask) {
  base::for_each_lane(active, [&](std::size_t lane) {
    const std::uint32_t corner = in[0].lane[lane], instance = in[1].lane[lane] - kFirstInstance;
    const float x = static_cast<float>(instance * 8 + (corner == 2 ? 8 : 0));
    const float y = corner == 1 ? 60.0f : instance % 2 == 0 ? 4.0f : -40.0f;
    const float position[4] = {x / kSide * 2 - 1, y / kSide * 2 - 1, 0.5f, 1};
    for (std::size_t c = 0; c < 4; ++c) out[c].lane[lane] = std::bit_cast<std::uint32_t>(position[c]);
    out[4].lane[lane] = 0;
  });
  return active;
}

/// Of fragments, which instance each is of, by column / 8.
struct ByInstance : TileObserver {
  std::mutex mutex;
  std::array<std::uint64_t, 8> right{}, wrong{};

  struct Watch : DrawWatch {
    explicit Watch(ByInstance& by) : out(by) {}
    void generated(const FragmentGroup& group, SampleLanes lanes) override {
      const std::lock_guard lock(out.mutex);
      base::for_each_lane(any_of(lanes), [&](std::size_t lane) {
        const std::uint32_t column = group.position.x[lane / 4] / 8;
        const bool same = group.instances->instance_of(group.from[lane / 4]) == kFirstInstance + column;
        ++(same ? out.right : out.wrong)[column];
      });
    }
    ByInstance& out;
  };
  bool watches(const TilePlace&) const override { return true; }
  std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand*, const TilePlace&) override {
    return std::make_unique<Watch>(*this);
  }
};

TEST_F(Observed, TellsWhichInstancesFragmentsAreOf) {
  for (const std::uint32_t general : {0u, 1u}) {
    ByInstance by;
    PassDesc desc;
    desc.color[0] = view(VK_FORMAT_R32G32B32A32_SFLOAT, color);
    desc.color_count = 1;
    desc.render_area = {{0, 0}, {kSide, kSide}};
    vertex.interface.inputs = {slot(spirv::BuiltIn::kVertexIndex, 0, 0), slot(spirv::BuiltIn::kInstanceIndex, 0, 1)};
    vertex.run = shade_instances;
    fragment.user = &discards;
    DrawCall call;
    call.state = &state;
    call.native_vertex = &vertex;
    call.native_fragment = &fragment;
    call.count = 3;
    call.instance_count = 8;
    call.first_instance = kFirstInstance;
    call.general_path = general != 0;
    call.tile_observer = &by;
    Pass pass(desc);
    pass.draw(call);
    pass.flush();
    for (std::size_t column = 0; column < 8; ++column) {
      EXPECT_GT(by.right[column], 100u) << column;
      EXPECT_EQ(by.wrong[column], 0u) << column;
    }
  }
}

/// Of primitives, which instances each fate is told of.
struct InstancesOfFates : DrawObserver {
  std::mutex mutex;
  std::map<PrimitiveFate, std::set<std::uint32_t>> instances;

  struct Watch : DrawWatch {
    explicit Watch(InstancesOfFates& to) : out(to) {}
    void primitive(std::uint32_t, std::optional<std::uint32_t> instance, PrimitiveFate fate) override {
      const std::lock_guard lock(out.mutex);
      out.instances[fate].insert(instance.value_or(0));
    }
    InstancesOfFates& out;
  };
  std::unique_ptr<DrawWatch> watch_chunk(const spirv::ObservedCommand*) override {
    return std::make_unique<Watch>(*this);
  }
  std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand*, std::uint32_t) override { return nullptr; }
};

TEST_F(Observed, TellsWhichInstancesPrimitivesAreOf) {
  for (const bool culls : {false, true}) {
    ByInstance by;
    InstancesOfFates fates;
    PassDesc desc;
    desc.color[0] = view(VK_FORMAT_R32G32B32A32_SFLOAT, color);
    desc.color_count = 1;
    desc.render_area = {{0, 0}, {kSide, kSide}};
    vertex.interface.inputs = {slot(spirv::BuiltIn::kVertexIndex, 0, 0), slot(spirv::BuiltIn::kInstanceIndex, 0, 1)};
    vertex.run = shade_instances;
    fragment.user = &discards;
    state.cull_mode = culls ? VK_CULL_MODE_FRONT_AND_BACK : VK_CULL_MODE_NONE;
    DrawCall call;
    call.state = &state;
    call.native_vertex = &vertex;
    call.native_fragment = &fragment;
    call.count = 3;
    call.instance_count = 8;
    call.first_instance = kFirstInstance;
    call.observer = &fates;
    call.tile_observer = &by;
    Pass pass(desc);
    pass.draw(call);
    pass.flush();
    using Set = std::set<std::uint32_t>;
    EXPECT_EQ(fates.instances[PrimitiveFate::kClipped], culls ? Set() : Set({11, 13, 15, 17}));
    EXPECT_EQ(fates.instances[culls ? PrimitiveFate::kFacing : PrimitiveFate::kRasterized],
              Set({10, 11, 12, 13, 14, 15, 16, 17}));
  }
}

/// Output 5: a varying with perspective, 6: one without, 7: a flat one.
base::LaneMask shade_varyings(const void*, const base::WaveRegister* in, base::WaveRegister* out, base::LaneMask active,
                              base::LaneMask) {
  base::for_each_lane(active, [&](std::size_t lane) {
    const auto number = static_cast<float>(in[0].lane[lane]);
    const float w = 1 + 0.37f * number;
    const float values[] = {(in[0].lane[lane] % 3 == 1 ? 1.3f : -0.9f) * w,
                            (in[0].lane[lane] % 3 == 2 ? 1.4f : -0.8f + 0.1f * number) * w,
                            0.5f * w,
                            w,
                            0,
                            3.3f * number - 1,
                            0.7f * number,
                            number};
    for (std::size_t c = 0; c < std::size(values); ++c) out[c].lane[lane] = std::bit_cast<std::uint32_t>(values[c]);
  });
  return active;
}

base::LaneMask copy_varyings(const void*, const base::WaveRegister* in, base::WaveRegister* out, base::LaneMask active,
                             base::LaneMask helpers) {
  for (std::size_t c = 0; c < 4; ++c) out[c] = in[c % 3];
  return active & ~helpers;
}

/// What fragments' inputs are said to be, by pixel: those of the last fragment.
struct ByInputs : TileObserver {
  std::vector<std::uint32_t> words = std::vector<std::uint32_t>(std::size_t{kSide} * kSide * 4);
  std::mutex mutex;

  struct Watch : DrawWatch {
    explicit Watch(ByInputs& to) : out(to) {}
    void generated(const FragmentGroup& group, SampleLanes lanes) override {
      const std::lock_guard lock(out.mutex);
      base::for_each_lane(any_of(lanes), [&](std::size_t lane) {
        const std::size_t x = group.position.x[lane / 4] + (lane & 1), y = group.position.y[lane / 4] + (lane >> 1 & 1);
        for (std::uint32_t c = 0; c < 4; ++c)
          out.words[4 * (y * kSide + x) + c] = group.inputs->word(c % 3, lane).value_or(~0u);
        EXPECT_FALSE(group.inputs->word(3, lane));
      });
    }
    ByInputs& out;
  };
  bool watches(const TilePlace&) const override { return true; }
  std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand*, const TilePlace&) override {
    return std::make_unique<Watch>(*this);
  }
};

TEST_F(Observed, TellsWhatTheShaderGetsBeforeItRuns) {
  vertex.run = shade_varyings;
  fragment.run = copy_varyings;
  constexpr spirv::Interpolation kKinds[] = {spirv::Interpolation::kPerspective, spirv::Interpolation::kLinear,
                                             spirv::Interpolation::kFlat};
  for (std::uint32_t i = 0; i < 3; ++i) {
    spirv::InterfaceSlot varying = slot(spirv::BuiltIn::kNone, 0, 5 + i);
    varying.location = static_cast<std::uint16_t>(i);
    vertex.interface.outputs.push_back(varying);
    varying.reg = i;
    varying.interpolation = kKinds[i];
    fragment.interface.inputs.push_back(varying);
  }
  ByInputs by;
  PassDesc desc;
  desc.color[0] = view(VK_FORMAT_R32G32B32A32_SFLOAT, color);
  desc.color_count = 1;
  desc.render_area = {{0, 0}, {kSide, kSide}};
  DrawCall call;
  call.state = &state;
  call.native_vertex = &vertex;
  call.native_fragment = &fragment;
  call.count = 9;
  call.tile_observer = &by;
  Pass pass(desc);
  pass.draw(call);
  pass.flush();
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < color.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(color[i]), by.words[i]) << i;
    drawn += by.words[i] != 0;
  }
  EXPECT_GT(drawn, color.size() / 4);
}

}  // namespace
}  // namespace vitrine::raster
