// Compute: built-ins, shared memory and barriers, atomics, indirect dispatch, image load and store, scans and sorts.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Dispatches one shader with buffers at bindings 0.. and puts the last one out.
void dispatch(Run& run, const std::string& code, const std::vector<Buffer>& buffers, uint32_t x, uint32_t y = 1,
              uint32_t z = 1) {
  std::vector<Binding> bindings;
  for (uint32_t i = 0; i < buffers.size(); ++i) bindings.push_back(storage_buffer(i, buffers[i]));
  const Resources res = run.resources(bindings);
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, x, y, z);
  run.out("result", buffers.back());
}

std::vector<uint32_t> random_words(Run& run, size_t count) {
  std::vector<uint32_t> words(count);
  for (uint32_t& word : words) word = run.random.bits();
  return words;
}

CTS_CASE("compute", "builtins") {
  dispatch(run, R"(
layout(local_size_x = 5, local_size_y = 3, local_size_z = 2) in;
layout(std430, binding = 0) buffer R { uvec4 r[]; };
void main() {
  uvec3 total = gl_NumWorkGroups * gl_WorkGroupSize;
  uint at = (gl_GlobalInvocationID.z * total.y + gl_GlobalInvocationID.y) * total.x + gl_GlobalInvocationID.x;
  r[at * 4u] = uvec4(gl_GlobalInvocationID, gl_LocalInvocationIndex);
  r[at * 4u + 1u] = uvec4(gl_WorkGroupID, 1u);
  r[at * 4u + 2u] = uvec4(gl_LocalInvocationID, 2u);
  r[at * 4u + 3u] = uvec4(gl_NumWorkGroups, gl_WorkGroupSize.x);
})",
           {run.buffer(5 * 3 * 2 * 24 * 64)}, 4, 3, 2);
}

CTS_CASE("compute", "device_index") {
  dispatch(run, R"(
#extension GL_EXT_device_group : require
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer R { uint r[]; };
void main() { r[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x + 7u * uint(gl_DeviceIndex); })",
           {run.buffer(4 * 64)}, 1);
}

void shared_reduction(Run& run, uint32_t local_size) {
  const Buffer in = run.buffer_of(random_words(run, local_size * 8));
  dispatch(run, "#define N " + std::to_string(local_size) + R"(
layout(local_size_x = N) in;
layout(std430, binding = 0) buffer A { uint a[]; };
layout(std430, binding = 1) buffer R { uint r[]; };
shared uint part[N];
void main() {
  uint l = gl_LocalInvocationIndex;
  part[l] = a[gl_GlobalInvocationID.x];
  barrier();
  for (uint step = 1u; step < N; step *= 2u) {
    uint other = l + step < N ? part[l + step] : 0u;
    barrier();
    part[l] += other;
    barrier();
  }
  r[gl_GlobalInvocationID.x] = part[l];
})",
           {in, run.buffer(in.size)}, 8);
}

CTS_CASE("compute", "shared_scan.64") { shared_reduction(run, 64); }
CTS_CASE("compute", "shared_scan.100") { shared_reduction(run, 100); }
CTS_CASE("compute", "shared_scan.256") { shared_reduction(run, 256); }
CTS_CASE("compute", "shared_scan.1") { shared_reduction(run, 7); }

CTS_CASE("compute", "shared_transpose") {
  const Buffer in = run.buffer_of(random_words(run, 64 * 64));
  dispatch(run, R"(
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) buffer A { uint a[]; };
layout(std430, binding = 1) buffer R { uint r[]; };
shared uint tile[16][17];
void main() {
  uvec2 l = gl_LocalInvocationID.xy, g = gl_WorkGroupID.xy * 16u;
  tile[l.y][l.x] = a[(g.y + l.y) * 64u + g.x + l.x];
  barrier();
  r[(g.x + l.y) * 64u + g.y + l.x] = tile[l.x][l.y];
})",
           {in, run.buffer(in.size)}, 4, 4);
}

void atomic(Run& run, const std::string& expression, const char* type) {
  dispatch(run,
           std::string("layout(local_size_x = 64) in;\n#define T ") + type +
               "\nlayout(std430, binding = 0) buffer R { T r[]; };\n"
               "shared T s[4];\n"
               "void main() {\n"
               "  if (gl_LocalInvocationIndex < 4u) s[gl_LocalInvocationIndex] = T(5);\n"
               "  barrier();\n"
               "  T v = T(gl_LocalInvocationIndex * 7u % 61u);\n"
               "  uint k = gl_LocalInvocationIndex & 3u;\n"
               "  " +
               expression +
               "\n"
               "  barrier();\n"
               "  if (gl_LocalInvocationIndex < 4u) r[8u + gl_LocalInvocationIndex] = s[gl_LocalInvocationIndex];\n"
               "}\n",
           {run.buffer_of<uint32_t>({3, 9, 0xfffffff0u, 100, 1, 2, 3, 4, 0, 0, 0, 0})}, 1);
}

const bool kAtomics = [] {
  for (const char* type : {"uint", "int"})
    for (const char* op : {"Add", "Min", "Max", "And", "Or", "Xor"})
      AddCase("compute", std::string("atomic.") + type + "." + op, [=](Run& run) {
        atomic(run, std::string("atomic") + op + "(r[k], v); atomic" + op + "(s[k], v);", type);
      });
  return true;
}();

const bool kAtomics64 = [] {
  for (const char* type : {"uint64_t", "int64_t"})
    for (const char* op : {"Add", "Min", "Max", "And", "Or", "Xor", "Exchange"})
      AddCase("compute", std::string("atomics_64.") + type + "." + op, [=](Run& run) {
        const auto& features = run.gpu.extension_features;
        run.require(
            run.gpu.features.shaderInt64 && features.shaderBufferInt64Atomics && features.shaderSharedInt64Atomics,
            "64-bit atomics");
        const bool exchange = std::string(op) == "Exchange";
        dispatch(run,
                 std::string("#version 450\n#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n"
                             "#extension GL_EXT_shader_atomic_int64 : require\n"
                             "layout(local_size_x = 64) in;\n#define T ") +
                     type +
                     "\nlayout(std430, binding = 0) buffer R { T r[]; };\n"
                     "shared T s[64];\n"
                     "void main() {\n"
                     "  uint id = gl_LocalInvocationIndex;\n"
                     "  s[id] = T(5) << 33;\n"
                     "  barrier();\n"
                     "  T v = (T(id * 7u % 61u) << 32) - T(id * 0x10001u);\n"
                     "  uint k = id" +
                     (exchange ? "" : " & 3u") +
                     ";\n"
                     "  T old = atomic" +
                     op +
                     "(r[k], v);\n"
                     "  atomic" +
                     op +
                     "(s[k], v);\n"
                     "  if (id == 13u) atomicCompSwap(r[70], T(0), T(-9));\n"
                     "  if (id == 17u) atomicCompSwap(r[71], T(1), T(77));\n"
                     "  barrier();\n"
                     "  r[128u + id] = s[id]" +
                     (exchange ? " + old" : "") +
                     ";\n"
                     "}\n",
                 {run.buffer_of(random_words(run, 2 * 192))}, 1);
      });
  return true;
}();

CTS_CASE("compute", "zero_initialized") {
  run.require(run.gpu.extension_features.shaderZeroInitializeWorkgroupMemory, "shaderZeroInitializeWorkgroupMemory");
  dispatch(run, R"(#version 450
#extension GL_EXT_null_initializer : require
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer R { uint r[]; };
struct S { vec3 v; uint u[5]; };
shared S s[32] = {};
void main() {
  uint id = gl_LocalInvocationIndex;
  if ((id & 3u) == 1u) s[id >> 1].u[id % 5u] = id + 1u;
  barrier();
  r[gl_GlobalInvocationID.x] = s[id >> 1].u[id % 5u] + floatBitsToUint(s[(id * 5u) & 31u].v.y);
})",
           {run.buffer(64 * 8 * 4)}, 8);
}

CTS_CASE("compute", "atomic.counter") {
  // Which invocation gets which number is open; that each number is given once is not.
  dispatch(run, R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer C { uint counter; };
layout(std430, binding = 1) buffer R { uint r[]; };
void main() { atomicAdd(r[atomicAdd(counter, 1u)], gl_WorkGroupSize.x); })",
           {run.buffer(4), run.buffer(64 * 16 * 4 + 64)}, 16);
}

CTS_CASE("compute", "atomic.compare_exchange") {
  dispatch(run, R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer R { uint r[]; };
void main() {
  for (;;) {
    uint old = r[0];
    if (atomicCompSwap(r[0], old, old + 3u) == old) break;
  }
  atomicExchange(r[1 + gl_LocalInvocationIndex], gl_LocalInvocationIndex * 3u);
})",
           {run.buffer(65 * 4)}, 1);
}

CTS_CASE("compute", "image_load_store") {
  ImageSpec spec;
  spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  spec.extent = {37, 29, 1};
  const Image from = run.image(spec), to = run.image(spec);
  run.fill_random(from);
  run.once([&](VkCommandBuffer cmd) {
    const VkClearColorValue zero{};
    const VkImageSubresourceRange range = to.range();
    vkCmdClearColorImage(cmd, to.handle, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &range);
  });
  const Resources res = run.resources({storage_image(0, from), storage_image(1, to)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D source;
layout(binding = 1, rgba32f) uniform writeonly image2D destination;
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  vec4 sum = imageLoad(source, p) + imageLoad(source, p + ivec2(3, -1)) * 0.5;
  imageStore(destination, ivec2(imageSize(destination).x - 1 - p.x, p.y), sum);
})"));
  run.dispatch(res, pipeline, 5, 4);
  run.out("to", to);
}

struct StorageFormat {
  VkFormat format;
  const char* glsl;
};
constexpr StorageFormat kStorageFormats[] = {{VK_FORMAT_R8G8B8A8_UNORM, "rgba8"},
                                             {VK_FORMAT_R8G8B8A8_SNORM, "rgba8_snorm"},
                                             {VK_FORMAT_R8G8B8A8_UINT, "rgba8ui"},
                                             {VK_FORMAT_R8G8B8A8_SINT, "rgba8i"},
                                             {VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f"},
                                             {VK_FORMAT_R16G16B16A16_UINT, "rgba16ui"},
                                             {VK_FORMAT_R16G16B16A16_SINT, "rgba16i"},
                                             {VK_FORMAT_R32_UINT, "r32ui"},
                                             {VK_FORMAT_R32_SINT, "r32i"},
                                             {VK_FORMAT_R32_SFLOAT, "r32f"},
                                             {VK_FORMAT_R32G32_UINT, "rg32ui"},
                                             {VK_FORMAT_R32G32_SFLOAT, "rg32f"},
                                             {VK_FORMAT_R32G32B32A32_UINT, "rgba32ui"},
                                             {VK_FORMAT_R32G32B32A32_SINT, "rgba32i"},
                                             {VK_FORMAT_R32G32B32A32_SFLOAT, "rgba32f"},
                                             {VK_FORMAT_R16_UNORM, "r16"},
                                             {VK_FORMAT_R16G16B16A16_UNORM, "rgba16"},
                                             {VK_FORMAT_R16G16B16A16_SNORM, "rgba16_snorm"},
                                             {VK_FORMAT_R8_UNORM, "r8"},
                                             {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "rgb10_a2"},
                                             {VK_FORMAT_B10G11R11_UFLOAT_PACK32, "r11f_g11f_b10f"}};

/// Stores random values (with NaN and infinities for float formats) and loads them again.
void store_format(Run& run, const StorageFormat& format) {
  const FormatInfo& info = format_info(format.format);
  const std::string prefix = info.numeric == Numeric::kUint ? "u" : info.numeric == Numeric::kSint ? "i" : "";
  ImageSpec spec;
  spec.format = format.format;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  const Image image = run.image(spec);
  std::vector<float> values(64 * 64 * 4);
  for (float& value : values)
    value = prefix.empty() ? run.random.operand(run.random.chance(0.3f)) * (run.random.chance(0.5f) ? 1.0f : 0.1f)
                           : Random::from_bits(run.random.bits() >> run.random.below(32));
  const Buffer in = run.buffer_of(values), loaded = run.buffer(in.size);
  const Resources res = run.resources({storage_image(0, image), storage_buffer(1, in), storage_buffer(2, loaded)});
  const std::string head =
      "layout(local_size_x = 8, local_size_y = 8) in;\nlayout(binding = 0, " + std::string(format.glsl) + ") uniform " +
      prefix + "image2D image;\nlayout(std430, binding = 1) buffer A { " + prefix +
      "vec4 a[]; };\nlayout(std430, binding = 2) buffer R { " + prefix +
      "vec4 r[]; };\nvoid main() {\n  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n  int at = p.y * 64 + p.x;\n";
  const VkPipeline store =
      run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, head + "  imageStore(image, p, a[at]);\n}\n"));
  const VkPipeline load =
      run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, head + "  r[at] = imageLoad(image, p);\n}\n"));
  run.once([&](VkCommandBuffer cmd) {
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    for (const VkPipeline pipeline : {store, load}) {
      vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
      vkCmdDispatch(cmd, 8, 8, 1);
      run.barrier(cmd);
    }
  });
  run.out("image", image);
  run.out("loaded", loaded, VK_FORMAT_R32G32B32A32_SFLOAT).nan_bits_free = true;
}

const bool kStores = [] {
  for (const StorageFormat& format : kStorageFormats)
    AddCase("compute", std::string("image_store.") + format.glsl, [&format](Run& run) { store_format(run, format); });
  return true;
}();

CTS_CASE("compute", "image_atomic") {
  ImageSpec spec;
  spec.format = VK_FORMAT_R32_UINT;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  spec.extent = {8, 8, 1};
  const Image image = run.image(spec);
  run.fill_random(image);
  const Resources res = run.resources({storage_image(0, image)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32ui) uniform uimage2D image;
void main() {
  ivec2 p = ivec2(gl_LocalInvocationID.xy);
  imageAtomicAdd(image, p, gl_WorkGroupID.x + 1u);
  imageAtomicMax(image, p.yx, 77u);
})"));
  run.dispatch(res, pipeline, 1);
  run.out("image", image);
}

CTS_CASE("compute", "indirect_dispatch") {
  const Buffer commands = run.buffer_of<uint32_t>({99, 3, 2, 1}), result = run.buffer(3 * 2 * 8 * 4);
  const Resources res = run.resources({storage_buffer(0, result)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 8) in;
layout(std430, binding = 0) buffer R { uint r[]; };
void main() { r[gl_WorkGroupID.y * 24u + gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x * 10u + gl_WorkGroupID.y; })"));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatchIndirect(cmd, commands.handle, 4);
  });
  run.out("result", result);
}

CTS_CASE("compute", "push_constants_and_specialization") {
  const Buffer result = run.buffer(64 * 16);
  const Resources res = run.resources({storage_buffer(0, result)}, 32);
  const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}, {2, 8, 4}, {3, 12, 4}};
  struct {
    uint32_t size = 16;
    float scale = 2.5f;
    int32_t shift = -3;
    VkBool32 flag = VK_TRUE;
  } values;
  const VkSpecializationInfo special{4, entries, sizeof values, &values};
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const float scale = 1.0;
layout(constant_id = 2) const int shift = 0;
layout(constant_id = 3) const bool flag = false;
layout(constant_id = 4) const uint untouched = 40u;
const int twice = shift * 2 + int(untouched);
layout(push_constant) uniform P { vec4 a; ivec2 b; float c[2]; };
layout(std430, binding = 0) buffer R { vec4 r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  r[id] = flag ? a * scale + vec4(b, twice, id) : vec4(0.0);
  r[id].x += c[id & 1u];
})"),
                                          &special);
  const float push[8] = {1.0f, 2.0f, 3.0f, 4.0f, Random::from_bits(5), Random::from_bits(6), 0.25f, 0.75f};
  run.dispatch(res, pipeline, 4, std::as_bytes(std::span(push)));
  run.out("result", result, VK_FORMAT_R32G32B32A32_SFLOAT);
}

CTS_CASE("compute", "bitonic_sort") {
  const Buffer values = run.buffer_of(random_words(run, 256));
  dispatch(run, R"(
layout(local_size_x = 128) in;
layout(std430, binding = 0) buffer R { uint r[]; };
shared uint s[256];
void main() {
  uint l = gl_LocalInvocationIndex;
  s[l] = r[l]; s[l + 128u] = r[l + 128u];
  barrier();
  for (uint k = 2u; k <= 256u; k <<= 1)
    for (uint j = k >> 1; j > 0u; j >>= 1) {
      uint i = 2u * l - (l & (j - 1u)), p = i + j;
      bool up = (i & k) == 0u;
      uint a = s[i], b = s[p];
      if ((a > b) == up) { s[i] = b; s[p] = a; }
      barrier();
    }
  r[l] = s[l]; r[l + 128u] = s[l + 128u];
})",
           {values}, 1);
}

CTS_CASE("compute", "n_body") {
  std::vector<float> bodies;
  for (int i = 0; i < 256 * 4; ++i) bodies.push_back(run.random.real(-5, 5));
  const Buffer in = run.buffer_of(bodies);
  dispatch(run, R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer A { vec4 body[]; };
layout(std430, binding = 1) buffer R { vec4 r[]; };
shared vec4 tile[64];
void main() {
  vec4 me = body[gl_GlobalInvocationID.x];
  vec3 force = vec3(0.0);
  for (uint t = 0u; t < 4u; ++t) {
    tile[gl_LocalInvocationIndex] = body[t * 64u + gl_LocalInvocationIndex];
    barrier();
    for (uint k = 0u; k < 64u; ++k) {
      vec3 d = tile[k].xyz - me.xyz;
      float inv = inversesqrt(dot(d, d) + 0.01);
      force += d * (abs(tile[k].w) * inv * inv * inv);
    }
    barrier();
  }
  r[gl_GlobalInvocationID.x] = vec4(force, 1.0);
})",
           {in, run.buffer(in.size)}, 4);
}

}  // namespace
}  // namespace vitrine::cts
