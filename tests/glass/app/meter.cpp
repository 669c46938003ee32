// An application, linked to the loader, that measures a dispatch with VK_KHR_performance_query, as a profiler would: a
// query for the dispatch and one for the whole command buffer, read by the host and copied to a buffer. Prints
// "NAME: COMMAND WHOLE COPIED", a line a counter that is not zero; for performance_layer_test.py.
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "tests/glass/app/meter_comp.h"

namespace {

void must(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  std::fprintf(stderr, "%s: VkResult %d\n", what, result);
  std::exit(3);
}

#define LOAD(name) reinterpret_cast<PFN_##name>(vkGetInstanceProcAddr(instance, #name))

VkInstance instance;
VkPhysicalDevice physical;
VkDevice device;
VkQueue queue;
std::vector<VkPerformanceCounterDescriptionKHR> names;

void make_device() {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  must(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(instance, &count, &physical) < 0 || count == 0) std::exit(3);
  VkPhysicalDevicePerformanceQueryFeaturesKHR queries{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PERFORMANCE_QUERY_FEATURES_KHR};
  queries.performanceCounterQueryPools = VK_TRUE;
  VkPhysicalDeviceHostQueryResetFeatures reset{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES, &queries};
  reset.hostQueryReset = VK_TRUE;
  const float priority = 1;
  VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  const char* extension = VK_KHR_PERFORMANCE_QUERY_EXTENSION_NAME;
  VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &reset};
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue_info;
  device_info.enabledExtensionCount = 1;
  device_info.ppEnabledExtensionNames = &extension;
  must(vkCreateDevice(physical, &device_info, nullptr, &device), "vkCreateDevice");
  vkGetDeviceQueue(device, 0, 0, &queue);
}

/// Of all counters, two queries.
VkQueryPool make_pool() {
  const auto ask = LOAD(vkEnumeratePhysicalDeviceQueueFamilyPerformanceQueryCountersKHR);
  std::uint32_t count = 0;
  must(ask(physical, 0, &count, nullptr, nullptr), "vkEnumerate...CountersKHR");
  std::vector<VkPerformanceCounterKHR> counters(count, {VK_STRUCTURE_TYPE_PERFORMANCE_COUNTER_KHR});
  names.assign(count, {VK_STRUCTURE_TYPE_PERFORMANCE_COUNTER_DESCRIPTION_KHR});
  must(ask(physical, 0, &count, counters.data(), names.data()), "vkEnumerate...CountersKHR");
  std::vector<std::uint32_t> all(count);
  for (std::uint32_t i = 0; i < count; ++i) all[i] = i;
  VkQueryPoolPerformanceCreateInfoKHR chosen{VK_STRUCTURE_TYPE_QUERY_POOL_PERFORMANCE_CREATE_INFO_KHR};
  chosen.counterIndexCount = count;
  chosen.pCounterIndices = all.data();
  std::uint32_t passes = 0;
  LOAD(vkGetPhysicalDeviceQueueFamilyPerformanceQueryPassesKHR)(physical, &chosen, &passes);
  if (passes != 1) std::exit(4);
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, &chosen};
  info.queryType = VK_QUERY_TYPE_PERFORMANCE_QUERY_KHR;
  info.queryCount = 2;
  VkQueryPool pool;
  must(vkCreateQueryPool(device, &info, nullptr, &pool), "vkCreateQueryPool");
  return pool;
}

struct Program {
  VkShaderModule module;
  VkPipelineLayout layout;
  VkPipeline pipeline;
};

Program make_program() {
  Program p;
  VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  module.codeSize = sizeof meter_comp;
  module.pCode = meter_comp;
  must(vkCreateShaderModule(device, &module, nullptr, &p.module), "vkCreateShaderModule");
  const VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  must(vkCreatePipelineLayout(device, &layout, nullptr, &p.layout), "vkCreatePipelineLayout");
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = p.module;
  info.stage.pName = "main";
  info.layout = p.layout;
  must(vkCreateComputePipelines(device, {}, 1, &info, nullptr, &p.pipeline), "vkCreateComputePipelines");
  return p;
}

struct Buffer {
  VkBuffer buffer;
  VkDeviceMemory memory;
  VkPerformanceCounterResultKHR* results;
};

Buffer make_buffer(VkDeviceSize size) {
  Buffer b;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  must(vkCreateBuffer(device, &info, nullptr, &b.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, b.buffer, &needs);
  VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocation.allocationSize = needs.size;
  must(vkAllocateMemory(device, &allocation, nullptr, &b.memory), "vkAllocateMemory");
  must(vkBindBufferMemory(device, b.buffer, b.memory, 0), "vkBindBufferMemory");
  void* data;
  must(vkMapMemory(device, b.memory, 0, VK_WHOLE_SIZE, 0, &data), "vkMapMemory");
  b.results = static_cast<VkPerformanceCounterResultKHR*>(data);
  return b;
}

void submit(VkCommandBuffer commands) {
  const VkPerformanceQuerySubmitInfoKHR pass{VK_STRUCTURE_TYPE_PERFORMANCE_QUERY_SUBMIT_INFO_KHR};
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO, &pass};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  must(vkQueueSubmit(queue, 1, &info, {}), "vkQueueSubmit");
  must(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
}

/// Query 0: the dispatch; 1: a command buffer of nothing but that.
void measure(VkQueryPool pool, const Program& program, const Buffer& copy, VkDeviceSize stride) {
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandPool command_pool;
  must(vkCreateCommandPool(device, &pool_info, nullptr, &command_pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = command_pool;
  allocation.commandBufferCount = 3;
  VkCommandBuffer commands[3];
  must(vkAllocateCommandBuffers(device, &allocation, commands), "vkAllocateCommandBuffers");
  vkResetQueryPool(device, pool, 0, 2);
  for (std::uint32_t query : {0u, 1u, 2u}) {
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    must(vkBeginCommandBuffer(commands[query], &begin), "vkBeginCommandBuffer");
    if (query == 1) vkCmdBeginQuery(commands[query], pool, query, 0);
    if (query < 2) vkCmdBindPipeline(commands[query], VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline);
    if (query == 0) vkCmdBeginQuery(commands[query], pool, query, 0);
    if (query < 2) vkCmdDispatch(commands[query], 3, 1, 1);
    if (query < 2) vkCmdEndQuery(commands[query], pool, query);
    if (query == 2)
      vkCmdCopyQueryPoolResults(commands[query], pool, 0, 1, copy.buffer, 0, stride, VK_QUERY_RESULT_WAIT_BIT);
    must(vkEndCommandBuffer(commands[query]), "vkEndCommandBuffer");
    submit(commands[query]);
  }
  vkDestroyCommandPool(device, command_pool, nullptr);
}

}  // namespace

int main() {
  make_device();
  VkAcquireProfilingLockInfoKHR lock{VK_STRUCTURE_TYPE_ACQUIRE_PROFILING_LOCK_INFO_KHR};
  lock.timeout = UINT64_MAX;
  must(LOAD(vkAcquireProfilingLockKHR)(device, &lock), "vkAcquireProfilingLockKHR");
  const VkQueryPool pool = make_pool();
  const Program program = make_program();
  const std::size_t stride = names.size() * sizeof(VkPerformanceCounterResultKHR);
  const Buffer copy = make_buffer(stride);
  measure(pool, program, copy, stride);
  std::vector<VkPerformanceCounterResultKHR> results(2 * names.size());
  must(vkGetQueryPoolResults(device, pool, 0, 2, 2 * stride, results.data(), stride, VK_QUERY_RESULT_WAIT_BIT),
       "vkGetQueryPoolResults");
  for (std::size_t i = 0; i < names.size(); ++i)
    if (results[i].uint64 != 0)
      std::printf("%s: %llu %llu %llu\n", names[i].name, static_cast<unsigned long long>(results[i].uint64),
                  static_cast<unsigned long long>(results[names.size() + i].uint64),
                  static_cast<unsigned long long>(copy.results[i].uint64));
  vkDestroyQueryPool(device, pool, nullptr);
  vkDestroyBuffer(device, copy.buffer, nullptr);
  vkFreeMemory(device, copy.memory, nullptr);
  vkDestroyPipeline(device, program.pipeline, nullptr);
  vkDestroyPipelineLayout(device, program.layout, nullptr);
  vkDestroyShaderModule(device, program.module, nullptr);
  LOAD(vkReleaseProfilingLockKHR)(device);
  vkDestroyDevice(device, nullptr);
  vkDestroyInstance(instance, nullptr);
}
