// Render passes and framebuffers as objects (Vulkan 1.3.239, Render Pass: Render Pass Creation, Framebuffers).
#include <algorithm>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/device.h"
#include "icd/object/render_pass.h"

namespace vitrine::icd {
namespace {

void copy_references(const VkAttachmentReference2* references, std::uint32_t count, Vector<std::uint32_t>& out) {
  for (std::uint32_t i = 0; references && i < count; ++i) out.push_back(references[i].attachment);
}

void copy_layouts(const VkAttachmentReference2* references, std::uint32_t count, Vector<AttachmentReference>& out) {
  for (std::uint32_t i = 0; references && i < count; ++i) {
    const VkAttachmentReference2& r = references[i];
    const auto* separate = find_in_chain<VkAttachmentReferenceStencilLayout>(r.pNext);
    if (r.attachment != VK_ATTACHMENT_UNUSED)
      out.push_back({r.attachment, {r.layout, separate ? separate->stencilLayout : r.layout}});
  }
}

Subpass make_subpass(const VkSubpassDescription2& info, const HostMemory& memory) {
  Subpass subpass(memory);
  copy_references(info.pInputAttachments, info.inputAttachmentCount, subpass.inputs);
  copy_references(info.pColorAttachments, info.colorAttachmentCount, subpass.colors);
  copy_references(info.pResolveAttachments, info.colorAttachmentCount, subpass.resolves);
  copy_layouts(info.pInputAttachments, info.inputAttachmentCount, subpass.layouts);
  copy_layouts(info.pColorAttachments, info.colorAttachmentCount, subpass.layouts);
  copy_layouts(info.pResolveAttachments, info.colorAttachmentCount, subpass.layouts);
  copy_layouts(info.pDepthStencilAttachment, 1, subpass.layouts);
  if (info.pDepthStencilAttachment) subpass.depth_stencil = info.pDepthStencilAttachment->attachment;
  if (const auto* resolve = find_in_chain<VkSubpassDescriptionDepthStencilResolve>(info.pNext)) {
    if (const VkAttachmentReference2* target = resolve->pDepthStencilResolveAttachment) {
      subpass.depth_stencil_resolve = target->attachment;
      copy_layouts(target, 1, subpass.layouts);
    }
    subpass.depth_resolve_mode = resolve->depthResolveMode;
    subpass.stencil_resolve_mode = resolve->stencilResolveMode;
  }
  if (const auto* rates = find_in_chain<VkFragmentShadingRateAttachmentInfoKHR>(info.pNext);
      rates && rates->pFragmentShadingRateAttachment) {
    subpass.shading_rate = rates->pFragmentShadingRateAttachment->attachment;
    subpass.shading_rate_texel = rates->shadingRateAttachmentTexelSize;
    copy_layouts(rates->pFragmentShadingRateAttachment, 1, subpass.layouts);
  }
  subpass.view_mask = info.viewMask;
  subpass.forced_samples = forced_samples(info.pNext);
  return subpass;
}

/// Fills Subpass::first_uses. With multiview, subpasses of other views use other layers: an attachment's load op is
/// then due in each subpass whose views no earlier one had; replay keeps count (icd/replay/pass.cpp).
void find_first_uses(RenderPass& pass, const HostMemory& memory) {
  Vector<std::uint32_t> views_seen(pass.attachments.size(), 0, memory);
  for (Subpass& subpass : pass.subpasses) {
    const std::uint32_t views = subpass.view_mask ? subpass.view_mask : 1;
    const auto use = [&](std::uint32_t attachment) {
      if (attachment == VK_ATTACHMENT_UNUSED || (views & ~views_seen[attachment]) == 0) return;
      views_seen[attachment] |= views;
      subpass.first_uses.push_back(attachment);
    };
    for (const auto* list : {&subpass.colors, &subpass.inputs, &subpass.resolves}) {
      std::for_each(list->begin(), list->end(), use);
    }
    use(subpass.depth_stencil);
    use(subpass.depth_stencil_resolve);
  }
}

/// The aspects that a render pass begins with in VK_IMAGE_LAYOUT_UNDEFINED.
VkImageAspectFlags undefined_aspects(const VkAttachmentDescription2& info) {
  constexpr VkImageAspectFlags kStencil = VK_IMAGE_ASPECT_STENCIL_BIT;
  const auto* separate = find_in_chain<VkAttachmentDescriptionStencilLayout>(info.pNext);
  const VkImageLayout stencil = separate ? separate->stencilInitialLayout : info.initialLayout;
  return (info.initialLayout == VK_IMAGE_LAYOUT_UNDEFINED ? ~kStencil : 0) |
         (stencil == VK_IMAGE_LAYOUT_UNDEFINED ? kStencil : 0);
}

AttachmentLayout initial_layout(const VkAttachmentDescription2& info) {
  const auto* separate = find_in_chain<VkAttachmentDescriptionStencilLayout>(info.pNext);
  return {info.initialLayout, separate ? separate->stencilInitialLayout : info.initialLayout};
}

AttachmentLayout final_layout(const VkAttachmentDescription2& info) {
  const auto* separate = find_in_chain<VkAttachmentDescriptionStencilLayout>(info.pNext);
  return {info.finalLayout, separate ? separate->stencilFinalLayout : info.finalLayout};
}

SubpassDependency make_dependency(const VkSubpassDependency2& info) {
  // A VkMemoryBarrier2 in the chain stands for the masks.
  if (const auto* barrier = find_in_chain<VkMemoryBarrier2>(info.pNext))
    return {info.srcSubpass,       info.dstSubpass,        barrier->srcStageMask,
            barrier->dstStageMask, barrier->srcAccessMask, barrier->dstAccessMask};
  return {info.srcSubpass,   info.dstSubpass,    info.srcStageMask,
          info.dstStageMask, info.srcAccessMask, info.dstAccessMask};
}

// ---- VkRenderPassCreateInfo as VkRenderPassCreateInfo2

/// The structures of the second form, made from the first; alive for one call.
struct UpgradedInfo {
  explicit UpgradedInfo(const HostMemory& m) : attachments(m), references(m), subpasses(m), dependencies(m) {}

  Vector<VkAttachmentDescription2> attachments;
  Vector<VkAttachmentReference2> references;
  Vector<VkSubpassDescription2> subpasses;
  Vector<VkSubpassDependency2> dependencies;
  VkRenderPassCreateInfo2 info = make_struct<VkRenderPassCreateInfo2>();
};

void upgrade_attachments(const VkRenderPassCreateInfo& info, UpgradedInfo& out) {
  for (std::uint32_t i = 0; i < info.attachmentCount; ++i) {
    const VkAttachmentDescription& a = info.pAttachments[i];
    VkAttachmentDescription2 b = make_struct<VkAttachmentDescription2>();
    b.flags = a.flags;
    b.format = a.format;
    b.samples = a.samples;
    b.loadOp = a.loadOp;
    b.storeOp = a.storeOp;
    b.stencilLoadOp = a.stencilLoadOp;
    b.stencilStoreOp = a.stencilStoreOp;
    b.initialLayout = a.initialLayout;
    b.finalLayout = a.finalLayout;
    out.attachments.push_back(b);
  }
}

/// Room for every reference of all subpasses, so that pointers into the vector stay valid.
std::size_t count_references(const VkRenderPassCreateInfo& info) {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < info.subpassCount; ++i) {
    count += info.pSubpasses[i].inputAttachmentCount + 2 * std::size_t{info.pSubpasses[i].colorAttachmentCount} + 1;
  }
  return count;
}

const VkAttachmentReference2* upgrade_references(const VkAttachmentReference* references, std::uint32_t count,
                                                 UpgradedInfo& out) {
  if (!references) return nullptr;
  const std::size_t first = out.references.size();
  for (std::uint32_t i = 0; i < count; ++i) {
    VkAttachmentReference2 b = make_struct<VkAttachmentReference2>();
    b.attachment = references[i].attachment;
    b.layout = references[i].layout;
    out.references.push_back(b);
  }
  return out.references.data() + first;
}

void upgrade_subpasses(const VkRenderPassCreateInfo& info, UpgradedInfo& out) {
  const auto* multiview = find_in_chain<VkRenderPassMultiviewCreateInfo>(info.pNext);
  out.references.reserve(count_references(info));
  for (std::uint32_t i = 0; i < info.subpassCount; ++i) {
    const VkSubpassDescription& a = info.pSubpasses[i];
    VkSubpassDescription2 b = make_struct<VkSubpassDescription2>();
    b.flags = a.flags;
    b.pipelineBindPoint = a.pipelineBindPoint;
    b.viewMask = multiview && i < multiview->subpassCount ? multiview->pViewMasks[i] : 0;
    b.inputAttachmentCount = a.inputAttachmentCount;
    b.pInputAttachments = upgrade_references(a.pInputAttachments, a.inputAttachmentCount, out);
    b.colorAttachmentCount = a.colorAttachmentCount;
    b.pColorAttachments = upgrade_references(a.pColorAttachments, a.colorAttachmentCount, out);
    b.pResolveAttachments = upgrade_references(a.pResolveAttachments, a.colorAttachmentCount, out);
    b.pDepthStencilAttachment = upgrade_references(a.pDepthStencilAttachment, 1, out);
    out.subpasses.push_back(b);
  }
}

void upgrade_dependencies(const VkRenderPassCreateInfo& info, UpgradedInfo& out) {
  for (std::uint32_t i = 0; i < info.dependencyCount; ++i) {
    const VkSubpassDependency& a = info.pDependencies[i];
    VkSubpassDependency2 b = make_struct<VkSubpassDependency2>();
    b.srcSubpass = a.srcSubpass;
    b.dstSubpass = a.dstSubpass;
    b.srcStageMask = a.srcStageMask;
    b.dstStageMask = a.dstStageMask;
    b.srcAccessMask = a.srcAccessMask;
    b.dstAccessMask = a.dstAccessMask;
    b.dependencyFlags = a.dependencyFlags;
    out.dependencies.push_back(b);
  }
}

}  // namespace

std::uint32_t forced_samples(const void* chain) {
  const auto* info = find_in_chain<VkMultisampledRenderToSingleSampledInfoEXT>(chain);
  return info && info->multisampledRenderToSingleSampledEnable ? static_cast<std::uint32_t>(info->rasterizationSamples)
                                                               : 1;
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateRenderPass(VkDevice device, const VkRenderPassCreateInfo* info,
                                                const VkAllocationCallbacks* allocator, VkRenderPass* pass) {
  UpgradedInfo upgraded(from_handle<Device>(device).memory);
  upgrade_attachments(*info, upgraded);
  upgrade_subpasses(*info, upgraded);
  upgraded.info.attachmentCount = info->attachmentCount;
  upgraded.info.pAttachments = upgraded.attachments.data();
  upgrade_dependencies(*info, upgraded);
  upgraded.info.dependencyCount = info->dependencyCount;
  upgraded.info.pDependencies = upgraded.dependencies.data();
  upgraded.info.subpassCount = info->subpassCount;
  upgraded.info.pSubpasses = upgraded.subpasses.data();
  return CreateRenderPass2(device, &upgraded.info, allocator, pass);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateRenderPass2(VkDevice device, const VkRenderPassCreateInfo2* info,
                                                 const VkAllocationCallbacks* allocator, VkRenderPass* pass) {
  Device& d = from_handle<Device>(device);
  Owned<RenderPass> object(create_object<RenderPass>(d.memory, allocator));
  for (std::uint32_t i = 0; i < info->attachmentCount; ++i) {
    const VkAttachmentDescription2& a = info->pAttachments[i];
    object->attachments.push_back({a.format, static_cast<std::uint32_t>(a.samples), a.loadOp, a.stencilLoadOp,
                                   a.storeOp, a.stencilStoreOp, undefined_aspects(a), initial_layout(a),
                                   final_layout(a)});
  }
  for (std::uint32_t i = 0; i < info->subpassCount; ++i) {
    object->subpasses.push_back(make_subpass(info->pSubpasses[i], object->memory));
  }
  for (std::uint32_t i = 0; i < info->dependencyCount; ++i)
    object->dependencies.push_back(make_dependency(info->pDependencies[i]));
  find_first_uses(*object, d.memory);
  *pass = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyRenderPass(VkDevice, VkRenderPass pass, const VkAllocationCallbacks*) {
  destroy_handle<RenderPass>(pass);
}

VKAPI_ATTR void VKAPI_CALL GetRenderAreaGranularity(VkDevice, VkRenderPass, VkExtent2D* granularity) {
  *granularity = {1, 1};
}

#ifdef VK_KHR_maintenance5
VKAPI_ATTR void VKAPI_CALL GetRenderingAreaGranularityKHR(VkDevice, const VkRenderingAreaInfoKHR*,
                                                          VkExtent2D* granularity) {
  *granularity = {1, 1};
}
#endif

VKAPI_ATTR VkResult VKAPI_CALL CreateFramebuffer(VkDevice device, const VkFramebufferCreateInfo* info,
                                                 const VkAllocationCallbacks* allocator, VkFramebuffer* framebuffer) {
  Owned<Framebuffer> object(create_object<Framebuffer>(from_handle<Device>(device).memory, allocator));
  const bool imageless = info->flags & VK_FRAMEBUFFER_CREATE_IMAGELESS_BIT;
  for (std::uint32_t i = 0; !imageless && i < info->attachmentCount; ++i) {
    object->attachments.push_back(from_nullable<ImageView>(info->pAttachments[i]));
  }
  object->width = info->width;
  object->height = info->height;
  object->layers = info->layers;
  *framebuffer = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyFramebuffer(VkDevice, VkFramebuffer framebuffer, const VkAllocationCallbacks*) {
  destroy_handle<Framebuffer>(framebuffer);
}

}  // namespace entry
}  // namespace vitrine::icd
