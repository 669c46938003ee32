// VkRenderPass and VkFramebuffer.
#pragma once

#include "icd/object/image.h"

namespace vitrine::icd {

struct AttachmentLayout {
  VkImageLayout main = VK_IMAGE_LAYOUT_UNDEFINED, stencil = VK_IMAGE_LAYOUT_UNDEFINED;
  bool operator==(const AttachmentLayout&) const = default;
};

struct Attachment {
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t samples = 1;
  VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_DONT_CARE;          ///< colour or depth
  VkAttachmentLoadOp stencil_load = VK_ATTACHMENT_LOAD_OP_DONT_CARE;  ///< stencil
  // What observers are told: contents that are given up.
  VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_STORE, stencil_store = VK_ATTACHMENT_STORE_OP_STORE;
  VkImageAspectFlags undefined_aspects = 0;  ///< from VK_IMAGE_LAYOUT_UNDEFINED
  AttachmentLayout initial, final;
};

/// An attachment of a subpass and the layout that it has there.
struct AttachmentReference {
  std::uint32_t attachment = VK_ATTACHMENT_UNUSED;
  AttachmentLayout layout;
};

/// A subpass dependency, as observers are told.
struct SubpassDependency {
  std::uint32_t first, second;
  VkPipelineStageFlags2 first_stages, second_stages;
  VkAccessFlags2 first_accesses, second_accesses;
};

struct Subpass {
  explicit Subpass(const HostMemory& m) : inputs(m), colors(m), resolves(m), first_uses(m), layouts(m) {}

  // Indices of attachments; VK_ATTACHMENT_UNUSED where there is none.
  Vector<std::uint32_t> inputs, colors, resolves;  ///< resolves: empty, or as many as colours
  std::uint32_t depth_stencil = VK_ATTACHMENT_UNUSED;
  std::uint32_t depth_stencil_resolve = VK_ATTACHMENT_UNUSED;
  std::uint32_t shading_rate = VK_ATTACHMENT_UNUSED;
  VkExtent2D shading_rate_texel{};  ///< pixels
  VkResolveModeFlagBits depth_resolve_mode = VK_RESOLVE_MODE_NONE, stencil_resolve_mode = VK_RESOLVE_MODE_NONE;
  std::uint32_t view_mask = 0;
  std::uint32_t forced_samples = 1;     ///< of single-sampled attachments while they are drawn to
  Vector<std::uint32_t> first_uses;     ///< attachments no earlier subpass uses: their load ops happen here
  Vector<AttachmentReference> layouts;  ///< what observers are told
};

struct RenderPass : Object<VkRenderPass, VK_OBJECT_TYPE_RENDER_PASS> {
  explicit RenderPass(const HostMemory& m) : Object(m), attachments(m), subpasses(m), dependencies(m) {}

  Vector<Attachment> attachments;
  Vector<Subpass> subpasses;
  Vector<SubpassDependency> dependencies;
};

/// The sample count of a VkMultisampledRenderToSingleSampledInfoEXT in the chain, 1 if it is off.
std::uint32_t forced_samples(const void* chain);

struct Framebuffer : Object<VkFramebuffer, VK_OBJECT_TYPE_FRAMEBUFFER> {
  explicit Framebuffer(const HostMemory& m) : Object(m), attachments(m) {}

  Vector<const ImageView*> attachments;
  std::uint32_t width = 0, height = 0, layers = 1;
};

}  // namespace vitrine::icd
