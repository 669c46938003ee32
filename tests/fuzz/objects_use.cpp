// What objects are used for: descriptors, commands, submissions.
#include <algorithm>

#include "tests/fuzz/objects.h"

#define VK_CALL(name) VK_GET(d_.instance, name)

namespace vitrine::fuzz {

using icd::make_struct;

namespace {

constexpr VkImageSubresourceLayers kLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
constexpr VkImageSubresourceRange kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
constexpr std::uint32_t kSide = 16;

}  // namespace

void Objects::update_set() {
  const Ref set = living(Kind::kSet);
  if (set) write(set, c_.below(kBindings));
}

void Objects::write(const Ref& set, std::uint32_t binding) {
  if (!usable(set->layout)) return;
  constexpr Kind kKinds[] = {Kind::kBuffer, Kind::kImageView, Kind::kImageView, Kind::kBufferView};
  constexpr VkDescriptorType kTypes[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                         VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER};
  const Ref thing = need(kKinds[binding]);
  const bool has_sampler = binding == 1, immutable = !set->layout->of.empty();
  const Ref sampler = has_sampler && !immutable ? need(Kind::kSampler) : nullptr;
  if (!thing || (has_sampler && !immutable && !sampler)) return;
  free_of_use(set);
  changed(set);
  set->of[binding] = thing;
  if (sampler) set->of[kBindings] = sampler;
  const VkDescriptorBufferInfo of_buffer{binding == 0 ? as<VkBuffer>(thing) : VK_NULL_HANDLE, 0, VK_WHOLE_SIZE};
  const VkDescriptorImageInfo of_image{as<VkSampler>(sampler),
                                       binding == 1 || binding == 2 ? as<VkImageView>(thing) : VK_NULL_HANDLE,
                                       VK_IMAGE_LAYOUT_GENERAL};
  const VkBufferView texels = binding == 3 ? as<VkBufferView>(thing) : VK_NULL_HANDLE;
  if (const Ref made_for = some(Kind::kTemplate, set->agreed); binding == 0 && made_for && c_.one_in(2)) {
    VK_CALL(UpdateDescriptorSetWithTemplate)
    (d_.device, as<VkDescriptorSet>(set), as<VkDescriptorUpdateTemplate>(made_for), &of_buffer);
    return;
  }
  auto write = make_struct<VkWriteDescriptorSet>();
  write.dstSet = as<VkDescriptorSet>(set);
  write.dstBinding = binding;
  write.descriptorCount = 1;
  write.descriptorType = kTypes[binding];
  write.pBufferInfo = &of_buffer;
  write.pImageInfo = &of_image;
  write.pTexelBufferView = &texels;
  VK_CALL(UpdateDescriptorSets)(d_.device, 1, &write, 0, nullptr);
}

void Objects::reset_something() {
  switch (c_.below(5)) {
    case 0:
      if (const Ref pool = some(Kind::kDescriptorPool)) {
        free_of_use(pool);
        VK_CALL(ResetDescriptorPool)(d_.device, as<VkDescriptorPool>(pool), 0);
        end_children(pool);
      }
      break;
    case 1:
      if (const Ref pool = some(Kind::kCommandPool)) {
        free_of_use(pool);
        VK_CALL(ResetCommandPool)
        (d_.device, as<VkCommandPool>(pool), c_.one_in(2) ? VK_COMMAND_POOL_RESET_RELEASE_RESOURCES_BIT : 0);
        for (const Ref& commands : things_) {
          if (commands->pool != pool) continue;
          changed(commands);
          commands->ready = false;
          commands->of.clear();
        }
      }
      break;
    case 2:
      if (const Ref event = some(Kind::kEvent)) {
        free_of_use(event);
        VK_CALL(SetEvent)(d_.device, as<VkEvent>(event));
        if (c_.one_in(2)) VK_CALL(ResetEvent)(d_.device, as<VkEvent>(event));
      }
      break;
    case 3:
      if (const Ref pool = some(Kind::kCommandPool)) VK_CALL(TrimCommandPool)(d_.device, as<VkCommandPool>(pool), 0);
      break;
    default:
      finish();
  }
}

void Objects::record() {
  const bool secondary = c_.one_in(3);
  const Kind kind = secondary ? Kind::kSecondary : Kind::kCommands;
  if (!living(kind)) make_of(kind);
  const Ref thing = living(kind);
  if (!thing) return;
  free_of_use(thing);
  changed(thing);
  const auto commands = as<VkCommandBuffer>(thing);
  if (c_.one_in(4)) VK_CALL(ResetCommandBuffer)(commands, 0);
  thing->ready = false;
  thing->of.clear();
  const auto inheritance = make_struct<VkCommandBufferInheritanceInfo>();
  auto begin = make_struct<VkCommandBufferBeginInfo>();
  begin.flags = VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT;
  if (secondary) begin.pInheritanceInfo = &inheritance;
  demand(VK_CALL(BeginCommandBuffer)(commands, &begin) == VK_SUCCESS, "the begin of a command buffer");
  std::vector<Ref> used;
  for (std::uint32_t i = c_.between(1, 6); i-- != 0;) record_command(commands, used, secondary);
  // Given up half way: it can be recorded again, reset or freed.
  if (c_.one_in(9)) return;
  demand(VK_CALL(EndCommandBuffer)(commands) == VK_SUCCESS, "the end of a command buffer");
  thing->of = std::move(used);
  thing->ready = true;
}

void Objects::record_command(VkCommandBuffer commands, std::vector<Ref>& used, bool secondary) {
  switch (c_.below(secondary ? 5 : 8)) {
    case 0:
    case 1:
      compute(commands, used);
      break;
    case 2:
      transfer(commands, used);
      break;
    case 3:
      query(commands, used);
      break;
    case 4:
      wait_for_event(commands, used);
      break;
    case 5:
      if (const Ref other = some(Kind::kSecondary); other && other->ready) {
        const auto handle = as<VkCommandBuffer>(other);
        VK_CALL(CmdExecuteCommands)(commands, 1, &handle);
        used.push_back(other);
      }
      break;
    default:
      render(commands, used);
  }
}

void Objects::to_general(VkCommandBuffer commands, const Ref& image) {
  auto barrier = make_struct<VkImageMemoryBarrier>();
  barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = as<VkImage>(image);
  barrier.subresourceRange = kWhole;
  VK_CALL(CmdPipelineBarrier)
  (commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
   &barrier);
}

bool Objects::bind(VkCommandBuffer commands, std::vector<Ref>& used, Kind kind, VkPipelineBindPoint point) {
  const Ref pipeline = need(kind);
  if (!pipeline) return false;
  const Ref layout = need(Kind::kPipelineLayout, pipeline->agreed), set = need(Kind::kSet, pipeline->agreed);
  if (!layout || !set) return false;
  for (const std::size_t binding : {1, 2}) to_general(commands, set->of[binding]->of[0]);
  const auto handle = as<VkDescriptorSet>(set);
  VK_CALL(CmdBindDescriptorSets)(commands, point, as<VkPipelineLayout>(layout), 0, 1, &handle, 0, nullptr);
  VK_CALL(CmdBindPipeline)(commands, point, as<VkPipeline>(pipeline));
  // Layouts must live until the end of the recording alone.
  used.insert(used.end(), {pipeline, set});
  return true;
}

void Objects::compute(VkCommandBuffer commands, std::vector<Ref>& used) {
  if (bind(commands, used, Kind::kComputePipeline, VK_PIPELINE_BIND_POINT_COMPUTE))
    VK_CALL(CmdDispatch)(commands, c_.between(1, 3), 1, 1);
}

void Objects::render(VkCommandBuffer commands, std::vector<Ref>& used) {
  const Ref pass = need(Kind::kRenderPass), framebuffer = need(Kind::kFramebuffer);
  if (!pass || !framebuffer) return;
  const bool draws = bind(commands, used, Kind::kGraphicsPipeline, VK_PIPELINE_BIND_POINT_GRAPHICS);
  const VkClearValue clear{};
  auto info = make_struct<VkRenderPassBeginInfo>();
  info.renderPass = as<VkRenderPass>(pass);
  info.framebuffer = as<VkFramebuffer>(framebuffer);
  info.renderArea.extent = {kSide, kSide};
  info.clearValueCount = 1;
  info.pClearValues = &clear;
  used.insert(used.end(), {pass, framebuffer});
  VK_CALL(CmdBeginRenderPass)(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  if (draws) VK_CALL(CmdDraw)(commands, 3, c_.between(1, 3), 0, 0);
  VK_CALL(CmdEndRenderPass)(commands);
}

void Objects::transfer(VkCommandBuffer commands, std::vector<Ref>& used) {
  const Ref buffer = some(Kind::kBuffer), image = need(Kind::kImage);
  if (buffer && c_.one_in(3)) {
    VK_CALL(CmdFillBuffer)(commands, as<VkBuffer>(buffer), 0, VK_WHOLE_SIZE, c_.hostile());
    used.push_back(buffer);
    return;
  }
  if (!image) return;
  to_general(commands, image);
  used.push_back(image);
  VkBufferImageCopy region{};
  region.imageSubresource = kLayer;
  region.imageExtent = {kSide, kSide, 1};
  const VkClearColorValue colour{};
  // Copies between what overlaps in memory are not valid.
  if (!buffer || buffer->of[0] == image->of[0]) {
    VK_CALL(CmdClearColorImage)(commands, as<VkImage>(image), VK_IMAGE_LAYOUT_GENERAL, &colour, 1, &kWhole);
    return;
  }
  used.push_back(buffer);
  if (c_.one_in(2)) VK_CALL(CmdCopyImageToBuffer)
  (commands, as<VkImage>(image), VK_IMAGE_LAYOUT_GENERAL, as<VkBuffer>(buffer), 1, &region);
  else VK_CALL(CmdCopyBufferToImage)(commands, as<VkBuffer>(buffer), as<VkImage>(image), VK_IMAGE_LAYOUT_GENERAL, 1,
                                     &region);
}

void Objects::query(VkCommandBuffer commands, std::vector<Ref>& used) {
  const Ref pool = need(Kind::kQueryPool), buffer = some(Kind::kBuffer);
  if (!pool) return;
  const auto handle = as<VkQueryPool>(pool);
  used.push_back(pool);
  VK_CALL(CmdResetQueryPool)(commands, handle, 0, 1);
  if (pool->agreed == VK_QUERY_TYPE_TIMESTAMP) {
    VK_CALL(CmdWriteTimestamp)(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, handle, 0);
  } else {
    VK_CALL(CmdBeginQuery)(commands, handle, 0, 0);
    VK_CALL(CmdEndQuery)(commands, handle, 0);
  }
  if (!buffer) return;
  VK_CALL(CmdCopyQueryPoolResults)(commands, handle, 0, 1, as<VkBuffer>(buffer), 0, 8, VK_QUERY_RESULT_64_BIT);
  used.push_back(buffer);
}

void Objects::wait_for_event(VkCommandBuffer commands, std::vector<Ref>& used) {
  const Ref event = need(Kind::kEvent);
  if (!event) return;
  const auto handle = as<VkEvent>(event);
  VK_CALL(CmdSetEvent)(commands, handle, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
  VK_CALL(CmdWaitEvents)
  (commands, 1, &handle, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, nullptr, 0, nullptr,
   0, nullptr);
  used.push_back(event);
}

void Objects::submit() {
  const Ref commands = some(Kind::kCommands);
  if (!commands || !commands->ready) return;
  Ref waits_for = c_.one_in(2) ? some(Kind::kSemaphore) : nullptr;
  Ref signals = c_.one_in(2) ? some(Kind::kSemaphore) : nullptr;
  if (waits_for && !waits_for->ready) waits_for = nullptr;
  if (signals && signals->ready) signals = nullptr;
  const Ref fence = c_.one_in(2) ? some(Kind::kFence) : nullptr;
  if (fence && fence->ready) {
    free_of_use(fence);
    const auto handle = as<VkFence>(fence);
    demand(VK_CALL(GetFenceStatus)(d_.device, handle) == VK_SUCCESS, "a signalled fence");
    VK_CALL(ResetFences)(d_.device, 1, &handle);
  }
  const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  const auto handle = as<VkCommandBuffer>(commands);
  const auto first = as<VkSemaphore>(waits_for), then = as<VkSemaphore>(signals);
  auto info = make_struct<VkSubmitInfo>();
  info.waitSemaphoreCount = waits_for ? 1 : 0;
  info.pWaitSemaphores = &first;
  info.pWaitDstStageMask = &stages;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &handle;
  info.signalSemaphoreCount = signals ? 1 : 0;
  info.pSignalSemaphores = &then;
  demand(VK_CALL(QueueSubmit)(d_.queue, 1, &info, as<VkFence>(fence)) == VK_SUCCESS, "a submission");
  if (waits_for) waits_for->ready = false;
  if (signals) signals->ready = true;
  if (fence) fence->ready = true;
  for (const Ref& used : {commands, waits_for, signals, fence})
    if (used) pending_.push_back(used);
}

}  // namespace vitrine::fuzz
