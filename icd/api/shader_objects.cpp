// Shader objects (Vulkan 1.4.309, Shaders: Shader Objects).
#include "icd/object/shader_object.h"

#include <algorithm>
#include <cstring>

#include "glass/timeline.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/stage_binary.h"
#include "icd/properties.h"
#include "icd/record/command_buffer.h"

#ifdef VK_EXT_shader_object
namespace vitrine::icd {
namespace {

// Of a stage that does not compile; a messenger gets the reason.
constexpr VkResult kCompileError = VK_ERROR_INITIALIZATION_FAILED;

constexpr const auto& kClaimed = kClaimedPhysicalDeviceShaderObjectPropertiesEXT;
constexpr BinaryFormat kFormat{kClaimed.shaderBinaryUUID, kClaimed.shaderBinaryVersion};

/// What the application gave as SPIR-V.
void read_spirv(const VkShaderCreateInfoEXT& info, KeptStage& out) {
  out.stage = info.stage;
  out.words.resize(info.codeSize / sizeof(std::uint32_t));
  if (!out.words.empty()) std::memcpy(out.words.data(), info.pCode, out.words.size() * sizeof(std::uint32_t));
  out.entry_point = info.pName ? info.pName : "";
  if (const auto* size = find_in_chain<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(info.pNext))
    out.subgroup_size = size->requiredSubgroupSize;
  copy_specialization(info.pSpecializationInfo, out);
}

std::uint32_t color_outputs(const spirv::ShaderInterface& interface) {
  std::uint32_t outputs = 0;
  if (interface.stage != VK_SHADER_STAGE_FRAGMENT_BIT) return outputs;
  for (const spirv::InterfaceSlot& slot : interface.outputs)
    if (slot.built_in == spirv::BuiltIn::kNone && slot.location < raster::kMaxColorAttachments)
      outputs |= 1u << slot.location;
  return outputs;
}

/// Compiles what has been read. False after a report.
bool compile(Device& device, ShaderObject& object) {
  const StageInfo stage(object.source);
  StageRequest request;
  request.stage = &stage.info();
  request.layout = object.layout;
  if (object.source.stage == VK_SHADER_STAGE_FRAGMENT_BIT)
    request.live_color_outputs = kAllColorWrites;
  else
    request.live_color_outputs = 0;  // as pipelines have it: equal stages are compiled once
  StageResult result = compile_stage(device, nullptr, request);
  if (!result.shader) {
    report_error(device, ref(device), "shader",
                 std::string(stage_name(object.source.stage)) + " shader object: " + result.problem);
    return false;
  }
  object.shader = std::move(result.shader);
  object.color_outputs = color_outputs(object.shader->shader->interface());
  if (object.source.stage == VK_SHADER_STAGE_COMPUTE_BIT) object.compute = make_compute_pipeline(object);
  return true;
}

VkResult create_shader(Device& device, const VkShaderCreateInfoEXT& info, const VkAllocationCallbacks* allocator,
                       VkShaderEXT* out) {
  const glass::Span span("pipeline", "create shader object");
  if (stage_index(info.stage) > kGraphicsStages) {
    report_error(device, ref(device), "shader", "shader objects of this stage are not supported");
    return kCompileError;
  }
  Owned<ShaderObject> object(create_object<ShaderObject>(device.memory, allocator, device));
  object->layout = make_layout_shape(device.memory, {info.pSetLayouts, info.setLayoutCount},
                                     {info.pPushConstantRanges, info.pushConstantRangeCount});
  if (info.codeType == VK_SHADER_CODE_TYPE_BINARY_EXT) {
    const char* problem = read_stage_binary(info.pCode, info.codeSize, kFormat, object->source);
    if (problem || object->source.stage != info.stage || !compile(device, *object))
      return VK_INCOMPATIBLE_SHADER_BINARY_EXT;
  } else {
    read_spirv(info, object->source);
    if (!compile(device, *object)) return kCompileError;
  }
  *out = to_handle(object.release());
  return VK_SUCCESS;
}

}  // namespace

namespace entry {

/// "the application can determine which shader the returned error pertains to by locating the first VK_NULL_HANDLE
/// element in pShaders": what comes behind it is not made.
VKAPI_ATTR VkResult VKAPI_CALL CreateShadersEXT(VkDevice device, std::uint32_t count,
                                                const VkShaderCreateInfoEXT* infos,
                                                const VkAllocationCallbacks* allocator, VkShaderEXT* shaders) {
  std::fill_n(shaders, count, VkShaderEXT{});
  for (std::uint32_t i = 0; i < count; ++i) {
    const VkResult result = create_shader(from_handle<Device>(device), infos[i], allocator, &shaders[i]);
    if (result != VK_SUCCESS) return result;
  }
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyShaderEXT(VkDevice, VkShaderEXT shader, const VkAllocationCallbacks*) {
  destroy_handle<ShaderObject>(shader);
}

VKAPI_ATTR VkResult VKAPI_CALL GetShaderBinaryDataEXT(VkDevice, VkShaderEXT shader, std::size_t* size, void* data) {
  const KeptStage& source = from_handle<ShaderObject>(shader).source;
  const std::size_t bytes = stage_binary_bytes(source);
  if (data && *size < bytes) {
    *size = 0;
    return VK_INCOMPLETE;
  }
  if (data) std::memcpy(data, stage_binary(source, kFormat).data(), bytes);
  *size = bytes;
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL CmdBindShadersEXT(VkCommandBuffer buffer, std::uint32_t count,
                                             const VkShaderStageFlagBits* stages, const VkShaderEXT* shaders) {
  icd::CmdBindShaders command{};
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t index = stage_index(stages[i]);
    if (index > kGraphicsStages) continue;
    ShaderObject* const shader = shaders ? from_nullable<ShaderObject>(shaders[i]) : nullptr;
    command.stages[index] = shader && shader->source.stage == stages[i] ? shader : nullptr;
    command.bound |= 1u << index;
  }
  record(buffer, command);
}

}  // namespace entry
}  // namespace vitrine::icd
#endif
