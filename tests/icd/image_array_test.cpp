// Arrays of images indexed by loop counters and by memory, which the reference does not offer: against known values.
#include <array>

#include "tests/icd/fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

constexpr std::uint32_t kCount = 4;
constexpr VkDeviceSize kImageStep = 4096;  ///< bytes between the images in the one allocation
constexpr VkDeviceSize kBufferOffset = 2 * kCount * kImageStep;

class ImageArrays : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    VkMemoryAllocateInfo info = make_struct<VkMemoryAllocateInfo>();
    info.allocationSize = kBufferOffset + 4096;
    ASSERT_EQ(VK_GET(instance, AllocateMemory)(device, &info, nullptr, &memory), VK_SUCCESS);
    void* data;
    ASSERT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    bytes = static_cast<std::byte*>(data);
    for (std::uint32_t i = 0; i < 2 * kCount; ++i) make_image(i);
    VkBufferCreateInfo buffer_info = make_struct<VkBufferCreateInfo>();
    buffer_info.size = 8;
    buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    ASSERT_EQ(VK_GET(instance, CreateBuffer)(device, &buffer_info, nullptr, &buffer), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, kBufferOffset), VK_SUCCESS);
  }

  void TearDown() override {
    for (const VkImageView view : views) VK_GET(instance, DestroyImageView)(device, view, nullptr);
    for (const VkImage image : images) VK_GET(instance, DestroyImage)(device, image, nullptr);
    VK_GET(instance, DestroyBuffer)(device, buffer, nullptr);
    VK_GET(instance, FreeMemory)(device, memory, nullptr);
    DeviceTest::TearDown();
  }

  void make_image(std::uint32_t i) {
    VkImageCreateInfo info = make_struct<VkImageCreateInfo>();
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R32_UINT;
    info.extent = {1, 1, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_LINEAR;
    info.usage = i < kCount ? VK_IMAGE_USAGE_SAMPLED_BIT : VK_IMAGE_USAGE_STORAGE_BIT;
    ASSERT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &images[i]), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, BindImageMemory)(device, images[i], memory, i * kImageStep), VK_SUCCESS);
    VkImageViewCreateInfo view = make_struct<VkImageViewCreateInfo>();
    view.image = images[i];
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    ASSERT_EQ(VK_GET(instance, CreateImageView)(device, &view, nullptr, &views[i]), VK_SUCCESS);
  }

  /// The texel of an image or a word of the buffer.
  std::uint32_t& word(VkDeviceSize offset) { return *reinterpret_cast<std::uint32_t*>(bytes + offset); }
  std::uint32_t& texel(std::uint32_t image) { return word(image * kImageStep); }

  void write_set(VkDescriptorSet set) {
    std::array<VkDescriptorImageInfo, 2 * kCount> infos;
    for (std::uint32_t i = 0; i < infos.size(); ++i) infos[i] = {VK_NULL_HANDLE, views[i], VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo buffer_info{buffer, 0, VK_WHOLE_SIZE};
    std::array<VkWriteDescriptorSet, 3> writes;
    for (std::uint32_t i = 0; i < writes.size(); ++i) {
      writes[i] = make_struct<VkWriteDescriptorSet>();
      writes[i].dstSet = set;
      writes[i].dstBinding = i;
      writes[i].descriptorType = kTypes[i];
      writes[i].descriptorCount = i < 2 ? kCount : 1;
      writes[i].pImageInfo = infos.data() + i * kCount;
      writes[i].pBufferInfo = &buffer_info;
    }
    writes[2].pImageInfo = nullptr;
    VK_GET(instance, UpdateDescriptorSets)(device, 3, writes.data(), 0, nullptr);
  }

  static constexpr std::array<VkDescriptorType, 3> kTypes{
      VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};

  VkDeviceMemory memory = VK_NULL_HANDLE;
  std::byte* bytes = nullptr;
  std::array<VkImage, 2 * kCount> images{};  // sampled, then storage
  std::array<VkImageView, 2 * kCount> views{};
  VkBuffer buffer = VK_NULL_HANDLE;
};

TEST_F(ImageArrays, AreIndexedDynamically) {
  std::array<VkDescriptorSetLayoutBinding, 3> bindings{};
  std::array<VkDescriptorPoolSize, 3> sizes{};
  for (std::uint32_t i = 0; i < 3; ++i) {
    bindings[i] = {i, kTypes[i], i < 2 ? kCount : 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    sizes[i] = {kTypes[i], bindings[i].descriptorCount};
  }
  auto layout_info = make_struct<VkDescriptorSetLayoutCreateInfo>();
  layout_info.bindingCount = 3;
  layout_info.pBindings = bindings.data();
  VkDescriptorSetLayout set_layout;
  ASSERT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &layout_info, nullptr, &set_layout), VK_SUCCESS);
  auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = 3;
  pool_info.pPoolSizes = sizes.data();
  VkDescriptorPool pool;
  ASSERT_EQ(VK_GET(instance, CreateDescriptorPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout;
  VkDescriptorSet set;
  ASSERT_EQ(VK_GET(instance, AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
  write_set(set);
  auto pipeline_layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  pipeline_layout_info.setLayoutCount = 1;
  pipeline_layout_info.pSetLayouts = &set_layout;
  VkPipelineLayout layout;
  ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &pipeline_layout_info, nullptr, &layout), VK_SUCCESS);
  auto module_info = make_struct<VkShaderModuleCreateInfo>();
  module_info.codeSize = sizeof kImageArrayWords;
  module_info.pCode = kImageArrayWords;
  VkShaderModule module;
  ASSERT_EQ(VK_GET(instance, CreateShaderModule)(device, &module_info, nullptr, &module), VK_SUCCESS);
  auto pipeline_info = make_struct<VkComputePipelineCreateInfo>();
  pipeline_info.stage = make_struct<VkPipelineShaderStageCreateInfo>();
  pipeline_info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  pipeline_info.stage.module = module;
  pipeline_info.stage.pName = "main";
  pipeline_info.layout = layout;
  VkPipeline pipeline;
  ASSERT_EQ(VK_GET(instance, CreateComputePipelines)(device, {}, 1, &pipeline_info, nullptr, &pipeline), VK_SUCCESS);

  for (std::uint32_t which = 0; which < kCount; ++which) {
    for (std::uint32_t i = 0; i < kCount; ++i) texel(i) = i + 1;
    for (std::uint32_t i = 0; i < kCount; ++i) texel(kCount + i) = 0;
    word(kBufferOffset) = which;
    dispatch(pipeline, layout, set);
    const std::uint32_t sum = 1234 + (which + 1) * 100000;
    EXPECT_EQ(word(kBufferOffset + 4), sum);
    for (std::uint32_t i = 0; i < kCount; ++i) EXPECT_EQ(texel(kCount + i), i == ((which + 1) & 3) ? sum : 0u) << which;
  }

  VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
  VK_GET(instance, DestroyShaderModule)(device, module, nullptr);
  VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
  VK_GET(instance, DestroyDescriptorPool)(device, pool, nullptr);
  VK_GET(instance, DestroyDescriptorSetLayout)(device, set_layout, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
