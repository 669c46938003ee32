// VkPipeline: compiled stages and the fixed-function state that does not change.
#pragma once

#include "icd/descriptors.h"
#include "icd/shader_cache.h"
#include "raster/draw.h"

namespace vitrine::icd {

/// State that a pipeline leaves to commands, one bit each.
enum DynamicStateBit : std::uint32_t {
  kDynamicViewport = 1u << 0,
  kDynamicScissor = 1u << 1,
  kDynamicLineWidth = 1u << 2,
  kDynamicDepthBias = 1u << 3,
  kDynamicBlendConstants = 1u << 4,
  kDynamicDepthBounds = 1u << 5,
  kDynamicStencilCompareMask = 1u << 6,
  kDynamicStencilWriteMask = 1u << 7,
  kDynamicStencilReference = 1u << 8,
};

struct VertexStream {
  std::uint32_t stride = 0;
  std::uint32_t divisor = 1;
  bool per_instance = false;
  bool used = false;
};

/// Immutable after creation.
struct Pipeline : Object<VkPipeline, VK_OBJECT_TYPE_PIPELINE> {
  using Object::Object;

  VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
  std::shared_ptr<const PipelineLayoutShape> layout;
  // graphics
  std::shared_ptr<const CompiledShader> vertex;
  std::shared_ptr<const CompiledShader> fragment;  ///< may be null
  raster::State state;
  std::uint32_t dynamic = 0;  ///< DynamicStateBit
  std::array<VertexStream, raster::kMaxVertexBindings> streams{};
  // compute
  std::shared_ptr<const CompiledShader> compute;
};

struct Subpass;

/// Fills `state`, `dynamic` and `streams` from the create info; `subpass` tells which attachments there are.
void fill_static_state(Pipeline& pipeline, const VkGraphicsPipelineCreateInfo& info, const Subpass& subpass);

}  // namespace vitrine::icd
