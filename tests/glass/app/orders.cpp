// An application, linked to the loader, that runs compute shaders out of files, for shake_test.py: each gets a buffer
// of 4096 words (binding 0) and an image of 64x64 words (binding 1), both zeros.
//
//   vitrine_test_orders FILE.spv:GROUPS...
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

constexpr VkDeviceSize kBytes = 4096 * 4;

void must(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  std::fprintf(stderr, "%s: VkResult %d\n", what, result);
  std::exit(3);
}

VkInstance instance;
VkPhysicalDevice physical;
VkDevice device;
VkQueue queue;

void make_device() {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  must(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(instance, &count, &physical) < 0 || count == 0) std::exit(3);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue_info;
  must(vkCreateDevice(physical, &device_info, nullptr, &device), "vkCreateDevice");
  vkGetDeviceQueue(device, 0, 0, &queue);
}

VkDeviceMemory allocate(const VkMemoryRequirements& needs) {
  VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocation.allocationSize = needs.size;
  VkDeviceMemory memory;
  must(vkAllocateMemory(device, &allocation, nullptr, &memory), "vkAllocateMemory");
  return memory;
}

VkBuffer make_buffer() {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = kBytes;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer;
  must(vkCreateBuffer(device, &info, nullptr, &buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, buffer, &needs);
  must(vkBindBufferMemory(device, buffer, allocate(needs), 0), "vkBindBufferMemory");
  return buffer;
}

VkImage make_image(VkImageView& view) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R32_UINT;
  info.extent = {64, 64, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkImage image;
  must(vkCreateImage(device, &info, nullptr, &image), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, image, &needs);
  must(vkBindImageMemory(device, image, allocate(needs), 0), "vkBindImageMemory");
  VkImageViewCreateInfo view_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view_info.image = image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = info.format;
  view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  must(vkCreateImageView(device, &view_info, nullptr, &view), "vkCreateImageView");
  return image;
}

struct Resources {
  VkBuffer buffer{};
  VkImage image{};
  VkDescriptorSetLayout set_layout{};
  VkPipelineLayout layout{};
  VkDescriptorSet set{};
};

void write_set(const Resources& r, VkImageView view) {
  const VkDescriptorBufferInfo range{r.buffer, 0, VK_WHOLE_SIZE};
  const VkDescriptorImageInfo texels{{}, view, VK_IMAGE_LAYOUT_GENERAL};
  VkWriteDescriptorSet writes[2]{{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET}, {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET}};
  for (VkWriteDescriptorSet& write : writes) {
    write.dstSet = r.set;
    write.descriptorCount = 1;
  }
  writes[0].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  writes[0].pBufferInfo = &range;
  writes[1].dstBinding = 1;
  writes[1].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  writes[1].pImageInfo = &texels;
  vkUpdateDescriptorSets(device, 2, writes, 0, nullptr);
}

Resources make_resources() {
  Resources r;
  VkImageView view;
  r.buffer = make_buffer();
  r.image = make_image(view);
  const VkDescriptorSetLayoutBinding bindings[] = {
      {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
      {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}};
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.bindingCount = 2;
  set.pBindings = bindings;
  must(vkCreateDescriptorSetLayout(device, &set, nullptr, &r.set_layout), "vkCreateDescriptorSetLayout");
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &r.set_layout;
  must(vkCreatePipelineLayout(device, &layout, nullptr, &r.layout), "vkCreatePipelineLayout");
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = 1;
  info.poolSizeCount = 2;
  info.pPoolSizes = sizes;
  VkDescriptorPool pool;
  must(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocation.descriptorPool = pool;
  allocation.descriptorSetCount = 1;
  allocation.pSetLayouts = &r.set_layout;
  must(vkAllocateDescriptorSets(device, &allocation, &r.set), "vkAllocateDescriptorSets");
  write_set(r, view);
  return r;
}

VkPipeline make_pipeline(const Resources& r, const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(words.data()));
  VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  module.codeSize = words.size() * 4;
  module.pCode = words.data();
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.pName = "main";
  must(vkCreateShaderModule(device, &module, nullptr, &info.stage.module), path.c_str());
  info.layout = r.layout;
  VkPipeline pipeline;
  must(vkCreateComputePipelines(device, {}, 1, &info, nullptr, &pipeline), path.c_str());
  return pipeline;
}

void barrier(VkCommandBuffer commands) {
  VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  all.srcAccessMask = all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0,
                       nullptr, 0, nullptr);
}

/// Zeros, then the dispatch.
void record(VkCommandBuffer commands, const Resources& r, VkPipeline pipeline, std::uint32_t groups) {
  VkImageMemoryBarrier general{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  general.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  general.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  general.srcQueueFamilyIndex = general.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  general.image = r.image;
  general.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  barrier(commands);
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &general);
  vkCmdFillBuffer(commands, r.buffer, 0, kBytes, 0);
  const VkClearColorValue zero{};
  vkCmdClearColorImage(commands, r.image, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &general.subresourceRange);
  barrier(commands);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, r.layout, 0, 1, &r.set, 0, nullptr);
  vkCmdDispatch(commands, groups, 1, 1);
}

}  // namespace

int main(int argc, char** argv) {
  make_device();
  const Resources resources = make_resources();
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandPool pool;
  must(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = pool;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands;
  must(vkAllocateCommandBuffers(device, &allocation, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  must(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t colon = word.rfind(':');
    const auto groups = static_cast<std::uint32_t>(std::strtoul(word.c_str() + colon + 1, nullptr, 10));
    record(commands, resources, make_pipeline(resources, word.substr(0, colon)), groups);
  }
  must(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  must(vkQueueSubmit(queue, 1, &submit, {}), "vkQueueSubmit");
  must(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
  return 0;
}
