// Listed deviations of sampling.
#include <limits>

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

/// Anisotropic lookups of 64 groups of eight invocations, or of 512 groups of equal ones. Component w: what `lookup`
/// makes of it.
void put_anisotropic_out(Run& run, const char* name, const Image& image, const VkSampler sampler,
                         const std::vector<float>& coordinates, const std::string& lookup, bool alone = false) {
  const Buffer table = run.buffer_of(coordinates), out = run.buffer(512 * 16);
  const Resources res = run.resources({sampled(0, image, sampler), storage_buffer(1, table), storage_buffer(2, out)});
  const VkPipeline pipeline = run.compute(
      res.layout,
      run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                 std::string("layout(local_size_x = 8) in;\nlayout(binding = 0) uniform sampler2D t;\n"
                             "layout(std430, binding = 1) buffer A { vec4 a[]; };\nlayout(std430, binding = 2) "
                             "buffer R { vec4 r[]; };\nvoid main() {\n  uint id = gl_WorkGroupID.x") +
                     (alone ? ";\n" : " * 8u + gl_LocalInvocationIndex;\n") + "  vec4 v = " + lookup + ";\n  " +
                     (alone ? "if (gl_LocalInvocationIndex == 0u) " : "") + "r[id] = v;\n}\n"));
  run.dispatch(res, pipeline, alone ? 512 : 64);
  run.out(name, out, VK_FORMAT_R32G32B32A32_SFLOAT);
}

struct AnisotropicScene {
  Image image;
  VkSampler sampler;
  std::vector<float> coordinates;
};

/// 8x8 texels, infinities among them or not; the same coordinates for four neighbours, or others for each.
AnisotropicScene anisotropic_scene(Run& run, bool infinity, bool by_four, bool levels) {
  run.require(run.gpu.features.samplerAnisotropy, "samplerAnisotropy");
  AnisotropicScene scene;
  ImageSpec spec;
  spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  spec.extent = {8, 8, 1};
  spec.levels = levels ? 4 : 1;
  scene.image = run.image(spec);
  run.fill_random(scene.image);
  if (infinity) {
    std::vector<float> texels(256);
    for (float& texel : texels) texel = run.random.unit();
    for (const size_t at : {9, 14, 27, 36, 50, 55}) texels[4 * at] = std::numeric_limits<float>::infinity();
    run.upload(scene.image, 0, {reinterpret_cast<const unsigned char*>(texels.data()), texels.size() * 4});
  }
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.maxLod = VK_LOD_CLAMP_NONE;
  info.anisotropyEnable = VK_TRUE;
  info.maxAnisotropy = 8;
  scene.sampler = run.sampler(info);
  float c[4] = {};
  for (int i = 0; i < 512; ++i) {
    if (!by_four || i % 4 == 0) {
      c[0] = run.random.unit();
      c[1] = run.random.unit();
      c[3] = levels ? static_cast<float>(run.random.below(4)) : 0.0f;
    }
    scene.coordinates.insert(scene.coordinates.end(), c, c + 4);
  }
  return scene;
}

void anisotropic_neighbours(Run& run, bool infinity, bool by_four, bool levels) {
  const AnisotropicScene scene = anisotropic_scene(run, infinity, by_four, levels);
  for (const bool alone : {false, true}) {
    put_anisotropic_out(run, alone ? "alone" : "together", scene.image, scene.sampler, scene.coordinates,
                        "textureLod(t, a[id].xy, a[id].w)", alone);
  }
}

const AddCase kAnisotropicLevels("texture", "deviation.anisotropic_levels", "anisotropic-neighbours",
                                 case_against_control,
                                 [](Run& run) { anisotropic_neighbours(run, false, true, true); });
const AddCase kAnisotropicInfinity("texture", "deviation.anisotropic_infinity", "anisotropic-neighbours",
                                   case_against_control,
                                   [](Run& run) { anisotropic_neighbours(run, true, true, false); });
const AddCase kAnisotropicStages("texture", "deviation.anisotropic_stages", "anisotropic-neighbours",
                                 case_against_control,
                                 [](Run& run) { anisotropic_neighbours(run, false, false, false); });
const AddCase kAnisotropicGather("texture", "deviation.anisotropic_gather", "anisotropic-gather", case_against_control,
                                 [](Run& run) {
                                   const AnisotropicScene scene = anisotropic_scene(run, false, true, false);
                                   for (const bool anisotropic : {true, false}) {
                                     put_anisotropic_out(run, anisotropic ? "anisotropic" : "isotropic", scene.image,
                                                         anisotropic ? scene.sampler : run.sampler(VK_FILTER_LINEAR),
                                                         scene.coordinates, "textureGather(t, a[id].xy, 1)");
                                   }
                                 });

/// A full-screen picture of an image through `sampler`; `body` sets color.
void put_picture_out(Run& run, const char* name, const Image& image, VkSampler sampler, const std::string& body) {
  const Resources res = run.resources({sampled(0, image, sampler)});
  GraphicsSpec pipeline;
  pipeline.layout = res.layout;
  pipeline.vertex = kFullScreenVertex;
  pipeline.fragment =
      "layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 color;\nlayout(binding = 0) uniform " + body;
  TargetSpec spec;
  spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, spec);
  const VkPipeline handle = make_pipeline(run, pipeline, target);
  draw_once(run, target, handle, &res);
  run.out(name, target.colors[0]);
}

/// The first pixel of every quad; in the control its neighbours are as far away as the gradients say.
const AddCase kAnisotropicGradients(
    "texture", "deviation.anisotropic_gradients", "anisotropic-gradients", case_against_control, [](Run& run) {
      const AnisotropicScene scene = anisotropic_scene(run, false, true, true);
      const std::string head =
          "sampler2D t;\nvoid main() {\n  ivec2 p = ivec2(gl_FragCoord.xy);\n  vec2 c = vec2(p >> 1) / 32.0;\n"
          "  vec2 gx = vec2(0.5, 0.125), gy = vec2(-0.0625, 0.25);\n  ";
      const std::string tail = ";\n  color = (p.x | p.y) % 2 == 0 ? v : vec4(0.0);\n}\n";
      put_picture_out(run, "given", scene.image, scene.sampler, head + "vec4 v = textureGrad(t, c, gx, gy)" + tail);
      put_picture_out(run, "implicit", scene.image, scene.sampler,
                      head + "c += float(p.x & 1) * gx + float(p.y & 1) * gy;\n  vec4 v = texture(t, c)" + tail);
    });

/// A footprint of 17 million texels in the first pixel, which is the point itself in the control.
const AddCase kAnisotropicFootprint(
    "texture", "deviation.anisotropic_footprint", "anisotropic-footprint", case_against_control, [](Run& run) {
      const AnisotropicScene scene = anisotropic_scene(run, false, true, false);
      const std::string body =
          "sampler2D t;\nvoid main() {\n  ivec2 p = ivec2(gl_FragCoord.xy);\n  vec2 c = vec2(0.3, 0.7);\n"
          "  if ((p.x | p.y) < 2) c += vec2(p) * 262.5;\n  vec4 v = texture(t, c);\n"
          "  color = (p.x | p.y) == 0 ? v : vec4(0.0);\n}\n";
      put_picture_out(run, "anisotropic", scene.image, scene.sampler, body);
      put_picture_out(run, "linear", scene.image, run.sampler(VK_FILTER_LINEAR), body);
    });

/// Comparisons with the same depth everywhere, of which every filter makes 0 or 1.
const AddCase kAnisotropicComparison(
    "texture", "deviation.anisotropic_comparison", "anisotropic-comparison", case_against_control, [](Run& run) {
      run.require(run.gpu.features.samplerAnisotropy, "samplerAnisotropy");
      ImageSpec spec;
      spec.format = VK_FORMAT_D32_SFLOAT;
      spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
      spec.extent = {8, 8, 1};
      const Image image = run.image(spec);
      const std::vector<float> depths(64, 0.625f);
      run.upload(image, 0, {reinterpret_cast<const unsigned char*>(depths.data()), depths.size() * 4},
                 VK_IMAGE_ASPECT_DEPTH_BIT);
      for (const float anisotropy : {8.0f, 1.0f}) {
        VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
        info.maxLod = VK_LOD_CLAMP_NONE;
        info.anisotropyEnable = anisotropy > 1;
        info.maxAnisotropy = anisotropy;
        info.compareEnable = VK_TRUE;
        info.compareOp = VK_COMPARE_OP_LESS;
        put_picture_out(run, anisotropy > 1 ? "anisotropic" : "isotropic", image, run.sampler(info),
                        "sampler2DShadow t;\nvoid main() { color = vec4(texture(t, vec3(uv.yx * 2.0, uv.x))); }\n");
      }
    });

/// Levels that a cube would be read at, as one of a cube array's in the control.
const AddCase kCubeQuery("texture", "deviation.cube_query", "cube-query", case_against_control, [](Run& run) {
  for (const bool array : {false, true}) {
    ImageSpec spec;
    spec.format = VK_FORMAT_R16G16_SFLOAT;  // texels of four bytes do not show it
    spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    spec.extent = {16, 16, 1};
    spec.layers = 6;
    spec.levels = 5;
    spec.view = array ? VK_IMAGE_VIEW_TYPE_CUBE_ARRAY : VK_IMAGE_VIEW_TYPE_CUBE;
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.maxLod = VK_LOD_CLAMP_NONE;
    const VkSampler sampler = run.sampler(info);
    put_picture_out(run, array ? "array" : "cube", run.image(spec), sampler,
                    std::string(array ? "samplerCubeArray" : "samplerCube") +
                        " t;\nvoid main() {\n  precise vec3 c = (vec3(0.5, -0.25, 0.375) + gl_FragCoord.x * "
                        "vec3(0.03, -0.01, 0.02)) + gl_FragCoord.y * vec3(-0.02, 0.015, -0.05);\n"
                        "  color = vec4(textureQueryLod(t, c), float(textureQueryLevels(t)), 1.0);\n}\n");
  }
});

}  // namespace
}  // namespace vitrine::cts
