// Listed deviations of what comes from tessellation and geometry stages, and of distances.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

constexpr char kPlainVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
void main() { gl_Position = position; })";

/// Patches of `corners` points, all levels the same.
GraphicsSpec patches(uint32_t corners, const std::string& evaluation, const std::string& level = "1.0") {
  GraphicsSpec spec;
  spec.vertex = kPlainVertex;
  spec.control = "layout(vertices = " + std::to_string(corners) + R"() out;
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = )" +
                 level + ";\n  for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = " + level + ";\n}\n";
  spec.evaluation = evaluation;
  spec.fragment = "layout(location = 0) out vec4 result;\nvoid main() { result = vec4(1.0, 0.5, 0.25, 1.0); }\n";
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  spec.tessellation.patchControlPoints = corners;
  return spec;
}

constexpr char kQuadPosition[] =
    "gl_Position = mix(mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x),\n"
    "                  mix(gl_in[3].gl_Position, gl_in[2].gl_Position, gl_TessCoord.x), gl_TessCoord.y);\n";

/// Two squares, one per viewport: each a patch with four vertices, then each as two patches with three.
const AddCase kViewports(
    "tessellation", "deviation.tessellated_viewports", "tessellated-viewports", case_against_control, [](Run& run) {
      run.require(run.gpu.features.tessellationShader && run.gpu.has("VK_EXT_shader_viewport_index_layer"),
                  "tessellation, VK_EXT_shader_viewport_index_layer");
      const std::string head = "#extension GL_ARB_shader_viewport_layer_array : require\n";
      GraphicsSpec spec = patches(
          4, head + "layout(quads) in;\nvoid main() {\n  gl_ViewportIndex = gl_PrimitiveID;\n" + kQuadPosition + "}\n");
      spec.viewports = {{0, 0, 32, 32, 0, 1}, {32, 32, 32, 32, 0, 1}};
      spec.scissors = {{{0, 0}, {64, 64}}, {{0, 0}, {64, 64}}};
      const std::array<float, 4> a{-0.5f, -0.5f, 0, 1}, b{0.5f, -0.5f, 0, 1}, c{0.5f, 0.5f, 0, 1}, d{-0.5f, 0.5f, 0, 1};
      draw(run, "quads", {}, spec, colored({a, b, c, d, a, b, c, d}));
      GraphicsSpec control = patches(3, head + R"(layout(triangles) in;
void main() {
  gl_ViewportIndex = gl_PrimitiveID / 2;
  gl_Position = gl_in[0].gl_Position * gl_TessCoord.x + gl_in[1].gl_Position * gl_TessCoord.y +
                gl_in[2].gl_Position * gl_TessCoord.z;
}
)");
      control.viewports = spec.viewports;
      control.scissors = spec.scissors;
      draw(run, "triangles", {}, control, colored({a, b, c, a, c, d, a, b, c, a, c, d}));
    });

/// Corners of 18 squares, each of which becomes 4,225 vertices at levels of 64.
std::vector<std::array<float, 4>> eighteen_squares() {
  std::vector<std::array<float, 4>> corners;
  for (int i = 0; i < 18; ++i) {
    const float x = -0.95f + 0.32f * static_cast<float>(i % 6), y = -0.9f + 0.6f * static_cast<float>(i / 6);
    corners.insert(corners.end(),
                   {{x, y, 0, 1}, {x + 0.28f, y, 0, 1}, {x + 0.3f, y + 0.5f, 0, 1}, {x, y + 0.5f, 0, 1}});
  }
  return corners;
}

/// 76,050 vertices in one draw, then in two.
const AddCase kManyVertices("tessellation", "deviation.tessellated_vertices", "tessellated-vertices",
                            case_against_control, [](Run& run) {
                              run.require(run.gpu.features.tessellationShader, "tessellation");
                              GraphicsSpec spec = patches(
                                  4, std::string("layout(quads) in;\nvoid main() {\n") + kQuadPosition + "}\n", "64.0");
                              spec.floats({4, 4});
                              const Buffer vertices = run.buffer_of(colored(eighteen_squares()));
                              for (const uint32_t first : {72u, 36u}) {
                                const Target target = make_target(run, {});
                                const VkPipeline pipeline = make_pipeline(run, spec, target);
                                run.once([&](VkCommandBuffer cmd) {
                                  target.begin(cmd);
                                  bind_pipeline(cmd, pipeline);
                                  bind_vertices(cmd, vertices);
                                  vkCmdDraw(cmd, first, 1, 0, 0);
                                  if (first < 72) vkCmdDraw(cmd, 72 - first, 1, first, 0);
                                  vkCmdEndRenderPass(cmd);
                                });
                                run.out(first == 72 ? "one_draw" : "two_draws", target.colors[0]);
                              }
                            });

/// The second patch's number in its fragments: the built-in, then a varying.
const AddCase kNumbers(
    "tessellation", "deviation.primitive_id", "tessellation-primitive-id", case_against_control, [](Run& run) {
      run.require(run.gpu.features.tessellationShader && run.gpu.features.geometryShader,
                  "tessellation, gl_PrimitiveID in fragment shaders");
      GraphicsSpec spec = patches(4, std::string("layout(quads) in;\nlayout(location = 0) flat out int number;\n") +
                                         "void main() {\n  number = gl_PrimitiveID;\n" + kQuadPosition + "}\n");
      const std::vector<float> values = colored({{-0.9f, -0.5f, 0, 1},
                                                 {-0.1f, -0.5f, 0, 1},
                                                 {-0.1f, 0.5f, 0, 1},
                                                 {-0.9f, 0.5f, 0, 1},
                                                 {0.1f, -0.5f, 0, 1},
                                                 {0.9f, -0.5f, 0, 1},
                                                 {0.9f, 0.5f, 0, 1},
                                                 {0.1f, 0.5f, 0, 1}});
      for (const char* source : {"gl_PrimitiveID", "number"}) {
        spec.fragment =
            std::string("layout(location = 0) flat in int number;\nlayout(location = 0) out vec4 result;\n") +
            "void main() { result = vec4(float(" + source + ") * 0.5 + 0.25); }\n";
        draw(run, source, {}, spec, values);
      }
    });

/// A triangle inside of all distances, of which there are five, then four.
const AddCase kDistances("clipping", "deviation.cull_distances_beyond_four", "cull-distances-beyond-four",
                         case_against_control, [](Run& run) {
                           run.require(run.gpu.features.shaderClipDistance && run.gpu.features.shaderCullDistance,
                                       "distances");
                           for (const int clips : {3, 2}) {
                             GraphicsSpec spec;
                             spec.vertex =
                                 "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n"
                                 "layout(location = 0) out vec4 passed;\n"
                                 "out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[" +
                                 std::to_string(clips) + "]; float gl_CullDistance[2]; };\n" +
                                 "void main() {\n  passed = color;\n  gl_Position = position;\n  for (int i = 0; i < " +
                                 std::to_string(clips) +
                                 "; ++i) gl_ClipDistance[i] = color.y;\n"
                                 "  gl_CullDistance[0] = gl_CullDistance[1] = color.y;\n}\n";
                             draw(run, std::to_string(clips), {}, spec,
                                  colored({{-0.7f, -0.7f, 0, 1}, {0.7f, -0.5f, 0, 1}, {0, 0.7f, 0, 1}}));
                           }
                         });

}  // namespace
}  // namespace vitrine::cts
