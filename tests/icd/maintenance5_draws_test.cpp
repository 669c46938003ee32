// VK_KHR_maintenance5 and 6: draws with ranges of indices and vertices, shaders without modules, points without a size,
// the order of fragment operations, views of blocks, and the formats that come with them.
#include <cstring>
#include <string>
#include <vector>

#include "tests/icd/maintenance5_draws_fixture.h"

#ifdef VK_KHR_maintenance6
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

/// Each vertex leaves its index and its attribute in the buffer.
Draw telling_draw() {
  Draw draw;
  draw.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  draw.has_attribute = true;
  draw.vertex =
      "layout(location = 0) in uint fetched; layout(push_constant) uniform P { uint slot; };\n"
      "layout(set = 0, binding = 0) buffer B { uint words[]; };\n"
      "void main() { words[2 * slot] = gl_VertexIndex; words[2 * slot + 1] = fetched; gl_Position = vec4(0); }";
  return draw;
}

/// Vulkan 1.4.309, vkCmdBindIndexBuffer2: the range ends the indices as the buffer's end does; those beyond are 0.
TEST_F(Maintenance5Draws, IndicesEndWithTheirRange) {
  const Bytes indices = make_bytes(32), attributes = make_bytes(64);
  const std::uint16_t values[] = {9, 8, 7, 6, 5, 4, 3, 2, 1, 0};
  std::memcpy(indices.data, values, sizeof values);
  for (std::uint32_t i = 0; i < 16; ++i) {
    const std::uint32_t value = 100 + i;
    std::memcpy(attributes.data + 4 * i, &value, 4);
  }
  const VkDeviceSize sizes[] = {6, VK_WHOLE_SIZE};
  for (const VkDeviceSize size : sizes) {
    render(telling_draw(), [&](VkCommandBuffer commands) {
      const VkDeviceSize start = 0;
      VK_CALL(CmdBindVertexBuffers)(commands, 0, 1, &attributes.buffer, &start);
      VK_CALL(CmdBindIndexBuffer2KHR)(commands, indices.buffer, 4, size, VK_INDEX_TYPE_UINT16);
      for (std::uint32_t i = 0; i < 6; ++i) {
        VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, 4, &i);
        VK_CALL(CmdDrawIndexed)(commands, 1, 1, i, 0, 0);
      }
    });
    using Words = std::vector<std::uint32_t>;
    EXPECT_EQ(words(12), size == 6 ? Words({7, 107, 6, 106, 5, 105, 0, 100, 0, 100, 0, 100})
                                   : Words({7, 107, 6, 106, 5, 105, 4, 104, 3, 103, 2, 102}))
        << size;
  }
}

/// Vulkan 1.4.309, vkCmdBindIndexBuffer: without a buffer "every index fetched results in a value of zero"
/// (VK_KHR_maintenance6).
TEST_F(Maintenance5Draws, IndicesOfNoBufferAreZero) {
  const Bytes attributes = make_bytes(16);
  const std::uint32_t value = 77;
  std::memcpy(attributes.data, &value, 4);
  for (const bool ranged : {false, true}) {
    std::memset(results.data, 0xff, results.size);
    render(telling_draw(), [&](VkCommandBuffer commands) {
      const VkDeviceSize start = 0;
      VK_CALL(CmdBindVertexBuffers)(commands, 0, 1, &attributes.buffer, &start);
      if (ranged)
        VK_CALL(CmdBindIndexBuffer2KHR)(commands, VK_NULL_HANDLE, 0, 0, VK_INDEX_TYPE_UINT32);
      else
        VK_CALL(CmdBindIndexBuffer)(commands, VK_NULL_HANDLE, 0, VK_INDEX_TYPE_UINT32);
      for (std::uint32_t i = 0; i < 2; ++i) {
        VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, 4, &i);
        VK_CALL(CmdDrawIndexed)(commands, 1, 1, 5 * i, 0, 0);
      }
    });
    EXPECT_EQ(words(4), (std::vector<std::uint32_t>{0, 77, 0, 77})) << ranged;
  }
}

/// Vulkan 1.4.309, vkCmdBindVertexBuffers2: VK_WHOLE_SIZE is to the end of the buffer.
TEST_F(Maintenance5Draws, VerticesMayGoToTheEndOfTheirBuffer) {
  const Bytes attributes = make_bytes(16);
  const std::uint32_t values[] = {5, 6, 7, 8};
  std::memcpy(attributes.data, values, sizeof values);
  for (const VkDeviceSize size : {VkDeviceSize{4}, VkDeviceSize{VK_WHOLE_SIZE}}) {
    render(telling_draw(), [&](VkCommandBuffer commands) {
      const VkDeviceSize start = 4;
      VK_CALL(CmdBindVertexBuffers2EXT)(commands, 0, 1, &attributes.buffer, &start, &size, nullptr);
      for (std::uint32_t i = 0; i < 4; ++i) {
        VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, 4, &i);
        VK_CALL(CmdDraw)(commands, 1, 1, i, 0);
      }
    });
    using Words = std::vector<std::uint32_t>;
    EXPECT_EQ(words(8), size == 4 ? Words({0, 6, 1, 0, 2, 0, 3, 0}) : Words({0, 6, 1, 7, 2, 8, 3, 0})) << size;
  }
}

/// Vulkan 1.4.309, Points: "if a value is not written to PointSize, the point size takes a default value of 1.0".
TEST_F(Maintenance5Draws, PointsAreOnePixelWide) {
  Draw draw;
  draw.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  draw.fragment = "layout(location = 0) out vec4 color; void main() { color = vec4(1); }";
  for (const char* size : {"", "gl_PointSize = 3.0;"}) {
    draw.vertex = "void main() { gl_Position = vec4(1.0 / 16.0, 1.0 / 16.0, 0.5, 1);";
    draw.vertex.append(size).append("}");
    const Picture target = render(draw, [&](VkCommandBuffer commands) { VK_CALL(CmdDraw)(commands, 1, 1, 0, 0); });
    const std::uint32_t around = *size ? 1 : 0;
    for (std::uint32_t y = 0; y < kSide; ++y)
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const bool inside = x + around >= 8 && x <= 8 + around && y + around >= 8 && y <= 8 + around;
        ASSERT_EQ(texel(target, x, y, 4), inside ? ~0u : 0u) << size << " " << x << " " << y;
      }
  }
}

/// Vulkan 1.4.309, VkPipelineCreateFlags2CreateInfo: the flag that makes a library stands there, too.
TEST_F(Maintenance5Draws, LibrariesAreMadeByTheFlagInTheChain) {
  Draw draw;
  draw.fragment = "layout(location = 0) out vec4 color; void main() { color = vec4(gl_FragCoord.xy / 16.0, 0, 1); }";
  const std::vector<std::uint32_t> expected = texels(render(draw), 4);
  draw.as_library = true;
  const VkPipeline library = make_pipeline(draw);
  auto libraries = make_struct<VkPipelineLibraryCreateInfoKHR>();
  libraries.libraryCount = 1;
  libraries.pLibraries = &library;
  auto info = make_struct<VkGraphicsPipelineCreateInfo>(&libraries);
  info.layout = layout;
  VkPipeline linked = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &linked), VK_SUCCESS);
  VK_CALL(DestroyPipeline)(device, library, nullptr);
  const auto draw_three = [&](VkCommandBuffer commands) { VK_CALL(CmdDraw)(commands, 3, 1, 0, 0); };
  EXPECT_EQ(texels(render(draw, draw_three, {}, linked), 4), expected);
  VK_CALL(DestroyPipeline)(device, linked, nullptr);
}

/// polygonModePointSize: the corners of a polygon are as large as its vertices say.
TEST_F(Maintenance5Draws, CornersOfPolygonsHaveASize) {
  Draw draw;
  draw.polygon_mode = VK_POLYGON_MODE_POINT;
  draw.vertex =
      "void main() { vec2 p = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1); gl_PointSize = 3.0;\n"
      "gl_Position = vec4(p + 1.0 / 16.0 - 0.5, 0.5, 1); }";
  draw.fragment = "layout(location = 0) out vec4 color; void main() { color = vec4(1); }";
  const Picture target = render(draw);
  std::uint32_t covered = 0;
  for (const std::uint32_t value : texels(target, 4)) covered += value == ~0u;
  EXPECT_EQ(covered, 3u * 9u);
}

/// earlyFragmentMultisampleCoverageAfterSampleCounting and earlyFragmentSampleMaskTestBeforeSampleCounting.
TEST_F(Maintenance5Draws, EarlyTestsCountWhatTheSampleMaskLeavesBeforeTheShader) {
  Draw draw;
  draw.samples = VK_SAMPLE_COUNT_4_BIT;
  draw.sample_mask = 0x5;
  draw.alpha_to_coverage = true;
  for (const bool early : {true, false}) {
    draw.fragment = early ? "layout(early_fragment_tests) in;\n" : "";
    draw.fragment +=
        "layout(location = 0) out vec4 color;\n"
        "void main() { if (gl_FragCoord.x < 8.0) discard; color = vec4(1, 1, 1, gl_FragCoord.y < 8.0 ? 1.0 : 0.0); }";
    auto info = make_struct<VkQueryPoolCreateInfo>();
    info.queryType = VK_QUERY_TYPE_OCCLUSION;
    info.queryCount = 1;
    VkQueryPool pool;
    ASSERT_EQ(VK_CALL(CreateQueryPool)(device, &info, nullptr, &pool), VK_SUCCESS);
    run([&](VkCommandBuffer commands) { VK_CALL(CmdResetQueryPool)(commands, pool, 0, 1); });
    render(draw, [&](VkCommandBuffer commands) {
      VK_CALL(CmdBeginQuery)(commands, pool, 0, VK_QUERY_CONTROL_PRECISE_BIT);
      VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
      VK_CALL(CmdEndQuery)(commands, pool, 0);
    });
    std::uint64_t count = 0;
    EXPECT_EQ(VK_CALL(GetQueryPoolResults)(device, pool, 0, 1, 8, &count, 8, VK_QUERY_RESULT_64_BIT), VK_SUCCESS);
    EXPECT_EQ(count, early ? kSide * kSide * 2 : kSide * kSide / 4 * 2) << early;
    VK_CALL(DestroyQueryPool)(device, pool, nullptr);
  }
}

/// depthStencilSwizzleOneSupport.
TEST_F(Maintenance5Draws, ViewsOfDepthCanSwizzleToOne) {
  const VkComponentMapping swizzle{VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_R, VK_COMPONENT_SWIZZLE_ZERO,
                                   VK_COMPONENT_SWIZZLE_ONE};
  const Picture depth = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_D32_SFLOAT, {4, 4, 1}, 1, VK_SAMPLE_COUNT_1_BIT,
                                     VK_IMAGE_ASPECT_DEPTH_BIT, swizzle);
  for (std::size_t i = 0; i + 4 <= depth.size; i += 4) {
    const float value = 0.2f;
    std::memcpy(depth.data + i, &value, 4);
  }
  sample(depth);
  Draw draw;
  draw.fragment =
      "layout(set = 0, binding = 1) uniform sampler2D t; layout(location = 0) out vec4 color;\n"
      "void main() { color = texture(t, vec2(0.5)); }";
  EXPECT_EQ(texel(render(draw), 3, 3, 4), 0xff0033ffu);
}

/// blockTexelViewCompatibleMultipleLayers: blocks of every layer as texels.
TEST_F(Maintenance5Draws, ViewsOfBlocksHaveLayers) {
  constexpr std::uint32_t kLayers = 3;
  auto info = image_info(VK_IMAGE_TYPE_2D, VK_FORMAT_BC1_RGB_UNORM_BLOCK, {16, 12, 1}, kLayers);
  info.flags = VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT | VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT |
               VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
  Picture blocks;
  ASSERT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &blocks.image), VK_SUCCESS);
  VkMemoryRequirements needed;
  VK_CALL(GetImageMemoryRequirements)(device, blocks.image, &needed);
  blocks.memory = map(needed.size, blocks.data);
  blocks.size = needed.size;
  ASSERT_EQ(VK_CALL(BindImageMemory)(device, blocks.image, blocks.memory, 0), VK_SUCCESS);
  const VkImageSubresource first{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0};
  VK_CALL(GetImageSubresourceLayout)(device, blocks.image, &first, &blocks.layout);
  auto view = make_struct<VkImageViewCreateInfo>();
  view.image = blocks.image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  view.format = VK_FORMAT_R32G32_UINT;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, kLayers};
  ASSERT_EQ(VK_CALL(CreateImageView)(device, &view, nullptr, &blocks.view), VK_SUCCESS);
  pictures.push_back(blocks);
  fill(blocks, 3);
  sample(blocks);
  Draw draw;
  draw.format = VK_FORMAT_R32G32_UINT;
  draw.fragment =
      "layout(set = 0, binding = 1) uniform usampler2DArray t; layout(location = 0) out uvec2 color;\n"
      "void main() { ivec2 p = ivec2(gl_FragCoord.xy); color = texelFetch(t, ivec3(p.x % 4, p.y % 3, p.y / 3 % 3), "
      "0).xy; }";
  const Picture read = render(draw);
  for (std::uint32_t y = 0; y < 9; ++y) {
    EXPECT_EQ(std::memcmp(read.row(0, y), blocks.row(y / 3, y % 3), 4 * 8), 0) << y;
  }
}

/// A draw into each of the formats against the same into one of the same fields, and samples of the result.
TEST_F(Maintenance5Draws, ItsFormatsAreLikeOthersOfTheSameFields) {
  struct Row {
    VkFormat format, peer;
    std::uint32_t bytes, peer_bytes;
    std::uint32_t (*convert)(std::uint32_t texel);  ///< a texel of the peer
  };
  const Row rows[] = {{VK_FORMAT_A8_UNORM_KHR, VK_FORMAT_R8G8B8A8_UNORM, 1, 4, [](std::uint32_t t) { return t >> 24; }},
                      {VK_FORMAT_A1B5G5R5_UNORM_PACK16_KHR, VK_FORMAT_A1R5G5B5_UNORM_PACK16, 2, 2,
                       [](std::uint32_t t) { return (t & 0x83e0u) | (t >> 10 & 0x1fu) | (t & 0x1fu) << 10; }}};
  for (const Row& row : rows) {
    VkFormatProperties properties;
    VK_CALL(GetPhysicalDeviceFormatProperties)(physical_device, row.format, &properties);
    EXPECT_TRUE(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT);
    for (const bool blends : {false, true}) {
      Draw draw;
      draw.blends = blends;
      draw.fragment =
          "layout(location = 0) out vec4 color; void main() { vec2 p = gl_FragCoord.xy / 16.0;\n"
          "color = vec4(p, 1.0 - p.x * p.y, p.x * 0.7 + p.y * 0.3); if (p.x > 0.9) discard; }";
      const VkClearColorValue clear{{0.3f, 0.5f, 0.7f, 0.6f}};
      draw.format = row.format;
      const Picture drawn = render(draw, clear);
      draw.format = row.peer;
      const Picture expected = render(draw, clear);
      for (std::uint32_t i = 0; i < kSide * kSide; ++i)
        ASSERT_EQ(texel(drawn, i % kSide, i / kSide, row.bytes),
                  row.convert(texel(expected, i % kSide, i / kSide, row.peer_bytes)))
            << row.format << " " << blends << " " << i;
      // Samples of both, filtered and with a border. What A8 lacks is 0.
      Draw reads;
      reads.fragment =
          "layout(set = 0, binding = 1) uniform sampler2D t; layout(location = 0) out vec4 color;\n"
          "void main() { color = texture(t, gl_FragCoord.xy * 0.11 - 0.4); }";
      reads.format = VK_FORMAT_R32G32B32A32_SFLOAT;
      sample(drawn);
      const Picture read = render(reads);
      sample(expected);
      const Picture expected_read = render(reads);
      for (std::uint32_t y = 0; y < kSide; ++y) {
        float a[4 * kSide], b[4 * kSide];
        std::memcpy(a, read.row(0, y), sizeof a);
        std::memcpy(b, expected_read.row(0, y), sizeof b);
        for (std::uint32_t i = 0; i < 4 * kSide; ++i) {
          const bool lacks = row.bytes == 1 && i % 4 != 3;
          ASSERT_NEAR(a[i], lacks ? 0.0f : b[i], 1e-6f) << row.format << " " << i / 4 << " " << y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
