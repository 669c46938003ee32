// Transform feedback: every last stage, several buffers, strides and gaps, counters, pause and resume, streams,
// overflow, queries, draws by byte count.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0, xfb_buffer = 0, xfb_offset = 16, xfb_stride = 48) out vec4 passed;
layout(location = 1, xfb_buffer = 1, xfb_offset = 4, xfb_stride = 20) out vec3 extra;
layout(location = 2, xfb_buffer = 0, xfb_offset = 36) out float list[2];
out gl_PerVertex {
  layout(xfb_buffer = 0, xfb_offset = 0) vec4 gl_Position;
  float gl_PointSize;
};
void main() {
  passed = color;
  extra = color.zyx * 2.0;
  list[0] = float(gl_VertexIndex);
  list[1] = float(gl_InstanceIndex);
  gl_Position = position;
  gl_PointSize = 1.0;
})";

struct Feedback {
  PFN_vkCmdBindTransformFeedbackBuffersEXT bind;
  PFN_vkCmdBeginTransformFeedbackEXT begin;
  PFN_vkCmdEndTransformFeedbackEXT end;
  PFN_vkCmdBeginQueryIndexedEXT begin_query;
  PFN_vkCmdEndQueryIndexedEXT end_query;
  PFN_vkCmdDrawIndirectByteCountEXT draw;
};

Feedback load_feedback(Run& run) {
  run.require(run.gpu.has("VK_EXT_transform_feedback"), "transform feedback");
  Feedback f{};
  f.bind = CTS_COMMAND(run.gpu, CmdBindTransformFeedbackBuffersEXT);
  f.begin = CTS_COMMAND(run.gpu, CmdBeginTransformFeedbackEXT);
  f.end = CTS_COMMAND(run.gpu, CmdEndTransformFeedbackEXT);
  f.begin_query = CTS_COMMAND(run.gpu, CmdBeginQueryIndexedEXT);
  f.end_query = CTS_COMMAND(run.gpu, CmdEndQueryIndexedEXT);
  f.draw = CTS_COMMAND(run.gpu, CmdDrawIndirectByteCountEXT);
  return f;
}

constexpr VkBufferUsageFlags kCaptureUsage =
    VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT | VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_COUNTER_BUFFER_BIT_EXT;

Buffer filled(Run& run, VkDeviceSize bytes) {
  const Buffer buffer = run.buffer(bytes, kCaptureUsage);
  std::memset(buffer.data, 0xee, bytes);
  return buffer;
}

std::vector<float> random_vertices(Random& random, uint32_t count) {
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i) {
    for (const float v : {random.real(-1.4f, 1.4f), random.real(-1.4f, 1.4f), random.unit(), 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  return values;
}

GraphicsSpec base_spec(VkPrimitiveTopology topology) {
  GraphicsSpec spec;
  spec.vertex = kVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.assembly.topology = topology;
  return spec;
}

void memory_barrier(VkCommandBuffer cmd) {
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0,
                       nullptr, 0, nullptr);
}

/// One draw of 31 vertices (twice, indexed or not) into two buffers, with its query.
void capture(Run& run, const GraphicsSpec& spec, bool indexed, VkDeviceSize first_size = 16384) {
  const Feedback f = load_feedback(run);
  const Target target = make_target(run, {});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_vertices(run.random, 32));
  std::vector<uint16_t> order;
  for (uint32_t i = 0; i < 47; ++i)
    order.push_back(spec.assembly.primitiveRestartEnable && i % 9 == 8 ? uint16_t{0xffff}
                                                                       : static_cast<uint16_t>(run.random.below(32)));
  const Buffer indices = run.buffer_of(order);
  const Buffer first = filled(run, first_size), second = filled(run, 8192), counters = filled(run, 16);
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT, 1);
  const Buffer counts = run.buffer(16, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 1);
    const VkBuffer handles[] = {first.handle, second.handle};
    const VkDeviceSize offsets[] = {0, 64}, sizes[] = {first_size, 8192 - 64};
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    f.bind(cmd, 0, 2, handles, offsets, sizes);
    f.begin_query(cmd, pool, 0, 0, 0);
    f.begin(cmd, 0, 0, nullptr, nullptr);
    for (int k = 0; k < 2; ++k) {
      if (indexed)
        vkCmdDrawIndexed(cmd, static_cast<uint32_t>(order.size()), 2, 0, 0, 0);
      else
        vkCmdDraw(cmd, 31, 2, 0, 0);
    }
    const VkBuffer counter_handles[] = {counters.handle, counters.handle};
    const VkDeviceSize counter_offsets[] = {0, 8};
    f.end(cmd, 0, 2, counter_handles, counter_offsets);
    f.end_query(cmd, pool, 0, 0);
    vkCmdEndRenderPass(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 1, counts.handle, 0, 16, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
  });
  out_target(run, target);
  run.out("first", first);
  run.out("second", second);
  run.out("counters", counters);
  run.out("counts", counts);
}

/// The same without a picture: primitives end behind the vertex shader.
void capture_alone(Run& run, GraphicsSpec& spec) {
  spec.raster.rasterizerDiscardEnable = VK_TRUE;
  spec.fragment.clear();
  capture(run, spec, false);
  run.may_be_blank();
}

struct Topology {
  const char* name;
  VkPrimitiveTopology value;
};
constexpr Topology kTopologies[] = {
    {"point_list", VK_PRIMITIVE_TOPOLOGY_POINT_LIST},         {"line_list", VK_PRIMITIVE_TOPOLOGY_LINE_LIST},
    {"line_strip", VK_PRIMITIVE_TOPOLOGY_LINE_STRIP},         {"triangle_list", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST},
    {"triangle_strip", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP}, {"triangle_fan", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN},
};

const bool kRegistered = [] {
  for (const Topology& topology : kTopologies) {
    const bool strip = topology.value == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP ||
                       topology.value == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP ||
                       topology.value == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
    AddCase("transform_feedback", std::string("vertex.") + topology.name,
            [=](Run& run) { capture(run, base_spec(topology.value), false); });
    AddCase("transform_feedback", std::string("last_provoking_vertex.") + topology.name, [=](Run& run) {
      run.require(run.gpu.extension_features.transformFeedbackPreservesProvokingVertex,
                  "transformFeedbackPreservesProvokingVertex");
      VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking{
          VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
      provoking.provokingVertexMode = VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
      GraphicsSpec spec = base_spec(topology.value);
      spec.raster.pNext = &provoking;
      capture(run, spec, false);
    });
    AddCase("transform_feedback", std::string("vertex.") + topology.name + ".indexed", [=](Run& run) {
      GraphicsSpec spec = base_spec(topology.value);
      spec.assembly.primitiveRestartEnable = strip;
      capture(run, spec, true);
    });
  }
  return true;
}();

/// Random layouts: strides with gaps, a buffer or two, ranges that are too small, several draws.
CTS_RANDOM("transform_feedback", "random", 20) {
  const Feedback f = load_feedback(run);
  Random& random = run.random;
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(kTopologies[random.below(std::size(kTopologies))].value);
  const bool two = random.chance(0.5f);
  const uint32_t gap = 4 * random.below(5), stride = 32 + gap + 4 * random.below(4), other = two ? 1 : 0;
  const uint32_t second_stride = two ? 8 + 4 * random.below(6) : stride;
  const auto place = [](uint32_t buffer, uint32_t offset, uint32_t size) {
    return "xfb_buffer = " + std::to_string(buffer) + ", xfb_offset = " + std::to_string(offset) +
           ", xfb_stride = " + std::to_string(size);
  };
  spec.vertex =
      "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n"
      "layout(location = 0, " +
      place(0, 16 + gap, stride) +
      ") out vec3 passed;\n"
      "layout(location = 1, " +
      place(other, two ? 4 : 28 + gap, second_stride) +
      ") out uint number;\n"
      "out gl_PerVertex { layout(" +
      place(0, gap, stride) +
      ") vec4 gl_Position; float gl_PointSize; };\n"
      "void main() {\n  passed = color.yzx;\n  number = uint(gl_VertexIndex * 3 + gl_InstanceIndex);\n"
      "  gl_Position = position.yxzw;\n  gl_PointSize = 1.0;\n}\n";
  spec.fragment =
      "layout(location = 0) in vec3 passed;\nlayout(location = 0) out vec4 result;\n"
      "void main() { result = vec4(passed, 1.0); }\n";
  spec.raster.rasterizerDiscardEnable = random.chance(0.3f);
  if (spec.raster.rasterizerDiscardEnable) spec.fragment.clear();
  run.note("vertex", spec.vertex);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const uint32_t count = 5 + random.below(60), instances = 1 + random.below(3), draws = 1 + random.below(3);
  const Buffer vertices = run.buffer_of(random_vertices(random, count));
  const VkDeviceSize whole = VkDeviceSize{count} * instances * draws * 3 * 96;
  const Buffer buffers[2] = {filled(run, whole), filled(run, whole)};
  const VkDeviceSize offsets[2] = {4 * random.below(8), 4 * random.below(8)};
  VkDeviceSize sizes[2];
  for (int i = 0; i < 2; ++i)
    sizes[i] = random.chance(0.3f) ? 64 + 4 * random.below(static_cast<uint32_t>(whole / 16)) : whole - offsets[i];
  const Buffer counter = filled(run, 8);
  run.once([&](VkCommandBuffer cmd) {
    const VkBuffer handles[] = {buffers[0].handle, buffers[1].handle};
    const VkBuffer counters[] = {counter.handle, counter.handle};
    const VkDeviceSize counter_offsets[] = {4, 0};
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    f.bind(cmd, 0, 1 + other, handles, offsets, sizes);
    f.begin(cmd, 0, 0, nullptr, nullptr);
    for (uint32_t i = 0; i < draws; ++i) vkCmdDraw(cmd, count, instances, 0, 0);
    f.end(cmd, 0, 1 + other, counters, counter_offsets);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.out("first", buffers[0]);
  run.out("second", buffers[1]);
  run.out("counter", counter);
  run.may_be_blank();
}

CTS_CASE("transform_feedback", "overflow") {
  capture(run, base_spec(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST), false, 48 * 3 * 7 + 20);
}

/// The blocks of an array are captured by consecutive buffers.
CTS_CASE("transform_feedback", "array_of_blocks") {
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP);
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0, xfb_buffer = 0, xfb_offset = 8, xfb_stride = 40) out Block { vec4 wide; vec2 narrow; } blocks[2];
void main() {
  blocks[0].wide = color;
  blocks[0].narrow = position.xy;
  blocks[1].wide = color.wzyx;
  blocks[1].narrow = color.xy;
  gl_Position = position;
})";
  capture_alone(run, spec);
}

/// Doubles, and structures with doubles, begin at multiples of eight bytes.
CTS_CASE("transform_feedback", "doubles_in_structures") {
  run.require(run.gpu.features.shaderFloat64, "shaderFloat64");
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP);
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
struct Inner { vec2 a; float b; dvec2 c; };
struct Outer { vec3 a; Inner b; };
layout(location = 0, xfb_buffer = 0, xfb_offset = 8, xfb_stride = 72) out Block { Outer a; int b; } block;
void main() {
  block.a.a = color.xyz;
  block.a.b.a = position.xy;
  block.a.b.b = color.w;
  block.a.b.c = dvec2(color.zw) * 3.0lf;
  block.b = gl_VertexIndex;
  gl_Position = position;
})";
  capture_alone(run, spec);
}

/// A structure that is no block is captured as a whole.
CTS_CASE("transform_feedback", "structure") {
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP);
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
struct Inner { float a[2]; int b; };
struct Outer { vec3 a; Inner b; mat2 c; };
layout(location = 0, xfb_buffer = 0, xfb_offset = 12, xfb_stride = 68) out Outer whole;
layout(location = 9, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 24) out Inner list[2];
void main() {
  whole.a = color.xyz;
  whole.b = Inner(float[2](position.x, color.w), gl_VertexIndex);
  whole.c = mat2(position.yx, color.zw);
  list[0] = whole.b;
  list[1] = Inner(float[2](color.x, color.y), gl_InstanceIndex);
  gl_Position = position;
})";
  capture_alone(run, spec);
}

/// Numbers of 16 bits take two bytes each. The reference, whose outputs have 32 bits, captures pairs of them as words.
GraphicsSpec narrow_spec(Run& run) {
  const auto& features = run.gpu.extension_features;
  run.require(run.gpu.features.shaderInt16 && features.shaderFloat16, "16-bit arithmetic");
  const bool narrow = features.storageInputOutput16;
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
  spec.vertex = "#version 450\n#extension GL_EXT_shader_explicit_arithmetic_types : require\n";
  spec.vertex += narrow ? R"(#extension GL_EXT_shader_16bit_storage : require
layout(location = 2, xfb_buffer = 0, xfb_offset = 8, xfb_stride = 40) out f16vec3 a;
layout(location = 3, xfb_buffer = 0, xfb_offset = 14) out int16_t b;
layout(location = 4, xfb_buffer = 0, xfb_offset = 16) out float16_t list[4];
struct Inner { u16vec2 x; float y; };
layout(location = 10, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 24) out Block {
  float16_t h;
  uint16_t u;
  Inner inner;
  int16_t last[2];
};
void give(f16vec3 va, int16_t vb, float16_t v[4], u16vec2 x, float y) {
  a = va;
  b = vb;
  list = v;
  h = v[1];
  u = x.y;
  inner.x = x;
  inner.y = y;
  last[0] = vb;
  last[1] = int16_t(x.x);
}
)"
                        : R"(
layout(location = 2, xfb_buffer = 0, xfb_offset = 8, xfb_stride = 40) out uvec2 ab;
layout(location = 4, xfb_buffer = 0, xfb_offset = 16) out uvec2 list;
layout(location = 10, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 24) out Block {
  uint hu;
  uint x;
  float y;
  uint last;
};
uint pair(uint low, uint high) { return (low & 65535u) | high << 16; }
uint pair(float16_t low, float16_t high) { return packFloat2x16(f16vec2(low, high)); }
void give(f16vec3 va, int16_t vb, float16_t v[4], u16vec2 xx, float yy) {
  ab = uvec2(pair(va.x, va.y), pair(uint(float16BitsToUint16(va.z)), uint(vb)));
  list = uvec2(pair(v[0], v[1]), pair(v[2], v[3]));
  hu = pair(uint(float16BitsToUint16(v[1])), uint(xx.y));
  x = pair(uint(xx.x), uint(xx.y));
  y = yy;
  last = pair(uint(vb), uint(xx.x));
}
)";
  spec.fragment.clear();
  spec.raster.rasterizerDiscardEnable = VK_TRUE;
  return spec;
}
constexpr char kNarrowValues[] = R"(
  float16_t list_of[4] = float16_t[4](float16_t(c.x), float16_t(c.y * 1e-4), float16_t(-c.z), float16_t(7.0));
  give(f16vec3(c.xyz), int16_t(c.x * -900.0), list_of, u16vec2(c.yz * 10000.0), c.w + c.x);
)";

CTS_CASE("transform_feedback", "narrow.vertex") {
  GraphicsSpec spec = narrow_spec(run);
  spec.vertex +=
      std::string("layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 c;\nvoid main() {\n") +
      kNarrowValues + "  gl_Position = position;\n}\n";
  capture(run, spec, false);
  run.may_be_blank();
}

CTS_CASE("transform_feedback", "narrow.geometry") {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  GraphicsSpec spec = narrow_spec(run);
  spec.geometry = spec.vertex +
                  "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 4) out;\n"
                  "layout(location = 0) in vec4 passed[];\nvoid main() {\n  for (int i = 0; i < 4; i++) {\n"
                  "    vec4 c = passed[i % 3] * float(i);\n" +
                  kNarrowValues + "    gl_Position = gl_in[i % 3].gl_Position;\n    EmitVertex();\n  }\n}\n";
  spec.vertex = kColorVertex;
  capture(run, spec, false);
  run.may_be_blank();
}

CTS_CASE("transform_feedback", "rasterizer_discard") {
  const Feedback f = load_feedback(run);
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
  spec.raster.rasterizerDiscardEnable = VK_TRUE;
  spec.fragment.clear();
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_vertices(run.random, 3000));
  const Buffer first = filled(run, 3000 * 3 * 48), second = filled(run, 3000 * 3 * 20);
  run.once([&](VkCommandBuffer cmd) {
    const VkBuffer handles[] = {first.handle, second.handle};
    const VkDeviceSize offsets[] = {0, 0};
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    f.bind(cmd, 0, 2, handles, offsets, nullptr);
    f.begin(cmd, 0, 0, nullptr, nullptr);
    vkCmdDraw(cmd, 3000, 1, 0, 0);
    f.end(cmd, 0, 0, nullptr, nullptr);
    vkCmdEndRenderPass(cmd);
  });
  run.out("first", first);
  run.out("second", second);
}

/// Two feedbacks, the second going on where the first ended, then a draw of what was captured.
CTS_CASE("transform_feedback", "pause_resume_and_draw") {
  const Feedback f = load_feedback(run);
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST);
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0, xfb_buffer = 0, xfb_offset = 16, xfb_stride = 32) out vec4 passed;
out gl_PerVertex { layout(xfb_buffer = 0, xfb_offset = 0) vec4 gl_Position; };
void main() { passed = color.wzyx; gl_Position = position * vec4(0.7, 0.7, 1.0, 1.0); })";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  GraphicsSpec plain = base_spec(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST);
  plain.vertex = kColorVertex;
  const VkPipeline drawing = make_pipeline(run, plain, target);
  const Buffer vertices = run.buffer_of(random_vertices(run.random, 30));
  const Buffer captured = filled(run, 4096), counter = filled(run, 8);
  run.once([&](VkCommandBuffer cmd) {
    const VkDeviceSize zero = 0, four = 4;
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    f.bind(cmd, 0, 1, &captured.handle, &zero, nullptr);
    f.begin(cmd, 0, 0, nullptr, nullptr);
    vkCmdDraw(cmd, 12, 1, 3, 0);
    f.end(cmd, 0, 1, &counter.handle, &four);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
    memory_barrier(cmd);
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    f.bind(cmd, 0, 1, &captured.handle, &zero, nullptr);
    f.begin(cmd, 0, 1, &counter.handle, &four);
    vkCmdDraw(cmd, 9, 2, 15, 0);
    f.end(cmd, 0, 1, &counter.handle, &four);
    vkCmdEndRenderPass(cmd);
    memory_barrier(cmd);
    target.begin(cmd);
    bind_pipeline(cmd, drawing);
    bind_vertices(cmd, captured);
    f.draw(cmd, 1, 0, counter.handle, 4, 0, 32);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.out("captured", captured);
  run.out("counter", counter);
}

CTS_CASE("transform_feedback", "geometry") {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST);
  spec.vertex = kColorVertex;
  spec.geometry = R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 7) out;
layout(location = 0) in vec4 passed[];
layout(location = 0, xfb_buffer = 0, xfb_offset = 16, xfb_stride = 32) out vec4 color;
layout(location = 1, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 8) flat out ivec2 number;
out gl_PerVertex { layout(xfb_buffer = 0, xfb_offset = 0) vec4 gl_Position; };
void main() {
  for (int i = 0; i < 4 + gl_PrimitiveIDIn % 4; ++i) {
    gl_Position = gl_in[i % 3].gl_Position * vec4(vec2(1.0 - 0.1 * float(i)), 1.0, 1.0);
    color = passed[i % 3];
    number = ivec2(i, gl_PrimitiveIDIn);
    EmitVertex();
    if (gl_PrimitiveIDIn == 2 && i == 2) EndPrimitive();
  }
})";
  capture(run, spec, false);
}

CTS_CASE("transform_feedback", "tessellation") {
  run.require(run.gpu.features.tessellationShader, "tessellation");
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_PATCH_LIST);
  spec.vertex = kColorVertex;
  spec.tessellation.patchControlPoints = 3;
  spec.control = R"(
layout(vertices = 3) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color[];
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  color[gl_InvocationID] = passed[gl_InvocationID];
  gl_TessLevelOuter = float[4](2.0, 3.0, 1.5, 0.0);
  gl_TessLevelInner = float[2](2.5, 0.0);
})";
  spec.evaluation = R"(
layout(triangles, fractional_odd_spacing, ccw) in;
layout(location = 0) in vec4 color[];
layout(location = 0, xfb_buffer = 0, xfb_offset = 16, xfb_stride = 32) out vec4 passed;
layout(location = 1, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 12) out vec3 at;
out gl_PerVertex { layout(xfb_buffer = 0, xfb_offset = 0) vec4 gl_Position; };
void main() {
  gl_Position = vec4(0.0);
  for (int i = 0; i < 3; ++i) gl_Position += gl_in[i].gl_Position * gl_TessCoord[i];
  passed = color[1];
  at = gl_TessCoord;
})";
  capture(run, spec, false, 32768);
}

/// Three vertex streams into three buffers, with a query for each.
void capture_streams(Run& run, VkQueryType type) {
  const Feedback f = load_feedback(run);
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  const Target target = make_target(run, {});
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
  spec.vertex = kColorVertex;
  spec.geometry = R"(
layout(points) in;
layout(points, max_vertices = 12) out;
layout(location = 0) in vec4 passed[];
layout(location = 0, stream = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 16) out vec4 zero;
layout(location = 1, stream = 1, xfb_buffer = 1, xfb_offset = 4, xfb_stride = 12) out vec2 one;
layout(location = 2, stream = 2, xfb_buffer = 2, xfb_offset = 0, xfb_stride = 4) out float two;
void main() {
  for (int i = 0; i < 2 + gl_PrimitiveIDIn % 3; ++i) {
    zero = passed[0] + float(i);
    gl_Position = gl_in[0].gl_Position * (1.0 - 0.1 * float(i));
    gl_PointSize = 2.0;
    EmitStreamVertex(0);
    EndStreamPrimitive(0);
    if (passed[0].x > 0.5) {
      one = passed[0].zw * float(i + 1);
      EmitStreamVertex(1);
      EndStreamPrimitive(1);
    }
    two = float(gl_PrimitiveIDIn * 10 + i);
    EmitStreamVertex(2);
    EndStreamPrimitive(2);
  }
})";
  spec.fragment =
      "layout(location = 0) in vec4 zero;\nlayout(location = 0) out vec4 result;\nvoid main() { result = zero * 0.3; "
      "}\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values = random_vertices(run.random, 200);
  for (size_t i = 0; i < values.size(); i += 8)
    for (size_t c = 0; c < 2; ++c) values[i + c] = std::min(std::max(values[i + c], -1.0f), 1.0f);
  const Buffer vertices = run.buffer_of(values);
  const Buffer buffers[] = {filled(run, 16384), filled(run, 16384), filled(run, 1024)};
  const VkQueryPool pool = make_query_pool(run, type, 3);
  const Buffer counts = run.buffer(3 * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  std::memset(counts.data, 0, counts.size);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 3);
    const VkBuffer handles[] = {buffers[0].handle, buffers[1].handle, buffers[2].handle};
    const VkDeviceSize offsets[] = {0, 0, 0};
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    f.bind(cmd, 0, 3, handles, offsets, nullptr);
    for (uint32_t stream = 0; stream < 3; ++stream) f.begin_query(cmd, pool, stream, 0, stream);
    f.begin(cmd, 0, 0, nullptr, nullptr);
    vkCmdDraw(cmd, 200, 1, 0, 0);
    f.end(cmd, 0, 0, nullptr, nullptr);
    for (uint32_t stream = 0; stream < 3; ++stream) f.end_query(cmd, pool, stream, stream);
    vkCmdEndRenderPass(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 3, counts.handle, 0, 16, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
  });
  out_target(run, target);
  for (const Buffer& buffer : buffers) run.out("stream" + std::to_string(&buffer - buffers), buffer);
  run.out("counts", counts);
}

CTS_CASE("transform_feedback", "streams") { capture_streams(run, VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT); }

CTS_CASE("transform_feedback", "primitives_generated") {
  run.require(run.gpu.has("VK_EXT_primitives_generated_query"), "primitives generated queries");
  const Target target = make_target(run, {});
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_PRIMITIVES_GENERATED_EXT, 2);
  const Buffer counts = run.buffer(16, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const Buffer vertices = run.buffer_of(random_vertices(run.random, 50));
  GraphicsSpec spec = base_spec(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
  spec.vertex = kColorVertex;
  const VkPipeline drawn = make_pipeline(run, spec, target);
  spec.raster.rasterizerDiscardEnable = VK_TRUE;
  spec.fragment.clear();
  const VkPipeline discarded = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 2);
    target.begin(cmd);
    bind_vertices(cmd, vertices);
    for (const uint32_t query : {0u, 1u}) {
      bind_pipeline(cmd, query == 0 ? drawn : discarded);
      vkCmdBeginQuery(cmd, pool, query, 0);
      vkCmdDraw(cmd, 50, 3, 0, 0);
      vkCmdEndQuery(cmd, pool, query);
    }
    vkCmdEndRenderPass(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 2, counts.handle, 0, 8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
  });
  out_target(run, target);
  run.out("counts", counts);
}

}  // namespace
}  // namespace vitrine::cts
