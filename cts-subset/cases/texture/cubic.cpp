// Cubic filters (VK_EXT_filter_cubic), which the reference lacks: there the shader computes them from fetched texels,
// in the order of texel/sampler/model/cubic.h (Vulkan 1.3.239, Texel Filtering).
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

struct Mode {
  VkSamplerAddressMode address;
  const char* turns;  ///< the coordinate s without whole turns
  const char* wrap;   ///< texel i of n
};

constexpr Mode kModes[] = {
    {VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, "s", "clamp(i, 0, n - 1)"},
    {VK_SAMPLER_ADDRESS_MODE_REPEAT, "s - floor(s)", "((i % n) + n) % n"},
    {VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, "s - 2.0 * floor(s * 0.5)",
     "min(((i % (2 * n)) + 2 * n) % (2 * n), 2 * n - 1 - ((i % (2 * n)) + 2 * n) % (2 * n))"},
};

std::string stand_in(const Mode& mode) {
  return std::string("int wrapped(int i, int n) { return ") + mode.wrap + "; }\n" + "float turned(float s) { return " +
         mode.turns + R"(; }
void weigh(float a, out float w[4]) {
  precise float square = a * a;
  precise float w0 = a * (a * (1.0 - 0.5 * a) - 0.5);
  precise float w1 = square * (1.5 * a - 2.5) + 1.0;
  precise float w2 = a * (a * (2.0 - 1.5 * a) + 0.5);
  precise float w3 = square * (0.5 * a - 0.5);
  w[0] = w0; w[1] = w1; w[2] = w2; w[3] = w3;
}
vec4 cubic(vec2 at) {
  ivec2 size = textureSize(t, 0);
  precise vec2 c = vec2(turned(at.x), turned(at.y)) * vec2(size) - 0.5;
  vec2 whole = floor(c);
  precise vec2 a = c - whole;
  float wx[4], wy[4];
  weigh(a.x, wx);
  weigh(a.y, wy);
  precise vec4 sum = vec4(0.0);
  for (int j = 0; j < 4; ++j) {
    precise vec4 row = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
      ivec2 texel = ivec2(wrapped(int(whole.x) - 1 + i, size.x), wrapped(int(whole.y) - 1 + j, size.y));
      row = row + wx[i] * texelFetch(t, texel, 0);
    }
    sum = sum + wy[j] * row;
  }
  return sum;
}
)";
}

CTS_RANDOM("texture", "random_cubic", 16) {
  Random& random = run.random;
  ImageSpec spec;
  spec.format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R32_SFLOAT,
                             VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_A2B10G10R10_UNORM_PACK32});
  spec.extent = {random.pick({13u, 16u, 64u}), random.pick({7u, 8u, 1u}), 1};
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  const Mode& mode = kModes[random.below(3)];
  const bool here = run.gpu.features_of(spec.format) & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = here ? VK_FILTER_CUBIC_EXT : VK_FILTER_NEAREST;
  info.addressModeU = info.addressModeV = info.addressModeW = mode.address;
  const VkSampler sampler = run.sampler(info);
  const Resources res = run.resources(
      {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {}, {{sampler, image.view, VK_IMAGE_LAYOUT_GENERAL}}, {}}});
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec graphics;
  graphics.layout = res.layout;
  graphics.vertex = kFullScreenVertex;
  const std::string scale = random.pick({"0.7", "2.3", "0.11"});
  graphics.fragment = "layout(binding = 0) uniform sampler2D t;\nlayout(location = 0) out vec4 v;\n" + stand_in(mode) +
                      "void main() {\n  vec2 p = gl_FragCoord.xy * 0.015625 * " + scale +
                      " - 0.3;\n  v = " + (here ? "textureLod(t, p, 0.0)" : "cubic(p)") + ";\n}\n";
  const VkPipeline pipeline = make_pipeline(run, graphics, target);
  draw_once(run, target, pipeline, &res);
  run.out("color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
}

}  // namespace
}  // namespace vitrine::cts
