// A render pass instance (one subpass, or one dynamic rendering scope) being drawn: takes clears and draws in order,
// bins them, and writes attachments when flushed. design.md section 3.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>

#include "raster/draw.h"
#include "raster/pass_desc.h"

namespace vitrine::raster {

class Pass {
 public:
  explicit Pass(const PassDesc& desc);
  ~Pass();  ///< flushes, unless an exception has left draw() or flush(): what they had begun is dropped then
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;

  /// Load-op clears and vkCmdClearAttachments: encodes the value once (lavapipe-rasterization.md 11.1) and fills `rect`
  /// (clipped to the attachment) of layers [base_layer, base_layer + layer_count), in order with draws.
  void clear_color(std::uint32_t attachment, const VkClearColorValue& value, const VkRect2D& rect,
                   std::uint32_t base_layer, std::uint32_t layer_count);
  void clear_depth_stencil(VkImageAspectFlags aspects, const VkClearDepthStencilValue& value, const VkRect2D& rect,
                           std::uint32_t base_layer, std::uint32_t layer_count);

  /// Takes the draw: runs its front end now or later, bins its primitives; fragments are shaded at the latest in
  /// flush().
  void draw(const DrawCall& draw);

  /// Everything recorded so far has reached memory, and query counters are final.
  void flush();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vitrine::raster
