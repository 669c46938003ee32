// Random transfers of what is no plain colour image: blocks as texels, volumes and arrays, depth and stencil, samples,
// results of queries.
#include <algorithm>

#include "cases/api/random_transfer.h"
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;

/// Between blocks and texels of the same size, in either direction; the extent counts texels of the source.
CTS_RANDOM("api", "random_copy_blocks_as_texels", 40) {
  Random& random = run.random;
  std::vector<VkFormat> blocks, texels;
  for (const VkFormat format : formats_with(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, true))
    if (format_info(format).block > 1) blocks.push_back(format);
  const VkFormat compressed = random.pick(blocks);
  for (const VkFormat format : formats_with(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
    if (format_info(format).bytes == format_info(compressed).bytes) texels.push_back(format);
  const uint32_t side = format_info(compressed).block;
  ImageSpec block_spec = random_spec(random, compressed), texel_spec = random_spec(random, random.pick(texels));
  block_spec.view = texel_spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  block_spec.extent.depth = texel_spec.extent.depth = 1;
  block_spec.layers = texel_spec.layers = 1 + random.below(3);
  const Image block_image = run.image(block_spec), texel_image = run.image(texel_spec);
  run.fill_random(block_image);
  run.fill_random(texel_image);
  const bool from_blocks = random.chance(0.5f);
  run.note("copy", std::string(format_info(compressed).name) + (from_blocks ? " to " : " from ") +
                       format_info(texel_spec.format).name);
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 4; ++n) {
      // A cut block at an edge can be the source, but not the target: the extent then counts whole texels.
      const uint32_t cut = from_blocks ? side - 1 : 0;
      const uint32_t block_level = from_blocks ? random.below(block_spec.levels) : 0,
                     texel_level = random.below(texel_spec.levels);
      const VkExtent3D block_size = block_image.level_extent(block_level),
                       texel_size = texel_image.level_extent(texel_level);
      const uint32_t columns = (block_size.width + cut) / side, rows = (block_size.height + cut) / side;
      const uint32_t width = 1 + random.below(std::min(columns, texel_size.width)),
                     height = 1 + random.below(std::min(rows, texel_size.height));
      const uint32_t bx = random.below(columns - width + 1) * side, by = random.below(rows - height + 1) * side;
      const VkOffset3D block_at{static_cast<int32_t>(bx), static_cast<int32_t>(by), 0};
      const VkOffset3D texel_at{static_cast<int32_t>(random.below(texel_size.width - width + 1)),
                                static_cast<int32_t>(random.below(texel_size.height - height + 1)), 0};
      VkImageSubresourceLayers layers = random_layers(random, block_image, block_level);
      VkImageCopy copy{};
      (from_blocks ? copy.srcSubresource : copy.dstSubresource) = layers;
      layers.mipLevel = texel_level;
      (from_blocks ? copy.dstSubresource : copy.srcSubresource) = layers;
      copy.srcOffset = from_blocks ? block_at : texel_at;
      copy.dstOffset = from_blocks ? texel_at : block_at;
      copy.extent = {width, height, 1};
      if (from_blocks)
        copy.extent = {std::min(width * side, block_size.width - bx), std::min(height * side, block_size.height - by),
                       1};
      vkCmdCopyImage(cmd, (from_blocks ? block_image : texel_image).handle, kGeneral,
                     (from_blocks ? texel_image : block_image).handle, kGeneral, 1, &copy);
      run.barrier(cmd);
    }
  });
  run.out("to", from_blocks ? texel_image : block_image);
}

/// Two corners, in either order.
void place(Random& random, const Region& region, VkOffset3D corners[2]) {
  const VkOffset3D size = to_offset(region.extent);
  corners[0] = region.offset;
  corners[1] = {region.offset.x + size.x, region.offset.y + size.y, region.offset.z + size.z};
  if (random.chance(0.3f)) std::swap(corners[0].x, corners[1].x);
  if (random.chance(0.3f)) std::swap(corners[0].y, corners[1].y);
  if (region.extent.depth > 1 && random.chance(0.3f)) std::swap(corners[0].z, corners[1].z);
}

/// Levels and layers of arrays, and volumes scaled in depth, flipped in every direction; compressed sources, too.
void random_blit_shapes(Run& run, VkImageViewType view) {
  Random& random = run.random;
  const bool volume = view == VK_IMAGE_VIEW_TYPE_3D;
  const VkFormat from_format = random.pick(formats_with(VK_FORMAT_FEATURE_BLIT_SRC_BIT, !volume));
  const auto kind = [](const FormatInfo& f) {
    return f.numeric == Numeric::kUint ? 1 : f.numeric == Numeric::kSint ? 2 : 0;
  };
  std::vector<VkFormat> targets;
  for (const VkFormat format : formats_with(VK_FORMAT_FEATURE_BLIT_DST_BIT))
    if (kind(format_info(format)) == kind(format_info(from_format))) targets.push_back(format);
  ImageSpec from_spec = random_spec(random, from_format), to_spec = random_spec(random, random.pick(targets));
  from_spec.view = to_spec.view = view;
  from_spec.layers = to_spec.layers = volume ? 1 : 1 + random.below(4);
  from_spec.extent.depth = volume ? 1 + random.below(8) : 1;
  to_spec.extent.depth = volume ? 1 + random.below(8) : 1;
  if (format_info(to_spec.format).numeric == Numeric::kSrgb)
    run.require(reference_cpu().srgb_comparable, "a comparable sRGB encoding");
  const Image from = run.image(from_spec), to = run.image(to_spec);
  run.fill_random(from);
  run.fill_random(to);
  const bool linear =
      reference_has(from_format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) && random.chance(0.6f);
  std::string note = std::string(format_info(from_format).name) + " to " + format_info(to_spec.format).name +
                     (linear ? " linear\n" : " nearest\n");
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 3; ++n) {
      VkImageBlit blit{};
      const uint32_t from_level = random.below(from_spec.levels), to_level = random.below(to_spec.levels);
      blit.srcSubresource = random_layers(random, from, from_level);
      blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, to_level, 0, blit.srcSubresource.layerCount};
      blit.dstSubresource.baseArrayLayer = random.below(to_spec.layers - blit.srcSubresource.layerCount + 1);
      place(random, random_region(random, from, from_level), blit.srcOffsets);
      place(random, random_region(random, to, to_level), blit.dstOffsets);
      for (const VkOffset3D& o : {blit.srcOffsets[0], blit.srcOffsets[1], blit.dstOffsets[0], blit.dstOffsets[1]})
        note += std::to_string(o.x) + " " + std::to_string(o.y) + " " + std::to_string(o.z) + "; ";
      note += "levels " + std::to_string(from_level) + " " + std::to_string(to_level) + "\n";
      vkCmdBlitImage(cmd, from.handle, kGeneral, to.handle, kGeneral, 1, &blit,
                     linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
      run.barrier(cmd);
    }
  });
  run.note("blit", note);
  run.out("to", to);
}
const AddGenerator kBlitArray("api", "random_blit_array", 40,
                              [](Run& run) { random_blit_shapes(run, VK_IMAGE_VIEW_TYPE_2D_ARRAY); });
const AddGenerator kBlitVolume("api", "random_blit_volume", 40,
                               [](Run& run) { random_blit_shapes(run, VK_IMAGE_VIEW_TYPE_3D); });

VkFormat random_depth_format(Random& random) {
  return random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT, VK_FORMAT_S8_UINT,
                      VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT});
}

/// One aspect of a format, or for `all` also both.
VkImageAspectFlags random_aspects(Random& random, VkFormat format, bool all) {
  const VkImageAspectFlags aspects = aspects_of(format);
  if (aspects != (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT)) return aspects;
  if (all && random.chance(0.4f)) return aspects;
  return random.chance(0.5f) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_STENCIL_BIT;
}

/// Clears, copies, blits and buffer copies of depth and stencil, several in a row.
CTS_RANDOM("api", "random_depth_stencil", 60) {
  Random& random = run.random;
  const VkFormat format = random_depth_format(random);
  ImageSpec spec = random_spec(random, format), to_spec = random_spec(random, format);
  spec.view = to_spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  spec.extent.depth = to_spec.extent.depth = 1;
  spec.layers = to_spec.layers = 1 + random.below(3);
  const Image from = run.image(spec), to = run.image(to_spec);
  run.fill_random(from);
  run.fill_random(to);
  const Buffer buffer = run.buffer(1 << 18);
  std::string note = format_info(format).name;
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 4; ++n) {
      const uint32_t level = random.below(spec.levels), to_level = random.below(to_spec.levels);
      const Region a = random_region(random, from, level), b = random_region(random, to, to_level);
      VkImageSubresourceLayers source = random_layers(random, from, level), target = source;
      target.mipLevel = to_level;
      const uint32_t what = n == 0 ? random.below(4) : 1 + random.below(3);
      // The reference blits both aspects whatever the mask (deviations.md, blit-other-aspect).
      source.aspectMask = target.aspectMask = what == 1 ? aspects_of(format) : random_aspects(random, format, what < 3);
      note += " " + std::to_string(what) + "/" + std::to_string(source.aspectMask);
      if (what == 0) {
        const VkClearDepthStencilValue value{random.unit(), random.below(256)};
        const VkImageSubresourceRange range{source.aspectMask, to_level, 1, target.baseArrayLayer, target.layerCount};
        vkCmdClearDepthStencilImage(cmd, to.handle, kGeneral, &value, 1, &range);
      } else if (what == 1) {
        VkImageBlit blit{source, {}, target, {}};
        place(random, a, blit.srcOffsets);
        place(random, b, blit.dstOffsets);
        vkCmdBlitImage(cmd, from.handle, kGeneral, to.handle, kGeneral, 1, &blit, VK_FILTER_NEAREST);
      } else if (what == 2) {
        source.aspectMask = target.aspectMask = aspects_of(format);
        const VkExtent3D extent{std::min(a.extent.width, b.extent.width), std::min(a.extent.height, b.extent.height),
                                1};
        const VkImageCopy copy{source, a.offset, target, b.offset, extent};
        vkCmdCopyImage(cmd, from.handle, kGeneral, to.handle, kGeneral, 1, &copy);
      } else {
        VkBufferImageCopy copy{VkDeviceSize{random.below(64)} * 4, 0, 0, source, a.offset, a.extent};
        if (random.chance(0.5f)) copy.bufferRowLength = a.extent.width + random.below(5);
        if (random.chance(0.5f)) copy.bufferImageHeight = a.extent.height + random.below(5);
        vkCmdCopyImageToBuffer(cmd, from.handle, kGeneral, buffer.handle, 1, &copy);
        run.barrier(cmd);
        copy.imageSubresource = target;
        copy.imageOffset = b.offset;
        copy.imageExtent = {std::min(a.extent.width, b.extent.width), std::min(a.extent.height, b.extent.height), 1};
        if (copy.bufferRowLength == 0) copy.bufferRowLength = a.extent.width;
        if (copy.bufferImageHeight == 0) copy.bufferImageHeight = a.extent.height;
        vkCmdCopyBufferToImage(cmd, buffer.handle, to.handle, kGeneral, 1, &copy);
      }
      run.barrier(cmd);
    }
  });
  run.note("steps", note);
  run.out("to", to);
  run.may_be_blank();  // a clear may have covered the whole of a level last
}

/// Colours of random triangles in a multisampled array; copied sample by sample, resolved, and the regions of both.
CTS_RANDOM("api", "random_multisample_transfers", 30) {
  Random& random = run.random;
  TargetSpec target_spec;
  std::vector<VkFormat> formats;
  for (const VkFormat format : formats_with(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT))
    if (format_info(format).numeric != Numeric::kSrgb &&
        !(format_info(format).numeric == Numeric::kSnorm && format_info(format).bits[0] == 10))
      formats.push_back(format);
  const VkFormat format = random.pick(formats);
  target_spec.colors = {format};
  target_spec.width = 20 + random.below(60);
  target_spec.height = 20 + random.below(60);
  target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Target target = make_target(run, target_spec);
  run.note("format", format_info(format).name);
  std::vector<float> vertices;
  for (int v = 0; v < 60; ++v) {
    for (int c = 0; c < 2; ++c) vertices.push_back(random.real(-1.2f, 1.2f));
    vertices.insert(vertices.end(), {0.5f, 1.0f});
    for (int c = 0; c < 4; ++c)
      vertices.push_back(is_integer(format_info(format)) ? random.real(0, 90) : random.unit());
  }
  const Buffer vertex_buffer = run.buffer_of(vertices);
  GraphicsSpec spec;
  spec.floats({4, 4});
  spec.vertex = kColorVertex;
  const std::string prefix = format_info(format).numeric == Numeric::kUint   ? "u"
                             : format_info(format).numeric == Numeric::kSint ? "i"
                                                                             : "";
  spec.fragment = "layout(location = 0) in vec4 color;\nlayout(location = 0) out " + prefix +
                  "vec4 v;\nvoid main() { v = " + prefix + "vec4(color); }\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  ImageSpec copy_spec;
  copy_spec.format = format;
  copy_spec.extent = {16 + random.below(60), 16 + random.below(60), 1};
  copy_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  copy_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image copied = run.image(copy_spec);
  copy_spec.samples = VK_SAMPLE_COUNT_1_BIT;
  copy_spec.levels = 2;
  copy_spec.layers = 2;
  copy_spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  const Image resolved = run.image(copy_spec);
  run.fill_random(resolved);
  run.once([&](VkCommandBuffer cmd) {
    VkClearColorValue clear{};
    const VkImageSubresourceRange range = copied.range();
    vkCmdClearColorImage(cmd, copied.handle, kGeneral, &clear, 1, &range);
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertex_buffer);
    vkCmdDraw(cmd, 60, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
    run.barrier(cmd);
    const Image& drawn = target.colors[0];
    for (int n = 0; n < 3; ++n) {
      const Region a = random_region(random, drawn, 0), b = random_region(random, copied, 0);
      const uint32_t level = random.below(2);
      const Region c = random_region(random, resolved, level);
      const auto smaller = [](VkExtent3D x, VkExtent3D y) {
        return VkExtent3D{std::min(x.width, y.width), std::min(x.height, y.height), 1};
      };
      const VkImageCopy copy{drawn.layers(), a.offset, copied.layers(), b.offset, smaller(a.extent, b.extent)};
      vkCmdCopyImage(cmd, drawn.handle, kGeneral, copied.handle, kGeneral, 1, &copy);
      const VkImageResolve resolve{drawn.layers(),
                                   a.offset,
                                   {VK_IMAGE_ASPECT_COLOR_BIT, level, random.below(2), 1},
                                   c.offset,
                                   smaller(a.extent, c.extent)};
      vkCmdResolveImage(cmd, drawn.handle, kGeneral, resolved.handle, kGeneral, 1, &resolve);
      run.barrier(cmd);
    }
  });
  run.out("drawn", target.colors[0]);
  run.out("copied", copied);
  run.outputs.back().may_be_blank = true;  // what is copied may lie between the triangles
  run.out("resolved", resolved);
}

/// Occlusion counts of draws, copied in words or double words, with strides and availability.
CTS_RANDOM("api", "random_query_results", 30) {
  Random& random = run.random;
  run.require(run.gpu.features.occlusionQueryPrecise, "occlusionQueryPrecise");
  const Target target = make_target(run, {});
  const uint32_t count = 4 + random.below(8);
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_OCCLUSION, count);
  std::vector<float> vertices;
  for (uint32_t v = 0; v < 3 * count; ++v) {
    for (int c = 0; c < 2; ++c) vertices.push_back(random.real(-1.2f, 1.2f));
    vertices.insert(vertices.end(), {0.5f, 1.0f, 1.0f, 0.5f, 0.0f, 1.0f});
  }
  const Buffer vertex_buffer = run.buffer_of(vertices);
  GraphicsSpec spec;
  spec.floats({4, 4});
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer results = run.buffer(4096);
  for (VkDeviceSize i = 0; i < results.size; ++i) results.data[i] = static_cast<unsigned char>(random.bits() >> 24);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, count);
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertex_buffer);
    for (uint32_t q = 0; q < count; ++q) {
      vkCmdBeginQuery(cmd, pool, q, VK_QUERY_CONTROL_PRECISE_BIT);
      vkCmdDraw(cmd, 3, 1, q * 3, 0);
      vkCmdEndQuery(cmd, pool, q);
    }
    vkCmdEndRenderPass(cmd);
    VkDeviceSize at = 0;
    for (int n = 0; n < 4; ++n) {
      VkQueryResultFlags flags = VK_QUERY_RESULT_WAIT_BIT;
      if (random.chance(0.5f)) flags |= VK_QUERY_RESULT_64_BIT;
      if (random.chance(0.5f)) flags |= VK_QUERY_RESULT_WITH_AVAILABILITY_BIT;
      const uint32_t first = random.below(count), number = 1 + random.below(count - first);
      const VkDeviceSize size = flags & VK_QUERY_RESULT_64_BIT ? 8 : 4;
      const VkDeviceSize stride =
          size * (1 + random.below(2)) + (flags & VK_QUERY_RESULT_WITH_AVAILABILITY_BIT ? size : 0);
      at = (at + 7) / 8 * 8;
      vkCmdCopyQueryPoolResults(cmd, pool, first, number, results.handle, at, stride, flags);
      at += stride * number;
      run.barrier(cmd);
    }
  });
  run.out("results", results);
}

}  // namespace
}  // namespace vitrine::cts
