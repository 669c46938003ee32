// Random transfers: copies between buffers and images, blits, clears, fills and updates, several in a row.
#include "cases/api/random_transfer.h"

#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {

VkOffset3D to_offset(VkExtent3D e) {
  return {static_cast<int32_t>(e.width), static_cast<int32_t>(e.height), static_cast<int32_t>(e.depth)};
}

bool reference_has(VkFormat format, VkFormatFeatureFlags features) {
  return (gpus().reference.features_of(format) & features) == features;
}

std::vector<VkFormat> formats_with(VkFormatFeatureFlags features, bool blocks) {
  std::vector<VkFormat> result;
  for (const FormatInfo& info : all_formats())
    if (reference_has(info.format, features) && (blocks || info.numeric != Numeric::kBlock) &&
        info.numeric != Numeric::kDepth)
      result.push_back(info.format);
  return result;
}

ImageSpec random_spec(Random& random, VkFormat format) {
  ImageSpec spec;
  spec.format = format;
  spec.view =
      random.pick({VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_IMAGE_VIEW_TYPE_3D});
  if (format_info(format).block > 1 && spec.view == VK_IMAGE_VIEW_TYPE_3D) spec.view = VK_IMAGE_VIEW_TYPE_2D;
  spec.extent = {8 + random.below(60), 8 + random.below(60), 1};
  if (spec.view == VK_IMAGE_VIEW_TYPE_3D) spec.extent.depth = 1 + random.below(6);
  if (spec.view == VK_IMAGE_VIEW_TYPE_2D_ARRAY) spec.layers = 1 + random.below(4);
  spec.levels = 1 + random.below(3);
  return spec;
}

Region random_region(Random& random, const Image& image, uint32_t level) {
  const uint32_t block = format_info(image.spec.format).block;
  const VkExtent3D size = image.level_extent(level);
  const auto axis = [&](uint32_t n, int32_t& offset, uint32_t& extent) {
    const uint32_t blocks = (n + block - 1) / block;
    const uint32_t first = random.below(blocks), count = 1 + random.below(blocks - first);
    offset = static_cast<int32_t>(first * block);
    extent = std::min(count * block, n - first * block);
  };
  Region region{{0, 0, 0}, {1, 1, 1}};
  axis(size.width, region.offset.x, region.extent.width);
  axis(size.height, region.offset.y, region.extent.height);
  if (size.depth > 1) {
    region.offset.z = static_cast<int32_t>(random.below(size.depth));
    region.extent.depth = 1 + random.below(size.depth - static_cast<uint32_t>(region.offset.z));
  }
  return region;
}

VkImageSubresourceLayers random_layers(Random& random, const Image& image, uint32_t level) {
  const uint32_t first = random.below(image.spec.layers);
  return {image.aspects(), level, first, 1 + random.below(image.spec.layers - first)};
}

namespace {

void random_buffer_image_copy(Run& run, bool to_image) {
  Random& random = run.random;
  const Image image =
      run.image(random_spec(random, random.pick(formats_with(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, true))));
  run.fill_random(image);
  const FormatInfo& info = format_info(image.spec.format);
  const Buffer buffer = run.buffer(1 << 20);
  const std::vector<unsigned char> bytes = random_texels(random, image.spec.format, buffer.size);
  std::memcpy(buffer.data, bytes.data(), bytes.size());
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 4; ++n) {
      const uint32_t level = random.below(image.spec.levels);
      const Region region = random_region(random, image, level);
      VkBufferImageCopy copy{};
      copy.bufferOffset = VkDeviceSize{random.below(64)} * info.bytes * 4;
      const uint32_t pad_x = random.below(3), pad_y = random.below(3);
      if (random.chance(0.5f))
        copy.bufferRowLength = (region.extent.width + info.block - 1 + pad_x * info.block) / info.block * info.block;
      if (random.chance(0.5f))
        copy.bufferImageHeight = (region.extent.height + info.block - 1 + pad_y * info.block) / info.block * info.block;
      copy.imageSubresource = random_layers(random, image, level);
      copy.imageOffset = region.offset;
      copy.imageExtent = region.extent;
      if (to_image)
        vkCmdCopyBufferToImage(cmd, buffer.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
      else
        vkCmdCopyImageToBuffer(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, buffer.handle, 1, &copy);
      run.barrier(cmd);
    }
  });
  if (to_image)
    run.out("image", image);
  else
    run.out("buffer", buffer);
}

void random_image_copy(Run& run) {
  Random& random = run.random;
  const VkFormat format = random.pick(formats_with(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, true));
  const FormatInfo& info = format_info(format);
  std::vector<VkFormat> compatible;
  for (const FormatInfo& other : all_formats())
    if (other.bytes == info.bytes && other.block == info.block && other.numeric != Numeric::kDepth &&
        reference_has(other.format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
      compatible.push_back(other.format);
  const Image from = run.image(random_spec(random, format));
  ImageSpec to_spec = random_spec(random, random.pick(compatible));
  to_spec.view = from.spec.view;
  to_spec.extent.depth = from.spec.extent.depth;
  to_spec.layers = from.spec.layers;
  const Image to = run.image(to_spec);
  run.fill_random(from);
  run.fill_random(to);
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 3; ++n) {
      VkImageCopy copy{};
      const uint32_t level = random.below(from.spec.levels), to_level = random.below(to.spec.levels);
      const Region a = random_region(random, from, level);
      copy.srcSubresource = random_layers(random, from, level);
      copy.dstSubresource = copy.srcSubresource;
      copy.dstSubresource.mipLevel = to_level;
      copy.srcOffset = a.offset;
      copy.extent = a.extent;
      const VkExtent3D size = to.level_extent(to_level);
      const uint32_t block = info.block;
      // Only whole blocks travel between levels whose edges cut blocks differently.
      if (block > 1) copy.extent = {a.extent.width / block * block, a.extent.height / block * block, a.extent.depth};
      copy.extent.width = std::min(copy.extent.width, size.width / block * block);
      copy.extent.height = std::min(copy.extent.height, size.height / block * block);
      copy.extent.depth = std::min(copy.extent.depth, size.depth);
      if (!copy.extent.width || !copy.extent.height) continue;
      const auto place = [&](uint32_t room) { return static_cast<int32_t>(random.below(room / block + 1) * block); };
      copy.dstOffset = {place(size.width - copy.extent.width), place(size.height - copy.extent.height),
                        static_cast<int32_t>(random.below(size.depth - copy.extent.depth + 1))};
      vkCmdCopyImage(cmd, from.handle, VK_IMAGE_LAYOUT_GENERAL, to.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
      run.barrier(cmd);
    }
  });
  run.out("to", to);
}

void random_blit(Run& run, bool scaled) {
  Random& random = run.random;
  const VkFormat from_format = random.pick(formats_with(VK_FORMAT_FEATURE_BLIT_SRC_BIT));
  const FormatInfo& info = format_info(from_format);
  std::vector<VkFormat> targets;
  for (const VkFormat format : formats_with(VK_FORMAT_FEATURE_BLIT_DST_BIT)) {
    const FormatInfo& other = format_info(format);
    const auto kind = [](const FormatInfo& f) {
      return f.numeric == Numeric::kUint ? 1 : f.numeric == Numeric::kSint ? 2 : 0;
    };
    if (kind(info) == kind(other)) targets.push_back(format);
  }
  ImageSpec spec;
  spec.format = from_format;
  spec.extent = {8 + random.below(60), 8 + random.below(60), 1};
  const Image from = run.image(spec);
  spec.format = random.pick(targets);
  spec.extent = {8 + random.below(60), 8 + random.below(60), 1};
  const Image to = run.image(spec);
  run.fill_random(from);
  run.fill_random(to);
  if (format_info(spec.format).numeric == Numeric::kSrgb)
    run.require(reference_cpu().srgb_comparable, "a comparable sRGB encoding");
  const bool linear =
      reference_has(from_format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) && random.chance(0.6f);
  run.note("blit", std::string(info.name) + " to " + format_info(spec.format).name + (linear ? " linear" : " nearest"));
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 2; ++n) {
      const Region a = random_region(random, from, 0);
      Region b = random_region(random, to, 0);
      VkImageBlit blit{};
      if (!scaled)
        b.extent = {std::min(a.extent.width, spec.extent.width), std::min(a.extent.height, spec.extent.height), 1};
      if (!scaled) b.offset = {0, 0, 0};
      const VkExtent3D size = scaled ? a.extent : b.extent;
      blit.srcSubresource = from.layers();
      blit.dstSubresource = to.layers();
      blit.srcOffsets[0] = a.offset;
      blit.srcOffsets[1] = {a.offset.x + to_offset(size).x, a.offset.y + to_offset(size).y, 1};
      blit.dstOffsets[0] = b.offset;
      blit.dstOffsets[1] = {b.offset.x + to_offset(b.extent).x, b.offset.y + to_offset(b.extent).y, 1};
      if (random.chance(0.3f)) std::swap(blit.dstOffsets[0].x, blit.dstOffsets[1].x);
      if (random.chance(0.3f)) std::swap(blit.srcOffsets[0].y, blit.srcOffsets[1].y);
      vkCmdBlitImage(cmd, from.handle, VK_IMAGE_LAYOUT_GENERAL, to.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &blit,
                     linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
      run.barrier(cmd);
    }
  });
  run.out("to", to);
}

VkClearColorValue random_clear(Random& random, const FormatInfo& info) {
  VkClearColorValue value{};
  for (int c = 0; c < 4; ++c) {
    if (is_integer(info))
      value.uint32[c] = random.chance(0.5f) ? random.below(256) : random.bits();
    else
      value.float32[c] = random.chance(0.8f) ? random.unit() : random.real(-2.0f, 3.0f);
  }
  return value;
}

void random_clear_image(Run& run) {
  Random& random = run.random;
  const VkFormat format = random.pick(formats_with(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT));
  const Image image = run.image(random_spec(random, format));
  run.fill_random(image);
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 2; ++n) {
      VkImageSubresourceRange range = image.range();
      range.baseMipLevel = random.below(image.spec.levels);
      range.levelCount = random.chance(0.3f) ? VK_REMAINING_MIP_LEVELS : 1;
      range.baseArrayLayer = random.below(image.spec.layers);
      range.layerCount = random.chance(0.3f) ? VK_REMAINING_ARRAY_LAYERS : 1;
      const VkClearColorValue value = random_clear(random, format_info(format));
      vkCmdClearColorImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
      run.barrier(cmd);
    }
  });
  run.out("image", image);
  run.may_be_blank();
}

void random_clear_attachments(Run& run) {
  Random& random = run.random;
  TargetSpec spec;
  spec.width = 20 + random.below(60);
  spec.height = 20 + random.below(60);
  spec.colors = {random.pick(formats_with(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)), VK_FORMAT_R8G8B8A8_UNORM};
  spec.depth = random.pick(
      {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT});
  Target target = make_target(run, spec);
  target.clears[0].color = random_clear(random, format_info(spec.colors[0]));
  target.clears[2].depthStencil = {random.unit(), random.below(256)};
  const auto rect = [&] {
    const uint32_t x = random.below(spec.width), y = random.below(spec.height);
    return VkRect2D{{static_cast<int32_t>(x), static_cast<int32_t>(y)},
                    {1 + random.below(spec.width - x), 1 + random.below(spec.height - y)}};
  };
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    for (int n = 0; n < 4; ++n) {
      VkClearAttachment clear{};
      const uint32_t which = random.below(3);
      clear.aspectMask = which < 2 ? VkImageAspectFlags{VK_IMAGE_ASPECT_COLOR_BIT} : aspects_of(spec.depth);
      if (which == 2 && random.chance(0.5f)) clear.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
      clear.colorAttachment = which;
      if (which < 2)
        clear.clearValue.color = random_clear(random, format_info(spec.colors[which]));
      else
        clear.clearValue.depthStencil = {random.unit(), random.below(256)};
      const VkClearRect area{rect(), 0, 1};
      vkCmdClearAttachments(cmd, 1, &clear, 1, &area);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

void random_buffer_transfers(Run& run) {
  Random& random = run.random;
  std::vector<uint32_t> words(1024);
  for (uint32_t& word : words) word = random.bits();
  const Buffer a = run.buffer_of(words), b = run.buffer(4096);
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 6; ++n) {
      const uint32_t at = random.below(1000) * 4;
      switch (random.below(3)) {
        case 0: {
          const uint32_t word = random.bits();
          vkCmdFillBuffer(cmd, b.handle, at,
                          random.chance(0.2f) ? VK_WHOLE_SIZE : (1 + random.below(1023 - at / 4)) * 4, word);
          break;
        }
        case 1: {
          std::vector<uint32_t> data(1 + random.below(20));
          for (uint32_t& word : data) word = random.bits();
          vkCmdUpdateBuffer(cmd, b.handle, at / 2 / 4 * 4, data.size() * 4, data.data());
          break;
        }
        default: {
          const uint32_t size = 1 + random.below(2000);
          const VkBufferCopy copy{random.below(4096 - size), random.below(4096 - size), size};
          vkCmdCopyBuffer(cmd, a.handle, b.handle, 1, &copy);
        }
      }
      run.barrier(cmd);
    }
  });
  run.out("b", b);
}

const AddGenerator kBufferToImage("api", "random_copy_buffer_to_image", 80,
                                  [](Run& run) { random_buffer_image_copy(run, true); });
const AddGenerator kImageToBuffer("api", "random_copy_image_to_buffer", 80,
                                  [](Run& run) { random_buffer_image_copy(run, false); });
const AddGenerator kImageCopy("api", "random_copy_image", 80, random_image_copy);
const AddGenerator kBlit("api", "random_blit_scaled", 120, [](Run& run) { random_blit(run, true); });
const AddGenerator kBlitSame("api", "random_blit_same_size", 60, [](Run& run) { random_blit(run, false); });
const AddGenerator kClearImage("api", "random_clear_image", 100, random_clear_image);
const AddGenerator kClearAttachments("api", "random_clear_attachments", 80, random_clear_attachments);
const AddGenerator kBuffers("api", "random_buffer_transfers", 60, random_buffer_transfers);

}  // namespace
}  // namespace vitrine::cts
