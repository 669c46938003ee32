// The output merger: conversion of shader outputs to every attachment format, blending, logic operations, write masks,
// depth and stencil tests, sample masks, alpha to coverage.
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kPixels = 64 * 64;

std::string prefix_of(const FormatInfo& info) {
  return info.numeric == Numeric::kUint ? "u" : info.numeric == Numeric::kSint ? "i" : "";
}

/// A full-screen draw whose fragment n writes vector n of a buffer.
struct PixelWriter {
  Target target;
  Resources resources;
  GraphicsSpec spec;

  PixelWriter(Run& run, VkFormat format, const Buffer& values, VkAttachmentLoadOp load) {
    TargetSpec target_spec;
    target_spec.colors = {format};
    target_spec.load = load;
    target = make_target(run, target_spec);
    resources = run.resources({storage_buffer(0, values)});
    const std::string prefix = prefix_of(format_info(format));
    spec.layout = resources.layout;
    spec.vertex = kFullScreenVertex;
    spec.fragment = "layout(std430, binding = 0) readonly buffer V { " + prefix + "vec4 values[]; };\n" +
                    "layout(location = 0) out " + prefix + "vec4 result;\n" +
                    "void main() { result = values[uint(gl_FragCoord.x) + 64u * uint(gl_FragCoord.y)]; }\n";
  }
  void draw(Run& run) {
    const VkPipeline pipeline = make_pipeline(run, spec, target);
    draw_once(run, target, pipeline, &resources);
    run.out("color", target.colors[0]);
    run.outputs.back().nan_bits_free = true;
  }
};

std::vector<VkFormat> attachment_formats(VkFormatFeatureFlags extra = 0) {
  std::vector<VkFormat> result;
  const VkFormatFeatureFlags needed = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | extra;
  for (const FormatInfo& info : color_formats())
    if ((gpus().reference.features_of(info.format) & needed) == needed) result.push_back(info.format);
  return result;
}

/// Values around what the format can hold, its rounding ties, and specials.
Buffer output_values(Run& run, const FormatInfo& info) {
  Random& random = run.random;
  std::vector<float> values(kPixels * 4);
  for (float& value : values) {
    if (is_integer(info)) {
      value = Random::from_bits(
          random.chance(0.3f) ? random.bits() : random.below(70000) - (info.numeric == Numeric::kSint ? 35000 : 0));
      continue;
    }
    switch (random.below(6)) {
      case 0:
        value = (static_cast<float>(random.below(256)) + 0.5f) / 255.0f;
        break;
      case 1:
        value = random.operand(true);
        break;
      case 2:
        value = random.real(-1.2f, 1.2f);
        break;
      case 3:
        value = random.real(-70000.0f, 70000.0f);
        break;
      default:
        value = random.unit();
    }
  }
  return run.buffer_of(values);
}

const bool kConversions = [] {
  for (const FormatInfo& info : color_formats())
    AddCase("pipeline", std::string("output.") + info.name, [&info](Run& run) {
      run.require(gpus().reference.features_of(info.format) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, info.name);
      PixelWriter(run, info.format, output_values(run, info), VK_ATTACHMENT_LOAD_OP_CLEAR).draw(run);
    });
  return true;
}();

// Every float above the linear part of the curve: 23 cases are all of them, each takes every 23rd.
CTS_RANDOM("pipeline", "srgb_encode", 2) {
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R8G8B8A8_SRGB};
  target_spec.width = target_spec.height = 1024;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "layout(location = 0) out vec4 result;\n"
      "void main() { uint i = (uint(gl_FragCoord.x) + 1024u * uint(gl_FragCoord.y)) * 3u;\n"
      "uvec3 bits = 0x3b4d2e00u + uvec3(i, i + 1u, i + 2u) * 23u + " +
      std::to_string(run.index % 23) + "u;\nresult = vec4(uintBitsToFloat(bits), 1.0); }\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  run.out("color", target.colors[0]);
}

/// Formats without alpha take (source op destination) times the factor when the factors of the colour are equal,
/// whatever those of alpha are.
const bool kCommonFactors = [] {
  for (const VkFormat format : {VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_B10G11R11_UFLOAT_PACK32})
    AddCase("pipeline", std::string("blend_common_factor.") + format_info(format).name, [format](Run& run) {
      run.require(gpus().reference.features_of(format) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, "blending");
      std::vector<float> values(kPixels * 4);
      for (float& value : values) value = run.random.unit();
      PixelWriter writer(run, format, run.buffer_of(values), VK_ATTACHMENT_LOAD_OP_LOAD);
      run.fill_random(writer.target.colors[0]);
      VkPipelineColorBlendAttachmentState blend{};
      blend.blendEnable = VK_TRUE;
      blend.srcColorBlendFactor = blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR;
      blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
      blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_DST_COLOR;
      blend.colorWriteMask = 0xf;
      writer.spec.blends = {blend};
      for (float& constant : writer.spec.blend.blendConstants) constant = run.random.unit();
      writer.draw(run);
    });
  return true;
}();

CTS_RANDOM("pipeline", "random_blend", 160) {
  Random& random = run.random;
  const VkFormat format =
      random.chance(0.5f)
          ? random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT})
          : random.pick(attachment_formats(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT));
  std::vector<float> values(kPixels * 4);
  for (float& value : values)
    value = random.chance(0.1f)   ? static_cast<float>(random.below(2))
            : random.chance(0.8f) ? random.unit()
                                  : random.real(-0.5f, 1.5f);
  PixelWriter writer(run, format, run.buffer_of(values), VK_ATTACHMENT_LOAD_OP_LOAD);
  run.fill_random(writer.target.colors[0]);
  VkPipelineColorBlendAttachmentState blend{};
  const auto factor = [&] { return static_cast<VkBlendFactor>(random.below(15)); };
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor = factor();
  blend.dstColorBlendFactor = factor();
  blend.srcAlphaBlendFactor = random.chance(0.3f) ? blend.srcColorBlendFactor : factor();
  blend.dstAlphaBlendFactor = random.chance(0.3f) ? blend.dstColorBlendFactor : factor();
  blend.colorBlendOp = random.chance(0.5f) ? VK_BLEND_OP_ADD : static_cast<VkBlendOp>(random.below(5));
  blend.alphaBlendOp = random.chance(0.5f) ? VK_BLEND_OP_ADD : static_cast<VkBlendOp>(random.below(5));
  blend.colorWriteMask = random.chance(0.8f) ? 0xf : 1 + random.below(15);
  writer.spec.blends = {blend};
  for (float& constant : writer.spec.blend.blendConstants) constant = random.unit();
  run.note("blend", std::string(format_info(format).name) + " color " + std::to_string(blend.srcColorBlendFactor) +
                        " op " + std::to_string(blend.colorBlendOp) + " " + std::to_string(blend.dstColorBlendFactor) +
                        " alpha " + std::to_string(blend.srcAlphaBlendFactor) + " op " +
                        std::to_string(blend.alphaBlendOp) + " " + std::to_string(blend.dstAlphaBlendFactor) +
                        " mask " + std::to_string(blend.colorWriteMask) + "\n");
  writer.draw(run);
  run.may_be_blank();
}

const bool kLogic = [] {
  for (int op = 0; op < 16; ++op)
    for (const VkFormat format :
         {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UINT, VK_FORMAT_R5G6B5_UNORM_PACK16})
      AddCase("pipeline", "logic_op." + std::to_string(op) + "." + format_info(format).name, [=](Run& run) {
        run.require(run.gpu.features.logicOp, "logicOp");
        const FormatInfo& info = format_info(format);
        PixelWriter writer(run, format, output_values(run, info), VK_ATTACHMENT_LOAD_OP_LOAD);
        run.fill_random(writer.target.colors[0]);
        writer.spec.blend.logicOpEnable = VK_TRUE;
        writer.spec.blend.logicOp = static_cast<VkLogicOp>(op);
        writer.draw(run);
        run.may_be_blank();
      });
  return true;
}();

/// Overlapping quads at many depths over random depth and stencil contents.
void depth_stencil(Run& run, VkFormat format, VkSampleCountFlagBits samples) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.depth = format;
  target_spec.samples = samples;
  if (samples == VK_SAMPLE_COUNT_1_BIT) target_spec.load = VK_ATTACHMENT_LOAD_OP_LOAD;
  Target target = make_target(run, target_spec);
  if (samples == VK_SAMPLE_COUNT_1_BIT) {
    run.fill_random(target.colors[0]);
    run.fill_random(*target.depth);
  }
  target.clears[1].depthStencil = {0.5f, 100};
  const Buffer vertices = run.buffer_of(random_colored_vertices(random, 3 * 16));
  std::vector<VkPipeline> pipelines;
  for (int n = 0; n < 4; ++n) {
    GraphicsSpec spec;
    spec.vertex = kColorVertex;
    spec.fragment = kColorFragment;
    spec.floats({4, 4});
    const auto compare = [&] { return static_cast<VkCompareOp>(random.below(8)); };
    const auto op = [&] { return static_cast<VkStencilOp>(random.below(8)); };
    const auto face = [&] {
      return VkStencilOpState{op(), op(), op(), compare(), random.below(256), random.below(256), random.below(256)};
    };
    spec.depth.depthTestEnable = random.chance(0.7f);
    spec.depth.depthWriteEnable = random.chance(0.7f);
    spec.depth.depthCompareOp = compare();
    spec.depth.stencilTestEnable = random.chance(0.8f);
    spec.depth.front = face();
    spec.depth.back = face();
    pipelines.push_back(make_pipeline(run, spec, target));
  }
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_vertices(cmd, vertices);
    for (uint32_t n = 0; n < 4; ++n) {
      bind_pipeline(cmd, pipelines[n]);
      vkCmdDraw(cmd, 12, 1, n * 12, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

const bool kDepth = [] {
  for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT,
                                VK_FORMAT_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
    const std::string name = std::string("random_depth_stencil.") + format_info(format).name;
    AddGenerator("pipeline", name.c_str(), 15, [=](Run& run) { depth_stencil(run, format, VK_SAMPLE_COUNT_1_BIT); });
  }
  AddGenerator("pipeline", "random_depth_stencil.multisample", 15,
               [](Run& run) { depth_stencil(run, VK_FORMAT_D32_SFLOAT, VK_SAMPLE_COUNT_4_BIT); });
  return true;
}();

/// Sample mask, alpha to coverage, alpha to one, sample shading, centroid and sample interpolation.
CTS_RANDOM("pipeline", "random_multisample", 80) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  target_spec.resolve = true;
  target_spec.colors = {
      random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT})};
  if (random.chance(0.4f)) target_spec.depth = VK_FORMAT_D32_SFLOAT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  const char* qualifier =
      random.pick({"", "centroid", run.gpu.features.sampleRateShading ? "sample" : "", "flat", "noperspective"});
  spec.vertex =
      std::string(
          "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\nlayout(location = 0) ") +
      qualifier + " out vec4 passed;\nvoid main() { passed = color; gl_Position = position; }\n";
  const std::string value = random.pick<const char*>(
      {"passed", "passed", "vec4(gl_FragCoord.xy * 0.01, gl_FragCoord.zw)", "passed + 0.1 * float(gl_SampleMaskIn[0])",
       "interpolateAtOffset(passed, vec2(0.2, -0.3))", "interpolateAtSample(passed, 2)"});
  const bool flat = std::string(qualifier) == "flat";
  // Read before it is interpolated elsewhere (deviations.md, interpolation-overwrites-input).
  const std::string mask_line = random.chance(0.2f) ? "  gl_SampleMask[0] = int(passed.x * 16.0);\n" : "";
  spec.fragment = std::string("layout(location = 0) ") + qualifier +
                  " in vec4 passed;\nlayout(location = 0) out vec4 result;\nvoid main() {\n" + mask_line +
                  "  result = " + (flat && value.starts_with("interpolate") ? "passed" : value) + ";\n" +
                  (run.gpu.features.sampleRateShading && random.chance(0.2f)
                       ? "  result.x = float(gl_SampleID) * 0.25 + gl_SamplePosition.x;\n"
                       : "") +
                  "}\n";
  run.require(run.gpu.features.sampleRateShading, "sampleRateShading");
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = target_spec.depth != 0;
  const VkSampleMask mask = random.chance(0.3f) ? random.below(16) : 0xf;
  spec.multisample.pSampleMask = &mask;
  spec.multisample.alphaToCoverageEnable = random.chance(0.3f);
  spec.multisample.alphaToOneEnable = run.gpu.features.alphaToOne && random.chance(0.2f);
  spec.multisample.sampleShadingEnable = random.chance(0.3f);
  spec.multisample.minSampleShading = random.pick({0.0f, 0.2f, 0.5f, 1.0f});
  // deviations.md, alpha-to-coverage-per-sample and alpha-to-one-beside-mask
  const bool per_sample = spec.multisample.sampleShadingEnable || std::string(qualifier) == "sample" ||
                          spec.fragment.find("gl_SampleID") != std::string::npos;
  if (per_sample) spec.multisample.alphaToCoverageEnable = VK_FALSE;
  if (spec.fragment.find("gl_SampleMask[") != std::string::npos) spec.multisample.alphaToOneEnable = VK_FALSE;
  run.note("fragment", spec.fragment);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values;
  for (int i = 0; i < 3 * 8; ++i) {
    const float w = random.real(0.5f, 2.0f);
    for (const float v : {random.real(-1, 1) * w, random.real(-1, 1) * w, random.unit() * w, w}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 24, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

/// The alpha of the first output decides the coverage where no attachment takes its colour.
CTS_CASE("pipeline", "alpha_to_coverage_of_depth_alone") {
  TargetSpec target_spec;
  target_spec.colors = {};
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "layout(location = 0) out vec4 result;\n"
      "void main() { result = vec4(1.0, 1.0, 1.0, fract(gl_FragCoord.x * 0.07)); }\n";
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  spec.multisample.alphaToCoverageEnable = VK_TRUE;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
