// Listed deviations of draws, tessellation and geometry.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

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
                              run.require(run.gpu.extension_features.primitiveTopologyPatchListRestart,
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
  run.require(run.gpu.extension_features.multiDraw, "multiDraw");
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
