// Five to eight colour attachments of different formats, blended and masked independently, some of them switched off
// (VK_EXT_color_write_enable).
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/format.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr VkFormat kFormats[] = {VK_FORMAT_R8G8B8A8_UNORM,
                                 VK_FORMAT_B8G8R8A8_UNORM,
                                 VK_FORMAT_R8_UNORM,
                                 VK_FORMAT_R5G6B5_UNORM_PACK16,
                                 VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                 VK_FORMAT_R16G16_UNORM,
                                 VK_FORMAT_R16G16B16A16_SFLOAT,
                                 VK_FORMAT_R32_SFLOAT,
                                 VK_FORMAT_R32G32B32A32_SFLOAT,
                                 VK_FORMAT_R8G8_UINT,
                                 VK_FORMAT_R16G16B16A16_SINT,
                                 VK_FORMAT_R32G32B32A32_UINT};

VkPipelineColorBlendAttachmentState random_blend(Random& random, bool integers) {
  const auto factor = [&] { return static_cast<VkBlendFactor>(random.below(VK_BLEND_FACTOR_CONSTANT_COLOR)); };
  VkPipelineColorBlendAttachmentState blend{};
  blend.blendEnable = !integers && random.chance(0.6f);
  blend.srcColorBlendFactor = factor();
  blend.dstColorBlendFactor = factor();
  blend.srcAlphaBlendFactor = factor();
  blend.dstAlphaBlendFactor = factor();
  blend.colorBlendOp = static_cast<VkBlendOp>(random.below(5));
  blend.alphaBlendOp = static_cast<VkBlendOp>(random.below(5));
  blend.colorWriteMask = random.chance(0.7f) ? 0xf : random.below(16);
  return blend;
}

CTS_RANDOM("pipeline", "random_many_attachments", 30) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.width = 70;
  target_spec.height = 52;
  target_spec.samples = random.chance(0.3f) ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
  if (random.chance(0.5f)) target_spec.depth = VK_FORMAT_D32_SFLOAT;
  target_spec.colors.clear();
  GraphicsSpec spec;
  std::string outputs, body;
  std::vector<VkBool32> enables;
  const uint32_t count = 5 + random.below(4);
  for (uint32_t i = 0; i < count; ++i) {
    const VkFormat format = kFormats[random.below(static_cast<uint32_t>(std::size(kFormats)))];
    const Numeric numeric = format_info(format).numeric;
    const bool whole = numeric == Numeric::kUint, integers = whole || numeric == Numeric::kSint;
    const std::string type = whole ? "uvec4" : integers ? "ivec4" : "vec4", number = std::to_string(i);
    target_spec.colors.push_back(format);
    outputs += "layout(location = " + number + ") out " + type + " result" + number + ";\n";
    body += "  result" + number + " = " + type + "(fract(passed * " + std::to_string(i + 1) + ".3)" +
            (integers ? " * 100.0" : "") + ");\n";
    spec.blends.push_back(random_blend(random, integers));
    enables.push_back(random.chance(0.8f));
  }
  const Target target = make_target(run, target_spec);
  spec.vertex = kColorVertex;
  spec.fragment = "layout(location = 0) in vec4 passed;\n" + outputs + "void main() {\n" + body + "}\n";
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = target_spec.depth != VK_FORMAT_UNDEFINED;
  VkPipelineColorWriteCreateInfoEXT writes{VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT};
  writes.attachmentCount = count;
  writes.pColorWriteEnables = enables.data();
  if (run.gpu.extension_features.colorWriteEnable) spec.blend.pNext = &writes;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_colored_vertices(random, 30));
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 30, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
