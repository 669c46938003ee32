// VK_EXT_shader_object: draws by shader objects leave the bytes that pipelines leave. (All of the suite, drawn so:
// cts-subset/compare_layer.py.)
#include <atomic>
#include <cstring>
#include <mutex>
#include <thread>

#include "icd/object/device.h"
#include "icd/object/shader_object.h"
#include "tests/icd/shader_objects_fixture.h"

#ifdef VK_EXT_shader_object
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using ShaderObjectDraws = ShaderObjectDevice;

constexpr VkShaderStageFlagBits kVertexStage = VK_SHADER_STAGE_VERTEX_BIT,
                                kControlStage = VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                                kEvaluationStage = VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
                                kGeometryStage = VK_SHADER_STAGE_GEOMETRY_BIT,
                                kFragmentStage = VK_SHADER_STAGE_FRAGMENT_BIT;

const std::string kVertex =
    "layout(push_constant) uniform P { vec4 push; };\n"
    "layout(location = 0) out vec4 a;\n"
    "layout(location = 3) out vec2 unread;\n"
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);\n"
    "  a = vec4(p, push.x, push.y + 0.3 * gl_InstanceIndex); unread = p;\n"
    "  gl_Position = vec4(p * 3 - 1 - 0.2 * gl_InstanceIndex, 0.4 + 0.2 * p.x - 0.1 * gl_InstanceIndex, 1);\n"
    "}\n";
const std::string kControl =
    "layout(vertices = 3) out;\n"
    "layout(location = 0) in vec4 a[];\n"
    "layout(location = 0) out vec4 b[];\n"
    "void main() {\n"
    "  b[gl_InvocationID] = a[gl_InvocationID].yxzw;\n"
    "  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
    "  gl_TessLevelOuter[0] = 3; gl_TessLevelOuter[1] = 4.5; gl_TessLevelOuter[2] = 2; gl_TessLevelInner[0] = 3;\n"
    "}\n";
const std::string kEvaluation =
    "layout(triangles, fractional_odd_spacing, ccw) in;\n"
    "layout(location = 0) in vec4 b[];\n"
    "layout(location = 0) out vec4 a;\n"
    "void main() {\n"
    "  vec3 t = gl_TessCoord;\n"
    "  a = t.x * b[0] + t.y * b[1] + t.z * b[2] + vec4(0, 0, 0.1 * fract(7 * t.x), 0);\n"
    "  gl_Position = t.x * gl_in[0].gl_Position + t.y * gl_in[1].gl_Position + t.z * gl_in[2].gl_Position;\n"
    "}\n";
const std::string kGeometry =
    "layout(triangles) in;\n"
    "layout(triangle_strip, max_vertices = 6) out;\n"
    "layout(location = 0) in vec4 a[];\n"
    "layout(location = 0) out vec4 c;\n"
    "void main() {\n"
    "  for (int k = 0; k < 2; ++k) {\n"
    "    for (int i = 0; i < 3; ++i) {\n"
    "      c = a[i].wzyx;\n"
    "      gl_Position = gl_in[i].gl_Position * vec4(k == 0 ? 0.6 : -0.4, 0.7, 1, 1);\n"
    "      EmitVertex();\n"
    "    }\n"
    "    EndPrimitive();\n"
    "  }\n"
    "}\n";
const std::string kFragment =
    "layout(location = 0) in vec4 a;\n"
    "layout(location = 0) out vec4 first;\n"
    "void main() { first = a * vec4(1, 2, 3, 0.5) + sin(a.xxxx * 9) * 0.2; }\n";
const std::string kThreeOutputs =
    "layout(location = 0) in vec4 a;\n"
    "layout(location = 0) out vec4 first;\n"
    "layout(location = 1) out vec4 second;\n"
    "layout(location = 2) out vec4 third;\n"
    "layout(set = 0, binding = 0) buffer B { uint count; };\n"
    "void main() {\n"
    "  vec4 x = a * a + 0.3; first = x * 0.7 + a; second = sqrt(x) * x; third = exp(-x) + first; atomicAdd(count, 1);\n"
    "}\n";

TEST_F(ShaderObjectDraws, EachCombinationOfStages) {
  for (const bool tessellates : {false, true})
    for (const bool has_geometry : {false, true})
      for (const bool has_fragment : {true, false}) {
        Picture2D picture;
        picture.stages[kVertexStage] = kVertex;
        if (tessellates) {
          picture.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
          picture.stages[kControlStage] = kControl;
          picture.stages[kEvaluationStage] = kEvaluation;
        }
        if (has_geometry) picture.stages[kGeometryStage] = kGeometry;
        if (has_fragment) picture.stages[kFragmentStage] = kFragment;
        picture.depth = true;
        if (!has_fragment) picture.colors = {};
        SCOPED_TRACE(std::string(tessellates ? "tessellated " : "") + (has_geometry ? "with geometry " : "") +
                     (has_fragment ? "" : "without fragments"));
        expect_same(picture);
      }
}

/// As with pipelines, outputs without an attachment are no part of the fragment shader.
TEST_F(ShaderObjectDraws, EachChoiceOfAttachments) {
  constexpr VkFormat kFormats[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16_SFLOAT};
  for (std::uint32_t mask = 1; mask < 8; ++mask) {
    Picture2D picture;
    picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kThreeOutputs}};
    picture.colors.clear();
    for (std::uint32_t i = 0; i < 3; ++i) picture.colors.push_back(mask >> i & 1 ? kFormats[i] : VK_FORMAT_UNDEFINED);
    SCOPED_TRACE(mask);
    expect_same(picture);
  }
}

/// One set of shaders with attachments that change: what was made for some is found again, and ends with a shader.
TEST_F(ShaderObjectDraws, LinksAreKeptUntilOneOfTheirShadersEnds) {
  Picture2D three;
  three.stages = {{kVertexStage, kVertex}, {kFragmentStage, kThreeOutputs}};
  three.colors = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT};
  Picture2D one = three;
  one.colors.resize(1);
  const auto shaders = make_shaders(three.stages);
  const VkShaderEXT other = make_shader(kFragmentStage, kFragment);
  const auto draw = [&](const Picture2D& picture, VkShaderEXT fragment) {
    auto bound = shaders;
    bound[kFragmentStage] = fragment;
    return render(picture, [&](VkCommandBuffer commands) {
      set_states(commands, picture);
      bind(commands, bound);
      VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
    });
  };
  const auto& links = from_handle<Device>(device).shader_links.links;
  const VkShaderEXT fragment = shaders.at(kFragmentStage);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(draw(three, fragment), by_pipeline(three));
    EXPECT_EQ(draw(one, fragment), by_pipeline(one));
    draw(one, other);
    draw(three, other);  // has no output that is missing or not
    EXPECT_EQ(links.size(), 3u);
  }
  destroy(other);
  EXPECT_EQ(links.size(), 2u);
  const VkShaderEXT again = make_shader(kFragmentStage, kFragment);
  draw(one, again);
  EXPECT_EQ(links.size(), 3u);
  destroy(shaders.at(kVertexStage));
  EXPECT_EQ(links.size(), 0u);
  EXPECT_EQ(from_handle<ShaderObject>(fragment).links.size(), 0u);
}

TEST_F(ShaderObjectDraws, BinariesDrawTheSame) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kGeometryStage, kGeometry}, {kFragmentStage, kFragment}};
  const auto shaders = make_shaders(picture.stages);
  std::map<VkShaderStageFlagBits, VkShaderEXT> again;
  for (const auto& [stage, shader] : shaders) {
    const auto binary = binary_of(shader);
    VkShaderCreateInfoEXT info = shader_info(stage, {});
    info.codeType = VK_SHADER_CODE_TYPE_BINARY_EXT;
    info.codeSize = binary.size();
    info.pCode = binary.data();
    again[stage] = make_shader(info);
  }
  EXPECT_EQ(render(picture,
                   [&](VkCommandBuffer commands) {
                     set_states(commands, picture);
                     bind(commands, again);
                     VK_CALL(CmdDraw)(commands, picture.vertices, 2, 0, 0);
                   }),
            by_pipeline(picture));
}

TEST_F(ShaderObjectDraws, LinkedStagesAreMadeTogether) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  const auto vertex = compile(kVertexStage, kVertex), fragment = compile(kFragmentStage, kFragment);
  VkShaderCreateInfoEXT infos[] = {shader_info(kVertexStage, vertex), shader_info(kFragmentStage, fragment)};
  for (VkShaderCreateInfoEXT& info : infos) info.flags = VK_SHADER_CREATE_LINK_STAGE_BIT_EXT;
  infos[0].nextStage = kFragmentStage;
  VkShaderEXT shaders[2];
  ASSERT_EQ(VK_CALL(CreateShadersEXT)(device, 2, infos, nullptr, shaders), VK_SUCCESS);
  EXPECT_EQ(render(picture,
                   [&](VkCommandBuffer commands) {
                     set_states(commands, picture);
                     bind(commands, {{kVertexStage, shaders[0]}, {kFragmentStage, shaders[1]}});
                     VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
                   }),
            by_pipeline(picture));
  for (const VkShaderEXT shader : shaders) VK_CALL(DestroyShaderEXT)(device, shader, nullptr);
}

/// Pipelines and shader objects alternate: each binding ends the other.
TEST_F(ShaderObjectDraws, PipelinesAndShadersReplaceEachOther) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  Picture2D turned = picture;
  turned.stages[kGeometryStage] = kGeometry;
  const VkPipeline plain = make_pipeline(picture), other = make_pipeline(turned);
  const auto plain_shaders = make_shaders(picture.stages), other_shaders = make_shaders(turned.stages);
  const auto draw = [&](const std::string& order) {
    return render(picture, [&](VkCommandBuffer commands) {
      set_states(commands, picture);
      for (std::uint32_t i = 0; i < order.size(); ++i) {
        const auto bind_pipeline = VK_CALL(CmdBindPipeline);
        if (order[i] == 'p') bind_pipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, plain);
        if (order[i] == 'P') bind_pipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, other);
        if (order[i] == 's') bind(commands, plain_shaders);
        if (order[i] == 'S') bind(commands, other_shaders);
        VK_CALL(CmdDraw)(commands, 3, 1, 0, i);
      }
    });
  };
  const Contents expected = draw("pPpPp");
  for (const char* order : {"sSsSs", "sPsPs", "pSpSp", "sSpPs"}) EXPECT_EQ(draw(order), expected) << order;
  EXPECT_EQ(draw("psSPp"), draw("ppPPp"));
}

/// "any shaders that had previously been bound to any of those stages are no longer bound" by a pipeline; null handles
/// and a null array unbind; stages that a command does not name stay.
TEST_F(ShaderObjectDraws, StagesAreBoundOneByOne) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  Picture2D turned = picture;
  turned.stages[kGeometryStage] = kGeometry;
  const VkPipeline pipeline = make_pipeline(turned);
  const auto shaders = make_shaders(turned.stages);
  const auto bind_one = [&](VkCommandBuffer commands, VkShaderStageFlagBits stage, bool null = false) {
    const VkShaderEXT shader = null ? VK_NULL_HANDLE : shaders.at(stage);
    VK_CALL(CmdBindShadersEXT)(commands, 1, &stage, &shader);
  };
  const auto draw = [&](const Record& bind_all) {
    return render(picture, [&](VkCommandBuffer commands) {
      set_states(commands, picture);
      bind_all(commands);
      VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
    });
  };
  const Contents blank = draw([](VkCommandBuffer) {}), plain = by_pipeline(picture), geometry = by_pipeline(turned);
  const auto bind_pipeline = [&](VkCommandBuffer c) {
    VK_CALL(CmdBindPipeline)(c, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  };
  const auto all = [&](VkCommandBuffer c) {
    for (const auto& [stage, shader] : shaders) bind_one(c, stage);
  };
  EXPECT_EQ(draw(all), geometry);
  EXPECT_EQ(draw([&](VkCommandBuffer c) { all(c), bind_one(c, kGeometryStage, true); }), plain);
  EXPECT_EQ(draw([&](VkCommandBuffer c) { all(c), bind_one(c, kVertexStage, true); }), blank);
  EXPECT_EQ(draw([&](VkCommandBuffer c) { all(c), VK_CALL(CmdBindShadersEXT)(c, 1, &kGeometryStage, nullptr); }),
            plain);
  // The pipeline's stages are gone with it, and so are the shaders that were bound before it.
  EXPECT_EQ(draw([&](VkCommandBuffer c) { bind_pipeline(c), bind_one(c, kFragmentStage); }), blank);
  EXPECT_EQ(draw([&](VkCommandBuffer c) { all(c), bind_pipeline(c), bind_one(c, kGeometryStage); }), blank);
  EXPECT_EQ(draw([&](VkCommandBuffer c) {
              all(c), bind_pipeline(c), bind_one(c, kVertexStage), bind_one(c, kFragmentStage);
            }),
            plain);
}

TEST_F(ShaderObjectDraws, HalfATessellationDrawsNothing) {
  Picture2D picture;
  picture.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  picture.stages = {{kVertexStage, kVertex}, {kControlStage, kControl}, {kFragmentStage, kFragment}};
  const Contents blank = render(picture, [](VkCommandBuffer) {});
  EXPECT_EQ(by_objects(picture), blank);
  picture.stages = {{kVertexStage, kVertex}, {kEvaluationStage, kEvaluation}, {kFragmentStage, kFragment}};
  EXPECT_EQ(by_objects(picture), blank);
  // Patches without tessellation, and tessellation without patches.
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  by_objects(picture);
  picture.stages = {
      {kVertexStage, kVertex}, {kControlStage, kControl}, {kEvaluationStage, kEvaluation}, {kFragmentStage, kFragment}};
  picture.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  by_objects(picture);
}

TEST_F(ShaderObjectDraws, SecondaryCommandBuffersBindTheirOwn) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  const auto shaders = make_shaders(picture.stages);
  const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
  VkCommandPool pool;
  ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer secondary;
  ASSERT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &secondary), VK_SUCCESS);
  auto rendering = make_struct<VkCommandBufferInheritanceRenderingInfo>();
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = picture.colors.data();
  rendering.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  auto inheritance = make_struct<VkCommandBufferInheritanceInfo>(&rendering);
  auto begin = make_struct<VkCommandBufferBeginInfo>();
  begin.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT;
  begin.pInheritanceInfo = &inheritance;
  ASSERT_EQ(VK_CALL(BeginCommandBuffer)(secondary, &begin), VK_SUCCESS);
  set_states(secondary, picture);
  bind(secondary, shaders);
  VK_CALL(CmdDraw)(secondary, 3, 2, 0, 0);
  ASSERT_EQ(VK_CALL(EndCommandBuffer)(secondary), VK_SUCCESS);
  const Contents drawn = render(
      picture,
      [&](VkCommandBuffer commands) {
        VK_CALL(CmdExecuteCommands)
        (commands, 1, &secondary);
      },
      VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT);
  EXPECT_EQ(drawn, by_pipeline(picture));
  VK_CALL(DestroyCommandPool)(device, pool, nullptr);
}

TEST_F(ShaderObjectDraws, WithoutAttachmentsShadersRun) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kThreeOutputs}};
  picture.colors = {};
  const auto count = [&](bool objects) {
    std::memset(storage.data, 0, storage.size);
    objects ? by_objects(picture) : by_pipeline(picture);
    std::uint32_t fragments;
    std::memcpy(&fragments, storage.data, sizeof fragments);
    return fragments;
  };
  const std::uint32_t expected = count(false);
  EXPECT_GT(expected, 0u);
  EXPECT_EQ(count(true), expected);
}

/// VK_KHR_dynamic_rendering_local_read: where outputs go is the command's say, until the next rendering instance.
TEST_F(ShaderObjectDraws, OutputsGoToTheLocationsThatWereSet) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kThreeOutputs}};
  picture.colors.assign(3, VK_FORMAT_R32G32B32A32_SFLOAT);
  const auto shaders = make_shaders(picture.stages);
  const auto draw = [&](std::vector<std::uint32_t> locations) {
    return render(picture, [&](VkCommandBuffer commands) {
      set_states(commands, picture);
      bind(commands, shaders);
      auto info = make_struct<VkRenderingAttachmentLocationInfoKHR>();
      info.colorAttachmentCount = static_cast<std::uint32_t>(locations.size());
      info.pColorAttachmentLocations = locations.data();
      if (!locations.empty()) VK_CALL(CmdSetRenderingAttachmentLocationsKHR)(commands, &info);
      VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
    });
  };
  const Contents plain = draw({});
  EXPECT_EQ(plain, by_pipeline(picture));
  const Contents turned = draw({2, 0, 1});
  EXPECT_EQ(turned, (Contents{plain[2], plain[0], plain[1]}));
  const Contents without = draw({1, VK_ATTACHMENT_UNUSED, 0});
  EXPECT_EQ(without[0], plain[1]);
  EXPECT_EQ(without[2], plain[0]);
  EXPECT_NE(without[1], plain[1]);
  EXPECT_EQ(draw({}), plain);
}

/// The stream need not be set where no geometry shader is bound (Setting State): an earlier command buffer's is none.
TEST_F(ShaderObjectDraws, StatesEndWithTheirCommandBuffer) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  run([&](VkCommandBuffer commands) { VK_CALL(CmdSetRasterizationStreamEXT)(commands, 1); });
  expect_same(picture);
}

/// No valid use: every state has the value that it begins with.
TEST_F(ShaderObjectDraws, WithoutStatesNothingBreaks) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kGeometryStage, kGeometry}, {kFragmentStage, kThreeOutputs}};
  const auto shaders = make_shaders(picture.stages);
  const Contents drawn = render(picture, [&](VkCommandBuffer commands) {
    bind(commands, shaders);
    VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
    VK_CALL(CmdDrawIndexed)(commands, 3, 2, 0, 0, 0);
  });
  EXPECT_EQ(drawn, render(picture, [](VkCommandBuffer) {})) << "the viewport is empty";
}

/// Stages that do not belong together, in states that suit neither them nor the attachments.
TEST_F(ShaderObjectDraws, AnyStagesInAnyStateBreakNothing) {
  const std::string points =
      "layout(points) in;\nlayout(line_strip, max_vertices = 3) out;\nlayout(location = 2) in float n[];\n"
      "layout(location = 0) out vec4 a;\n"
      "void main() { for (int i = 0; i < 3; ++i) { a = vec4(n[0]); gl_Position = gl_in[0].gl_Position + 0.1 * i; "
      "gl_ViewportIndex = 7; EmitVertex(); } }\n";
  const std::string adjacent =
      "layout(triangles_adjacency) in;\nlayout(points, max_vertices = 200) out;\n"
      "void main() { gl_Layer = gl_PrimitiveIDIn; gl_Position = gl_in[5].gl_Position; EmitVertex(); }\n";
  const std::string lines =
      "layout(isolines, point_mode) in;\nlayout(location = 5) in vec3 q[];\nlayout(location = 6) patch in vec4 p;\n"
      "layout(location = 0) out vec4 a;\n"
      "void main() { a = vec4(q[3], 1) + p; gl_Position = gl_in[gl_PatchVerticesIn - 1].gl_Position; }\n";
  const std::string reads =
      "layout(location = 0) in vec4 position;\nlayout(location = 1) in ivec2 other;\n"
      "void main() { gl_Position = position + other.xyxy; }\n";
  const std::string integers =
      "layout(location = 7) flat in ivec4 v;\nlayout(location = 0) out uvec4 o;\nlayout(location = 7) out vec4 last;\n"
      "void main() { o = uvec4(v); last = vec4(gl_PrimitiveID); gl_FragDepth = 0.3; }\n";
  std::map<VkShaderStageFlagBits, std::vector<VkShaderEXT>> all;
  for (const auto& [stage, texts] : std::map<VkShaderStageFlagBits, std::vector<std::string>>{
           {kVertexStage, {kVertex, reads}},
           {kControlStage, {kControl}},
           {kEvaluationStage, {kEvaluation, lines}},
           {kGeometryStage, {kGeometry, points, adjacent}},
           {kFragmentStage, {kFragment, kThreeOutputs, integers}}})
    for (const std::string& text : texts) all[stage].push_back(make_shader(stage, text));
  std::uint32_t state = 7;
  const auto below = [&](std::uint32_t n) { return (state = state * 1664525 + 1013904223) / 65536 % n; };
  Picture2D picture;
  picture.depth = true;
  picture.colors = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_UNDEFINED, VK_FORMAT_R16G16_SFLOAT};
  for (int i = 0; i < 40; ++i)
    render(picture, [&](VkCommandBuffer commands) {
      set_states(commands, picture);
      for (int n = 0; n < 10; ++n) {
        std::map<VkShaderStageFlagBits, VkShaderEXT> bound;
        for (const auto& [stage, shaders] : all)
          if (stage == kVertexStage || below(2))
            bound[stage] = shaders[below(static_cast<std::uint32_t>(shaders.size()))];
        bind(commands, bound);
        const VkViewport viewport{0, 0, 50, 60, 0, 1};
        const VkRect2D scissor{{0, 0}, {60, 60}};
        const VkSampleMask mask = below(2) ? ~0u : below(16);
        const VkVertexInputBindingDescription2EXT stream{VK_STRUCTURE_TYPE_VERTEX_INPUT_BINDING_DESCRIPTION_2_EXT,
                                                         nullptr,
                                                         below(3),
                                                         below(20),
                                                         VK_VERTEX_INPUT_RATE_VERTEX,
                                                         1};
        const VkVertexInputAttributeDescription2EXT attribute{
            VK_STRUCTURE_TYPE_VERTEX_INPUT_ATTRIBUTE_DESCRIPTION_2_EXT,
            nullptr,
            below(3),
            below(3),
            VK_FORMAT_R32G32B32_SFLOAT,
            below(9)};
        VK_CALL(CmdSetVertexInputEXT)(commands, below(2), &stream, below(2), &attribute);
        VK_CALL(CmdSetPrimitiveTopologyEXT)(commands, static_cast<VkPrimitiveTopology>(below(11)));
        VK_CALL(CmdSetPrimitiveRestartEnableEXT)(commands, below(2));
        VK_CALL(CmdSetPatchControlPointsEXT)(commands, below(34));
        VK_CALL(CmdSetViewportWithCountEXT)(commands, below(2), &viewport);
        VK_CALL(CmdSetScissorWithCountEXT)(commands, below(2), &scissor);
        VK_CALL(CmdSetPolygonModeEXT)(commands, static_cast<VkPolygonMode>(below(3)));
        VK_CALL(CmdSetSampleMaskEXT)(commands, VK_SAMPLE_COUNT_1_BIT, &mask);
        VK_CALL(CmdSetAlphaToCoverageEnableEXT)(commands, below(2));
        VK_CALL(CmdSetRasterizerDiscardEnableEXT)(commands, below(4) == 0);
        VK_CALL(CmdSetStencilTestEnableEXT)(commands, below(2));
        VK_CALL(CmdDraw)(commands, below(40), below(3), below(4), 0);
        VK_CALL(CmdDrawIndexed)(commands, below(40), 1, 0, 0, 0);
      }
    });
}

/// Shaders whose use has ended are destroyed by one thread while another draws with the rest of them.
TEST_F(ShaderObjectDraws, ShadersEndWhileOthersDraw) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  const Contents expected = by_pipeline(picture);
  const auto words = compile(kFragmentStage, kFragment);
  const VkShaderEXT vertex = make_shader(kVertexStage, kVertex);
  std::mutex mutex;
  std::vector<VkShaderEXT> ended;
  std::atomic<bool> done{false};
  const auto destroy_shader = VK_CALL(DestroyShaderEXT);
  std::thread destroyer([&] {
    for (bool last = false; !last;) {
      last = done;
      const std::lock_guard lock(mutex);
      for (const VkShaderEXT shader : ended) destroy_shader(device, shader, nullptr);
      ended.clear();
    }
  });
  for (int i = 0; i < 100; ++i) {
    const VkShaderCreateInfoEXT info = shader_info(kFragmentStage, words);
    VkShaderEXT fragment;
    ASSERT_EQ(VK_CALL(CreateShadersEXT)(device, 1, &info, nullptr, &fragment), VK_SUCCESS);
    EXPECT_EQ(render(picture,
                     [&](VkCommandBuffer commands) {
                       set_states(commands, picture);
                       bind(commands, {{kVertexStage, vertex}, {kFragmentStage, fragment}});
                       VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
                     }),
              expected);
    const std::lock_guard lock(mutex);
    ended.push_back(fragment);
  }
  done = true;
  destroyer.join();
  EXPECT_EQ(from_handle<Device>(device).shader_links.links.size(), 0u);
}

class ShaderObjectExhaustion : public ShaderObjectDevice {
 protected:
  ShaderObjectExhaustion() { host = allocator.callbacks(); }

  /// What a submission returns, or the wait for it, where the device's n-th allocation fails meanwhile.
  VkResult submit(VkCommandBuffer commands, std::size_t n) {
    VkQueue queue;
    VK_CALL(GetDeviceQueue)(device, 0, 0, &queue);
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    allocator.clear_failed();
    allocator.fail_after(n);
    const VkResult submitted = VK_CALL(QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE);
    const VkResult waited = VK_CALL(QueueWaitIdle)(queue);
    allocator.fail_after(~std::size_t{0});
    return submitted == VK_SUCCESS ? waited : submitted;
  }

  CountingAllocator allocator;
};

TEST_F(ShaderObjectExhaustion, InTheMidstOfADrawIsAnError) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kThreeOutputs}};
  for (std::size_t n = 0;; ++n) {
    const auto shaders = make_shaders(picture.stages);
    const Picture target = make_picture(VK_IMAGE_TYPE_2D, picture.colors[0], {kCanvas.width, kCanvas.height, 1}, 1);
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    VkCommandPool pool;
    ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands;
    ASSERT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    ASSERT_EQ(VK_CALL(BeginCommandBuffer)(commands, &begin), VK_SUCCESS);
    auto color = make_struct<VkRenderingAttachmentInfo>();
    color.imageView = target.view;
    color.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    auto info = make_struct<VkRenderingInfo>();
    info.renderArea = {{0, 0}, kCanvas};
    info.layerCount = info.colorAttachmentCount = 1;
    info.pColorAttachments = &color;
    VK_CALL(CmdBeginRenderingKHR)(commands, &info);
    set_states(commands, picture);
    bind(commands, shaders);
    VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
    VK_CALL(CmdEndRenderingKHR)(commands);
    ASSERT_EQ(VK_CALL(EndCommandBuffer)(commands), VK_SUCCESS);
    const VkResult result = submit(commands, n);
    if (!allocator.failed()) {
      EXPECT_EQ(result, VK_SUCCESS);
      EXPECT_GT(n, 3u) << "a link and its place in the lists";
    } else {
      EXPECT_TRUE(result == VK_ERROR_DEVICE_LOST || result == VK_ERROR_OUT_OF_HOST_MEMORY) << n << ": " << result;
    }
    VK_CALL(DestroyCommandPool)(device, pool, nullptr);
    TearDown();
    pictures.clear(), buffers.clear();
    const bool done = !allocator.failed();
    SetUp();
    if (done) break;
    ASSERT_LT(n, 100u);
  }
}

TEST_F(ShaderObjectDraws, OutsideOfRenderingNothingHappens) {
  Picture2D picture;
  picture.stages = {{kVertexStage, kVertex}, {kFragmentStage, kFragment}};
  const auto shaders = make_shaders(picture.stages);
  run([&](VkCommandBuffer commands) {
    set_states(commands, picture);
    bind(commands, shaders);
    VK_CALL(CmdDraw)(commands, 3, 2, 0, 0);
    VK_CALL(CmdBindShadersEXT)(commands, 0, nullptr, nullptr);
    const VkShaderStageFlagBits strange[] = {VK_SHADER_STAGE_MESH_BIT_EXT, VK_SHADER_STAGE_TASK_BIT_EXT};
    const VkShaderEXT both[] = {shaders.at(kVertexStage), VK_NULL_HANDLE};
    VK_CALL(CmdBindShadersEXT)(commands, 2, strange, both);
  });
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
