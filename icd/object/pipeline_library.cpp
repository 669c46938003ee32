// Pipeline libraries: parts of graphics pipelines, made apart and linked (VK_EXT_graphics_pipeline_library). Shaders
// are compiled when they are linked, because only then the whole pipeline layout is known; that takes a fraction of a
// millisecond, and nothing for shaders that other pipelines already use.
#include "icd/edge/util.h"
#include "icd/object/pipeline.h"
#include "icd/object/shader_module.h"

namespace vitrine::icd {

VkGraphicsPipelineLibraryFlagsEXT own_parts(const VkGraphicsPipelineCreateInfo& info) {
  if (const auto* parts = find_in_chain<VkGraphicsPipelineLibraryCreateInfoEXT>(info.pNext)) return parts->flags;
  const auto* libraries = find_in_chain<VkPipelineLibraryCreateInfoKHR>(info.pNext);
  const bool links = libraries && libraries->libraryCount;
  return links || (create_flags(info) & VK_PIPELINE_CREATE_LIBRARY_BIT_KHR) ? 0 : kAllPipelineParts;
}

std::vector<OwnStage> own_stages(const VkGraphicsPipelineCreateInfo& info) {
  const VkGraphicsPipelineLibraryFlagsEXT parts = own_parts(info);
  VkShaderStageFlags wanted = 0;
  if (parts & VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT) {
    wanted |= VK_SHADER_STAGE_ALL_GRAPHICS & ~VK_SHADER_STAGE_FRAGMENT_BIT;
  }
  if (parts & VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT) wanted |= VK_SHADER_STAGE_FRAGMENT_BIT;
  std::vector<OwnStage> own;
  for (std::uint32_t i = 0; wanted && i < info.stageCount; ++i) {
    if (info.pStages[i].stage & wanted) own.push_back({&info.pStages[i], i});
  }
  return own;
}

void link_library(Pipeline& pipeline, const Pipeline& library) {
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(DynamicState::kCount); ++i) {
    const auto state = static_cast<DynamicState>(i);
    if (part_of(state) & library.parts) copy_state(library.state, state, pipeline.state);
  }
  pipeline.dynamic |= library.dynamic;
  if (library.parts & VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT) pipeline.streams = library.streams;
  if (library.parts & VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT) {
    pipeline.clip_follows_clamp = library.clip_follows_clamp;
    pipeline.state.discard_count = library.state.discard_count;
    pipeline.state.discard_inside = library.state.discard_inside;
  }
  if (library.parts & VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT) {
    pipeline.color_writes = library.color_writes;
    pipeline.live_colors = library.live_colors;
    pipeline.locations = library.locations;
    pipeline.has_depth = library.has_depth;
    pipeline.has_stencil = library.has_stencil;
  }
  pipeline.captured |= library.captured;
  pipeline.state.ordered_attachment_access |= library.state.ordered_attachment_access;
  // The two parts that have the multisample state agree on it where both have it.
  if (library.state.sample_shading) {
    pipeline.state.sample_shading = true;
    pipeline.state.min_sample_shading = library.state.min_sample_shading;
  }
  if (!pipeline.layout) pipeline.layout = library.layout;
  pipeline.library_stages.insert(pipeline.library_stages.end(), library.library_stages.begin(),
                                 library.library_stages.end());
  pipeline.parts |= library.parts;
}

}  // namespace vitrine::icd
