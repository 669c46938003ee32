// Texels and their addresses, both ways.
#include "glass/pixel/locate.h"

#include <gtest/gtest.h>

#include <set>

namespace vitrine::glass::pixel {
namespace {

/// Every texel of a plane of an image has an address of its own, which names the texel.
void expect_both_ways(const texel::ImageDesc& desc, VkImageAspectFlagBits aspect) {
  texel::ImageLayout layout;
  ASSERT_TRUE(texel::make_image_layout(desc, layout));
  std::vector<std::byte> memory(layout.size);
  std::byte* const first = memory.data();
  const ImagePlace place{&layout, &first, nullptr};
  const texel::PlaneLayout& plane = layout.plane[texel::plane_of_aspect(layout, aspect)];
  const texel::FormatDesc& format = texel::format_desc(plane.format);
  std::set<const std::byte*> seen;
  TexelId id;
  id.aspect = aspect;
  for (id.level = 0; id.level < desc.levels; ++id.level) {
    const texel::Extent& extent = plane.level[id.level].extent;
    for (id.layer = 0; id.layer < desc.layers; ++id.layer)
      for (id.slice = 0; id.slice < extent.depth; ++id.slice)
        for (id.sample = 0; id.sample < desc.samples; ++id.sample)
          for (id.y = 0; id.y < extent.height; id.y += format.block_height)
            for (id.x = 0; id.x < extent.width; id.x += format.block_width) {
              const std::byte* const address = address_of(place, id);
              EXPECT_TRUE(seen.insert(address).second);
              const auto back = id_at(place, address);
              ASSERT_TRUE(back.has_value());
              EXPECT_TRUE(*back == id) << id.level << " " << id.layer << " " << id.x << " " << id.y;
            }
  }
}

texel::ImageDesc desc_of(VkFormat format) {
  texel::ImageDesc desc;
  desc.format = format;
  desc.extent = {13, 7, 1};
  return desc;
}

TEST(PixelLocate, LevelsAndLayers) {
  texel::ImageDesc desc = desc_of(VK_FORMAT_R8G8B8A8_UNORM);
  desc.levels = 4;
  desc.layers = 3;
  expect_both_ways(desc, VK_IMAGE_ASPECT_COLOR_BIT);
}

TEST(PixelLocate, Volumes) {
  texel::ImageDesc desc = desc_of(VK_FORMAT_R16_SFLOAT);
  desc.type = VK_IMAGE_TYPE_3D;
  desc.extent.depth = 5;
  desc.levels = 3;
  expect_both_ways(desc, VK_IMAGE_ASPECT_COLOR_BIT);
}

TEST(PixelLocate, SamplesOfDepthAndStencil) {
  texel::ImageDesc desc = desc_of(VK_FORMAT_D24_UNORM_S8_UINT);
  desc.samples = 4;
  desc.layers = 2;
  expect_both_ways(desc, VK_IMAGE_ASPECT_DEPTH_BIT);
  expect_both_ways(desc, VK_IMAGE_ASPECT_STENCIL_BIT);
}

TEST(PixelLocate, Blocks) {
  texel::ImageDesc desc = desc_of(VK_FORMAT_BC1_RGBA_UNORM_BLOCK);
  desc.levels = 3;
  expect_both_ways(desc, VK_IMAGE_ASPECT_COLOR_BIT);
}

TEST(PixelLocate, ElsewhereIsNoTexel) {
  texel::ImageLayout layout;
  ASSERT_TRUE(texel::make_image_layout(desc_of(VK_FORMAT_R8_UNORM), layout));
  std::vector<std::byte> memory(layout.size + 2);
  std::byte* const first = memory.data() + 1;
  const ImagePlace place{&layout, &first, nullptr};
  EXPECT_FALSE(id_at(place, memory.data()));
  EXPECT_FALSE(id_at(place, first + layout.size));
  EXPECT_FALSE(id_at(place, first + 13));  // between rows
}

}  // namespace
}  // namespace vitrine::glass::pixel
