// See needs.h (Vulkan 1.3.239, Features). A driver that lacks a feature ignores what asks for it: it would give other
// bytes, and nobody would know why.
#include "glass/replayer/needs.h"

#include <algorithm>

#include "glass/bug/contents.h"

namespace vitrine::glass::replayer {
namespace {

using bug::Bug;

bool has_stage(const Bug& bug, VkShaderStageFlagBits stage) {
  return std::ranges::any_of(bug.stages, [&](const bug::Stage& s) { return s.stage == stage; });
}

bool is_of_second_source(VkBlendFactor factor) {
  return factor >= VK_BLEND_FACTOR_SRC1_COLOR && factor <= VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA;
}

bool blends_second_source(const Bug& bug) {
  return std::any_of(bug.state.blend.begin(), bug.state.blend.begin() + static_cast<long>(bug.rendering.colors.size()),
                     [](const raster::BlendAttachment& b) {
                       return b.enable && (is_of_second_source(b.src_color) || is_of_second_source(b.dst_color) ||
                                           is_of_second_source(b.src_alpha) || is_of_second_source(b.dst_alpha));
                     });
}

/// Whether fragments may cover several pixels, by the pipeline, by an attachment or by a shader whose rates are
/// combined with the pipeline's.
bool has_shading_rate(const Bug& bug) {
  const VkExtent2D size = bug.state.fragment_size;
  return bug.rendering.rate != bug::kNone || size.width != 1 || size.height != 1 ||
         bug.state.rate_combiners[0] != VK_FRAGMENT_SHADING_RATE_COMBINER_OP_KEEP_KHR;
}

/// Whether descriptors of a binding are of several types. If they are of one, the binding can be of it.
bool has_mixed_bindings(const Bug& bug) {
  for (std::uint32_t set = 0; set < bug.sets.size(); ++set)
    for (const bug::Binding& binding : bug.sets[set].bindings)
      if (bug::plain_type(bug, set, binding) == VK_DESCRIPTOR_TYPE_MUTABLE_EXT) return true;
  return false;
}

struct CoreNeed {
  VkBool32 VkPhysicalDeviceFeatures::*feature;
  const char* name;
  bool (*is_there)(const Bug& bug);
};

constexpr CoreNeed kCore[] = {
    {&VkPhysicalDeviceFeatures::depthBounds, "depthBounds",
     [](const Bug& b) { return b.state.depth_bounds_test && b.rendering.depth != bug::kNone; }},
    {&VkPhysicalDeviceFeatures::depthClamp, "depthClamp", [](const Bug& b) { return b.state.depth_clamp; }},
    {&VkPhysicalDeviceFeatures::fillModeNonSolid, "fillModeNonSolid",
     [](const Bug& b) { return b.state.polygon_mode != VK_POLYGON_MODE_FILL; }},
    {&VkPhysicalDeviceFeatures::wideLines, "wideLines", [](const Bug& b) { return b.state.line_width != 1; }},
    {&VkPhysicalDeviceFeatures::logicOp, "logicOp", [](const Bug& b) { return b.state.logic_op_enable; }},
    {&VkPhysicalDeviceFeatures::alphaToOne, "alphaToOne", [](const Bug& b) { return b.state.alpha_to_one; }},
    {&VkPhysicalDeviceFeatures::sampleRateShading, "sampleRateShading",
     [](const Bug& b) { return b.state.sample_shading; }},
    {&VkPhysicalDeviceFeatures::multiViewport, "multiViewport",
     [](const Bug& b) { return b.state.viewport_count > 1; }},
    {&VkPhysicalDeviceFeatures::geometryShader, "geometryShader",
     [](const Bug& b) { return has_stage(b, VK_SHADER_STAGE_GEOMETRY_BIT); }},
    {&VkPhysicalDeviceFeatures::tessellationShader, "tessellationShader",
     [](const Bug& b) { return has_stage(b, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT); }},
    {&VkPhysicalDeviceFeatures::dualSrcBlend, "dualSrcBlend", blends_second_source},
    {&VkPhysicalDeviceFeatures::multiDrawIndirect, "multiDrawIndirect",
     [](const Bug& b) { return b.command.arguments != bug::kNone && b.command.draw_count > 1; }},
};

}  // namespace

const Need kNeeds[13] = {
    {VK_EXT_MUTABLE_DESCRIPTOR_TYPE_EXTENSION_NAME, has_mixed_bindings, false},
    {VK_KHR_FRAGMENT_SHADING_RATE_EXTENSION_NAME, has_shading_rate},
    {VK_EXT_DEPTH_CLIP_CONTROL_EXTENSION_NAME, [](const Bug& b) { return b.state.negative_one_to_one; }},
    {VK_EXT_DEPTH_CLIP_ENABLE_EXTENSION_NAME, [](const Bug& b) { return b.state.depth_clip == b.state.depth_clamp; }},
    {VK_EXT_BLEND_OPERATION_ADVANCED_EXTENSION_NAME,
     [](const Bug& b) {
       return std::ranges::any_of(b.state.blend, [](const auto& blend) { return blend.enable && blend.advances(); });
     }},
    {VK_EXT_DISCARD_RECTANGLES_EXTENSION_NAME, [](const Bug& b) { return b.state.discard_count != 0; }},
    {VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME, [](const Bug& b) { return b.state.overestimates; }},
    {VK_EXT_PROVOKING_VERTEX_EXTENSION_NAME, [](const Bug& b) { return b.state.provoking_vertex_last; }},
    {VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME,
     [](const Bug& b) { return b.state.line_mode != VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT || b.state.line_stipple; }},
    {VK_EXT_VERTEX_ATTRIBUTE_DIVISOR_EXTENSION_NAME,
     [](const Bug& b) {
       return std::ranges::any_of(b.streams, [](const bug::Stream& s) { return s.per_instance && s.divisor != 1; });
     }},
    {VK_EXT_SAMPLE_LOCATIONS_EXTENSION_NAME, [](const Bug& b) { return b.state.custom_locations; }},
    {VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME,
     [](const Bug& b) { return !b.feedback.empty() || b.state.rasterized_stream != 0; }},
    {VK_EXT_MULTI_DRAW_EXTENSION_NAME, [](const Bug& b) { return b.command.draws.size() > 1; }},
};

const char* missing_feature(const Bug& bug, const VkPhysicalDeviceFeatures& has) {
  if (bug.dispatches()) return nullptr;
  for (const CoreNeed& need : kCore)
    if (need.is_there(bug) && !(has.*need.feature)) return need.name;
  return nullptr;
}

}  // namespace vitrine::glass::replayer
