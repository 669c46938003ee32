// Recording clears (Vulkan 1.3.239, Clear Commands).
#include "icd/entry_points.h"
#include "icd/object/image.h"
#include "icd/record/command_buffer.h"
#include "icd/record/dependencies.h"

namespace vitrine::icd {
namespace {

constexpr std::uint64_t kBytesPerNanosecond = 8;

void add_cost(VkCommandBuffer buffer, const Image& image) {
  from_handle<CommandBuffer>(buffer).cost += 300 + image.layout.size / kBytesPerNanosecond;
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdClearColorImage(VkCommandBuffer buffer, VkImage image, VkImageLayout layout,
                                              const VkClearColorValue* value, std::uint32_t count,
                                              const VkImageSubresourceRange* ranges) {
  const Image& i = from_handle<Image>(image);
  record(buffer, icd::CmdClearColorImage{&i, *value, copy_array(buffer, ranges, count)});
  record_layouts(buffer, i, layout, {ranges, count});
  add_cost(buffer, i);
}

VKAPI_ATTR void VKAPI_CALL CmdClearDepthStencilImage(VkCommandBuffer buffer, VkImage image, VkImageLayout layout,
                                                     const VkClearDepthStencilValue* value, std::uint32_t count,
                                                     const VkImageSubresourceRange* ranges) {
  const Image& i = from_handle<Image>(image);
  record(buffer, icd::CmdClearDepthStencilImage{&i, *value, copy_array(buffer, ranges, count)});
  record_layouts(buffer, i, layout, {ranges, count});
  add_cost(buffer, i);
}

VKAPI_ATTR void VKAPI_CALL CmdClearAttachments(VkCommandBuffer buffer, std::uint32_t attachment_count,
                                               const VkClearAttachment* attachments, std::uint32_t rect_count,
                                               const VkClearRect* rects) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdClearAttachments{b.arena.copy_array(attachments, attachment_count),
                                     b.arena.copy_array(rects, rect_count)});
  b.cost += b.pass_pixels / kBytesPerNanosecond;
}

}  // namespace entry
}  // namespace vitrine::icd
