// The two sides of what samples at known places give.
#include "cases/multisample/located.h"

#include <array>

#include "cases/multisample/samples.h"
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Custom places as Vulkan's structures.
class LocationState {
 public:
  explicit LocationState(const Located& located) : by_(located.by) {
    for (const Place& place : located.places)
      locations_.push_back({static_cast<float>(place.x) / 16, static_cast<float>(place.y) / 16});
    info_.sampleLocationsPerPixel = static_cast<VkSampleCountFlagBits>(located.samples());
    info_.sampleLocationGridSize = {1, 1};
    info_.sampleLocationsCount = located.samples();
    info_.pSampleLocations = locations_.data();
  }
  LocationState(const LocationState&) = delete;

  /// The structure stays alive with this.
  void add_to(GraphicsSpec& spec) {
    if (by_ == Located::By::kNothing) return;
    state_.sampleLocationsEnable = by_ != Located::By::kCommandEnable;
    state_.sampleLocationsInfo = info_;
    spec.multisample.pNext = &state_;
    if (by_ == Located::By::kCommand) spec.dynamic.push_back(VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT);
    if (by_ == Located::By::kCommandEnable) spec.dynamic.push_back(VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_ENABLE_EXT);
  }
  void record(const Run& run, VkCommandBuffer cmd) const {
    if (by_ == Located::By::kCommand) CTS_COMMAND(run.gpu, CmdSetSampleLocationsEXT)(cmd, &info_);
    if (by_ == Located::By::kCommandEnable) CTS_COMMAND(run.gpu, CmdSetSampleLocationsEnableEXT)(cmd, VK_TRUE);
  }

 private:
  Located::By by_;
  std::vector<VkSampleLocationEXT> locations_;
  VkSampleLocationsInfoEXT info_{VK_STRUCTURE_TYPE_SAMPLE_LOCATIONS_INFO_EXT};
  VkPipelineSampleLocationsStateCreateInfoEXT state_{VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT};
};

/// A target that can be fetched from, and what its attachments hold, appended.
struct Contents {
  std::vector<uint32_t> color, depth, stencil;

  void add(Run& run, const Target& target) {
    const auto append = [&](std::vector<uint32_t>& to, const Image& image, VkImageAspectFlagBits aspect) {
      if (!(image.aspects() & aspect)) return;
      const std::vector<uint32_t> words = fetch(run, image, aspect);
      to.insert(to.end(), words.begin(), words.end());
    };
    append(color, target.colors[0], VK_IMAGE_ASPECT_COLOR_BIT);
    if (!target.depth) return;
    append(depth, *target.depth, VK_IMAGE_ASPECT_DEPTH_BIT);
    append(stencil, *target.depth, VK_IMAGE_ASPECT_STENCIL_BIT);
  }
  void put_all(Run& run, VkExtent2D extent, uint32_t samples) const {
    put(run, "color", extent, samples, color);
    if (!depth.empty()) put(run, "depth", extent, samples, depth);
    if (!stencil.empty()) put(run, "stencil", extent, samples, stencil);
  }
};

const char kFlatVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) flat out vec4 passed;
void main() {
  passed = color;
  gl_Position = position;
})";
const char kFlatFragment[] = R"(
layout(location = 0) flat in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = passed; })";

/// Triangles at multiples of 1/256 pixels, each of one depth and one colour.
std::vector<float> flat_triangles(Random& random, uint32_t count) {
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i) {
    const float z = static_cast<float>(random.below(17)) / 16;
    const float color[4] = {random.unit(), random.unit(), random.unit(), random.unit()};
    const bool small = random.chance(0.5f);
    const int x0 = random.between(2 * 256, 61 * 256), y0 = random.between(2 * 256, 61 * 256);
    for (int corner = 0; corner < 3; ++corner) {
      const auto near = [&](int v) {
        return std::min(std::max(small ? v + random.between(-1500, 1500) : random.between(2 * 256, 62 * 256), 512),
                        62 * 256);
      };
      const int x = near(x0), y = near(y0);
      for (const int v : {x, y}) values.push_back(static_cast<float>(v) / 256 / 32 - 1);
      values.insert(values.end(), {z, 1.0f});
      values.insert(values.end(), color, color + 4);
    }
  }
  return values;
}

VkStencilOpState random_stencil(Random& random) {
  const auto op = [&] { return static_cast<VkStencilOp>(random.below(8)); };
  return {op(), op(), op(), static_cast<VkCompareOp>(random.below(8)), 0xff, 0xff, random.below(256)};
}

struct Seen {
  bool shades_samples;
  const char* fragment;
  /// What one run of the shader puts out: its sample, the pixel, and which samples are covered.
  std::array<float, 4> (*value)(const Places& places, uint32_t sample, uint32_t x, uint32_t y, uint32_t mask);
};

float at(int sixteenths, uint32_t pixel) { return static_cast<float>(pixel) + static_cast<float>(sixteenths) / 16; }

/// Planes of places are not exact where an edge's length is no power of two: results are rounded to sixteenths.
const Seen kSeen[] = {
    {true,
     "layout(location = 0) out vec4 result;\n"
     "void main() { result = vec4(gl_SampleID, gl_SamplePosition, gl_SampleMaskIn[0]); }\n",
     [](const Places& places, uint32_t sample, uint32_t, uint32_t, uint32_t) -> std::array<float, 4> {
       const Place& place = places[sample];
       return {static_cast<float>(sample), at(place.x, 0), at(place.y, 0), static_cast<float>(1u << sample)};
     }},
    {true,
     "layout(location = 2) sample in vec2 sample_place;\n"
     "layout(location = 0) out vec4 result;\n"
     "void main() { result = vec4(round(sample_place * 16) / 16, gl_FragCoord.xy); }\n",
     [](const Places& places, uint32_t sample, uint32_t x, uint32_t y, uint32_t) -> std::array<float, 4> {
       const Place& place = places[sample];
       return {at(place.x, x), at(place.y, y), at(place.x, x), at(place.y, y)};
     }},
    {false,
     "layout(location = 0) in vec2 place;\n"
     "layout(location = 0) out vec4 result;\n"
     "void main() {\n"
     "  vec2 one = round(interpolateAtOffset(place, vec2(-0.5, 0.25)) * 16) / 16;\n"
     "  vec2 other = round(interpolateAtOffset(place, vec2(int(gl_FragCoord.x) % 8) / 16) * 16) / 16;\n"
     "  result = vec4(one, other);\n"
     "}\n",
     // Offsets are the middle's, wherever samples are; interpolateAtSample is not allowed where they are placed.
     [](const Places&, uint32_t, uint32_t x, uint32_t y, uint32_t) -> std::array<float, 4> {
       const int other = 8 + static_cast<int>(x % 8);
       return {at(0, x), at(12, y), at(other, x), at(other, y)};
     }},
    {false,
     "layout(location = 1) centroid in vec2 centroid_place;\n"
     "layout(location = 0) out vec4 result;\n"
     "void main() { result = vec4(round(centroid_place * 16) / 16, gl_SampleMaskIn[0], 1); }\n",
     // The first covered sample where some are (lavapipe-rasterization.md 8.4).
     [](const Places& places, uint32_t, uint32_t x, uint32_t y, uint32_t mask) -> std::array<float, 4> {
       uint32_t first = 0;
       while ((mask >> first & 1) == 0) ++first;
       const bool all = mask == (1u << places.size()) - 1;
       const Place place = all ? Place{8, 8} : places[first];
       return {at(place.x, x), at(place.y, y), static_cast<float>(mask), 1};
     }},
    {false,
     "layout(location = 0) out vec4 result;\n"
     "void main() {\n"
     "  gl_SampleMask[0] = int(gl_FragCoord.x) * 37 + int(gl_FragCoord.y);\n"
     "  result = vec4(1, 2, 3, 4);\n"
     "}\n",
     [](const Places&, uint32_t sample, uint32_t x, uint32_t y, uint32_t) -> std::array<float, 4> {
       if (((x * 37 + y) >> sample & 1) == 0) return {};
       return {1, 2, 3, 4};
     }}};

static_assert(std::size(kSeen) == kSeenCount);

/// Any places, or the standard ones said aloud.
Located random_places(Random& random, uint32_t samples) {
  Located located{standard_places(samples),
                  random.pick({Located::By::kPipeline, Located::By::kCommand, Located::By::kCommandEnable})};
  if (random.chance(0.2f)) return located;
  for (Place& place : located.places) place = {random.between(0, 15), random.between(0, 15)};
  return located;
}

/// Only the device under test places samples: the other side computes.
void require_places(const Run& run) {
  if (&run.gpu != &gpus().device) return;
  run.require(run.gpu.has("VK_EXT_sample_locations"), "VK_EXT_sample_locations");
}

const bool kRegistered = [] {
  static const char* const kTriangles[] = {"random_locations.samples_2", "random_locations.samples_4",
                                           "random_locations.samples_8"};
  static const char* const kSeenBy[] = {"random_locations.seen_samples_2", "random_locations.seen_samples_4",
                                        "random_locations.seen_samples_8"};
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t samples = 2u << i;
    AddGenerator("multisample", kTriangles[i], 20, [=](Run& run) {
      require_places(run);
      samples_as_viewports(run, random_places(run.random, samples));
    });
    AddGenerator("multisample", kSeenBy[i], 20, [=](Run& run) {
      require_places(run);
      const Located located = random_places(run.random, samples);
      const size_t which = run.random.below(kSeenCount);
      seen_by_shaders(run, located, which, run.random.chance(0.5f) ? ~0u : run.random.below(256));
    });
  }
  return true;
}();

}  // namespace

const Places& standard_places(uint32_t samples) {
  static const Places kTwo{{12, 12}, {4, 4}}, kFour{{6, 2}, {14, 6}, {2, 10}, {10, 14}},
      kEight{{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
  return samples == 2 ? kTwo : samples == 4 ? kFour : kEight;
}

bool draws(const Run& run, uint32_t samples) {
  const VkPhysicalDeviceLimits& limits = run.gpu.properties.limits;
  return &run.gpu == &gpus().device && (limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts &
                                        limits.sampledImageColorSampleCounts & samples) != 0;
}

bool covered(const Place& place, uint32_t x, uint32_t y) {
  constexpr int kCut = 60;
  return 16 * (static_cast<int>(x) + 2 * static_cast<int>(y)) + place.x + 2 * place.y < 16 * kCut;
}

const char kCutVertex[] = R"(
layout(location = 0) out vec2 place;
layout(location = 1) centroid out vec2 centroid_place;
layout(location = 2) sample out vec2 sample_place;
void main() {
  vec2 corners[3] = vec2[3](vec2(0, 0), vec2(0, 30), vec2(60, 0));
  place = centroid_place = sample_place = corners[gl_VertexIndex];
  gl_Position = vec4(place / 32.0 - 1.0, 0.5, 1);
})";

void samples_as_viewports(Run& run, const Located& located) {
  Random& random = run.random;
  const auto samples = located.samples();
  const bool direct = draws(run, samples);
  TargetSpec target_spec;
  target_spec.width = target_spec.height = kSide;
  target_spec.colors = {random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT})};
  target_spec.depth = random.pick({VK_FORMAT_UNDEFINED, VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT,
                                   VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT});
  if (direct) target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  GraphicsSpec spec;
  spec.vertex = kFlatVertex;
  spec.fragment = kFlatFragment;
  spec.floats({4, 4});
  spec.dynamic = {VK_DYNAMIC_STATE_VIEWPORT};
  spec.depth.depthTestEnable = random.chance(0.8f);
  spec.depth.depthWriteEnable = random.chance(0.8f);
  spec.depth.depthCompareOp = random.chance(0.5f) ? VK_COMPARE_OP_LESS : static_cast<VkCompareOp>(random.below(8));
  spec.depth.stencilTestEnable = random.chance(0.5f);
  spec.depth.front = random_stencil(random);
  spec.depth.back = random_stencil(random);
  if (random.chance(0.4f)) {
    VkPipelineColorBlendAttachmentState blend{};
    blend.blendEnable = VK_TRUE;
    blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.colorWriteMask = 0xf;
    spec.blends = {blend};
  }
  LocationState state(located);
  if (direct) state.add_to(spec);
  if (direct && located.custom()) target_spec.depth_flags = VK_IMAGE_CREATE_SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_BIT_EXT;
  const uint32_t count = 1 + random.below(40);
  const Buffer vertices = run.buffer_of(flat_triangles(random, count));
  Contents contents;
  for (uint32_t pass = 0; pass < (direct ? 1 : samples); ++pass) {
    const Place& place = located.places[pass];
    const float dx = direct ? 0 : static_cast<float>(8 - place.x) / 16;
    const float dy = direct ? 0 : static_cast<float>(8 - place.y) / 16;
    const VkViewport viewport{dx, dy, kSide, kSide, 0, 1};
    const Target target = make_target(run, target_spec);
    const VkPipeline pipeline = make_pipeline(run, spec, target);
    run.once([&](VkCommandBuffer cmd) {
      target.begin(cmd);
      bind_pipeline(cmd, pipeline);
      bind_vertices(cmd, vertices);
      vkCmdSetViewport(cmd, 0, 1, &viewport);
      if (direct) state.record(run, cmd);
      vkCmdDraw(cmd, 3 * count, 1, 0, 0);
      vkCmdEndRenderPass(cmd);
    });
    contents.add(run, target);
  }
  contents.put_all(run, {kSide, kSide}, samples);
}

void seen_by_shaders(Run& run, const Located& located, size_t which, VkSampleMask sample_mask) {
  const Seen& seen = kSeen[which];
  const auto samples = located.samples();
  constexpr VkExtent2D kExtent{kSide, kSide};
  if (!draws(run, samples)) {
    std::vector<float> values;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          uint32_t mask = 0;
          for (uint32_t i = 0; i < samples; ++i)
            if (covered(located.places[i], x, y)) mask |= 1u << i;
          mask &= sample_mask;
          std::array<float, 4> value{};
          if ((mask >> s & 1) != 0) value = seen.value(located.places, s, x, y, mask);
          values.insert(values.end(), value.begin(), value.end());
        }
    put(run, "color", kExtent, samples, values);
    return;
  }
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  Target target = make_target(run, target_spec);
  target.clears[0] = {};
  GraphicsSpec spec;
  spec.vertex = kCutVertex;
  spec.fragment = "#define COUNT " + std::to_string(samples) + "\n" + seen.fragment;
  spec.multisample.pSampleMask = &sample_mask;
  spec.multisample.sampleShadingEnable = seen.shades_samples;
  spec.multisample.minSampleShading = 1;
  LocationState state(located);
  state.add_to(spec);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    state.record(run, cmd);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  put(run, "color", kExtent, samples, fetch(run, target.colors[0], VK_IMAGE_ASPECT_COLOR_BIT));
}

}  // namespace vitrine::cts
