// Objects of absurd sizes: they are made or there is an error of memory, and nothing else suffers.
#include "tests/fuzz/objects.h"

#define VK_CALL(name) VK_GET(d_.instance, name)

/// Of AddressSanitizer: what it is asked for in vain is an error of ours to handle, as of any allocator.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }

namespace vitrine::fuzz {

using icd::make_struct;

namespace {

/// Any 64 bits but 0, often close to a power of two.
std::uint64_t size(Choices& c) {
  const std::uint64_t power = std::uint64_t{1} << c.below(64);
  const std::uint64_t some = std::uint64_t{c.hostile()} << c.below(33);
  const std::uint64_t value = c.one_in(2) ? power + (std::uint64_t{c.below(5)} - 2) : some;
  return value ? value : 1;
}

std::uint32_t count(Choices& c) {
  const auto value = static_cast<std::uint32_t>(size(c) >> c.below(33));
  return value ? value : 1;
}

}  // namespace

void Objects::make_absurd() {
  const auto try_to = [&]<class Info, class Handle>(
                          VkResult(VKAPI_PTR * call)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
                          void(VKAPI_PTR * end)(VkDevice, Handle, const VkAllocationCallbacks*), const Info& info) {
    Handle handle{};
    const VkResult result = call(d_.device, &info, nullptr, &handle);
    demand(result == VK_SUCCESS || result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY,
           "an object of any size, or no memory for it");
    if (result == VK_SUCCESS) end(d_.device, handle, nullptr);
  };
  switch (c_.below(6)) {
    case 0: {
      auto info = make_struct<VkMemoryAllocateInfo>();
      info.allocationSize = size(c_);
      try_to(VK_CALL(AllocateMemory), VK_CALL(FreeMemory), info);
      break;
    }
    case 1: {
      auto info = make_struct<VkBufferCreateInfo>();
      info.size = size(c_);
      info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
      try_to(VK_CALL(CreateBuffer), VK_CALL(DestroyBuffer), info);
      break;
    }
    case 2: {
      VkPhysicalDeviceProperties properties;
      VK_CALL(GetPhysicalDeviceProperties)(d_.physical_device, &properties);
      const VkPhysicalDeviceLimits& limits = properties.limits;
      const bool volume = c_.one_in(3);
      const std::uint32_t most = volume ? limits.maxImageDimension3D : limits.maxImageDimension2D;
      auto info = make_struct<VkImageCreateInfo>();
      info.imageType = volume ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
      info.format = c_.one_in(2) ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_BC7_UNORM_BLOCK;
      info.extent = {1 + count(c_) % most, 1 + count(c_) % most, volume ? 1 + count(c_) % most : 1};
      info.mipLevels = 1;
      info.arrayLayers = volume ? 1 : 1 + count(c_) % limits.maxImageArrayLayers;
      info.samples = VK_SAMPLE_COUNT_1_BIT;
      info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
      try_to(VK_CALL(CreateImage), VK_CALL(DestroyImage), info);
      break;
    }
    case 3: {
      auto info = make_struct<VkQueryPoolCreateInfo>();
      info.queryType = VK_QUERY_TYPE_OCCLUSION;
      // More makes AddressSanitizer mark gigabytes; loaded_test asks for all that there can be.
      info.queryCount = 1 + count(c_) % (1u << 22);
      try_to(VK_CALL(CreateQueryPool), VK_CALL(DestroyQueryPool), info);
      break;
    }
    case 4: {
      const VkDescriptorPoolSize of_pool{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count(c_)};
      auto info = make_struct<VkDescriptorPoolCreateInfo>();
      info.maxSets = count(c_);
      info.poolSizeCount = 1;
      info.pPoolSizes = &of_pool;
      try_to(VK_CALL(CreateDescriptorPool), VK_CALL(DestroyDescriptorPool), info);
      break;
    }
    default: {
      const VkDescriptorSetLayoutBinding binding{count(c_), VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count(c_),
                                                 VK_SHADER_STAGE_ALL, nullptr};
      auto info = make_struct<VkDescriptorSetLayoutCreateInfo>();
      info.bindingCount = 1;
      info.pBindings = &binding;
      try_to(VK_CALL(CreateDescriptorSetLayout), VK_CALL(DestroyDescriptorSetLayout), info);
    }
  }
}

}  // namespace vitrine::fuzz
