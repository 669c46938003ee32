// Small extensions that became core in Vulkan 1.3: private data, names, pipeline creation feedback and cache control,
// maintenance4, calibrated timestamps; the memory budget.
#include <time.h>

#include <cstring>
#include <string>

#include "icd/edge/diagnostics.h"
#include "icd/object/shader_module.h"
#include "tests/icd/compute_fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

using PrivateData = DeviceTest;
using Maintenance4 = DeviceTest;
using Timestamps = DeviceTest;
using Memory = DeviceTest;
using DebugUtils = DeviceTest;

std::uint64_t handle_of(const void* handle) { return reinterpret_cast<std::uint64_t>(handle); }

TEST_F(PrivateData, BelongsToTheObjectAndTheSlot) {
  CountingAllocator allocator;
  const auto slot_info = make_struct<VkPrivateDataSlotCreateInfo>();
  VkPrivateDataSlot slots[2];
  for (VkPrivateDataSlot& slot : slots) {
    ASSERT_EQ(VK_GET(instance, CreatePrivateDataSlotEXT)(device, &slot_info, nullptr, &slot), VK_SUCCESS);
  }
  const auto fence_info = make_struct<VkFenceCreateInfo>();
  VkFence fence;
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &fence_info, allocator.callbacks(), &fence), VK_SUCCESS);
  const auto set = VK_GET(instance, SetPrivateDataEXT);
  const auto get = [&](VkObjectType type, const void* handle, VkPrivateDataSlot slot) {
    std::uint64_t data = 99;
    VK_GET(instance, GetPrivateDataEXT)(device, type, handle_of(handle), slot, &data);
    return data;
  };
  EXPECT_EQ(get(VK_OBJECT_TYPE_FENCE, fence, slots[0]), 0u);
  EXPECT_EQ(set(device, VK_OBJECT_TYPE_FENCE, handle_of(fence), slots[0], 7), VK_SUCCESS);
  EXPECT_EQ(set(device, VK_OBJECT_TYPE_FENCE, handle_of(fence), slots[1], 8), VK_SUCCESS);
  EXPECT_EQ(set(device, VK_OBJECT_TYPE_FENCE, handle_of(fence), slots[0], 9), VK_SUCCESS);
  EXPECT_EQ(set(device, VK_OBJECT_TYPE_DEVICE, handle_of(device), slots[0], 10), VK_SUCCESS);
  EXPECT_EQ(get(VK_OBJECT_TYPE_FENCE, fence, slots[0]), 9u);
  EXPECT_EQ(get(VK_OBJECT_TYPE_FENCE, fence, slots[1]), 8u);
  EXPECT_EQ(get(VK_OBJECT_TYPE_DEVICE, device, slots[0]), 10u);
  // A slot that takes the place of another knows nothing of it.
  VK_GET(instance, DestroyPrivateDataSlotEXT)(device, slots[0], nullptr);
  ASSERT_EQ(VK_GET(instance, CreatePrivateDataSlotEXT)(device, &slot_info, nullptr, &slots[0]), VK_SUCCESS);
  EXPECT_EQ(get(VK_OBJECT_TYPE_FENCE, fence, slots[0]), 0u);
  VK_GET(instance, DestroyFence)(device, fence, allocator.callbacks());
  EXPECT_EQ(allocator.live(), 0u);
  for (const VkPrivateDataSlot slot : slots) VK_GET(instance, DestroyPrivateDataSlotEXT)(device, slot, nullptr);
}

VKAPI_ATTR VkBool32 VKAPI_CALL remember_name(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  if (data->objectCount && data->pObjects[0].pObjectName) {
    *static_cast<std::string*>(user) = data->pObjects[0].pObjectName;
  }
  return VK_FALSE;
}

TEST_F(DebugUtils, MessagesCarryTheNamesOfObjects) {
  std::string heard;
  auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
  info.pfnUserCallback = &remember_name;
  info.pUserData = &heard;
  VkDebugUtilsMessengerEXT messenger;
  ASSERT_EQ(VK_GET(instance, CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  auto name = make_struct<VkDebugUtilsObjectNameInfoEXT>();
  name.objectType = VK_OBJECT_TYPE_DEVICE;
  name.objectHandle = handle_of(device);
  name.pObjectName = "the glass";
  EXPECT_EQ(VK_GET(instance, SetDebugUtilsObjectNameEXT)(device, &name), VK_SUCCESS);
  icd::Device& d = from_handle<icd::Device>(device);
  report_error(d, ref(d), "test", "something");
  EXPECT_EQ(heard, "the glass");
  VK_GET(instance, DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
}

class PipelineCreation : public ComputeTest {
 protected:
  void SetUp() override {
    ComputeTest::SetUp();
    main_stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, kComputeWords);
  }
  VkComputePipelineCreateInfo info(VkPipelineCreateFlags flags, void* next = nullptr) {
    auto out = make_struct<VkComputePipelineCreateInfo>(next);
    out.flags = flags;
    out.stage = main_stage;
    out.layout = layout;
    return out;
  }

  VkPipelineShaderStageCreateInfo main_stage{};
};

TEST_F(PipelineCreation, FeedbackTellsTimesAndCacheHits) {
  VkPipeline pipelines[2];
  for (int i = 0; i < 2; ++i) {
    VkPipelineCreationFeedback whole{}, stage{};
    auto feedback = make_struct<VkPipelineCreationFeedbackCreateInfo>();
    feedback.pPipelineCreationFeedback = &whole;
    feedback.pipelineStageCreationFeedbackCount = 1;
    feedback.pPipelineStageCreationFeedbacks = &stage;
    const VkComputePipelineCreateInfo create = info(0, &feedback);
    ASSERT_EQ(VK_GET(instance, CreateComputePipelines)(device, cache, 1, &create, nullptr, &pipelines[i]), VK_SUCCESS);
    const VkPipelineCreationFeedbackFlags hit =
        i ? VK_PIPELINE_CREATION_FEEDBACK_APPLICATION_PIPELINE_CACHE_HIT_BIT : 0;
    EXPECT_EQ(whole.flags, VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT | hit);
    EXPECT_EQ(stage.flags, VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT | hit);
    EXPECT_GE(whole.duration, stage.duration);
    EXPECT_GT(whole.duration, 0u);
  }
  for (const VkPipeline pipeline : pipelines) VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
}

TEST_F(PipelineCreation, NothingIsCompiledWhereThatIsNotWanted) {
  const auto create = VK_GET(instance, CreateComputePipelines);
  const VkPipelineCreateFlags only_cached = VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
  const VkPipelineCreateFlags early = only_cached | VK_PIPELINE_CREATE_EARLY_RETURN_ON_FAILURE_BIT;
  VkPipeline pipelines[3];
  // The first fails and ends the call, or does not.
  VkComputePipelineCreateInfo infos[2] = {info(early), info(0)};
  EXPECT_EQ(create(device, VK_NULL_HANDLE, 2, infos, nullptr, pipelines), VK_PIPELINE_COMPILE_REQUIRED);
  EXPECT_EQ(pipelines[0], VkPipeline{});
  EXPECT_EQ(pipelines[1], VkPipeline{});
  infos[0].flags = only_cached;
  EXPECT_EQ(create(device, VK_NULL_HANDLE, 2, infos, nullptr, pipelines), VK_PIPELINE_COMPILE_REQUIRED);
  EXPECT_EQ(pipelines[0], VkPipeline{});
  ASSERT_NE(pipelines[1], VkPipeline{});
  // While the same shader is alive nothing has to be compiled.
  EXPECT_EQ(create(device, VK_NULL_HANDLE, 1, infos, nullptr, &pipelines[2]), VK_SUCCESS);
  VK_GET(instance, DestroyPipeline)(device, pipelines[1], nullptr);
  VK_GET(instance, DestroyPipeline)(device, pipelines[2], nullptr);
}

/// All accesses are checked, whatever a pipeline asks for: even without the features nothing less is promised.
TEST_F(PipelineCreation, RobustnessIsTheSameForAll) {
  auto properties = make_struct<VkPhysicalDevicePipelineRobustnessPropertiesEXT>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_GET(instance, GetPhysicalDeviceProperties2)(physical_device, &whole);
  EXPECT_EQ(properties.defaultRobustnessStorageBuffers,
            VK_PIPELINE_ROBUSTNESS_BUFFER_BEHAVIOR_ROBUST_BUFFER_ACCESS_2_EXT);
  EXPECT_EQ(properties.defaultRobustnessImages, VK_PIPELINE_ROBUSTNESS_IMAGE_BEHAVIOR_ROBUST_IMAGE_ACCESS_2_EXT);
  VkPipeline pipelines[2] = {};
  for (int i = 0; i < 2; ++i) {
    auto robustness = make_struct<VkPipelineRobustnessCreateInfoEXT>();
    robustness.storageBuffers = i ? VK_PIPELINE_ROBUSTNESS_BUFFER_BEHAVIOR_DISABLED_EXT
                                  : VK_PIPELINE_ROBUSTNESS_BUFFER_BEHAVIOR_ROBUST_BUFFER_ACCESS_2_EXT;
    const VkComputePipelineCreateInfo create = info(0, &robustness);
    ASSERT_EQ(VK_GET(instance, CreateComputePipelines)(device, cache, 1, &create, nullptr, &pipelines[i]), VK_SUCCESS);
  }
  for (const VkPipeline pipeline : pipelines) VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
}

/// Whether pipelines are for protected command buffers makes no difference where there are none.
TEST_F(PipelineCreation, ProtectedAccessIsGivenAndTakenAway) {
  auto access = make_struct<VkPhysicalDevicePipelineProtectedAccessFeaturesEXT>();
  auto memory = make_struct<VkPhysicalDeviceProtectedMemoryFeatures>(&access);
  auto features = make_struct<VkPhysicalDeviceFeatures2>(&memory);
  VK_GET(instance, GetPhysicalDeviceFeatures2)(physical_device, &features);
  EXPECT_TRUE(access.pipelineProtectedAccess);
  EXPECT_FALSE(memory.protectedMemory);
  for (const VkPipelineCreateFlagBits flag :
       {VK_PIPELINE_CREATE_NO_PROTECTED_ACCESS_BIT_EXT, VK_PIPELINE_CREATE_PROTECTED_ACCESS_ONLY_BIT_EXT}) {
    const VkComputePipelineCreateInfo create = info(flag);
    VkPipeline pipeline = VK_NULL_HANDLE;
    ASSERT_EQ(VK_GET(instance, CreateComputePipelines)(device, cache, 1, &create, nullptr, &pipeline), VK_SUCCESS);
    VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
  }
}

TEST_F(PipelineCreation, ModulesCanBeNamedByTheirIdentifiers) {
  auto of_module = make_struct<VkShaderModuleIdentifierEXT>(), of_words = make_struct<VkShaderModuleIdentifierEXT>();
  VK_GET(instance, GetShaderModuleIdentifierEXT)(device, main_stage.module, &of_module);
  ASSERT_EQ(of_module.identifierSize, 16u);
  const auto& words = from_handle<ShaderModule>(main_stage.module).words;
  auto module_info = make_struct<VkShaderModuleCreateInfo>();
  module_info.codeSize = words.size() * sizeof words[0];
  module_info.pCode = words.data();
  VK_GET(instance, GetShaderModuleCreateInfoIdentifierEXT)(device, &module_info, &of_words);
  EXPECT_EQ(std::memcmp(of_module.identifier, of_words.identifier, 16), 0);
  module_info.codeSize -= sizeof words[0];
  VK_GET(instance, GetShaderModuleCreateInfoIdentifierEXT)(device, &module_info, &of_words);
  EXPECT_NE(std::memcmp(of_module.identifier, of_words.identifier, 16), 0) << "of other words";

  const auto create = VK_GET(instance, CreateComputePipelines);
  VkComputePipelineCreateInfo named = info(VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT);
  auto identifier = make_struct<VkPipelineShaderStageModuleIdentifierCreateInfoEXT>();
  identifier.identifierSize = of_module.identifierSize;
  identifier.pIdentifier = of_module.identifier;
  named.stage.module = VK_NULL_HANDLE;
  named.stage.pNext = &identifier;
  VkPipeline pipelines[2];
  EXPECT_EQ(create(device, VK_NULL_HANDLE, 1, &named, nullptr, &pipelines[0]), VK_PIPELINE_COMPILE_REQUIRED);
  const VkComputePipelineCreateInfo whole = info(0);
  ASSERT_EQ(create(device, cache, 1, &whole, nullptr, &pipelines[0]), VK_SUCCESS);
  EXPECT_EQ(create(device, cache, 1, &named, nullptr, &pipelines[1]), VK_SUCCESS);
  for (const VkPipeline pipeline : pipelines) VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
}

TEST_F(Maintenance4, RequirementsNeedNoObject) {
  auto buffer_info = make_struct<VkBufferCreateInfo>();
  buffer_info.size = 1000;
  buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  auto image_info = make_struct<VkImageCreateInfo>();
  image_info.imageType = VK_IMAGE_TYPE_2D;
  image_info.format = VK_FORMAT_D24_UNORM_S8_UINT;
  image_info.extent = {130, 70, 1};
  image_info.mipLevels = 4;
  image_info.arrayLayers = 3;
  image_info.samples = VK_SAMPLE_COUNT_1_BIT;
  image_info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  VkBuffer buffer;
  VkImage image;
  ASSERT_EQ(VK_GET(instance, CreateBuffer)(device, &buffer_info, nullptr, &buffer), VK_SUCCESS);
  ASSERT_EQ(VK_GET(instance, CreateImage)(device, &image_info, nullptr, &image), VK_SUCCESS);
  VkMemoryRequirements of_object;
  auto without = make_struct<VkMemoryRequirements2>();
  const auto expect_equal = [&] {
    EXPECT_EQ(of_object.size, without.memoryRequirements.size);
    EXPECT_EQ(of_object.alignment, without.memoryRequirements.alignment);
    EXPECT_EQ(of_object.memoryTypeBits, without.memoryRequirements.memoryTypeBits);
  };
  VK_GET(instance, GetBufferMemoryRequirements)(device, buffer, &of_object);
  auto device_buffer = make_struct<VkDeviceBufferMemoryRequirements>();
  device_buffer.pCreateInfo = &buffer_info;
  VK_GET(instance, GetDeviceBufferMemoryRequirementsKHR)(device, &device_buffer, &without);
  expect_equal();
  VK_GET(instance, GetImageMemoryRequirements)(device, image, &of_object);
  auto device_image = make_struct<VkDeviceImageMemoryRequirements>();
  device_image.pCreateInfo = &image_info;
  VK_GET(instance, GetDeviceImageMemoryRequirementsKHR)(device, &device_image, &without);
  expect_equal();
  std::uint32_t count = 5;
  VK_GET(instance, GetDeviceImageSparseMemoryRequirementsKHR)(device, &device_image, &count, nullptr);
  EXPECT_EQ(count, 0u);
  VK_GET(instance, DestroyBuffer)(device, buffer, nullptr);
  VK_GET(instance, DestroyImage)(device, image, nullptr);
}

TEST_F(Timestamps, AreOfTheMonotonicClock) {
  std::uint32_t count = 4;
  VkTimeDomainEXT domains[4];
  ASSERT_EQ(VK_GET(instance, GetPhysicalDeviceCalibrateableTimeDomainsEXT)(physical_device, &count, domains),
            VK_SUCCESS);
  ASSERT_EQ(count, 2u);
  VkCalibratedTimestampInfoEXT infos[2];
  for (int i = 0; i < 2; ++i) {
    infos[i] = make_struct<VkCalibratedTimestampInfoEXT>();
    infos[i].timeDomain = domains[i];
  }
  timespec before{}, after{};
  std::uint64_t values[2], deviation = 1;
  clock_gettime(CLOCK_MONOTONIC, &before);
  ASSERT_EQ(VK_GET(instance, GetCalibratedTimestampsEXT)(device, 2, infos, values, &deviation), VK_SUCCESS);
  clock_gettime(CLOCK_MONOTONIC, &after);
  const auto nanoseconds = [](const timespec& t) {
    return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(t.tv_nsec);
  };
  EXPECT_EQ(values[0], values[1]);
  EXPECT_GE(values[0], nanoseconds(before));
  EXPECT_LE(values[0], nanoseconds(after));
}

TEST_F(Memory, TheBudgetKnowsWhatIsAllocated) {
  const auto usage = [](VkInstance of, VkPhysicalDevice seen) {
    auto budget = make_struct<VkPhysicalDeviceMemoryBudgetPropertiesEXT>();
    auto properties = make_struct<VkPhysicalDeviceMemoryProperties2>(&budget);
    VK_GET(of, GetPhysicalDeviceMemoryProperties2)(seen, &properties);
    EXPECT_GE(budget.heapBudget[0], budget.heapUsage[0]);
    EXPECT_LE(budget.heapBudget[0], properties.memoryProperties.memoryHeaps[0].size);
    EXPECT_GT(budget.heapBudget[0], 0u);
    EXPECT_EQ(budget.heapBudget[1] + budget.heapUsage[1], 0u);
    return budget.heapUsage[0];
  };
  const VkDeviceSize before = usage(instance, physical_device);
  auto info = make_struct<VkMemoryAllocateInfo>();
  info.allocationSize = 1 << 20;
  VkDeviceMemory memory;
  ASSERT_EQ(VK_GET(instance, AllocateMemory)(device, &info, nullptr, &memory), VK_SUCCESS);
  EXPECT_EQ(usage(instance, physical_device), before + (1 << 20));
  // "A heap's usage is an estimate of how much memory the process is currently using in that heap": all instances do.
  VkInstance other;
  ASSERT_EQ(create_instance(&other), VK_SUCCESS);
  std::uint32_t count = 1;
  VkPhysicalDevice same_device;
  ASSERT_EQ(VK_GET(other, EnumeratePhysicalDevices)(other, &count, &same_device), VK_SUCCESS);
  EXPECT_EQ(usage(other, same_device), before + (1 << 20));
  VK_GET(other, DestroyInstance)(other, nullptr);
  VK_GET(instance, FreeMemory)(device, memory, nullptr);
  EXPECT_EQ(usage(instance, physical_device), before);
}

}  // namespace
}  // namespace vitrine::icd::test
