// Recording dynamic state (Vulkan 1.3.239, Pipelines: Dynamic State, and the commands of the fixed-function chapters).
#include "icd/command_buffer.h"
#include "icd/entry_points.h"

namespace vitrine::icd::entry {

VKAPI_ATTR void VKAPI_CALL CmdSetViewport(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                          const VkViewport* viewports) {
  record(buffer, icd::CmdSetViewport{first, copy_array(buffer, viewports, count)});
}

VKAPI_ATTR void VKAPI_CALL CmdSetScissor(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                         const VkRect2D* scissors) {
  record(buffer, icd::CmdSetScissor{first, copy_array(buffer, scissors, count)});
}

VKAPI_ATTR void VKAPI_CALL CmdSetLineWidth(VkCommandBuffer buffer, float width) {
  record(buffer, icd::CmdSetLineWidth{width});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBias(VkCommandBuffer buffer, float constant, float clamp, float slope) {
  record(buffer, icd::CmdSetDepthBias{constant, clamp, slope});
}

VKAPI_ATTR void VKAPI_CALL CmdSetBlendConstants(VkCommandBuffer buffer, const float constants[4]) {
  record(buffer, icd::CmdSetBlendConstants{{constants[0], constants[1], constants[2], constants[3]}});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBounds(VkCommandBuffer buffer, float min, float max) {
  record(buffer, icd::CmdSetDepthBounds{min, max});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilCompareMask(VkCommandBuffer buffer, VkStencilFaceFlags faces,
                                                    std::uint32_t mask) {
  record(buffer, icd::CmdSetStencil{StencilValue::kCompareMask, faces, mask});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilWriteMask(VkCommandBuffer buffer, VkStencilFaceFlags faces,
                                                  std::uint32_t mask) {
  record(buffer, icd::CmdSetStencil{StencilValue::kWriteMask, faces, mask});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilReference(VkCommandBuffer buffer, VkStencilFaceFlags faces,
                                                  std::uint32_t reference) {
  record(buffer, icd::CmdSetStencil{StencilValue::kReference, faces, reference});
}

}  // namespace vitrine::icd::entry
