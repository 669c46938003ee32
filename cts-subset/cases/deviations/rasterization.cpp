// Listed deviations of rasterization (not lines).
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

const AddCase kNine("rasterization", "deviation.nine_vertices", "nine-vertices", case_against_control, [](Run& run) {
  std::vector<std::array<float, 4>> positions = {{-0.9f, -0.8f, 0, 1}, {0.2f, -0.7f, 0, 1}, {-0.5f, 0.6f, 0, 1},
                                                 {0.1f, -0.2f, 0, 1},  {0.9f, 0.1f, 0, 1},  {0.3f, 0.8f, 0, 1},
                                                 {0.1f, 0.3f, 0, 1},   {0.4f, 0.3f, 0, 1},  {0.7f, 0.3f, 0, 1}};
  draw(run, "nine", {}, {}, colored(positions));
  for (int k = 0; k < 3; ++k) positions.push_back({0.5f, 0.5f, 0, 1});
  draw(run, "twelve", {}, {}, colored(positions));
});

const AddCase kScissor(
    "rasterization", "deviation.multisample_scissor", "multisample-scissor",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) {
      // The control has no scissor: inside the rectangle the device equals it, outside it holds the clear value.
      Output expected = reference[1];
      for (uint32_t s = 0; s < expected.layers; ++s)
        for (uint32_t y = 0; y < expected.height; ++y)
          for (uint32_t x = 0; x < expected.width; ++x)
            if (x < 20 || x >= 44 || y < 17 || y >= 50)
              std::memcpy(&expected.bytes[((size_t{s} * expected.height + y) * expected.width + x) * 16],
                          &expected.bytes[0], 16);
      return first_of({same(device[1], reference[1], "the control"),
                       different(reference[0], expected, "the reference's fault"),
                       same(device[0], expected, "the device")});
    },
    [](Run& run) {
      TargetSpec target;
      target.samples = VK_SAMPLE_COUNT_4_BIT;
      const std::vector<float> values = colored({{-0.9f, -0.9f, 0, 1}, {0.9f, -0.8f, 0, 1}, {-0.1f, 0.9f, 0, 1}});
      GraphicsSpec spec;
      spec.scissors = {{{20, 17}, {24, 33}}};
      draw(run, "scissored", target, spec, values);
      draw(run, "whole", target, {}, values);
    });

/// A point of 300 pixels, and the square of two triangles that it is.
const AddCase kLargePoint("rasterization", "deviation.large_points", "large-points", case_against_control,
                          [](Run& run) {
                            run.require(run.gpu.features.largePoints, "largePoints");
                            TargetSpec target;
                            target.width = target.height = 320;
                            GraphicsSpec points;
                            points.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
                            points.vertex =
                                "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n"
                                "layout(location = 0) out vec4 passed;\n"
                                "void main() {\n  passed = color;\n  gl_Position = position;\n"
                                "  gl_PointSize = 300.0;\n}\n";
                            draw(run, "point", target, points, colored({{0, 0, 0.5f, 1}}));
                            constexpr float kEdge = 300.0f / 320;
                            std::vector<float> square = colored({{-kEdge, -kEdge, 0.5f, 1},
                                                                 {kEdge, -kEdge, 0.5f, 1},
                                                                 {-kEdge, kEdge, 0.5f, 1},
                                                                 {kEdge, -kEdge, 0.5f, 1},
                                                                 {-kEdge, kEdge, 0.5f, 1},
                                                                 {kEdge, kEdge, 0.5f, 1}});
                            for (size_t i = 8; i < square.size(); ++i)
                              if (i % 8 >= 4) square[i] = square[i - 8];
                            draw(run, "square", target, {}, square);
                          });

/// A viewport that ends within pixels 46, and the same rectangle drawn in the whole one.
const AddCase kViewport("rasterization", "deviation.viewport_scissor", "viewport-scissor", case_against_control,
                        [](Run& run) {
                          TargetSpec target;
                          target.samples = VK_SAMPLE_COUNT_4_BIT;
                          const auto rectangle = [](float low, float high) {
                            std::vector<float> values = colored({{low, low, 0.5f, 1},
                                                                 {high, low, 0.5f, 1},
                                                                 {low, high, 0.5f, 1},
                                                                 {high, low, 0.5f, 1},
                                                                 {low, high, 0.5f, 1},
                                                                 {high, high, 0.5f, 1}});
                            for (size_t i = 4; i < values.size(); i += 8) values[i] = 0.25f;
                            return values;
                          };
                          GraphicsSpec inner;
                          inner.viewports = {{16.0f, 16.0f, 30.375f, 30.375f, 0.0f, 1.0f}};
                          draw(run, "small_viewport", target, inner, rectangle(-1, 1));
                          draw(run, "whole_viewport", target, {}, rectangle(-0.5f, 46.375f / 32 - 1));
                        });

/// The outline of a back-facing triangle, which only the back stencil state lets through.
const AddCase kFacing(
    "rasterization", "deviation.polygon_mode_facing", "polygon-mode-facing", case_against_control, [](Run& run) {
      run.require(run.gpu.features.fillModeNonSolid, "fillModeNonSolid");
      TargetSpec target;
      target.depth = VK_FORMAT_D32_SFLOAT_S8_UINT;
      GraphicsSpec spec;
      spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
      spec.raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
      spec.depth.stencilTestEnable = VK_TRUE;
      spec.depth.front.compareOp = VK_COMPARE_OP_NEVER;
      spec.depth.back.compareOp = VK_COMPARE_OP_ALWAYS;
      const std::vector<float> values = colored({{-0.7f, -0.7f, 0, 1}, {0.7f, -0.5f, 0, 1}, {0, 0.7f, 0, 1}});
      draw(run, "not_read", target, spec, values);
      spec.fragment =
          "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
          "void main() { result = gl_FrontFacing ? vec4(0.0) : passed; }\n";
      draw(run, "read", target, spec, values);
    });

const AddCase kIdentity(
    "rasterization", "deviation.identity_viewport", "identity-viewport", case_against_control, [](Run& run) {
      TargetSpec target;
      target.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
      target.width = target.height = 8;
      const std::vector<float> values = colored({{0, 0, 0.5f, 2}, {2, 0, 0.5f, 2}, {0, 2, 0.5f, 2}});
      GraphicsSpec spec;
      spec.fragment =
          "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
          "void main() { result = gl_FragCoord.zwzw; }\n";
      spec.viewports = {{-1.0f, -1.0f, 2.0f, 2.0f, 0.0f, 1.0f}};
      draw(run, "identity", target, spec, values);
      spec.viewports = {{-1.0f, -1.0f, 2.0f, 2.0f, 0.0f, 0.99999994f}};
      spec.fragment =
          "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
          "void main() { result = vec4(0.25, 0.5, 0.25, 0.5) + 0.0 * gl_FragCoord; }\n";
      draw(run, "not_identity", target, spec, values);
    });

/// The bias carries one corner of a filled triangle beyond depth 1; the state of lines is smooth, and not.
const AddCase kLineStateBias("rasterization", "deviation.line_state_depth_bias", "line-state-depth-bias",
                             case_against_control, [](Run& run) {
                               run.require(run.gpu.extension_features.smoothLines, "smoothLines");
                               for (const bool smooth : {true, false}) {
                                 VkPipelineRasterizationLineStateCreateInfoEXT line{
                                     VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
                                 if (smooth)
                                   line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
                                 TargetSpec target;
                                 target.depth = VK_FORMAT_D16_UNORM;
                                 GraphicsSpec spec;
                                 spec.raster.pNext = &line;
                                 spec.raster.depthBiasEnable = VK_TRUE;
                                 spec.raster.depthBiasConstantFactor = 0x1p14f;
                                 spec.fragment =
                                     "layout(location = 0) out vec4 result;\n"
                                     "void main() { result = vec4(gl_FragCoord.z); }\n";
                                 draw(run, smooth ? "smooth" : "default", target, spec,
                                      colored({{-0.7f, -0.7f, 0.9f, 1}, {0.7f, -0.5f, 0.1f, 1}, {0, 0.7f, 0.2f, 1}}));
                               }
                             });

}  // namespace
}  // namespace vitrine::cts
