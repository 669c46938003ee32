// A small program over the driver's own functions: a compute dispatch and a triangle in a render pass, from the
// instance to the fence.
#pragma once

#include <array>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {

/// Every handle of the program; null until made.
struct Program {
  const VkAllocationCallbacks* allocator = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  std::array<VkShaderModule, 3> modules{};
  std::array<VkPipeline, 2> pipelines{};  // compute, graphics
  VkRenderPass render_pass = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  VkQueryPool query_pool = VK_NULL_HANDLE;
  VkCommandPool command_pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
};

/// The steps of the program in their order; each needs those before it. An error of Vulkan ends the step.
VkResult make_device(Program& p);
VkResult make_resources(Program& p);
VkResult make_descriptors(Program& p);
VkResult make_render_pass(Program& p);
VkResult make_pipelines(Program& p);
VkResult record(Program& p);
VkResult submit(Program& p);  // of threads that share the device, one at a time
VkResult wait(Program& p);

/// Another command buffer of the program's pool, to be recorded.
VkResult begin_commands(Program& p, VkCommandBuffer& commands);
/// All steps, up to the first that fails.
VkResult run(Program& p);
/// Expects what the program computes: 3 i + 1 in the buffer, magenta below the diagonal in the image.
void check_results(Program& p);
/// What make_pipelines() and record() have made.
void destroy_recorded(Program& p);
/// What has been made of the device.
void destroy_objects(Program& p);
/// That, the device and the instance; of a program that failed anywhere, too.
void destroy(Program& p);

}  // namespace vitrine::icd::test
