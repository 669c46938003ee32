// Listed deviations of interpolation, logic operations and alpha coverage.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

const AddCase kInterpolation(
    "pipeline", "deviation.interpolation_overwrites_input", "interpolation-overwrites-input", case_against_control,
    [](Run& run) {
      run.require(run.gpu.features.sampleRateShading, "sampleRateShading");
      TargetSpec target;
      target.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
      const std::vector<float> values = colored({{-0.7f, -0.7f, 0, 1}, {0.7f, -0.5f, 0, 1}, {0, 0.7f, 0, 1}});
      const auto fragment = [](const char* first, const char* second) {
        return std::string("layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n") +
               "void main() {\n" + first + second + "  result = vec4(plain.xy, other.xy);\n}\n";
      };
      const char* plain = "  vec4 plain = passed;\n";
      const char* other = "  vec4 other = interpolateAtOffset(passed, vec2(0.25, -0.375));\n";
      GraphicsSpec spec;
      spec.fragment = fragment(other, plain);
      draw(run, "read_after", target, spec, values);
      spec.fragment = fragment(plain, other);
      draw(run, "read_before", target, spec, values);
    });

/// The inverse of what is there, by logic operation and from the shader.
const AddCase kPackedLogic(
    "pipeline", "deviation.logic_op_width", "logic-op-width", case_against_control, [](Run& run) {
      run.require(run.gpu.features.logicOp, "logicOp");
      for (const bool inverts : {true, false}) {
        TargetSpec target_spec;
        target_spec.colors = {VK_FORMAT_A2B10G10R10_UINT_PACK32};
        Target target = make_target(run, target_spec);
        target.clears[0].color = {};
        for (uint32_t c = 0; c < 4; ++c) target.clears[0].color.uint32[c] = 3 - c;
        GraphicsSpec spec;
        spec.vertex = kFullScreenVertex;
        spec.fragment =
            "layout(location = 0) out uvec4 result;\nvoid main() { result = uvec4(1020, 1021, 1022, 3); }\n";
        spec.blend.logicOpEnable = inverts;
        spec.blend.logicOp = VK_LOGIC_OP_INVERT;
        const VkPipeline pipeline = make_pipeline(run, spec, target);
        draw_once(run, target, pipeline);
        run.out(inverts ? "inverted" : "written", target.colors[0]);
        run.outputs.back().may_be_blank = true;
      }
    });

const AddCase kAlphaPerSample(
    "pipeline", "deviation.alpha_to_coverage_per_sample", "alpha-to-coverage-per-sample", case_against_control,
    [](Run& run) {
      run.require(run.gpu.features.sampleRateShading, "sampleRateShading");
      TargetSpec target;
      target.samples = VK_SAMPLE_COUNT_4_BIT;
      const std::vector<float> values = colored({{-0.7f, -0.7f, 0, 1}, {0.7f, -0.5f, 0, 1}, {0, 0.7f, 0, 1}});
      GraphicsSpec spec;
      spec.fragment =
          "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
          "void main() { result = vec4(passed.xyz, gl_SampleID == 0 ? 0.125 : 1.0); }\n";
      spec.multisample.alphaToCoverageEnable = VK_TRUE;
      draw(run, "alpha_to_coverage", target, spec, values);
      spec.multisample.alphaToCoverageEnable = VK_FALSE;
      draw(run, "all_samples", target, spec, values);
    });

/// A mask without the one sample, and one without any.
const AddCase kOneSampleMask(
    "pipeline", "deviation.one_sample_mask", "one-sample-mask", case_against_control, [](Run& run) {
      const std::vector<float> values = colored({{-0.7f, -0.7f, 0, 1}, {0.7f, -0.5f, 0, 1}, {0, 0.7f, 0, 1}});
      for (const VkSampleMask mask : {0xfffffffeu, 0u}) {
        GraphicsSpec spec;
        spec.multisample.pSampleMask = &mask;
        draw(run, mask ? "others" : "none", {}, spec, values);
        run.outputs.back().may_be_blank = true;
      }
    });

const AddCase kAlphaToOne(
    "pipeline", "deviation.alpha_to_one_beside_mask", "alpha-to-one-beside-mask", case_against_control, [](Run& run) {
      run.require(run.gpu.features.alphaToOne, "alphaToOne");
      TargetSpec target;
      target.samples = VK_SAMPLE_COUNT_4_BIT;
      const std::vector<float> values = colored({{-0.7f, -0.7f, 0, 1}, {0.7f, -0.5f, 0, 1}, {0, 0.7f, 0, 1}});
      const auto text = [](const char* alpha) {
        return std::string(
                   "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
                   "void main() { gl_SampleMask[0] = 7; result = vec4(passed.xyz, ") +
               alpha + "); }\n";
      };
      GraphicsSpec spec;
      spec.fragment = text("0.25");
      spec.multisample.alphaToOneEnable = VK_TRUE;
      draw(run, "alpha_to_one", target, spec, values);
      spec.fragment = text("1.0");
      spec.multisample.alphaToOneEnable = VK_FALSE;
      draw(run, "one", target, spec, values);
    });

/// The control is a clear, which the reference rounds.
const AddCase kSnorm10("pipeline", "deviation.snorm10_attachments", "snorm10-attachments", case_against_control,
                       [](Run& run) {
                         TargetSpec target_spec;
                         target_spec.colors = {VK_FORMAT_A2B10G10R10_SNORM_PACK32};
                         const std::vector<float> corners = colored({{-3, -1, 0, 1}, {3, -1, 0, 1}, {0, 5, 0, 1}});
                         GraphicsSpec spec;
                         spec.fragment =
                             "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
                             "void main() { result = vec4(-0.9, 0.3, 0.75, 1.0); }\n";
                         draw(run, "drawn", target_spec, spec, corners);
                         Target target = make_target(run, target_spec);
                         target.clears[0].color = {{-0.9f, 0.3f, 0.75f, 1.0f}};
                         run.once([&](VkCommandBuffer cmd) {
                           target.begin(cmd);
                           vkCmdEndRenderPass(cmd);
                         });
                         run.out("cleared", target.colors[0]);
                       });

}  // namespace
}  // namespace vitrine::cts
