// The route of a single B8G8R8A8 attachment (lavapipe-rasterization.md 9).
#include "raster/plan/rectangles.h"

#include <algorithm>
#include <set>
#include <utility>

namespace vitrine::raster {
namespace {

using spirv::BuiltIn;
using spirv::InterfaceSlot;

/// What the reference keeps of its vertices at a time, in bytes, and those of one attribute.
constexpr std::uint32_t kBatchBytes = 4096, kAttributeBytes = 16;
/// Positions that it shades at a time: of draws without and with indices.
constexpr std::uint32_t kSegmentVertices = 4096, kSegmentIndices = 1024;

bool reads(const PipelinePlan& plan, BuiltIn built_in) {
  return plan.fragment && std::any_of(plan.fragment->inputs.begin(), plan.fragment->inputs.end(),
                                      [=](const InterfaceSlot& slot) { return slot.built_in == built_in; });
}

bool makes_triangles(const PipelinePlan& plan) {
  if (plan.stages.geometry) return plan.corners == 3;
  const VkPrimitiveTopology topology = plan.state->topology;
  return topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST || topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP ||
         topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
}

bool has_guard_band(const PipelinePlan& plan, const PassDesc& pass) {
  if (pass.color_count != 1 || !pass.color[0].format || !pass.plain_image || pass.samples > 1) return false;
  if (pass.color[0].format->format != VK_FORMAT_B8G8R8A8_UNORM) return false;
  if (pass.depth.format || pass.stencil.format) return false;
  return plan.out.viewport_index == kNoReg && !reads(plan, BuiltIn::kViewportIndex);
}

/// Attributes of the reference's vertices between clipping and setup: the position, what the fragment shader reads by
/// location, and what rasterization takes of the last stage.
std::uint32_t attributes_of(const PipelinePlan& plan) {
  std::uint32_t count = 1 + (plan.out.point_size != kNoReg) + (plan.out.layer != kNoReg);
  if (!plan.fragment) return count;
  std::set<std::pair<BuiltIn, std::uint32_t>> read;
  for (const InterfaceSlot& slot : plan.fragment->inputs) {
    if (slot.implied) continue;
    switch (slot.built_in) {
      case BuiltIn::kNone:
        read.emplace(slot.built_in, slot.location);
        break;
      case BuiltIn::kClipDistance:
      case BuiltIn::kCullDistance:
        read.emplace(slot.built_in, slot.component / 4);
        break;
      case BuiltIn::kFragCoord:
      case BuiltIn::kPointCoord:
      case BuiltIn::kFrontFacing:
        read.emplace(slot.built_in, 0);
        break;
      default:
        break;
    }
  }
  return count + static_cast<std::uint32_t>(read.size());
}

}  // namespace

bool reads_flat(const PipelinePlan& plan) {
  if (!plan.fragment) return false;
  return std::any_of(plan.fragment->inputs.begin(), plan.fragment->inputs.end(), [](const InterfaceSlot& slot) {
    const bool numbers = slot.built_in == BuiltIn::kLayer || slot.built_in == BuiltIn::kPrimitiveId;
    const bool by_location = slot.built_in == BuiltIn::kNone;
    return !slot.implied && (numbers || (by_location && (slot.type != spirv::BaseType::kFloat ||
                                                         slot.interpolation == spirv::Interpolation::kFlat)));
  });
}

std::uint32_t segment_of(const TopologyShape& shape, bool indexed) {
  const std::uint32_t positions = indexed ? kSegmentIndices : kSegmentVertices;
  return (positions - shape.first) / shape.step + 1;
}

void plan_rectangles(PipelinePlan& plan, const DrawCall& draw, const PassDesc& pass) {
  plan.guard_band = has_guard_band(plan, pass);
  plan.rectangles = {};
  plan.rectangles.batch_vertices = kBatchBytes / (kAttributeBytes * attributes_of(plan));
  if (!plan.guard_band || !makes_triangles(plan) || plan.stages.evaluation || plan.bias_in_vertices) return;
  if (plan.overestimates) return;
  if (plan.rates.any && plan.out.shading_rate != kNoReg) return;  // the two may have different ones
  if (reads_flat(plan) || plan.numbers_corners) return;
  plan.rectangles.any = true;
  const std::uint32_t segment = segment_of(plan.shape, draw.index_data != nullptr);
  plan.rectangles.segment = plan.shape.step == 1 ? segment & ~1u : segment;  // strips keep an even number
  if (plan.stages.geometry) {
    plan.rectangles.segment = segment;
    plan.chunk_positions = 1;  // a chunk for each: all of its primitives, or none, go through the clipper
  }
}

}  // namespace vitrine::raster
