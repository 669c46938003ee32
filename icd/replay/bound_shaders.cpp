// Replay of what binds shader objects, and how they become the pipeline that draws and dispatches use (Vulkan 1.4.309,
// Shaders: Binding Shader Objects).
#include "icd/object/shader_object.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {

#ifdef VK_EXT_shader_object
namespace {

/// Locations of the color outputs that matter: as a pipeline has them that knows its attachments and its state.
std::uint32_t live_outputs(const ReplayState& state) {
  const bool decides = state.dynamic.state.alpha_to_coverage;
  return located(state.shaders.locations, state.scope.live_colors) | (decides ? 1u : 0u);
}

}  // namespace

void link_shaders(ReplayState& state) {
  BoundShaders& bound = state.shaders;
  if (!bound.any || !(state.dirty & (kDirtyShaders | kDirtyState))) return;
  state.dirty &= ~kDirtyShaders;
  const LinkKey key = link_key(bound.stages, live_outputs(state), bound.locations);
  if (state.graphics.pipeline && key == bound.key) return;
  bound.key = key;
  state.graphics.pipeline = link_stages(state.device, bound.stages, key, bound.locations);
  state.dirty |= kDirtyState | kDirtyDescriptors | kDirtyVertexBuffers;
}

/// "any pipelines that had previously been bound to those pipeline bind points are no longer bound".
void execute(ReplayState& state, const CmdBindShaders& command) {
  constexpr std::uint32_t kCompute = 1u << kGraphicsStages;
  if (command.bound & kCompute) {
    const ShaderObject* shader = command.stages[kGraphicsStages];
    state.compute.pipeline = shader ? shader->compute.get() : nullptr;
  }
  if (!(command.bound & (kCompute - 1))) return;
  if (!state.shaders.any) state.graphics.pipeline = nullptr;
  state.shaders.any = true;
  for (std::size_t i = 0; i < kGraphicsStages; ++i)
    if (command.bound >> i & 1) state.shaders.stages[i] = command.stages[i];
  state.dirty |= kDirtyShaders;
}

void execute(ReplayState& state, const CmdSetColorLocations& command) {
  state.shaders.locations = command.locations;
  state.dirty |= kDirtyShaders;
}
#else
void link_shaders(ReplayState&) {}
#endif

}  // namespace vitrine::icd
