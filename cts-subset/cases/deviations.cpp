// One case per row of deviations.md: the devices differ exactly as the row says, so that the row cannot rot.
#include <array>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

std::string same(const Output& a, const Output& b, const char* what) {
  const Comparison found = compare(a, b);
  return found.first.empty() ? "" : std::string(what) + ": " + found.first;
}
std::string different(const Output& a, const Output& b, const char* what) {
  return compare(a, b).first.empty() ? std::string(what) + " does not show" : "";
}
std::string first_of(std::initializer_list<std::string> messages) {
  for (const std::string& message : messages)
    if (!message.empty()) return message;
  return "";
}

/// Output 0 is the case; output 1 is the same picture made in a way that the reference gets right.
std::string case_against_control(const std::vector<Output>& device, const std::vector<Output>& reference) {
  return first_of({same(device[1], reference[1], "the control"),
                   different(reference[0], reference[1], "the reference's fault"),
                   same(device[0], reference[1], "the device")});
}

/// Draws vertices (vec4 position, vec4 colour) into a fresh target and puts its colour out.
void draw(Run& run, const std::string& name, const TargetSpec& target_spec, GraphicsSpec spec,
          const std::vector<float>& values) {
  const Target target = make_target(run, target_spec);
  if (spec.vertex.empty()) spec.vertex = kColorVertex;
  if (spec.fragment.empty()) spec.fragment = kColorFragment;
  if (spec.bindings.empty()) spec.floats({4, 4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, static_cast<uint32_t>(values.size() / 8), 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out(name, target.colors[0]);
  run.outputs.back().may_be_blank = true;
}

std::vector<float> colored(const std::vector<std::array<float, 4>>& positions) {
  std::vector<float> values;
  for (size_t i = 0; i < positions.size(); ++i) {
    values.insert(values.end(), positions[i].begin(), positions[i].end());
    for (const float c : {0.25f + 0.5f * static_cast<float>(i % 2), 0.5f, 0.75f, 1.0f}) values.push_back(c);
  }
  return values;
}

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

/// A short vertical line of one colour, and the two triangles that its rectangle consists of.
const AddCase kShortLine("rasterization", "deviation.multisample_short_lines", "multisample-short-lines",
                         case_against_control, [](Run& run) {
                           TargetSpec target;
                           target.samples = VK_SAMPLE_COUNT_4_BIT;
                           const auto at = [](float x, float y) {
                             return std::array<float, 4>{x / 32.0f - 1.0f, y / 32.0f - 1.0f, 0.5f, 1.0f};
                           };
                           const auto plain = [](std::vector<float> values) {
                             for (size_t i = 4; i < values.size(); i += 8) values[i] = 0.25f;
                             return values;
                           };
                           GraphicsSpec spec;
                           spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
                           draw(run, "line", target, spec, plain(colored({at(16.5f, 20.25f), at(16.5f, 20.75f)})));
                           draw(run, "triangles", target, {},
                                plain(colored({at(16, 20.25f), at(17, 20.25f), at(16, 20.75f), at(17, 20.25f),
                                               at(16, 20.75f), at(17, 20.75f)})));
                         });

const char kBigPoint[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() { passed = color; gl_Position = position; gl_PointSize = 11.0; })";

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

/// Three patches in a row, coloured by their number.
void draw_patches(Run& run, const std::string& name, bool restarts) {
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = "layout(location = 0) in vec4 position;\nvoid main() { gl_Position = position; }";
  spec.control = R"(
layout(vertices = 3) out;
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  gl_TessLevelOuter = float[4](1.0, 1.0, 1.0, 1.0);
  gl_TessLevelInner = float[2](1.0, 1.0);
})";
  spec.evaluation = R"(
layout(triangles, equal_spacing, cw) in;
layout(location = 0) out vec4 passed;
void main() {
  gl_Position = vec4(0.0);
  for (int i = 0; i < 3; ++i) gl_Position += gl_in[i].gl_Position * gl_TessCoord[i];
  passed = vec4(0.25 * float(gl_PrimitiveID + 1), 0.5, 0.5, 1.0);
})";
  spec.fragment = kColorFragment;
  spec.floats({4});
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  spec.assembly.primitiveRestartEnable = restarts;
  spec.tessellation.patchControlPoints = 3;
  std::vector<float> positions;
  std::vector<uint16_t> order;
  for (uint16_t patch = 0; patch < 3; ++patch) {
    const float left = -0.9f + 0.6f * static_cast<float>(patch);
    for (const float v : {left, -0.8f, 0.5f, 1.0f, left + 0.5f, -0.8f, 0.5f, 1.0f, left, 0.8f, 0.5f, 1.0f})
      positions.push_back(v);
    for (uint16_t i = 0; i < 3; ++i) order.push_back(static_cast<uint16_t>(3 * patch + i));
    if (restarts) order.push_back(0xffff);
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(positions), indices = run.buffer_of(order);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexed(cmd, static_cast<uint32_t>(order.size()), 1, 0, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out(name, target.colors[0]);
}

const AddCase kPatchNumbers("tessellation", "deviation.patch_numbers", "patch-numbers", case_against_control,
                            [](Run& run) {
                              run.require(run.gpu.extension_features.list_restart.primitiveTopologyPatchListRestart,
                                          "primitiveTopologyPatchListRestart");
                              draw_patches(run, "restarted", true);
                              draw_patches(run, "list", false);
                            });

const AddCase kPoint("clipping", "deviation.point_clipping", "point-clipping", case_against_control, [](Run& run) {
  run.require(run.gpu.features.largePoints, "largePoints");
  GraphicsSpec spec;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  spec.vertex = kBigPoint;
  draw(run, "outside", {}, spec, colored({{-1.0625f, 0.25f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 1.0f}}));
  draw(run, "inside_only", {}, spec, colored({{-5.0f, 0.25f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 1.0f}}));
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

/// A strip after a line: with its first line outside of the volume, and without that line.
const AddCase kStippleCounter("rasterization", "deviation.stipple_counter", "stipple-counter", case_against_control,
                              [](Run& run) {
                                run.require(run.gpu.extension_features.line_rasterization.stippledRectangularLines,
                                            "stippledRectangularLines");
                                VkPipelineRasterizationLineStateCreateInfoEXT line{
                                    VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
                                line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
                                line.stippledLineEnable = VK_TRUE;
                                line.lineStippleFactor = 1;
                                line.lineStipplePattern = 0x00ff;
                                GraphicsSpec spec;
                                spec.vertex = kColorVertex;
                                spec.fragment = kColorFragment;
                                spec.floats({4, 4});
                                spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
                                spec.raster.pNext = &line;
                                // The first line is 24 pixels long, so that the pattern stops between its ones and its
                                // zeros.
                                const Buffer vertices = run.buffer_of(colored({{-0.375f, -0.5f, 0, 1},
                                                                               {0.375f, -0.5f, 0, 1},
                                                                               {-0.5f, 3, 0, 1},
                                                                               {-0.5f, 2, 0, 1},
                                                                               {-0.5f, 0.25f, 0, 1},
                                                                               {0.5f, 0.25f, 0, 1}}));
                                for (const uint32_t first : {2u, 3u}) {
                                  const Target target = make_target(run, {});
                                  const VkPipeline pipeline = make_pipeline(run, spec, target);
                                  run.once([&](VkCommandBuffer cmd) {
                                    target.begin(cmd);
                                    bind_pipeline(cmd, pipeline);
                                    bind_vertices(cmd, vertices);
                                    vkCmdDraw(cmd, 2, 1, 0, 0);
                                    vkCmdDraw(cmd, 6 - first, 1, first, 0);
                                    vkCmdEndRenderPass(cmd);
                                  });
                                  run.out("first_" + std::to_string(first), target.colors[0]);
                                }
                              });

VkPipelineRasterizationLineStateCreateInfoEXT line_state(Run& run, VkLineRasterizationModeEXT mode, bool stippled) {
  const auto& features = run.gpu.extension_features.line_rasterization;
  run.require(features.rectangularLines && features.smoothLines && features.stippledRectangularLines,
              "smooth and stippled lines");
  VkPipelineRasterizationLineStateCreateInfoEXT line{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
  line.lineRasterizationMode = mode;
  line.stippledLineEnable = stippled;
  line.lineStippleFactor = 1;
  line.lineStipplePattern = 0x00ff;
  return line;
}

/// The number is a flat integer, then a flat float.
const AddCase kStippleIntegers(
    "rasterization", "deviation.stipple_flat_integers", "stipple-flat-integers", case_against_control, [](Run& run) {
      const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT, true);
      for (const char* type : {"int", "float"}) {
        GraphicsSpec spec;
        spec.vertex = std::string("layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n") +
                      "layout(location = 0) flat out " + type + " number;\nvoid main() {\n  number = " + type +
                      "(color.x * 8.0);\n  gl_Position = position;\n}\n";
        spec.fragment = std::string("layout(location = 0) flat in ") + type +
                        " number;\nlayout(location = 0) out vec4 result;\n" +
                        "void main() { result = vec4(float(number) * 0.125); }\n";
        spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        spec.raster.pNext = &line;
        draw(run, type, {}, spec, colored({{-0.9f, -0.5f, 0, 1}, {0.9f, 0.5f, 0, 1}}));
      }
    });

/// The lines of a strip are 12 pixels long. The strip with adjacency has one more vertex at each end.
const AddCase kStipplePerLine("rasterization", "deviation.stipple_per_line", "stipple-per-line", case_against_control,
                              [](Run& run) {
                                const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT, true);
                                std::vector<float> values;
                                for (int i = 0; i < 6; ++i) {
                                  const float x = -0.75f + 0.375f * static_cast<float>(i - 1);
                                  for (const float v : {x, 0.25f, 0.5f, 1.0f, 0.5f, 0.25f, 0.75f, 1.0f})
                                    values.push_back(v);
                                }
                                for (const bool adjacent : {true, false}) {
                                  GraphicsSpec spec;
                                  spec.assembly.topology = adjacent ? VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY
                                                                    : VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
                                  spec.raster.pNext = &line;
                                  const auto end = values.end();
                                  draw(run, adjacent ? "adjacent" : "plain", {}, spec,
                                       adjacent ? values : std::vector<float>(values.begin() + 8, end - 8));
                                }
                              });

/// (1, 2, 3, 4) is written; the reference loses the 4.
const AddCase kSmoothIntegers(
    "rasterization", "deviation.smooth_line_integers", "smooth-line-integers",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) -> std::string {
      bool drawn = false;
      for (size_t at = 0; at < device[0].bytes.size(); at += 16) {
        const unsigned char *ours = &device[0].bytes[at], *theirs = &reference[0].bytes[at];
        if (std::memcmp(ours, theirs, 12) != 0) return "red, green or blue differ";
        if (ours[12] != (ours[0] != 0 ? 4 : 0)) return "the device's alpha is not the shader's";
        if (theirs[12] != 0) return "the reference's fault does not show";
        drawn |= ours[0] != 0;
      }
      return drawn ? "" : "nothing is drawn";
    },
    [](Run& run) {
      const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT, false);
      TargetSpec target_spec;
      target_spec.colors = {VK_FORMAT_R32G32B32A32_SINT};
      Target target = make_target(run, target_spec);
      target.clears[0] = {};
      GraphicsSpec spec;
      spec.vertex = kColorVertex;
      spec.fragment = "layout(location = 0) out ivec4 result;\nvoid main() { result = ivec4(1, 2, 3, 4); }\n";
      spec.floats({4, 4});
      spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      spec.raster.pNext = &line;
      const VkPipeline pipeline = make_pipeline(run, spec, target);
      const Buffer vertices = run.buffer_of(colored({{-0.9f, -0.5f, 0, 1}, {0.9f, 0.5f, 0, 1}}));
      run.once([&](VkCommandBuffer cmd) {
        target.begin(cmd);
        bind_pipeline(cmd, pipeline);
        bind_vertices(cmd, vertices);
        vkCmdDraw(cmd, 2, 1, 0, 0);
        vkCmdEndRenderPass(cmd);
      });
      run.out("color", target.colors[0]);
    });

/// Half of the pixels are kept: by gl_SampleMask, then by discarding the others.
const AddCase kSmoothMask("rasterization", "deviation.smooth_line_sample_mask", "smooth-line-sample-mask",
                          case_against_control, [](Run& run) {
                            const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT, false);
                            for (const char* keep : {"gl_SampleMask[0] = int(gl_FragCoord.x);",
                                                     "if ((int(gl_FragCoord.x) & 1) == 0) discard;"}) {
                              GraphicsSpec spec;
                              spec.fragment =
                                  std::string(
                                      "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n") +
                                  "void main() {\n  result = passed;\n  " + keep + "\n}\n";
                              spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
                              spec.raster.pNext = &line;
                              draw(run, keep, {}, spec, colored({{-0.9f, -0.5f, 0, 1}, {0.9f, 0.5f, 0, 1}}));
                            }
                          });

/// Sample 1 is masked away; the reference draws it as it draws sample 0.
const AddCase kLineMasks(
    "rasterization", "deviation.one_sample_line_masks", "one-sample-line-masks",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) -> std::string {
      const size_t sample = device[0].bytes.size() / 4;
      const unsigned char *ours = device[0].bytes.data(), *theirs = reference[0].bytes.data();
      for (const size_t s : {size_t{0}, size_t{2}, size_t{3}})
        if (std::memcmp(ours + s * sample, theirs + s * sample, sample) != 0) return "other samples differ";
      if (std::memcmp(theirs, theirs + sample, sample) != 0) return "the reference's fault does not show";
      for (size_t at = 0; at < sample; ++at)
        if (ours[sample + at] != ours[sample + at % 16]) return "the device draws sample 1";
      return "";
    },
    [](Run& run) {
      const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, false);
      TargetSpec target;
      target.samples = VK_SAMPLE_COUNT_4_BIT;
      GraphicsSpec spec;
      const VkSampleMask mask = 0xd;
      spec.multisample.pSampleMask = &mask;
      spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      spec.raster.pNext = &line;
      draw(run, "samples", target, spec, colored({{-0.9f, -0.5f, 0, 1}, {0.9f, 0.5f, 0, 1}}));
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
        run.once([&](VkCommandBuffer cmd) {
          target.begin(cmd);
          bind_pipeline(cmd, pipeline);
          vkCmdDraw(cmd, 3, 1, 0, 0);
          vkCmdEndRenderPass(cmd);
        });
        run.out(inverts ? "inverted" : "written", target.colors[0]);
        run.outputs.back().may_be_blank = true;
      }
    });

/// Outlines of triangles in two colours for their facing, behind a geometry shader and without one.
const AddCase kGeometryFacing(
    "geometry", "deviation.polygon_mode_facing", "geometry-polygon-facing", case_against_control, [](Run& run) {
      run.require(run.gpu.features.geometryShader, "geometry shaders");
      for (const bool geometry : {true, false}) {
        GraphicsSpec spec;
        if (geometry)
          spec.geometry =
              "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n"
              "layout(location = 0) in vec4 passed[];\nlayout(location = 0) out vec4 result;\n"
              "void main() {\n  for (int i = 0; i < 3; ++i) {\n    gl_Position = gl_in[i].gl_Position;\n"
              "    result = passed[i];\n    EmitVertex();\n  }\n}\n";
        spec.vertex = kColorVertex;
        spec.fragment =
            "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
            "void main() { result = gl_FrontFacing ? passed : passed.zyxw; }\n";
        spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
        draw(run, geometry ? "behind" : "without", {}, spec,
             colored({{-0.9f, -0.5f, 0, 1},
                      {0.9f, 0.5f, 0, 1},
                      {-0.5f, 0.8f, 0, 1},
                      {-0.9f, -0.2f, 0, 1},
                      {0.3f, 0.5f, 0, 1},
                      {0.5f, -0.8f, 0, 1}}));
      }
    });

/// The outline of a clipped triangle in layer 1.
const AddCase kClippedLayer(
    "clipping", "deviation.clipped_polygon_layer", "clipped-polygon-layer",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) -> std::string {
      const size_t layer = device[0].bytes.size() / 2;
      const auto blank = [&](const Output& output) {
        for (size_t at = 4; at < layer; ++at)
          if (output.bytes[at] != output.bytes[at % 4]) return false;
        return true;
      };
      if (!blank(device[0])) return "the device draws to layer 0";
      return blank(reference[0]) ? "the reference's fault does not show" : "";
    },
    [](Run& run) {
      run.require(run.gpu.has("VK_EXT_shader_viewport_index_layer"), "VK_EXT_shader_viewport_index_layer");
      TargetSpec target;
      target.layers = 2;
      GraphicsSpec spec;
      spec.vertex =
          "#extension GL_ARB_shader_viewport_layer_array : require\nlayout(location = 0) in vec4 position;\n"
          "layout(location = 1) in vec4 color;\nlayout(location = 0) out vec4 passed;\n"
          "void main() {\n  passed = color;\n  gl_Position = position;\n  gl_Layer = 1;\n}\n";
      spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
      draw(run, "layers", target, spec,
           colored({{-0.9f, -0.5f, 0.5f, 1}, {1.9f, 0.1f, 0.5f, 1}, {-0.5f, 1.8f, 0.5f, 1}}));
    });

/// Two draws of two instances each, all over each other; each instance has its own colour and moves a little.
const AddCase kMultiDraw("draw", "deviation.multi_draw_order", "multi-draw-order", case_against_control, [](Run& run) {
  run.require(run.gpu.extension_features.multi_draw.multiDraw, "multiDraw");
  GraphicsSpec spec;
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() {
  passed = color * (gl_InstanceIndex == 0 ? vec4(1.0) : vec4(0.5, 1.0, 0.25, 1.0));
  gl_Position = position + vec4(0.5, 0.25, 0.0, 0.0) * float(gl_InstanceIndex);
})";
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  const Buffer vertices = run.buffer_of(colored({{-0.5f, -0.5f, 0, 1},
                                                 {0.5f, -0.5f, 0, 1},
                                                 {-0.5f, 0.5f, 0, 1},
                                                 {0.5f, -0.25f, 0, 1},
                                                 {0.5f, 0.75f, 0, 1},
                                                 {-0.5f, 0.75f, 0, 1}}));
  const VkMultiDrawInfoEXT draws[2] = {{0, 3}, {3, 3}};
  for (const bool together : {true, false}) {
    const Target target = make_target(run, {});
    const VkPipeline pipeline = make_pipeline(run, spec, target);
    run.once([&](VkCommandBuffer cmd) {
      target.begin(cmd);
      bind_pipeline(cmd, pipeline);
      bind_vertices(cmd, vertices);
      if (together)
        CTS_COMMAND(run.gpu, CmdDrawMultiEXT)(cmd, 2, draws, 2, 0, sizeof draws[0]);
      else
        for (const VkMultiDrawInfoEXT& one : draws) vkCmdDraw(cmd, one.vertexCount, 2, one.firstVertex, 0);
      vkCmdEndRenderPass(cmd);
    });
    run.out(together ? "together" : "apart", target.colors[0]);
  }
});

/// The rectangle of the line reaches from y = 63.4 to 64.4.
const AddCase kLineTiles(
    "rasterization", "deviation.multisample_line_tiles", "multisample-line-tiles",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) {
      const size_t pitch = size_t{device[0].width} * 16;
      std::string message;
      for (uint32_t s = 0; s < 4; ++s)
        for (uint32_t y = 0; y < device[0].height; ++y) {
          const size_t at = (size_t{s} * device[0].height + y) * pitch;
          const bool same = std::memcmp(&device[0].bytes[at], &reference[0].bytes[at], pitch) == 0;
          const bool lost = y == 63 && s >= 2;
          if (same == lost) message = "sample " + std::to_string(s) + " of row " + std::to_string(y);
        }
      return message;
    },
    [](Run& run) {
      TargetSpec target;
      target.height = 128;
      target.samples = VK_SAMPLE_COUNT_4_BIT;
      target.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
      GraphicsSpec spec;
      spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      const float y = 63.9f / 64.0f - 1.0f;
      draw(run, "line", target, spec, colored({{-0.5f, y, 0.5f, 1}, {0.5f, y, 0.5f, 1}}));
    });

/// The depth that a line leaves in every sample.
const AddCase kLineDepth(
    "rasterization", "deviation.line_depth_first_sample", "line-depth-first-sample",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) {
      const auto sample = [](const Output& output, uint32_t s) {
        const size_t bytes = output.bytes.size() / output.layers;
        const auto begin = output.bytes.begin() + static_cast<std::ptrdiff_t>(bytes * s);
        return std::vector<unsigned char>(begin, begin + static_cast<std::ptrdiff_t>(bytes));
      };
      if (sample(device[0], 0) != sample(reference[0], 0)) return std::string("sample 0 differs");
      for (uint32_t s = 1; s < 4; ++s) {
        if (sample(device[0], s) != sample(device[0], 0)) return std::string("the device's samples differ");
        if (sample(reference[0], s) == sample(reference[0], 0))
          return std::string("the reference's fault does not show");
      }
      return std::string();
    },
    [](Run& run) {
      run.require(run.gpu.extension_features.line_rasterization.bresenhamLines, "bresenhamLines");
      TargetSpec target_spec;
      target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
      target_spec.depth = VK_FORMAT_D32_SFLOAT;
      const Target target = make_target(run, target_spec);
      VkPipelineRasterizationLineStateCreateInfoEXT line{
          VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
      line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
      GraphicsSpec spec;
      spec.vertex = kColorVertex;
      spec.fragment = kColorFragment;
      spec.floats({4, 4});
      spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
      spec.raster.pNext = &line;
      const VkPipeline pipeline = make_pipeline(run, spec, target);
      const Buffer vertices = run.buffer_of(colored({{-0.9f, 0.1f, 0.5f, 1}, {0.9f, 0.3f, 0.5f, 1}}));
      run.once([&](VkCommandBuffer cmd) {
        target.begin(cmd);
        bind_pipeline(cmd, pipeline);
        bind_vertices(cmd, vertices);
        vkCmdDraw(cmd, 2, 1, 0, 0);
        vkCmdEndRenderPass(cmd);
      });
      run.out("depth", *target.depth);
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

/// The same triangles, crossing the view volume, into BGRA8 with and without a depth attachment.
const AddCase kBgra("clipping", "deviation.bgra8_route", "bgra8-route", case_against_control, [](Run& run) {
  std::vector<float> values;
  for (int i = 0; i < 3 * 12; ++i) {
    const float w = run.random.real(0.7f, 1.4f);
    for (const float v : {run.random.real(-1.7f, 1.7f) * w, run.random.real(-1.7f, 1.7f) * w, 0.5f * w, w})
      values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(run.random.unit());
  }
  TargetSpec target;
  target.colors = {VK_FORMAT_B8G8R8A8_UNORM};
  target.width = target.height = 200;
  draw(run, "alone", target, {}, values);
  target.depth = VK_FORMAT_D32_SFLOAT;
  draw(run, "with_depth", target, {}, values);
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

/// Runs 64 invocations of `expression` over (int x, int y) pairs.
void integers(Run& run, const std::string& name, const std::string& statements, const std::vector<int32_t>& in,
              uint32_t group_size = 1) {
  const Buffer input = run.buffer_of(in), out = run.buffer(in.size() * 2);
  const Resources res = run.resources({storage_buffer(0, input), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(
      res.layout,
      run.shader(VK_SHADER_STAGE_COMPUTE_BIT, "layout(local_size_x = " + std::to_string(group_size) + R"() in;
layout(std430, binding = 0) buffer A { ivec2 a[]; };
layout(std430, binding = 1) buffer R { int r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  int x = a[id].x, y = a[id].y;
)" + statements + "\n}\n"));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, static_cast<uint32_t>(in.size() / 2 / group_size), 1, 1);
  });
  run.out(name, out, VK_FORMAT_R32_SINT);
}

const AddCase kModulo("glsl", "deviation.signed_modulo", "signed-modulo", case_against_control, [](Run& run) {
  const std::vector<int32_t> pairs = {-7, 3, 7, -3, -7, -3, 7, 3, -1, 5, 100, -7, 0, -4, -6, 3};
  integers(run, "smod", "  r[id] = x % y;", pairs);
  integers(run, "floored", "  int q = x / y; int m = x - q * y; r[id] = m != 0 && (m < 0) != (y < 0) ? m + y : m;",
           pairs);
});

const AddCase kBudget("glsl", "deviation.loop_budget", "loop-budget", case_against_control, [](Run& run) {
  integers(run, "long_loop", "  int n = 0;\n  for (int k = 0; k < x; ++k) n += (k ^ y) & 3;\n  r[id] = n + x;",
           {70000, 1, 10, 2});
  integers(
      run, "short_loops",
      "  int n = 0;\n  if (x > 60000) n = 105000; else for (int k = 0; k < x; ++k) n += (k ^ y) & 3;\n  r[id] = n + x;",
      {70000, 1, 10, 2});
});

/// A value that is computed anew in each iteration from one that the loop carries, read behind the loop.
const AddCase kLeavesLoop("glsl", "deviation.value_leaves_loop", "value-leaves-loop", case_against_control,
                          [](Run& run) {
                            const std::vector<int32_t> x = {4, 1, 3, 2, 1, 7, 2, -5, 9, 0, 1, 1, 5, 3, 6, 8};
                            integers(run, "loop",
                                     "  int n = y, m = 0, k = x;\n"
                                     "  do {\n    m = n * 3;\n    n += 5;\n  } while (--k > 0);\n  r[id] = m;",
                                     x, 8);
                            integers(run, "closed", "  r[id] = (y + 5 * (x - 1)) * 3;", x, 8);
                          });

/// A derivative of a value loaded from a storage buffer, at the edges of a triangle.
const AddCase kHelper("glsl", "deviation.helper_lane_loads", "helper-lane-loads", case_against_control, [](Run& run) {
  run.require(run.gpu.features.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
  TargetSpec target;
  target.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  std::vector<float> hundred(64 * 64, 100.0f);
  for (size_t i = 0; i < hundred.size(); ++i) hundred[i] += static_cast<float>(i % 64);
  const Buffer table = run.buffer_of(hundred);
  const Resources res = run.resources({storage_buffer(0, table)});
  for (const bool loaded : {true, false}) {
    const Target where = make_target(run, target);
    GraphicsSpec spec;
    spec.layout = res.layout;
    spec.vertex = kColorVertex;
    spec.fragment =
        std::string("layout(std430, binding = 0) readonly buffer T { float t[]; };\n") +
        "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n" + "void main() { float x = " +
        (loaded ? "t[uint(gl_FragCoord.y) * 64u + uint(gl_FragCoord.x)]" : "100.0 + floor(gl_FragCoord.x)") +
        "; result = vec4(dFdx(x), dFdy(x), x, 1.0); }\n";
    spec.floats({4, 4});
    const VkPipeline pipeline = make_pipeline(run, spec, where);
    const Buffer vertices = run.buffer_of(colored({{-0.8f, -0.7f, 0, 1}, {0.7f, -0.3f, 0, 1}, {-0.1f, 0.9f, 0, 1}}));
    run.once([&](VkCommandBuffer cmd) {
      where.begin(cmd);
      bind_pipeline(cmd, pipeline);
      res.bind(cmd);
      bind_vertices(cmd, vertices);
      vkCmdDraw(cmd, 3, 1, 0, 0);
      vkCmdEndRenderPass(cmd);
    });
    run.out(loaded ? "loaded" : "computed", where.colors[0]);
  }
});

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
    run.once([&](VkCommandBuffer cmd) {
      vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
      res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
      vkCmdDispatch(cmd, alone ? 512 : 64, 1, 1);
    });
    run.out(alone ? "alone" : "together", out, VK_FORMAT_R32G32B32A32_SFLOAT);
  }
}

const AddCase kFilters("texture", "deviation.mixed_filters", "mixed-filters", case_against_control,
                       [](Run& run) { neighbours(run, false); });
const AddCase kCorners("texture", "deviation.cube_corners", "cube-corners", case_against_control,
                       [](Run& run) { neighbours(run, true); });

}  // namespace
}  // namespace vitrine::cts
