// Graphics and compute pipelines (Vulkan 1.3.239, Pipelines).
#include "icd/object/pipeline.h"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "base/check.h"
#include "glass/timeline.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/render_pass.h"

namespace vitrine::icd {

std::uint64_t Pipeline::next_number() {
  static std::atomic<std::uint64_t> made{0};
  return ++made;
}

namespace {

VkPipelineCreateFlags flags_of([[maybe_unused]] const void* chain, VkPipelineCreateFlags narrow) {
#ifdef VK_KHR_maintenance5
  if (const auto* wide = find_in_chain<VkPipelineCreateFlags2CreateInfoKHR>(chain)) {
    return static_cast<VkPipelineCreateFlags>(wide->flags);
  }
#endif
  return narrow;
}

}  // namespace

VkPipelineCreateFlags create_flags(const VkGraphicsPipelineCreateInfo& info) {
  return flags_of(info.pNext, info.flags);
}
VkPipelineCreateFlags create_flags(const VkComputePipelineCreateInfo& info) { return flags_of(info.pNext, info.flags); }

namespace {

// Of a stage that does not compile: "an unknown error has occurred; either the application has provided invalid input,
// or an implementation failure has occurred" (VK_ERROR_UNKNOWN); no code of core Vulkan says it better. A messenger
// gets the reason.
constexpr VkResult kCompileError = VK_ERROR_UNKNOWN;

/// Compiles the stages of one pipeline, and tells the application how that went (VkPipelineCreationFeedback).
class StageCompiler {
 public:
  StageCompiler(Device& device, PipelineCache* cache, VkPipelineCreateFlags flags, const void* chain)
      : device_(device),
        cache_(cache),
        may_compile_(!(flags & VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT)),
        feedback_(find_in_chain<VkPipelineCreationFeedbackCreateInfo>(chain)) {
    if (feedback_) *feedback_->pPipelineCreationFeedback = {};
    for (std::uint32_t i = 0; feedback_ && i < feedback_->pipelineStageCreationFeedbackCount; ++i) {
      feedback_->pPipelineStageCreationFeedbacks[i] = {};
    }
  }

  /// `index` is the stage's in pStages. Null, after a report, if it cannot be compiled; failure() has the code.
  std::shared_ptr<const CompiledShader> compile(const VkPipelineShaderStageCreateInfo& stage, std::uint32_t index,
                                                const Pipeline& pipeline, std::uint32_t live_color_outputs) {
    const Clock::time_point start = Clock::now();
    StageRequest request{&stage, pipeline.layout, live_color_outputs, may_compile_, pipeline.captured};
    StageResult result = compile_stage(device_, cache_, request);
    if (feedback_ && index < feedback_->pipelineStageCreationFeedbackCount) {
      fill(feedback_->pPipelineStageCreationFeedbacks[index], start, result.was_in_cache);
    }
    all_in_cache_ &= result.was_in_cache;
    if (!result.shader && result.problem.empty()) {
      failure_ = VK_PIPELINE_COMPILE_REQUIRED;
    } else if (!result.shader) {
      const ObjectRef object = stage.module ? ref(from_handle<ShaderModule>(stage.module)) : ref(device_);
      report_error(device_, object, "pipeline", std::string(stage_name(stage.stage)) + " stage: " + result.problem);
    }
    return result.shader;
  }

  VkResult failure() const { return failure_; }
  void finish() {
    if (feedback_) fill(*feedback_->pPipelineCreationFeedback, start_, all_in_cache_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void fill(VkPipelineCreationFeedback& out, Clock::time_point start, bool was_in_cache) const {
    out.flags = VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT;
    if (was_in_cache) out.flags |= VK_PIPELINE_CREATION_FEEDBACK_APPLICATION_PIPELINE_CACHE_HIT_BIT;
    const auto duration = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start);
    out.duration = static_cast<std::uint64_t>(duration.count());
  }

  Device& device_;
  PipelineCache* cache_;
  bool may_compile_;
  const VkPipelineCreationFeedbackCreateInfo* feedback_;
  Clock::time_point start_ = Clock::now();
  bool all_in_cache_ = true;
  VkResult failure_ = kCompileError;
};

/// Where a pipeline keeps a stage; null: no stage of graphics pipelines.
std::shared_ptr<const CompiledShader>* shader_of(Pipeline& pipeline, VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return &pipeline.vertex;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return &pipeline.control;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return &pipeline.evaluation;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return &pipeline.geometry;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return &pipeline.fragment;
    default:
      return nullptr;
  }
}

/// Color outputs of the fragment shader that matter: those that reach an attachment, and the first, whose alpha may
/// decide the coverage without one.
std::uint32_t live_outputs(const Pipeline& pipeline) {
  const bool decides = pipeline.state.alpha_to_coverage || pipeline.dynamic.test(DynamicState::kAlphaToCoverageEnable);
  return located(pipeline.locations, pipeline.live_colors) | (decides ? 1u : 0u);
}

/// Compiles one stage if it takes part. False after a report.
bool compile_graphics_stage(StageCompiler& compiler, const VkPipelineShaderStageCreateInfo& stage, std::uint32_t index,
                            Pipeline& pipeline) {
  std::shared_ptr<const CompiledShader>* shader = shader_of(pipeline, stage.stage);
  if (!shader) {
    VITRINE_UNSUPPORTED("mesh and task stages");
    return false;
  }
  const bool fragment = stage.stage == VK_SHADER_STAGE_FRAGMENT_BIT;
  if (fragment && pipeline.never_rasterizes()) return true;
  *shader = compiler.compile(stage, index, pipeline, fragment ? live_outputs(pipeline) : 0);
  return *shader != nullptr;
}

/// A stage that a library kept, as the application gave it.
bool compile_library_stage(StageCompiler& compiler, const KeptStage& kept, Pipeline& pipeline) {
  return compile_graphics_stage(compiler, StageInfo(kept).info(), UINT32_MAX, pipeline);
}

/// Compiles the stages of the info and of linked libraries. False after a report.
bool compile_graphics(StageCompiler& compiler, const VkGraphicsPipelineCreateInfo& info, VkShaderStageFlags own_stages,
                      Pipeline& pipeline) {
  for (std::uint32_t i = 0; i < info.stageCount; ++i) {
    if (!(info.pStages[i].stage & own_stages)) continue;
    if (!compile_graphics_stage(compiler, info.pStages[i], i, pipeline)) return false;
  }
  for (const KeptStage& kept : pipeline.library_stages) {
    if (!compile_library_stage(compiler, kept, pipeline)) return false;
  }
  return pipeline.vertex != nullptr;
}

/// The stages that parts of a pipeline have.
VkShaderStageFlags stages_of(VkGraphicsPipelineLibraryFlagsEXT parts) {
  VkShaderStageFlags stages = 0;
  if (parts & VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT) {
    stages |= VK_SHADER_STAGE_ALL_GRAPHICS & ~VK_SHADER_STAGE_FRAGMENT_BIT;
  }
  if (parts & VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT) stages |= VK_SHADER_STAGE_FRAGMENT_BIT;
  return stages;
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
  const VkPipelineCreateFlags flags = create_flags(info);
  StageCompiler compiler(device, cache, flags, info.pNext);
  Owned<Pipeline> pipeline(create_object<Pipeline>(device.memory, allocator));
  pipeline->captured = flags & VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;
  if (const auto* layout = from_nullable<PipelineLayout>(info.layout)) pipeline->layout = layout->shape;
  if (const auto* libraries = find_in_chain<VkPipelineLibraryCreateInfoKHR>(info.pNext)) {
    for (std::uint32_t i = 0; i < libraries->libraryCount; ++i) {
      link_library(*pipeline, from_handle<Pipeline>(libraries->pLibraries[i]));
    }
  }
  const VkGraphicsPipelineLibraryFlagsEXT parts = own_parts(info);
  fill_static_state(*pipeline, info, subpass, parts);
  pipeline->state.unrestricted_depth = device.extensions.test(Extension::EXT_depth_range_unrestricted);
  if (flags & VK_PIPELINE_CREATE_LIBRARY_BIT_KHR) {
    for (std::uint32_t i = 0; i < info.stageCount; ++i) {
      if (!(info.pStages[i].stage & stages_of(parts))) continue;
      pipeline->library_stages.push_back(copy_stage(info.pStages[i], pipeline->memory));
    }
  } else {
    if (!compile_graphics(compiler, info, stages_of(parts), *pipeline)) return compiler.failure();
    pipeline->library_stages.clear();
    if (pipeline->dynamic.none()) leave_unnamed(*pipeline, pipeline->color_writes, pipeline->state);
  }
  compiler.finish();
  *out = to_handle(pipeline.release());
  return VK_SUCCESS;
}

VkResult create_compute_pipeline(Device& device, PipelineCache* cache, const VkComputePipelineCreateInfo& info,
                                 const VkAllocationCallbacks* allocator, VkPipeline* out) {
  const VkPipelineCreateFlags flags = create_flags(info);
  StageCompiler compiler(device, cache, flags, info.pNext);
  Owned<Pipeline> pipeline(create_object<Pipeline>(device.memory, allocator));
  pipeline->captured = flags & VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;
  pipeline->bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
  pipeline->layout = from_handle<PipelineLayout>(info.layout).shape;
  pipeline->compute = compiler.compile(info.stage, 0, *pipeline, 0);
  if (!pipeline->compute) return compiler.failure();
  compiler.finish();
  *out = to_handle(pipeline.release());
  return VK_SUCCESS;
}

/// "If creation fails for any pipeline, the others are still created; failed ones are VK_NULL_HANDLE."
template <class Info, class Create>
VkResult create_all(VkDevice device, VkPipelineCache cache, std::uint32_t count, const Info* infos,
                    const VkAllocationCallbacks* allocator, VkPipeline* pipelines, Create create) {
  VkResult result = VK_SUCCESS;
  std::fill_n(pipelines, count, VkPipeline{});
  for (std::uint32_t i = 0; i < count; ++i) {
    const glass::Span span("pipeline", "create pipeline");
    VkResult one;
    try {
      one =
          create(from_handle<Device>(device), from_nullable<PipelineCache>(cache), infos[i], allocator, &pipelines[i]);
    } catch (const std::bad_alloc&) {
      one = VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    // An error says more than that a pipeline would have to be compiled.
    if (one < 0 || (one != VK_SUCCESS && result == VK_SUCCESS)) result = one;
    if (one != VK_SUCCESS && (create_flags(infos[i]) & VK_PIPELINE_CREATE_EARLY_RETURN_ON_FAILURE_BIT)) break;
  }
  return result;
}

}  // namespace

std::array<ObjectRef, kGraphicsStages> objects_of(const Pipeline& pipeline) {
  if (pipeline.shader_objects[0].handle) return pipeline.shader_objects;
  return {ref(pipeline)};
}

const char* stage_name(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return "vertex";
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return "tessellation control";
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return "tessellation evaluation";
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return "geometry";
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return "fragment";
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return "compute";
    default:
      return "unsupported";
  }
}

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
