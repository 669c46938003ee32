// Small frames of several passes as applications draw them: overdraw with early rejection, shadow map with filtered
// comparison, deferred shading. The surface is made in the vertex shader.
#include <string>

#include "bench.h"

namespace vitrine::bench {
namespace {

constexpr std::uint32_t kCells = 160;  ///< of the surface, a side
constexpr std::uint32_t kSurfaceVertices = kCells * kCells * 6;

/// surface(v): x, y in [-1, 1], the height; normal(): of the same place.
const std::string kSurface =
    "const int N = " + std::to_string(kCells) +
    ";"
    "float height(vec2 p) { return 0.2 * sin(p.x * 11.0) * cos(p.y * 8.0); }"
    "vec3 surface(int v) { int cell = v / 6, k = v % 6;"
    "vec2 p = vec2(cell % N + (0x1a >> k & 1), cell / N + (0x34 >> k & 1)) / float(N);"
    "p = p * 2.0 - 1.0; return vec3(p, height(p)); }"
    "vec3 normal(vec2 p) { vec2 e = vec2(0.01, 0.0); return normalize(vec3(height(p - e) - "
    "height(p + e), height(p - e.yx) - height(p + e.yx), 0.02)); }"
    "vec4 camera(vec3 s) { float w = 1.5 + 0.5 * s.y; return vec4(s.x * 1.4, s.y - s.z, (0.4 "
    "+ 0.2 * s.y) * w, w); }"
    "vec3 light(vec3 s) { return vec3(s.x * 0.9 + s.z * 0.7, s.y * 0.9 + s.z * 0.4, 0.5 - s.z); }";

void test_depth(cts::GraphicsSpec& spec) {
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS;
}

/// Full-screen layers from front to back: all but the first are rejected.
double measure_overdraw(Run& run) {
  constexpr std::uint32_t kWidth = 1280, kHeight = 720, kLayers = 24;
  const cts::Target target = make_screen(run, kWidth, kHeight);
  cts::GraphicsSpec spec;
  spec.vertex =
      "layout(location=0) out vec2 uv; void main() { vec2 p = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == "
      "2 ? 3.0 : -1.0); uv = p; gl_Position = vec4(p, 0.02 + 0.04 * float(gl_InstanceIndex) + p.x * 0.001, 1.0); }";
  spec.fragment =
      "layout(location=0) in vec2 uv; layout(location=0) out vec4 o; void main() { vec2 z = uv; for (int i = 0; i < 8; "
      "++i) z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) * 0.5 + uv; o = vec4(z, uv); }";
  test_depth(spec);
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  vkCmdDraw(cmd, 3, kLayers, 0, 0);
  vkCmdEndRenderPass(cmd);
  return 1.0 * kWidth * kHeight * kLayers / time_submissions(run, finish(cmd)) / 1e6;
}

double measure_shadow(Run& run) {
  cts::TargetSpec map_spec;
  map_spec.colors = {};
  map_spec.depth = VK_FORMAT_D32_SFLOAT;
  map_spec.width = map_spec.height = 1024;
  const cts::Target map = cts::make_target(run, map_spec), screen = make_screen(run, 1280, 720);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.compareEnable = VK_TRUE;
  info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  const cts::Resources resources = run.resources({cts::sampled(0, *map.depth, run.sampler(info))});
  cts::GraphicsSpec caster, receiver;
  caster.vertex = kSurface + "void main() { gl_Position = vec4(light(surface(gl_VertexIndex)), 1.0); }";
  test_depth(caster);
  receiver.vertex = kSurface +
                    "layout(location=0) out vec3 place; layout(location=1) out vec3 n; void main() { vec3 s = "
                    "surface(gl_VertexIndex); place = light(s) * vec3(0.5, 0.5, 1.0) + vec3(0.5, 0.5, -0.01); n = "
                    "normal(s.xy); gl_Position = camera(s); }";
  receiver.fragment =
      "layout(location=0) in vec3 place; layout(location=1) in vec3 n; layout(binding=0) uniform sampler2DShadow map;"
      "layout(location=0) out vec4 o; void main() { float lit = 0.0; for (int y = -1; y <= 1; ++y) for (int x = -1; x "
      "<= 1; ++x) lit += texture(map, place + vec3(x, y, 0) / 1024.0); o = vec4(vec3(0.1 + lit / 10.0 * "
      "max(dot(normalize(n), vec3(-0.5, -0.3, 0.8)), 0.0)), 1.0); }";
  test_depth(receiver);
  receiver.layout = resources.layout;
  const VkPipeline casts = cts::make_pipeline(run, caster, map), receives = cts::make_pipeline(run, receiver, screen);
  VkCommandBuffer cmd = begin_repeatable(run);
  map.begin(cmd);
  cts::bind_pipeline(cmd, casts);
  vkCmdDraw(cmd, kSurfaceVertices, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  run.barrier(cmd);
  screen.begin(cmd);
  cts::bind_pipeline(cmd, receives);
  resources.bind(cmd);
  vkCmdDraw(cmd, kSurfaceVertices, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  return 1 / time_submissions(run, finish(cmd), 1.0);
}

double measure_deferred(Run& run) {
  cts::TargetSpec buffers_spec;
  buffers_spec.colors = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT};
  buffers_spec.depth = VK_FORMAT_D32_SFLOAT;
  buffers_spec.width = 1280;
  buffers_spec.height = 720;
  const cts::Target buffers = cts::make_target(run, buffers_spec), screen = make_screen(run, 1280, 720, false);
  const VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  const VkSampler sampler = run.sampler(info);
  const cts::Resources resources =
      run.resources({cts::sampled(0, buffers.colors[0], sampler), cts::sampled(1, buffers.colors[1], sampler)});
  cts::GraphicsSpec geometry, lighting;
  geometry.vertex = kSurface +
                    "layout(location=0) out vec3 place; layout(location=1) out vec3 n; void main() { place = "
                    "surface(gl_VertexIndex); n = normal(place.xy); gl_Position = camera(place); }";
  geometry.fragment =
      "layout(location=0) in vec3 place; layout(location=1) in vec3 n; layout(location=0) out vec4 albedo;"
      "layout(location=1) out vec4 shape; void main() { albedo = vec4(fract(place * 4.0), 1.0); shape = "
      "vec4(normalize(n), place.z); }";
  test_depth(geometry);
  lighting.vertex = cts::kFullScreenVertex;
  lighting.fragment =
      "layout(location=0) in vec2 uv; layout(binding=0) uniform sampler2D albedo; layout(binding=1) uniform sampler2D "
      "shape; layout(location=0) out vec4 o; void main() { ivec2 p = ivec2(gl_FragCoord.xy); vec4 s = "
      "texelFetch(shape, p, 0); vec3 at = vec3(uv * 2.0 - 1.0, s.w), sum = vec3(0.05); for (int i = 0; i < 8; ++i) { "
      "vec3 l = vec3(float(i & 3) * 0.5 - 0.75, float(i >> 2) - 0.5, 0.5) - at; float d = dot(l, l); sum += "
      "max(dot(s.xyz, l), 0.0) / (d * (1.0 + 8.0 * d)); } o = vec4(sum * texelFetch(albedo, p, 0).rgb, 1.0); }";
  lighting.layout = resources.layout;
  const VkPipeline fills = cts::make_pipeline(run, geometry, buffers),
                   lights = cts::make_pipeline(run, lighting, screen);
  VkCommandBuffer cmd = begin_repeatable(run);
  buffers.begin(cmd);
  cts::bind_pipeline(cmd, fills);
  vkCmdDraw(cmd, kSurfaceVertices, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  run.barrier(cmd);
  screen.begin(cmd);
  cts::bind_pipeline(cmd, lights);
  resources.bind(cmd);
  vkCmdDraw(cmd, 3, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  return 1 / time_submissions(run, finish(cmd), 1.0);
}

}  // namespace

std::vector<Workload> scene_workloads() {
  return {{"overdraw", "Mpix/s", false, measure_overdraw, true, true},
          {"scene_shadow", "frame/s", false, measure_shadow},
          {"scene_deferred", "frame/s", false, measure_deferred}};
}

}  // namespace vitrine::bench
