// Barycentric coordinates and what vertices have (VK_KHR_fragment_shader_barycentric), which the reference lacks. It
// draws lists of the same primitives whose vertices carry the corner's unit vector and what all three corners have.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

struct Shape {
  VkPrimitiveTopology topology, list;
  uint32_t corners, first, step;  ///< vertices of a primitive, of the first one, and of each further one
};

constexpr Shape kShapes[] = {
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 3, 3, 3},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 3, 3, 1},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 3, 3, 1},
    {VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 2, 2, 2},
    {VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 2, 2, 1},
    {VK_PRIMITIVE_TOPOLOGY_POINT_LIST, VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 1, 1, 1},
};

/// The number of the vertex that is corner `c` of primitive `i`: the tables of Vulkan 1.3.239, Barycentric
/// Interpolation, of both provoking vertex modes. Where a primitive has no such corner, that of its last.
std::string vertex_number(VkPrimitiveTopology topology, bool last) {
  switch (topology) {
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
      return "3 * i + c";
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
      return last ? "i + ((i & 1) == 0 || c == 2 ? c : 1 - c)" : "i + ((i & 1) == 0 || c == 0 ? c : 3 - c)";
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN:
      return last ? "c == 0 ? 0 : i + c" : "c == 2 ? 0 : i + 1 + c";
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
      return "2 * i + min(c, 1)";
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
      return "i + min(c, 1)";
    default:
      return "i";
  }
}

/// What a vertex has, in a buffer: position, colour, numbers.
constexpr const char* kVertices =
    "struct V { vec4 position, color; uvec4 numbers; };\n"
    "layout(std430, binding = 0) readonly buffer B { V v[]; };\n";

std::string vertex_shader(const Shape& shape, bool last, bool has) {
  std::string code = kVertices;
  if (has)
    return code +
           "layout(location = 0) out vec4 color;\nlayout(location = 1) flat out uvec2 numbers;\n"
           "layout(location = 2) out Block { vec3 x; mat2 y; } block;\n"
           "void main() {\n  V own = v[gl_VertexIndex];\n  color = own.color;\n  numbers = own.numbers.xy;\n"
           "  block.x = own.color.zyx;\n  block.y = mat2(own.color.zw, own.color.yx);\n"
           "  gl_Position = own.position;\n  gl_PointSize = own.numbers.z & 31u;\n}\n";
  const std::string corners = std::to_string(shape.corners);
  return code +
         "layout(location = 0) out vec3 corner;\nlayout(location = 1) noperspective out vec3 corner_linear;\n"
         "layout(location = 2) flat out vec4 colors[3];\nlayout(location = 5) flat out uvec2 numbers[3];\n"
         "int vertex(int i, int c) { return " +
         vertex_number(shape.topology, last) + "; }\nvoid main() {\n  int i = gl_VertexIndex / " + corners +
         ", own = gl_VertexIndex % " + corners +
         ";\n  corner = corner_linear = vec3(own == 0, own == 1, own == 2);\n"
         "  for (int c = 0; c < 3; ++c) {\n    colors[c] = v[vertex(i, c)].color;\n"
         "    numbers[c] = v[vertex(i, c)].numbers.xy;\n  }\n"
         "  gl_Position = v[vertex(i, own)].position;\n  gl_PointSize = v[vertex(i, own)].numbers.z & 31u;\n}\n";
}

/// `where`: how the coordinates are read, with % for what is read.
std::string read_at(const std::string& where, const std::string& what) {
  std::string text = where;
  return text.replace(text.find('%'), 1, what);
}

std::string fragment_shader(const std::string& where, bool has) {
  std::string code =
      has ? "#extension GL_EXT_fragment_shader_barycentric : require\n"
            "layout(location = 0) pervertexEXT in vec4 color[];\n"
            "layout(location = 1) pervertexEXT in uvec2 numbers[];\n"
            "layout(location = 2) pervertexEXT in Block { vec3 x; mat2 y; } block[];\n"
          : "layout(location = 0) in vec3 corner;\nlayout(location = 1) noperspective in vec3 corner_linear;\n"
            "layout(location = 2) flat in vec4 color[3];\nlayout(location = 5) flat in uvec2 numbers[3];\n";
  const auto x = [&](const std::string& i) { return has ? "block[" + i + "].x" : "color[" + i + "].zyx"; };
  const auto y = [&](const std::string& i) { return has ? "block[" + i + "].y[1]" : "color[" + i + "].yx"; };
  return code +
         "layout(location = 0) out vec4 r0;\nlayout(location = 1) out vec4 r1;\nlayout(location = 2) out vec4 r2;\n"
         "layout(location = 3) out uvec4 r3;\nvoid main() {\n  int k = int(gl_FragCoord.x + gl_FragCoord.y) % 3;\n"
         "  r0 = vec4(" +
         read_at(where, has ? "gl_BaryCoordEXT" : "corner") + ", color[k].w);\n  r1 = vec4(" +
         read_at(where, has ? "gl_BaryCoordNoPerspEXT" : "corner_linear") + ", " + x("k") + ".x);\n" +
         "  r2 = vec4(color[1].xy, " + y("2") + ");\n  r3 = uvec4(numbers[k], numbers[0].x ^ numbers[2].y, 1u);\n}\n";
}

/// `clipped`: some may lie outside of the volume.
std::vector<uint32_t> random_vertices(Run& run, uint32_t count, bool clipped) {
  Random& random = run.random;
  std::vector<uint32_t> words;
  const auto add = [&](float value) {
    uint32_t word;
    std::memcpy(&word, &value, sizeof word);
    words.push_back(word);
  };
  const bool outside = random.chance(0.5f) && clipped;
  for (uint32_t i = 0; i < count; ++i) {
    const float w = random.chance(0.3f) ? 1.0f : random.real(outside ? -0.3f : 0.4f, 2.5f),
                reach = outside ? 2.5f : 1.0f;
    for (int c = 0; c < 2; ++c) add(random.real(-reach, reach) * w);
    add(random.real(outside ? -0.5f : 0.1f, outside ? 1.5f : 0.9f) * w);
    add(w);
    for (int c = 0; c < 4; ++c) add(random.real(-4, 4));
    for (int c = 0; c < 4; ++c) words.push_back(random.bits());
  }
  return words;
}

CTS_RANDOM("rasterization", "random_barycentric", 96) {
  Random& random = run.random;
  const Shape& shape = kShapes[run.index % std::size(kShapes)];
  const bool has = run.gpu.extension_features.fragmentShaderBarycentric;
  const bool last = run.gpu.extension_features.provokingVertexLast && random.chance(0.5f);
  run.require(run.gpu.features.sampleRateShading, "sampleRateShading");
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
                        VK_FORMAT_R32G32B32A32_UINT};
  VkPolygonMode mode = VK_POLYGON_MODE_FILL;
  if (shape.corners == 3 && run.gpu.features.fillModeNonSolid && random.chance(0.2f))
    mode = random.chance(0.5f) ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_POINT;
  // Some short lines of several samples vanish on the reference (deviations.md, multisample-short-lines).
  const bool lines = shape.corners == 2 || mode == VK_POLYGON_MODE_LINE;
  target_spec.samples = random.chance(0.4f) && !lines ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
  target_spec.width = 16 + random.below(100);
  target_spec.height = 16 + random.below(100);
  const Target target = make_target(run, target_spec);
  // Of points that lie outside the reference keeps some (deviations.md, point-clipping).
  const uint32_t primitives = 1 + random.below(9), vertices = shape.first + (primitives - 1) * shape.step;
  const Buffer data = run.buffer_of(random_vertices(run, vertices, shape.corners != 1));
  const Resources res = run.resources({storage_buffer(0, data)});
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = vertex_shader(shape, last, has);
  spec.assembly.topology = has ? shape.topology : shape.list;
  spec.multisample.sampleShadingEnable = random.chance(0.3f);
  spec.multisample.minSampleShading = 1.0f;
  spec.raster.polygonMode = mode;
  // Of lines and points the reference has no planes to evaluate elsewhere.
  const bool filled = shape.corners == 3 && mode == VK_POLYGON_MODE_FILL;
  const char* const where = random.pick({"%", "%", "interpolateAtCentroid(%)",
                                         "interpolateAtOffset(%, vec2(0.25, -0.125))", "interpolateAtSample(%, 2)"});
  spec.fragment = fragment_shader(filled ? where : "%", has);
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
  provoking.provokingVertexMode =
      last ? VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT : VK_PROVOKING_VERTEX_MODE_FIRST_VERTEX_EXT;
  if (run.gpu.extension_features.provokingVertexLast) spec.raster.pNext = &provoking;
  run.note("vertex", spec.vertex);
  run.note("fragment", spec.fragment);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res, has ? vertices : primitives * shape.corners);
  out_target(run, target);
  run.may_be_blank();
}

constexpr const char* kControl =
    "layout(vertices = 3) out;\nlayout(location = 0) in vec4 color[];\nlayout(location = 0) out vec4 out_color[];\n"
    "void main() {\n  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
    "  out_color[gl_InvocationID] = color[gl_InvocationID];\n"
    "  gl_TessLevelInner[0] = 3.0;\n  gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 3.0;\n}\n";
constexpr const char* kEvaluation =
    "layout(triangles, equal_spacing, ccw) in;\nlayout(location = 0) in vec4 color[];\n"
    "layout(location = 0) out vec4 out_color;\nvoid main() {\n"
    "  vec3 t = gl_TessCoord;\n  out_color = vec4(t, color[1].x);\n"
    "  gl_Position = t.x * gl_in[0].gl_Position + t.y * gl_in[1].gl_Position + t.z * gl_in[2].gl_Position;\n}\n";

/// Both stages before rasterization. With a geometry shader on the reference that tells the corners apart.
void staged(Run& run, bool tessellates) {
  const bool has = run.gpu.extension_features.fragmentShaderBarycentric;
  run.require(run.gpu.features.geometryShader && run.gpu.features.tessellationShader, "stages");
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  const uint32_t vertices = 3 * 4;
  const Buffer data = run.buffer_of(random_vertices(run, vertices, true));
  const Resources res = run.resources({storage_buffer(0, data)});
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = std::string(kVertices) +
                "layout(location = 0) out vec4 color;\nvoid main() {\n  color = v[gl_VertexIndex].color;\n"
                "  gl_Position = v[gl_VertexIndex].position;\n}\n";
  if (tessellates) {
    spec.control = kControl;
    spec.evaluation = kEvaluation;
    spec.tessellation.patchControlPoints = 3;
    spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  } else {
    spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  }
  if (!has || !tessellates)
    spec.geometry =
        std::string(
            "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n"
            "layout(location = 0) in vec4 color[];\n") +
        (has ? "layout(location = 0) out vec4 out_color;\n"
             : "layout(location = 0) flat out vec4 out_color[3];\nlayout(location = 3) out vec3 corner;\n") +
        "void main() {\n  for (int i = 0; i < 3; ++i) {\n    gl_Position = gl_in[i].gl_Position;\n" +
        (has ? "    out_color = color[i];\n"
             : "    out_color = vec4[3](color[0], color[1], color[2]);\n"
               "    corner = vec3(i == 0, i == 1, i == 2);\n") +
        "    EmitVertex();\n  }\n}\n";
  spec.fragment =
      std::string(has ? "#extension GL_EXT_fragment_shader_barycentric : require\n"
                        "layout(location = 0) pervertexEXT in vec4 color[];\n"
                      : "layout(location = 0) flat in vec4 color[3];\nlayout(location = 3) in vec3 corner;\n") +
      "layout(location = 0) out vec4 r0;\nlayout(location = 1) out vec4 r1;\nvoid main() {\n  r0 = vec4(" +
      (has ? "gl_BaryCoordEXT" : "corner") + ", color[2].w);\n  r1 = color[0] + color[1] * color[2];\n}\n";
  run.note("fragment", spec.fragment);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res, vertices);
  out_target(run, target);
  run.may_be_blank();
}

CTS_RANDOM("rasterization", "barycentric_geometry", 8) { staged(run, false); }
CTS_RANDOM("rasterization", "barycentric_tessellation", 8) { staged(run, true); }

/// Numbers of 64 bits, arrays and components of locations, of each vertex.
CTS_CASE("rasterization", "barycentric_types") {
  run.require(run.gpu.features.shaderFloat64, "shaderFloat64");
  const bool has = run.gpu.extension_features.fragmentShaderBarycentric;
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_SFLOAT}});
  const std::string values =
      "dvec3 wide(int v) { return dvec3(v + 0.1lf, v * 3.0lf, v - 7.0lf); }\n"
      "float one(int v, int i) { return float(v * 10 + i); }\nvec2 pair(int v) { return vec2(v, -v); }\n";
  const std::string place =
      "  gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.5, 1.0);\n";
  GraphicsSpec spec;
  if (has) {
    spec.vertex =
        "layout(location = 0) flat out dvec3 d;\nlayout(location = 2) out float f[2];\n"
        "layout(location = 4, component = 2) out vec2 g;\n" +
        values +
        "void main() {\n  int v = gl_VertexIndex;\n  d = wide(v);\n"
        "  f = float[2](one(v, 0), one(v, 1));\n  g = pair(v);\n" +
        place + "}\n";
    spec.fragment =
        "#extension GL_EXT_fragment_shader_barycentric : require\n"
        "layout(location = 0) pervertexEXT in dvec3 d[3];\n"
        "layout(location = 2) pervertexEXT in float f[3][2];\n"
        "layout(location = 4, component = 2) pervertexEXT in vec2 g[3];\n";
  } else {
    spec.vertex =
        "layout(location = 0) flat out dvec3 d[3];\nlayout(location = 6) flat out float f[3][2];\n"
        "layout(location = 12) flat out vec2 g[3];\n" +
        values +
        "void main() {\n  for (int v = 0; v < 3; ++v) {\n    d[v] = wide(v);\n"
        "    f[v] = float[2](one(v, 0), one(v, 1));\n    g[v] = pair(v);\n  }\n" +
        place + "}\n";
    spec.fragment =
        "layout(location = 0) flat in dvec3 d[3];\nlayout(location = 6) flat in float f[3][2];\n"
        "layout(location = 12) flat in vec2 g[3];\n";
  }
  spec.fragment +=
      "layout(location = 0) out vec4 color;\nvoid main() {\n  int k = int(gl_FragCoord.x) % 3;\n"
      "  color = vec4(float(d[k].z), float(d[1].x + d[2].y), f[k][1] + f[2][0], g[k].y * 0.5 + g[1].x);\n}\n";
  draw_once(run, target, make_pipeline(run, spec, target));
  out_target(run, target);
}

/// Many of every vertex, with both coordinates. The reference has whole numbers in their place.
CTS_CASE("rasterization", "barycentric_many_locations") {
  const bool has = run.gpu.extension_features.fragmentShaderBarycentric;
  // Debian 12's validation layer counts those of each vertex.
  const uint32_t locations = run.gpu.properties.limits.maxFragmentInputComponents / 12 - 1;
  const std::string count = std::to_string(std::min(locations, 31u));
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_SFLOAT}});
  const std::string position =
      "  gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.5, 1.0);\n}\n";
  const std::string value = "vec4 value(int l, int v) { return vec4(l, v, l * v, l + 3 * v); }\n";
  GraphicsSpec spec;
  spec.vertex = has ? "layout(location = 0) out vec4 a[" + count + "];\n" + value +
                          "void main() {\n  for (int l = 0; l < " + count +
                          "; ++l) a[l] = value(l, gl_VertexIndex);\n" + position
                    : "void main() {\n" + position;
  spec.fragment = (has ? "#extension GL_EXT_fragment_shader_barycentric : require\n"
                         "layout(location = 0) pervertexEXT in vec4 a[3][" +
                             count + "];\n#define VALUE(l, v) a[v][l]\n"
                       : value + "#define VALUE(l, v) value(l, v)\n") +
                  "layout(location = 0) out vec4 color;\nvoid main() {\n  vec4 sum = vec4(0.0);\n"
                  "  for (int v = 0; v < 3; ++v)\n    for (int l = 0; l < " +
                  count + "; ++l) sum += VALUE(l, v) * float((int(gl_FragCoord.x) >> (l % 6)) & 1);\n  float all = " +
                  (has ? "dot(gl_BaryCoordEXT + gl_BaryCoordNoPerspEXT, vec3(0.5))" : "1.0") +
                  ";\n  color = sum + floor(all + 0.5);\n}\n";
  draw_once(run, target, make_pipeline(run, spec, target));
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
