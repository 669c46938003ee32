// AmberScript: what it says of a dispatch, and what it has no words for.
#include "glass/bug/amber.h"

#include <gtest/gtest.h>

#include "glass/bug/contents.h"
#include "tests/glass/bug/bugs.h"

namespace vitrine::glass::bug {
namespace {

TEST(Amber, SaysADispatchWithItsData) {
  const base::Result<std::string> script = to_amber(small_bug());
  ASSERT_TRUE(script.ok()) << script.message();
  EXPECT_TRUE(script.value().starts_with("#!amber\n"));
  for (const char* const part :
       {"SHADER compute shader0 SPIRV-HEX\n03 02 23 07 00 03 01 00 00 00 00 00 01 00 00 00 00 00 00 00END\n",
        "# particles\nBUFFER buffer0 DATA_TYPE uint32 STD430 DATA\n"
        "0x00000000 0x00000000 0x00000000 0x00000000 0x00000001 0x00000002 0x00000003 0x00000004\n",
        "ATTACH shader0 TYPE compute ENTRY_POINT main SPECIALIZE 3 AS uint32 5\n",
        "BIND BUFFER buffer0 AS storage DESCRIPTOR_SET 0 BINDING 0 DESCRIPTOR_OFFSET 0 DESCRIPTOR_RANGE 64\n",
        "BIND BUFFER pushed AS push_constant\n", "RUN pipeline 4 2 1\n", "EXPECT buffer0 EQ_BUFFER expected0\n"})
    EXPECT_NE(script.value().find(part), std::string::npos) << part << script.value();
}

void expect_words(const Bug& bug, std::initializer_list<const char*> parts) {
  const base::Result<std::string> script = to_amber(bug);
  ASSERT_TRUE(script.ok()) << script.message();
  for (const char* const part : parts)
    EXPECT_NE(script.value().find(part), std::string::npos) << part << script.value();
}

/// With an image of two texels at binding 1.
Bug bug_with_image(VkFormat format) {
  Bug bug = small_bug();
  Image image;
  image.format = format;
  image.extent = {2, 1, 1};
  image.texels = {{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1, false, blob({1, 0x3f800000}), nullptr, nullptr}};
  bug.images = {image};
  View view;
  view.image = 0;
  view.format = format;
  bug.views = {view};
  Binding binding;
  binding.binding = 1;
  binding.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  binding.count = 1;
  bug.sets[0].bindings.push_back(binding);
  Descriptor descriptor;
  descriptor.binding = 1;
  descriptor.view = 0;
  bug.descriptors.push_back(descriptor);
  return bug;
}

TEST(Amber, SaysImagesWithTheirTexels) {
  const base::Result<std::string> script = to_amber(bug_with_image(VK_FORMAT_R32_UINT));
  ASSERT_TRUE(script.ok()) << script.message();
  for (const char* const part :
       {"IMAGE image0 FORMAT R32_UINT DIM_2D WIDTH 2 HEIGHT 1 DATA\n0x00000001 0x3f800000\nEND\n",
        "BIND BUFFER image0 AS storage_image DESCRIPTOR_SET 0 BINDING 1\n",
        "EXPECT image0 EQ_BUFFER expected_image0\n"})
    EXPECT_NE(script.value().find(part), std::string::npos) << part << script.value();
  EXPECT_NE(to_amber(bug_with_image(VK_FORMAT_R32_SFLOAT)).value().find("1.40129846e-45 1\n"), std::string::npos);
}

TEST(Amber, HasNoWordsForSomeImages) {
  EXPECT_EQ(to_amber(bug_with_image(VK_FORMAT_R8G8B8_UNORM)).message(),
            "AmberScript is not written for images of format 23");
  Bug infinite = bug_with_image(VK_FORMAT_R16_SFLOAT);
  infinite.images[0].texels[0].before = blob({0x7c003c00});
  EXPECT_EQ(to_amber(infinite).message(), "AmberScript is not written for texels that are no numbers");
  Bug swizzled = bug_with_image(VK_FORMAT_R32_UINT);
  swizzled.views[0].swizzle = {2, 1, 0, 3};
  EXPECT_EQ(to_amber(swizzled).message(), "AmberScript is not written for views that swap components");
  const auto said = [](const auto& change) {
    Bug bug = bug_with_image(VK_FORMAT_R32_UINT);
    change(bug, bug.images[0]);
    return to_amber(bug).message();
  };
  EXPECT_EQ(said([](Bug& b, Image&) { b.views[0].type = VK_IMAGE_VIEW_TYPE_2D_ARRAY; }),
            "AmberScript is not written for arrays of images, cubes, or slices");
  EXPECT_EQ(said([](Bug&, Image& i) { i.samples = 4; }), "AmberScript is not written for images of several samples");
  EXPECT_EQ(said([](Bug&, Image& i) { i.texels.push_back(i.texels[0]); }),
            "AmberScript is not written for images of which several levels or aspects are seen");
  EXPECT_EQ(said([](Bug&, Image& i) { i.texels[0].layers = 2; }),
            "AmberScript is not written for images of which several layers are seen");
  EXPECT_EQ(said([](Bug& b, Image&) {
              b.views.push_back(b.views[0]);
              b.views[1].format = VK_FORMAT_R32_SINT;
            }),
            "AmberScript is not written for images that are shown in two formats");
}

TEST(Amber, SaysTheLevelAndLayerOfAnImageThatIsSeen) {
  Bug bug = bug_with_image(VK_FORMAT_R32_UINT);
  bug.images[0].extent = {9, 4, 1};
  bug.images[0].levels = 4;
  bug.images[0].layers = 7;
  bug.images[0].texels[0].level = 2;
  bug.images[0].texels[0].layer = 5;
  bug.views[0].range = {VK_IMAGE_ASPECT_COLOR_BIT, 2, 1, 5, 1};
  expect_words(bug, {"IMAGE image0 FORMAT R32_UINT DIM_2D WIDTH 2 HEIGHT 1 DATA\n0x00000001 0x3f800000\nEND\n"});
}

TEST(Amber, SaysLevelsThatAreAllAlike) {
  Bug bug = bug_with_image(VK_FORMAT_R32_UINT);
  Image& image = bug.images[0];
  image.extent = {4, 4, 1};
  image.levels = 3;
  image.texels[0].level = 1;
  image.texels[0].before = blob({7, 8, 9, 5});
  image.texels.push_back(image.texels[0]);
  image.texels[1].level = 2;
  image.texels[1].before = blob({7});
  bug.views[0].range = {VK_IMAGE_ASPECT_COLOR_BIT, 1, 2, 0, 1};
  expect_words(bug, {"IMAGE image0 FORMAT R32_UINT MIP_LEVELS 2 DIM_2D WIDTH 2 HEIGHT 2 DATA\n"
                     "0x00000007 0x00000008 0x00000009 0x00000005\nEND\n"});
  const auto said = [&](const auto& change) {
    Bug other = bug;
    change(other, other.images[0].texels[1]);
    return to_amber(other).message();
  };
  const char* const none = "AmberScript is not written for images of which several levels or aspects are seen";
  EXPECT_EQ(said([](Bug&, Texels& t) { t.before = blob({8}); }), none);
  EXPECT_EQ(said([](Bug&, Texels& t) { t.after = blob({8}); }), none);
  EXPECT_EQ(said([](Bug& b, Texels&) { b.images[0].texels[0].after = blob({6, 8, 9, 5}); }), none);
  EXPECT_EQ(said([](Bug& b, Texels&) { b.images[0].extent.height = 2; }), none);  // no level has no rows in Amber
  EXPECT_EQ(said([](Bug& b, Texels&) { b.views[0].range.levelCount = 1; }), none);
  EXPECT_EQ(said([](Bug&, Texels& t) { t.aspect = VK_IMAGE_ASPECT_STENCIL_BIT; }), none);
}

TEST(Amber, SaysImagesInTheFormatOfTheirViews) {
  Bug bug = bug_with_image(VK_FORMAT_R32_UINT);
  bug.views[0].format = VK_FORMAT_R32_SFLOAT;
  expect_words(bug, {"IMAGE image0 FORMAT R32_SFLOAT DIM_2D WIDTH 2 HEIGHT 1 DATA\n1.40129846e-45 1\nEND\n"});
}

TEST(Amber, SaysPackedAndLongTexelsAsOneNumber) {
  expect_words(bug_with_image(VK_FORMAT_A2B10G10R10_UNORM_PACK32),
               {"IMAGE image0 FORMAT A2B10G10R10_UNORM_PACK32 DIM_2D WIDTH 2 HEIGHT 1 DATA\n0x00000001 0x3f800000\n"});
  Bug bug = bug_with_image(VK_FORMAT_R64_UINT);
  bug.images[0].extent = {1, 1, 1};
  expect_words(bug, {"IMAGE image0 FORMAT R64_UINT DIM_2D WIDTH 1 HEIGHT 1 DATA\n0x3f80000000000001\nEND\n"});
  bug = bug_with_image(VK_FORMAT_R5G6B5_UNORM_PACK16);
  expect_words(bug, {"FORMAT R5G6B5_UNORM_PACK16 DIM_2D WIDTH 2 HEIGHT 1 DATA\n0x0001 0x0000 0x0000 0x3f80\nEND\n"});
}

TEST(Amber, SaysTexelsOfSixteenBits) {
  Bug bug = bug_with_image(VK_FORMAT_R16_SFLOAT);
  bug.images[0].texels[0].before = blob({0x80003c00});
  expect_words(bug, {"IMAGE image0 FORMAT R16_SFLOAT DIM_2D WIDTH 2 HEIGHT 1 DATA\n1 -0.0\nEND\n"});
  bug = bug_with_image(VK_FORMAT_R16G16_UNORM);
  expect_words(bug, {"IMAGE image0 FORMAT R16G16_UNORM DIM_2D WIDTH 2 HEIGHT 1 DATA\n0x0001 0x0000 0x0000 0x3f80\n"});
}

/// With a descriptor at binding 2.
Bug bug_with(VkDescriptorType type, const Descriptor& what) {
  Bug bug = small_bug();
  Binding binding;
  binding.binding = 2;
  binding.type = type;
  binding.count = 1;
  bug.sets[0].bindings.push_back(binding);
  bug.descriptors.push_back(what);
  bug.descriptors.back().binding = 2;
  return bug;
}

TEST(Amber, SaysTexelBuffersOfWholeBuffers) {
  Descriptor descriptor;
  descriptor.texels = 0;
  Bug bug = bug_with(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, descriptor);
  bug.buffers.push_back({"texels", 8, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT, 1, 0});
  bug.memories.push_back({8, 0, {{0, false, blob({0x04030201, 0x3f800000}), nullptr}}});
  bug.buffer_views = {{"", 1, VK_FORMAT_R8G8B8A8_UINT, 0, 8}};
  expect_words(bug, {"BUFFER buffer1 DATA_TYPE R8G8B8A8_UINT STD430 DATA\n1 2 3 4 0 0 128 63\nEND\n",
                     "BUFFER expected1 DATA_TYPE R8G8B8A8_UINT STD430 DATA\n",
                     "BIND BUFFER buffer1 AS storage_texel_buffer DESCRIPTOR_SET 0 BINDING 2\n"});
}

/// Two words at binding 2, of which a view shows the second one, with what it becomes.
Bug bug_with_a_part(std::uint32_t after) {
  Descriptor descriptor;
  descriptor.texels = 0;
  Bug bug = bug_with(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, descriptor);
  bug.buffers.push_back({"texels", 8, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT, 1, 0});
  bug.memories.push_back({8, 0, {{0, false, blob({5, 0x3f800000}), blob({5, after})}}});
  bug.buffer_views = {{"", 1, VK_FORMAT_R32_SFLOAT, 4, 4}};
  return bug;
}

TEST(Amber, SaysTexelBuffersOfPartsAsBuffersOfTheirOwn) {
  const Bug bug = bug_with_a_part(0x40000000);
  expect_words(bug, {"BUFFER texels0 DATA_TYPE R32_SFLOAT STD430 DATA\n1\nEND\n",
                     "BUFFER expected_texels0 DATA_TYPE R32_SFLOAT STD430 DATA\n2\nEND\n",
                     "BIND BUFFER texels0 AS storage_texel_buffer DESCRIPTOR_SET 0 BINDING 2\n",
                     "EXPECT texels0 EQ_BUFFER expected_texels0\n"});
  EXPECT_EQ(to_amber(bug).value().find("buffer1 "), std::string::npos);
  Bug formats = bug;
  formats.buffer_views = {{"", 1, VK_FORMAT_R32_SFLOAT, 0, 8}, {"", 1, VK_FORMAT_R32_UINT, 0, 8}};
  formats.memories[1].pieces[0].after = nullptr;
  expect_words(formats, {"BUFFER texels0 DATA_TYPE R32_SFLOAT STD430 DATA\n7.00649232e-45 1\nEND\n",
                         "BUFFER texels1 DATA_TYPE R32_UINT STD430 DATA\n0x00000005 0x3f800000\nEND\n"});
}

TEST(Amber, HasNoWordsForPartsThatChangeWhereOthersSeeThem) {
  const char* const said =
      "AmberScript is not written for texel buffers that change and show parts of a buffer that is bound otherwise, "
      "too";
  Bug shared = bug_with_a_part(0x40000000);
  shared.descriptors[0].buffer = 1;
  shared.descriptors[0].range = 8;
  EXPECT_EQ(to_amber(shared).message(), said);
  Bug twice = bug_with_a_part(0x40000000);
  twice.buffer_views.push_back({"", 1, VK_FORMAT_R32_UINT, 0, 8});
  EXPECT_EQ(to_amber(twice).message(), said);
  twice.buffer_views[1].range = 4;
  EXPECT_TRUE(to_amber(twice).ok());
  Bug read = bug_with_a_part(0x3f800000);
  read.descriptors[0].buffer = 1;
  read.descriptors[0].range = 8;
  EXPECT_TRUE(to_amber(read).ok());
}

TEST(Amber, SaysInlineUniformBlocksAsBuffers) {
  Descriptor descriptor;
  descriptor.bytes = blob({7, 8});
  expect_words(bug_with(VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, descriptor),
               {"BUFFER block0_2 DATA_TYPE uint32 STD430 DATA\n0x00000007 0x00000008\nEND\n",
                "BIND BUFFER block0_2 AS uniform DESCRIPTOR_SET 0 BINDING 2\n"});
}

TEST(Amber, SaysImmutableSamplersThatCompare) {
  Bug bug = small_bug();
  Binding binding;
  binding.binding = 3;
  binding.count = 2;
  binding.samplers = {0, 0};
  bug.sets[0].bindings.push_back(binding);
  bug.samplers.resize(1);
  bug.samplers[0].state.compare = true;
  bug.samplers[0].state.compare_op = VK_COMPARE_OP_LESS_OR_EQUAL;
  expect_words(bug, {" COMPARE on COMPARE_OP less_or_equal\n",
                     "BIND SAMPLER_ARRAY sampler0 sampler0 DESCRIPTOR_SET 0 BINDING 3\n"});
}

TEST(Amber, SaysOneSamplerForImagesOfABinding) {
  Bug bug = bug_with_image(VK_FORMAT_R32_UINT);
  bug.sets[0].bindings[1].type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  bug.samplers.resize(2);
  bug.descriptors[1].sampler = 0;
  bug.descriptors.push_back(bug.descriptors[1]);
  bug.descriptors[2].element = 1;
  expect_words(bug, {"BIND BUFFER_ARRAY image0 image0 AS combined_image_sampler SAMPLER sampler0 DESCRIPTOR_SET 0"});
  bug.descriptors[2].sampler = 1;
  EXPECT_EQ(to_amber(bug).message(), "AmberScript is not written for arrays of images with several samplers");
  bug.sets[0].bindings.push_back(bug.sets[0].bindings[1]);
  bug.sets[0].bindings[2].binding = 2;
  bug.descriptors[2].element = 0;
  bug.descriptors[2].binding = 2;
  expect_words(bug, {"BIND BUFFER image0 AS combined_image_sampler SAMPLER sampler0 DESCRIPTOR_SET 0 BINDING 1\n",
                     "BIND BUFFER image0 AS combined_image_sampler SAMPLER sampler1 DESCRIPTOR_SET 0 BINDING 2\n"});
}

TEST(Amber, HasNoWordsForDescriptorsThatNothingHasWritten) {
  Bug bug = small_bug();
  bug.sets[0].bindings.push_back(bug.sets[0].bindings[0]);
  bug.sets[0].bindings[1].binding = 5;
  EXPECT_TRUE(to_amber(bug).ok());
  bug.stages[0].words = blob({0x07230203, 0x00010300, 0, 9, 0, 0x00040047, 7, 34, 0, 0x00040047, 7, 33, 5});
  EXPECT_EQ(to_amber(bug).message(), "AmberScript is not written for descriptors that nothing has written");
}

TEST(Amber, FillsHolesThatNobodyMayRead) {
  Bug bug = small_bug();
  bug.descriptors[0].element = 2;
  expect_words(bug, {"BIND BUFFER_ARRAY buffer0 buffer0 buffer0 AS storage DESCRIPTOR_SET 0 BINDING 0 "});
  bug.null_descriptors = true;
  EXPECT_EQ(to_amber(bug).message(), "AmberScript is not written for null descriptors");
}

TEST(Amber, ContentsAreThoseOfTheBuffer) {
  const Bug bug = small_bug();
  const Bytes before = contents_of(bug, bug.buffers[0], false), after = contents_of(bug, bug.buffers[0], true);
  ASSERT_EQ(before.size(), 64u);
  EXPECT_EQ(before[16], std::byte{1});
  EXPECT_EQ(before[28], std::byte{4});
  EXPECT_EQ(after[28], std::byte{5});
  EXPECT_EQ(after[63], std::byte{0});
}

/// Three vertices to an image of two texels.
Bug drawing_bug() {
  Bug bug = small_bug();
  Stage fragment = bug.stages[0];
  bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  fragment.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  bug.stages.push_back(fragment);
  Image target;
  target.format = VK_FORMAT_R32_UINT;
  target.extent = {2, 1, 1};
  target.texels = {{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1, false, blob({1, 2}), blob({3, 4}), nullptr}};
  bug.images = {target};
  View view;
  view.image = 0;
  view.format = target.format;
  bug.views = {view};
  bug.rendering.colors = {0};
  bug.rendering.area = {{0, 0}, {2, 1}};
  bug.state.viewport_count = 1;
  bug.state.viewport[0] = {0, 0, 2, 1, 0, 1};
  bug.state.scissor[0] = {{0, 0}, {2, 1}};
  bug.state.attribute_count = 1;
  bug.state.attribute[0] = {3, 5, VK_FORMAT_R32G32_SFLOAT, 4};
  Stream stream;
  stream.binding = 5;
  stream.buffer = 0;
  stream.offset = 8;
  stream.size = 56;
  stream.stride = 16;
  bug.streams = {stream};
  bug.command.draws = {{3, 0, 0}};
  return bug;
}

TEST(Amber, SaysADraw) {
  const base::Result<std::string> script = to_amber(drawing_bug());
  ASSERT_TRUE(script.ok()) << script.message();
  for (const char* const part :
       {"SHADER vertex shader0 SPIRV-HEX", "SHADER fragment shader1 SPIRV-HEX", "PIPELINE graphics pipeline\n",
        "  FRAMEBUFFER_SIZE 2 1\n  BIND BUFFER image0 AS color LOCATION 0\n",
        "  VERTEX_DATA buffer0 LOCATION 3 FORMAT R32G32_SFLOAT OFFSET 12 STRIDE 16\n",
        "  VIEWPORT 0.0 0.0 SIZE 2.0 1.0 MIN_DEPTH 0.0 MAX_DEPTH 1.0\n",
        "RUN pipeline DRAW_ARRAY AS TRIANGLE_LIST START_IDX 0 COUNT 3 START_INSTANCE 0 INSTANCE_COUNT 1\n",
        "EXPECT image0 EQ_BUFFER expected_image0\n"})
    EXPECT_NE(script.value().find(part), std::string::npos) << part << script.value();
}

TEST(Amber, SaysIndicesFromWhereTheyBegin) {
  Bug bug = drawing_bug();
  bug.command.indexed = true;
  bug.command.index_type = VK_INDEX_TYPE_UINT32;
  bug.command.indices.buffer = 0;
  bug.command.indices.offset = 16;
  bug.command.indices.size = 48;
  const base::Result<std::string> script = to_amber(bug);
  ASSERT_TRUE(script.ok()) << script.message();
  for (const char* const part : {"BUFFER indices DATA_TYPE uint32 STD430 DATA\n0x00000001 0x00000002 0x00000003\nEND\n",
                                 "  INDEX_DATA indices\n", " INDEXED START_IDX 0 COUNT 3 "})
    EXPECT_NE(script.value().find(part), std::string::npos) << part << script.value();
}

/// Amber's START_IDX is what is added to indices; they begin with the first one.
TEST(Amber, SaysWhichIndicesAndWhatIsAddedToThem) {
  Bug bug = drawing_bug();
  bug.command.indexed = true;
  bug.command.index_type = VK_INDEX_TYPE_UINT32;
  bug.command.indices.buffer = 0;
  bug.command.indices.offset = 16;
  bug.command.indices.size = 48;
  bug.command.draws = {{2, 1, 2}, {3, 0, 0}};
  expect_words(bug, {"BUFFER indices DATA_TYPE uint32 STD430 DATA\n0x00000002 0x00000003 0x00000000 0x00000000\nEND\n",
                     "BUFFER indices1 DATA_TYPE uint32 STD430 DATA\n0x00000001 0x00000002 0x00000003\nEND\n",
                     "PIPELINE graphics pipeline1\n", "  INDEX_DATA indices1\n",
                     "RUN pipeline DRAW_ARRAY AS TRIANGLE_LIST INDEXED START_IDX 2 COUNT 2 START_INSTANCE 0 ",
                     "RUN pipeline1 DRAW_ARRAY AS TRIANGLE_LIST INDEXED START_IDX 0 COUNT 3 START_INSTANCE 0 "});
}

TEST(Amber, SaysDrawsWhoseArgumentsAreInABuffer) {
  Bug bug = drawing_bug();
  bug.memories[0].pieces[0] = {0, false, blob({3, 2, 1, 5, 0, 0, 0, 0, 6, 1, 0, 0}), nullptr};
  bug.command.draws.clear();
  bug.command.arguments = 0;
  bug.command.draw_count = 3;
  bug.command.stride = 16;
  expect_words(bug,
               {"RUN pipeline DRAW_ARRAY AS TRIANGLE_LIST START_IDX 1 COUNT 3 START_INSTANCE 5 INSTANCE_COUNT 2\n"
                "RUN pipeline DRAW_ARRAY AS TRIANGLE_LIST START_IDX 0 COUNT 6 START_INSTANCE 0 INSTANCE_COUNT 1\n"});
  bug.command.arguments_offset = 64;
  EXPECT_EQ(to_amber(bug).message(), "AmberScript is not written for arguments outside of their buffer");
}

TEST(Amber, SaysAdvancedBlending) {
  Bug bug = drawing_bug();
  raster::BlendAttachment& blend = bug.state.blend[0];
  blend.enable = true;
  blend.color_op = blend.alpha_op = VK_BLEND_OP_HSL_HUE_EXT;
  blend.src_premultiplied = blend.dst_premultiplied = true;
  blend.overlap = VK_BLEND_OVERLAP_UNCORRELATED_EXT;
  expect_words(
      bug, {"DEVICE_EXTENSION VK_EXT_blend_operation_advanced\n", "    COLOR_OP hsl_hue\n", "    ALPHA_OP hsl_hue\n"});
  for (const auto& [op, name] : {std::pair(VK_BLEND_OP_ZERO_EXT, "COLOR_OP zero\n"),
                                 std::pair(VK_BLEND_OP_PLUS_CLAMPED_ALPHA_EXT, "COLOR_OP plus_clamped_alpha\n"),
                                 std::pair(VK_BLEND_OP_BLUE_EXT, "COLOR_OP blue\n")}) {
    blend.color_op = blend.alpha_op = op;
    expect_words(bug, {name});
  }
  blend.dst_premultiplied = false;
  EXPECT_EQ(to_amber(bug).message(),
            "AmberScript is not written for advanced blending of colours that are not premultiplied, or overlap");
}

TEST(Amber, SaysDrawsWithoutAttachments) {
  Bug bug = drawing_bug();
  bug.rendering.colors.clear();
  expect_words(bug, {"  FRAMEBUFFER_SIZE 2 1\n"});
}

TEST(Amber, HasNoWordsForSomeState) {
  const auto said = [](const auto& change) {
    Bug bug = drawing_bug();
    change(bug);
    return to_amber(bug).message();
  };
  EXPECT_EQ(said([](Bug& b) { b.state.cull_mode = VK_CULL_MODE_BACK_BIT; }),
            "AmberScript is not written for culling, or front faces that are clockwise");
  EXPECT_EQ(said([](Bug& b) {
              b.state.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
              b.state.line_width = 2;
            }),
            "AmberScript is not written for lines that are wide, stippled or of another kind");
  EXPECT_EQ(said([](Bug& b) { b.state.line_width = 2; }), "");            // of triangles
  EXPECT_EQ(said([](Bug& b) { b.state.primitive_restart = true; }), "");  // without indices
  EXPECT_EQ(said([](Bug& b) { b.state.blend[0].write_mask = 7; }), "AmberScript is not written for masks of colours");
  EXPECT_EQ(said([](Bug& b) { b.rendering.area.extent.width = 1; }),
            "AmberScript is not written for scissors and render areas that leave something out");
  EXPECT_EQ(said([](Bug& b) { b.command.draws.clear(); }), "AmberScript is not written for draws of nothing");
  EXPECT_EQ(said([](Bug& b) { b.command.draws[0].vertex_offset = -1; }),
            "AmberScript is not written for draws with a negative vertex offset");
  EXPECT_EQ(said([](Bug& b) {
              b.command.draws.push_back({3, 0, 0});
              b.stages[0].words = blob({0x07230203, 0x00010300, 0, 1, 0, 0x00020011, 1, 0x00020011, 4427});
            }),
            "AmberScript is not written for several draws whose shaders ask which one it is");
  EXPECT_EQ(said([](Bug& b) { b.addressed = {0}; }),
            "AmberScript is not written for shaders that follow device addresses");
}

}  // namespace
}  // namespace vitrine::glass::bug
