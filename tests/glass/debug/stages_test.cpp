// The debugger stops shaders of every stage.
#include "tests/glass/debug/scripted.h"
#include "tests/glass/scene.h"

namespace vitrine::glass::debug::test {
namespace {

std::string session(VkShaderStageFlagBits stage, std::vector<std::string> lines, const std::string& shader) {
  std::string log;
  const auto module = vitrine::test::compile_glsl(stage, shader, vitrine::test::VulkanVersion::k12, log,
                                                  vitrine::test::DebugInfo::kNonSemantic);
  EXPECT_FALSE(module.empty()) << log;
  ScriptedDebugger debugger(std::move(lines));
  glass::test::Scene scene;
  scene.run(*debugger.tool, stage, module);
  return debugger.script.text();
}

void expect_in_order(const std::string& text, const std::vector<std::string>& parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    const std::size_t found = text.find(part, at);
    ASSERT_NE(found, std::string::npos) << "'" << part << "' is missing behind " << at << " in\n" << text;
    at = found + part.size();
  }
}

TEST(DebuggerStages, Vertex) {
  expect_in_order(
      session(VK_SHADER_STAGE_VERTEX_BIT,
              {"break vertex 5", "run", "step", "print x", "step", "print gl_Position", "back", "print x * 2.0"},
              R"(#version 460
void main() {
  float x = float(gl_VertexIndex) * 0.25;
  gl_PointSize = 1.0;
  gl_Position = vec4(x, 0.0, 0.5, 1.0);
})"),
      {"breakpoint 1: vertex 5", "vertex 5 of instance 0", "main at shader.glsl:3", "main at shader.glsl:4", "x = 1.25",
       "main at shader.glsl:5", "<no value>", "main at shader.glsl:4", "x * 2.0 = 2.5"});
}

TEST(DebuggerStages, Fragment) {
  expect_in_order(
      session(VK_SHADER_STAGE_FRAGMENT_BIT,
              {"break pixel 6,0", "run", "next", "print x", "next", "print color", "break shade", "continue"},
              R"(#version 460
layout(location = 0) out vec4 color;
float shade(float x) {
  return x * 2.0;
}
void main() {
  float x = gl_FragCoord.x;
  color = vec4(shade(x), 0.0, 0.0, 1.0);
  if (x > 4.0) color.y = 1.0;
})"),
      {"breakpoint 1: pixel 6,0", "pixel (6, 0)", "main at shader.glsl:7", "main at shader.glsl:8", "x = 6.5",
       "main at shader.glsl:9", "color = (13.0, 0.0, 0.0, 1.0)"});
}

TEST(DebuggerStages, FragmentFunction) {
  expect_in_order(
      session(VK_SHADER_STAGE_FRAGMENT_BIT, {"break shade if x > 3.0", "run", "backtrace", "finish"}, R"(#version 460
layout(location = 0) out vec4 color;
float shade(float x) {
  return x * 2.0;
}
void main() {
  color = vec4(shade(gl_FragCoord.x));
})"),
      {"pixel (", "shade at shader.glsl:4", "#0 shade at shader.glsl:4", "#1 main at shader.glsl:7",
       "main at shader.glsl:7"});
}

TEST(DebuggerStages, Geometry) {
  expect_in_order(session(VK_SHADER_STAGE_GEOMETRY_BIT, {"break main", "run", "step", "print y"}, R"(#version 460
layout(points) in;
layout(points, max_vertices = 1) out;
void main() {
  float y = gl_in[0].gl_Position.y + 1.0;
  gl_Position = vec4(y, 0.0, 0.5, 1.0);
  EmitVertex();
})"),
                  {"main at shader.glsl:5", "main at shader.glsl:6", "y = "});
}

TEST(DebuggerStages, TessellationControl) {
  expect_in_order(
      session(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, {"break main", "run", "step", "print n @lanes"}, R"(#version 460
layout(vertices = 8) out;
void main() {
  int n = gl_InvocationID + 1;
  gl_out[gl_InvocationID].gl_Position = vec4(float(n));
  gl_TessLevelOuter[0] = 1.0;
  gl_TessLevelOuter[1] = 7.0;
})"),
      {"main at shader.glsl:4", "main at shader.glsl:5", "lane  invocation", "  8\n"});
}

TEST(DebuggerStages, TessellationEvaluation) {
  expect_in_order(
      session(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, {"break main", "run", "step", "print u"}, R"(#version 460
layout(isolines) in;
void main() {
  float u = gl_TessCoord.x * 7.0;
  gl_Position = vec4(u);
})"),
      {"main at shader.glsl:4", "main at shader.glsl:5", "u = "});
}

TEST(DebuggerStages, Texels) {
  expect_in_order(session(VK_SHADER_STAGE_COMPUTE_BIT,
                          {"break 9 if l == 0u",
                           "run",
                           "print imageLoad(picture, 1, 2)",
                           "print imageLoad(picture, ivec2(1, 2)).x",
                           "print imageLoad(layers, 1, 2, 1)",
                           "print texelFetch(flats, ivec2(3, 3), 0)",
                           "print texelFetch(texels, 2)",
                           "print imageLoad(many[1], 0, 0)",
                           "print imageLoad(many[2], 0, 0)",
                           "print imageLoad(picture, 4, 0)",
                           "print imageLoad(l, 0)",
                           "watch imageLoad(picture, 1, 2)",
                           "watch imageLoad(layers, 2, 2, 1)",
                           "whowrote imageLoad(picture, 1, 2)",
                           "continue",
                           "whowrote imageLoad(picture, 1, 2)",
                           "set imageLoad(picture, 1, 2) = uvec4(3)",
                           "print picture[1, 2]",
                           "set picture[ivec2(1, 2)] = 51",
                           "print picture",
                           "print many",
                           "print layers",
                           "set picture[4, 0] = 1",
                           "set picture = 1",
                           "set picture[1, 2] = {1, 2, 3, 4, 5}",
                           "set l[1, 2] = 5",
                           "set picture[3, 3] = {700, 1}",
                           "continue",
                           "reverse-continue",
                           "print imageLoad(layers, 2, 2, 1)",
                           "print imageLoad(picture, 1, 2)"},
                          R"(#version 460
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 4) in;
layout(set = 0, binding = 2, r32ui) uniform uimage2D picture; layout(set = 0, binding = 3, r32ui) uniform uimage2DArray layers;
layout(set = 0, binding = 1) uniform utexture2D flats; layout(set = 0, binding = 4, r32ui) uniform uimageBuffer texels;
layout(set = 0, binding = 6, r32ui) uniform uimage2D many[3];
void main() {
  uint l = gl_LocalInvocationIndex;
  imageStore(picture, ivec2(int(l), 2), uvec4(50u + l));
  imageAtomicAdd(layers, ivec3(2, int(l), 1), 7u);
  l += texelFetch(flats, ivec2(0), 0).x + imageLoad(texels, 1).x + imageLoad(many[l & 1u], ivec2(0)).x;
  imageStore(picture, ivec2(0), uvec4(l));
})"),
                  {"main at shader.glsl:9",
                   "imageLoad(picture, 1, 2) = (",
                   "imageLoad(picture, ivec2(1, 2)).x = ",
                   "imageLoad(layers, 1, 2, 1) = (",
                   "texelFetch(flats, ivec2(3, 3), 0) = (",
                   "texelFetch(texels, 2) = (",
                   "imageLoad(many[1], 0, 0) = (",
                   "no such texel",
                   "no such texel",
                   "that is no image",
                   "watch 2: imageLoad(picture, 1, 2)",
                   "watch 3",
                   "nothing that is recorded",
                   "watch 2: imageLoad(picture, 1, 2) has changed: (",
                   "-> (51, 0, 0, 1)",
                   "main at shader.glsl:9",
                   "was written at shader.glsl:9 by invocation (1, 0, 0)",
                   "imageLoad(picture, 1, 2) = (3, 0, 0, 1)",
                   "picture[1, 2] = (3, 0, 0, 1)",
                   "picture[ivec2(1, 2)] = (51, 0, 0, 1)",
                   "picture = R32_UINT, 4 x 4 {{(",
                   "(50, 0, 0, 1), (51, 0, 0, 1), (52, 0, 0, 1)",
                   "many = {R32_UINT, 4 x 4 {{(",
                   ", <image or sampler>}\n",
                   "layers = R32_UINT, 4 x 4 x 2 {{{(",
                   "no such texel",
                   "images and arrays of bindings cannot be set",
                   "one to four numbers",
                   "texels of images have several indices",
                   "picture[3, 3] = (700, 0, 0, 1)",
                   "watch 3: imageLoad(layers, 2, 2, 1) has changed",
                   "main at shader.glsl:10",
                   "watch 2",
                   "imageLoad(layers, 2, 2, 1) = (",
                   "imageLoad(picture, 1, 2) = (51, 0, 0, 1)"});
}

}  // namespace
}  // namespace vitrine::glass::debug::test
