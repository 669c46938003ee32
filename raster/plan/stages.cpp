// The stages between the vertex shader and rasterization (Vulkan 1.3.239, Tessellation; Geometry Shading; Transform
// Feedback).
#include "raster/plan/stages.h"

#include <algorithm>

#include "spirv/stage_memory.h"

namespace vitrine::raster {
namespace {

using spirv::BuiltIn;
using spirv::InterfaceSlot;
using spirv::ShaderInterface;

/// Vertices that a patch is expected to become, and primitives of a chunk at least.
constexpr std::uint32_t kTessellationGrowth = 256, kMinPrimitives = 64;

/// Locations of a vertex, in words behind its header.
std::uint32_t vertex_words(const std::vector<InterfaceSlot>& outputs, const ShaderInterface& reader) {
  std::uint32_t locations = reader.modes.input_locations;
  for (const InterfaceSlot& slot : outputs)
    if (slot.built_in == BuiltIn::kNone) locations = std::max<std::uint32_t>(locations, slot.location + 1u);
  return spirv::kVertexHeaderWords + 4 * locations;
}

/// "The tessellation modes may be specified in either stage" (Vulkan 1.3.239, Tessellation).
spirv::StageModes merge_modes(const spirv::StageModes& control, const spirv::StageModes& evaluation) {
  spirv::StageModes modes = evaluation;
  if (!modes.has_domain) modes.domain = control.domain;
  // Where neither stage says, which Vulkan forbids, this is what the reference makes of it.
  if (!modes.has_spacing) modes.spacing = control.has_spacing ? control.spacing : spirv::TessSpacing::kFractionalEven;
  if (!modes.has_order) modes.clockwise = !control.has_order || control.clockwise;
  modes.point_mode |= control.point_mode;
  modes.control_points = std::max(control.control_points, evaluation.control_points);
  modes.vertex_words = control.vertex_words;
  modes.patch_words = control.patch_words;
  return modes;
}

bool reads(const ShaderInterface& shader, BuiltIn built_in) {
  return std::any_of(shader.inputs.begin(), shader.inputs.end(),
                     [=](const InterfaceSlot& slot) { return slot.built_in == built_in; });
}

}  // namespace

bool plan_stages(const DrawCall& draw, PipelinePlan& plan) {
  StagePlan& stages = plan.stages;
  stages.control = draw.control ? &draw.control->interface() : nullptr;
  stages.evaluation = draw.control && draw.evaluation ? &draw.evaluation->interface() : nullptr;
  stages.geometry = draw.geometry ? &draw.geometry->interface() : nullptr;
  plan.shape = topology_shape(draw);
  plan.corners = plan.shape.corners;
  plan.outputs = &plan.vertex->outputs;
  plan.chunk_positions = kChunkPositions;
  plan.position_weight = 1;
  plan.counts_primitives = false;
  if (!stages.any()) return true;
  if (plan.corners == 0) return false;
  std::uint32_t growth = 1;
  if (stages.evaluation) {
    stages.vertex_words = vertex_words(plan.vertex->outputs, *stages.control);
    stages.tessellation = merge_modes(stages.control->modes, stages.evaluation->modes);
    if (stages.tessellation.control_points == 0) return false;
    plan.outputs = &stages.evaluation->outputs;
    const bool lines = stages.tessellation.domain == spirv::TessDomain::kIsolines;
    plan.corners = stages.tessellation.point_mode ? 1 : lines ? 2 : 3;
    growth = kTessellationGrowth;
  }
  if (stages.geometry) {
    const spirv::StageModes& modes = stages.geometry->modes;
    (stages.evaluation ? stages.evaluation_words : stages.vertex_words) = vertex_words(*plan.outputs, *stages.geometry);
    plan.outputs = &stages.geometry->emitted;
    plan.corners = topology_of(modes.output).shape.corners;
    // "The index is incremented after every individual point, line, or triangle primitive is processed" (Vulkan
    // 1.3.239, PrimitiveId): those of the tessellator, not patches.
    plan.counts_primitives = stages.evaluation && reads(*stages.geometry, BuiltIn::kPrimitiveId);
    growth *= std::max<std::uint32_t>(modes.max_vertices * modes.invocations, 1);
  }
  plan.position_weight = std::max(growth / plan.shape.step, 1u);
  plan.chunk_positions = std::max(kChunkPositions / plan.position_weight, kMinPrimitives * plan.shape.step);
  return true;
}

void plan_captures(PipelinePlan& plan) {
  const spirv::ShaderInterface& last = plan.stages.geometry     ? *plan.stages.geometry
                                       : plan.stages.evaluation ? *plan.stages.evaluation
                                                                : *plan.vertex;
  plan.capture_begin.fill(0);
  if (!last.captures) return;
  std::copy_n(last.xfb_stride, spirv::kMaxXfbBuffers, plan.xfb_stride.begin());
  std::uint32_t number = 0;
  for (std::uint32_t stream = 0; stream < kMaxStreams; ++stream) {
    for (const spirv::InterfaceSlot& slot : *plan.outputs) {
      if (slot.stream != stream || slot.xfb_buffer >= spirv::kMaxXfbBuffers || number == plan.capture.size()) continue;
      plan.capture[number++] = {slot.reg, slot.xfb_offset, slot.xfb_buffer};
    }
    plan.capture_begin[stream + 1] = number;
  }
}

}  // namespace vitrine::raster
