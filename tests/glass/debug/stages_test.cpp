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

}  // namespace
}  // namespace vitrine::glass::debug::test
