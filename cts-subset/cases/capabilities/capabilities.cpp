// Shader capabilities of small extensions: image access without a format, float atomics, the memory model, demotion
// and termination, draw parameters, the clock.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

void dispatch(Run& run, const std::string& code, const std::vector<Binding>& bindings) {
  const Resources res = run.resources(bindings);
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, 1);
}

Image storage(Run& run, VkFormat format) {
  ImageSpec spec;
  spec.format = format;
  spec.extent = {8, 8, 1};
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  return run.image(spec);
}

/// Reads one image and writes another, neither with a format in the shader; the reference, which does not claim that,
/// is told `layout`.
void image_without_format(Run& run, VkFormat format, const std::string& prefix, const std::string& layout) {
  const VkPhysicalDeviceFeatures& features = run.gpu.features;
  run.require((run.gpu.features_of(format) & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0, "storage images");
  const Image from = storage(run, format), to = storage(run, format);
  run.fill_random(from);
  const std::string read = features.shaderStorageImageReadWithoutFormat ? "" : ", " + layout;
  const std::string write = features.shaderStorageImageWriteWithoutFormat ? "" : ", " + layout;
  dispatch(run,
           "#extension GL_EXT_shader_image_load_formatted : require\n"
           "layout(local_size_x = 8, local_size_y = 8) in;\n"
           "layout(binding = 0" +
               read + ") uniform " + prefix + "image2D a;\nlayout(binding = 1" + write + ") uniform writeonly " +
               prefix +
               "image2D b;\n"
               "void main() { ivec2 at = ivec2(gl_GlobalInvocationID.xy); imageStore(b, at, imageLoad(a, at.yx)); "
               "}\n",
           {storage_image(0, from), storage_image(1, to)});
  run.out("written", to);
}

const bool kWithoutFormat = [] {
  struct Row {
    VkFormat format;
    const char *prefix, *layout;
  };
  const Row kRows[] = {
      {VK_FORMAT_R8G8B8A8_UNORM, "", "rgba8"},
      {VK_FORMAT_R8G8B8A8_SNORM, "", "rgba8_snorm"},
      {VK_FORMAT_R32_SFLOAT, "", "r32f"},
      {VK_FORMAT_R16G16B16A16_SFLOAT, "", "rgba16f"},
      {VK_FORMAT_R32G32B32A32_UINT, "u", "rgba32ui"},
      {VK_FORMAT_R8_SINT, "i", "r8i"},
      {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "", "rgb10_a2"},
      {VK_FORMAT_R16G16_UINT, "u", "rg16ui"},
  };
  for (const Row& row : kRows)
    AddCase("capabilities", std::string("image_without_format.") + row.layout,
            [=](Run& run) { image_without_format(run, row.format, row.prefix, row.layout); });
  return true;
}();

constexpr char kAtomicFloat[] =
    "// target: vulkan1.1\n#extension GL_EXT_shader_atomic_float : require\n"
    "#extension GL_EXT_shader_atomic_float2 : require\n"
    "#extension GL_KHR_memory_scope_semantics : require\n";

/// Sums of small integers: exact in any order.
void atomic_float(Run& run, const std::string& operation) {
  run.require(run.gpu.extension_features.shaderBufferFloat32AtomicAdd &&
                  run.gpu.extension_features.shaderSharedFloat32AtomicAdd,
              "shaderBufferFloat32AtomicAdd");
  run.require(run.gpu.extension_features.shaderBufferFloat32AtomicMinMax, "float atomic min and max");
  const Buffer out = run.buffer_of<float>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  dispatch(run,
           std::string(kAtomicFloat) +
               "layout(local_size_x = 64) in;\nlayout(std430, binding = 0) buffer R { float r[]; };\n"
               "shared float s[4];\n"
               "void main() {\n"
               "  uint i = gl_LocalInvocationIndex, k = i & 3u;\n"
               "  if (i < 4u) s[i] = 5.0;\n"
               "  barrier();\n"
               "  float v = float(int(i * 7u % 61u) - 20);\n"
               "  " +
               operation + "(r[k], v);\n  " + operation + "(s[k], v);\n  " + operation +
               "(r[4], v);\n"
               "  barrier();\n"
               "  if (i < 4u) r[8u + i] = s[i];\n"
               "}\n",
           {storage_buffer(0, out)});
  run.out("result", out, VK_FORMAT_R32_SFLOAT);
}
CTS_CASE("capabilities", "atomic_float.add") { atomic_float(run, "atomicAdd"); }
CTS_CASE("capabilities", "atomic_float.min") { atomic_float(run, "atomicMin"); }
CTS_CASE("capabilities", "atomic_float.max") { atomic_float(run, "atomicMax"); }

/// Both signs of 1, zero, infinity, quiet and signaling NaN, the least and the greatest denormal.
std::vector<std::uint32_t> special_floats() {
  std::vector<std::uint32_t> bits;
  for (const std::uint32_t magnitude :
       {0x3f800000u, 0u, 0x7f800000u, 0x7fc00001u, 0x7fa00001u, 0x7fffffffu, 1u, 0x007fffffu})
    for (const std::uint32_t sign : {0u, 0x80000000u}) bits.push_back(magnitude | sign);
  return bits;
}

/// Every pair of them, one as what memory holds and one as the operand; in a buffer and in shared memory.
void atomic_float_specials(Run& run, const std::string& operation) {
  run.require(run.gpu.extension_features.shaderBufferFloat32AtomicMinMax &&
                  run.gpu.extension_features.shaderSharedFloat32AtomicMinMax,
              "float atomic min and max");
  const std::vector<std::uint32_t> bits = special_floats();
  const std::size_t count = bits.size();
  std::vector<std::uint32_t> memory, operands;
  for (std::size_t i = 0; i < count * count; ++i) {
    memory.push_back(bits[i / count]);
    operands.push_back(bits[i % count]);
  }
  const Buffer out = run.buffer_of(memory), in = run.buffer_of(operands), shared = run.buffer_of(memory);
  dispatch(run,
           std::string(kAtomicFloat) +
               "layout(local_size_x = 256) in;\nlayout(std430, binding = 0) buffer R { float r[256]; };\n"
               "layout(std430, binding = 1) buffer V { float v[256]; };\n"
               "layout(std430, binding = 2) buffer S { float t[256]; };\n"
               "shared float s[256];\n"
               "void main() {\n"
               "  uint i = gl_LocalInvocationIndex;\n"
               "  s[i] = t[i];\n"
               "  barrier();\n  " +
               operation + "(r[i], v[i]);\n  " + operation +
               "(s[i], v[i]);\n"
               "  barrier();\n"
               "  t[i] = s[i];\n"
               "}\n",
           {storage_buffer(0, out), storage_buffer(1, in), storage_buffer(2, shared)});
  run.out("buffer", out);
  run.out("shared", shared);
}
CTS_CASE("capabilities", "atomic_float.special_min") { atomic_float_specials(run, "atomicMin"); }
CTS_CASE("capabilities", "atomic_float.special_max") { atomic_float_specials(run, "atomicMax"); }

CTS_CASE("capabilities", "atomic_float.exchange") {
  run.require(run.gpu.extension_features.shaderBufferFloat32Atomics, "shaderBufferFloat32Atomics");
  const Buffer out = run.buffer_of<float>(std::vector<float>(65, 2.5f));
  dispatch(run,
           std::string(kAtomicFloat) +
               "layout(local_size_x = 64) in;\nlayout(std430, binding = 0) buffer R { float r[]; };\n"
               "void main() {\n"
               "  uint i = gl_LocalInvocationIndex;\n"
               "  float old = atomicExchange(r[i], float(i));\n"
               "  atomicStore(r[i], old + atomicLoad(r[i], gl_ScopeDevice, 0, 0), gl_ScopeDevice, 0, 0);\n"
               "}\n",
           {storage_buffer(0, out)});
  run.out("result", out, VK_FORMAT_R32_SFLOAT);
}

/// A width whose atomics the reference lacks.
struct Rare {
  const char *type, *suffix;
  bool has;       ///< this device has all its atomics
  Buffer memory;  ///< 1, 2, 3, ... 12
};

Rare doubles(Run& run) {
  const auto& features = run.gpu.extension_features;
  run.require(run.gpu.features.shaderFloat64, "shaderFloat64");
  const bool has = features.shaderBufferFloat64Atomics && features.shaderBufferFloat64AtomicAdd &&
                   features.shaderSharedFloat64Atomics && features.shaderSharedFloat64AtomicAdd &&
                   features.shaderBufferFloat64AtomicMinMax && features.shaderSharedFloat64AtomicMinMax;
  return {"double", "LF", has, run.buffer_of<double>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12})};
}

Rare halves(Run& run) {
  const auto& features = run.gpu.extension_features;
  run.require(features.shaderFloat16 && features.storageBuffer16BitAccess, "binary16 in buffers");
  const bool has = features.shaderBufferFloat16Atomics && features.shaderBufferFloat16AtomicAdd &&
                   features.shaderBufferFloat16AtomicMinMax && features.shaderSharedFloat16Atomics &&
                   features.shaderSharedFloat16AtomicAdd && features.shaderSharedFloat16AtomicMinMax;
  return {"float16_t", "HF", has,
          run.buffer_of<uint16_t>(
              {0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600, 0x4700, 0x4800, 0x4880, 0x4900, 0x4980, 0x4a00})};
}

constexpr char kHalfExtensions[] =
    "#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require\n"
    "#extension GL_EXT_shader_16bit_storage : require\n#extension GL_EXT_buffer_reference : require\n";

/// Sums and extrema of multiples of 1/2, exact in any order; the reference, which lacks the atomics, does the same one
/// by one.
void rare_atomic(Run& run, const Rare& rare, const std::string& operation, const std::string& alone) {
  const std::string type = rare.type, suffix = rare.suffix;
  const auto act = [&](const std::string& at) {
    if (rare.has) return operation + "(" + at + ", value(i));\n";
    return at + " = " + alone + "(" + at + ", value(j));\n";
  };
  const auto all = [&](const std::string& at, const std::string& when) {
    return rare.has ? "if (" + when + ") " + act(at)
                    : "if (i == 0u) for (uint j = 0u; j < 64u; j++) if (" + when + ") " + act(at);
  };
  const std::string k = rare.has ? "(i & 3u)" : "(j & 3u)";
  dispatch(run,
           std::string(kAtomicFloat) + kHalfExtensions +
               "layout(local_size_x = 64) in;\nlayout(std430, binding = 0) buffer R { " + type +
               " r[]; };\n"
               "shared " +
               type + " s[4];\n" + type + " value(uint i) { return " + type + "(int(i * 7u % 61u) - 20) + 0.5" +
               suffix + "; }\n" + type + " sum(" + type + " a, " + type +
               " b) { return a + b; }\n"
               "void main() {\n"
               "  uint i = gl_LocalInvocationIndex;\n"
               "  if (i < 4u) s[i] = 5.0" +
               suffix +
               ";\n"
               "  barrier();\n  " +
               all("r[" + k + "]", "true") + "  " + all("s[" + k + "]", "true") + "  " + all("r[4]", "true") + "  " +
               all("r[5]", rare.has ? "i == 9u" : "j == 9u") +
               "  barrier();\n"
               "  if (i < 4u) r[8u + i] = s[i];\n"
               "}\n",
           {storage_buffer(0, rare.memory)});
  run.out("result", rare.memory);
}
CTS_CASE("capabilities", "atomic_double.add") { rare_atomic(run, doubles(run), "atomicAdd", "sum"); }
CTS_CASE("capabilities", "atomic_double.min") { rare_atomic(run, doubles(run), "atomicMin", "min"); }
CTS_CASE("capabilities", "atomic_double.max") { rare_atomic(run, doubles(run), "atomicMax", "max"); }
CTS_CASE("capabilities", "atomic_half.add") { rare_atomic(run, halves(run), "atomicAdd", "sum"); }
CTS_CASE("capabilities", "atomic_half.min") { rare_atomic(run, halves(run), "atomicMin", "min"); }
CTS_CASE("capabilities", "atomic_half.max") { rare_atomic(run, halves(run), "atomicMax", "max"); }

/// Every invocation has a number of its own: the old values come back. In shared memory as in the buffer.
void rare_exchange(Run& run, const Rare& rare) {
  const std::string type = rare.type;
  const Buffer memory = run.buffer(rare.memory.size / 12 * 66);
  for (VkDeviceSize i = 0; i < memory.size; ++i) memory.data[i] = rare.memory.data[i % rare.memory.size];
  const std::string exchanged =
      rare.has ? "  " + type + " old = atomicExchange(r[i], " + type +
                     "(i)), lone = atomicExchange(s[i], old);\n"
                     "  atomicStore(r[i], old + atomicLoad(r[i], gl_ScopeDevice, 0, 0) + atomicLoad(s[i], "
                     "gl_ScopeDevice, 0, 0) + lone, gl_ScopeDevice, 0, 0);\n"
               : "  " + type + " old = r[i];\n  r[i] = old + " + type + "(i) + old + " + type + "(i & 7u);\n";
  dispatch(run,
           std::string(kAtomicFloat) + kHalfExtensions +
               "layout(local_size_x = 64) in;\nlayout(std430, binding = 0) buffer R { " + type +
               " r[]; };\n"
               "shared " +
               type +
               " s[64];\n"
               "void main() {\n"
               "  uint i = gl_LocalInvocationIndex;\n  s[i] = " +
               type + "(i & 7u);\n" + exchanged + "}\n",
           {storage_buffer(0, memory)});
  run.out("result", memory);
}
CTS_CASE("capabilities", "atomic_double.exchange") { rare_exchange(run, doubles(run)); }
CTS_CASE("capabilities", "atomic_half.exchange") { rare_exchange(run, halves(run)); }

void atomic_float_image(Run& run, const std::string& operation) {
  run.require(run.gpu.extension_features.shaderImageFloat32AtomicAdd &&
                  run.gpu.extension_features.shaderImageFloat32AtomicMinMax,
              "float atomics on images");
  const Image image = storage(run, VK_FORMAT_R32_SFLOAT);
  std::vector<float> texels(64);
  for (float& texel : texels) texel = static_cast<float>(run.random.between(-20, 20));
  run.upload(image, 0, {reinterpret_cast<const unsigned char*>(texels.data()), texels.size() * 4});
  dispatch(run,
           std::string(kAtomicFloat) +
               "layout(local_size_x = 64) in;\nlayout(binding = 0, r32f) uniform image2D a;\n"
               "void main() {\n"
               "  uint i = gl_LocalInvocationIndex;\n"
               "  " +
               operation +
               "(a, ivec2(i & 3u, i >> 4), float(int(i * 7u % 61u) - 20));\n"
               "}\n",
           {storage_image(0, image)});
  run.out("image", image);
}
CTS_CASE("capabilities", "atomic_float.image_add") { atomic_float_image(run, "imageAtomicAdd"); }
CTS_CASE("capabilities", "atomic_float.image_min") { atomic_float_image(run, "imageAtomicMin"); }
CTS_CASE("capabilities", "atomic_float.image_max") { atomic_float_image(run, "imageAtomicMax"); }

CTS_CASE("capabilities", "memory_model") {
  run.require(run.gpu.extension_features.vulkanMemoryModel && run.gpu.extension_features.vulkanMemoryModelDeviceScope,
              "vulkanMemoryModel");
  const Buffer out = run.buffer(64 * 4);
  dispatch(run, R"(// target: vulkan1.1
#pragma use_vulkan_memory_model
#extension GL_KHR_memory_scope_semantics : require
layout(local_size_x = 64) in;
layout(std430, binding = 0) workgroupcoherent buffer R { uint r[]; };
shared uint s[64];
void main() {
  uint i = gl_LocalInvocationIndex;
  s[i] = i * 3u;
  controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared,
                 gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable | gl_SemanticsMakeVisible);
  atomicAdd(r[i & 7u], s[63u - i], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquireRelease);
  memoryBarrier(gl_ScopeWorkgroup, gl_StorageSemanticsBuffer, gl_SemanticsAcquireRelease);
  controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsBuffer, gl_SemanticsAcquireRelease);
  if (i >= 8u) r[i] = atomicLoad(r[i & 7u], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquire) + i;
})",
           {storage_buffer(0, out)});
  run.out("result", out);
}

/// SPIR-V 1.4: OpCopyLogical between layouts, OpSelect on composites, all variables in the interface, loop controls.
CTS_CASE("capabilities", "spirv_1_4") {
  run.require(run.gpu.has("VK_KHR_spirv_1_4"), "VK_KHR_spirv_1_4");
  std::vector<float> values(64 * 8);
  for (float& value : values) value = run.random.real(-4, 4);
  const Buffer in = run.buffer_of(values), out = run.buffer(64 * 64);
  dispatch(run, R"(// target: spirv1.4
#extension GL_EXT_control_flow_attributes : require
layout(local_size_x = 64) in;
struct Thing { vec3 v; float w; vec2 list[2]; };
layout(std430, binding = 0) buffer A { Thing a[]; };
layout(std140, binding = 1) buffer R { Thing r[]; };
shared uint counter;
void main() {
  uint i = gl_LocalInvocationIndex;
  if (i == 0u) counter = 0u;
  barrier();
  Thing t = a[i], u = a[63u - i];
  Thing chosen = t.w > 0.0 ? t : u;
  [[dont_unroll, dependency_length(4)]] for (int k = 0; k < 5; k++) {
    chosen.list[k & 1] += chosen.v.xy * float(k);
    if (chosen.list[0].x > 20.0) break;
  }
  [[unroll, max_iterations(3)]] for (int k = 0; k < 3; k++) chosen.v[k] += float(k);
  atomicAdd(counter, 1u);
  barrier();
  chosen.w += float(counter);
  r[i] = chosen;
})",
           {storage_buffer(0, in), storage_buffer(1, out)});
  run.out("out", out, VK_FORMAT_R32_SFLOAT);
}

CTS_CASE("capabilities", "clock") {
  run.require(run.gpu.extension_features.shaderSubgroupClock && run.gpu.extension_features.shaderDeviceClock,
              "shaderSubgroupClock, shaderDeviceClock");
  const Buffer out = run.buffer(64 * 4);
  dispatch(run, R"(// target: vulkan1.1
#extension GL_ARB_shader_clock : require
#extension GL_EXT_shader_realtime_clock : require
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer R { uint r[]; };
bool before(uvec2 a, uvec2 b) { return a.y < b.y || (a.y == b.y && a.x <= b.x); }
void main() {
  uvec2 a = clock2x32ARB(), c = clockRealtime2x32EXT();
  uint x = gl_LocalInvocationIndex;
  for (uint i = 0u; i < 50u + (x & 3u); i++) x = x * 1664525u + 1013904223u;
  uvec2 b = clock2x32ARB(), d = clockRealtime2x32EXT();
  r[gl_LocalInvocationIndex] = x + (before(a, b) ? 1u : 0u) + (before(c, d) ? 2u : 0u);
})",
           {storage_buffer(0, out)});
  run.out("result", out);
}

/// A full-screen draw of one fragment shader.
void draw(Run& run, const std::string& fragment) {
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_SFLOAT}});
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = fragment;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  out_target(run, target);
}

CTS_CASE("capabilities", "demote") {
  run.require(run.gpu.extension_features.shaderDemoteToHelperInvocation, "shaderDemoteToHelperInvocation");
  draw(run, R"(// target: vulkan1.1
#extension GL_EXT_demote_to_helper_invocation : require
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
void main() {
  vec2 p = uv * 17.0;
  if (fract(p.x) < 0.4) demote;
  float v = sin(p.x * 3.0) * p.y;
  bool helper = helperInvocationEXT();
  if (!helper && fract(p.y) < 0.3) demote;
  o = vec4(v, dFdx(v), dFdy(v), helper ? 1.0 : 0.5);
})");
}

CTS_CASE("capabilities", "terminate") {
  run.require(run.gpu.extension_features.shaderTerminateInvocation, "shaderTerminateInvocation");
  draw(run, R"(// target: vulkan1.1
#extension GL_EXT_terminate_invocation : require
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
float pick(float a) {
  if (fract(a) < 0.25) terminateInvocation;
  return a * 0.5;
}
void main() {
  float s = 0.0;
  for (int i = 0; i < 6; i++) {
    s += pick(uv.x * 3.0 + uv.y * float(i));
    if (s > 6.0) terminateInvocation;
  }
  o = vec4(s, uv, 1.0);
})");
}

CTS_CASE("capabilities", "draw_parameters") {
  run.require(run.gpu.extension_features.shaderDrawParameters, "shaderDrawParameters");
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_SFLOAT}});
  GraphicsSpec spec;
  spec.vertex = R"(// target: vulkan1.1
#extension GL_ARB_shader_draw_parameters : require
layout(location = 0) flat out vec4 v;
void main() {
  int corner = gl_VertexIndex - gl_BaseVertexARB;
  vec2 at = vec2(float((gl_BaseVertexARB + gl_InstanceIndex * 5 + gl_DrawIDARB * 3) % 16), float(gl_InstanceIndex));
  gl_Position = vec4((at + vec2(corner & 1, corner >> 1)) / 8.0 - 1.0, 0.0, 1.0);
  v = vec4(gl_BaseVertexARB, gl_BaseInstanceARB, gl_DrawIDARB, gl_InstanceIndex);
})";
  spec.fragment =
      "layout(location = 0) flat in vec4 v;\nlayout(location = 0) out vec4 o;\nvoid main() { o = v + 1.0; }\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer draws = run.buffer_of<VkDrawIndirectCommand>({{3, 2, 4, 1}, {3, 1, 7, 6}, {3, 3, 0, 9}});
  run.require(run.gpu.features.multiDrawIndirect && run.gpu.features.drawIndirectFirstInstance, "multiDrawIndirect");
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 2, 3, 4);
    vkCmdDrawIndirect(cmd, draws.handle, 0, 3, sizeof(VkDrawIndirectCommand));
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
