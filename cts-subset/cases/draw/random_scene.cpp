// Small random scenes: several pipelines, textures, push constants and dynamic state in one render pass, many draws of
// meshes with shared edges and tiny triangles, so that order, batching and tiles all show.
#include <cmath>
#include <optional>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

const char kVertex[] = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 tint;
layout(location = 0) out vec2 passed_uv;
layout(location = 1) out vec4 passed_tint;
layout(location = 2) flat out int number;
layout(push_constant) uniform P { mat4 matrix; vec4 color; };
void main() {
  gl_Position = matrix * vec4(position, 1.0);
  passed_uv = uv;
  passed_tint = tint * color;
  number = gl_VertexIndex;
})";

const char* const kFragments[] = {
    "result = passed_tint;",
    "result = texture(image, passed_uv) * passed_tint;",
    "result = vec4(fract(passed_uv * 4.0), float(number & 15) / 15.0, 0.5);",
    "vec4 t = texture(image, passed_uv * 3.0); if (t.a < 0.4) discard; result = t;",
    "vec3 n = normalize(vec3(dFdx(passed_uv.x), dFdy(passed_uv.y), 0.1)); result = vec4(n * 0.5 + 0.5, passed_tint.a);",
    "float s = 0.0; for (int k = 0; k < 1 + (number & 3); ++k) s += textureLod(image, passed_uv + float(k) * 0.1, "
    "float(k)).g; "
    "result = vec4(s * 0.25, passed_tint.yzw);",
};

struct Mesh {
  std::vector<float> vertices;
  std::vector<uint16_t> indices;
};

/// A bent grid: shared vertices, triangles from many pixels down to less than one.
Mesh random_mesh(Random& random) {
  Mesh mesh;
  const uint32_t side = random.pick({2u, 4u, 9u, 24u});
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(side - 1),
                  v = static_cast<float>(y) / static_cast<float>(side - 1);
      for (const float f : {u * 2 - 1 + random.real(-0.1f, 0.1f), v * 2 - 1, random.real(-0.3f, 0.3f), u, v,
                            random.unit(), random.unit(), random.unit(), random.unit()})
        mesh.vertices.push_back(f);
      if (x + 1 < side && y + 1 < side)
        for (const uint32_t i : {0u, 1u, side, side, 1u, side + 1})
          mesh.indices.push_back(static_cast<uint16_t>(y * side + x + i));
    }
  return mesh;
}

struct Push {
  float matrix[16], color[4];
};

/// Scale, shear and move, with some perspective.
Push random_push(Random& random) {
  Push push{};
  const float scale = random.pick({0.1f, 0.3f, 0.8f, 1.5f});
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) push.matrix[column * 4 + row] = random.real(-scale, scale);
  push.matrix[2] *= 0.3f;
  push.matrix[6] *= 0.3f;
  push.matrix[3] = random.real(-0.3f, 0.3f);
  push.matrix[7] = random.real(-0.3f, 0.3f);
  for (const int i : {12, 13}) push.matrix[i] = random.real(-0.6f, 0.6f);
  push.matrix[14] = random.real(0.2f, 0.8f);
  push.matrix[15] = random.real(0.8f, 1.5f);
  for (float& c : push.color) c = random.unit();
  return push;
}

/// One draw of a scene, and what is set before it.
struct SceneDraw {
  uint32_t mesh, pipeline;
  Push push;
  std::optional<VkRect2D> scissor;
};

/// A corner in framebuffer coordinates.
struct Corner {
  double x, y;
  bool outside;  ///< of the view volume
};
Corner transformed(const Mesh& mesh, uint32_t index, const Push& push, const TargetSpec& target) {
  const float* position = &mesh.vertices[size_t{index} * 9];
  double clip[4];
  for (int row = 0; row < 4; ++row) {
    clip[row] = push.matrix[12 + row];
    for (int column = 0; column < 3; ++column) clip[row] += double{push.matrix[column * 4 + row]} * position[column];
  }
  const double w = clip[3];
  const bool outside = !(std::abs(clip[0]) <= w && std::abs(clip[1]) <= w && clip[2] >= 0 && clip[2] <= w);
  return {(clip[0] / w * 0.5 + 0.5) * target.width, (clip[1] / w * 0.5 + 0.5) * target.height, outside};
}

/// Whether a triangle that the rounding of its corners may turn around is drawn with one that is clipped
/// (deviations.md, neighbour-culling).
bool thin_beside_clipped(const Mesh& mesh, const Push& push, const TargetSpec& target) {
  bool thin = false, clipped = false;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    Corner c[3];
    for (size_t k = 0; k < 3; ++k) c[k] = transformed(mesh, mesh.indices[i + k], push, target);
    if (c[0].outside || c[1].outside || c[2].outside) {
      clipped = true;
      continue;
    }
    const double ax = c[1].x - c[0].x, ay = c[1].y - c[0].y, bx = c[2].x - c[0].x, by = c[2].y - c[0].y;
    const double reach = std::abs(ax) + std::abs(ay) + std::abs(bx) + std::abs(by);
    thin |= std::abs(ax * by - ay * bx) < reach / 128;  // corners are rounded to 1/256
  }
  return thin && clipped;
}

CTS_RANDOM("draw", "random_scene", 120) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.width = 40 + random.below(200);
  target_spec.height = 40 + random.below(200);
  target_spec.depth = random.pick({VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM, VK_FORMAT_D24_UNORM_S8_UINT});
  target_spec.colors = {
      random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT})};
  ImageSpec image_spec;
  image_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  image_spec.extent = {32, 32, 1};
  image_spec.levels = 6;
  const Image image = run.image(image_spec);
  run.fill_random(image);
  VkSamplerCreateInfo sampler_info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler_info.magFilter = sampler_info.minFilter = random.pick({VK_FILTER_LINEAR, VK_FILTER_NEAREST});
  sampler_info.mipmapMode = random.pick({VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_SAMPLER_MIPMAP_MODE_NEAREST});
  sampler_info.maxLod = VK_LOD_CLAMP_NONE;
  const Resources res = run.resources({sampled(0, image, run.sampler(sampler_info))}, sizeof(Push));

  std::vector<GraphicsSpec> pipelines;
  for (uint32_t n = 1 + random.below(3); n > 0; --n) {
    GraphicsSpec spec;
    spec.layout = res.layout;
    spec.vertex = kVertex;
    spec.fragment = std::string(
                        "layout(binding = 0) uniform sampler2D image;\nlayout(location = 0) in vec2 passed_uv;\n"
                        "layout(location = 1) in vec4 passed_tint;\nlayout(location = 2) flat in int number;\n"
                        "layout(location = 0) out vec4 result;\nvoid main() { ") +
                    kFragments[random.below(std::size(kFragments))] + " }\n";
    run.note("fragment" + std::to_string(n), spec.fragment);
    spec.floats({3, 2, 4});
    spec.depth.depthTestEnable = random.chance(0.8f);
    spec.depth.depthWriteEnable = random.chance(0.8f);
    spec.raster.cullMode = random.chance(0.3f) ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
    if (random.chance(0.4f))
      spec.blends = {{VK_TRUE, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD,
                      VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD, 0xf}};
    spec.dynamic = {VK_DYNAMIC_STATE_SCISSOR};
    pipelines.push_back(spec);
  }
  std::vector<Mesh> meshes;
  std::vector<std::pair<Buffer, Buffer>> buffers;
  for (uint32_t n = 1 + random.below(3); n > 0; --n) {
    const Mesh& mesh = meshes.emplace_back(random_mesh(random));
    const Buffer indices = run.buffer_of(mesh.indices);
    buffers.emplace_back(run.buffer_of(mesh.vertices), indices);
  }
  const VkRect2D everything{{0, 0}, {target_spec.width, target_spec.height}};
  std::vector<SceneDraw> draws;
  bool listed = false;
  for (uint32_t n = 1 + random.below(30); n > 0; --n) {
    SceneDraw& draw = draws.emplace_back();
    draw.mesh = random.below(static_cast<uint32_t>(meshes.size()));
    draw.push = random_push(random);
    draw.pipeline = random.below(static_cast<uint32_t>(pipelines.size()));
    const VkRect2D half{{static_cast<int32_t>(random.below(20)), 5}, {target_spec.width / 2, target_spec.height / 2}};
    if (random.chance(0.2f)) draw.scissor = random.chance(0.5f) ? half : everything;
    listed |=
        pipelines[draw.pipeline].raster.cullMode && thin_beside_clipped(meshes[draw.mesh], draw.push, target_spec);
  }
  const auto render = [&] {
    const Target target = make_target(run, target_spec);
    std::vector<VkPipeline> handles;
    for (const GraphicsSpec& spec : pipelines) handles.push_back(make_pipeline(run, spec, target));
    run.once([&](VkCommandBuffer cmd) {
      target.begin(cmd);
      res.bind(cmd);
      vkCmdSetScissor(cmd, 0, 1, &everything);
      for (const SceneDraw& draw : draws) {
        bind_pipeline(cmd, handles[draw.pipeline]);
        bind_vertices(cmd, buffers[draw.mesh].first);
        vkCmdBindIndexBuffer(cmd, buffers[draw.mesh].second.handle, 0, VK_INDEX_TYPE_UINT16);
        vkCmdPushConstants(cmd, res.layout, VK_SHADER_STAGE_ALL, 0, sizeof draw.push, &draw.push);
        if (draw.scissor) vkCmdSetScissor(cmd, 0, 1, &*draw.scissor);
        vkCmdDrawIndexed(cmd, static_cast<uint32_t>(meshes[draw.mesh].indices.size()), 1, 0, 0, 0);
      }
      vkCmdEndRenderPass(cmd);
    });
    out_target(run, target);
  };
  render();
  if (listed) {
    for (Output& output : run.outputs) output.deviation = "neighbour-culling";
    const size_t first = run.outputs.size();
    for (GraphicsSpec& spec : pipelines) spec.raster.cullMode = VK_CULL_MODE_NONE;
    render();
    for (size_t i = first; i < run.outputs.size(); ++i) run.outputs[i].name = "without_culling." + run.outputs[i].name;
  }
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
