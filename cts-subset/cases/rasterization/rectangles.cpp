// Rectangles and what nearly is one, in a window's format and without depth: the reference draws two triangles that
// form an axis-aligned rectangle as one there, and clips in x and y at twice the volume (docs/lavapipe-rasterization.md
// 9). What is interpolated is shown bit by bit, as that is where it tells.
#include <algorithm>
#include <array>
#include <numeric>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Numbers of a corner: position, a vector of which some rows of `Look` have planes, another one.
constexpr uint32_t kFloats = 12;

const char kShown[] = R"(
vec4 bits_of(float v) { return unpackUnorm4x8(floatBitsToUint(v)); }
)";

std::string vertex_text(const std::string& qualifiers, bool point_size, bool layer = false) {
  return std::string(layer ? "#extension GL_ARB_shader_viewport_layer_array : require\n" : "") +
         "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 first;\n"
         "layout(location = 2) in vec4 second;\nlayout(location = 0) " +
         qualifiers + " out vec4 a;\nlayout(location = 1) out vec4 b;\nvoid main() {\n  a = first;\n  b = second;\n" +
         "  gl_Position = position;\n" + (point_size ? "  gl_PointSize = 1.0;\n" : "") +
         (layer ? "  gl_Layer = gl_VertexIndex / 6 % 2;\n" : "") + "}\n";
}

std::string fragment_text(Random& random, const std::string& qualifiers) {
  const char* value = random.pick<const char*>(
      {"a", "bits_of(a.x)", "bits_of(a.y)", "bits_of(a.x + b.w)", "bits_of(b.x)", "bits_of(gl_FragCoord.z)",
       "bits_of(gl_FragCoord.w)", "bits_of(a.x * (gl_FrontFacing ? 1.0 : 2.0))", "vec4(1.0, 0.5, 0.25, 0.5)",
       "fract(a * 37.0 + b.yzwx)", "bits_of(dFdx(a.x))"});
  const std::string text = value;
  // What is not read must not be declared flat: it would count as flat for the reference only where it is read.
  return "layout(location = 0) " + qualifiers +
         " in vec4 a;\nlayout(location = 1) in vec4 b;\nlayout(location = 0) out vec4 color;\n" + kShown +
         "void main() { color = " + text + "; }\n";
}

/// Four corners, counted around.
struct Quad {
  float x0, y0, x1, y1, z, w;
  float a[4][4], b[4][4];
};

Quad random_quad(Random& random, float reach) {
  Quad quad{};
  const float step = random.pick({0.125f, 0.03125f, 0.0f});
  const auto place = [&] {
    const float at = random.real(-reach, reach);
    return step == 0 ? at : static_cast<float>(static_cast<int>(at / step)) * step;
  };
  quad.x0 = place();
  quad.y0 = place();
  const float size = random.pick({0.1f, 0.5f, 2.0f});
  quad.x1 = random.chance(0.3f) ? place() : quad.x0 + random.unit() * size;
  quad.y1 = random.chance(0.3f) ? place() : quad.y0 + random.unit() * size;
  if (random.chance(0.1f)) quad.x0 = quad.y0 = -1, quad.x1 = quad.y1 = 1;
  quad.z = random.unit();
  quad.w = random.chance(0.6f) ? 1.0f : random.real(0.5f, 2.0f);
  const auto fill = [&](float(&values)[4][4]) {
    const uint32_t kind = random.below(4);  // planes in steps that are exact, planes, planes of constants, none
    for (int c = 0; c < 4; ++c) {
      const auto number = [&] {
        return kind == 0 ? static_cast<float>(random.below(64)) * 0.125f : random.real(-1.0f, 2.0f);
      };
      const float base = number(), dx = kind == 2 ? 0.0f : number(), dy = kind == 2 ? 0.0f : number();
      for (int corner = 0; corner < 4; ++corner) {
        const bool right = corner == 1 || corner == 2, low = corner >= 2;
        values[corner][c] = kind == 3 ? number() : base + (right ? dx : 0.0f) + (low ? dy : 0.0f);
      }
    }
  };
  fill(quad.a);
  fill(quad.b);
  return quad;
}

/// Corners: (x0, y0), (x1, y0), (x1, y1), (x0, y1).
void append_corner(Random& random, std::vector<float>& values, const Quad& quad, uint32_t corner, bool jitter) {
  const bool right = corner == 1 || corner == 2, low = corner >= 2;
  float x = right ? quad.x1 : quad.x0, y = low ? quad.y1 : quad.y0, w = quad.w;
  if (jitter) {
    (random.chance(0.5f) ? x : y) += 0.01f;
    if (random.chance(0.2f)) w *= 1.25f;
  }
  for (const float v : {x * w, y * w, quad.z * w, w}) values.push_back(v);
  for (const float v : quad.a[corner]) values.push_back(v);
  for (const float v : quad.b[corner]) values.push_back(v);
}

void random_state(Run& run, GraphicsSpec& spec, const TargetSpec& target) {
  Random& random = run.random;
  spec.raster.cullMode =
      random.chance(0.5f) ? 0 : random.pick<VkCullModeFlags>({VK_CULL_MODE_BACK_BIT, VK_CULL_MODE_FRONT_BIT});
  spec.raster.frontFace = static_cast<VkFrontFace>(random.below(2));
  if (random.chance(0.1f)) {
    spec.raster.depthBiasEnable = VK_TRUE;
    spec.raster.depthBiasConstantFactor = random.real(-200.0f, 200.0f);
    spec.raster.depthBiasSlopeFactor = random.real(-3.0f, 3.0f);
  }
  const auto width = static_cast<float>(target.width), height = static_cast<float>(target.height);
  if (random.chance(0.3f)) {
    const float x = random.real(0, width * 0.4f), y = random.real(0, height * 0.4f);
    const float w = random.real(width * 0.3f, width - x), h = random.real(height * 0.3f, height - y);
    spec.viewports = {random.chance(0.3f) ? VkViewport{x, y + h, w, -h, 0, 1} : VkViewport{x, y, w, h, 0, 1}};
  }
  if (random.chance(0.3f)) {
    const auto x = static_cast<int32_t>(random.below(target.width / 2));
    const auto y = static_cast<int32_t>(random.below(target.height / 2));
    spec.scissors = {{{x, y}, {1 + random.below(target.width), 1 + random.below(target.height)}}};
  }
  VkPipelineColorBlendAttachmentState blend{};
  blend.colorWriteMask = random.chance(0.9f) ? 0xf : random.below(16);
  blend.blendEnable = random.chance(0.2f);
  blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  spec.blends = {blend};
}

/// Vertices of a draw, and its indices: as they are counted, or corners that triangles share.
struct Geometry {
  std::vector<float> values;
  std::vector<uint16_t> indices;

  uint32_t vertices() const { return static_cast<uint32_t>(values.size() / kFloats); }
  void count_up() {
    indices.resize(vertices());
    std::iota(indices.begin(), indices.end(), uint16_t{0});
  }
};

/// A list in which the triangles of each quad can join in many ways, and some cannot. `shared`: four corners each.
Geometry list_of(Random& random, const std::vector<Quad>& quads, bool shared) {
  Geometry out;
  for (const Quad& quad : quads) {
    const uint32_t turn = random.below(4), first = out.vertices();
    const bool back = random.chance(0.5f), mixed = random.chance(0.1f);
    for (uint32_t corner = 0; shared && corner < 4; ++corner) append_corner(random, out.values, quad, corner, false);
    const auto triangle = [&](std::array<uint32_t, 3> corners, bool reversed) {
      if (reversed) std::swap(corners[1], corners[2]);
      std::rotate(corners.begin(), corners.begin() + random.below(3), corners.end());
      for (uint32_t corner : corners) {
        corner = (corner + turn) % 4;
        if (shared)
          out.indices.push_back(static_cast<uint16_t>(first + corner));
        else
          append_corner(random, out.values, quad, corner, random.chance(0.03f));
      }
    };
    triangle({0, 1, 2}, back);
    if (random.chance(0.95f)) triangle({0, 2, 3}, back != mixed);
  }
  if (!shared) out.count_up();
  return out;
}

/// Four corners each, in the order of strips or of fans.
Geometry corners_of(Random& random, const std::vector<Quad>& quads, bool strip) {
  Geometry out;
  const uint32_t turn = random.below(2);
  for (const Quad& quad : quads)
    for (const uint32_t corner : {0u, 1u, strip ? 3u : 2u, strip ? 2u : 3u})
      append_corner(random, out.values, quad, corner ^ turn, random.chance(0.02f));
  out.count_up();
  return out;
}

TargetSpec random_window(Random& random) {
  TargetSpec spec;
  spec.width = 16 + random.below(150);
  spec.height = 16 + random.below(150);
  spec.colors = {VK_FORMAT_B8G8R8A8_UNORM};
  return spec;
}

std::vector<Quad> random_quads(Random& random, float reach, uint32_t most) {
  std::vector<Quad> quads;
  for (uint32_t n = 1 + random.below(most); n > 0; --n) quads.push_back(random_quad(random, reach));
  return quads;
}

/// All vertices in one draw without indices.
void draw_whole(Run& run, const Target& target, VkPipeline pipeline, const std::vector<float>& values) {
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, static_cast<uint32_t>(values.size()) / kFloats, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

void random_rectangles(Run& run, VkPrimitiveTopology topology, uint32_t most) {
  Random& random = run.random;
  const TargetSpec target_spec = random_window(random);
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  const std::string qualifiers = random.pick<const char*>({"", "", "", "noperspective", "flat"});
  spec.vertex = vertex_text(qualifiers, random.chance(0.1f));
  spec.fragment = fragment_text(random, qualifiers);
  run.note("fragment", spec.fragment);
  spec.floats({4, 4, 4});
  spec.assembly.topology = topology;
  random_state(run, spec, target_spec);
  const VkPipeline pipeline = make_pipeline(run, spec, target);

  const float reach = random.pick({0.9f, 1.2f, 1.9f, 3.0f});
  const std::vector<Quad> quads = random_quads(random, reach, most);
  const bool list = topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, shared = list && random.chance(0.3f);
  const Geometry geometry = list ? list_of(random, quads, shared)
                                 : corners_of(random, quads, topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
  const Buffer vertices = run.buffer_of(geometry.values), indices = run.buffer_of(geometry.indices);
  const auto count = static_cast<uint32_t>(geometry.indices.size());
  // In one draw, or quad by quad; also with indices.
  const bool whole = list || random.chance(0.4f), indexed = shared || random.chance(0.4f);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    const uint32_t step = whole ? count : 4;
    for (uint32_t first = 0; first + step <= count; first += step) {
      if (indexed)
        vkCmdDrawIndexed(cmd, step, 1, first, 0, 0);
      else
        vkCmdDraw(cmd, step, 1, first, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

/// A strip for every four vertices, and with `twice` a smaller one behind it.
std::string geometry_text(const std::string& qualifiers, bool twice) {
  return "layout(lines_adjacency) in;\nlayout(triangle_strip, max_vertices = 9) out;\nlayout(location = 0) " +
         qualifiers + " in vec4 in_a[];\nlayout(location = 1) in vec4 in_b[];\nlayout(location = 0) " + qualifiers +
         " out vec4 a;\nlayout(location = 1) out vec4 b;\nvoid main() {\n  for (int copy = 0; copy < " +
         (twice ? "2" : "1") + "; ++copy) {\n" + R"(    for (int i = 0; i < 4; ++i) {
      a = in_a[i];
      b = in_b[i];
      gl_Position = gl_in[i].gl_Position;
      gl_Position.xy *= 1.0 - float(copy) * 0.5;
      EmitVertex();
    }
    EndPrimitive();
  }
}
)";
}

/// The quads of a strip each, made by a geometry shader.
CTS_RANDOM("rasterization", "random_rectangles_geometry", 60) {
  Random& random = run.random;
  const TargetSpec target_spec = random_window(random);
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  const std::string qualifiers = random.pick<const char*>({"", "", "", "noperspective", "flat"});
  spec.vertex = vertex_text(qualifiers, false);
  spec.geometry = geometry_text(qualifiers, random.chance(0.3f));
  spec.fragment = fragment_text(random, qualifiers);
  run.note("fragment", spec.fragment);
  spec.floats({4, 4, 4});
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY;
  random_state(run, spec, target_spec);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const float reach = random.pick({0.5f, 0.9f, 1.2f, 3.0f});
  const std::vector<Quad> quads = random_quads(random, reach, random.pick({3u, 40u, 2500u}));
  draw_whole(run, target, pipeline, corners_of(random, quads, true).values);
}

/// Lists whose vertex shader chooses the layer.
CTS_RANDOM("rasterization", "random_rectangles_layers", 30) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.width = target_spec.height = 64;
  target_spec.layers = 2;
  target_spec.colors = {VK_FORMAT_B8G8R8A8_UNORM};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = vertex_text("", false, true);
  spec.fragment = fragment_text(random, "");
  spec.floats({4, 4, 4});
  random_state(run, spec, target_spec);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const float reach = random.pick({0.5f, 0.9f, 1.2f});
  std::vector<float> values;
  for (const Quad& quad : random_quads(random, reach, 8))
    for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) append_corner(random, values, quad, corner, false);
  draw_whole(run, target, pipeline, values);
}

CTS_RANDOM("rasterization", "random_rectangles_list", 60) {
  random_rectangles(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 6);
}
CTS_RANDOM("rasterization", "random_rectangles_long_list", 30) {
  random_rectangles(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 900);
}
CTS_RANDOM("rasterization", "random_rectangles_strip", 60) {
  random_rectangles(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 6);
}
CTS_RANDOM("rasterization", "random_rectangles_fan", 40) {
  random_rectangles(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, 3);
}

}  // namespace
}  // namespace vitrine::cts
