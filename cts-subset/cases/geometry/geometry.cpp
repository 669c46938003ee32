// Geometry shaders: every input topology, output primitive and built-in, divergent emission, instanced invocations.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

struct Input {
  const char* name;
  VkPrimitiveTopology topology;
  const char* layout;  ///< GLSL input layout
  uint32_t vertices;   ///< of a primitive
};
constexpr Input kInputs[] = {
    {"point_list", VK_PRIMITIVE_TOPOLOGY_POINT_LIST, "points", 1},
    {"line_list", VK_PRIMITIVE_TOPOLOGY_LINE_LIST, "lines", 2},
    {"line_strip", VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, "lines", 2},
    {"triangle_list", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, "triangles", 3},
    {"triangle_strip", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, "triangles", 3},
    {"triangle_fan", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, "triangles", 3},
    {"line_list_adjacency", VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, "lines_adjacency", 4},
    {"line_strip_adjacency", VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, "lines_adjacency", 4},
    {"triangle_list_adjacency", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, "triangles_adjacency", 6},
    {"triangle_strip_adjacency", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY, "triangles_adjacency", 6},
};

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
layout(location = 1) out float weight;
void main() {
  passed = color;
  weight = color.x + float(gl_InstanceIndex) * 0.25;
  gl_Position = position + vec4(0.3, 0.2, 0.0, 0.0) * float(gl_InstanceIndex);
  gl_PointSize = 1.0 + color.y * 5.0;
})";

std::vector<float> random_vertices(Random& random, uint32_t count, bool clipped) {
  std::vector<float> values;
  const float reach = clipped ? 1.6f : 1.0f;
  for (uint32_t i = 0; i < count; ++i) {
    const float w = random.chance(0.5f) ? 1.0f : random.real(0.5f, 2.0f);
    for (const float v : {random.real(-reach, reach) * w, random.real(-reach, reach) * w, random.unit() * w, w})
      values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  return values;
}

struct Draw {
  uint32_t vertices = 24, instances = 1;
  bool indexed = false, restart = false, clipped = false;
};

void draw(Run& run, const Target& target, VkPipeline pipeline, const Draw& what) {
  const Buffer vertices = run.buffer_of(random_vertices(run.random, what.vertices, what.clipped));
  std::vector<uint16_t> order;
  for (uint32_t i = 0; i < what.vertices * 2; ++i)
    order.push_back(what.restart && run.random.chance(0.12f) ? uint16_t{0xffff}
                                                             : static_cast<uint16_t>(run.random.below(what.vertices)));
  const Buffer indices = run.buffer_of(order);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    if (what.indexed) {
      vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
      vkCmdDrawIndexed(cmd, static_cast<uint32_t>(order.size()), what.instances, 0, 0, 0);
    } else {
      vkCmdDraw(cmd, what.vertices, what.instances, 0, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

GraphicsSpec base_spec(Run& run, const Input& input) {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  run.require(run.gpu.features.shaderTessellationAndGeometryPointSize, "point sizes of geometry shaders");
  GraphicsSpec spec;
  spec.vertex = kVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.assembly.topology = input.topology;
  return spec;
}

std::string head(const Input& input, const char* output, uint32_t max_vertices, uint32_t invocations = 1) {
  return std::string("layout(") + input.layout + ", invocations = " + std::to_string(invocations) + ") in;\n" +
         "layout(" + output + ", max_vertices = " + std::to_string(max_vertices) + ") out;\n" +
         "layout(location = 0) in vec4 passed[];\nlayout(location = 1) in float weight[];\n";
}

/// A small triangle at every input vertex; its colour tells which vertex of which primitive it is.
void mark_vertices(Run& run, const Input& input, const Draw& what) {
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(run, input);
  const std::string n = std::to_string(input.vertices);
  spec.geometry = head(input, "triangle_strip", input.vertices * 3) + R"(
layout(location = 0) out vec4 result;
void main() {
  for (int i = 0; i < )" +
                  n + R"(; ++i) {
    for (int k = 0; k < 3; ++k) {
      vec2 at = vec2(k & 1, k >> 1) * (0.1 + 0.03 * float(i));
      gl_Position = gl_in[i].gl_Position + vec4(at, 0.0, 0.0);
      result = vec4(float(i) * 0.15, float(gl_PrimitiveIDIn % 16) / 15.0, passed[i].z, weight[i]);
      EmitVertex();
    }
    EndPrimitive();
  }
})";
  spec.assembly.primitiveRestartEnable = what.restart;
  spec.assembly.topology = input.topology;
  draw(run, target, make_pipeline(run, spec, target), what);
}

const bool kRegistered = [] {
  for (const Input& input : kInputs) {
    const std::string name = std::string("input.") + input.name;
    AddCase("geometry", name + ".direct", [=](Run& run) { mark_vertices(run, input, {}); });
    AddCase("geometry", name + ".indexed", [=](Run& run) { mark_vertices(run, input, {24, 2, true, false, false}); });
    const bool strip = input.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP ||
                       input.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP ||
                       input.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN ||
                       input.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY ||
                       input.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY;
    if (strip)
      AddCase("geometry", name + ".restart", [=](Run& run) { mark_vertices(run, input, {40, 1, true, true, false}); });
    AddCase("draw", std::string(input.name) + ".without_geometry", [=](Run& run) {
      const Target target = make_target(run, {});
      GraphicsSpec spec = base_spec(run, input);
      spec.assembly.primitiveRestartEnable = strip;
      const bool clipped = input.vertices != 1;  // deviations.md, point-clipping
      draw(run, target, make_pipeline(run, spec, target), {30, 1, true, strip, clipped});
    });
  }
  return true;
}();

const Input& kTriangles = kInputs[3];

/// A geometry shader over triangles, a fragment shader, on a target.
void run_case(Run& run, const std::string& geometry, const std::string& fragment = kColorFragment,
              const TargetSpec& target_spec = {}, const Draw& what = {24, 1, false, false, true}) {
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec = base_spec(run, kTriangles);
  spec.geometry = geometry;
  spec.fragment = fragment;
  draw(run, target, make_pipeline(run, spec, target), what);
}

CTS_CASE("geometry", "output.points") {
  run_case(run, head(kTriangles, "points", 3) + R"(
layout(location = 0) out vec4 result;
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = vec4(clamp(gl_in[i].gl_Position.xy / gl_in[i].gl_Position.w, -1.0, 1.0), 0.5, 1.0);
    gl_PointSize = gl_in[i].gl_PointSize + float(i);
    result = passed[i];
    EmitVertex();
  }
})");
}

CTS_CASE("geometry", "output.lines") {
  run_case(run, head(kTriangles, "line_strip", 8) + R"(
layout(location = 0) out vec4 result;
void main() {
  for (int i = 0; i < 8; ++i) {
    gl_Position = gl_in[i % 3].gl_Position * (1.0 - 0.05 * float(i));
    result = passed[2 - i % 3];
    EmitVertex();
    if (i == 3) EndPrimitive();
  }
})");
}

CTS_CASE("geometry", "output.nothing") {
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(run, kTriangles);
  spec.geometry = head(kTriangles, "triangle_strip", 5) + R"(
layout(location = 0) out vec4 result;
void main() {
  result = passed[0];
  gl_Position = gl_in[0].gl_Position;
  EmitVertex();
  EmitVertex();
  EndPrimitive();
  if (gl_PrimitiveIDIn != 2) return;
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
})";
  draw(run, target, make_pipeline(run, spec, target), {});
}

CTS_CASE("geometry", "invocations") {
  run_case(run, head(kTriangles, "triangle_strip", 3, 5) + R"(
layout(location = 0) out vec4 result;
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position * vec4(vec2(1.0 - 0.15 * float(gl_InvocationID)), 1.0, 1.0);
    result = passed[i] * (0.4 + 0.15 * float(gl_InvocationID));
    EmitVertex();
  }
})");
}

CTS_CASE("geometry", "divergent_emission") {
  run_case(run, head(kTriangles, "triangle_strip", 24) + R"(
layout(location = 0) out vec4 result;
void emit(int i, float scale) {
  gl_Position = gl_in[i % 3].gl_Position * vec4(vec2(scale), 1.0, 1.0);
  result = passed[(i + gl_PrimitiveIDIn) % 3];
  EmitVertex();
}
void main() {
  if (gl_PrimitiveIDIn == 3) return;
  int count = 3 + (gl_PrimitiveIDIn * 7) % 11;
  for (int i = 0; i < count; ++i) {
    if ((gl_PrimitiveIDIn & 1) == 1 && i % 4 == 3) EndPrimitive();
    if (passed[i % 3].x > 0.9) continue;
    emit(i, 1.0 - 0.04 * float(i));
    if (gl_PrimitiveIDIn == 6 && i == 5) break;
  }
  switch (gl_PrimitiveIDIn % 3) {
    case 0: EndPrimitive();
    case 1: emit(0, 0.5); emit(1, 0.4); emit(2, 0.3); break;
    default: emit(1, 0.2);
  }
})");
}

CTS_CASE("geometry", "clip_and_cull_distances") {
  run.require(run.gpu.features.shaderClipDistance && run.gpu.features.shaderCullDistance, "clip and cull distances");
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(run, kTriangles);
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
layout(location = 1) out float weight;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2]; };
void main() {
  passed = color;
  weight = 1.0;
  gl_Position = position;
  gl_PointSize = 1.0;
  gl_ClipDistance[0] = color.x - 0.3;
  gl_ClipDistance[1] = 0.8 - color.y;
})";
  spec.geometry = head(kTriangles, "triangle_strip", 3) + R"(
in gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2]; } gl_in[];
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[3]; float gl_CullDistance[1]; };
layout(location = 0) out vec4 result;
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    gl_ClipDistance[0] = gl_in[i].gl_ClipDistance[1];
    gl_ClipDistance[1] = gl_in[i].gl_ClipDistance[0];
    gl_ClipDistance[2] = gl_Position.x + 0.7;
    gl_CullDistance[0] = gl_PrimitiveIDIn % 3 == 1 ? -1.0 : float(i) - 0.5;
    result = passed[i];
    EmitVertex();
  }
})";
  draw(run, target, make_pipeline(run, spec, target), {36, 1, false, false, true});
}

CTS_CASE("geometry", "flat_and_linear_varyings") {
  for (const bool swap : {false, true})
    run_case(run,
             head(kTriangles, "triangle_strip", 6) + R"(
layout(location = 0) out vec4 smooth_color;
layout(location = 1) flat out ivec2 number;
layout(location = 2) noperspective out vec2 linear_color;
layout(location = 3) out mat2 matrix;
layout(location = 5) out float list[2];
void main() {
  for (int i = 0; i < 6; ++i) {
    int v = )" + std::string(swap ? "5 - i" : "i") +
                 R"(;
    gl_Position = gl_in[v % 3].gl_Position * vec4(v < 3 ? 1.0 : 0.6, v < 3 ? 1.0 : -0.7, 1.0, 1.0);
    smooth_color = passed[v % 3];
    number = ivec2(v, gl_PrimitiveIDIn);
    linear_color = passed[v % 3].zw;
    matrix = mat2(passed[v % 3].xy, passed[0].xy);
    list[0] = passed[1].x;
    list[1] = weight[v % 3];
    EmitVertex();
  }
})",
             R"(
layout(location = 0) in vec4 smooth_color;
layout(location = 1) flat in ivec2 number;
layout(location = 2) noperspective in vec2 linear_color;
layout(location = 3) in mat2 matrix;
layout(location = 5) in float list[2];
layout(location = 0) out vec4 result;
void main() {
  result = vec4(smooth_color.x * 0.5 + float(number.x) * 0.1, linear_color.x + matrix[0].y * 0.2,
                float(number.y) * 0.1 + matrix[1].x * 0.1, list[0] * 0.5 + list[1] * 0.5);
})",
             {}, {24, 1, false, false, true});
}

CTS_CASE("geometry", "double_varyings") {
  run.require(run.gpu.features.shaderFloat64, "shaderFloat64");
  run_case(run, head(kTriangles, "triangle_strip", 3) + R"(
layout(location = 0) flat out dvec3 wide;
layout(location = 1, component = 2) flat out double one;
layout(location = 2) flat out dvec2 list[2];
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    wide = dvec3(passed[i].xyz) * 1.000000001lf;
    one = double(weight[i]) / 3.0lf;
    list[i & 1] = dvec2(passed[i].zw) + 1e-9lf;
    list[1] = dvec2(passed[0].xw) - 1e-9lf;
    EmitVertex();
  }
})",
           R"(
layout(location = 0) flat in dvec3 wide;
layout(location = 1, component = 2) flat in double one;
layout(location = 2) flat in dvec2 list[2];
layout(location = 0) out vec4 result;
void main() { result = vec4(wide.xy + list[0], wide.z + one, list[1].x * 0.5lf + list[1].y * 0.5lf); })",
           {}, {24, 1, false, false, true});
}

CTS_CASE("geometry", "layer") {
  TargetSpec layered;
  layered.depth = VK_FORMAT_D32_SFLOAT;
  layered.layers = 4;
  const Target target = make_target(run, layered);
  GraphicsSpec spec = base_spec(run, kTriangles);
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.geometry = head(kTriangles, "triangle_strip", 12) + R"(
layout(location = 0) out vec4 result;
void main() {
  for (int layer = 0; layer < 4; ++layer) {
    if ((gl_PrimitiveIDIn + layer) % 3 == 0) continue;
    for (int i = 0; i < 3; ++i) {
      gl_Position = gl_in[i].gl_Position;
      gl_Layer = layer;
      result = passed[i];
      EmitVertex();
    }
    EndPrimitive();
  }
})";
  spec.fragment = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = vec4(passed.xyz, float(gl_Layer) / 4.0); })";
  draw(run, target, make_pipeline(run, spec, target), {36, 1, false, false, true});
}

CTS_CASE("geometry", "primitive_id") {
  run_case(run, head(kTriangles, "triangle_strip", 4) + R"(
layout(location = 0) out vec4 result;
void main() {
  for (int i = 0; i < 4; ++i) {
    gl_Position = gl_in[i % 3].gl_Position * vec4(vec2(i == 3 ? -0.8 : 1.0), 1.0, 1.0);
    gl_PrimitiveID = gl_PrimitiveIDIn * 10 + i;
    result = passed[i % 3];
    EmitVertex();
  }
})",
           R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = vec4(passed.xy, float(gl_PrimitiveID) / 100.0, float(gl_PrimitiveID % 10) / 10.0); })");
}

CTS_CASE("geometry", "storage_buffer") {
  run.require(run.gpu.features.vertexPipelineStoresAndAtomics, "stores in vertex stages");
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(run, kTriangles);
  const Buffer log = run.buffer(4096);
  std::memset(log.data, 0, log.size);
  const Resources resources = run.resources({storage_buffer(0, log)});
  spec.layout = resources.layout;
  spec.geometry = head(kTriangles, "triangle_strip", 3, 2) + R"(
layout(location = 0) out vec4 result;
layout(set = 0, binding = 0) buffer Log { uint count; uint pad; vec2 entry[]; } log;
void main() {
  atomicAdd(log.count, 1u);
  log.entry[gl_PrimitiveIDIn * 2 + gl_InvocationID] = passed[gl_InvocationID].xy;
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    result = passed[i] * (gl_InvocationID == 0 ? 1.0 : 0.5);
    EmitVertex();
  }
})";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_vertices(run.random, 60, true));
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    resources.bind(cmd);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 60, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.out("log", log);
}

CTS_CASE("geometry", "many_vertices") {
  run_case(run, head(kTriangles, "triangle_strip", 90) + R"(
layout(location = 0) out vec4 result;
void main() {
  int steps = 30 + gl_PrimitiveIDIn * 2;
  for (int i = 0; i < steps; ++i) {
    float t = float(i) / float(steps - 1);
    vec4 a = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, t);
    vec4 b = mix(gl_in[0].gl_Position, gl_in[2].gl_Position, t * t);
    gl_Position = (i & 1) == 0 ? a : b;
    result = mix(passed[0], passed[1 + (i & 1)], t);
    EmitVertex();
  }
})",
           kColorFragment, {{VK_FORMAT_R8G8B8A8_UNORM}, VK_FORMAT_UNDEFINED, 150, 130}, {90, 2, false, false, true});
}

CTS_CASE("geometry", "pipeline_statistics") {
  run.require(run.gpu.features.pipelineStatisticsQuery, "pipeline statistics");
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(run, kTriangles);
  spec.geometry = head(kTriangles, "triangle_strip", 6) + R"(
layout(location = 0) out vec4 result;
void main() {
  for (int i = 0; i < 3 + gl_PrimitiveIDIn % 4; ++i) {
    gl_Position = gl_in[i % 3].gl_Position * vec4(vec2(1.0 - 0.1 * float(i)), 1.0, 1.0);
    result = passed[i % 3];
    EmitVertex();
  }
})";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  constexpr VkQueryPipelineStatisticFlags kStatistics = VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
                                                        VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
                                                        VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_INVOCATIONS_BIT |
                                                        VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_PRIMITIVES_BIT |
                                                        VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT;
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_PIPELINE_STATISTICS, 1, kStatistics);
  const Buffer vertices = run.buffer_of(random_vertices(run.random, 60, false));
  const Buffer counts = run.buffer(5 * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 1);
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdBeginQuery(cmd, pool, 0, 0);
    vkCmdDraw(cmd, 60, 1, 0, 0);
    vkCmdEndQuery(cmd, pool, 0);
    vkCmdEndRenderPass(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 1, counts.handle, 0, 0, VK_QUERY_RESULT_WAIT_BIT);
  });
  out_target(run, target);
  run.out("counts", counts);
}

/// A random shader: what is emitted depends on primitive, invocation and varyings.
CTS_RANDOM("geometry", "random", 40) {
  Random& random = run.random;
  const Input& input = kInputs[random.below(std::size(kInputs))];
  TargetSpec target_spec;
  target_spec.width = 16 + random.below(120);
  target_spec.height = 16 + random.below(120);
  if (random.chance(0.4f)) target_spec.depth = VK_FORMAT_D32_SFLOAT;
  // The reference loses lines of less than a pixel when multisampled (deviations.md, multisample-short-lines).
  const uint32_t kind = random.below(3);
  if (kind != 1 && random.chance(0.25f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  if (random.chance(0.3f) && target_spec.samples == VK_SAMPLE_COUNT_1_BIT) target_spec.layers = 1 + random.below(4);
  // The reference takes the layer of a clipped primitive from memory that it has not written.
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec = base_spec(run, input);
  const uint32_t steps = 1 + random.below(14), invocations = random.chance(0.4f) ? 1 + random.below(4) : 1;
  const auto number = [](float value) { return std::to_string(value); };
  const float reach = target_spec.layers > 1 ? 0.3f : 1.0f;
  std::string body;
  body += "  for (int i = 0; i < " + std::to_string(steps) + " + gl_PrimitiveIDIn % 3; ++i) {\n";
  if (random.chance(0.5f)) {
    const std::string jump = random.pick({"continue", "EndPrimitive()", "break"});
    const std::string limit = number(random.real(0.5f, 1));
    body += "    if (passed[i % N]." + std::string(random.pick({"x", "y", "z"})) + " > " + limit + ") " + jump + ";\n";
  }
  body +=
      "    int v = " + std::string(random.pick({"i % N", "(i * 2 + gl_InvocationID) % N", "N - 1 - i % N"})) + ";\n";
  body += "    vec4 p = gl_in[v].gl_Position;\n";
  const std::string by_invocation = number(random.real(-0.2f, 0.2f) * reach);
  const std::string by_step = number(random.real(-0.1f, 0.1f) * reach);
  body += "    p.xy = p.xy * " + number(random.real(0.3f, 1.2f) * reach) + " + vec2(float(i) * " + by_step +
          ", float(gl_InvocationID) * " + by_invocation + ") * p.w;\n";
  if (kind == 0) body += "    p.xy = clamp(p.xy, -p.w, p.w);\n    gl_PointSize = 1.0 + 6.0 * passed[v].x;\n";
  body += "    gl_Position = p;\n";
  if (target_spec.layers > 1)
    body += "    gl_Layer = (gl_PrimitiveIDIn + gl_InvocationID) % " + std::to_string(target_spec.layers) + ";\n";
  body += "    result = passed[v] * " + number(random.real(0.5f, 1.0f)) + ";\n";
  body += "    tone = weight[v];\n    EmitVertex();\n";
  if (random.chance(0.5f)) body += "    if (i % " + std::to_string(2 + random.below(4)) + " == 1) EndPrimitive();\n";
  body += "  }\n";
  // The reference has room for as many strips as max_vertices would have primitives, and writes beyond it.
  constexpr const char* kOutputs[] = {"points", "line_strip", "triangle_strip"};
  spec.geometry = head(input, kOutputs[kind], 2 * steps + 6, invocations) +
                  "const int N = " + std::to_string(input.vertices) + ";\nlayout(location = 0) out vec4 result;\n" +
                  "layout(location = 1) " + random.pick({"flat", "noperspective", "smooth"}) +
                  " out float tone;\nvoid main() {\n" + body + "}\n";
  const std::string qualifier = spec.geometry.find("flat out") != std::string::npos            ? "flat"
                                : spec.geometry.find("noperspective out") != std::string::npos ? "noperspective"
                                                                                               : "smooth";
  spec.fragment = "layout(location = 0) in vec4 passed;\nlayout(location = 1) " + qualifier +
                  " in float tone;\nlayout(location = 0) out vec4 result;\n"
                  "void main() { result = vec4(passed.xyz, tone); }\n";
  run.note("geometry", spec.geometry);
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.raster.cullMode = kind == 2 && random.chance(0.3f) ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
  if (kind == 2 && target_spec.samples == VK_SAMPLE_COUNT_1_BIT && random.chance(0.2f))
    spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
  const bool strip = input.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP ||
                     input.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP ||
                     input.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
  const bool restart = strip && random.chance(0.5f);
  spec.assembly.primitiveRestartEnable = restart;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw(run, target, pipeline,
       {12 + random.below(80), 1 + random.below(3), restart || random.chance(0.5f), restart,
        target_spec.layers == 1 && random.chance(0.5f)});
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
