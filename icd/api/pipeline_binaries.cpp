// VK_KHR_pipeline_binary (Vulkan 1.4.309, Pipelines: Pipeline Binaries). There is no cache behind the application's
// back from which they could come: pPipelineCreateInfo finds nothing.
#include <algorithm>
#include <cstring>

#include "glass/timeline.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/pipeline_binary.h"
#include "icd/object/stage_binary.h"

#ifdef VK_KHR_pipeline_binary
namespace vitrine::icd {
namespace {

constexpr std::uint32_t kVersion = 1;  ///< of what is in binaries beside the driver's version

/// Another version of the driver reads no binaries of this one.
BinaryFormat format_of(const Device& device) { return {device.physical_device.properties.pipelineCacheUUID, kVersion}; }

void write_key(const ShaderKey& key, VkPipelineBinaryKeyKHR& out) {
  static_assert(sizeof key <= VK_MAX_PIPELINE_BINARY_KEY_SIZE_KHR);
  out.keySize = sizeof key;
  std::memset(out.key, 0, sizeof out.key);
  std::memcpy(out.key, key.data(), sizeof key);
}

bool is_key(const ShaderKey& key, const VkPipelineBinaryKeyKHR& given) {
  return given.keySize == sizeof key && std::memcmp(given.key, key.data(), sizeof key) == 0;
}

/// What stages of create infos stand for in keys: their binaries with identifiers in the place of words, "equal to the
/// key generated when using the shader module from which the identifier was queried" (vkGetPipelineKeyKHR).
class KeyWords {
 public:
  /// What applies to all pipelines.
  explicit KeyWords(const Device& device) : device_(device), words_(device.memory) { append(KeptStage(device.memory)); }
  /// A pipeline of this kind, whose stages follow.
  void begin(VkPipelineBindPoint kind) { words_.push_back(static_cast<std::uint32_t>(kind)); }
  void add(const VkPipelineShaderStageCreateInfo& stage) {
    const std::shared_ptr<KeptStage> named = keep_stage(stage, device_.memory);
    const ShaderKey identifier = identifier_of(stage);
    named->words.resize(sizeof identifier / sizeof named->words[0]);
    std::memcpy(named->words.data(), identifier.data(), sizeof identifier);
    append(*named);
  }
  ShaderKey key() const { return identifier_of(words_); }

 private:
  void append(const KeptStage& stage) {
    const Vector<std::uint32_t> binary = stage_binary(stage, format_of(device_));
    words_.insert(words_.end(), binary.begin(), binary.end());
  }

  const Device& device_;
  Vector<std::uint32_t> words_;
};

/// A pipeline as it would be made, with the stages of libraries first.
void add_pipeline(const VkGraphicsPipelineCreateInfo& info, KeyWords& key) {
  key.begin(VK_PIPELINE_BIND_POINT_GRAPHICS);
  if (const auto* libraries = find_in_chain<VkPipelineLibraryCreateInfoKHR>(info.pNext))
    for (std::uint32_t i = 0; i < libraries->libraryCount; ++i)
      for (const auto& kept : from_handle<Pipeline>(libraries->pLibraries[i]).library_stages)
        key.add(StageInfo(*kept).info());
  for (const OwnStage& stage : own_stages(info)) key.add(*stage.info);
}

ShaderKey key_of(const KeptStage& stage, const Device& device) {
  return identifier_of(stage_binary(stage, format_of(device)));
}

void add_pipeline(const VkComputePipelineCreateInfo& info, KeyWords& key) {
  key.begin(VK_PIPELINE_BIND_POINT_COMPUTE);
  key.add(info.stage);
}

/// One of the application's, which is refused unless it is as it was given out.
VkResult read_binary(Device& device, const VkPipelineBinaryKeyKHR& key, const VkPipelineBinaryDataKHR& data,
                     std::shared_ptr<const KeptStage>& out) {
  const auto stage = std::allocate_shared<KeptStage>(HostAllocator<KeptStage>(device.memory), device.memory);
  const char* problem = read_stage_binary(data.pData, data.dataSize, format_of(device), *stage);
  if (!problem && !is_key(key_of(*stage, device), key)) problem = "its key is another's";
  if (problem) {
    report_error(device, ref(device), "pipeline", std::string("a pipeline binary is refused: ") + problem);
    return VK_ERROR_INITIALIZATION_FAILED;
  }
  out = stage;
  return VK_SUCCESS;
}

/// Calls make(i, stage) for each of `count` binaries, or for as many as the application has room for.
template <class Make>
VkResult create_all(Device& device, std::uint32_t count, const VkAllocationCallbacks* allocator,
                    VkPipelineBinaryHandlesInfoKHR& out, Make make) {
  if (!out.pPipelineBinaries) {
    out.pipelineBinaryCount = count;
    return VK_SUCCESS;
  }
  const std::uint32_t made = std::min(count, out.pipelineBinaryCount);
  VkResult result = made < count ? VK_INCOMPLETE : VK_SUCCESS;
  for (std::uint32_t i = 0; i < made; ++i) {
    VkResult one;
    out.pPipelineBinaries[i] = VK_NULL_HANDLE;
    try {
      std::shared_ptr<const KeptStage> stage;
      one = make(i, stage);
      if (one == VK_SUCCESS)
        out.pPipelineBinaries[i] = to_handle(create_object<PipelineBinary>(device.memory, allocator, std::move(stage)));
    } catch (const std::bad_alloc&) {
      one = VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    if (one != VK_SUCCESS && result >= VK_SUCCESS) result = one;  // that of the first that could not be made
  }
  out.pipelineBinaryCount = made;
  return result;
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreatePipelineBinariesKHR(VkDevice device, const VkPipelineBinaryCreateInfoKHR* info,
                                                         const VkAllocationCallbacks* allocator,
                                                         VkPipelineBinaryHandlesInfoKHR* binaries) {
  const glass::Span span("pipeline", "create pipeline binaries");
  Device& d = from_handle<Device>(device);
  if (const VkPipelineBinaryKeysAndDataKHR* given = info->pKeysAndDataInfo) {
    const auto read = [&](std::uint32_t i, std::shared_ptr<const KeptStage>& stage) {
      return read_binary(d, given->pPipelineBinaryKeys[i], given->pPipelineBinaryData[i], stage);
    };
    return create_all(d, given->binaryCount, allocator, *binaries, read);
  }
  if (const Pipeline* pipeline = from_nullable<Pipeline>(info->pipeline)) {
    const auto take = [&](std::uint32_t i, std::shared_ptr<const KeptStage>& stage) {
      stage = pipeline->binary_stages[i];
      return VK_SUCCESS;
    };
    const auto count = static_cast<std::uint32_t>(pipeline->binary_stages.size());
    return create_all(d, count, allocator, *binaries, take);
  }
  if (binaries->pPipelineBinaries)
    std::fill_n(binaries->pPipelineBinaries, binaries->pipelineBinaryCount, VkPipelineBinaryKHR{});
  binaries->pipelineBinaryCount = 0;
  return VK_PIPELINE_BINARY_MISSING_KHR;
}

VKAPI_ATTR void VKAPI_CALL DestroyPipelineBinaryKHR(VkDevice, VkPipelineBinaryKHR binary,
                                                    const VkAllocationCallbacks*) {
  destroy_handle<PipelineBinary>(binary);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineKeyKHR(VkDevice device, const VkPipelineCreateInfoKHR* info,
                                                 VkPipelineBinaryKeyKHR* key) {
  KeyWords words(from_handle<Device>(device));
  const void* chain = info ? info->pNext : nullptr;
  if (const auto* graphics = find_in_chain<VkGraphicsPipelineCreateInfo>(chain)) add_pipeline(*graphics, words);
  if (const auto* compute = find_in_chain<VkComputePipelineCreateInfo>(chain)) add_pipeline(*compute, words);
  write_key(words.key(), *key);
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineBinaryDataKHR(VkDevice device, const VkPipelineBinaryDataInfoKHR* info,
                                                        VkPipelineBinaryKeyKHR* key, std::size_t* size, void* data) {
  const KeptStage& stage = *from_handle<PipelineBinary>(info->pipelineBinary).stage;
  const Vector<std::uint32_t> binary = stage_binary(stage, format_of(from_handle<Device>(device)));
  const std::size_t room = *size;
  *size = binary.size() * sizeof binary[0];
  if (data && room < *size) return VK_ERROR_NOT_ENOUGH_SPACE_KHR;
  if (data) std::memcpy(data, binary.data(), *size);
  write_key(identifier_of(binary), *key);
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL ReleaseCapturedPipelineDataKHR(VkDevice,
                                                              const VkReleaseCapturedPipelineDataInfoKHR* info,
                                                              const VkAllocationCallbacks*) {
  from_handle<Pipeline>(info->pipeline).binary_stages.clear();
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd
#endif
