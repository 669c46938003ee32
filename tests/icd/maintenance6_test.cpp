// VK_KHR_maintenance6, which neither older headers nor the reference know: the commands of binding with structures, and
// the results of binding memory. Draws without indices are maintenance5_draws_test.cpp's.
#include <cstring>
#include <string>

#include "tests/icd/maintenance5_fixture.h"

#ifdef VK_KHR_maintenance6
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using Maintenance6 = Maintenance5Device;

TEST_F(Maintenance6, IsOffered) {
  auto features = make_struct<VkPhysicalDeviceMaintenance6FeaturesKHR>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.maintenance6);
  auto properties = make_struct<VkPhysicalDeviceMaintenance6PropertiesKHR>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  EXPECT_TRUE(properties.blockTexelViewCompatibleMultipleLayers);
  EXPECT_EQ(properties.maxCombinedImageSamplerDescriptorCount, 1u);
  EXPECT_TRUE(properties.fragmentShadingRateClampCombinerInputs);
}

/// Vulkan 1.4.309, VkBindMemoryStatus: each resource has a result of its own, and those that can be bound are.
TEST_F(Maintenance6, EveryBindingTellsItsResult) {
  std::byte* data = nullptr;
  const VkDeviceMemory memory = map(65536, data);
  auto buffer_info = make_struct<VkBufferCreateInfo>();
  buffer_info.size = 256;
  buffer_info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  VkBuffer made[3];
  VkBindBufferMemoryInfo binds[3];
  VkBindMemoryStatusKHR status[3];
  VkResult results[3];
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(VK_CALL(CreateBuffer)(device, &buffer_info, nullptr, &made[i]), VK_SUCCESS);
    results[i] = VK_RESULT_MAX_ENUM;
    status[i] = make_struct<VkBindMemoryStatusKHR>();
    status[i].pResult = &results[i];
    binds[i] = make_struct<VkBindBufferMemoryInfo>(&status[i]);
    binds[i].buffer = made[i];
    binds[i].memory = memory;
    binds[i].memoryOffset = i == 1 ? 65536 : 256u * static_cast<unsigned>(i);
  }
  EXPECT_EQ(VK_CALL(BindBufferMemory2)(device, 3, binds), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_EQ(results[0], VK_SUCCESS);
  EXPECT_EQ(results[1], VK_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_EQ(results[2], VK_SUCCESS);
  // The last one is bound.
  const Bytes target = make_bytes(256);
  std::memset(data + 512, 0x5a, 256);
  run([&](VkCommandBuffer commands) {
    const VkBufferCopy copy{0, 0, 256};
    VK_CALL(CmdCopyBuffer)(commands, made[2], target.buffer, 1, &copy);
  });
  EXPECT_EQ(std::memcmp(target.data, data + 512, 256), 0);
  auto info = image_info(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {16, 16, 1}, 1);
  VkImage images[2];
  VkBindImageMemoryInfo image_binds[2];
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &images[i]), VK_SUCCESS);
    results[i] = VK_RESULT_MAX_ENUM;
    image_binds[i] = make_struct<VkBindImageMemoryInfo>(&status[i]);
    image_binds[i].image = images[i];
    image_binds[i].memory = memory;
    image_binds[i].memoryOffset = i == 0 ? 65536 - 64 : 4096;
  }
  EXPECT_EQ(VK_CALL(BindImageMemory2)(device, 2, image_binds), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_EQ(results[0], VK_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_EQ(results[1], VK_SUCCESS);
  for (const VkBuffer buffer : made) VK_CALL(DestroyBuffer)(device, buffer, nullptr);
  for (const VkImage image : images) VK_CALL(DestroyImage)(device, image, nullptr);
  VK_CALL(FreeMemory)(device, memory, nullptr);
}

/// Sets and constants of a dispatch, by the commands with structures.
class Maintenance6Binding : public Maintenance5Device {
 protected:
  void TearDown() override {
    VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
    VK_CALL(DestroyPipelineLayout)(device, layout, nullptr);
    VK_CALL(DestroyDescriptorPool)(device, pool, nullptr);
    VK_CALL(DestroyDescriptorSetLayout)(device, set_layout, nullptr);
    Maintenance5Device::TearDown();
  }

  void make(VkDescriptorSetLayoutCreateFlags flags, VkDescriptorType type) {
    const VkDescriptorSetLayoutBinding binding{0, type, 1, VK_SHADER_STAGE_ALL, nullptr};
    auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
    shape.flags = flags;
    shape.bindingCount = 1;
    shape.pBindings = &binding;
    ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &set_layout), VK_SUCCESS);
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 4, 8};
    auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    layout_info.pushConstantRangeCount = 1;
    layout_info.pPushConstantRanges = &range;
    ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &layout), VK_SUCCESS);
    const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT,
                               "layout(push_constant) uniform P { layout(offset = 4) uint a; uint b; };\n"
                               "layout(set = 0, binding = 0) buffer B { uint words[]; };\n"
                               "void main() { words[0] = a; words[1] = b; }");
    auto module = module_info(words);
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = make_struct<VkPipelineShaderStageCreateInfo>(&module);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = "main";
    info.layout = layout;
    ASSERT_EQ(VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    results = make_bytes(1024);
  }

  VkWriteDescriptorSet write(VkDescriptorType type) {
    buffer_info = {results.buffer, 0, 256};
    auto out = make_struct<VkWriteDescriptorSet>();
    out.descriptorCount = 1;
    out.descriptorType = type;
    out.pBufferInfo = &buffer_info;
    return out;
  }

  /// A dispatch after `bind`, which leaves 11 and 22 at `offset`.
  template <class Bind>
  void expect_dispatch(std::size_t offset, Bind bind) {
    run([&](VkCommandBuffer commands) {
      VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
      const std::uint32_t constants[] = {11, 22};
      auto push = make_struct<VkPushConstantsInfoKHR>();
      push.layout = layout;
      push.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
      push.offset = 4;
      push.size = 8;
      push.pValues = constants;
      VK_CALL(CmdPushConstants2KHR)(commands, &push);
      bind(commands);
      VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    });
    std::uint32_t got[2];
    std::memcpy(got, results.data + offset, sizeof got);
    EXPECT_EQ(got[0], 11u);
    EXPECT_EQ(got[1], 22u);
  }

  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkDescriptorBufferInfo buffer_info{};
  Bytes results;
};

TEST_F(Maintenance6Binding, SetsAreBoundToThePointsOfTheirStages) {
  constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
  make(0, kType);
  const VkDescriptorPoolSize size{kType, 1};
  auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
  pool_info.maxSets = pool_info.poolSizeCount = 1;
  pool_info.pPoolSizes = &size;
  ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout;
  VkDescriptorSet set;
  ASSERT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
  VkWriteDescriptorSet whole = write(kType);
  whole.dstSet = set;
  VK_CALL(UpdateDescriptorSets)(device, 1, &whole, 0, nullptr);
  std::uint32_t offset = 256;
  auto info = make_struct<VkBindDescriptorSetsInfoKHR>();
  info.layout = layout;
  info.descriptorSetCount = 1;
  info.pDescriptorSets = &set;
  info.dynamicOffsetCount = 1;
  info.pDynamicOffsets = &offset;
  info.stageFlags = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
  expect_dispatch(256, [&](VkCommandBuffer commands) { VK_CALL(CmdBindDescriptorSets2KHR)(commands, &info); });
  // Those of graphics alone leave compute's as they are.
  std::memset(results.data, 0, results.size);
  expect_dispatch(512, [&](VkCommandBuffer commands) {
    offset = 512;
    info.stageFlags = VK_SHADER_STAGE_ALL;
    VK_CALL(CmdBindDescriptorSets2KHR)(commands, &info);
    offset = 768;
    info.stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
    VK_CALL(CmdBindDescriptorSets2KHR)(commands, &info);
  });
}

TEST_F(Maintenance6Binding, DescriptorsArePushed) {
  constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  make(VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR, kType);
  const VkWriteDescriptorSet one = write(kType);
  auto info = make_struct<VkPushDescriptorSetInfoKHR>();
  info.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
  info.layout = layout;
  info.descriptorWriteCount = 1;
  info.pDescriptorWrites = &one;
  expect_dispatch(0, [&](VkCommandBuffer commands) { VK_CALL(CmdPushDescriptorSet2KHR)(commands, &info); });
  const VkDescriptorUpdateTemplateEntry entry{0, 0, 1, kType, 0, sizeof(VkDescriptorBufferInfo)};
  auto shape = make_struct<VkDescriptorUpdateTemplateCreateInfo>();
  shape.descriptorUpdateEntryCount = 1;
  shape.pDescriptorUpdateEntries = &entry;
  shape.templateType = VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_PUSH_DESCRIPTORS_KHR;
  shape.pipelineBindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
  shape.pipelineLayout = layout;
  VkDescriptorUpdateTemplate update;
  ASSERT_EQ(VK_CALL(CreateDescriptorUpdateTemplate)(device, &shape, nullptr, &update), VK_SUCCESS);
  buffer_info.offset = 512;
  auto templated = make_struct<VkPushDescriptorSetWithTemplateInfoKHR>();
  templated.descriptorUpdateTemplate = update;
  templated.layout = layout;
  templated.pData = &buffer_info;
  expect_dispatch(512, [&](VkCommandBuffer commands) {
    VK_CALL(CmdPushDescriptorSetWithTemplate2KHR)(commands, &templated);
  });
  VK_CALL(DestroyDescriptorUpdateTemplate)(device, update, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
