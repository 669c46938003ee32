// Copies, blits, clears.
#include <cstring>

#include "bench.h"

namespace vitrine::bench {
namespace {

constexpr std::uint32_t kSide = 2048;

double per_second(Run& run, double work, const std::function<void(VkCommandBuffer)>& record) {
  VkCommandBuffer cmd = begin_repeatable(run);
  record(cmd);
  return work / time_submissions(run, finish(cmd));
}

constexpr VkDeviceSize kBytes = 64 << 20;

/// What copies are measured against: the C library on one thread.
double copy_memory(Run&) {
  std::vector<char> from(kBytes, 1), to(kBytes, 2);
  return kBytes / 1e9 / time_calls([&] { std::memcpy(to.data(), from.data(), kBytes); });
}

double copy_buffer(Run& run) {
  const cts::Buffer from = run.buffer(kBytes), to = run.buffer(kBytes);
  const VkBufferCopy copy{0, 0, kBytes};
  return per_second(run, kBytes / 1e9,
                    [&](VkCommandBuffer cmd) { vkCmdCopyBuffer(cmd, from.handle, to.handle, 1, &copy); });
}

double copy_image(Run& run, bool to_image) {
  const cts::Buffer buffer = run.buffer(VkDeviceSize{kSide} * kSide * 4);
  cts::ImageSpec spec;
  spec.extent = {kSide, kSide, 1};
  const cts::Image image = run.image(spec);
  VkBufferImageCopy copy{};
  copy.imageSubresource = image.layers();
  copy.imageExtent = spec.extent;
  return per_second(run, kSide * kSide * 4 / 1e9, [&](VkCommandBuffer cmd) {
    if (to_image) {
      vkCmdCopyBufferToImage(cmd, buffer.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    } else {
      vkCmdCopyImageToBuffer(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, buffer.handle, 1, &copy);
    }
  });
}

double copy_between_images(Run& run) {
  cts::ImageSpec spec;
  spec.extent = {kSide, kSide, 1};
  const cts::Image from = run.image(spec), to = run.image(spec);
  VkImageCopy region{};
  region.srcSubresource = region.dstSubresource = from.layers();
  region.extent = spec.extent;
  return per_second(run, kSide * kSide * 4 / 1e9, [&](VkCommandBuffer cmd) {
    vkCmdCopyImage(cmd, from.handle, VK_IMAGE_LAYOUT_GENERAL, to.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  });
}

/// Every level from the one above it.
double generate_mips(Run& run, VkFormat format) {
  constexpr std::uint32_t kWidth = 1024, kLevels = 11;
  cts::ImageSpec spec;
  spec.format = format;
  spec.extent = {kWidth, kWidth, 1};
  spec.levels = kLevels;
  const cts::Image image = run.image(spec);
  run.fill_random(image);
  return per_second(run, kWidth * kWidth / 3 / 1e6, [&](VkCommandBuffer cmd) {
    for (std::uint32_t level = 1; level < kLevels; ++level) {
      const auto side = [](std::uint32_t i) { return static_cast<std::int32_t>(kWidth >> i); };
      VkImageBlit region{};
      region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, 1};
      region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
      region.srcOffsets[1] = {side(level - 1), side(level - 1), 1};
      region.dstOffsets[1] = {side(level), side(level), 1};
      vkCmdBlitImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region,
                     VK_FILTER_LINEAR);
      VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
      barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
      barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
      vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &barrier, 0,
                           nullptr, 0, nullptr);
    }
  });
}

double blit(Run& run, VkFilter filter, VkFormat source = VK_FORMAT_R8G8B8A8_UNORM,
            VkFormat destination = VK_FORMAT_R8G8B8A8_UNORM) {
  cts::ImageSpec spec;
  spec.format = source;
  spec.extent = {1024, 1024, 1};
  const cts::Image from = run.image(spec);
  run.fill_random(from);
  spec.format = destination;
  spec.extent = {1400, 1400, 1};
  const cts::Image to = run.image(spec);
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = from.layers();
  region.srcOffsets[1] = {1024, 1024, 1};
  region.dstOffsets[1] = {1400, 1400, 1};
  return per_second(run, 1400 * 1400 / 1e6, [&](VkCommandBuffer cmd) {
    vkCmdBlitImage(cmd, from.handle, VK_IMAGE_LAYOUT_GENERAL, to.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region, filter);
  });
}

double clear_image(Run& run) {
  cts::ImageSpec spec;
  spec.extent = {kSide, kSide, 1};
  const cts::Image image = run.image(spec);
  const VkClearColorValue color{{0.1f, 0.2f, 0.3f, 0.4f}};
  const VkImageSubresourceRange range = image.range();
  return per_second(run, kSide * kSide * 4 / 1e9, [&](VkCommandBuffer cmd) {
    vkCmdClearColorImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
  });
}

}  // namespace

std::vector<Workload> transfer_workloads() {
  return {
      {"x_memcpy", "GB/s", false, copy_memory},
      {"x_copy_buffer", "GB/s", false, copy_buffer},
      {"x_copy_image", "GB/s", false, copy_between_images},
      {"x_buf_to_img", "GB/s", false, [](Run& run) { return copy_image(run, true); }},
      {"x_img_to_buf", "GB/s", false, [](Run& run) { return copy_image(run, false); }},
      {"x_blit_linear", "Mpix/s", false, [](Run& run) { return blit(run, VK_FILTER_LINEAR); }},
      {"x_blit_nearest", "Mpix/s", false, [](Run& run) { return blit(run, VK_FILTER_NEAREST); }},
      {"x_mips_rgba8", "Mpix/s", false, [](Run& run) { return generate_mips(run, VK_FORMAT_R8G8B8A8_UNORM); }},
      {"x_mips_srgb", "Mpix/s", false, [](Run& run) { return generate_mips(run, VK_FORMAT_R8G8B8A8_SRGB); }},
      {"x_mips_rgba16f", "Mpix/s", false, [](Run& run) { return generate_mips(run, VK_FORMAT_R16G16B16A16_SFLOAT); }},
      {"x_mips_r8", "Mpix/s", false, [](Run& run) { return generate_mips(run, VK_FORMAT_R8_UNORM); }},
      {"x_mips_rg16f", "Mpix/s", false, [](Run& run) { return generate_mips(run, VK_FORMAT_R16G16_SFLOAT); }},
      {"x_mips_r11g11b10", "Mpix/s", false,
       [](Run& run) { return generate_mips(run, VK_FORMAT_B10G11R11_UFLOAT_PACK32); }},
      {"x_mips_rgba32f", "Mpix/s", false, [](Run& run) { return generate_mips(run, VK_FORMAT_R32G32B32A32_SFLOAT); }},
      {"x_blit_bc1", "Mpix/s", false,
       [](Run& run) { return blit(run, VK_FILTER_LINEAR, VK_FORMAT_BC1_RGBA_UNORM_BLOCK); }},
      {"x_blit_d32", "Mpix/s", false,
       [](Run& run) { return blit(run, VK_FILTER_NEAREST, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT); }},
      {"x_clear_image", "GB/s", false, clear_image}};
}

}  // namespace vitrine::bench
