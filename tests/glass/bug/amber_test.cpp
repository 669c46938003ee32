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
  EXPECT_EQ(to_amber(bug_with_image(VK_FORMAT_R16_SFLOAT)).message(),
            "AmberScript is not written for images of format 76");
  Bug swizzled = bug_with_image(VK_FORMAT_R32_UINT);
  swizzled.views[0].swizzle = {2, 1, 0, 3};
  EXPECT_EQ(to_amber(swizzled).message(), "AmberScript is not written for views that show an image as another one");
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

TEST(Amber, HasNoWordsForSomeState) {
  const auto said = [](const auto& change) {
    Bug bug = drawing_bug();
    change(bug);
    return to_amber(bug).message();
  };
  EXPECT_EQ(said([](Bug& b) { b.state.cull_mode = VK_CULL_MODE_BACK_BIT; }),
            "AmberScript is not written for culling, or front faces that are clockwise");
  EXPECT_EQ(said([](Bug& b) { b.state.blend[0].write_mask = 7; }), "AmberScript is not written for masks of colours");
  EXPECT_EQ(said([](Bug& b) { b.rendering.area.extent.width = 1; }),
            "AmberScript is not written for scissors and render areas that leave something out");
  EXPECT_EQ(said([](Bug& b) { b.command.draws.push_back({}); }), "AmberScript is not written for several draws");
  EXPECT_EQ(said([](Bug& b) { b.addressed = {0}; }),
            "AmberScript is not written for shaders that follow device addresses");
}

}  // namespace
}  // namespace vitrine::glass::bug
