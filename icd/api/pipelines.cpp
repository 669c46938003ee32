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
#include "icd/object/pipeline_binary.h"
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
        given_(stages_of_binaries(chain, device.memory)),
        may_compile_(!given_.empty() || !(flags & VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT)),
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
    ++stages_;
    hits_ += result.was_in_cache;
    if (!result.shader && result.problem.empty()) {
      failure_ = VK_PIPELINE_COMPILE_REQUIRED;
    } else if (!result.shader) {
      const ObjectRef object = stage.module ? ref(from_handle<ShaderModule>(stage.module)) : ref(device_);
      report_error(device_, object, "pipeline", std::string(stage_name(stage.stage)) + " stage: " + result.problem);
    }
    return result.shader;
  }

  /// What the application's binaries give in place of the pipeline's stages; empty: it gives none.
  const KeptStages& given() const { return given_; }
  /// Whether they suit a pipeline of these stages. False after a report.
  bool check_given(const std::vector<VkShaderStageFlagBits>& stages) const {
    const std::string problem = mismatch(given_, stages);
    if (!problem.empty()) report_error(device_, ref(device_), "pipeline", problem);
    return problem.empty();
  }

  VkResult failure() const { return failure_; }
  void finish() {
    if (feedback_) fill(*feedback_->pPipelineCreationFeedback, start_, stages_ && hits_ == stages_);
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
  const KeptStages given_;
  bool may_compile_;
  const VkPipelineCreationFeedbackCreateInfo* feedback_;
  Clock::time_point start_ = Clock::now();
  std::uint32_t stages_ = 0, hits_ = 0;  ///< that were compiled; in the application's cache
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

/// Compiles the pipeline's own stages and those that it has from libraries, or all from binaries. False after a report.
bool compile_graphics(StageCompiler& compiler, const OwnStages& own, Pipeline& pipeline) {
  for (const OwnStage& stage : own) {
    if (!compiler.given().empty()) break;
    if (!compile_graphics_stage(compiler, *stage.info, stage.index, pipeline)) return false;
  }
  for (const auto& kept : pipeline.library_stages) {
    const auto given =
        std::find_if(own.begin(), own.end(), [&](const OwnStage& s) { return s.info->stage == kept->stage; });
    const std::uint32_t index = given == own.end() ? UINT32_MAX : given->index;
    if (!compile_graphics_stage(compiler, StageInfo(*kept).info(), index, pipeline)) return false;
  }
  return pipeline.vertex != nullptr;
}

/// Keeps a stage, of a module that is named by its identifier alone with the words that `compiled` came from. False if
/// nobody has them.
bool keep(Device& device, const VkPipelineShaderStageCreateInfo& stage, const CompiledShader* compiled,
          KeptStages& out) {
  const std::shared_ptr<KeptStage> kept = keep_stage(stage, device.memory);
  if (kept->words.empty() && compiled && compiled->kept) kept->words = compiled->kept->words;
  out.push_back(kept);
  const bool named = !stage.module && find_in_chain<VkPipelineShaderStageModuleIdentifierCreateInfoEXT>(stage.pNext);
  return !named || !kept->words.empty();
}

/// Keeps the own stages of a library, or of a pipeline that has been compiled. False if nobody has the words of one.
bool keep_own(Device& device, const OwnStages& own, Pipeline& pipeline) {
  for (const OwnStage& stage : own) {
    const std::shared_ptr<const CompiledShader>* compiled = shader_of(pipeline, stage.info->stage);
    if (!keep(device, *stage.info, compiled ? compiled->get() : nullptr, pipeline.library_stages)) return false;
  }
  return true;
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

/// The stages of a library, or those of a whole pipeline, which are compiled; and what binaries of either are made
/// from.
VkResult make_stages(Device& device, StageCompiler& compiler, VkPipelineCreateFlags flags, const OwnStages& own,
                     Pipeline& pipeline) {
  const bool library = flags & VK_PIPELINE_CREATE_LIBRARY_BIT_KHR, captures = captures_binaries(flags);
  const bool given = !compiler.given().empty();
  if (given) {
    std::vector<VkShaderStageFlagBits> stages;
    for (const auto& kept : pipeline.library_stages) stages.push_back(kept->stage);
    for (const OwnStage& stage : own) stages.push_back(stage.info->stage);
    if (!compiler.check_given(stages)) return compiler.failure();
    pipeline.library_stages = compiler.given();
  }
  if (!library && !compile_graphics(compiler, own, pipeline)) return compiler.failure();
  if (!given && (library || captures) && !keep_own(device, own, pipeline)) return VK_PIPELINE_COMPILE_REQUIRED;
  if (captures) pipeline.binary_stages = pipeline.library_stages;
  if (library) return VK_SUCCESS;
  pipeline.library_stages.clear();
  if (pipeline.dynamic.none()) leave_unnamed(pipeline, pipeline.color_writes, pipeline.state);
  return VK_SUCCESS;
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
  const OwnStages own = own_stages(info);
  fill_static_state(*pipeline, info, subpass, parts);
  pipeline->state.unrestricted_depth = device.extensions.test(Extension::EXT_depth_range_unrestricted);
  if (const VkResult result = make_stages(device, compiler, flags, own, *pipeline); result != VK_SUCCESS) return result;
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
  const KeptStages& given = compiler.given();
  if (given.empty())
    pipeline->compute = compiler.compile(info.stage, 0, *pipeline, 0);
  else if (compiler.check_given({VK_SHADER_STAGE_COMPUTE_BIT}))
    pipeline->compute = compiler.compile(StageInfo(*given[0]).info(), 0, *pipeline, 0);
  if (!pipeline->compute) return compiler.failure();
  if (captures_binaries(flags)) {
    pipeline->binary_stages = given;
    if (given.empty() && !keep(device, info.stage, pipeline->compute.get(), pipeline->binary_stages))
      return VK_PIPELINE_COMPILE_REQUIRED;
  }
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
