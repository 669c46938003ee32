// Dynamic state: names, and where each state lies in raster::State.
#include "icd/record/dynamic_state.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vitrine::icd {
namespace {

struct Name {
  VkDynamicState vulkan;
  DynamicState state;
};
constexpr Name kNames[] = {
    {VK_DYNAMIC_STATE_VIEWPORT, DynamicState::kViewport},
    {VK_DYNAMIC_STATE_SCISSOR, DynamicState::kScissor},
    {VK_DYNAMIC_STATE_LINE_WIDTH, DynamicState::kLineWidth},
    {VK_DYNAMIC_STATE_DEPTH_BIAS, DynamicState::kDepthBias},
    {VK_DYNAMIC_STATE_BLEND_CONSTANTS, DynamicState::kBlendConstants},
    {VK_DYNAMIC_STATE_DEPTH_BOUNDS, DynamicState::kDepthBounds},
    {VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK, DynamicState::kStencilCompareMask},
    {VK_DYNAMIC_STATE_STENCIL_WRITE_MASK, DynamicState::kStencilWriteMask},
    {VK_DYNAMIC_STATE_STENCIL_REFERENCE, DynamicState::kStencilReference},
    {VK_DYNAMIC_STATE_CULL_MODE, DynamicState::kCullMode},
    {VK_DYNAMIC_STATE_FRONT_FACE, DynamicState::kFrontFace},
    {VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY, DynamicState::kTopology},
    {VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT, DynamicState::kViewportCount},
    {VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT, DynamicState::kScissorCount},
    {VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE, DynamicState::kVertexStride},
    {VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE, DynamicState::kDepthTestEnable},
    {VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE, DynamicState::kDepthWriteEnable},
    {VK_DYNAMIC_STATE_DEPTH_COMPARE_OP, DynamicState::kDepthCompareOp},
    {VK_DYNAMIC_STATE_DEPTH_BOUNDS_TEST_ENABLE, DynamicState::kDepthBoundsTestEnable},
    {VK_DYNAMIC_STATE_STENCIL_TEST_ENABLE, DynamicState::kStencilTestEnable},
    {VK_DYNAMIC_STATE_STENCIL_OP, DynamicState::kStencilOp},
    {VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE, DynamicState::kRasterizerDiscardEnable},
    {VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE, DynamicState::kDepthBiasEnable},
    {VK_DYNAMIC_STATE_PRIMITIVE_RESTART_ENABLE, DynamicState::kPrimitiveRestartEnable},
    {VK_DYNAMIC_STATE_LINE_STIPPLE_EXT, DynamicState::kLineStipple},
    {VK_DYNAMIC_STATE_VERTEX_INPUT_EXT, DynamicState::kVertexInput},
    {VK_DYNAMIC_STATE_PATCH_CONTROL_POINTS_EXT, DynamicState::kPatchControlPoints},
    {VK_DYNAMIC_STATE_LOGIC_OP_EXT, DynamicState::kLogicOp},
    {VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT, DynamicState::kColorWriteEnable},
    {VK_DYNAMIC_STATE_TESSELLATION_DOMAIN_ORIGIN_EXT, DynamicState::kTessellationDomainOrigin},
    {VK_DYNAMIC_STATE_DEPTH_CLAMP_ENABLE_EXT, DynamicState::kDepthClampEnable},
    {VK_DYNAMIC_STATE_POLYGON_MODE_EXT, DynamicState::kPolygonMode},
    {VK_DYNAMIC_STATE_RASTERIZATION_SAMPLES_EXT, DynamicState::kRasterizationSamples},
    {VK_DYNAMIC_STATE_SAMPLE_MASK_EXT, DynamicState::kSampleMask},
    {VK_DYNAMIC_STATE_ALPHA_TO_COVERAGE_ENABLE_EXT, DynamicState::kAlphaToCoverageEnable},
    {VK_DYNAMIC_STATE_ALPHA_TO_ONE_ENABLE_EXT, DynamicState::kAlphaToOneEnable},
    {VK_DYNAMIC_STATE_LOGIC_OP_ENABLE_EXT, DynamicState::kLogicOpEnable},
    {VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT, DynamicState::kBlendEnable},
    {VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT, DynamicState::kBlendEquation},
    {VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT, DynamicState::kWriteMask},
    {VK_DYNAMIC_STATE_DEPTH_CLIP_ENABLE_EXT, DynamicState::kDepthClipEnable},
    {VK_DYNAMIC_STATE_PROVOKING_VERTEX_MODE_EXT, DynamicState::kProvokingVertexMode},
    {VK_DYNAMIC_STATE_LINE_RASTERIZATION_MODE_EXT, DynamicState::kLineRasterizationMode},
    {VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT, DynamicState::kLineStippleEnable},
    {VK_DYNAMIC_STATE_DEPTH_CLIP_NEGATIVE_ONE_TO_ONE_EXT, DynamicState::kDepthClipNegativeOneToOne},
    {VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT, DynamicState::kSampleLocations},
    {VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_ENABLE_EXT, DynamicState::kSampleLocationsEnable},
};

/// Calls f(member, member) for the member that a one-word state is. `from` and `to` may be one state.
template <class F>
void visit_word(DynamicState which, F f) {
  using S = raster::State;
  switch (which) {
    case DynamicState::kLineWidth:
      return f(&S::line_width);
    case DynamicState::kBlendConstants:
      return f(&S::blend_constants);
    case DynamicState::kSampleMask:
      return f(&S::sample_mask);
    case DynamicState::kCullMode:
      return f(&S::cull_mode);
    case DynamicState::kFrontFace:
      return f(&S::front_face);
    case DynamicState::kTopology:
      return f(&S::topology);
    case DynamicState::kPatchControlPoints:
      return f(&S::patch_control_points);
    case DynamicState::kTessellationDomainOrigin:
      return f(&S::domain_origin_lower_left);
    case DynamicState::kDepthTestEnable:
      return f(&S::depth_test);
    case DynamicState::kDepthWriteEnable:
      return f(&S::depth_write);
    case DynamicState::kDepthCompareOp:
      return f(&S::depth_compare);
    case DynamicState::kDepthBoundsTestEnable:
      return f(&S::depth_bounds_test);
    case DynamicState::kStencilTestEnable:
      return f(&S::stencil_test);
    case DynamicState::kRasterizerDiscardEnable:
      return f(&S::rasterizer_discard);
    case DynamicState::kDepthBiasEnable:
      return f(&S::depth_bias);
    case DynamicState::kPrimitiveRestartEnable:
      return f(&S::primitive_restart);
    case DynamicState::kLogicOp:
      return f(&S::logic_op);
    case DynamicState::kLogicOpEnable:
      return f(&S::logic_op_enable);
    case DynamicState::kDepthClampEnable:
      return f(&S::depth_clamp);
    case DynamicState::kDepthClipEnable:
      return f(&S::depth_clip);
    case DynamicState::kPolygonMode:
      return f(&S::polygon_mode);
    case DynamicState::kRasterizationSamples:
      return f(&S::samples);
    case DynamicState::kAlphaToCoverageEnable:
      return f(&S::alpha_to_coverage);
    case DynamicState::kAlphaToOneEnable:
      return f(&S::alpha_to_one);
    case DynamicState::kProvokingVertexMode:
      return f(&S::provoking_vertex_last);
    case DynamicState::kLineRasterizationMode:
      return f(&S::line_mode);
    case DynamicState::kLineStippleEnable:
      return f(&S::line_stipple);
    case DynamicState::kDepthClipNegativeOneToOne:
      return f(&S::negative_one_to_one);
    case DynamicState::kSampleLocations:
      return f(&S::locations);
    case DynamicState::kSampleLocationsEnable:
      return f(&S::custom_locations);
    default:
      return;
  }
}

void copy_stencil(const raster::StencilFace& from, DynamicState which, raster::StencilFace& to) {
  if (which == DynamicState::kStencilCompareMask) to.compare_mask = from.compare_mask;
  if (which == DynamicState::kStencilWriteMask) to.write_mask = from.write_mask;
  if (which == DynamicState::kStencilReference) to.reference = from.reference;
  if (which != DynamicState::kStencilOp) return;
  to.fail = from.fail;
  to.pass = from.pass;
  to.depth_fail = from.depth_fail;
  to.compare = from.compare;
}

void copy_blend(const raster::BlendAttachment& from, DynamicState which, raster::BlendAttachment& to) {
  if (which == DynamicState::kBlendEnable) to.enable = from.enable;
  if (which == DynamicState::kWriteMask) to.write_mask = from.write_mask;
  if (which != DynamicState::kBlendEquation) return;
  const bool enable = to.enable;
  const VkColorComponentFlags mask = to.write_mask;
  to = from;
  to.enable = enable;
  to.write_mask = mask;
}

}  // namespace

DynamicState dynamic_state_of(VkDynamicState state) {
  const auto* found =
      std::find_if(std::begin(kNames), std::end(kNames), [&](const Name& name) { return name.vulkan == state; });
  return found == std::end(kNames) ? DynamicState::kCount : found->state;
}

VkGraphicsPipelineLibraryFlagBitsEXT part_of(DynamicState state) {
  switch (state) {
    case DynamicState::kVertexStride:
    case DynamicState::kVertexInput:
    case DynamicState::kTopology:
    case DynamicState::kPrimitiveRestartEnable:
      return VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT;
    case DynamicState::kDepthBounds:
    case DynamicState::kStencilCompareMask:
    case DynamicState::kStencilWriteMask:
    case DynamicState::kStencilReference:
    case DynamicState::kStencilOp:
    case DynamicState::kDepthTestEnable:
    case DynamicState::kDepthWriteEnable:
    case DynamicState::kDepthCompareOp:
    case DynamicState::kDepthBoundsTestEnable:
    case DynamicState::kStencilTestEnable:
      return VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT;
    case DynamicState::kBlendConstants:
    case DynamicState::kSampleMask:
    case DynamicState::kBlendEnable:
    case DynamicState::kBlendEquation:
    case DynamicState::kWriteMask:
    case DynamicState::kColorWriteEnable:
    case DynamicState::kLogicOp:
    case DynamicState::kLogicOpEnable:
    case DynamicState::kRasterizationSamples:
    case DynamicState::kAlphaToCoverageEnable:
    case DynamicState::kAlphaToOneEnable:
    case DynamicState::kSampleLocations:
    case DynamicState::kSampleLocationsEnable:
      return VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT;
    default:
      return VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT;
  }
}

void set_value(raster::State& state, DynamicState which, std::uint32_t value) {
  visit_word(which, [&](auto member) {
    using T = std::remove_reference_t<decltype(state.*member)>;
    if constexpr (std::is_same_v<T, bool>) {
      state.*member = value != 0;
    } else if constexpr (std::is_enum_v<T> || std::is_integral_v<T>) {
      state.*member = static_cast<T>(value);
    }
  });
}

void copy_state(const raster::State& from, DynamicState which, raster::State& to) {
  switch (which) {
    case DynamicState::kViewportCount:
      to.viewport_count = from.viewport_count;
      [[fallthrough]];
    case DynamicState::kViewport:
      to.viewport = from.viewport;
      return;
    case DynamicState::kScissor:
    case DynamicState::kScissorCount:
      to.scissor = from.scissor;
      return;
    case DynamicState::kDepthBias:
      to.depth_bias_constant = from.depth_bias_constant;
      to.depth_bias_clamp = from.depth_bias_clamp;
      to.depth_bias_slope = from.depth_bias_slope;
      return;
    case DynamicState::kDepthBounds:
      to.min_depth_bounds = from.min_depth_bounds;
      to.max_depth_bounds = from.max_depth_bounds;
      return;
    case DynamicState::kStencilCompareMask:
    case DynamicState::kStencilWriteMask:
    case DynamicState::kStencilReference:
    case DynamicState::kStencilOp:
      copy_stencil(from.front, which, to.front);
      copy_stencil(from.back, which, to.back);
      return;
    case DynamicState::kBlendEnable:
    case DynamicState::kBlendEquation:
    case DynamicState::kWriteMask:
      for (std::size_t i = 0; i < to.blend.size(); ++i) copy_blend(from.blend[i], which, to.blend[i]);
      return;
    case DynamicState::kLineStipple:
      to.line_stipple_factor = from.line_stipple_factor;
      to.line_stipple_pattern = from.line_stipple_pattern;
      return;
    case DynamicState::kVertexInput:
      to.attribute_count = from.attribute_count;
      to.attribute = from.attribute;
      return;
    default:
      visit_word(which, [&](auto member) { to.*member = from.*member; });
  }
}

raster::SampleLocations sample_locations(const VkSampleLocationsInfoEXT& info) {
  const auto count = static_cast<std::uint32_t>(info.sampleLocationsPerPixel);
  if (count == 0 || count > raster::kMaxSamples || info.sampleLocationsCount < count)
    return raster::standard_locations(count);
  raster::SampleLocations out{count, {}, {}};
  const auto place = [](float v) {
    return v > 0 ? 16 * static_cast<std::int32_t>(std::lround(std::min(16 * v, 15.0f))) : 0;
  };
  for (std::uint32_t i = 0; i < raster::kMaxSamples; ++i) {
    const VkSampleLocationEXT& location = info.pSampleLocations[std::min(i, count - 1)];
    out.x[i] = place(location.x);
    out.y[i] = place(location.y);
  }
  return out;
}

void apply_color_writes(raster::State& state, ColorWrites writes) {
  for (std::uint32_t i = 0; i < raster::kMaxColorAttachments; ++i) {
    if (!(writes >> i & 1)) state.blend[i].write_mask = 0;
  }
}

}  // namespace vitrine::icd
