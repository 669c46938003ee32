// See dependencies.h.
#include "icd/record/dependencies.h"

#include "icd/object/image.h"
#include "icd/object/memory.h"

namespace vitrine::icd {
namespace {

template <class Barrier>
RecordedBarrier with_masks(const Barrier& b) {
  return {b.srcStageMask, b.dstStageMask, b.srcAccessMask, b.dstAccessMask, nullptr, 0, 0, nullptr, {}, {}, {}};
}

template <class Barrier>
RecordedBarrier with_masks(const Barrier& b, const OldBarriers& all) {
  return {all.first_stages, all.second_stages, b.srcAccessMask, b.dstAccessMask, nullptr, 0, 0, nullptr, {}, {}, {}};
}

template <class Barrier>
RecordedBarrier of_buffer(RecordedBarrier out, const Barrier& b) {
  out.buffer = &from_handle<Buffer>(b.buffer);
  out.offset = b.offset;
  out.size = b.size;
  return out;
}

template <class Barrier>
RecordedBarrier of_image(RecordedBarrier out, const Barrier& b) {
  out.image = &from_handle<Image>(b.image);
  out.range = b.subresourceRange;
  out.from = b.oldLayout;
  out.to = b.newLayout;
  return out;
}

void record_all(VkCommandBuffer buffer, DependencyKind kind, std::span<const VkEvent> events,
                std::span<const RecordedBarrier> barriers) {
  CmdDependency command{};
  command.kind = kind;
  command.events = copy_array(buffer, events.data(), events.size());
  command.barriers = copy_array(buffer, barriers.data(), barriers.size());
  record(buffer, command);
}

}  // namespace

void record_layouts(VkCommandBuffer buffer, std::span<const UsedLayout> used) {
  record(buffer, CmdUsedLayouts{copy_array(buffer, used.data(), used.size())});
}

void record_dependency(VkCommandBuffer buffer, DependencyKind kind, std::span<const VkEvent> events,
                       std::span<const VkDependencyInfo> infos) {
  if (!glass::sync::is_on()) return;
  std::vector<RecordedBarrier> barriers;
  for (const VkDependencyInfo& info : infos) {
    for (const auto& b : std::span(info.pMemoryBarriers, info.memoryBarrierCount)) barriers.push_back(with_masks(b));
    for (const auto& b : std::span(info.pBufferMemoryBarriers, info.bufferMemoryBarrierCount))
      barriers.push_back(of_buffer(with_masks(b), b));
    for (const auto& b : std::span(info.pImageMemoryBarriers, info.imageMemoryBarrierCount))
      barriers.push_back(of_image(with_masks(b), b));
  }
  record_all(buffer, kind, events, barriers);
}

void record_dependency(VkCommandBuffer buffer, DependencyKind kind, std::span<const VkEvent> events,
                       const OldBarriers& all) {
  if (!glass::sync::is_on()) return;
  std::vector<RecordedBarrier> barriers;
  // Without any it is an execution dependency.
  barriers.push_back(with_masks(VkMemoryBarrier{}, all));
  for (const VkMemoryBarrier& b : all.memory) barriers.push_back(with_masks(b, all));
  for (const VkBufferMemoryBarrier& b : all.buffers) barriers.push_back(of_buffer(with_masks(b, all), b));
  for (const VkImageMemoryBarrier& b : all.images) barriers.push_back(of_image(with_masks(b, all), b));
  record_all(buffer, kind, events, barriers);
}

}  // namespace vitrine::icd
