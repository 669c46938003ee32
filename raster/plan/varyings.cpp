// Interface matching (Vulkan 1.3.239, Interface Matching): fragment shader inputs meet the outputs of the last stage
// before rasterization.
#include "raster/plan/varyings.h"

#include <algorithm>

namespace vitrine::raster {
namespace {

using spirv::BuiltIn;
using spirv::InterfaceSlot;
using spirv::Interpolation;

bool is_varying(const InterfaceSlot& slot) {
  switch (slot.built_in) {
    case BuiltIn::kNone:
    case BuiltIn::kClipDistance:
    case BuiltIn::kCullDistance:
    case BuiltIn::kLayer:
    case BuiltIn::kViewportIndex:
    case BuiltIn::kBaryCoord:
    case BuiltIn::kBaryCoordNoPersp:
      return true;
    default:
      return false;
  }
}

std::uint8_t corner_of(const InterfaceSlot& slot) {
  if (slot.built_in == BuiltIn::kBaryCoord || slot.built_in == BuiltIn::kBaryCoordNoPersp) return slot.component;
  if (!is_of_vertex(slot.part)) return Varying::kAnyCorner;
  return static_cast<std::uint8_t>(static_cast<int>(slot.part) - static_cast<int>(spirv::InputPart::kVertex0));
}

std::uint32_t matching_output(const PipelinePlan& plan, const InterfaceSlot& input) {
  for (const InterfaceSlot& slot : *plan.outputs) {
    const bool same =
        slot.stream == rasterized_stream(plan) && slot.built_in == input.built_in && slot.component == input.component;
    if (same && (slot.built_in != BuiltIn::kNone || slot.location == input.location)) return slot.reg;
  }
  return kNoReg;
}

Interpolation interpolation_of(const InterfaceSlot& slot) {
  const bool raw = slot.built_in == BuiltIn::kLayer || slot.built_in == BuiltIn::kViewportIndex;
  return raw || slot.type != spirv::BaseType::kFloat ? Interpolation::kFlat : slot.interpolation;
}

bool same_varying(const InterfaceSlot& a, const InterfaceSlot& b) {
  return a.built_in == b.built_in && a.component == b.component && a.location == b.location &&
         interpolation_of(a) == interpolation_of(b) && corner_of(a) == corner_of(b);
}

/// Slots that name the same component share a varying.
void add_varyings(PipelinePlan& plan, Interpolation interpolation, std::uint32_t& count) {
  const std::vector<InterfaceSlot>& inputs = plan.fragment->inputs;
  const std::uint32_t first_read = plan.read_count;
  const std::uint32_t most = interpolation == Interpolation::kFlat ? kMaxRecordVaryings : kMaxVaryings;
  std::array<std::uint16_t, kMaxVaryingReads> source;  // index in inputs, per read
  for (std::size_t i = 0; i < inputs.size() && plan.read_count < kMaxVaryingReads; ++i) {
    const InterfaceSlot& slot = inputs[i];
    if (!is_varying(slot) || interpolation_of(slot) != interpolation) continue;
    std::uint32_t known = first_read;
    while (known < plan.read_count && !same_varying(inputs[source[known]], slot)) ++known;
    const bool added = known == plan.read_count;
    if (added && plan.varying_count() == most) continue;
    const std::uint32_t varying = added ? plan.varying_count() : plan.read[known].varying;
    if (added) {
      plan.varying[varying] = {matching_output(plan, slot), interpolation, corner_of(slot)};
      plan.numbers_corners |= corner_of(slot) != Varying::kAnyCorner;
      ++count;
    }
    source[plan.read_count] = static_cast<std::uint16_t>(i);
    const spirv::InputPart part = is_of_vertex(slot.part) ? spirv::InputPart::kValue : slot.part;
    plan.read[plan.read_count++] = {slot.reg, static_cast<std::uint16_t>(varying), slot.sample_location, part};
  }
}

void plan_fragment_inputs(PipelinePlan& plan) {
  FragmentRegisters& frag = plan.frag;
  for (const InterfaceSlot& slot : plan.fragment->inputs) {
    switch (slot.built_in) {
      case BuiltIn::kFragCoord:
        frag.frag_coord[slot.component & 3] = slot.reg;
        break;
      case BuiltIn::kPointCoord:
        frag.point_coord[slot.component & 1] = slot.reg;
        break;
      case BuiltIn::kSamplePosition:
        frag.sample_position[slot.component & 1] = slot.reg;
        break;
      case BuiltIn::kInterpolationCenter:
        frag.interpolation_center[slot.component & 1] = slot.reg;
        break;
      case BuiltIn::kInterpolationSample:
        if (slot.component < frag.interpolation_sample.size()) frag.interpolation_sample[slot.component] = slot.reg;
        break;
      case BuiltIn::kInterpolationScale:
        frag.interpolation_scale = slot.reg;
        break;
      case BuiltIn::kFrontFacing:
        frag.front_facing = slot.reg;
        break;
      case BuiltIn::kSampleId:
        frag.sample_id = slot.reg;
        break;
      case BuiltIn::kSampleMask:
        frag.sample_mask_in = slot.reg;
        break;
      case BuiltIn::kPrimitiveId:
        frag.primitive_id = slot.reg;
        break;
      case BuiltIn::kHelperInvocation:
        frag.helper = slot.reg;
        break;
      case BuiltIn::kShadingRate:
        frag.shading_rate = slot.reg;
        break;
      case BuiltIn::kViewIndex:
        frag.view_index = slot.reg;
        break;
      default:
        break;
    }
  }
}

void plan_fragment_outputs(PipelinePlan& plan) {
  FragmentRegisters& frag = plan.frag;
  for (const InterfaceSlot& slot : plan.fragment->outputs) {
    switch (slot.built_in) {
      case BuiltIn::kNone:
        if (slot.index == 1)
          frag.color_second[slot.component & 3] = slot.reg;
        else if (slot.location < kMaxColorAttachments)
          frag.color[slot.location][slot.component & 3] = slot.reg;
        break;
      case BuiltIn::kFragDepth:
        frag.depth = slot.reg;
        break;
      case BuiltIn::kFragStencilRef:
        frag.stencil = slot.reg;
        break;
      case BuiltIn::kSampleMask:
        frag.sample_mask = slot.reg;
        break;
      default:
        break;
    }
  }
}

/// gl_PointSize travels with the vertices through the clipper, like an output no fragment shader reads
/// (lavapipe-rasterization.md 1.5).
void add_point_size(PipelinePlan& plan) {
  const State& state = *plan.state;
  const bool points = plan.corners == 1 || state.polygon_mode == VK_POLYGON_MODE_POINT;
  plan.point_size_word = kNoReg;
  if (!points || plan.out.point_size == kNoReg || plan.perspective_count == kMaxVaryings) return;
  plan.varying[plan.perspective_count] = {plan.out.point_size, Interpolation::kPerspective};
  plan.point_size_word = 4 + plan.perspective_count++;
}

}  // namespace

void plan_varyings(PipelinePlan& plan) {
  plan.perspective_count = plan.linear_count = plan.flat_count = plan.read_count = 0;
  plan.numbers_corners = false;
  FragmentRegisters& frag = plan.frag;
  frag = {};
  frag.frag_coord.fill(kNoReg);
  frag.point_coord.fill(kNoReg);
  frag.sample_position.fill(kNoReg);
  frag.interpolation_center.fill(kNoReg);
  frag.interpolation_sample.fill(kNoReg);
  for (auto& color : frag.color) color.fill(kNoReg);
  frag.color_second.fill(kNoReg);
  if (plan.fragment) {
    plan_fragment_inputs(plan);
    plan_fragment_outputs(plan);
    add_varyings(plan, Interpolation::kPerspective, plan.perspective_count);
  }
  add_point_size(plan);
  plan.smooth_lines &= plan.varying_count() + 4 <= kMaxVaryings;
  for (std::uint32_t i = 0; i < (plan.smooth_lines ? 4u : 0u); ++i)
    plan.varying[plan.perspective_count++] = {kNoReg, Interpolation::kPerspective};
  if (plan.fragment) {
    add_varyings(plan, Interpolation::kLinear, plan.linear_count);
    add_varyings(plan, Interpolation::kFlat, plan.flat_count);
  }
  std::stable_sort(plan.read.begin(), plan.read.begin() + plan.read_count,
                   [](const VaryingRead& a, const VaryingRead& b) {
                     if (a.part != b.part) return a.part < b.part;
                     return a.location < b.location;
                   });
  plan.vertex_stride = (4 + plan.varying_count() + 3) & ~3u;
}

}  // namespace vitrine::raster
