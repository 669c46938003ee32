// Layouts and views: no two texels overlap, everything lies inside the image, views address what they name.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "texel/view.h"

namespace vitrine::texel {
namespace {

TEST(Layout, EveryBlockHasItsOwnBytes) {
  ImageDesc desc;
  desc.format = VK_FORMAT_D24_UNORM_S8_UINT;
  desc.extent = {13, 7, 1};
  desc.levels = 4;
  desc.layers = 3;
  desc.samples = 4;
  ImageLayout layout;
  ASSERT_TRUE(make_image_layout(desc, layout));
  ASSERT_EQ(layout.plane_count, 2u);
  std::vector<std::byte> memory(layout.size);
  std::set<const std::byte*> seen;
  for (const auto aspect : {VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
    ImageViewDesc vd;
    vd.type = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    vd.format = desc.format;
    vd.aspect = aspect;
    vd.level_count = 4;
    vd.layer_count = 3;
    const ImageView view = make_image_view(layout, memory.data(), vd);
    for (std::uint32_t level = 0; level < 4; ++level)
      for (std::uint32_t layer = 0; layer < 3; ++layer)
        for (std::uint32_t s = 0; s < 4; ++s)
          for (std::uint32_t y = 0; y < view.level[level].extent.height; ++y)
            for (std::uint32_t x = 0; x < view.level[level].extent.width; ++x)
              for (std::uint32_t b = 0; b < view.format->block_bytes; ++b) {
                const std::byte* p = view.block(level, layer, s, x, y, 0) + b;
                ASSERT_TRUE(p >= memory.data() && p < memory.data() + memory.size());
                ASSERT_TRUE(seen.insert(p).second);
              }
  }
}

TEST(Layout, TooLargeIsAnError) {
  ImageDesc desc;
  desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  desc.extent = {0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF};
  ImageLayout layout;
  EXPECT_FALSE(make_image_layout(desc, layout));
  desc.extent = {1, 1, 1};
  desc.format = VK_FORMAT_UNDEFINED;
  EXPECT_FALSE(make_image_layout(desc, layout));
}

TEST(Layout, ViewsOfLevelsLayersSlicesAndBlocks) {
  ImageDesc desc;
  desc.type = VK_IMAGE_TYPE_3D;
  desc.format = VK_FORMAT_BC1_RGB_UNORM_BLOCK;
  desc.extent = {20, 12, 5};
  desc.levels = 3;
  ImageLayout layout;
  ASSERT_TRUE(make_image_layout(desc, layout));
  std::vector<std::byte> memory(layout.size);
  ImageViewDesc vd;
  vd.type = VK_IMAGE_VIEW_TYPE_3D;
  vd.format = desc.format;
  vd.base_level = 1;
  vd.level_count = 2;
  const ImageView whole = make_image_view(layout, memory.data(), vd);
  EXPECT_EQ(whole.level[0].extent.width, 10u);
  EXPECT_EQ(whole.level0_extent.width, 20u);
  EXPECT_EQ(whole.level[1].extent.depth, 1u);

  vd.type = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  vd.format = VK_FORMAT_R32G32_UINT;
  vd.level_count = 1;
  vd.base_layer = 1;
  vd.layer_count = 1;
  const ImageView slice = make_image_view(layout, memory.data(), vd);
  EXPECT_EQ(slice.block(0, 0, 0, 2, 1, 0), whole.block(0, 0, 0, 2, 1, 1));
  EXPECT_EQ(slice.level[0].extent.width, 3u);  // blocks
  EXPECT_EQ(slice.level[0].extent.height, 2u);
}

}  // namespace
}  // namespace vitrine::texel
