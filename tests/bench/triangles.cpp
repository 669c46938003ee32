// Triangle rates from pixel size to large, vertex-bound and instanced draws, and a lit, textured scene.
#include <cmath>

#include "bench.h"

namespace vitrine::bench {
namespace {

struct Grid {
  std::vector<float> vertices;  ///< x y z w, r g b a
  std::vector<std::uint32_t> indices;
};

/// A grid of cells over a part of the screen, two triangles each; `cell` is the side in pixels.
Grid make_grid(float width, float height, float cell) {
  Grid grid;
  const auto columns = static_cast<std::uint32_t>(width / cell), rows = static_cast<std::uint32_t>(height / cell);
  for (std::uint32_t y = 0; y <= rows; ++y) {
    for (std::uint32_t x = 0; x <= columns; ++x) {
      const float fx = static_cast<float>(x) * cell / width * 2 - 1, fy = static_cast<float>(y) * cell / height * 2 - 1;
      for (const float v : {fx, fy, 0.5f, 1.0f, fx * 0.5f + 0.5f, fy * 0.5f + 0.5f, 0.25f, 1.0f})
        grid.vertices.push_back(v);
    }
  }
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
      for (const std::uint32_t i : {a, a + 1, b, b, a + 1, b + 1}) grid.indices.push_back(i);
    }
  }
  return grid;
}

double measure_grid(Run& run, float cell, std::uint32_t repeats, bool depth_only) {
  const cts::Target target = make_screen(run, 1280, 720);
  const Grid grid = make_grid(1280, 720, cell);
  const cts::Buffer vertices = run.buffer_of(grid.vertices), indices = run.buffer_of(grid.indices);
  cts::GraphicsSpec spec;
  spec.vertex = cts::kColorVertex;
  if (!depth_only) spec.fragment = cts::kColorFragment;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  cts::bind_vertices(cmd, vertices);
  vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT32);
  for (std::uint32_t i = 0; i < repeats; ++i)
    vkCmdDrawIndexed(cmd, static_cast<std::uint32_t>(grid.indices.size()), 1, 0, 0, 0);
  vkCmdEndRenderPass(cmd);
  const double triangles = static_cast<double>(grid.indices.size()) / 3 * repeats;
  return triangles / time_submissions(run, finish(cmd)) / 1e6;
}

/// 400 arithmetic operations a vertex, triangles too small to cover a sample.
double measure_vertex_bound(Run& run) {
  const cts::Target target = make_screen(run, 256, 256);
  cts::GraphicsSpec spec;
  spec.vertex =
      "layout(location=0) out vec4 c; void main() { float v = float(gl_VertexIndex); vec4 a = vec4(v, v * 0.5, v * "
      "0.25, 1.0);"
      "for (int i = 0; i < 100; ++i) a = a * 0.999 + 0.001; c = a;"
      "gl_Position = vec4(fract(v * 0.0001) * 2.0 - 1.0, fract(v * 0.00017) * 2.0 - 1.0, 0.5, 1.0) + a * 1e-20; }";
  spec.fragment = cts::kColorFragment;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  constexpr std::uint32_t kVertices = 90000;
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  vkCmdDraw(cmd, kVertices, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  return kVertices / time_submissions(run, finish(cmd)) / 1e6;
}

/// A grid of cells of which every triangle faces away: fetching, a matrix, culling.
double measure_culled(Run& run) {
  const cts::Target target = make_screen(run, 512, 512);
  const Grid grid = make_grid(512, 512, 1.6f);
  const cts::Buffer vertices = run.buffer_of(grid.vertices), indices = run.buffer_of(grid.indices);
  const cts::Resources resources = run.resources({}, 64);
  cts::GraphicsSpec spec;
  spec.vertex =
      "layout(location=0) in vec4 p; layout(location=1) in vec4 q; layout(location=0) out vec4 c;"
      "layout(push_constant) uniform P { mat4 m; } pc; void main() { gl_Position = pc.m * p; c = q; }";
  spec.fragment = cts::kColorFragment;
  spec.layout = resources.layout;
  spec.floats({4, 4});
  spec.raster.cullMode = VK_CULL_MODE_BACK_BIT;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  const float matrix[16] = {0.9f, 0.1f, 0, 0, -0.1f, 0.9f, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  vkCmdPushConstants(cmd, resources.layout, VK_SHADER_STAGE_ALL, 0, sizeof(matrix), matrix);
  cts::bind_vertices(cmd, vertices);
  vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(cmd, static_cast<std::uint32_t>(grid.indices.size()), 1, 0, 0, 0);
  vkCmdEndRenderPass(cmd);
  return static_cast<double>(grid.vertices.size() / 8) / time_submissions(run, finish(cmd)) / 1e6;
}

double measure_instanced(Run& run) {
  const cts::Target target = make_screen(run, 1280, 720);
  cts::GraphicsSpec spec;
  spec.vertex =
      "layout(location=0) out vec4 c; void main() { int i = gl_InstanceIndex; int v = gl_VertexIndex;"
      "vec2 base = vec2(float(i % 200), float(i / 200)) / vec2(100.0, 50.0) - 1.0;"
      "vec2 corner = vec2(float(v % 3 & 1), float(v % 3 >> 1)) * 0.009 + vec2(float(v / 3) * 0.0007);"
      "c = vec4(base * 0.5 + 0.5, float(v) / 36.0, 1.0);"
      "gl_Position = vec4(base + corner, float(v) / 72.0, 1.0); }";
  spec.fragment = cts::kColorFragment;
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  constexpr std::uint32_t kInstances = 20000;
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  vkCmdDraw(cmd, 36, kInstances, 0, 0);
  vkCmdEndRenderPass(cmd);
  return 12.0 * kInstances / time_submissions(run, finish(cmd)) / 1e6;
}

struct Knot {
  std::vector<float> vertices;  ///< position 3, normal 3, tangent 3, uv 2
  std::vector<std::uint32_t> indices;
};

Knot make_knot(std::uint32_t rings, std::uint32_t sides) {
  Knot knot;
  const auto point = [](float t, float out[3]) {
    const float r = 1.4f + 0.55f * std::cos(3 * t);
    out[0] = r * std::cos(2 * t), out[1] = r * std::sin(2 * t), out[2] = 0.55f * std::sin(3 * t);
  };
  for (std::uint32_t i = 0; i <= rings; ++i) {
    const float t = 6.2831853f * static_cast<float>(i) / static_cast<float>(rings);
    float c[3], d[3];
    point(t, c);
    point(t + 0.01f, d);
    float tangent[3], length = 0;
    for (int k = 0; k < 3; ++k) tangent[k] = d[k] - c[k], length += tangent[k] * tangent[k];
    for (float& k : tangent) k /= std::sqrt(length);
    float side[3] = {tangent[1], -tangent[0], 0};
    const float s = std::sqrt(side[0] * side[0] + side[1] * side[1]);
    side[0] /= s, side[1] /= s;
    const float up[3] = {side[1] * tangent[2], -side[0] * tangent[2], side[0] * tangent[1] - side[1] * tangent[0]};
    for (std::uint32_t j = 0; j <= sides; ++j) {
      const float a = 6.2831853f * static_cast<float>(j) / static_cast<float>(sides);
      float n[3];
      for (int k = 0; k < 3; ++k) n[k] = side[k] * std::cos(a) + up[k] * std::sin(a);
      for (int k = 0; k < 3; ++k) knot.vertices.push_back(c[k] + 0.3f * n[k]);
      knot.vertices.insert(knot.vertices.end(), n, n + 3);
      knot.vertices.insert(knot.vertices.end(), tangent, tangent + 3);
      knot.vertices.push_back(30 * static_cast<float>(i) / static_cast<float>(rings));
      knot.vertices.push_back(4 * static_cast<float>(j) / static_cast<float>(sides));
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sides; ++j) {
      const std::uint32_t a = i * (sides + 1) + j, b = a + sides + 1;
      for (const std::uint32_t v : {a, b, a + 1, a + 1, b, b + 1}) knot.indices.push_back(v);
    }
  }
  return knot;
}

cts::Image make_texture(Run& run, std::uint32_t size, std::uint32_t seed) {
  cts::ImageSpec spec;
  spec.extent = {size, size, 1};
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  for (spec.levels = 1; size >> spec.levels;) ++spec.levels;
  const cts::Image image = run.image(spec);
  for (std::uint32_t level = 0; level < spec.levels; ++level) {
    const std::uint32_t side = size >> level;
    std::vector<unsigned char> texels(std::size_t{side} * side * 4);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      texels[i] = static_cast<unsigned char>(((i * 2654435761u + seed) >> 13 & 0x3f) + ((i / 64) & 1 ? 160 : 90));
    }
    run.upload(image, level, texels);
  }
  return image;
}

constexpr char kPhongVertex[] =
    "layout(location=0) in vec3 p; layout(location=1) in vec3 n; layout(location=2) in vec3 t; layout(location=3) in "
    "vec2 uv;"
    "layout(push_constant) uniform P { mat4 m; } pc;"
    "layout(location=0) out vec3 wp; layout(location=1) out vec3 wn; layout(location=2) out vec3 wt; "
    "layout(location=3) out vec2 tc;"
    "void main() { wp = p; wn = n; wt = t; tc = uv; gl_Position = pc.m * vec4(p, 1.0); }";
constexpr char kPhongFragment[] =
    "layout(location=0) in vec3 wp; layout(location=1) in vec3 wn; layout(location=2) in vec3 wt; layout(location=3) "
    "in vec2 tc;"
    "layout(binding=0) uniform sampler2D albedo; layout(binding=1) uniform sampler2D normals;"
    "layout(binding=2) uniform L { vec4 eye; vec4 pos[3]; vec4 color[3]; } u;"
    "layout(location=0) out vec4 o; void main() {"
    "vec3 n = normalize(wn), t = normalize(wt), b = cross(n, t); vec3 m = texture(normals, tc).xyz * 2.0 - 1.0;"
    "n = normalize(m.x * t + m.y * b + m.z * n); vec3 base = texture(albedo, tc).rgb; vec3 v = normalize(u.eye.xyz - "
    "wp);"
    "vec3 sum = base * 0.05; for (int i = 0; i < 3; ++i) { vec3 l = u.pos[i].xyz - wp; float a = 1.0 / (1.0 + dot(l, "
    "l) * 0.1);"
    "l = normalize(l); vec3 h = normalize(l + v); float d = max(dot(n, l), 0.0); float s = pow(max(dot(n, h), 0.0), "
    "32.0);"
    "sum += u.color[i].rgb * (base * d + s) * a; } o = vec4(pow(sum, vec3(1.0 / 2.2)), 1.0); }";

double measure_phong(Run& run) {
  const cts::Target target = make_screen(run, 1280, 720);
  const Knot knot = make_knot(640, 40);
  const cts::Buffer vertices = run.buffer_of(knot.vertices), indices = run.buffer_of(knot.indices);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.maxLod = 1000;
  const VkSampler sampler = run.sampler(info);
  const std::vector<float> lights{0, 0, 4, 1, 3, 3, 3, 1, -3, 2, 3, 1, 0, -3, 4, 1, 2, 2, 2, 1, 1, 2, 3, 1, 3, 1, 1, 1};
  const cts::Buffer uniforms = run.buffer_of(lights);
  const cts::Image albedo = make_texture(run, 512, 1), normals = make_texture(run, 512, 77);
  const cts::Resources resources = run.resources(
      {cts::sampled(0, albedo, sampler), cts::sampled(1, normals, sampler), cts::uniform_buffer(2, uniforms)}, 64);
  cts::GraphicsSpec spec;
  spec.vertex = kPhongVertex;
  spec.fragment = kPhongFragment;
  spec.layout = resources.layout;
  spec.floats({3, 3, 3, 2});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  const float f = 1.9f, near = 0.1f, far = 10.0f, distance = 4.0f;
  const float matrix[16] = {f * 9 / 16,
                            0,
                            0,
                            0,
                            0,
                            f,
                            0,
                            0,
                            0,
                            0,
                            far / (near - far),
                            -1,
                            0,
                            0,
                            -distance * far / (near - far) + near * far / (near - far),
                            distance};
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  resources.bind(cmd);
  vkCmdPushConstants(cmd, resources.layout, VK_SHADER_STAGE_ALL, 0, 64, matrix);
  cts::bind_vertices(cmd, vertices);
  vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(cmd, static_cast<std::uint32_t>(knot.indices.size()), 1, 0, 0, 0);
  vkCmdEndRenderPass(cmd);
  return 1 / time_submissions(run, finish(cmd), 1.0);
}

constexpr char kObjectVertex[] =
    "layout(location=0) in vec3 p; layout(location=1) in vec3 n; layout(location=2) in vec3 at; layout(location=3) in "
    "float scale;"
    "layout(push_constant) uniform P { mat4 m; vec4 light; } pc;"
    "layout(location=0) out vec3 wn; layout(location=1) out vec3 wc; layout(location=2) out vec3 wv; "
    "layout(location=3) out vec3 wl;"
    "void main() { wn = n; wc = abs(n) * 0.5 + 0.5; vec3 q = p * scale + at; gl_Position = pc.m * vec4(q, 1.0);"
    "wl = normalize(pc.light.xyz - q); wv = -q; }";
constexpr char kObjectFragment[] =
    "layout(location=0) in vec3 wn; layout(location=1) in vec3 wc; layout(location=2) in vec3 wv; layout(location=3) "
    "in vec3 wl; layout(location=0) out vec4 o;"
    "void main() { vec3 n = normalize(wn), l = normalize(wl); o = vec4(max(dot(n, l), 0.2) * wc, 1.0); }";

/// A mesh of 2 * rings * sides triangles drawn by one multi-draw of indirect commands, as after culling on the device:
/// one instance for half of the objects, none for the others.
double measure_objects(Run& run, std::uint32_t rings, std::uint32_t sides, std::uint32_t columns, std::uint32_t rows) {
  const cts::Target target = make_screen(run, 1280, 720);
  const Knot knot = make_knot(rings, sides);
  const auto count = static_cast<std::uint32_t>(knot.indices.size());
  std::vector<float> instances;
  std::vector<VkDrawIndexedIndirectCommand> commands;
  const float width = 2 / static_cast<float>(columns), height = 2 / static_cast<float>(rows);
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    const auto x = static_cast<float>(i % columns) + 0.5f, y = static_cast<float>(i / columns) + 0.5f;
    for (const float v : {x * width - 1, y * height - 1, 0.5f, width * 0.2f}) instances.push_back(v);
    commands.push_back({count, i % 2, 0, 0, i});
  }
  const cts::Buffer vertices = run.buffer_of(knot.vertices), indices = run.buffer_of(knot.indices),
                    places = run.buffer_of(instances), draws = run.buffer_of(commands);
  const cts::Resources resources = run.resources({}, 80);
  cts::GraphicsSpec spec;
  spec.vertex = kObjectVertex;
  spec.fragment = kObjectFragment;
  spec.layout = resources.layout;
  spec.bindings = {{0, 44, VK_VERTEX_INPUT_RATE_VERTEX}, {1, 16, VK_VERTEX_INPUT_RATE_INSTANCE}};
  spec.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                     {1, 0, VK_FORMAT_R32G32B32_SFLOAT, 12},
                     {2, 1, VK_FORMAT_R32G32B32_SFLOAT, 0},
                     {3, 1, VK_FORMAT_R32_SFLOAT, 12}};
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  const float push[20] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2, 3, 4, 1};
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  resources.bind(cmd);
  vkCmdPushConstants(cmd, resources.layout, VK_SHADER_STAGE_ALL, 0, sizeof(push), push);
  const VkBuffer streams[] = {vertices.handle, places.handle};
  const VkDeviceSize offsets[] = {0, 0};
  vkCmdBindVertexBuffers(cmd, 0, 2, streams, offsets);
  vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexedIndirect(cmd, draws.handle, 0, columns * rows, sizeof(VkDrawIndexedIndirectCommand));
  vkCmdEndRenderPass(cmd);
  return count / 3.0 * (columns * rows / 2) / time_submissions(run, finish(cmd)) / 1e6;
}

}  // namespace

std::vector<Workload> triangle_workloads() {
  const auto grid = [](const char* name, float cell, std::uint32_t repeats, bool depth_only = false) {
    return Workload{name, "Mtri/s", false, [=](Run& run) { return measure_grid(run, cell, repeats, depth_only); }};
  };
  return {grid("tri_tiny", 2, 1),
          grid("tri_50px", 10, 4),
          grid("tri_5000px", 100, 16),
          grid("depth_only_tiny", 2, 1, true),
          {"vertex_bound", "Mvert/s", false, measure_vertex_bound},
          {"vertex_culled", "Mvert/s", false, measure_culled},
          {"instanced", "Mtri/s", false, measure_instanced},
          {"indirect_objects", "Mtri/s", false, [](Run& run) { return measure_objects(run, 20, 8, 60, 50); }},
          {"indirect_small", "Mtri/s", false, [](Run& run) { return measure_objects(run, 6, 3, 200, 150); }},
          {"scene_phong", "frame/s", false, measure_phong}};
}

}  // namespace vitrine::bench
