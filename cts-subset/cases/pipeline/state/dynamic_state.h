// State of a pipeline that is left to commands.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/graphics.h"

namespace vitrine::cts {

/// Whether both devices claim a feature: what a case does must not depend on the device.
template <class Feature>
bool both(Feature claimed) {
  return claimed(gpus().device.extension_features) && claimed(gpus().reference.extension_features);
}

/// A pipeline like another one of which a random part of the state is left to commands. What the pipeline itself says
/// of that part is wrong, so that a command without effect shows. Only state that both devices can leave to commands
/// is.
class DynamicState {
 public:
  /// `share` of the state, 0 .. 1, is left. `right` is the whole state, for one vertex buffer; what it points to must
  /// outlive this object, but the structures behind pNext of the pipeline's own that are named below.
  DynamicState(Run& run, Random& random, float share, const GraphicsSpec& right, VkSampleCountFlagBits samples,
               uint32_t colors);
  DynamicState(const DynamicState&) = delete;

  const GraphicsSpec& spec() const { return spec_; }  ///< of the pipeline
  /// Sets what the pipeline does not, and binds the vertex buffer.
  void set(VkCommandBuffer cmd, const Buffer& vertices) const;
  /// The numbers of the dynamic states, for a note.
  std::string text() const;

 private:
  using Set = std::function<void(VkCommandBuffer)>;
  bool takes(VkDynamicState state, bool available);
  void leave(VkDynamicState state, bool available, const std::function<void()>& spoil, Set set);
  template <class Command, class Value>
  void leave_value(VkDynamicState state, bool available, const std::function<void()>& spoil, Command command,
                   Value value) {
    leave(state, available, spoil, [command, value](VkCommandBuffer cmd) { command(cmd, value); });
  }
  const void* copy_chain(const void* next);
  void leave_assembly();
  void leave_viewports();
  void leave_rasterization();
  void leave_lines();
  void leave_depth();
  void leave_stencil();
  void leave_multisample(VkSampleCountFlagBits samples);
  void leave_blending(uint32_t colors);
  void leave_vertex_input();

  Run& run_;
  Random& random_;
  float share_;
  const GraphicsSpec right_;
  GraphicsSpec spec_;
  std::vector<Set> commands_;
  bool binds_with_stride_ = false;
  /// Copies of what pNext chains of `spec_` name; null: not in a chain.
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking_storage_{};
  VkPipelineRasterizationLineStateCreateInfoEXT line_storage_{};
  VkPipelineRasterizationDepthClipStateCreateInfoEXT clip_storage_{};
  VkPipelineViewportDepthClipControlCreateInfoEXT control_storage_{};
  VkPipelineColorWriteCreateInfoEXT writes_storage_{};
  VkPipelineTessellationDomainOriginStateCreateInfo origin_storage_{};
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT* provoking_ = nullptr;
  VkPipelineRasterizationLineStateCreateInfoEXT* line_ = nullptr;
  VkPipelineRasterizationDepthClipStateCreateInfoEXT* clip_ = nullptr;
  VkPipelineViewportDepthClipControlCreateInfoEXT* control_ = nullptr;
  VkPipelineColorWriteCreateInfoEXT* writes_ = nullptr;
  VkPipelineTessellationDomainOriginStateCreateInfo* origin_ = nullptr;
  VkSampleMask spoiled_mask_ = 0;
};

}  // namespace vitrine::cts
