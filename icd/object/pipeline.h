// VkPipeline: compiled stages and the fixed-function state that does not change.
#pragma once

#include "icd/edge/diagnostics.h"
#include "icd/object/color_locations.h"
#include "icd/object/descriptors.h"
#include "icd/object/kept_stage.h"
#include "icd/object/shader_cache.h"
#include "icd/object/shader_links.h"
#include "icd/record/dynamic_state.h"
#include "raster/draw.h"

namespace vitrine::icd {

inline constexpr VkGraphicsPipelineLibraryFlagsEXT kAllPipelineParts =
    VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT |
    VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT |
    VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT |
    VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT;

/// Immutable after creation, but for binary_stages.
struct Pipeline : Object<VkPipeline, VK_OBJECT_TYPE_PIPELINE> {
  explicit Pipeline(const HostMemory& m) : Object(m), library_stages(m), binary_stages(m) {}

  static std::uint64_t next_number();

  const std::uint64_t number = next_number();  ///< of all that this process made, counted from 1
  VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
  bool captured = false;  ///< its shaders, and those of pipelines that link it, keep their internal representations
  std::shared_ptr<const PipelineLayoutShape> layout;
  // graphics
  std::shared_ptr<const CompiledShader> vertex;
  std::shared_ptr<const CompiledShader> control, evaluation, geometry;  ///< may be null
  std::shared_ptr<const CompiledShader> fragment;                       ///< may be null
  raster::State state;
  DynamicStates dynamic;
  ColorWrites color_writes = kAllColorWrites;
  bool clip_follows_clamp = true;  ///< depth clipping is off where depth clamping is on
  VertexStreams streams{};
  std::uint32_t live_colors = 0;              ///< bit i: there is a colour attachment i
  bool has_depth = true, has_stencil = true;  ///< of dynamic rendering, whether their formats are named
  ColorLocations locations;                   ///< of dynamic rendering's
  /// Of a library: the parts that it has, and its stages, not yet compiled.
  VkGraphicsPipelineLibraryFlagsEXT parts = 0;
  KeptStages library_stages;
  /// Without rasterization for good: there is no fragment stage.
  bool never_rasterizes() const {
    return state.rasterizer_discard && !dynamic.test(DynamicState::kRasterizerDiscardEnable);
  }
  // compute
  std::shared_ptr<const CompiledShader> compute;
  /// What its binaries are made from (icd/object/pipeline_binary.h), until the application releases it.
  KeptStages binary_stages;
  /// Where it is none of the application's, but stands for shader objects: those, the first ones of the array.
  std::array<ObjectRef, kGraphicsStages> shader_objects{};
};

/// The flags of a create info, or those that its chain puts in their place (Vulkan 1.4.309,
/// VkPipelineCreateFlags2CreateInfo). There are none here beyond the first 32.
VkPipelineCreateFlags create_flags(const VkGraphicsPipelineCreateInfo& info);
VkPipelineCreateFlags create_flags(const VkComputePipelineCreateInfo& info);

/// The pipeline, or the shader objects that it stands for; null behind the last.
std::array<ObjectRef, kGraphicsStages> objects_of(const Pipeline& pipeline);

/// "tessellation control", ...
const char* stage_name(VkShaderStageFlagBits stage);

/// What VkDepthBiasRepresentationInfoEXT in a chain says.
raster::DepthBiasUnit depth_bias_unit(const void* chain);

struct Subpass;

/// Fills the state of `parts` from the create info; `subpass` tells which attachments there are.
void fill_static_state(Pipeline& pipeline, const VkGraphicsPipelineCreateInfo& info, const Subpass& subpass,
                       VkGraphicsPipelineLibraryFlagsEXT parts);

/// Lets state that is complete leave alone what the pipeline names no format for, though it may be there to be drawn to
/// (Vulkan 1.4.309, VK_EXT_dynamic_rendering_unused_attachments). `writes`: by colour attachment.
void leave_unnamed(const Pipeline& pipeline, ColorWrites writes, raster::State& state);

/// The parts that a create info itself has: all, unless it makes or links libraries.
VkGraphicsPipelineLibraryFlagsEXT own_parts(const VkGraphicsPipelineCreateInfo& info);

/// A stage that a create info gives, and where it stands in pStages.
struct OwnStage {
  const VkPipelineShaderStageCreateInfo* info;
  std::uint32_t index;
};
using OwnStages = std::vector<OwnStage>;
/// Those of the parts that a create info itself has: others are ignored.
OwnStages own_stages(const VkGraphicsPipelineCreateInfo& info);

/// Takes over the parts and stages of a library.
void link_library(Pipeline& pipeline, const Pipeline& library);

}  // namespace vitrine::icd
