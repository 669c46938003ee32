// Small extensions that neither older headers than Vulkan 1.4.309's nor the reference know: results are held against
// the specification's formulas.
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "tests/icd/maintenance5_draws_fixture.h"

#ifdef VK_KHR_maintenance6
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

// ---- VK_EXT_depth_bias_control

class DepthBiasControl : public Maintenance5Draws {
 protected:
  /// The depth of a fragment at 0.5 that is biased by `constant`; without a depth attachment a unit is one of 24 bits.
  /// By the pipeline, or by the command.
  double depth_of(float constant, VkDepthBiasRepresentationEXT representation, bool exact, bool by_command,
                  VkImageView depth_view = VK_NULL_HANDLE) {
    auto how = make_struct<VkDepthBiasRepresentationInfoEXT>();
    how.depthBiasRepresentation = representation;
    how.depthBiasExact = exact;
    Draw draw;
    draw.fragment = "layout(location = 0) out float c; void main() { c = gl_FragCoord.z; }";
    draw.format = VK_FORMAT_R32_SFLOAT;
    draw.depth = depth_view;
    if (by_command) {
      draw.dynamic = {VK_DYNAMIC_STATE_DEPTH_BIAS};
    } else {
      draw.depth_bias = constant;
      draw.rasterization = &how;
    }
    const Picture picture = render(draw, [&](VkCommandBuffer commands) {
      if (by_command) {
        auto info = make_struct<VkDepthBiasInfoEXT>(&how);
        info.depthBiasConstantFactor = constant;
        VK_CALL(CmdSetDepthBias2EXT)(commands, &info);
      }
      VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
    });
    float depth;
    std::memcpy(&depth, picture.row(0), sizeof depth);
    return depth;
  }
};

TEST_F(DepthBiasControl, UnitsAreThoseOfTheRepresentation) {
  for (const bool by_command : {false, true}) {
    EXPECT_EQ(depth_of(0.125f, VK_DEPTH_BIAS_REPRESENTATION_FLOAT_EXT, false, by_command), 0.625);
    const double unit = std::ldexp(1.0, -24);
    for (const auto representation : {VK_DEPTH_BIAS_REPRESENTATION_LEAST_REPRESENTABLE_VALUE_FORMAT_EXT,
                                      VK_DEPTH_BIAS_REPRESENTATION_LEAST_REPRESENTABLE_VALUE_FORCE_UNORM_EXT}) {
      // "its value must be r = 2^-n"; else "must be at most r = 2 x 2^-n", of the format's as the reference has it.
      EXPECT_EQ(depth_of(4096, representation, true, by_command), 0.5 + 4096 * unit);
      const bool forced = representation == VK_DEPTH_BIAS_REPRESENTATION_LEAST_REPRESENTABLE_VALUE_FORCE_UNORM_EXT;
      EXPECT_NEAR(depth_of(4096, representation, false, by_command), 0.5 + (forced ? 1 : 2) * 4096 * unit,
                  forced ? 0 : unit);
    }
  }
}

/// n of floats is 24.
TEST_F(DepthBiasControl, ForcedUnitsOfFloatsAreExact) {
  const Picture depth = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_D32_SFLOAT, {kSide, kSide, 1}, 1,
                                     VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
  const auto representation = VK_DEPTH_BIAS_REPRESENTATION_LEAST_REPRESENTABLE_VALUE_FORCE_UNORM_EXT;
  for (const bool by_command : {false, true})
    for (const bool exact : {false, true})
      EXPECT_EQ(depth_of(-4194304, representation, exact, by_command, depth.view), 0.25);
}

/// vkCmdSetDepthBias, and a pipeline that does not say: units of the format.
TEST_F(DepthBiasControl, WithoutARepresentationItIsTheFormats) {
  Draw draw;
  draw.fragment = "layout(location = 0) out float c; void main() { c = gl_FragCoord.z; }";
  draw.format = VK_FORMAT_R32_SFLOAT;
  draw.dynamic = {VK_DYNAMIC_STATE_DEPTH_BIAS};
  const Picture picture = render(draw, [&](VkCommandBuffer commands) {
    auto how = make_struct<VkDepthBiasRepresentationInfoEXT>();
    how.depthBiasRepresentation = VK_DEPTH_BIAS_REPRESENTATION_FLOAT_EXT;
    auto info = make_struct<VkDepthBiasInfoEXT>(&how);
    info.depthBiasConstantFactor = 0.25f;
    VK_CALL(CmdSetDepthBias2EXT)(commands, &info);
    VK_CALL(CmdSetDepthBias)(commands, 4096, 0, 0);
    VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
  });
  float depth;
  std::memcpy(&depth, picture.row(0), sizeof depth);
  EXPECT_NEAR(depth, 0.5 + 2 * std::ldexp(4096.0, -24), std::ldexp(1.0, -24));
}

// ---- VK_EXT_discard_rectangles, revision 2

class DiscardRectangles : public Maintenance5Draws {
 protected:
  /// Whether the texels at (2, 2), in the rectangle that commands set, and at (12, 12) were drawn; `enable`, `mode`:
  /// what commands say; no structure does.
  std::pair<bool, bool> drawn(bool enable, VkDiscardRectangleModeEXT mode) {
    Draw draw;
    draw.fragment = "layout(location = 0) out vec4 c; void main() { c = vec4(1); }";
    draw.dynamic = {VK_DYNAMIC_STATE_DISCARD_RECTANGLE_EXT, VK_DYNAMIC_STATE_DISCARD_RECTANGLE_ENABLE_EXT,
                    VK_DYNAMIC_STATE_DISCARD_RECTANGLE_MODE_EXT};
    const Picture picture = render(draw, [&](VkCommandBuffer commands) {
      const VkRect2D rectangle{{0, 0}, {8, 8}};
      VK_CALL(CmdSetDiscardRectangleEXT)(commands, 0, 1, &rectangle);
      VK_CALL(CmdSetDiscardRectangleEnableEXT)(commands, enable);
      VK_CALL(CmdSetDiscardRectangleModeEXT)(commands, mode);
      VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
    });
    return {texel(picture, 2, 2, 4) != 0, texel(picture, 12, 12, 4) != 0};
  }
};

TEST_F(DiscardRectangles, CommandsSwitchThemAndSayWhatIsDiscarded) {
  using Pair = std::pair<bool, bool>;
  EXPECT_EQ(drawn(true, VK_DISCARD_RECTANGLE_MODE_INCLUSIVE_EXT), Pair(true, false));
  EXPECT_EQ(drawn(true, VK_DISCARD_RECTANGLE_MODE_EXCLUSIVE_EXT), Pair(false, true));
  EXPECT_EQ(drawn(false, VK_DISCARD_RECTANGLE_MODE_INCLUSIVE_EXT), Pair(true, true));
  EXPECT_EQ(drawn(false, VK_DISCARD_RECTANGLE_MODE_EXCLUSIVE_EXT), Pair(true, true));
}

// ---- Dual-source blending

using DualSource = Maintenance5Draws;

/// Nothing is defined of the first colour, and nothing taken of it.
TEST_F(DualSource, BlendingTakesTheSecondColorAlone) {
  for (const char* first : {"", "layout(location = 0) out vec4 d; "}) {
    Draw draw;
    draw.fragment = std::string(first) +
                    "layout(location = 0, index = 1) out vec4 c; void main() { c = vec4(0.25, 0.5, 0.75, 1); }";
    draw.blends = true;
    draw.dynamic = {VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT};
    const Picture picture = render(draw,
                                   [&](VkCommandBuffer commands) {
                                     const VkColorBlendEquationEXT equation{
                                         VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC1_COLOR, VK_BLEND_OP_ADD,
                                         VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC1_ALPHA, VK_BLEND_OP_ADD};
                                     VK_CALL(CmdSetColorBlendEquationEXT)(commands, 0, 1, &equation);
                                     VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
                                   },
                                   {{1, 1, 1, 1}});
    EXPECT_EQ(texel(picture, 5, 5, 4), 0xffbf8040u) << first;
  }
}

// ---- VK_EXT_transform_feedback: the stream that is rasterized

class RasterizedStream : public Maintenance5Draws {
 protected:
  /// Whether a draw without a geometry shader draws, `stream` being chosen by the pipeline or by the command.
  bool draws(std::uint32_t stream, bool by_command) {
    auto chosen = make_struct<VkPipelineRasterizationStateStreamCreateInfoEXT>();
    chosen.rasterizationStream = by_command ? 1 - stream : stream;
    Draw draw;
    draw.fragment = "layout(location = 0) out vec4 c; void main() { c = vec4(1); }";
    draw.rasterization = &chosen;
    if (by_command) draw.dynamic = {VK_DYNAMIC_STATE_RASTERIZATION_STREAM_EXT};
    const Picture picture = render(draw, [&](VkCommandBuffer commands) {
      if (by_command) VK_CALL(CmdSetRasterizationStreamEXT)(commands, stream);
      VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
    });
    return texel(picture, 5, 5, 4) != 0;
  }
};

TEST_F(RasterizedStream, WithoutAGeometryShaderAllIsOfTheFirst) {
  for (const bool by_command : {false, true}) {
    EXPECT_TRUE(draws(0, by_command));
    EXPECT_FALSE(draws(1, by_command));
  }
}

// ---- VK_EXT_image_sliced_view_of_3d

class SlicedViews : public Maintenance5Draws {
 protected:
  /// What a shader sees of a view of slices `offset`... of an image of 4 x 4 x 8 whose texels are their slices: its
  /// depth, the texel at z = 0, the last one; the one beyond it and one sampled from the whole image.
  std::vector<std::uint32_t> seen(std::uint32_t level, std::uint32_t offset, std::uint32_t count) {
    auto info = image_info(VK_IMAGE_TYPE_3D, VK_FORMAT_R32_UINT, {4, 4, 8}, 1);
    info.mipLevels = 2;
    info.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    VkImage image = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
    VkMemoryRequirements needed;
    VK_CALL(GetImageMemoryRequirements)(device, image, &needed);
    std::byte* data = nullptr;
    const VkDeviceMemory memory = map(needed.size, data);
    EXPECT_EQ(VK_CALL(BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
    const VkImageSubresource first{VK_IMAGE_ASPECT_COLOR_BIT, level, 0};
    VkSubresourceLayout place;
    VK_CALL(GetImageSubresourceLayout)(device, image, &first, &place);
    for (std::uint32_t z = 0; z < 8u >> level; ++z) {
      const std::uint32_t value = 100 + z;
      std::memcpy(data + place.offset + z * place.depthPitch, &value, sizeof value);
    }
    auto slices = make_struct<VkImageViewSlicedCreateInfoEXT>();
    slices.sliceOffset = offset;
    slices.sliceCount = count;
    auto view_info = make_struct<VkImageViewCreateInfo>(&slices);
    view_info.image = image;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_3D;
    view_info.format = VK_FORMAT_R32_UINT;
    view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, level, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateImageView)(device, &view_info, nullptr, &view), VK_SUCCESS);
    const auto out = look(view);
    VK_CALL(DestroyImageView)(device, view, nullptr);
    VK_CALL(DestroyImage)(device, image, nullptr);
    VK_CALL(FreeMemory)(device, memory, nullptr);
    return out;
  }

  std::vector<std::uint32_t> look(VkImageView view) {
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_ALL, nullptr},
        {2, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_ALL, nullptr}};
    auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
    shape.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
    shape.bindingCount = 3;
    shape.pBindings = bindings;
    VkDescriptorSetLayout pushed = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &pushed), VK_SUCCESS);
    auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &pushed;
    VkPipelineLayout pushing = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &pushing), VK_SUCCESS);
    const auto code =
        compile(VK_SHADER_STAGE_COMPUTE_BIT,
                "#extension GL_EXT_samplerless_texture_functions : require\n"
                "layout(binding = 0) buffer B { uint words[]; };\n"
                "layout(binding = 1, r32ui) uniform uimage3D m;\n"
                "layout(binding = 2) uniform utexture3D t;\n"
                "void main() { int n = imageSize(m).z; words[0] = n; words[1] = imageLoad(m, ivec3(0)).x;\n"
                "words[2] = imageLoad(m, ivec3(0, 0, n - 1)).x; words[3] = imageLoad(m, ivec3(0, 0, n)).x;\n"
                "words[4] = texelFetch(t, ivec3(0), 0).x;\n"
                "imageStore(m, ivec3(1, 0, 0), uvec4(7)); imageStore(m, ivec3(1, 0, n), uvec4(8));\n"
                "memoryBarrierImage(); words[5] = imageLoad(m, ivec3(1, 0, 0)).x; }");
    auto module = module_info(code);
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = make_struct<VkPipelineShaderStageCreateInfo>(&module);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = "main";
    info.layout = pushing;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    const VkDescriptorBufferInfo buffer{results.buffer, 0, VK_WHOLE_SIZE};
    const VkDescriptorImageInfo image{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet writes[3];
    for (std::uint32_t i = 0; i < 3; ++i) {
      writes[i] = make_struct<VkWriteDescriptorSet>();
      writes[i].dstBinding = i;
      writes[i].descriptorCount = 1;
      writes[i].descriptorType = bindings[i].descriptorType;
      writes[i].pBufferInfo = &buffer;
      writes[i].pImageInfo = &image;
    }
    run([&](VkCommandBuffer commands) {
      VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
      VK_CALL(CmdPushDescriptorSetKHR)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pushing, 0, 3, writes);
      VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    });
    VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
    VK_CALL(DestroyPipelineLayout)(device, pushing, nullptr);
    VK_CALL(DestroyDescriptorSetLayout)(device, pushed, nullptr);
    return words(6);
  }
};

TEST_F(SlicedViews, StorageImagesSeeTheirSlicesAndSampledOnesAll) {
  EXPECT_EQ(seen(0, 2, 3), (std::vector<std::uint32_t>{3, 102, 104, 0, 100, 7}));
  EXPECT_EQ(seen(0, 5, VK_REMAINING_3D_SLICES_EXT), (std::vector<std::uint32_t>{3, 105, 107, 0, 100, 7}));
  EXPECT_EQ(seen(1, 1, 2), (std::vector<std::uint32_t>{2, 101, 102, 0, 100, 7}));
  EXPECT_EQ(seen(0, 0, 8), (std::vector<std::uint32_t>{8, 100, 107, 0, 100, 7}));
}

// ---- VK_EXT_nested_command_buffer

class NestedCommands : public Maintenance5Draws {
 protected:
  VkCommandBuffer secondary(VkCommandPool pool, const std::function<void(VkCommandBuffer)>& record,
                            VkResult expected = VK_SUCCESS) {
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
    const auto inherited = make_struct<VkCommandBufferInheritanceInfo>();
    auto begin = make_struct<VkCommandBufferBeginInfo>();
    begin.flags = VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT;
    begin.pInheritanceInfo = &inherited;
    EXPECT_EQ(VK_CALL(BeginCommandBuffer)(commands, &begin), VK_SUCCESS);
    record(commands);
    EXPECT_EQ(VK_CALL(EndCommandBuffer)(commands), expected);
    return commands;
  }
};

/// A tree of command buffers that all add up in one word, by copies from one part of a buffer to the next.
TEST_F(NestedCommands, RunInOrder) {
  const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
  VkCommandPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  const auto copy = [&](VkCommandBuffer commands, std::uint32_t from, std::uint32_t to) {
    const VkBufferCopy region{from * 4, to * 4, 4};
    VK_CALL(CmdCopyBuffer)(commands, results.buffer, results.buffer, 1, &region);
  };
  std::memset(results.data, 0, results.size);
  const std::uint32_t start = 77;
  std::memcpy(results.data, &start, sizeof start);
  const VkCommandBuffer leaf = secondary(pool, [&](VkCommandBuffer c) { copy(c, 1, 2); });
  const VkCommandBuffer middle = secondary(pool, [&](VkCommandBuffer c) {
    copy(c, 0, 1);
    VK_CALL(CmdExecuteCommands)(c, 1, &leaf);
    copy(c, 2, 3);
    VK_CALL(CmdExecuteCommands)(c, 1, &leaf);
  });
  run([&](VkCommandBuffer c) {
    VK_CALL(CmdExecuteCommands)(c, 1, &middle);
    copy(c, 3, 4);
  });
  EXPECT_EQ(words(5), (std::vector<std::uint32_t>{77, 77, 77, 77, 77}));
  VK_CALL(DestroyCommandPool)(device, pool, nullptr);
}

/// As deep as is claimed, and no deeper: the stack of who replays them ends somewhere.
TEST_F(NestedCommands, AreAsDeepAsIsClaimed) {
  auto properties = make_struct<VkPhysicalDeviceNestedCommandBufferPropertiesEXT>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  const std::uint32_t deepest = properties.maxCommandBufferNestingLevel;
  ASSERT_GE(deepest, 1u);
  const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
  VkCommandPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  VkCommandBuffer last = secondary(pool, [&](VkCommandBuffer c) {
    VK_CALL(CmdFillBuffer)
    (c, results.buffer, 0, 4, 0x1234);
  });
  for (std::uint32_t i = 1; i < deepest; ++i)
    last = secondary(pool, [&](VkCommandBuffer c) { VK_CALL(CmdExecuteCommands)(c, 1, &last); });
  run([&](VkCommandBuffer c) { VK_CALL(CmdExecuteCommands)(c, 1, &last); });
  EXPECT_EQ(words(1)[0], 0x1234u);
  last = secondary(pool, [&](VkCommandBuffer c) { VK_CALL(CmdExecuteCommands)(c, 1, &last); });
  secondary(
      pool,
      [&](VkCommandBuffer c) {
        VK_CALL(CmdExecuteCommands)
        (c, 1, &last);
      },
      VK_ERROR_OUT_OF_HOST_MEMORY);
  VK_CALL(DestroyCommandPool)(device, pool, nullptr);
}

// ---- VK_EXT_dynamic_rendering_unused_attachments

class UnusedAttachments : public Maintenance5Draws {
 protected:
  /// Draws with a pipeline for `format`, in a rendering whose attachments are these, cleared to 1 and to the depth
  /// 0.25.
  void draw_into(const Draw& draw, VkImageView color, VkImageView depth) {
    const VkPipeline pipeline = make_pipeline(draw);
    run([&](VkCommandBuffer commands) {
      auto color_attachment = make_struct<VkRenderingAttachmentInfo>(), depth_attachment = color_attachment;
      color_attachment.imageView = color;
      depth_attachment.imageView = depth;
      for (VkRenderingAttachmentInfo* a : {&color_attachment, &depth_attachment}) {
        a->imageLayout = VK_IMAGE_LAYOUT_GENERAL;
        a->loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      }
      color_attachment.clearValue.color = {{1, 1, 1, 1}};
      depth_attachment.clearValue.depthStencil = {0.25f, 0};
      auto info = make_struct<VkRenderingInfo>();
      info.renderArea = {{0, 0}, {kSide, kSide}};
      info.layerCount = 1;
      info.colorAttachmentCount = 1;
      info.pColorAttachments = &color_attachment;
      info.pDepthAttachment = &depth_attachment;
      VK_CALL(CmdBeginRenderingKHR)(commands, &info);
      VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
      VK_CALL(CmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
      const VkColorComponentFlags all = 0xf;
      VK_CALL(CmdSetColorWriteMaskEXT)(commands, 0, 1, &all);
      VK_CALL(CmdSetDepthTestEnableEXT)(commands, VK_TRUE);
      VK_CALL(CmdSetDepthWriteEnableEXT)(commands, VK_TRUE);
      VK_CALL(CmdSetDepthCompareOpEXT)(commands, VK_COMPARE_OP_LESS);
      VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
      VK_CALL(CmdEndRenderingKHR)(commands);
    });
    VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
  }
  static Draw writer(VkFormat format, std::vector<VkDynamicState> dynamic) {
    Draw draw;
    draw.fragment =
        "layout(set = 0, binding = 0) buffer B { uint words[]; };\n"
        "layout(location = 0) out vec4 c;\nvoid main() { atomicAdd(words[0], 1u); c = vec4(0, 1, 0, 1); }";
    draw.format = format;
    draw.dynamic = std::move(dynamic);
    return draw;
  }
};

/// Vulkan 1.4.309, Fragment Output Interface: what the pipeline names no format for is not written.
TEST_F(UnusedAttachments, AreLeftAloneWhereThePipelineHasNone) {
  const std::vector<VkDynamicState> dynamic{VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT, VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE,
                                            VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE, VK_DYNAMIC_STATE_DEPTH_COMPARE_OP};
  for (const auto& states : {std::vector<VkDynamicState>{}, dynamic}) {
    const Picture depth = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_D32_SFLOAT, {kSide, kSide, 1}, 1,
                                       VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
    const auto depth_at = [&] {
      float value;
      std::memcpy(&value, depth.row(0, 3), sizeof value);
      return value;
    };
    // A pipeline for a colour and no depth: the depth test, which none of its fragments at 0.5 would pass, is none.
    const Picture drawn = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {kSide, kSide, 1}, 1);
    draw_into(writer(VK_FORMAT_R8G8B8A8_UNORM, states), drawn.view, depth.view);
    EXPECT_EQ(texel(drawn, 3, 3, 4), 0xff00ff00u);
    EXPECT_EQ(depth_at(), 0.25f);
    // One without a colour, too.
    const Picture left = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {kSide, kSide, 1}, 1);
    draw_into(writer(VK_FORMAT_UNDEFINED, states), left.view, depth.view);
    EXPECT_EQ(texel(left, 3, 3, 4), 0xffffffffu);
    EXPECT_EQ(depth_at(), 0.25f);
  }
}

TEST_F(UnusedAttachments, MayBeAbsentWhereThePipelineHasThem) {
  std::memset(results.data, 0, results.size);
  draw_into(writer(VK_FORMAT_R16G16_SFLOAT, {}), VK_NULL_HANDLE, VK_NULL_HANDLE);
  EXPECT_EQ(words(1)[0], kSide * kSide) << "its fragments are shaded";
}

// ---- VK_EXT_attachment_feedback_loop_dynamic_state

using FeedbackLoopState = Maintenance5Draws;

TEST_F(FeedbackLoopState, MayBeSetAtAnyTime) {
  Draw draw;
  draw.fragment = "layout(location = 0) out vec4 c; void main() { c = vec4(1, 0, 1, 0); }";
  draw.dynamic = {VK_DYNAMIC_STATE_ATTACHMENT_FEEDBACK_LOOP_ENABLE_EXT};
  const Picture picture = render(draw, [&](VkCommandBuffer commands) {
    VK_CALL(CmdSetAttachmentFeedbackLoopEnableEXT)(commands, VK_IMAGE_ASPECT_COLOR_BIT);
    VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
  });
  EXPECT_EQ(texel(picture, 5, 5, 4), 0x00ff00ffu);
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
