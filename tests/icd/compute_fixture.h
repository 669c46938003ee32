// A device with what a compute pipeline of the tests' shaders needs: one storage buffer in set 0.
#pragma once

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {

class ComputeTest : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr};
    auto set_info = make_struct<VkDescriptorSetLayoutCreateInfo>();
    set_info.bindingCount = 1;
    set_info.pBindings = &binding;
    ASSERT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &set_info, nullptr, &set_layout), VK_SUCCESS);
    auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &layout_info, nullptr, &layout), VK_SUCCESS);
    const auto cache_info = make_struct<VkPipelineCacheCreateInfo>();
    ASSERT_EQ(VK_GET(instance, CreatePipelineCache)(device, &cache_info, nullptr, &cache), VK_SUCCESS);
  }
  void TearDown() override {
    for (const VkShaderModule m : modules) VK_GET(instance, DestroyShaderModule)(device, m, nullptr);
    VK_GET(instance, DestroyPipelineCache)(device, cache, nullptr);
    VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
    VK_GET(instance, DestroyDescriptorSetLayout)(device, set_layout, nullptr);
    DeviceTest::TearDown();
  }

  /// The entry point "main" of a module, which is destroyed with the device.
  template <std::size_t N>
  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit, const std::uint32_t (&words)[N]) {
    auto info = make_struct<VkShaderModuleCreateInfo>();
    info.codeSize = sizeof words;
    info.pCode = words;
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateShaderModule)(device, &info, nullptr, &module), VK_SUCCESS);
    modules.push_back(module);
    auto out = make_struct<VkPipelineShaderStageCreateInfo>();
    out.stage = bit;
    out.module = module;
    out.pName = "main";
    return out;
  }

  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipelineCache cache = VK_NULL_HANDLE;
  std::vector<VkShaderModule> modules;
};

}  // namespace vitrine::icd::test
