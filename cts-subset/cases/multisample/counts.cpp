// Two and eight samples, which the reference lacks: where a device does not offer a count it puts out what the
// specification says instead. Coverage and tests: sample i of n is the one sample of a viewport moved by what lies
// between its location and the pixel's centre. What shaders see of samples: computed here.
#include <array>

#include "cases/multisample/samples.h"
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Vulkan 1.3.239, Multisampling, "standard sample locations", in sixteenths of a pixel.
struct Place {
  int x, y;
};
const std::vector<Place>& places(uint32_t samples) {
  static const std::vector<Place> kTwo{{12, 12}, {4, 4}}, kFour{{6, 2}, {14, 6}, {2, 10}, {10, 14}},
      kEight{{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
  return samples == 2 ? kTwo : samples == 4 ? kFour : kEight;
}

/// Whether this side draws with that many samples; the other computes what must come out.
bool draws(const Run& run, uint32_t samples) {
  const VkPhysicalDeviceLimits& limits = run.gpu.properties.limits;
  return &run.gpu == &gpus().device && (limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts &
                                        limits.sampledImageColorSampleCounts & samples) != 0;
}

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

constexpr uint32_t kSide = 64;  ///< a power of two: window coordinates of the corners are exact

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

void samples_as_viewports(Run& run, uint32_t samples) {
  Random& random = run.random;
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
  const uint32_t count = 1 + random.below(40);
  const Buffer vertices = run.buffer_of(flat_triangles(random, count));
  Contents contents;
  for (uint32_t pass = 0; pass < (direct ? 1 : samples); ++pass) {
    const Place& place = places(samples)[pass];
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
      vkCmdDraw(cmd, 3 * count, 1, 0, 0);
      vkCmdEndRenderPass(cmd);
    });
    contents.add(run, target);
  }
  contents.put_all(run, {kSide, kSide}, samples);
}

// ---- what shaders see

/// The lower left half of the target, cut along x + 2y = 60 (in pixels): its edge passes between samples.
constexpr int kCut = 60;
bool covered(const Place& place, uint32_t x, uint32_t y) {
  return 16 * (static_cast<int>(x) + 2 * static_cast<int>(y)) + place.x + 2 * place.y < 16 * kCut;
}
/// (0, 0), (0, 30), (60, 0) in pixels. The varying is the place itself.
const char kCutVertex[] = R"(
layout(location = 0) out vec2 place;
layout(location = 1) centroid out vec2 centroid_place;
layout(location = 2) sample out vec2 sample_place;
void main() {
  vec2 corners[3] = vec2[3](vec2(0, 0), vec2(0, 30), vec2(60, 0));
  place = centroid_place = sample_place = corners[gl_VertexIndex];
  gl_Position = vec4(place / 32.0 - 1.0, 0.5, 1);
})";

struct Seen {
  bool shades_samples;
  const char* fragment;
  /// What one run of the shader puts out: its sample, the pixel, and which samples are covered.
  std::array<float, 4> (*value)(uint32_t samples, uint32_t sample, uint32_t x, uint32_t y, uint32_t mask);
};

float at(int sixteenths, uint32_t pixel) { return static_cast<float>(pixel) + static_cast<float>(sixteenths) / 16; }

/// Planes of places are not exact where an edge's length is no power of two: results are rounded to sixteenths.
const Seen kSeen[] = {
    {true,
     "layout(location = 0) out vec4 result;\n"
     "void main() { result = vec4(gl_SampleID, gl_SamplePosition, gl_SampleMaskIn[0]); }\n",
     [](uint32_t samples, uint32_t sample, uint32_t, uint32_t, uint32_t) -> std::array<float, 4> {
       const Place& place = places(samples)[sample];
       return {static_cast<float>(sample), at(place.x, 0), at(place.y, 0), static_cast<float>(1u << sample)};
     }},
    {true,
     "layout(location = 2) sample in vec2 sample_place;\n"
     "layout(location = 0) out vec4 result;\n"
     "void main() { result = vec4(round(sample_place * 16) / 16, gl_FragCoord.xy); }\n",
     [](uint32_t samples, uint32_t sample, uint32_t x, uint32_t y, uint32_t) -> std::array<float, 4> {
       const Place& place = places(samples)[sample];
       return {at(place.x, x), at(place.y, y), at(place.x, x), at(place.y, y)};
     }},
    {false,
     "layout(location = 0) in vec2 place;\n"
     "layout(location = 0) out vec4 result;\n"
     "void main() {\n"
     "  vec2 last = round(interpolateAtSample(place, COUNT - 1) * 16) / 16;\n"
     "  vec2 some = round(interpolateAtSample(place, int(gl_FragCoord.x) % COUNT) * 16) / 16;\n"
     "  result = vec4(last, some);\n"
     "}\n",
     [](uint32_t samples, uint32_t, uint32_t x, uint32_t y, uint32_t) -> std::array<float, 4> {
       const Place &last = places(samples).back(), &some = places(samples)[x % samples];
       return {at(last.x, x), at(last.y, y), at(some.x, x), at(some.y, y)};
     }},
    {false,
     "layout(location = 1) centroid in vec2 centroid_place;\n"
     "layout(location = 0) out vec4 result;\n"
     "void main() { result = vec4(round(centroid_place * 16) / 16, gl_SampleMaskIn[0], 1); }\n",
     // The first covered sample where some are (lavapipe-rasterization.md 8.4).
     [](uint32_t samples, uint32_t, uint32_t x, uint32_t y, uint32_t mask) -> std::array<float, 4> {
       uint32_t first = 0;
       while ((mask >> first & 1) == 0) ++first;
       const bool all = mask == (1u << samples) - 1;
       const Place place = all ? Place{8, 8} : places(samples)[first];
       return {at(place.x, x), at(place.y, y), static_cast<float>(mask), 1};
     }},
    {false,
     "layout(location = 0) out vec4 result;\n"
     "void main() {\n"
     "  gl_SampleMask[0] = int(gl_FragCoord.x) * 37 + int(gl_FragCoord.y);\n"
     "  result = vec4(1, 2, 3, 4);\n"
     "}\n",
     [](uint32_t, uint32_t sample, uint32_t x, uint32_t y, uint32_t) -> std::array<float, 4> {
       if (((x * 37 + y) >> sample & 1) == 0) return {};
       return {1, 2, 3, 4};
     }}};

void seen_by_shaders(Run& run, uint32_t samples, const Seen& seen, VkSampleMask sample_mask) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  if (!draws(run, samples)) {
    std::vector<float> values;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          uint32_t mask = 0;
          for (uint32_t i = 0; i < samples; ++i)
            if (covered(places(samples)[i], x, y)) mask |= 1u << i;
          mask &= sample_mask;
          std::array<float, 4> value{};
          if ((mask >> s & 1) != 0) value = seen.value(samples, s, x, y, mask);
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
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  put(run, "color", kExtent, samples, fetch(run, target.colors[0], VK_IMAGE_ASPECT_COLOR_BIT));
}

/// Alpha grows with x; alpha to coverage keeps sample s of n where alpha > s / n (lavapipe-rasterization.md 8.6).
void alpha_to_coverage(Run& run, uint32_t samples, bool to_one) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  if (!draws(run, samples)) {
    std::vector<float> values;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          const float alpha = static_cast<float>(x) / 32;
          const bool kept = alpha > static_cast<float>(s) / static_cast<float>(samples);
          values.insert(values.end(), {0, 0, kept ? 1.0f : 0.0f, !kept ? 0 : to_one ? 1 : alpha});
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
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "layout(location = 0) out vec4 result;\n"
      "void main() { result = vec4(0, 0, 1, floor(gl_FragCoord.x) / 32); }\n";
  spec.multisample.alphaToCoverageEnable = VK_TRUE;
  spec.multisample.alphaToOneEnable = to_one;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  put(run, "color", kExtent, samples, fetch(run, target.colors[0], VK_IMAGE_ASPECT_COLOR_BIT));
}

// ---- images of samples

/// A number per sample and pixel, exact in every format used here.
float sample_value(uint32_t s, uint32_t x, uint32_t y) { return static_cast<float>((s * 89 + x * 7 + y * 13) % 256); }

const char kSampleValueFragment[] =
    "layout(location = 0) out VECTOR result;\n"
    "void main() {\n"
    "  int value = (gl_SampleID * 89 + int(gl_FragCoord.x) * 7 + int(gl_FragCoord.y) * 13) % 256;\n"
    "  result = VECTOR(value, 255 - value, 0, 255) / SCALE;\n"
    "}\n";

/// In the render pass and by command: floats are averaged, sample by sample, integers take sample 0.
void resolve(Run& run, uint32_t samples, VkFormat format) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  const bool bytes = format == VK_FORMAT_R8G8B8A8_UNORM, whole = format == VK_FORMAT_R32G32B32A32_UINT;
  if (!draws(run, samples)) {
    std::vector<float> floats;
    std::vector<uint32_t> words;
    for (uint32_t y = 0; y < kSide; ++y)
      for (uint32_t x = 0; x < kSide; ++x)
        for (uint32_t c = 0; c < 4; ++c) {
          float sum = 0;
          const auto value = [&](uint32_t s) {
            const float v = sample_value(s, x, y);
            return c == 0 ? v : c == 1 ? 255 - v : c == 2 ? 0 : 255;
          };
          for (uint32_t s = 0; s < samples; ++s) sum += bytes ? value(s) * (1.0f / 255.0f) : value(s);
          const float average = sum * (1.0f / static_cast<float>(samples));
          // To nearest by adding 2^15: a byte's unit is the last bit of the sum.
          const float clamped = std::min(average, 1.0f) * (255.0f / 256.0f) + 32768.0f;
          uint32_t low;
          std::memcpy(&low, &clamped, 4);
          floats.push_back(bytes ? static_cast<float>(low & 0xff) * (1.0f / 255.0f) : average);
          words.push_back(static_cast<uint32_t>(value(0)));
        }
    for (const char* name : {"in_pass", "by_command"}) {
      if (whole)
        put(run, name, kExtent, 1, words);
      else
        put(run, name, kExtent, 1, floats);
    }
    return;
  }
  TargetSpec target_spec;
  target_spec.colors = {format};
  target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  target_spec.resolve = true;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = std::string("#define VECTOR ") + (whole ? "uvec4\n" : "vec4\n") + "#define SCALE " +
                  (whole   ? "1u\n"
                   : bytes ? "255.0\n"
                           : "1.0\n") +
                  kSampleValueFragment;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  ImageSpec single;
  single.format = format;
  single.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image resolved = run.image(single);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
    run.barrier(cmd);
    const VkImageResolve region{target.colors[0].layers(), {}, resolved.layers(), {}, {kSide, kSide, 1}};
    vkCmdResolveImage(cmd, target.colors[0].handle, VK_IMAGE_LAYOUT_GENERAL, resolved.handle, VK_IMAGE_LAYOUT_GENERAL,
                      1, &region);
  });
  Image in_pass = target.resolves[0];
  ImageSpec copy_spec = single;
  const Image copy = run.image(copy_spec);
  run.once([&](VkCommandBuffer cmd) {
    const VkImageCopy region{in_pass.layers(), {}, copy.layers(), {}, {kSide, kSide, 1}};
    vkCmdCopyImage(cmd, in_pass.handle, VK_IMAGE_LAYOUT_GENERAL, copy.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  });
  put(run, "in_pass", kExtent, 1, fetch(run, copy, VK_IMAGE_ASPECT_COLOR_BIT));
  put(run, "by_command", kExtent, 1, fetch(run, resolved, VK_IMAGE_ASPECT_COLOR_BIT));
}

/// Stores to every sample, a copy of a part to a cleared image, and loads.
void storage_copy_clear(Run& run, uint32_t samples) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  constexpr VkOffset3D kFrom{5, 9, 0}, kTo{20, 3, 0};
  constexpr VkExtent3D kCopied{33, 27, 1};
  const auto stored = [](uint32_t s, uint32_t x, uint32_t y) { return s << 20 | y << 10 | x; };
  if (!draws(run, samples)) {
    std::vector<uint32_t> first, second;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          const uint32_t dx = x - kTo.x, dy = y - kTo.y;
          const bool inside = dx < kCopied.width && dy < kCopied.height;
          first.insert(first.end(), {stored(s, x, y), 0, 0, 1});
          second.insert(second.end(), {inside ? stored(s, dx + kFrom.x, dy + kFrom.y) : 77, 0, 0, 1});
        }
    put(run, "stored", kExtent, samples, first);
    put(run, "copied", kExtent, samples, second);
    put(run, "loaded", kExtent, samples, first);
    return;
  }
  run.require(run.gpu.features.shaderStorageImageMultisample, "shaderStorageImageMultisample");
  ImageSpec spec;
  spec.format = VK_FORMAT_R32_UINT;
  spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image image = run.image(spec), copy = run.image(spec);
  const Buffer loaded = run.buffer(size_t{16} * kSide * kSide * samples);
  const Resources res = run.resources({storage_image(0, image), storage_buffer(1, loaded)});
  const std::string head =
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(binding = 0, r32ui) uniform uimage2DMS image;\n"
      "layout(binding = 1) buffer Loaded { uvec4 loaded[]; };\n"
      "void main() {\n"
      "  uvec3 at = gl_GlobalInvocationID;\n";
  const VkPipeline store = run.compute(
      res.layout,
      run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                 head + "  imageStore(image, ivec2(at.xy), int(at.z), uvec4(at.z << 20 | at.y << 10 | at.x));\n}\n"));
  const VkPipeline load = run.compute(
      res.layout,
      run.shader(
          VK_SHADER_STAGE_COMPUTE_BIT,
          head + "  loaded[(at.z * 64u + at.y) * 64u + at.x] = imageLoad(image, ivec2(at.xy), int(at.z));\n}\n"));
  run.once([&](VkCommandBuffer cmd) {
    VkClearColorValue color{};
    color.uint32[0] = 77;
    const VkImageSubresourceRange range = copy.range();
    vkCmdClearColorImage(cmd, copy.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, store);
    vkCmdDispatch(cmd, kSide / 8, kSide / 8, samples);
    run.barrier(cmd);
    const VkImageCopy region{image.layers(), kFrom, copy.layers(), kTo, kCopied};
    vkCmdCopyImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, copy.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, load);
    vkCmdDispatch(cmd, kSide / 8, kSide / 8, samples);
  });
  put(run, "stored", kExtent, samples, fetch(run, image, VK_IMAGE_ASPECT_COLOR_BIT));
  put(run, "copied", kExtent, samples, fetch(run, copy, VK_IMAGE_ASPECT_COLOR_BIT));
  put(run, "loaded", kExtent, samples,
      std::vector<uint32_t>(loaded.as<uint32_t>(), loaded.as<uint32_t>() + loaded.size / 4));
}

/// Each sample takes what an input attachment holds in the next sample.
void input_attachment_of_samples(Run& run, uint32_t samples) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  if (!draws(run, samples)) {
    std::vector<float> values;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          const float v = sample_value((s + 1) % samples, x, y);
          values.insert(values.end(), {v, 255 - v, 0, 255});
        }
    put(run, "color", kExtent, samples, values);
    return;
  }
  ImageSpec spec;
  spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image written = run.image(spec), result = run.image(spec);
  VkAttachmentDescription attachment{};
  attachment.format = spec.format;
  attachment.samples = spec.samples;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.initialLayout = attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  const VkAttachmentDescription attachments[] = {attachment, attachment};
  const VkAttachmentReference references[] = {{0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}};
  VkSubpassDescription subpasses[2]{};
  subpasses[0].colorAttachmentCount = subpasses[1].colorAttachmentCount = subpasses[1].inputAttachmentCount = 1;
  subpasses[0].pColorAttachments = subpasses[1].pInputAttachments = &references[0];
  subpasses[1].pColorAttachments = &references[1];
  const VkSubpassDependency dependency{0,
                                       1,
                                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                       VK_ACCESS_INPUT_ATTACHMENT_READ_BIT,
                                       VK_DEPENDENCY_BY_REGION_BIT};
  VkRenderPassCreateInfo pass_info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  pass_info.attachmentCount = pass_info.subpassCount = 2;
  pass_info.pAttachments = attachments;
  pass_info.pSubpasses = subpasses;
  pass_info.dependencyCount = 1;
  pass_info.pDependencies = &dependency;
  VkRenderPass pass;
  CTS_VK(vkCreateRenderPass(run.device, &pass_info, nullptr, &pass));
  run.own(pass, vkDestroyRenderPass);
  const VkImageView views[] = {written.view, result.view};
  VkFramebufferCreateInfo framebuffer_info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  framebuffer_info.renderPass = pass;
  framebuffer_info.attachmentCount = 2;
  framebuffer_info.pAttachments = views;
  framebuffer_info.width = framebuffer_info.height = kSide;
  framebuffer_info.layers = 1;
  VkFramebuffer framebuffer;
  CTS_VK(vkCreateFramebuffer(run.device, &framebuffer_info, nullptr, &framebuffer));
  run.own(framebuffer, vkDestroyFramebuffer);
  const Resources res = run.resources({input_attachment(0, written)});
  GraphicsSpec write;
  write.vertex = kFullScreenVertex;
  write.fragment = std::string("#define VECTOR vec4\n#define SCALE 1.0\n") + kSampleValueFragment;
  GraphicsSpec read;
  read.vertex = kFullScreenVertex;
  read.fragment =
      "layout(input_attachment_index = 0, binding = 0) uniform subpassInputMS written;\n"
      "layout(location = 0) out vec4 result;\n"
      "void main() { result = subpassLoad(written, (gl_SampleID + 1) % " +
      std::to_string(samples) + "); }\n";
  read.layout = res.layout;
  const VkPipeline first = make_pipeline(run, write, pass, 0, 1, kExtent, spec.samples);
  const VkPipeline second = make_pipeline(run, read, pass, 1, 1, kExtent, spec.samples);
  run.once([&](VkCommandBuffer cmd) {
    const VkClearValue clears[2]{};
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, kExtent};
    begin.clearValueCount = 2;
    begin.pClearValues = clears;
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, first);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, second);
    res.bind(cmd);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  put(run, "color", kExtent, samples, fetch(run, result, VK_IMAGE_ASPECT_COLOR_BIT));
}

/// Without attachments the pipeline's count holds: runs per sample and samples that pass are counted.
void without_attachments(Run& run, uint32_t samples) {
  std::vector<uint32_t> counted(8, 0);
  if (!draws(run, samples)) {
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) counted[s] += covered(places(samples)[s], x, y) ? 1 : 0;
    put(run, "runs", {2, 1}, 1, counted);
    return;
  }
  TargetSpec target_spec;
  target_spec.colors.clear();
  target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  const Target target = make_target(run, target_spec);
  const Buffer runs = run.buffer_of(counted);
  const Resources res = run.resources({storage_buffer(0, runs)});
  GraphicsSpec spec;
  spec.vertex = kCutVertex;
  spec.fragment =
      "layout(binding = 0) buffer Runs { uint runs[8]; };\n"
      "void main() { atomicAdd(runs[gl_SampleID], 1u); }\n";
  spec.layout = res.layout;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  put(run, "runs", {2, 1}, 1, std::vector<uint32_t>(runs.as<uint32_t>(), runs.as<uint32_t>() + 8));
}

const bool kRegistered = [] {
  for (const uint32_t samples : {2u, 4u, 8u}) {
    const std::string suffix = ".samples_" + std::to_string(samples);
    static const char* const kGenerators[] = {
        nullptr, nullptr, "random_triangles.samples_2", nullptr, "random_triangles.samples_4", nullptr,
        nullptr, nullptr, "random_triangles.samples_8"};
    AddGenerator("multisample", kGenerators[samples], 20, [=](Run& run) { samples_as_viewports(run, samples); });
    const char* const kNames[] = {"inputs", "places", "at_sample", "centroid", "mask_out"};
    for (size_t i = 0; i < std::size(kSeen); ++i) {
      AddCase("multisample", kNames[i] + suffix, [=](Run& run) { seen_by_shaders(run, samples, kSeen[i], ~0u); });
      AddCase("multisample", kNames[i] + std::string("_masked") + suffix,
              [=](Run& run) { seen_by_shaders(run, samples, kSeen[i], 0x5a); });
    }
    AddCase("multisample", "alpha_to_coverage" + suffix, [=](Run& run) { alpha_to_coverage(run, samples, false); });
    AddCase("multisample", "alpha_to_one" + suffix, [=](Run& run) { alpha_to_coverage(run, samples, true); });
    AddCase("multisample", "resolve.float" + suffix,
            [=](Run& run) { resolve(run, samples, VK_FORMAT_R32G32B32A32_SFLOAT); });
    AddCase("multisample", "resolve.unorm" + suffix,
            [=](Run& run) { resolve(run, samples, VK_FORMAT_R8G8B8A8_UNORM); });
    AddCase("multisample", "resolve.uint" + suffix,
            [=](Run& run) { resolve(run, samples, VK_FORMAT_R32G32B32A32_UINT); });
    AddCase("multisample", "storage_copy_clear" + suffix, [=](Run& run) { storage_copy_clear(run, samples); });
    AddCase("multisample", "input_attachment" + suffix, [=](Run& run) { input_attachment_of_samples(run, samples); });
    AddCase("multisample", "without_attachments" + suffix, [=](Run& run) { without_attachments(run, samples); });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
