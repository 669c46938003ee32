// Objects of a run: buffers, samplers, shaders, descriptors, command buffers.
#include "harness/run.h"

#include <algorithm>

#include "harness/mutant.h"
#include "harness/options.h"
#include "harness/shader.h"

namespace vitrine::cts {

Binding storage_buffer(uint32_t binding, const Buffer& buffer) {
  return {binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {{buffer.handle, 0, VK_WHOLE_SIZE}}, {}, {}};
}
Binding uniform_buffer(uint32_t binding, const Buffer& buffer) {
  return {binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {{buffer.handle, 0, VK_WHOLE_SIZE}}, {}, {}};
}
Binding sampled(uint32_t binding, const Image& image, VkSampler sampler) {
  return {binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {}, {{sampler, image.view, VK_IMAGE_LAYOUT_GENERAL}}, {}};
}
Binding storage_image(uint32_t binding, const Image& image) {
  return {binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {}, {{VK_NULL_HANDLE, image.view, VK_IMAGE_LAYOUT_GENERAL}}, {}};
}
Binding input_attachment(uint32_t binding, const Image& image) {
  return {
      binding, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, {}, {{VK_NULL_HANDLE, image.view, VK_IMAGE_LAYOUT_GENERAL}}, {}};
}

void Resources::bind(VkCommandBuffer cmd, VkPipelineBindPoint point) const {
  if (set) vkCmdBindDescriptorSets(cmd, point, layout, 0, 1, &set, 0, nullptr);
}

Run::Run(Gpu& g, uint64_t seed, uint32_t i) : gpu(g), device(g.device), random(seed), index(i) {
  VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  info.queueFamilyIndex = gpu.family;
  CTS_VK(vkCreateCommandPool(device, &info, nullptr, &pool_));
}

Run::~Run() {
  vkDeviceWaitIdle(device);
  for (auto destroy = deferred_.rbegin(); destroy != deferred_.rend(); ++destroy) (*destroy)();
  vkDestroyCommandPool(device, pool_, nullptr);
}

void Run::require(bool claimed, const char* what) const {
  if (!claimed) throw Unsupported(gpu.name + " does not claim " + what);
}

VkDeviceMemory Run::allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags wanted) {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = requirements.size;
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  if (gpu.extension_features.bufferDeviceAddress) info.pNext = &flags;
  info.memoryTypeIndex = gpu.memory_type(requirements.memoryTypeBits, wanted);
  VkDeviceMemory memory;
  CTS_VK(vkAllocateMemory(device, &info, nullptr, &memory));
  return own(memory, vkFreeMemory);
}

Buffer Run::buffer(VkDeviceSize size, VkBufferUsageFlags extra_usage) {
  Buffer result;
  result.size = size;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
               VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
               VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
               VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | extra_usage;
  CTS_VK(vkCreateBuffer(device, &info, nullptr, &result.handle));
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device, result.handle, &requirements);
  const VkDeviceMemory memory =
      allocate(requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  own(result.handle, vkDestroyBuffer);
  CTS_VK(vkBindBufferMemory(device, result.handle, memory, 0));
  CTS_VK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, reinterpret_cast<void**>(&result.data)));
  std::memset(result.data, 0, size);
  inputs.buffer(result, extra_usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
  return result;
}

VkSampler Run::sampler(const VkSamplerCreateInfo& info) {
  inputs.sampler(info);
  VkSampler result;
  CTS_VK(vkCreateSampler(device, &info, nullptr, &result));
  return own(result, vkDestroySampler);
}

VkSampler Run::sampler(VkFilter filter, VkSamplerAddressMode mode) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = filter;
  info.addressModeU = info.addressModeV = info.addressModeW = mode;
  info.maxLod = VK_LOD_CLAMP_NONE;
  return sampler(info);
}

VkShaderModule Run::module(const std::vector<uint32_t>& words) {
  inputs.module(words, false);
  return create_module(words);
}

VkShaderModule Run::create_module(const std::vector<uint32_t>& original) {
  const bool mutate = options().mutate && mutates;
  const std::vector<uint32_t> words = mutate ? mutant_of(original, options().seed) : original;
  if (mutate) note("mutant" + std::to_string(notes.size()), disassemble(words));
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = words.size() * 4;
  info.pCode = words.data();
  VkShaderModule result;
  CTS_VK(vkCreateShaderModule(device, &info, nullptr, &result));
  return own(result, vkDestroyShaderModule);
}

VkShaderModule Run::shader(VkShaderStageFlagBits stage, const std::string& glsl) {
  const std::vector<uint32_t>& words = compile_glsl(stage, glsl);
  inputs.shader(stage, glsl);
  inputs.module(words, true);
  return create_module(words);
}

Resources Run::resources(const std::vector<Binding>& bindings, uint32_t push_bytes) {
  inputs.bindings(bindings, push_bytes);
  Resources result;
  std::vector<VkDescriptorSetLayoutBinding> layout_bindings;
  std::vector<VkDescriptorPoolSize> sizes;
  std::vector<VkWriteDescriptorSet> writes;
  std::vector<std::vector<VkSampler>> immutable(bindings.size());
  for (const Binding& b : bindings) {
    const auto count = static_cast<uint32_t>(std::max({b.buffers.size(), b.images.size(), b.views.size()}));
    const VkShaderStageFlags stages =
        b.type == VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_ALL;
    std::vector<VkSampler>& samplers = immutable[layout_bindings.size()];
    if (b.immutable_samplers)
      for (const VkDescriptorImageInfo& image : b.images) samplers.push_back(image.sampler);
    layout_bindings.push_back({b.binding, b.type, count, stages, samplers.empty() ? nullptr : samplers.data()});
    sizes.push_back({b.type, count});
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = b.binding;
    write.descriptorCount = count;
    write.descriptorType = b.type;
    write.pBufferInfo = b.buffers.data();
    write.pImageInfo = b.images.data();
    write.pTexelBufferView = b.views.data();
    writes.push_back(write);
  }
  if (!bindings.empty()) {
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<uint32_t>(layout_bindings.size());
    info.pBindings = layout_bindings.data();
    CTS_VK(vkCreateDescriptorSetLayout(device, &info, nullptr, &result.set_layout));
    own(result.set_layout, vkDestroyDescriptorSetLayout);
    VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool;
    CTS_VK(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool));
    own(pool, vkDestroyDescriptorPool);
    VkDescriptorSetAllocateInfo allocate_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate_info.descriptorPool = pool;
    allocate_info.descriptorSetCount = 1;
    allocate_info.pSetLayouts = &result.set_layout;
    CTS_VK(vkAllocateDescriptorSets(device, &allocate_info, &result.set));
    for (VkWriteDescriptorSet& write : writes) write.dstSet = result.set;
    vkUpdateDescriptorSets(device, static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
  }
  const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, push_bytes};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = bindings.empty() ? 0 : 1;
  layout.pSetLayouts = &result.set_layout;
  layout.pushConstantRangeCount = push_bytes ? 1 : 0;
  layout.pPushConstantRanges = &range;
  CTS_VK(vkCreatePipelineLayout(device, &layout, nullptr, &result.layout));
  own(result.layout, vkDestroyPipelineLayout);
  return result;
}

VkPipeline Run::compute(VkPipelineLayout layout, VkShaderModule module, const VkSpecializationInfo* special) {
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                nullptr,
                0,
                VK_SHADER_STAGE_COMPUTE_BIT,
                module,
                "main",
                special};
  info.layout = layout;
  inputs.special(special);
  VkPipeline result;
  CTS_VK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &result));
  return own(result, vkDestroyPipeline);
}

VkCommandBuffer Run::begin() {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool_;
  info.commandBufferCount = 1;
  VkCommandBuffer cmd;
  CTS_VK(vkAllocateCommandBuffers(device, &info, &cmd));
  const VkCommandBufferBeginInfo begin_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  CTS_VK(vkBeginCommandBuffer(cmd, &begin_info));
  if (!pending_.empty()) {
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
                         nullptr, static_cast<uint32_t>(pending_.size()), pending_.data());
    pending_.clear();
  }
  return cmd;
}

VkCommandBuffer Run::begin_secondary(const VkCommandBufferInheritanceInfo& inheritance,
                                     VkCommandBufferUsageFlags usage) {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool_;
  info.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
  info.commandBufferCount = 1;
  VkCommandBuffer cmd;
  CTS_VK(vkAllocateCommandBuffers(device, &info, &cmd));
  VkCommandBufferBeginInfo begin_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin_info.flags = usage;
  begin_info.pInheritanceInfo = &inheritance;
  CTS_VK(vkBeginCommandBuffer(cmd, &begin_info));
  return cmd;
}

void Run::barrier(VkCommandBuffer cmd) {
  VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  all.srcAccessMask = all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                       VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &all, 0, nullptr, 0,
                       nullptr);
}

void Run::submit(VkCommandBuffer cmd) {
  inputs.submission();
  barrier(cmd);
  CTS_VK(vkEndCommandBuffer(cmd));
  VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence;
  CTS_VK(vkCreateFence(device, &fence_info, nullptr, &fence));
  own(fence, vkDestroyFence);
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &cmd;
  CTS_VK(vkQueueSubmit(gpu.queue, 1, &info, fence));
  // Half of a case's time, so that the case can still say so before it is ended.
  const std::uint64_t patience = std::uint64_t{options().timeout_s} * 1'000'000'000 / 2;
  const VkResult waited = vkWaitForFences(device, 1, &fence, VK_TRUE, patience);
  CTS_VK(waited);
  if (waited == VK_TIMEOUT) throw std::runtime_error("the submission did not end within half of the case's time");
}

void Run::once(const std::function<void(VkCommandBuffer)>& record) {
  const VkCommandBuffer cmd = begin();
  record(cmd);
  submit(cmd);
}

void Run::dispatch(const Resources& resources, VkPipeline pipeline, uint32_t x, uint32_t y, uint32_t z) {
  inputs.given().numbers(x, y, z);
  once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    resources.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, x, y, z);
  });
}

void Run::dispatch(const Resources& resources, VkPipeline pipeline, uint32_t x, std::span<const std::byte> push) {
  inputs.given().numbers(x);
  inputs.push_constants(push);
  once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    resources.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    if (!push.empty())
      vkCmdPushConstants(cmd, resources.layout, VK_SHADER_STAGE_ALL, 0, static_cast<uint32_t>(push.size()),
                         push.data());
    vkCmdDispatch(cmd, x, 1, 1);
  });
}

void Run::may_be_blank() {
  for (Output& output : outputs) output.may_be_blank = true;
}

}  // namespace vitrine::cts
