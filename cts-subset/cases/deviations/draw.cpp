// Listed deviations of draws, tessellation and geometry.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

/// Three patches in a row, coloured by their number: by the evaluation shader's, or by the fragment shader's, when the
/// evaluation shader may read it all the same.
enum class Numbered { kByEvaluation, kByFragment, kByFragmentReadBefore };
void draw_patches(Run& run, const std::string& name, bool restarts, Numbered numbered = Numbered::kByEvaluation) {
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
  spec.evaluation = std::string(R"(
layout(triangles, equal_spacing, cw) in;
layout(location = 0) out vec4 passed;
void main() {
  gl_Position = vec4(0.0);
  for (int i = 0; i < 3; ++i) gl_Position += gl_in[i].gl_Position * gl_TessCoord[i];
  passed = vec4(0.25 * float()") +
                    (numbered == Numbered::kByFragment ? "0" : "gl_PrimitiveID") + R"( + 1), 0.5, 0.5, 1.0);
})";
  spec.fragment = kColorFragment;
  if (numbered != Numbered::kByEvaluation)
    spec.fragment = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = vec4(0.25 * float(gl_PrimitiveID + 1), passed.yzw); })";
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

const AddCase kNumbersRead("tessellation", "deviation.primitive_id_read_before", "evaluation-primitive-id",
                           case_against_control, [](Run& run) {
                             draw_patches(run, "read_before", false, Numbered::kByFragmentReadBefore);
                             draw_patches(run, "not_read", false, Numbered::kByFragment);
                           });

/// Two quads, each in its half of the target: by a viewport of its own, and by its positions.
const AddCase kPatchViewports(
    "tessellation", "deviation.patch_viewports", "tessellated-viewport", case_against_control, [](Run& run) {
      run.require(run.gpu.has("VK_EXT_shader_viewport_index_layer"), "VK_EXT_shader_viewport_index_layer");
      for (const bool viewports : {true, false}) {
        GraphicsSpec spec;
        spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() {
  passed = color;
  gl_Position = position;
})";
        spec.control = R"(
layout(vertices = 4) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 point[];
void main() {
  point[gl_InvocationID] = passed[gl_InvocationID];
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  gl_TessLevelOuter = float[4](1.0, 1.0, 1.0, 1.0);
  gl_TessLevelInner = float[2](1.0, 1.0);
})";
        spec.evaluation = std::string(R"(#extension GL_ARB_shader_viewport_layer_array : require
layout(quads, equal_spacing, cw) in;
layout(location = 0) in vec4 point[];
layout(location = 0) out vec4 passed;
void main() {
  const int corner = int(gl_TessCoord.x) + 2 * int(gl_TessCoord.y);
  passed = point[corner];
  gl_Position = gl_in[corner].gl_Position;
)") +
                          (viewports ? "  gl_ViewportIndex = gl_PrimitiveID;\n"
                                     : "  gl_Position.x = gl_Position.x * 0.5 - 0.5 + float(gl_PrimitiveID);\n") +
                          "}\n";
        spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
        spec.tessellation.patchControlPoints = 4;
        spec.viewports = {{0, 0, 64, 64, 0, 1}};
        if (viewports) spec.viewports = {{0, 0, 32, 64, 0, 1}, {32, 0, 32, 64, 0, 1}};
        spec.scissors.assign(spec.viewports.size(), {{0, 0}, {64, 64}});
        std::vector<std::array<float, 4>> corners;
        for (int patch = 0; patch < 2; ++patch)
          for (int i = 0; i < 4; ++i)
            corners.push_back({i % 2 == 0 ? -0.75f : 0.5f, i < 2 ? -0.5f : 0.75f, 0.5f, 1.0f});
        draw(run, viewports ? "viewports" : "positions", {}, spec, colored(corners));
      }
    });

const AddCase kPatchNumbers("tessellation", "deviation.patch_numbers", "patch-numbers", case_against_control,
                            [](Run& run) {
                              run.require(run.gpu.extension_features.list_restart.primitiveTopologyPatchListRestart,
                                          "primitiveTopologyPatchListRestart");
                              draw_patches(run, "restarted", true);
                              draw_patches(run, "list", false);
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

}  // namespace
}  // namespace vitrine::cts
