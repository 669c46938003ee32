// What a run does, one after the other.
#include "tests/fuzz/api_run.h"

#include "tests/fuzz/target.h"

namespace vitrine::fuzz {

using icd::make_struct;

Run::~Run() {
  VK_CALL(DestroyCommandPool)(w_.device, pool_, nullptr);
  for (const VkPipeline p : {graphics_, compute_}) VK_CALL(DestroyPipeline)(w_.device, p, nullptr);
  VK_CALL(DestroyDescriptorPool)(w_.device, descriptors_, nullptr);
  VK_CALL(DestroySampler)(w_.device, sampler_, nullptr);
  for (const VkBufferView v : texels_) VK_CALL(DestroyBufferView)(w_.device, v, nullptr);
  for (const Picture& p : {target_, depth_, picture_, canvas_}) {
    VK_CALL(DestroyImageView)(w_.device, p.view, nullptr);
    VK_CALL(DestroyImage)(w_.device, p.image, nullptr);
  }
  for (const Buffer& b : buffers_) VK_CALL(DestroyBuffer)(w_.device, b.handle, nullptr);
  VK_CALL(DestroyBuffer)(w_.device, parameters_.handle, nullptr);
  for (const VkDeviceMemory m : memories_) VK_CALL(FreeMemory)(w_.device, m, nullptr);
}

bool Run::go() {
  for (Buffer& buffer : buffers_) buffer = make_buffer();
  parameters_ = make_buffer();
  make_images();
  make_set();
  make_graphics();
  make_compute();
  record();
  auto info = make_struct<VkSubmitInfo>();
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands_;
  const VkResult submitted = VK_CALL(QueueSubmit)(w_.queue, 1, &info, VK_NULL_HANDLE);
  const VkResult waited = VK_CALL(QueueWaitIdle)(w_.queue);
  for (const VkResult result : {submitted, waited})
    demand(result == VK_SUCCESS || result == VK_ERROR_DEVICE_LOST, "a submission");
  return waited == VK_SUCCESS;
}

}  // namespace vitrine::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vitrine::fuzz;
  Choices choices({data, size});
  bool lives = true;
  {
    Run run(choices);
    lives = run.go();
  }
  if (!lives) replace_device();
  return 0;
}
