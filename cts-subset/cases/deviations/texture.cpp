// Listed deviations of sampling.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

/// Samples with explicit LOD where neighbouring invocations want different filters, or one is at a cube's corner; the
/// control makes all invocations of a group alike.
void neighbours(Run& run, bool cube) {
  ImageSpec spec;
  spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  spec.extent = {8, 8, 1};
  spec.levels = cube ? 1 : 4;
  if (cube) {
    spec.view = VK_IMAGE_VIEW_TYPE_CUBE;
    spec.layers = 6;
  }
  const Image image = run.image(spec);
  run.fill_random(image);
  VkSamplerCreateInfo sampler_info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler_info.magFilter = cube ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  sampler_info.minFilter = VK_FILTER_LINEAR;
  sampler_info.addressModeU = sampler_info.addressModeV = sampler_info.addressModeW =
      VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  sampler_info.maxLod = 3.0f;
  const VkSampler sampler = run.sampler(sampler_info);
  std::vector<float> coordinates;
  for (int i = 0; i < 512; ++i) {
    const bool corner = i % 8 == 3;
    if (cube) {
      for (const float v :
           {1.0f, corner ? 0.99f : run.random.real(-0.8f, 0.8f), corner ? -0.98f : run.random.real(-0.8f, 0.8f), 0.0f})
        coordinates.push_back(v);
    } else {
      for (const float v : {run.random.unit(), run.random.unit(), 0.0f, corner ? 1.5f : -1.0f})
        coordinates.push_back(v);
    }
  }
  const Buffer table = run.buffer_of(coordinates);
  for (const bool alone : {false, true}) {
    const Buffer out = run.buffer(512 * 16);
    const Resources res = run.resources({sampled(0, image, sampler), storage_buffer(1, table), storage_buffer(2, out)});
    const VkPipeline pipeline = run.compute(
        res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                               std::string("layout(local_size_x = 8) in;\n") + "layout(binding = 0) uniform sampler" +
                                   (cube ? "Cube" : "2D") +
                                   " t;\n"
                                   "layout(std430, binding = 1) buffer A { vec4 a[]; };\nlayout(std430, binding = 2) "
                                   "buffer R { vec4 r[]; };\n"
                                   "void main() {\n  uint id = gl_WorkGroupID.x" +
                                   (alone ? ";\n" : " * 8u + gl_LocalInvocationIndex;\n") +
                                   "  vec4 v = textureLod(t, a[id]." + (cube ? "xyz" : "xy") + ", a[id].w);\n  " +
                                   (alone ? "if (gl_LocalInvocationIndex == 0u) " : "") + "r[id] = v;\n}\n"));
    run.dispatch(res, pipeline, alone ? 512 : 64);
    run.out(alone ? "alone" : "together", out, VK_FORMAT_R32G32B32A32_SFLOAT);
  }
}

const AddCase kFilters("texture", "deviation.mixed_filters", "mixed-filters", case_against_control,
                       [](Run& run) { neighbours(run, false); });
const AddCase kCorners("texture", "deviation.cube_corners", "cube-corners", case_against_control,
                       [](Run& run) { neighbours(run, true); });

}  // namespace
}  // namespace vitrine::cts
