// See pipeline_binaries_fixture.h.
#include "tests/icd/pipeline_binaries_fixture.h"

#include <cstring>
#include <utility>

#ifdef VK_KHR_pipeline_binary
namespace vitrine::icd::test {

#define VK_CALL(name) VK_GET(instance, name)

void PipelineBinaryDevice::make_device() {
  auto binaries = make_struct<VkPhysicalDevicePipelineBinaryFeaturesKHR>();
  binaries.pipelineBinaries = VK_TRUE;
  auto maintenance = make_struct<VkPhysicalDeviceMaintenance5FeaturesKHR>(&binaries);
  maintenance.maintenance5 = VK_TRUE;
  auto libraries = make_struct<VkPhysicalDeviceGraphicsPipelineLibraryFeaturesEXT>(&maintenance);
  libraries.graphicsPipelineLibrary = VK_TRUE;
  auto identifiers = make_struct<VkPhysicalDeviceShaderModuleIdentifierFeaturesEXT>(&libraries);
  identifiers.shaderModuleIdentifier = VK_TRUE;
  auto control = make_struct<VkPhysicalDevicePipelineCreationCacheControlFeatures>(&identifiers);
  control.pipelineCreationCacheControl = VK_TRUE;
  auto rendering = make_struct<VkPhysicalDeviceDynamicRenderingFeatures>(&control);
  rendering.dynamicRendering = VK_TRUE;
  // Nothing is there to be switched off: it makes no difference.
  auto cache = make_struct<VkDevicePipelineBinaryInternalCacheControlKHR>(&rendering);
  cache.disableInternalCache = VK_TRUE;
  auto features = make_struct<VkPhysicalDeviceFeatures2>(&cache);
  features.features.geometryShader = features.features.tessellationShader = VK_TRUE;
  features.features.vertexPipelineStoresAndAtomics = features.features.fragmentStoresAndAtomics = VK_TRUE;
  const char* const names[] = {
      VK_KHR_PIPELINE_BINARY_EXTENSION_NAME,           VK_KHR_MAINTENANCE_5_EXTENSION_NAME,
      VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME,         VK_KHR_PIPELINE_LIBRARY_EXTENSION_NAME,
      VK_EXT_GRAPHICS_PIPELINE_LIBRARY_EXTENSION_NAME, VK_EXT_SHADER_MODULE_IDENTIFIER_EXTENSION_NAME,
      VK_EXT_EXTENDED_DYNAMIC_STATE_EXTENSION_NAME,    VK_EXT_PIPELINE_CREATION_CACHE_CONTROL_EXTENSION_NAME};
  ASSERT_EQ(create_device(instance, physical_device, &device, host, &features, names), VK_SUCCESS);
}

void PipelineBinaryDevice::SetUp() {
  ShaderObjectDevice::SetUp();
  auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
  info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) -> VkBool32 {
    static_cast<PipelineBinaryDevice*>(self)->heard.push_back(data->pMessage);
    return VK_FALSE;
  };
  info.pUserData = this;
  ASSERT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger_), VK_SUCCESS);
}

void PipelineBinaryDevice::TearDown() {
  for (const VkPipelineBinaryKHR b : std::exchange(binaries_, {}))
    VK_CALL(DestroyPipelineBinaryKHR)(device, b, nullptr);
  for (const VkPipeline p : std::exchange(made_, {})) VK_CALL(DestroyPipeline)(device, p, nullptr);
  VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger_, nullptr);
  ShaderObjectDevice::TearDown();
}

template <class Info, class F>
VkPipeline PipelineBinaryDevice::create_with(F create, const Info& info, const PipelineChain& chain,
                                             VkResult expected) {
  Info out = info;
  auto flags = make_struct<VkPipelineCreateFlags2CreateInfoKHR>(const_cast<void*>(out.pNext));
  flags.flags = info.flags | chain.flags;
  auto binaries = make_struct<VkPipelineBinaryInfoKHR>(&flags);
  binaries.binaryCount = static_cast<std::uint32_t>(chain.binaries.size());
  binaries.pPipelineBinaries = chain.binaries.data();
  out.pNext = &binaries;
  VkPipeline pipeline = VK_NULL_HANDLE;
  EXPECT_EQ(create(device, VK_NULL_HANDLE, 1, &out, nullptr, &pipeline), expected);
  EXPECT_EQ(pipeline != VkPipeline{}, expected == VK_SUCCESS);
  return made_.emplace_back(pipeline);
}

VkPipeline PipelineBinaryDevice::create(const VkGraphicsPipelineCreateInfo& info, const PipelineChain& chain,
                                        VkResult expected) {
  return create_with(VK_CALL(CreateGraphicsPipelines), info, chain, expected);
}

VkPipeline PipelineBinaryDevice::create(const VkComputePipelineCreateInfo& info, const PipelineChain& chain,
                                        VkResult expected) {
  return create_with(VK_CALL(CreateComputePipelines), info, chain, expected);
}

VkComputePipelineCreateInfo PipelineBinaryDevice::compute_info(VkShaderModule module) const {
  auto info = make_struct<VkComputePipelineCreateInfo>();
  info.stage = make_struct<VkPipelineShaderStageCreateInfo>();
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.layout = layout;
  return info;
}

Binaries PipelineBinaryDevice::binaries_of(VkPipeline pipeline) {
  auto from = make_struct<VkPipelineBinaryCreateInfoKHR>();
  from.pipeline = pipeline;
  auto handles = make_struct<VkPipelineBinaryHandlesInfoKHR>();
  EXPECT_EQ(VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles), VK_SUCCESS);
  Binaries out(handles.pipelineBinaryCount);
  handles.pPipelineBinaries = out.data();
  EXPECT_EQ(VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles), VK_SUCCESS);
  EXPECT_EQ(handles.pipelineBinaryCount, out.size());
  binaries_.insert(binaries_.end(), out.begin(), out.end());
  return out;
}

Blob PipelineBinaryDevice::blob_of(VkPipelineBinaryKHR binary) {
  auto info = make_struct<VkPipelineBinaryDataInfoKHR>();
  info.pipelineBinary = binary;
  Blob blob, sized;
  std::size_t size = 0;
  EXPECT_EQ(VK_CALL(GetPipelineBinaryDataKHR)(device, &info, &sized.key, &size, nullptr), VK_SUCCESS);
  blob.data.resize(size);
  EXPECT_EQ(VK_CALL(GetPipelineBinaryDataKHR)(device, &info, &blob.key, &size, blob.data.data()), VK_SUCCESS);
  EXPECT_EQ(size, blob.data.size());
  EXPECT_EQ(sized.key_bytes(), blob.key_bytes());
  EXPECT_GT(blob.key.keySize, 0u);
  return blob;
}

Blobs PipelineBinaryDevice::blobs_of(VkPipeline pipeline) {
  Blobs blobs;
  for (const VkPipelineBinaryKHR binary : binaries_of(pipeline)) blobs.push_back(blob_of(binary));
  return blobs;
}

VkResult PipelineBinaryDevice::read(const Blobs& blobs, Binaries& out) {
  std::vector<VkPipelineBinaryKeyKHR> keys;
  std::vector<VkPipelineBinaryDataKHR> data;
  for (const Blob& blob : blobs) {
    keys.push_back(blob.key);
    data.push_back({blob.data.size(), const_cast<std::byte*>(blob.data.data())});
  }
  const VkPipelineBinaryKeysAndDataKHR given{static_cast<std::uint32_t>(blobs.size()), keys.data(), data.data()};
  auto from = make_struct<VkPipelineBinaryCreateInfoKHR>();
  from.pKeysAndDataInfo = &given;
  auto handles = make_struct<VkPipelineBinaryHandlesInfoKHR>();
  EXPECT_EQ(VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles), VK_SUCCESS);
  EXPECT_EQ(handles.pipelineBinaryCount, blobs.size());
  out.resize(blobs.size());
  std::memset(out.data(), 0xee, out.size() * sizeof out[0]);
  handles.pPipelineBinaries = out.data();
  const VkResult result = VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles);
  binaries_.insert(binaries_.end(), out.begin(), out.end());
  return result;
}

Binaries PipelineBinaryDevice::read(const Blobs& blobs) {
  Binaries out;
  EXPECT_EQ(read(blobs, out), VK_SUCCESS);
  return out;
}

std::string PipelineBinaryDevice::key_of(const void* create_info) {
  auto info = make_struct<VkPipelineCreateInfoKHR>(const_cast<void*>(create_info));
  Blob blob;
  std::memset(blob.key.key, 0xee, sizeof blob.key.key);
  EXPECT_EQ(VK_CALL(GetPipelineKeyKHR)(device, create_info ? &info : nullptr, &blob.key), VK_SUCCESS);
  EXPECT_GT(blob.key.keySize, 0u);
  EXPECT_LE(blob.key.keySize, VK_MAX_PIPELINE_BINARY_KEY_SIZE_KHR);
  return blob.key_bytes();
}

std::vector<std::uint32_t> PipelineBinaryDevice::dispatched(VkPipeline pipeline) {
  std::memset(storage.data, 0xff, storage.size);
  run([&](VkCommandBuffer commands) {
    const std::uint32_t offset[4] = {100, 0, 0, 0};
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, sizeof offset, offset);
    const auto bind_sets = VK_CALL(CmdBindDescriptorSets);
    bind_sets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  });
  std::vector<std::uint32_t> out(4);
  std::memcpy(out.data(), storage.data, 16);
  return out;
}

}  // namespace vitrine::icd::test
#endif
