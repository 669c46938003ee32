// VkShaderEXT: a stage by itself (Vulkan 1.4.309, Shaders: Shader Objects), and the pipelines that stand for several
// which draws use together. Stages are compiled one by one in any case (icd/object/shader_cache.h), and what passes
// between them is matched when a draw is planned: linking compiles nothing, but for fragment shaders of which not every
// color output reaches an attachment.
#pragma once

#include "icd/object/pipeline.h"
#include "icd/object/shader_links.h"

#ifdef VK_EXT_shader_object
namespace vitrine::icd {

/// Immutable after creation but for its links.
struct ShaderObject : Object<VkShaderEXT, VK_OBJECT_TYPE_SHADER_EXT> {
  ShaderObject(const HostMemory& m, Device& owner) : Object(m), device(owner), source(m), links(m) {}
  /// Its links end, too: nothing that is still to run uses it.
  ~ShaderObject();

  static std::uint64_t next_number();

  Device& device;
  const std::uint64_t number = next_number();  ///< of all that this process made, counted from 1
  KeptStage source;
  std::shared_ptr<const PipelineLayoutShape> layout;
  std::shared_ptr<const CompiledShader> shader;  ///< with all color outputs that there can be
  std::uint32_t color_outputs = 0;               ///< those that it has, of a fragment shader: bit i = location i
  std::shared_ptr<const Pipeline> compute;       ///< of a compute shader: what dispatches use
  Vector<ShaderLink*> links;                     ///< that it is part of; guarded by ShaderLinks::mutex
};

/// Shader objects that were used together.
struct ShaderLink {
  explicit ShaderLink(const HostMemory& m) : pipeline(m) {}
  LinkKey key{};
  std::array<ShaderObject*, kGraphicsStages> stages{};
  Pipeline pipeline;
};

/// By stage, null: none.
using BoundStages = std::array<ShaderObject*, kGraphicsStages>;

/// Where a stage stands in BoundStages; kGraphicsStages: compute shaders; more: not supported.
std::size_t stage_index(VkShaderStageFlagBits stage);

/// What identifies a link: `live_outputs` are the locations whose color outputs matter.
LinkKey link_key(const BoundStages& stages, std::uint32_t live_outputs, const ColorLocations& locations);

/// The pipeline that stands for them, valid while all of them are; null if they draw nothing: without a vertex shader,
/// or with half of a tessellation. Throws std::bad_alloc.
const Pipeline* link_stages(Device& device, const BoundStages& stages, const LinkKey& key,
                            const ColorLocations& locations);

/// The pipeline of a compute shader that has been compiled.
std::shared_ptr<const Pipeline> make_compute_pipeline(const ShaderObject& shader);

}  // namespace vitrine::icd
#endif
