// Derivatives in compute shaders: of quads of two columns and two rows, and of four invocations one behind the other;
// lookups that find their level by them. The reference does not have them: there neighbours meet in shared memory.
#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

struct Shape {
  uint32_t x, y, z;
  bool quads;
};

std::string head(const Shape& shape, bool has) {
  std::string code;
  if (has) code += "#extension GL_NV_compute_shader_derivatives : require\n";
  code += "layout(local_size_x = " + std::to_string(shape.x) + ", local_size_y = " + std::to_string(shape.y) +
          ", local_size_z = " + std::to_string(shape.z) + ") in;\n";
  if (has) code += std::string("layout(derivative_group_") + (shape.quads ? "quads" : "linear") + "NV) in;\n";
  const std::string count = std::to_string(shape.x * shape.y * shape.z);
  return code +
         "layout(std430, binding = 0) buffer R { vec4 r[]; };\nlayout(binding = 1) uniform sampler2D t;\n"
         "shared vec2 values[" +
         count + "];\nconst uint kCount = " + count + "u;\n";
}

/// vec2 ddx and ddy of values[] at the invocation's quad.
std::string differences(const Shape& shape) {
  const std::string x = std::to_string(shape.x) + "u";
  const std::string first =
      shape.quads ? "(l.z * " + std::to_string(shape.y) + "u + (l.y & ~1u)) * " + x + " + (l.x & ~1u)" : "i & ~3u";
  return "  uint first = " + first + ";\n  uint below = first + " + (shape.quads ? x : std::string("2u")) +
         ";\n  uint right = " +
         (shape.quads ? std::string("l.x & 1u, down = l.y & 1u") : std::string("i & 1u, down = i >> 1 & 1u")) +
         ";\n  uint row = down == 1u ? below : first;\n  vec2 ddx = values[row + 1u] - values[row];\n"
         "  vec2 ddy = values[below + right] - values[first + right];\n"
         "  vec2 coarse_x = values[first + 1u] - values[first], coarse_y = values[below] - values[first];\n";
}

void derive(Run& run, const Shape& shape) {
  run.require(gpus().device.has("VK_NV_compute_shader_derivatives"), "VK_NV_compute_shader_derivatives");
  const bool has = run.gpu.has("VK_NV_compute_shader_derivatives");
  ImageSpec image_spec;
  image_spec.levels = 6;
  image_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(image_spec);
  run.fill_random(image);
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  sampler.maxLod = VK_LOD_CLAMP_NONE;
  constexpr uint32_t kGroups = 3;
  const uint32_t count = shape.x * shape.y * shape.z * kGroups;
  const Buffer result = run.buffer(VkDeviceSize{count} * 48);
  const Resources resources = run.resources({storage_buffer(0, result), sampled(1, image, run.sampler(sampler))});
  const std::string code = head(shape, has) + R"(
void main() {
  uvec3 l = gl_LocalInvocationID;
  uint i = gl_LocalInvocationIndex;
  vec2 v = vec2(l.xy) * vec2(0.031, 0.017) + vec2(float(l.z), float(gl_WorkGroupID.x)) * 0.37;
  v = v * v + v.yx * 0.25;
  values[i] = v;
  memoryBarrierShared();
  barrier();
)" + differences(shape) +
                           (has ? R"(
  vec4 fine = vec4(dFdxFine(v), dFdyFine(v)), coarse = vec4(dFdxCoarse(v), dFdyCoarse(v));
  vec4 texel = texture(t, v);
)"
                                : R"(
  vec4 fine = vec4(ddx, ddy), coarse = fine;
  vec4 texel = textureGrad(t, v, coarse_x, coarse_y);
)") + R"(
  uint at = (gl_WorkGroupID.x * kCount + i) * 3u;
  r[at] = fine;
  r[at + 1u] = coarse;
  r[at + 2u] = texel;
})";
  run.dispatch(resources, run.compute(resources.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code)), kGroups);
  run.out("result", result, VK_FORMAT_R32G32B32A32_SFLOAT);
}

const bool kCases = [] {
  constexpr std::pair<const char*, Shape> kShapes[] = {
      {"quads", {8, 8, 1, true}},         {"quads_narrow", {2, 34, 1, true}}, {"quads_deep", {6, 4, 3, true}},
      {"quads_small", {2, 2, 1, true}},   {"quads_large", {16, 16, 2, true}}, {"linear", {64, 1, 1, false}},
      {"linear_rows", {6, 10, 2, false}}, {"linear_small", {4, 1, 1, false}},
  };
  for (const auto& [name, shape] : kShapes)
    AddCase("compute", std::string("derivatives.") + name, [shape = shape](Run& run) { derive(run, shape); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
