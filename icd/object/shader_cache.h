// Compiled shaders by what they were compiled from. The device knows all that are alive (a second pipeline from the
// same words costs a look-up); a VkPipelineCache keeps those it saw alive.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "icd/object/descriptors.h"
#include "icd/object/kept_stage.h"
#include "icd/object/shader_module.h"
#include "spirv/compile.h"

namespace vitrine::icd {

/// A shader and what it refers to: immutable samplers belong to the layout.
struct CompiledShader {
  std::unique_ptr<spirv::Shader> shader;
  std::shared_ptr<const PipelineLayoutShape> layout;
  std::uint32_t subgroup_size = 0;                     ///< invocations
  std::vector<spirv::Representation> representations;  ///< of captured shaders alone
  std::uint32_t live_color_outputs = 0xff;
  /// On devices with performance queries or pipeline binaries, and where commands are captured: what it was compiled
  /// from. And the same shader with its blocks counted, made when a query first sees it.
  std::shared_ptr<const KeptStage> kept;
  mutable std::mutex counted_mutex;
  mutable std::unique_ptr<spirv::Shader> counted;
};

/// What one stage of a pipeline is made of.
struct StageRequest {
  const VkPipelineShaderStageCreateInfo* stage = nullptr;
  std::shared_ptr<const PipelineLayoutShape> layout;
  std::uint32_t live_color_outputs = 0xff;
  bool may_compile = true;  ///< false: only what has been compiled before
  bool captured = false;    ///< keeps its internal representations; a shader apart from the same one without
};

/// What becomes of a request.
struct StageResult {
  std::shared_ptr<const CompiledShader> shader;  ///< null: not compiled
  std::string problem;                           ///< why not: invalid or not covered; empty: it may not be compiled
  bool was_in_cache = false;                     ///< in the application's
};

/// The compiled stage, from the device's table or new. `cache` may be null.
StageResult compile_stage(Device& device, PipelineCache* cache, const StageRequest& request);

/// The shader as `profile` counts it; the shader itself where nothing was kept of it.
const spirv::Shader& counted_shader(const CompiledShader& shader, glass::Profile& profile);

}  // namespace vitrine::icd
