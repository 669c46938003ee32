// The device and the shaders of the API's fuzzer.
#include "tests/fuzz/api_world.h"

#include <cstdlib>
#include <string>

#include "tests/glsl/compile.h"

namespace vitrine::fuzz {
namespace {

using icd::make_struct;

constexpr char kHead[] = R"(#version 460
#extension GL_EXT_samplerless_texture_functions : require
layout(set = 0, binding = 0) buffer Data { uint data[]; };
layout(set = 0, binding = 1) uniform Table { vec4 table[16]; };
layout(set = 0, binding = 2) uniform sampler2D picture;
layout(set = 0, binding = 3, rgba8) uniform image2D canvas;
layout(set = 0, binding = 4) uniform textureBuffer list;
layout(set = 0, binding = 5, r32ui) uniform uimageBuffer counters;
layout(push_constant) uniform Push { vec4 scale; int index; uint mask; float bias; float lod; };
vec4 use(vec4 v, int i) {
  v += table[i & 31] + texelFetch(list, i + index);
  v += textureLod(picture, v.xy, v.z + lod) + texelFetch(picture, ivec2(i, index), index & 15);
  v += textureGrad(picture, v.yx, vec2(bias, v.w), v.zw) + textureGather(picture, v.zw, 2);
  data[i] += floatBitsToUint(v.x) & mask;
  atomicAdd(data[i * index], 3u);
  imageStore(canvas, ivec2(i, index), v);
  v += imageLoad(canvas, ivec2(v.xy));
  imageAtomicMax(counters, i ^ index, mask);
  float local[7];
  for (int k = 0; k < 7; ++k) local[k] = v[k & 3];
  v.y += local[i] + uintBitsToFloat(data[i + 1]);
  if (mask == 5u) for (int k = 0; k < i; ++k) v.x += float(data[k]);
  return v;
}
)";

struct Source {
  VkShaderStageFlagBits stage;
  const char* body;
};
constexpr Source kSources[] = {
    {VK_SHADER_STAGE_VERTEX_BIT, R"(
layout(location = 0) in vec4 a; layout(location = 1) in vec4 b;
layout(location = 0) out vec4 v; layout(location = 1) flat out int n;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2]; };
void main() {
  gl_Position = a * scale; gl_PointSize = b.x; gl_ClipDistance[0] = b.y; gl_ClipDistance[1] = a.z;
  v = b; n = floatBitsToInt(b.w) + gl_VertexIndex + gl_InstanceIndex;
})"},
    {VK_SHADER_STAGE_VERTEX_BIT, R"(
layout(location = 0) in vec4 a; layout(location = 1) in vec4 b;
layout(location = 0) out vec4 v; layout(location = 1) flat out int n;
void main() { v = use(a, floatBitsToInt(b.x)); n = gl_VertexIndex; gl_Position = v * scale + b; gl_PointSize = 4.0; })"},
    {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(
layout(vertices = 3) out;
layout(location = 0) in vec4 v[]; layout(location = 1) flat in int n[];
layout(location = 0) out vec4 w[]; layout(location = 1) flat out int m[];
void main() {
  const int i = gl_InvocationID;
  gl_out[gl_InvocationID].gl_Position = gl_in[i].gl_Position;
  w[gl_InvocationID] = v[i]; m[gl_InvocationID] = n[n[i] & 3];
  gl_TessLevelOuter[i] = clamp(v[i].x, -1.0, 9.0); gl_TessLevelInner[0] = v[i].y > 9.0 ? 9.0 : v[i].y;
  gl_TessLevelOuter[3] = 2.0; gl_TessLevelInner[1] = clamp(v[i].z, 0.0, 7.0);
})"},
    {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, R"(
layout(triangles, fractional_odd_spacing) in;
layout(location = 0) in vec4 w[]; layout(location = 1) flat in int m[];
layout(location = 0) out vec4 v; layout(location = 1) flat out int n;
void main() {
  gl_Position = gl_in[0].gl_Position * gl_TessCoord.x + gl_in[1].gl_Position * gl_TessCoord.y + gl_in[2].gl_Position * gl_TessCoord.z;
  v = w[m[0] & 1]; n = m[1];
})"},
    {VK_SHADER_STAGE_GEOMETRY_BIT, R"(
layout(triangles) in; layout(triangle_strip, max_vertices = 6) out;
layout(location = 0) in vec4 v[]; layout(location = 1) flat in int n[];
layout(location = 0) out vec4 w; layout(location = 1) flat out int m;
void main() {
  for (int i = 0; i < (n[0] & 7); ++i) {
    gl_Position = gl_in[i % 3].gl_Position + v[i % 3] * 0.01; w = v[i % 3]; m = n[i % 3];
    gl_Layer = n[1] & 3; gl_ViewportIndex = n[2] & 1;
    EmitVertex();
  }
})"},
    {VK_SHADER_STAGE_FRAGMENT_BIT, R"(
layout(location = 0) in vec4 v; layout(location = 1) flat in int n;
layout(location = 0) out vec4 colour;
void main() { colour = use(v, n) + dFdx(v) + texture(picture, v.xy, bias); if (colour.x > 3.0) discard; })"},
    {VK_SHADER_STAGE_FRAGMENT_BIT, R"(
layout(location = 0) in vec4 v; layout(location = 1) flat in int n;
layout(location = 0) out vec4 colour;
void main() { colour = v * float(n); gl_FragDepth = v.z; gl_SampleMask[0] = n; })"},
    {VK_SHADER_STAGE_FRAGMENT_BIT, R"(
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 colour;
void main() { colour = v; })"},
    {VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 8, local_size_y = 3) in;
shared uint pool[24];
void main() {
  pool[gl_LocalInvocationIndex] = data[gl_GlobalInvocationID.x];
  barrier();
  const vec4 v = use(vec4(gl_GlobalInvocationID, bias), int(pool[(gl_LocalInvocationIndex * mask) % 29u]));
  data[gl_GlobalInvocationID.y * mask] = floatBitsToUint(v.x) + pool[uint(index)];
})"},
};

std::vector<VkShaderModule>& modules_of(World& w, VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return w.vertex;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return w.control;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return w.evaluation;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return w.geometry;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return w.fragment;
    default:
      return w.compute;
  }
}

void make_modules(World& w) {
  for (const Source& source : kSources) {
    std::string log;
    static std::vector<std::vector<std::uint32_t>> compiled(std::size(kSources));
    std::vector<std::uint32_t>& words = compiled[static_cast<std::size_t>(&source - kSources)];
    if (words.empty())
      words = test::compile_glsl(source.stage, std::string(kHead) + source.body, test::VulkanVersion::k12, log);
    demand(!words.empty(), log);
    auto info = make_struct<VkShaderModuleCreateInfo>();
    info.codeSize = words.size() * 4;
    info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    demand(VK_GET(w.instance, CreateShaderModule)(w.device, &info, nullptr, &module) == VK_SUCCESS, "a module");
    modules_of(w, source.stage).push_back(module);
  }
}

void make_layout(World& w) {
  std::array<VkDescriptorSetLayoutBinding, kBindings.size()> bindings{};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) bindings[i] = {i, kBindings[i], 1, VK_SHADER_STAGE_ALL, nullptr};
  auto set_info = make_struct<VkDescriptorSetLayoutCreateInfo>();
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  demand(VK_GET(w.instance, CreateDescriptorSetLayout)(w.device, &set_info, nullptr, &w.set_layout) == VK_SUCCESS,
         "a set layout");
  const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, kPushBytes};
  auto info = make_struct<VkPipelineLayoutCreateInfo>();
  info.setLayoutCount = 1;
  info.pSetLayouts = &w.set_layout;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  demand(VK_GET(w.instance, CreatePipelineLayout)(w.device, &info, nullptr, &w.layout) == VK_SUCCESS, "a layout");
}

void open_device(World& w) {
  auto robustness = make_struct<VkPhysicalDeviceRobustness2FeaturesEXT>();
  auto of13 = make_struct<VkPhysicalDeviceVulkan13Features>(&robustness);
  auto of12 = make_struct<VkPhysicalDeviceVulkan12Features>(&of13);
  auto of11 = make_struct<VkPhysicalDeviceVulkan11Features>(&of12);
  auto features = make_struct<VkPhysicalDeviceFeatures2>(&of11);
  VK_GET(w.instance, GetPhysicalDeviceFeatures2)(w.physical_device, &features);
  const char* const extensions[] = {VK_EXT_ROBUSTNESS_2_EXTENSION_NAME, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME};
  make_device(w, extensions, &features);
  make_layout(w);
  make_modules(w);
  const auto cache = make_struct<VkPipelineCacheCreateInfo>();
  demand(VK_GET(w.instance, CreatePipelineCache)(w.device, &cache, nullptr, &w.pipelines) == VK_SUCCESS, "a cache");
}

World make_world() {
  setenv("VITRINE_SHADER_BUDGET", "2000000", 0);
  World w;
  make_instance(w, {});
  open_device(w);
  return w;
}

}  // namespace

World& world() {
  static World& w = *new World(make_world());
  return w;
}

void replace_device() {
  World& w = world();
  for (std::vector<VkShaderModule>* list :
       {&w.vertex, &w.control, &w.evaluation, &w.geometry, &w.fragment, &w.compute}) {
    for (const VkShaderModule module : *list) VK_GET(w.instance, DestroyShaderModule)(w.device, module, nullptr);
    list->clear();
  }
  VK_GET(w.instance, DestroyPipelineCache)(w.device, w.pipelines, nullptr);
  VK_GET(w.instance, DestroyPipelineLayout)(w.device, w.layout, nullptr);
  VK_GET(w.instance, DestroyDescriptorSetLayout)(w.device, w.set_layout, nullptr);
  VK_GET(w.instance, DestroyDevice)(w.device, nullptr);
  open_device(w);
}

}  // namespace vitrine::fuzz
