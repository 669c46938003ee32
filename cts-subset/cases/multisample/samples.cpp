// Fetches samples with a compute shader, and puts words out.
#include "cases/multisample/samples.h"

#include <cstring>

namespace vitrine::cts {

std::vector<uint32_t> fetch(Run& run, const Image& image, VkImageAspectFlagBits aspect) {
  const bool whole = aspect == VK_IMAGE_ASPECT_STENCIL_BIT || format_info(image.spec.format).numeric == Numeric::kUint;
  const std::string prefix = whole ? "u" : "", kind = image.spec.samples > 1 ? "2DMS" : "2D";
  const auto samples = static_cast<uint32_t>(image.spec.samples);
  const VkExtent3D& extent = image.spec.extent;
  const size_t texels = size_t{extent.width} * extent.height * samples;
  const Buffer words = run.buffer(16 * texels);
  Image readable = image;
  readable.view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, image.spec.format,
                                 {static_cast<VkImageAspectFlags>(aspect), 0, 1, 0, 1});
  const Resources res = run.resources({sampled(0, readable, run.sampler(VK_FILTER_NEAREST)), storage_buffer(1, words)});
  const std::string code =
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(binding = 0) uniform " +
      prefix + "sampler" + kind +
      " source;\n"
      "layout(binding = 1) buffer Texels { " +
      prefix +
      "vec4 texels[]; };\n"
      "void main() {\n"
      "  uvec3 at = gl_GlobalInvocationID;\n"
      "  if (at.x >= " +
      std::to_string(extent.width) + "u || at.y >= " + std::to_string(extent.height) +
      "u) return;\n"
      "  texels[(at.z * " +
      std::to_string(extent.height) + "u + at.y) * " + std::to_string(extent.width) +
      "u + at.x] = texelFetch(source, ivec2(at.xy), int(at.z));\n"
      "}\n";
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, (extent.width + 7) / 8, (extent.height + 7) / 8, samples);
  });
  return {words.as<uint32_t>(), words.as<uint32_t>() + 4 * texels};
}

void put(Run& run, const std::string& name, VkExtent2D extent, uint32_t planes, const std::vector<uint32_t>& words) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(words.data());
  Output output{name,         format_info(VK_FORMAT_R32G32B32A32_UINT),
                extent.width, extent.height,
                planes,       std::vector<unsigned char>(bytes, bytes + 4 * words.size())};
  output.may_be_blank = true;
  run.out(std::move(output));
}

void put(Run& run, const std::string& name, VkExtent2D extent, uint32_t planes, const std::vector<float>& values) {
  std::vector<uint32_t> words(values.size());
  std::memcpy(words.data(), values.data(), 4 * values.size());
  put(run, name, extent, planes, words);
}

}  // namespace vitrine::cts
