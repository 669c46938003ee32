// Synchronization2 and timeline semaphores: chains of work whose order shows in the bytes.
#include <thread>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

const char kStep[] =
    "layout(local_size_x = 64) in;\nlayout(binding = 0) buffer B { uint b[]; };\n"
    "void main() { uint i = gl_GlobalInvocationID.x; b[i] = b[i] * 1664525u + 1013904223u + i; }\n";

/// A compute step over a buffer; steps do not commute.
struct Chain {
  Buffer buffer;
  Resources resources;
  VkPipeline pipeline;

  explicit Chain(Run& run) : buffer(run.buffer(64 * 64 * 4)), resources(run.resources({storage_buffer(0, buffer)})) {
    pipeline = run.compute(resources.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, kStep));
  }
  void step(VkCommandBuffer cmd) const {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    resources.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, 64, 1, 1);
  }
};

VkMemoryBarrier2 everything() {
  VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  all.srcAccessMask = all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  return all;
}

VkDependencyInfo dependency(const VkMemoryBarrier2& barrier) {
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  return info;
}

VkSemaphore make_semaphore(Run& run, bool timeline, uint64_t value = 0) {
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = timeline ? VK_SEMAPHORE_TYPE_TIMELINE : VK_SEMAPHORE_TYPE_BINARY;
  type.initialValue = value;
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, timeline ? &type : nullptr};
  VkSemaphore semaphore;
  CTS_VK(vkCreateSemaphore(run.device, &info, nullptr, &semaphore));
  return run.own(semaphore, vkDestroySemaphore);
}

VkSemaphoreSubmitInfo at(VkSemaphore semaphore, uint64_t value) {
  return {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, semaphore, value, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0};
}

void require_synchronization2(Run& run) {
  run.require(run.gpu.extension_features.synchronization2, "synchronization2");
}
void require_timeline(Run& run) { run.require(run.gpu.extension_features.timelineSemaphore, "timelineSemaphore"); }

CTS_CASE("synchronization2", "pipeline_barrier") {
  require_synchronization2(run);
  const Chain chain(run);
  const Buffer copy = run.buffer(chain.buffer.size);
  run.once([&](VkCommandBuffer cmd) {
    const VkMemoryBarrier2 all = everything();
    const VkDependencyInfo info = dependency(all);
    for (int n = 0; n < 4; ++n) {
      chain.step(cmd);
      CTS_COMMAND(run.gpu, CmdPipelineBarrier2KHR)(cmd, &info);
    }
    const VkBufferCopy region{0, 0, copy.size};
    vkCmdCopyBuffer(cmd, chain.buffer.handle, copy.handle, 1, &region);
  });
  run.out("copy", copy);
}

CTS_CASE("synchronization2", "image_barrier_between_draws") {
  require_synchronization2(run);
  Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = "layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 c;\nvoid main() { c = uv.xyxy; }\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer copy = run.buffer(64 * 64 * 4);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
    barrier.oldLayout = barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = target.colors[0].handle;
    barrier.subresourceRange = target.colors[0].range();
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    CTS_COMMAND(run.gpu, CmdPipelineBarrier2KHR)(cmd, &info);
    VkBufferImageCopy region{};
    region.imageSubresource = target.colors[0].layers();
    region.imageExtent = {64, 64, 1};
    vkCmdCopyImageToBuffer(cmd, target.colors[0].handle, VK_IMAGE_LAYOUT_GENERAL, copy.handle, 1, &region);
  });
  run.out("copy", copy);
}

CTS_CASE("synchronization2", "events") {
  require_synchronization2(run);
  const Chain chain(run);
  const VkEventCreateInfo event_info{VK_STRUCTURE_TYPE_EVENT_CREATE_INFO};
  VkEvent event;
  CTS_VK(vkCreateEvent(run.device, &event_info, nullptr, &event));
  run.own(event, vkDestroyEvent);
  const VkMemoryBarrier2 all = everything();
  const VkDependencyInfo info = dependency(all);
  run.once([&](VkCommandBuffer cmd) {
    chain.step(cmd);
    CTS_COMMAND(run.gpu, CmdSetEvent2KHR)(cmd, event, &info);
    CTS_COMMAND(run.gpu, CmdWaitEvents2KHR)(cmd, 1, &event, &info);
    chain.step(cmd);
    CTS_COMMAND(run.gpu, CmdPipelineBarrier2KHR)(cmd, &info);
    CTS_COMMAND(run.gpu, CmdResetEvent2KHR)(cmd, event, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  });
  const Buffer status = run.buffer_of<uint32_t>({vkGetEventStatus(run.device, event) == VK_EVENT_RESET, 7});
  run.out("chain", chain.buffer);
  run.out("status", status);
}

CTS_CASE("synchronization2", "queue_submit") {
  require_synchronization2(run);
  require_timeline(run);
  const Chain chain(run);
  const VkSemaphore binary = make_semaphore(run, false), timeline = make_semaphore(run, true, 5);
  std::vector<VkCommandBufferSubmitInfo> buffers;
  for (int n = 0; n < 3; ++n) {
    const VkCommandBuffer cmd = run.begin();
    chain.step(cmd);
    run.barrier(cmd);
    CTS_VK(vkEndCommandBuffer(cmd));
    buffers.push_back({VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, cmd, 0});
  }
  const VkSemaphoreSubmitInfo signals[2] = {at(binary, 0), at(timeline, 9)};
  const VkSemaphoreSubmitInfo wait_binary = at(binary, 0), wait_timeline = at(timeline, 8), last = at(timeline, 20);
  VkSubmitInfo2 batches[3] = {
      {VK_STRUCTURE_TYPE_SUBMIT_INFO_2}, {VK_STRUCTURE_TYPE_SUBMIT_INFO_2}, {VK_STRUCTURE_TYPE_SUBMIT_INFO_2}};
  for (int n = 0; n < 3; ++n) {
    batches[n].commandBufferInfoCount = 1;
    batches[n].pCommandBufferInfos = &buffers[n];
  }
  batches[0].signalSemaphoreInfoCount = 2;
  batches[0].pSignalSemaphoreInfos = signals;
  batches[1].waitSemaphoreInfoCount = 1;
  batches[1].pWaitSemaphoreInfos = &wait_binary;
  batches[2].waitSemaphoreInfoCount = batches[2].signalSemaphoreInfoCount = 1;
  batches[2].pWaitSemaphoreInfos = &wait_timeline;
  batches[2].pSignalSemaphoreInfos = &last;
  CTS_VK(CTS_COMMAND(run.gpu, QueueSubmit2KHR)(run.gpu.queue, 3, batches, VK_NULL_HANDLE));
  const uint64_t wanted = 20;
  VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  wait.semaphoreCount = 1;
  wait.pSemaphores = &timeline;
  wait.pValues = &wanted;
  CTS_VK(CTS_COMMAND(run.gpu, WaitSemaphoresKHR)(run.device, &wait, ~0ull));
  run.out("chain", chain.buffer);
  CTS_VK(vkQueueWaitIdle(run.gpu.queue));
}

/// The host is in the middle of the queue's work: it signals what a batch waits for, and waits for what it signals.
CTS_CASE("synchronization", "timeline_semaphore") {
  require_timeline(run);
  const Chain chain(run);
  const VkSemaphore timeline = make_semaphore(run, true, 0);
  const auto submit = [&](uint64_t wait_value, uint64_t signal_value) {
    const VkCommandBuffer cmd = run.begin();
    chain.step(cmd);
    run.barrier(cmd);
    CTS_VK(vkEndCommandBuffer(cmd));
    VkTimelineSemaphoreSubmitInfo values{VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO};
    values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
    values.pWaitSemaphoreValues = &wait_value;
    values.pSignalSemaphoreValues = &signal_value;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO, &values};
    info.commandBufferCount = info.waitSemaphoreCount = info.signalSemaphoreCount = 1;
    info.pCommandBuffers = &cmd;
    info.pWaitSemaphores = info.pSignalSemaphores = &timeline;
    info.pWaitDstStageMask = &stage;
    CTS_VK(vkQueueSubmit(run.gpu.queue, 1, &info, VK_NULL_HANDLE));
  };
  const auto wait = [&](uint64_t value) {
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline;
    info.pValues = &value;
    CTS_VK(CTS_COMMAND(run.gpu, WaitSemaphoresKHR)(run.device, &info, ~0ull));
  };
  submit(1, 2);  // waits for the host
  submit(3, 4);
  std::vector<uint32_t> values;
  for (uint64_t value = 1; value <= 3; value += 2) {
    VkSemaphoreSignalInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO};
    info.semaphore = timeline;
    info.value = value;
    CTS_VK(CTS_COMMAND(run.gpu, SignalSemaphoreKHR)(run.device, &info));
    wait(value + 1);
    uint64_t counter = 0;
    CTS_VK(CTS_COMMAND(run.gpu, GetSemaphoreCounterValueKHR)(run.device, timeline, &counter));
    values.push_back(static_cast<uint32_t>(counter));
    values.push_back(*chain.buffer.as<uint32_t>());
  }
  CTS_VK(vkQueueWaitIdle(run.gpu.queue));
  run.out("chain", chain.buffer);
  run.out("values", run.buffer_of(values));
}

}  // namespace
}  // namespace vitrine::cts
