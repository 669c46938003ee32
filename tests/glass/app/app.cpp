// A small application, linked to the loader, for the tests of tools and of the command `vitrine`: a compute shader
// fills a buffer of eight words and says that it was there.
//
//   vitrine_test_app [ROUNDS] [COUNT] [copies]    ROUNDS: instances, one after the other; COUNT: words that it writes
//                                                 (8; more is a fault); copies: the buffer is filled, updated and
//                                                 copied, too, and the shader runs again
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/glass/app/fill_comp.h"

namespace {

void must(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  std::fprintf(stderr, "%s: VkResult %d\n", what, result);
  std::exit(3);
}

struct Device {
  VkInstance instance{};
  VkPhysicalDevice physical{};
  VkDevice device{};
  VkQueue queue{};
};

Device make_device() {
  Device d;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo instance{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance.pApplicationInfo = &application;
  must(vkCreateInstance(&instance, nullptr, &d.instance), "vkCreateInstance");
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(d.instance, &count, &d.physical) < 0 || count == 0) std::exit(3);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo device{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device.queueCreateInfoCount = 1;
  device.pQueueCreateInfos = &queue;
  must(vkCreateDevice(d.physical, &device, nullptr, &d.device), "vkCreateDevice");
  vkGetDeviceQueue(d.device, 0, 0, &d.queue);
  return d;
}

struct Buffer {
  VkBuffer buffer{};
  VkDeviceMemory memory{};
};

Buffer make_buffer(VkDevice device, VkDeviceSize size) {
  Buffer b;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  must(vkCreateBuffer(device, &info, nullptr, &b.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, b.buffer, &needs);
  VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocation.allocationSize = needs.size;
  must(vkAllocateMemory(device, &allocation, nullptr, &b.memory), "vkAllocateMemory");
  must(vkBindBufferMemory(device, b.buffer, b.memory, 0), "vkBindBufferMemory");
  return b;
}

struct Program {
  VkShaderModule module{};
  VkDescriptorSetLayout set_layout{};
  VkPipelineLayout layout{};
  VkPipeline pipeline{};
};

Program make_program(VkDevice device, std::uint32_t words) {
  Program p;
  VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  module.codeSize = sizeof fill_comp;
  module.pCode = fill_comp;
  must(vkCreateShaderModule(device, &module, nullptr, &p.module), "vkCreateShaderModule");
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                                             nullptr};
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.bindingCount = 1;
  set.pBindings = &binding;
  must(vkCreateDescriptorSetLayout(device, &set, nullptr, &p.set_layout), "vkCreateDescriptorSetLayout");
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &p.set_layout;
  must(vkCreatePipelineLayout(device, &layout, nullptr, &p.layout), "vkCreatePipelineLayout");
  const VkSpecializationMapEntry entry{0, 0, sizeof words};
  const VkSpecializationInfo constants{1, &entry, sizeof words, &words};
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = p.module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &constants;
  info.layout = p.layout;
  must(vkCreateComputePipelines(device, {}, 1, &info, nullptr, &p.pipeline), "vkCreateComputePipelines");
  return p;
}

/// A pool with one set of one buffer.
VkDescriptorPool make_set(VkDevice device, const Program& program, const Buffer& buffer, VkDescriptorSet& set) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = 1;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool;
  must(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocation.descriptorPool = pool;
  allocation.descriptorSetCount = 1;
  allocation.pSetLayouts = &program.set_layout;
  must(vkAllocateDescriptorSets(device, &allocation, &set), "vkAllocateDescriptorSets");
  const VkDescriptorBufferInfo range{buffer.buffer, 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &range;
  vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  return pool;
}

void wait(VkCommandBuffer commands) {
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier,
                       0, nullptr, 0, nullptr);
}

/// Words 1, 2 and 3 become 70, 80 and 80; then the shader runs again.
void copy_and_dispatch(VkCommandBuffer commands, VkBuffer buffer) {
  wait(commands);
  vkCmdFillBuffer(commands, buffer, 4, 4, 70);
  const std::uint32_t word = 80;
  vkCmdUpdateBuffer(commands, buffer, 8, 4, &word);
  wait(commands);
  const VkBufferCopy region{8, 12, 4};
  vkCmdCopyBuffer(commands, buffer, buffer, 1, &region);
  wait(commands);
  vkCmdDispatch(commands, 1, 1, 1);
}

/// `copied`: the buffer, if it is copied, too.
void dispatch(const Device& d, const Program& program, VkDescriptorSet set, VkBuffer copied) {
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandPool pool;
  must(vkCreateCommandPool(d.device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = pool;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands;
  must(vkAllocateCommandBuffers(d.device, &allocation, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  must(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout, 0, 1, &set, 0, nullptr);
  vkCmdDispatch(commands, 1, 1, 1);
  if (copied) copy_and_dispatch(commands, copied);
  must(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  must(vkQueueSubmit(d.queue, 1, &submit, {}), "vkQueueSubmit");
  must(vkQueueWaitIdle(d.queue), "vkQueueWaitIdle");
  vkDestroyCommandPool(d.device, pool, nullptr);
}

void run_round(std::uint32_t words, bool copies) {
  const Device d = make_device();
  const Buffer buffer = make_buffer(d.device, 8 * sizeof(std::uint32_t));
  const Program program = make_program(d.device, words);
  VkDescriptorSet set;
  const VkDescriptorPool pool = make_set(d.device, program, buffer, set);
  dispatch(d, program, set, copies ? buffer.buffer : VkBuffer{});
  vkDestroyDescriptorPool(d.device, pool, nullptr);
  vkDestroyPipeline(d.device, program.pipeline, nullptr);
  vkDestroyPipelineLayout(d.device, program.layout, nullptr);
  vkDestroyDescriptorSetLayout(d.device, program.set_layout, nullptr);
  vkDestroyShaderModule(d.device, program.module, nullptr);
  vkDestroyBuffer(d.device, buffer.buffer, nullptr);
  vkFreeMemory(d.device, buffer.memory, nullptr);
  vkDestroyDevice(d.device, nullptr);
  vkDestroyInstance(d.instance, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  const long rounds = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 1;
  const unsigned long words = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 8;
  for (long i = 0; i < rounds; ++i) run_round(static_cast<std::uint32_t>(words), argc > 3);
}
