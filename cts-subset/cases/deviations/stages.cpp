// Listed deviations of what comes from tessellation and geometry stages, and of distances.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

constexpr char kPlainVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
void main() { gl_Position = position; })";

/// Patches of `corners` points, all levels 1.
GraphicsSpec patches(uint32_t corners, const std::string& evaluation) {
  GraphicsSpec spec;
  spec.vertex = kPlainVertex;
  spec.control = "layout(vertices = " + std::to_string(corners) + R"() out;
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = 1.0;
  for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = 1.0;
})";
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
