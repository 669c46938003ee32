// Graphics and compute pipelines (Vulkan 1.3.239, Pipelines).
#include "icd/pipeline.h"

#include "base/check.h"
#include "icd/diagnostics.h"
#include "icd/entry_points.h"
#include "icd/render_pass.h"
#include "icd/util.h"

namespace vitrine::icd {
namespace {

// Of a stage that does not compile: "an unknown error has occurred; either the application has provided invalid input,
// or an implementation failure has occurred" (VK_ERROR_UNKNOWN); no code of core Vulkan says it better. A messenger
// gets the reason.
constexpr VkResult kCompileError = VK_ERROR_UNKNOWN;

const char* stage_name(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return "vertex";
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return "fragment";
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return "compute";
    default:
      return "unsupported";
  }
}

std::shared_ptr<const CompiledShader> compile_or_report(Device& device, PipelineCache* cache,
                                                        const StageRequest& request) {
  std::string problem;
  std::shared_ptr<const CompiledShader> shader = compile_stage(device, cache, request, problem);
  if (!shader) {
    const ShaderModule& module = from_handle<ShaderModule>(request.stage->module);
    report_error(device, ref(module), "pipeline", std::string(stage_name(request.stage->stage)) + " stage: " + problem);
  }
  return shader;
}

std::uint32_t live_outputs(const Subpass& subpass) {
  std::uint32_t live = 0;
  for (std::size_t i = 0; i < subpass.colors.size(); ++i) {
    if (subpass.colors[i] != VK_ATTACHMENT_UNUSED) live |= 1u << i;
  }
  return live;
}

/// Compiles the stages that take part. False after a report.
bool compile_graphics(Device& device, PipelineCache* cache, const VkGraphicsPipelineCreateInfo& info,
                      const Subpass& subpass, Pipeline& pipeline) {
  for (std::uint32_t i = 0; i < info.stageCount; ++i) {
    const VkPipelineShaderStageCreateInfo& stage = info.pStages[i];
    StageRequest request{&stage, pipeline.layout, 0};
    if (stage.stage == VK_SHADER_STAGE_VERTEX_BIT) {
      pipeline.vertex = compile_or_report(device, cache, request);
      if (!pipeline.vertex) return false;
    } else if (stage.stage == VK_SHADER_STAGE_FRAGMENT_BIT) {
      if (pipeline.state.rasterizer_discard) continue;
      request.live_color_outputs = live_outputs(subpass);
      pipeline.fragment = compile_or_report(device, cache, request);
      if (!pipeline.fragment) return false;
    } else {
      VITRINE_UNSUPPORTED("tessellation and geometry stages");
      return false;
    }
  }
  return pipeline.vertex != nullptr;
}

/// The attachments that a pipeline of dynamic rendering names, as if they were a subpass's: colour i is attachment i.
Subpass make_subpass(const VkGraphicsPipelineCreateInfo& info, const HostMemory& memory) {
  Subpass subpass(memory);
  const auto* rendering = find_in_chain<VkPipelineRenderingCreateInfo>(info.pNext);
  if (!rendering) return subpass;
  subpass.view_mask = rendering->viewMask;
  for (std::uint32_t i = 0; i < rendering->colorAttachmentCount; ++i) {
    const bool used = rendering->pColorAttachmentFormats[i] != VK_FORMAT_UNDEFINED;
    subpass.colors.push_back(used ? i : VK_ATTACHMENT_UNUSED);
  }
  if (rendering->depthAttachmentFormat || rendering->stencilAttachmentFormat) {
    subpass.depth_stencil = rendering->colorAttachmentCount;
  }
  return subpass;
}

VkResult create_graphics_pipeline(Device& device, PipelineCache* cache, const VkGraphicsPipelineCreateInfo& info,
                                  const VkAllocationCallbacks* allocator, VkPipeline* out) {
  const RenderPass* pass = from_nullable<RenderPass>(info.renderPass);
  const Subpass dynamic = make_subpass(info, device.memory);
  const Subpass& subpass = pass ? pass->subpasses[info.subpass] : dynamic;
  Owned<Pipeline> pipeline(create_object<Pipeline>(device.memory, allocator));
  pipeline->layout = from_handle<PipelineLayout>(info.layout).shape;
  fill_static_state(*pipeline, info, subpass);
  if (!compile_graphics(device, cache, info, subpass, *pipeline)) return kCompileError;
  *out = to_handle(pipeline.release());
  return VK_SUCCESS;
}

VkResult create_compute_pipeline(Device& device, PipelineCache* cache, const VkComputePipelineCreateInfo& info,
                                 const VkAllocationCallbacks* allocator, VkPipeline* out) {
  Owned<Pipeline> pipeline(create_object<Pipeline>(device.memory, allocator));
  pipeline->bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
  pipeline->layout = from_handle<PipelineLayout>(info.layout).shape;
  pipeline->compute = compile_or_report(device, cache, {&info.stage, pipeline->layout, 0});
  if (!pipeline->compute) return kCompileError;
  *out = to_handle(pipeline.release());
  return VK_SUCCESS;
}

/// "If creation fails for any pipeline, the others are still created; failed ones are VK_NULL_HANDLE."
template <class Info, class Create>
VkResult create_all(VkDevice device, VkPipelineCache cache, std::uint32_t count, const Info* infos,
                    const VkAllocationCallbacks* allocator, VkPipeline* pipelines, Create create) {
  VkResult result = VK_SUCCESS;
  for (std::uint32_t i = 0; i < count; ++i) {
    pipelines[i] = VK_NULL_HANDLE;
    VkResult one;
    try {
      one =
          create(from_handle<Device>(device), from_nullable<PipelineCache>(cache), infos[i], allocator, &pipelines[i]);
    } catch (const std::bad_alloc&) {
      one = VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    if (one != VK_SUCCESS) result = one;
  }
  return result;
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateGraphicsPipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                                       const VkGraphicsPipelineCreateInfo* infos,
                                                       const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  return create_all(device, cache, count, infos, allocator, pipelines, create_graphics_pipeline);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateComputePipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                                      const VkComputePipelineCreateInfo* infos,
                                                      const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  return create_all(device, cache, count, infos, allocator, pipelines, create_compute_pipeline);
}

VKAPI_ATTR void VKAPI_CALL DestroyPipeline(VkDevice, VkPipeline pipeline, const VkAllocationCallbacks*) {
  destroy_handle<Pipeline>(pipeline);
}

}  // namespace entry
}  // namespace vitrine::icd
