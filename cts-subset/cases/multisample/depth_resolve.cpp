// Resolves of depth and stencil in all modes, in render pass 2 and dynamic rendering: what lies in the resolved image
// against what the fetched samples give. The reference takes sample 0 whatever the mode and cannot resolve one aspect
// alone, so the side of the reference puts out what a device without a fault does: no difference.
#include <algorithm>
#include <bit>
#include <cmath>

#include "cases/multisample/samples.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr VkExtent2D kExtent{61, 47};

struct Resolve {
  VkFormat format;
  VkSampleCountFlagBits samples;
  VkResolveModeFlagBits depth, stencil;
  VkRect2D area;
  bool dynamic;
};

Resolve random_resolve(Random& random) {
  Resolve r;
  r.format = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT, VK_FORMAT_S8_UINT,
                          VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT});
  r.samples = random.pick({VK_SAMPLE_COUNT_2_BIT, VK_SAMPLE_COUNT_4_BIT, VK_SAMPLE_COUNT_8_BIT});
  r.depth = random.pick({VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_AVERAGE_BIT,
                         VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MAX_BIT});
  r.stencil = random.pick(
      {VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MAX_BIT});
  const VkImageAspectFlags aspects = aspects_of(r.format);
  if (!(aspects & VK_IMAGE_ASPECT_DEPTH_BIT)) r.depth = VK_RESOLVE_MODE_NONE;
  if (!(aspects & VK_IMAGE_ASPECT_STENCIL_BIT)) r.stencil = VK_RESOLVE_MODE_NONE;
  if (!r.depth && !r.stencil) {
    if (aspects & VK_IMAGE_ASPECT_DEPTH_BIT)
      r.depth = VK_RESOLVE_MODE_AVERAGE_BIT;
    else
      r.stencil = VK_RESOLVE_MODE_MAX_BIT;
  }
  r.area = {{0, 0}, kExtent};
  if (random.chance(0.5f)) {
    const auto x = random.below(30), y = random.below(20);
    r.area = {{static_cast<int32_t>(x), static_cast<int32_t>(y)}, {1 + random.below(30), 1 + random.below(26)}};
  }
  r.dynamic = random.chance(0.5f);
  return r;
}

/// A stored number as an integer of the format, or a float's bits.
struct Plane {
  VkImageAspectFlagBits aspect;
  uint32_t largest;  ///< 0: floats
};

uint32_t stored(const Plane& plane, uint32_t word) {
  if (plane.aspect == VK_IMAGE_ASPECT_STENCIL_BIT || plane.largest == 0) return word;
  return static_cast<uint32_t>(std::lround(static_cast<double>(std::bit_cast<float>(word)) * plane.largest));
}

uint32_t reduce(const Plane& plane, VkResolveModeFlagBits mode, const std::vector<uint32_t>& samples) {
  const bool floats = plane.largest == 0;
  const auto less = [&](uint32_t a, uint32_t b) {
    return floats ? std::bit_cast<float>(a) < std::bit_cast<float>(b) : a < b;
  };
  const auto count = static_cast<uint32_t>(samples.size());
  switch (mode) {
    case VK_RESOLVE_MODE_MIN_BIT:
      return *std::min_element(samples.begin(), samples.end(), less);
    case VK_RESOLVE_MODE_MAX_BIT:
      return *std::max_element(samples.begin(), samples.end(), less);
    case VK_RESOLVE_MODE_AVERAGE_BIT:
      if (floats) {
        float sum = 0;
        for (const uint32_t s : samples) sum += std::bit_cast<float>(s);
        return std::bit_cast<uint32_t>(sum / static_cast<float>(count));
      } else {
        uint64_t sum = 0;
        for (const uint32_t s : samples) sum += s;
        return static_cast<uint32_t>((2 * sum + count) / (2 * count));
      }
    default:
      return samples[0];
  }
}

/// Draws random triangles with depth and stencil writes inside a scope that `begin` and `end` make.
template <class Begin, class End>
void draw(Run& run, VkPipeline pipeline, Begin begin, End end) {
  std::vector<float> values;
  for (int i = 0; i < 30; ++i) {
    for (const float v : {run.random.real(-1.2f, 1.2f), run.random.real(-1.2f, 1.2f), run.random.unit(), 1.0f})
      values.push_back(v);
    values.insert(values.end(), 4, 1.0f);
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 30, 1, 0, 0);
    end(cmd);
  });
}

GraphicsSpec triangles() {
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = spec.depth.stencilTestEnable = VK_TRUE;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_INVERT, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 1};
  return spec;
}

constexpr VkClearValue kClear{.depthStencil = {0.9f, 60}};

void in_render_pass(Run& run, const Resolve& r, const Image& source, const Image& target) {
  VkAttachmentDescription2 attachments[2];
  for (const Image* image : {&source, &target}) {
    VkAttachmentDescription2& a = attachments[image == &target];
    a = {VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2};
    a.format = r.format;
    a.samples = image->spec.samples;
    a.loadOp = a.stencilLoadOp = image == &source ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    a.initialLayout = a.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  }
  const auto reference = [&](uint32_t index) {
    return VkAttachmentReference2{VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2, nullptr, index, VK_IMAGE_LAYOUT_GENERAL,
                                  source.aspects()};
  };
  const VkAttachmentReference2 from = reference(0), to = reference(1);
  VkSubpassDescriptionDepthStencilResolve resolve{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE};
  resolve.depthResolveMode = r.depth;
  resolve.stencilResolveMode = r.stencil;
  resolve.pDepthStencilResolveAttachment = &to;
  VkSubpassDescription2 subpass{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2, &resolve};
  subpass.pDepthStencilAttachment = &from;
  VkRenderPassCreateInfo2 info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  info.attachmentCount = 2;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass;
  CTS_VK(CTS_COMMAND(run.gpu, CreateRenderPass2KHR)(run.device, &info, nullptr, &pass));
  run.own(pass, vkDestroyRenderPass);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {source.view, target.view}, kExtent);
  const VkClearValue clears[2] = {kClear, {}};
  VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  begin.renderPass = pass;
  begin.framebuffer = framebuffer;
  begin.renderArea = r.area;
  begin.clearValueCount = 2;
  begin.pClearValues = clears;
  draw(
      run, make_pipeline(run, triangles(), pass, 0, 0, kExtent, r.samples),
      [&](VkCommandBuffer cmd) { vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE); }, vkCmdEndRenderPass);
}

void in_dynamic_rendering(Run& run, const Resolve& r, const Image& source, const Image& target) {
  run.require(run.gpu.extension_features.dynamicRendering, "dynamicRendering");
  const auto attachment = [&](VkResolveModeFlagBits mode) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = source.view;
    info.imageLayout = info.resolveImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.resolveMode = mode;
    info.resolveImageView = mode ? target.view : VK_NULL_HANDLE;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.clearValue = kClear;
    return info;
  };
  const VkRenderingAttachmentInfo depth = attachment(r.depth), stencil = attachment(r.stencil);
  const bool has_depth = source.aspects() & VK_IMAGE_ASPECT_DEPTH_BIT;
  const bool has_stencil = source.aspects() & VK_IMAGE_ASPECT_STENCIL_BIT;
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea = r.area;
  rendering.layerCount = 1;
  rendering.pDepthAttachment = has_depth ? &depth : nullptr;
  rendering.pStencilAttachment = has_stencil ? &stencil : nullptr;
  VkPipelineRenderingCreateInfo formats{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  formats.depthAttachmentFormat = has_depth ? r.format : VK_FORMAT_UNDEFINED;
  formats.stencilAttachmentFormat = has_stencil ? r.format : VK_FORMAT_UNDEFINED;
  GraphicsSpec spec = triangles();
  spec.next = &formats;
  draw(
      run, make_pipeline(run, spec, VK_NULL_HANDLE, 0, 0, kExtent, r.samples),
      [&](VkCommandBuffer cmd) {
        CTS_COMMAND(run.gpu, CmdBeginRenderingKHR)
        (cmd, &rendering);
      },
      CTS_COMMAND(run.gpu, CmdEndRenderingKHR));
}

CTS_RANDOM("multisample", "random_depth_resolve", 60) {
  const Resolve r = random_resolve(run.random);
  const size_t words = size_t{kExtent.width} * kExtent.height * 4;
  std::vector<Plane> planes;
  const VkImageAspectFlags aspects = aspects_of(r.format);
  const uint32_t largest = r.format == VK_FORMAT_D16_UNORM                                                ? 0xffff
                           : r.format == VK_FORMAT_D32_SFLOAT || r.format == VK_FORMAT_D32_SFLOAT_S8_UINT ? 0
                                                                                                          : 0xffffff;
  if (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) planes.push_back({VK_IMAGE_ASPECT_DEPTH_BIT, largest});
  if (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) planes.push_back({VK_IMAGE_ASPECT_STENCIL_BIT, 255});
  if (&run.gpu != &gpus().device || gpus().same_driver) {
    for (size_t i = 0; i < planes.size(); ++i)
      put(run, "difference" + std::to_string(i), kExtent, 1, std::vector<uint32_t>(words));
    return;
  }
  ImageSpec spec;
  spec.format = r.format;
  spec.extent = {kExtent.width, kExtent.height, 1};
  spec.samples = r.samples;
  spec.usage =
      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const Image source = run.image(spec);
  // All samples are fetched, those outside of the area too.
  run.once([&](VkCommandBuffer cmd) {
    const VkImageSubresourceRange all{aspects, 0, 1, 0, 1};
    vkCmdClearDepthStencilImage(cmd, source.handle, VK_IMAGE_LAYOUT_GENERAL, &kClear.depthStencil, 1, &all);
  });
  spec.samples = VK_SAMPLE_COUNT_1_BIT;
  const Image target = run.image(spec);
  run.fill_random(target);
  std::vector<std::vector<uint32_t>> before;
  for (const Plane& plane : planes) before.push_back(fetch(run, target, plane.aspect));
  (r.dynamic ? in_dynamic_rendering : in_render_pass)(run, r, source, target);
  for (size_t i = 0; i < planes.size(); ++i) {
    const Plane& plane = planes[i];
    const VkResolveModeFlagBits mode = plane.aspect == VK_IMAGE_ASPECT_DEPTH_BIT ? r.depth : r.stencil;
    const std::vector<uint32_t> samples = fetch(run, source, plane.aspect), after = fetch(run, target, plane.aspect);
    std::vector<uint32_t> difference(words);
    for (uint32_t y = 0; y < kExtent.height; ++y)
      for (uint32_t x = 0; x < kExtent.width; ++x) {
        const size_t at = (size_t{y} * kExtent.width + x) * 4;
        std::vector<uint32_t> here;
        for (size_t s = 0; s < static_cast<size_t>(r.samples); ++s)
          here.push_back(stored(plane, samples[s * words + at]));
        const uint32_t dx = x - static_cast<uint32_t>(r.area.offset.x), dy = y - static_cast<uint32_t>(r.area.offset.y);
        const bool inside = mode && dx < r.area.extent.width && dy < r.area.extent.height;
        const uint32_t expected = inside ? reduce(plane, mode, here) : stored(plane, before[i][at]);
        const uint32_t actual = stored(plane, after[at]);
        // Numbers of 24 bits come back as floats that may lie a unit beside them (texel Resolve.* has them exactly).
        const bool near = plane.largest == 0xffffff && expected - actual + 1 <= 2;
        difference[at] = near ? 0 : expected ^ actual;
      }
    put(run, "difference" + std::to_string(i), kExtent, 1, difference);
  }
}

}  // namespace
}  // namespace vitrine::cts
