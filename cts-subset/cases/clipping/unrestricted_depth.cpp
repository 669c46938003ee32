// VK_EXT_depth_range_unrestricted: viewports, clears, bias and shaders that give depth outside [0, 1]. The extension
// changes what devices do as soon as it is enabled, so each case makes devices of its own.
#include <algorithm>
#include <limits>

#include "cases/common/own_device.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr char kExtension[] = "VK_EXT_depth_range_unrestricted";

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() {
  passed = color;
  gl_Position = position;
})";

void random_depths(Run& run) {
  Random& random = run.random;
  const bool clears_attachment = random.chance(0.3f), writes_depth = random.chance(0.3f);
  TargetSpec target_spec;
  target_spec.width = 16 + random.below(90);
  target_spec.height = 16 + random.below(90);
  target_spec.depth = random.pick({VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT,
                                   VK_FORMAT_D16_UNORM, VK_FORMAT_D24_UNORM_S8_UINT});
  const bool floats = target_spec.depth == VK_FORMAT_D32_SFLOAT || target_spec.depth == VK_FORMAT_D32_SFLOAT_S8_UINT;
  if (random.chance(0.25f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const auto depth = [&] { return random.real(-2.0f, 3.0f); };
  const auto clear_depth = [&] { return floats ? depth() : random.unit(); };
  Target target = make_target(run, target_spec);
  const float cleared_stencil = random.unit();
  target.clears.back() = clear_value(target_spec.depth, clear_depth(), cleared_stencil, 0, 0);
  GraphicsSpec spec;
  spec.vertex = kVertex;
  spec.fragment = std::string("layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n") +
                  "void main() {\n  result = vec4(passed.xy, fract(gl_FragCoord.z), 1);\n" +
                  (writes_depth ? "  gl_FragDepth = passed.z * 5.0 - 2.0;\n" : "") +
                  (random.chance(0.2f) ? "  if (passed.w > 0.8) discard;\n" : "") + "}\n";
  spec.floats({4, 4});
  spec.depth.depthTestEnable = VK_TRUE;
  spec.depth.depthWriteEnable = random.chance(0.9f);
  spec.depth.depthCompareOp = static_cast<VkCompareOp>(random.below(8));
  spec.depth.stencilTestEnable = random.chance(0.3f);
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_INVERT, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 1};
  const bool bounds = gpus().device.features.depthBounds && gpus().reference.features.depthBounds;
  if (bounds && random.chance(0.2f)) {
    spec.depth.depthBoundsTestEnable = VK_TRUE;
    spec.depth.minDepthBounds = random.real(-2.0f, 0.5f);
    spec.depth.maxDepthBounds = random.real(0.5f, 3.0f);
  }
  const bool clamps = random.chance(0.4f);
  spec.raster.depthClampEnable = clamps;
  if (random.chance(0.3f)) {
    spec.raster.depthBiasEnable = VK_TRUE;
    spec.raster.depthBiasConstantFactor = random.real(-2.0e6f, 2.0e6f);
    spec.raster.depthBiasSlopeFactor = random.real(-3.0f, 3.0f);
  }
  // deviations.md, unorm-depth-outside
  const auto end = [&] { return clamps && !floats ? random.unit() : depth(); };
  spec.viewports = {
      {0, 0, static_cast<float>(target_spec.width), static_cast<float>(target_spec.height), end(), end()}};
  const uint32_t count = 3 * (1 + random.below(30));
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i) {
    const float w = random.chance(0.5f) ? 1.0f : random.real(0.2f, 4.0f);
    for (const float v : {random.real(-1, 1) * w, random.real(-1, 1) * w, random.real(-0.3f, 1.3f) * w, w})
      values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  run.note("state",
           "format " + std::to_string(target_spec.depth) + ", compare " + std::to_string(spec.depth.depthCompareOp) +
               ", write " + std::to_string(spec.depth.depthWriteEnable) + ", bounds " +
               std::to_string(spec.depth.depthBoundsTestEnable) + ", clamp " +
               std::to_string(spec.raster.depthClampEnable) + ", bias " + std::to_string(spec.raster.depthBiasEnable) +
               ", clear " + std::to_string(target.clears.back().depthStencil.depth) + ", viewport " +
               std::to_string(spec.viewports[0].minDepth) + " to " + std::to_string(spec.viewports[0].maxDepth) + "\n" +
               spec.fragment);
  const Buffer vertices = run.buffer_of(values);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  VkClearAttachment clear{VK_IMAGE_ASPECT_DEPTH_BIT, 0, {}};
  clear.clearValue.depthStencil.depth = clear_depth();
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    if (clears_attachment) {
      const VkClearRect rect{{{3, 5}, {9, 7}}, 0, 1};
      vkCmdClearAttachments(cmd, 1, &clear, 1, &rect);
    }
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, count, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

CTS_RANDOM("clipping", "random_unrestricted_depth", 60) {
  run.require(offers_extension(run.gpu, kExtension), kExtension);
  OwnDevice own(run.gpu, kExtension);
  {
    Run inner(own.gpu, run.random.bits64(), run.index);
    random_depths(inner);
    run.outputs = std::move(inner.outputs);
    run.notes = std::move(inner.notes);
  }
}

/// A depth that is not a number, and then one that is compared with it, by every comparison.
void unordered_depths(Run& run) {
  for (int op = 0; op < 8; ++op) {
    TargetSpec target_spec;
    target_spec.depth = VK_FORMAT_D32_SFLOAT;
    const Target target = make_target(run, target_spec);
    GraphicsSpec spec;
    spec.vertex = kVertex;
    spec.fragment =
        "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
        "void main() { result = vec4(passed.xyw, 1); gl_FragDepth = passed.z; }\n";
    spec.floats({4, 4});
    spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
    spec.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
    const VkPipeline first = make_pipeline(run, spec, target);
    spec.depth.depthCompareOp = static_cast<VkCompareOp>(op);
    const VkPipeline second = make_pipeline(run, spec, target);
    std::vector<float> values;
    for (const float depth : {std::numeric_limits<float>::quiet_NaN(), 0.5f})
      for (const float x : {-0.7f, 0.0f, 0.7f})
        values.insert(values.end(), {x, x == 0.0f ? 0.8f : -0.6f, 0.5f, 1, depth == 0.5f ? 1.0f : 0.25f, 0, depth, 0});
    const Buffer vertices = run.buffer_of(values);
    run.once([&](VkCommandBuffer cmd) {
      target.begin(cmd);
      bind_vertices(cmd, vertices);
      bind_pipeline(cmd, first);
      vkCmdDraw(cmd, 3, 1, 0, 0);
      bind_pipeline(cmd, second);
      vkCmdDraw(cmd, 3, 1, 3, 0);
      vkCmdEndRenderPass(cmd);
    });
    out_target(run, target);
    for (Output* output : {&run.outputs.end()[-2], &run.outputs.end()[-1]}) output->name += "." + std::to_string(op);
  }
}

CTS_CASE("clipping", "unordered_depths") {
  run.require(offers_extension(run.gpu, kExtension), kExtension);
  OwnDevice own(run.gpu, kExtension);
  Run inner(own.gpu, 1, 0);
  unordered_depths(inner);
  run.outputs = std::move(inner.outputs);
}

/// A smooth line at depth -1.
const AddCase kSmoothOutside(
    "clipping", "deviation.unrestricted_smooth_lines", "smooth-line-depth-clamp",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) -> std::string {
      const auto lowest = [](const Output& output) {
        std::vector<float> depth(output.bytes.size() / 4);
        std::memcpy(depth.data(), output.bytes.data(), output.bytes.size());
        return *std::min_element(depth.begin(), depth.end());
      };
      if (lowest(device.back()) != -1.0f) return "the device's depth is not -1";
      return lowest(reference.back()) == 0.0f ? "" : "the reference's depth is not 0";
    },
    [](Run& run) {
      run.require(offers_extension(run.gpu, kExtension), kExtension);
      run.require(run.gpu.extension_features.smoothLines, "smoothLines");
      OwnDevice own(run.gpu, kExtension);
      Run inner(own.gpu, 1, 0);
      TargetSpec target_spec;
      target_spec.depth = VK_FORMAT_D32_SFLOAT;
      const Target target = make_target(inner, target_spec);
      VkPipelineRasterizationLineStateCreateInfoEXT line{
          VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
      line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
      GraphicsSpec spec;
      spec.vertex = "void main() { gl_Position = vec4(gl_VertexIndex == 0 ? -0.7 : 0.8, 0.1, 0.0, 1.0); }\n";
      spec.fragment = "layout(location = 0) out vec4 result;\nvoid main() { result = vec4(1); }\n";
      spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      spec.raster.pNext = &line;
      spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
      spec.viewports = {{0, 0, 64, 64, -1.0f, -1.0f}};
      const VkPipeline pipeline = make_pipeline(inner, spec, target);
      inner.once([&](VkCommandBuffer cmd) {
        target.begin(cmd);
        bind_pipeline(cmd, pipeline);
        vkCmdDraw(cmd, 2, 1, 0, 0);
        vkCmdEndRenderPass(cmd);
      });
      out_target(inner, target);
      run.outputs = std::move(inner.outputs);
    });

/// The depth clamp to a range below 0, of a format of fixed point.
const AddCase kUnormOutside(
    "clipping", "deviation.unorm_depth_outside", "unorm-depth-outside",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) {
      const auto is_zero = [](const Output& output) {
        return std::all_of(output.bytes.begin(), output.bytes.end(), [](unsigned char byte) { return byte == 0; });
      };
      if (!is_zero(device.back())) return std::string("the device's depth is not 0");
      return is_zero(reference.back()) ? std::string("the reference's depth is 0") : std::string();
    },
    [](Run& run) {
      run.require(offers_extension(run.gpu, kExtension), kExtension);
      OwnDevice own(run.gpu, kExtension);
      Run inner(own.gpu, 1, 0);
      TargetSpec target_spec;
      target_spec.depth = VK_FORMAT_D16_UNORM;
      const Target target = make_target(inner, target_spec);
      GraphicsSpec spec;
      spec.vertex = kFullScreenVertex;
      spec.fragment = "layout(location = 0) out vec4 result;\nvoid main() { result = vec4(1); }\n";
      spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
      spec.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
      spec.raster.depthClampEnable = VK_TRUE;
      spec.viewports = {{0, 0, 64, 64, -1.3f, -1.9f}};
      const VkPipeline pipeline = make_pipeline(inner, spec, target);
      inner.once([&](VkCommandBuffer cmd) {
        target.begin(cmd);
        bind_pipeline(cmd, pipeline);
        vkCmdDraw(cmd, 3, 1, 0, 0);
        vkCmdEndRenderPass(cmd);
      });
      out_target(inner, target);
      run.outputs = std::move(inner.outputs);
    });

}  // namespace
}  // namespace vitrine::cts
