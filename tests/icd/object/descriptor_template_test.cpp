// Update templates gather strided infos into writes.
#include "icd/object/descriptor_template.h"

#include <gtest/gtest.h>

namespace vitrine::icd {
namespace {

struct Item {
  std::uint64_t before;
  VkDescriptorBufferInfo info;
  std::uint32_t after;
};

TEST(Descriptors, TemplatesGatherStridedInfos) {
  Item items[3] = {};
  for (std::uint32_t i = 0; i < 3; ++i) items[i].info = {VK_NULL_HANDLE, i * 16u, i + 1u};
  VkDescriptorUpdateTemplateEntry entry{};
  entry.dstBinding = 5;
  entry.dstArrayElement = 2;
  entry.descriptorCount = 3;
  entry.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  entry.offset = offsetof(Item, info);
  entry.stride = sizeof(Item);
  TemplateScratch scratch{HostMemory()};
  const VkWriteDescriptorSet write = make_write(entry, items, scratch);
  EXPECT_EQ(write.dstBinding, 5u);
  EXPECT_EQ(write.dstArrayElement, 2u);
  ASSERT_EQ(write.descriptorCount, 3u);
  ASSERT_NE(write.pBufferInfo, nullptr);
  EXPECT_EQ(write.pImageInfo, nullptr);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(write.pBufferInfo[i].offset, i * 16u);
    EXPECT_EQ(write.pBufferInfo[i].range, i + 1u);
  }
}

TEST(Descriptors, TemplatesChooseTheArrayByType) {
  const VkDescriptorImageInfo image{VK_NULL_HANDLE, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_GENERAL};
  VkDescriptorUpdateTemplateEntry entry{};
  entry.descriptorCount = 1;
  entry.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  TemplateScratch scratch{HostMemory()};
  const VkWriteDescriptorSet write = make_write(entry, &image, scratch);
  ASSERT_NE(write.pImageInfo, nullptr);
  EXPECT_EQ(write.pImageInfo->imageLayout, VK_IMAGE_LAYOUT_GENERAL);
  const VkBufferView views[2] = {};
  entry.descriptorCount = 2;
  entry.stride = sizeof(VkBufferView);
  entry.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
  EXPECT_NE(make_write(entry, views, scratch).pTexelBufferView, nullptr);
}

}  // namespace
}  // namespace vitrine::icd
