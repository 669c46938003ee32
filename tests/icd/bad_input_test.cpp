// Input that no valid application gives: damaged shader modules and absurd sizes. An error code each time; never a
// crash, and the device goes on working.
#include <array>
#include <cstring>
#include <vector>

#include "tests/icd/fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

constexpr VkDeviceSize kBufferSize = 1024;

/// A device with a storage buffer at set 0, binding 0, a pipeline layout for it, and commands that dispatch.
class DamagedShader : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    make_buffer();
    make_descriptors();
    const auto pool = make_struct<VkCommandPoolCreateInfo>();
    ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool, nullptr, &command_pool), VK_SUCCESS);
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = command_pool;
    allocate.commandBufferCount = 1;
    ASSERT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
    VK_CALL(GetDeviceQueue)(device, 0, 0, &queue);
  }

  void TearDown() override {
    VK_CALL(DestroyCommandPool)(device, command_pool, nullptr);
    VK_CALL(DestroyPipelineLayout)(device, layout, nullptr);
    VK_CALL(DestroyDescriptorPool)(device, descriptor_pool, nullptr);
    VK_CALL(DestroyDescriptorSetLayout)(device, set_layout, nullptr);
    VK_CALL(DestroyBuffer)(device, buffer, nullptr);
    VK_CALL(FreeMemory)(device, memory, nullptr);
    DeviceTest::TearDown();
  }

  void make_buffer() {
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = kBufferSize;
    ASSERT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
    void* data = nullptr;
    ASSERT_EQ(VK_CALL(MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    numbers = static_cast<std::uint32_t*>(data);
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = kBufferSize;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    ASSERT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &buffer), VK_SUCCESS);
    ASSERT_EQ(VK_CALL(BindBufferMemory)(device, buffer, memory, 0), VK_SUCCESS);
  }

  void make_descriptors() {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                                               nullptr};
    auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
    shape.bindingCount = 1;
    shape.pBindings = &binding;
    ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &set_layout), VK_SUCCESS);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    auto pool = make_struct<VkDescriptorPoolCreateInfo>();
    pool.maxSets = pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool, nullptr, &descriptor_pool), VK_SUCCESS);
    auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
    allocate.descriptorPool = descriptor_pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
    const VkDescriptorBufferInfo range{buffer, 0, VK_WHOLE_SIZE};
    auto write = make_struct<VkWriteDescriptorSet>();
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &range;
    VK_CALL(UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
    auto info = make_struct<VkPipelineLayoutCreateInfo>();
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
  }

  /// The pipeline of these words, or null; checks that the results of the two calls make sense.
  VkPipeline compile(const void* words, std::size_t bytes) {
    auto module_info = make_struct<VkShaderModuleCreateInfo>();
    module_info.codeSize = bytes;
    module_info.pCode = static_cast<const std::uint32_t*>(words);
    VkShaderModule module = VK_NULL_HANDLE;
    const VkResult made = VK_CALL(CreateShaderModule)(device, &module_info, nullptr, &module);
    if (made != VK_SUCCESS) {
      EXPECT_EQ(made, VK_ERROR_INVALID_SHADER_NV);
      return VK_NULL_HANDLE;
    }
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = make_struct<VkPipelineShaderStageCreateInfo>();
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult compiled = VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    EXPECT_EQ(compiled == VK_SUCCESS, pipeline != VK_NULL_HANDLE);
    EXPECT_TRUE(compiled == VK_SUCCESS || compiled == VK_ERROR_UNKNOWN) << compiled;
    VK_CALL(DestroyShaderModule)(device, module, nullptr);
    return pipeline;
  }

  /// Runs and destroys the pipeline.
  VkResult dispatch(VkPipeline pipeline) {
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    VkResult result = VK_CALL(ResetCommandPool)(device, command_pool, 0);
    if (result == VK_SUCCESS) result = VK_CALL(BeginCommandBuffer)(commands, &begin);
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_CALL(CmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    VK_CALL(CmdDispatch)(commands, 2, 1, 1);
    if (result == VK_SUCCESS) result = VK_CALL(EndCommandBuffer)(commands);
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    if (result == VK_SUCCESS) result = VK_CALL(QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE);
    if (result == VK_SUCCESS) result = VK_CALL(QueueWaitIdle)(queue);
    VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
    return result;
  }

  void expect_sound_module_works() {
    std::memset(numbers, 0, kBufferSize);
    const VkPipeline pipeline = compile(kComputeWords, sizeof kComputeWords);
    ASSERT_NE(pipeline, VkPipeline{VK_NULL_HANDLE});
    ASSERT_EQ(dispatch(pipeline), VK_SUCCESS);
    for (std::uint32_t i = 0; i < 128; ++i) ASSERT_EQ(numbers[i], i * 3 + 1);
  }

  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  std::uint32_t* numbers = nullptr;  ///< the buffer's contents
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkCommandPool command_pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
};

using Words = std::vector<std::uint32_t>;

TEST_F(DamagedShader, EveryBitFlipIsRefusedOrRuns) {
  const Words sound(std::begin(kComputeWords), std::end(kComputeWords));
  std::size_t refused = 0;
  std::size_t ran = 0;
  for (std::size_t bit = 0; bit < sound.size() * 32; ++bit) {
    Words damaged = sound;
    damaged[bit / 32] ^= 1u << (bit % 32);
    const VkPipeline pipeline = compile(damaged.data(), damaged.size() * 4);
    if (pipeline == VK_NULL_HANDLE) {
      ++refused;
    } else {
      ASSERT_EQ(dispatch(pipeline), VK_SUCCESS) << "bit " << bit;
      ++ran;
    }
  }
  EXPECT_GT(refused, 1000u);
  EXPECT_GT(ran, 100u);
  expect_sound_module_works();
}

TEST_F(DamagedShader, EveryTruncationIsRefused) {
  for (std::size_t bytes = 4; bytes < sizeof kComputeWords; bytes += 4) {
    EXPECT_EQ(compile(kComputeWords, bytes), VkPipeline{VK_NULL_HANDLE}) << bytes << " bytes";
  }
  expect_sound_module_works();
}

TEST_F(DamagedShader, WhatIsNotSpirVIsRefused) {
  EXPECT_EQ(compile(kComputeWords, 0), VkPipeline{VK_NULL_HANDLE});
  EXPECT_EQ(compile(kComputeWords, sizeof kComputeWords - 1), VkPipeline{VK_NULL_HANDLE});
  Words words(std::begin(kComputeWords), std::end(kComputeWords));
  words[0] = 0x03022307;  // the other byte order
  EXPECT_EQ(compile(words.data(), words.size() * 4), VkPipeline{VK_NULL_HANDLE});
  words[0] = 0xdeadbeef;
  EXPECT_EQ(compile(words.data(), words.size() * 4), VkPipeline{VK_NULL_HANDLE});
  EXPECT_EQ(compile(kFragmentWords, sizeof kFragmentWords), VkPipeline{VK_NULL_HANDLE}) << "another stage's module";
  expect_sound_module_works();
}

class AbsurdSizes : public DeviceTest {};

VkImageCreateInfo image_info(VkFormat format, VkExtent3D extent, std::uint32_t layers) {
  auto info = make_struct<VkImageCreateInfo>();
  info.imageType = extent.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = extent;
  info.mipLevels = 1;
  info.arrayLayers = layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  return info;
}

/// Every image is an error, or reports a true size whose allocation is an error or memory as large as it says.
TEST_F(AbsurdSizes, Images) {
  constexpr std::uint32_t kMax = ~std::uint32_t{0};
  const VkImageCreateInfo images[] = {
      image_info(VK_FORMAT_R32G32B32A32_SFLOAT, {16384, 16384, 1}, 2048),
      image_info(VK_FORMAT_R32G32B32A32_SFLOAT, {4096, 4096, 4096}, 1),
      image_info(VK_FORMAT_R8G8B8A8_UNORM, {kMax, kMax, 1}, kMax),
      image_info(VK_FORMAT_R8G8B8A8_UNORM, {kMax, kMax, kMax}, 1),
      image_info(VK_FORMAT_R8G8B8A8_UNORM, {1u << 31, 1u << 31, 1}, 1),
      image_info(VK_FORMAT_R32G32B32A32_SFLOAT, {1u << 30, 1u << 30, 1}, 1),  // 2^64 bytes
      image_info(VK_FORMAT_BC7_UNORM_BLOCK, {kMax, kMax, 1}, 1),
      image_info(VK_FORMAT_R8_UNORM, {kMax, 1, 1}, 1),
      image_info(VK_FORMAT_D32_SFLOAT_S8_UINT, {16384, 16384, 1}, 2048),
  };
  for (const VkImageCreateInfo& info : images) {
    SCOPED_TRACE(::testing::Message() << info.extent.width << " x " << info.extent.height << " x " << info.extent.depth
                                      << ", " << info.arrayLayers << " layers");
    VkImage image = VK_NULL_HANDLE;
    const VkResult made = VK_CALL(CreateImage)(device, &info, nullptr, &image);
    if (made != VK_SUCCESS) {
      EXPECT_EQ(made, VK_ERROR_OUT_OF_DEVICE_MEMORY);
      continue;
    }
    VkMemoryRequirements requirements;
    VK_CALL(GetImageMemoryRequirements)(device, image, &requirements);
    EXPECT_GE(requirements.size, VkDeviceSize{1} << 32);
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = requirements.size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    const VkResult allocated = VK_CALL(AllocateMemory)(device, &allocate, nullptr, &memory);
    EXPECT_TRUE(allocated == VK_SUCCESS || allocated == VK_ERROR_OUT_OF_DEVICE_MEMORY) << allocated;
    if (allocated == VK_SUCCESS) {
      EXPECT_EQ(VK_CALL(BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
      void* data = nullptr;
      ASSERT_EQ(VK_CALL(MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
      static_cast<volatile char*>(data)[requirements.size - 1] = 1;
    }
    VK_CALL(FreeMemory)(device, memory, nullptr);
    VK_CALL(DestroyImage)(device, image, nullptr);
  }
}

TEST_F(AbsurdSizes, MemoryAndBuffers) {
  for (const VkDeviceSize size : {~VkDeviceSize{0}, VkDeviceSize{1} << 63, VkDeviceSize{1} << 48}) {
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &memory), VK_ERROR_OUT_OF_DEVICE_MEMORY);
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = size;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &buffer), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  }
}

TEST_F(AbsurdSizes, PoolsAndCounts) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, ~0u};
  auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
  pool_info.maxSets = ~0u;
  pool_info.poolSizeCount = 1;
  pool_info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  const VkResult made = VK_CALL(CreateDescriptorPool)(device, &pool_info, nullptr, &pool);
  EXPECT_TRUE(made == VK_SUCCESS || made == VK_ERROR_OUT_OF_HOST_MEMORY || made == VK_ERROR_OUT_OF_DEVICE_MEMORY)
      << made;
  if (made == VK_SUCCESS) VK_CALL(DestroyDescriptorPool)(device, pool, nullptr);

  auto query_info = make_struct<VkQueryPoolCreateInfo>();
  query_info.queryType = VK_QUERY_TYPE_OCCLUSION;
  query_info.queryCount = ~0u;
  VkQueryPool queries = VK_NULL_HANDLE;
  const VkResult queried = VK_CALL(CreateQueryPool)(device, &query_info, nullptr, &queries);
  EXPECT_TRUE(queried == VK_SUCCESS || queried == VK_ERROR_OUT_OF_HOST_MEMORY ||
              queried == VK_ERROR_OUT_OF_DEVICE_MEMORY)
      << queried;
  if (queried == VK_SUCCESS) VK_CALL(DestroyQueryPool)(device, queries, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
