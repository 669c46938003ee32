// Pipelines: everything in them is static, since the file has the state as it was for the command.
#include "glass/replayer/pipeline.h"

#include <algorithm>
#include <deque>

namespace vitrine::glass::replayer {
namespace {

using bug::kNone;

bool has_stage(const bug::Bug& bug, VkShaderStageFlagBits stage) {
  return std::any_of(bug.stages.begin(), bug.stages.end(), [&](const bug::Stage& s) { return s.stage == stage; });
}

VkFormat format_of(const bug::Bug& bug, std::uint32_t view) {
  return view == kNone ? VK_FORMAT_UNDEFINED : bug.views[view].format;
}

VkStencilOpState face(const raster::StencilFace& f) {
  return {f.fail, f.pass, f.depth_fail, f.compare, f.compare_mask, f.write_mask, f.reference};
}

/// Adds a structure in front of a chain.
template <class T>
void chain(const void*& first, T& structure) {
  structure.pNext = first;
  first = &structure;
}

/// The structures of one pipeline, which point at each other.
class GraphicsInfo {
 public:
  GraphicsInfo(const Device& device, const bug::Bug& bug) : bug_(bug), s_(bug.state), device_(device) {
    vertex_input();
    before_rasterization();
    rasterization();
    multisample();
    depth_stencil();
    blend();
    rendering();
  }
  GraphicsInfo(const GraphicsInfo&) = delete;
  GraphicsInfo& operator=(const GraphicsInfo&) = delete;

  VkGraphicsPipelineCreateInfo info(VkPipelineLayout layout);

 private:
  void vertex_input();
  void before_rasterization();
  void rasterization();
  void multisample();
  void depth_stencil();
  void blend();
  void rendering();

  const bug::Bug& bug_;
  const raster::State& s_;
  const Device& device_;
  std::deque<StageInfo> kept_;
  std::vector<VkPipelineShaderStageCreateInfo> stages_;
  std::vector<VkVertexInputBindingDescription> bindings_;
  std::vector<VkVertexInputAttributeDescription> attributes_;
  std::vector<VkVertexInputBindingDivisorDescriptionEXT> divisors_;
  VkPipelineVertexInputDivisorStateCreateInfoEXT divisor_{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_DIVISOR_STATE_CREATE_INFO_EXT};
  VkPipelineVertexInputStateCreateInfo input_{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly_{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineTessellationDomainOriginStateCreateInfo origin_{
      VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO};
  VkPipelineTessellationStateCreateInfo tessellation_{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
  VkPipelineViewportDepthClipControlCreateInfoEXT control_{
      VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT};
  VkPipelineViewportStateCreateInfo viewport_{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  VkPipelineRasterizationDepthClipStateCreateInfoEXT clip_{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT};
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking_{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
  VkPipelineRasterizationLineStateCreateInfoEXT lines_{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
  VkPipelineRasterizationStateStreamCreateInfoEXT stream_{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_STREAM_CREATE_INFO_EXT};
  VkPipelineRasterizationConservativeStateCreateInfoEXT conservative_{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_CONSERVATIVE_STATE_CREATE_INFO_EXT};
  VkPipelineDiscardRectangleStateCreateInfoEXT discard_{
      VK_STRUCTURE_TYPE_PIPELINE_DISCARD_RECTANGLE_STATE_CREATE_INFO_EXT};
  VkPipelineFragmentShadingRateStateCreateInfoKHR rate_{
      VK_STRUCTURE_TYPE_PIPELINE_FRAGMENT_SHADING_RATE_STATE_CREATE_INFO_KHR};
  VkPipelineRasterizationStateCreateInfo rasterization_{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  std::vector<VkSampleLocationEXT> locations_;
  VkPipelineSampleLocationsStateCreateInfoEXT custom_{
      VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT};
  VkPipelineMultisampleStateCreateInfo multisample_{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth_stencil_{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  std::vector<VkPipelineColorBlendAttachmentState> blends_;
  VkPipelineColorBlendAdvancedStateCreateInfoEXT advanced_{
      VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_ADVANCED_STATE_CREATE_INFO_EXT};
  VkPipelineColorBlendStateCreateInfo blend_{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  std::vector<VkFormat> formats_;
  VkPipelineRenderingCreateInfo rendering_{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
};

void GraphicsInfo::vertex_input() {
  for (const bug::Stream& s : bug_.streams) {
    bindings_.push_back(
        {s.binding, s.stride, s.per_instance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
    if (s.per_instance && s.divisor != 1) divisors_.push_back({s.binding, s.divisor});
  }
  for (std::uint32_t i = 0; i < s_.attribute_count; ++i) {
    const raster::VertexAttribute& a = s_.attribute[i];
    attributes_.push_back({a.location, a.binding, a.format, a.offset});
  }
  input_.vertexBindingDescriptionCount = static_cast<std::uint32_t>(bindings_.size());
  input_.pVertexBindingDescriptions = bindings_.data();
  input_.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes_.size());
  input_.pVertexAttributeDescriptions = attributes_.data();
  divisor_.vertexBindingDivisorCount = static_cast<std::uint32_t>(divisors_.size());
  divisor_.pVertexBindingDivisors = divisors_.data();
  if (!divisors_.empty()) chain(input_.pNext, divisor_);
}

void GraphicsInfo::before_rasterization() {
  assembly_.topology = s_.topology;
  assembly_.primitiveRestartEnable = s_.primitive_restart;
  tessellation_.patchControlPoints = s_.patch_control_points;
  origin_.domainOrigin = VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT;
  if (s_.domain_origin_lower_left) chain(tessellation_.pNext, origin_);
  viewport_.viewportCount = viewport_.scissorCount = std::max(s_.viewport_count, 1u);
  viewport_.pViewports = s_.viewport.data();
  viewport_.pScissors = s_.scissor.data();
  control_.negativeOneToOne = VK_TRUE;
  if (s_.negative_one_to_one) chain(viewport_.pNext, control_);
}

void GraphicsInfo::rasterization() {
  rasterization_.depthClampEnable = s_.depth_clamp;
  rasterization_.rasterizerDiscardEnable = s_.rasterizer_discard;
  rasterization_.polygonMode = s_.polygon_mode;
  rasterization_.cullMode = s_.cull_mode;
  rasterization_.frontFace = s_.front_face;
  rasterization_.depthBiasEnable = s_.depth_bias;
  rasterization_.depthBiasConstantFactor = s_.depth_bias_constant;
  rasterization_.depthBiasClamp = s_.depth_bias_clamp;
  rasterization_.depthBiasSlopeFactor = s_.depth_bias_slope;
  rasterization_.lineWidth = s_.line_width;
  clip_.depthClipEnable = s_.depth_clip;
  if (s_.depth_clip == s_.depth_clamp) chain(rasterization_.pNext, clip_);
  provoking_.provokingVertexMode = VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
  if (s_.provoking_vertex_last) chain(rasterization_.pNext, provoking_);
  lines_.lineRasterizationMode = s_.line_mode;
  lines_.stippledLineEnable = s_.line_stipple;
  lines_.lineStippleFactor = s_.line_stipple_factor;
  lines_.lineStipplePattern = s_.line_stipple_pattern;
  if (s_.line_mode != VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT || s_.line_stipple) chain(rasterization_.pNext, lines_);
  stream_.rasterizationStream = s_.rasterized_stream;
  if (s_.rasterized_stream != 0) chain(rasterization_.pNext, stream_);
  conservative_.conservativeRasterizationMode = VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT;
  if (s_.overestimates) chain(rasterization_.pNext, conservative_);
}

void GraphicsInfo::multisample() {
  multisample_.rasterizationSamples = static_cast<VkSampleCountFlagBits>(s_.samples);
  multisample_.sampleShadingEnable = s_.sample_shading;
  multisample_.minSampleShading = s_.min_sample_shading;
  multisample_.pSampleMask = &s_.sample_mask;
  multisample_.alphaToCoverageEnable = s_.alpha_to_coverage;
  multisample_.alphaToOneEnable = s_.alpha_to_one;
  for (std::uint32_t i = 0; i < s_.locations.count; ++i)
    locations_.push_back({s_.locations.pixel_x(i), s_.locations.pixel_y(i)});
  custom_.sampleLocationsEnable = VK_TRUE;
  custom_.sampleLocationsInfo = {VK_STRUCTURE_TYPE_SAMPLE_LOCATIONS_INFO_EXT,
                                 nullptr,
                                 static_cast<VkSampleCountFlagBits>(std::max(s_.locations.count, 1u)),
                                 {1, 1},
                                 static_cast<std::uint32_t>(locations_.size()),
                                 locations_.data()};
  if (s_.custom_locations) chain(multisample_.pNext, custom_);
}

void GraphicsInfo::depth_stencil() {
  depth_stencil_.depthTestEnable = s_.depth_test;
  depth_stencil_.depthWriteEnable = s_.depth_write;
  depth_stencil_.depthCompareOp = s_.depth_compare;
  depth_stencil_.depthBoundsTestEnable = s_.depth_bounds_test;
  depth_stencil_.minDepthBounds = s_.min_depth_bounds;
  depth_stencil_.maxDepthBounds = s_.max_depth_bounds;
  depth_stencil_.stencilTestEnable = s_.stencil_test;
  depth_stencil_.front = face(s_.front);
  depth_stencil_.back = face(s_.back);
}

void GraphicsInfo::blend() {
  for (std::size_t i = 0; i < bug_.rendering.colors.size(); ++i) {
    const raster::BlendAttachment& b = s_.blend[i];
    blends_.push_back(
        {b.enable, b.src_color, b.dst_color, b.color_op, b.src_alpha, b.dst_alpha, b.alpha_op, b.write_mask});
  }
  blend_.logicOpEnable = s_.logic_op_enable;
  blend_.logicOp = s_.logic_op;
  blend_.attachmentCount = static_cast<std::uint32_t>(blends_.size());
  blend_.pAttachments = blends_.data();
  advanced_.srcPremultiplied = s_.blend[0].src_premultiplied;
  advanced_.dstPremultiplied = s_.blend[0].dst_premultiplied;
  advanced_.blendOverlap = s_.blend[0].overlap;
  if (s_.blend[0].enable && s_.blend[0].advances()) chain(blend_.pNext, advanced_);
  std::copy(s_.blend_constants.begin(), s_.blend_constants.end(), blend_.blendConstants);
  if (s_.ordered_attachment_access && device_.has(VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME))
    blend_.flags |= VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT;
}

void GraphicsInfo::rendering() {
  for (const std::uint32_t view : bug_.rendering.colors) formats_.push_back(format_of(bug_, view));
  rendering_.viewMask = bug_.rendering.view_mask;
  rendering_.colorAttachmentCount = static_cast<std::uint32_t>(formats_.size());
  rendering_.pColorAttachmentFormats = formats_.data();
  rendering_.depthAttachmentFormat = format_of(bug_, bug_.rendering.depth);
  rendering_.stencilAttachmentFormat = format_of(bug_, bug_.rendering.stencil);
  discard_.discardRectangleMode =
      s_.discard_inside ? VK_DISCARD_RECTANGLE_MODE_EXCLUSIVE_EXT : VK_DISCARD_RECTANGLE_MODE_INCLUSIVE_EXT;
  discard_.discardRectangleCount = s_.discard_count;
  discard_.pDiscardRectangles = s_.discard.data();
  if (s_.discard_count != 0) chain(rendering_.pNext, discard_);
  rate_.fragmentSize = s_.fragment_size;
  std::copy(s_.rate_combiners.begin(), s_.rate_combiners.end(), rate_.combinerOps);
  if (device_.has(VK_KHR_FRAGMENT_SHADING_RATE_EXTENSION_NAME)) chain(rendering_.pNext, rate_);
}

VkGraphicsPipelineCreateInfo GraphicsInfo::info(VkPipelineLayout layout) {
  for (const bug::Stage& stage : bug_.stages) {
    kept_.emplace_back(device_, stage);
    stages_.push_back(kept_.back().info());
  }
  VkGraphicsPipelineCreateInfo out{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  out.pNext = &rendering_;
  if (bug_.rendering.rate != kNone) out.flags |= VK_PIPELINE_CREATE_RENDERING_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
  out.stageCount = static_cast<std::uint32_t>(stages_.size());
  out.pStages = stages_.data();
  out.pVertexInputState = &input_;
  out.pInputAssemblyState = &assembly_;
  if (has_stage(bug_, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT)) out.pTessellationState = &tessellation_;
  out.pViewportState = &viewport_;
  out.pRasterizationState = &rasterization_;
  out.pMultisampleState = &multisample_;
  out.pDepthStencilState = &depth_stencil_;
  out.pColorBlendState = &blend_;
  out.layout = layout;
  return out;
}

}  // namespace

StageInfo::StageInfo(const Device& d, const bug::Stage& stage) {
  VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  module.codeSize = bug::size_of(stage.words);
  module.pCode = reinterpret_cast<const std::uint32_t*>(stage.words->data());
  must(vkCreateShaderModule(d.device, &module, nullptr, &info_.module), "vkCreateShaderModule");
  constants_ = {static_cast<std::uint32_t>(stage.constants.size()), stage.constants.data(),
                bug::size_of(stage.constant_data), stage.constant_data ? stage.constant_data->data() : nullptr};
  info_.stage = stage.stage;
  info_.pName = stage.entry_point.c_str();
  info_.pSpecializationInfo = &constants_;
  size_.requiredSubgroupSize = stage.subgroup_size;
  if (stage.subgroup_size) info_.pNext = &size_;
}

VkPipeline make_compute_pipeline(const Device& d, const bug::Bug& bug, VkPipelineLayout layout) {
  const StageInfo stage(d, bug.stages[0]);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  const auto& base = bug.command.base;
  if (base[0] || base[1] || base[2]) info.flags = VK_PIPELINE_CREATE_DISPATCH_BASE_BIT;
  info.stage = stage.info();
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  must(vkCreateComputePipelines(d.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "vkCreateComputePipelines");
  set_name(d, VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), bug.pipeline);
  return pipeline;
}

VkPipeline make_graphics_pipeline(const Device& d, const bug::Bug& bug, VkPipelineLayout layout) {
  GraphicsInfo graphics(d, bug);
  const VkGraphicsPipelineCreateInfo info = graphics.info(layout);
  VkPipeline pipeline = VK_NULL_HANDLE;
  must(vkCreateGraphicsPipelines(d.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "vkCreateGraphicsPipelines");
  set_name(d, VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), bug.pipeline);
  return pipeline;
}

}  // namespace vitrine::glass::replayer
