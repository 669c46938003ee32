// Rendering in a few lines: render targets with their render pass, and graphics pipelines with defaults.
#pragma once

#include <optional>

#include "harness/run.h"

namespace vitrine::cts {

struct TargetSpec {
  std::vector<VkFormat> colors{VK_FORMAT_R8G8B8A8_UNORM};
  VkFormat depth = VK_FORMAT_UNDEFINED;
  uint32_t width = 64, height = 64, layers = 1;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_CLEAR;
  VkImageCreateFlags depth_flags = 0;  ///< of the depth attachment's image
  bool resolve = false;                ///< adds a resolve attachment for every colour attachment
  uint32_t view_mask = 0;              ///< the layers that every draw goes to; 0: no multiview
};

/// Attachments with a one-subpass render pass and a framebuffer.
struct Target {
  TargetSpec spec;
  std::vector<Image> colors, resolves;
  std::optional<Image> depth;
  VkRenderPass pass = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  std::vector<VkClearValue> clears;  ///< may be changed before begin()

  void begin(VkCommandBuffer cmd, VkSubpassContents contents = VK_SUBPASS_CONTENTS_INLINE) const;
  void begin(VkCommandBuffer cmd, VkRect2D area, VkSubpassContents contents = VK_SUBPASS_CONTENTS_INLINE) const;
  VkRect2D rect() const { return {{0, 0}, {spec.width, spec.height}}; }
};

/// A clear value of the right kind for a format.
VkClearValue clear_value(VkFormat format, float r, float g, float b, float a);
/// `probe`: allows sRGB colours even where the reference's encoding is not the recorded one.
Target make_target(Run& run, const TargetSpec& spec, bool probe = false);
/// A target of `layers` layers of one colour image, whose texels it loads and keeps.
Target make_target_of(Run& run, const Image& image, uint32_t layers = 1);
/// Adds every attachment (and resolve attachment) to the outputs.
void out_target(Run& run, const Target& target);

/// A graphics pipeline as Vulkan's own structures, filled with the plainest values.
struct GraphicsSpec {
  std::string vertex, fragment;               ///< GLSL; no fragment shader if empty
  std::string control, evaluation, geometry;  ///< GLSL; no such stage if empty
  VkPipelineTessellationStateCreateInfo tessellation{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
  VkShaderModule vertex_module = VK_NULL_HANDLE, fragment_module = VK_NULL_HANDLE;  ///< used instead if set
  VkPipelineLayout layout = VK_NULL_HANDLE;                                         ///< an empty one is made if null
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  const void* input_next = nullptr;     ///< pNext of the vertex input state
  const void* viewport_next = nullptr;  ///< pNext of the viewport state
  std::vector<VkViewport> viewports;    ///< the whole target if empty
  std::vector<VkRect2D> scissors;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  std::vector<VkPipelineColorBlendAttachmentState> blends;  ///< one per colour attachment; opaque if empty
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  std::vector<VkDynamicState> dynamic;
  const VkSpecializationInfo* vertex_special = nullptr;
  const VkSpecializationInfo* fragment_special = nullptr;
  VkPipelineCache cache = VK_NULL_HANDLE;
  const void* next = nullptr;  ///< of VkGraphicsPipelineCreateInfo
  VkPipelineCreateFlags flags = 0;

  GraphicsSpec();
  /// Adds a binding of tightly interleaved float attributes at locations 0..: one number of components each.
  void floats(const std::vector<uint32_t>& components, VkVertexInputRate rate = VK_VERTEX_INPUT_RATE_VERTEX);
};

VkRenderPass make_render_pass(Run& run, const VkRenderPassCreateInfo& info);
VkFramebuffer make_framebuffer(Run& run, VkRenderPass pass, const std::vector<VkImageView>& views, VkExtent2D extent,
                               uint32_t layers = 1);
VkQueryPool make_query_pool(Run& run, VkQueryType type, uint32_t count, VkQueryPipelineStatisticFlags statistics = 0);

VkPipeline make_pipeline(Run& run, const GraphicsSpec& spec, const Target& target);
VkPipeline make_pipeline(Run& run, const GraphicsSpec& spec, VkRenderPass pass, uint32_t subpass, uint32_t colors,
                         VkExtent2D extent, VkSampleCountFlagBits samples);

void bind_pipeline(VkCommandBuffer cmd, VkPipeline pipeline);
void bind_vertices(VkCommandBuffer cmd, const Buffer& buffer, uint32_t binding = 0);
/// A pass of one draw without vertex buffers, run at once: the default is a triangle over everything.
void draw_once(Run& run, const Target& target, VkPipeline pipeline, const Resources* resources = nullptr,
               uint32_t vertices = 3);

/// A triangle over everything at depth 0.5; also passes `vec2 uv` (0..1) at location 0.
extern const char kFullScreenVertex[];
/// vec4 position at location 0, vec4 colour at location 1, passed on at location 0. Point size 1.
extern const char kColorVertex[];
extern const char kColorFragment[];

}  // namespace vitrine::cts
