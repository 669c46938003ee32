// Listed deviations of lines.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

/// Empty if the outputs differ in samples 2 and 3 of a row, and nowhere else.
std::string loses_lower_samples(const Output& device, const Output& reference, uint32_t row) {
  const size_t pitch = size_t{device.width} * 16;
  for (uint32_t s = 0; s < 4; ++s)
    for (uint32_t y = 0; y < device.height; ++y) {
      const size_t at = (size_t{s} * device.height + y) * pitch;
      const bool same = std::memcmp(&device.bytes[at], &reference.bytes[at], pitch) == 0;
      const bool lost = y == row && s >= 2;
      if (same == lost) return "sample " + std::to_string(s) + " of row " + std::to_string(y);
    }
  return {};
}

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

/// The diamond rule ends the vertical edge at y = 21, at the edge of the pixel in whose diamond its end lies.
const AddCase kShortOutline(
    "rasterization", "deviation.multisample_short_outlines", "multisample-short-lines",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) {
      return loses_lower_samples(device[0], reference[0], 20);
    },
    [](Run& run) {
      run.require(run.gpu.extension_features.bresenhamLines, "bresenhamLines");
      TargetSpec target;
      target.samples = VK_SAMPLE_COUNT_4_BIT;
      target.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
      VkPipelineRasterizationLineStateCreateInfoEXT line{
          VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
      line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
      GraphicsSpec spec;
      spec.raster.pNext = &line;
      spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
      spec.raster.lineWidth = 5.0f;
      const auto at = [](float x, float y) {
        return std::array<float, 4>{x / 32.0f - 1.0f, y / 32.0f - 1.0f, 0.5f, 1.0f};
      };
      draw(run, "outline", target, spec, colored({at(16.5f, 20.4f), at(16.5f, 21.6f), at(50.0f, 21.0f)}));
    });

/// A strip after a line: with its first line outside of the volume, and without that line.
const AddCase kStippleCounter("rasterization", "deviation.stipple_counter", "stipple-counter", case_against_control,
                              [](Run& run) {
                                run.require(run.gpu.extension_features.stippledRectangularLines,
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
  const auto& features = run.gpu.extension_features;
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

/// What gl_SampleMaskIn has of four samples that are all covered; the control has it written out.
const AddCase kLineMaskIn(
    "rasterization", "deviation.one_sample_line_mask_in", "one-sample-line-masks",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) {
      std::string message = device.size() == 4 ? "" : "outputs are missing";
      for (size_t at = 0; at + 1 < device.size() && message.empty(); at += 2)
        message = case_against_control({device[at], device[at + 1]}, {reference[at], reference[at + 1]});
      return message;
    },
    [](Run& run) {
      for (const auto mode :
           {VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT})
        for (const char* mask : {"gl_SampleMaskIn[0]", "15"}) {
          const auto line = line_state(run, mode, false);
          TargetSpec target;
          target.samples = VK_SAMPLE_COUNT_4_BIT;
          GraphicsSpec spec;
          spec.fragment = std::string("layout(location = 0) out vec4 result;\nvoid main() { result = vec4(float(") +
                          mask + "), 2.0, 3.0, 1.0) / 15.0; }\n";
          spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
          spec.raster.pNext = &line;
          const char* name = mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT ? "bresenham " : "smooth ";
          draw(run, name + std::string(mask), target, spec, colored({{-0.9f, -0.5f, 0, 1}, {0.9f, 0.5f, 0, 1}}));
        }
    });

/// The smooth outline of a back-facing triangle.
const AddCase kSmoothFacing(
    "rasterization", "deviation.smooth_outline_facing", "smooth-outline-facing", case_against_control, [](Run& run) {
      run.require(run.gpu.features.fillModeNonSolid, "fillModeNonSolid");
      const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT, false);
      for (const char* front : {"gl_FrontFacing", "false"}) {
        GraphicsSpec spec;
        spec.fragment = std::string("layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n") +
                        "void main() { result = " + front + " ? vec4(1.0) : passed; }\n";
        spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
        spec.raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
        spec.raster.pNext = &line;
        draw(run, front, {}, spec, colored({{-0.7f, -0.7f, 0, 1}, {0.7f, -0.5f, 0, 1}, {0, 0.7f, 0, 1}}));
      }
    });

/// Depth 1.25 and 0.75 in a viewport that reaches to 0.75.
const AddCase kSmoothClamp(
    "rasterization", "deviation.smooth_line_depth_clamp", "smooth-line-depth-clamp", case_against_control,
    [](Run& run) {
      run.require(run.gpu.features.depthClamp, "depthClamp");
      const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT, false);
      for (const float z : {2.0f, 1.0f}) {
        TargetSpec target;
        target.depth = VK_FORMAT_D32_SFLOAT;
        GraphicsSpec spec;
        spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        spec.raster.pNext = &line;
        spec.raster.depthClampEnable = VK_TRUE;
        spec.depth.depthTestEnable = VK_TRUE;
        spec.depth.depthCompareOp = VK_COMPARE_OP_LESS;
        spec.viewports = {{0, 0, 64, 64, 0.25f, 0.75f}};
        draw(run, "z_" + std::to_string(z), target, spec, colored({{-0.9f, -0.5f, z, 1}, {0.9f, 0.5f, z, 1}}));
      }
    });

/// Two instances of smooth lines, behind a geometry shader and without one.
const AddCase kSmoothVertices(
    "geometry", "deviation.smooth_line_vertices", "smooth-line-vertices", case_against_control, [](Run& run) {
      run.require(run.gpu.features.geometryShader, "geometryShader");
      const auto line = line_state(run, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT, false);
      const Buffer vertices = run.buffer_of(colored(
          {{-0.9f, -0.5f, 0, 1}, {0.9f, 0.3f, 0, 1}, {-0.8f, 0.4f, 0, 1}, {0.7f, -0.6f, 0, 1}, {0, 0.7f, 0, 1}}));
      for (const bool geometry : {true, false}) {
        const Target target = make_target(run, {});
        GraphicsSpec spec;
        spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() { passed = color; gl_Position = position + vec4(0.0, 0.2, 0.0, 0.0) * float(gl_InstanceIndex); })";
        if (geometry)
          spec.geometry = R"(
layout(lines) in;
layout(line_strip, max_vertices = 2) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 passed;
void main() {
  for (int i = 0; i < 2; ++i) {
    passed = color[i];
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
})";
        spec.fragment = kColorFragment;
        spec.floats({4, 4});
        spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
        spec.raster.pNext = &line;
        const VkPipeline pipeline = make_pipeline(run, spec, target);
        run.once([&](VkCommandBuffer cmd) {
          target.begin(cmd);
          bind_pipeline(cmd, pipeline);
          bind_vertices(cmd, vertices);
          vkCmdDraw(cmd, 5, 2, 0, 0);
          vkCmdEndRenderPass(cmd);
        });
        run.out(geometry ? "geometry" : "vertex", target.colors[0]);
      }
    });

/// The rectangle of the line reaches from y = 63.4 to 64.4.
const AddCase kLineTiles(
    "rasterization", "deviation.multisample_line_tiles", "multisample-line-tiles",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) {
      return loses_lower_samples(device[0], reference[0], 63);
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
      run.require(run.gpu.extension_features.bresenhamLines, "bresenhamLines");
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

}  // namespace
}  // namespace vitrine::cts
