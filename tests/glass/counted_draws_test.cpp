// Draws whose shaders are counted without being run, or are told of by the tile: the numbers of draws that take the
// general path.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/glass/scene.h"

namespace vitrine::glass::test {
namespace {

constexpr std::uint32_t kSide = 96;  // a tile and parts of three

constexpr char kLayers[] = R"(#version 460
layout(location = 0) out vec2 at;
void main() {
  at = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1 & 1);
  float size = gl_InstanceIndex == 1 ? 1.3 : 4.0;
  gl_Position = vec4(size * at - 1.0, 0.5 + 0.1 * float(gl_InstanceIndex % 3), 1.0);
})";
constexpr char kConstant[] = R"(#version 460
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); })";
constexpr char kStraight[] = R"(#version 460
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 color;
void main() { color = vec4(at * 3.0, dFdx(at.x), 1.0); })";
constexpr char kBranching[] = R"(#version 460
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 color;
void main() {
  color = vec4(0.0);
  for (float x = at.x; x < 0.5; x += 0.1) color.x += at.y;
})";

std::unique_ptr<spirv::Shader> compile(VkShaderStageFlagBits stage, const char* text, Tool* tool) {
  std::string log;
  const auto module = vitrine::test::compile_glsl(stage, text, vitrine::test::VulkanVersion::k12, log);
  EXPECT_FALSE(module.empty()) << log;
  spirv::CompileOptions options;
  options.stage = stage;
  if (tool != nullptr) options.observer = std::make_shared<ToolObserver>(*tool, ShaderIdentity{stage, "main", module});
  auto shader = spirv::compile(module, options);
  EXPECT_TRUE(shader) << shader.message();
  return shader ? std::move(shader.value()) : nullptr;
}

struct Drawn {
  nlohmann::json counts;
  std::vector<std::byte> pixels;
};

/// Five layers of a fragment shader, the nearest of which comes first and fourth; all counted.
Drawn draw(const char* fragment, bool depth, bool general) {
  const auto file = std::filesystem::temp_directory_path() / ("vitrine-drawn-" + std::to_string(::getpid()) + ".json");
  ::setenv("VITRINE_COUNTS", file.c_str(), 1);
  const auto tool = make_count();
  Drawn drawn{{}, std::vector<std::byte>(std::size_t{kSide} * kSide * 4)};
  std::vector<float> depths(std::size_t{kSide} * kSide, 1.0f);
  const auto vertex_shader = compile(VK_SHADER_STAGE_VERTEX_BIT, kLayers, nullptr);
  const auto fragment_shader = compile(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, tool.get());
  if (!vertex_shader || !fragment_shader) return drawn;
  const auto view = [](VkFormat format, void* memory) {
    texel::ImageView view;
    view.base = static_cast<std::byte*>(memory);
    view.format = &texel::format_desc(format);
    view.level[0].extent = {kSide, kSide, 1};
    view.level[0].row_pitch = std::uint64_t{kSide} * 4;
    return view;
  };
  SceneCommand command;
  raster::State state;
  state.depth_test = state.depth_write = depth;
  state.depth_compare = VK_COMPARE_OP_LESS;
  state.viewport[0] = {0, 0, kSide, kSide, 0, 1};
  state.scissor[0] = {{0, 0}, {kSide, kSide}};
  spirv::Fault fault;
  raster::DrawCall call;
  call.state = &state;
  call.vertex = vertex_shader.get();
  call.fragment = fragment_shader.get();
  call.vertex_resources.command = call.fragment_resources.command = &command;
  call.fault = &fault;
  call.count = 3;
  call.instance_count = 5;
  call.observer = tool->draws();
  call.general_path = general;
  raster::PassDesc desc;
  desc.color[0] = view(VK_FORMAT_R8G8B8A8_UNORM, drawn.pixels.data());
  desc.color_count = 1;
  if (depth) desc.depth = view(VK_FORMAT_D32_SFLOAT, depths.data());
  desc.render_area = {{0, 0}, {kSide, kSide}};
  {
    raster::Pass pass(desc);
    pass.draw(call);
    pass.flush();
  }
  tool->write();
  std::ifstream(file) >> drawn.counts;
  std::filesystem::remove(file);
  return drawn;
}

TEST(CountedDraws, HaveTheNumbersOfTheGeneralPath) {
  for (const char* fragment : {kConstant, kStraight, kBranching})
    for (const bool depth : {false, true}) {
      const Drawn fast = draw(fragment, depth, false), general = draw(fragment, depth, true);
      EXPECT_EQ(fast.counts, general.counts) << fragment << depth;
      EXPECT_EQ(fast.pixels, general.pixels) << fragment << depth;
      const auto& total = fast.counts["total"];
      const auto generated = total["fragments"]["generated"].get<std::uint32_t>();
      EXPECT_GT(generated, 4 * kSide * kSide);
      EXPECT_EQ(total["invocations"], total["shading"]["invocations"]);
      EXPECT_EQ(total["invocations"], total["fragments"]["passed"]);
      EXPECT_EQ(total["fragments"]["passed"], depth ? kSide * kSide : generated);
    }
}

}  // namespace
}  // namespace vitrine::glass::test
