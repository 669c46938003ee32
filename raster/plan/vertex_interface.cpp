// Sources of vertex shader inputs; built-in outputs of the last stage before rasterization.
#include "raster/plan/vertex_interface.h"

#include <algorithm>

#include "texel/format.h"

namespace vitrine::raster {
namespace {

using spirv::BuiltIn;
using spirv::InterfaceSlot;

VertexInput::Source source_of(BuiltIn built_in) {
  switch (built_in) {
    case BuiltIn::kVertexIndex:
      return VertexInput::Source::kVertexIndex;
    case BuiltIn::kInstanceIndex:
      return VertexInput::Source::kInstanceIndex;
    case BuiltIn::kBaseVertex:
      return VertexInput::Source::kBaseVertex;
    case BuiltIn::kBaseInstance:
      return VertexInput::Source::kBaseInstance;
    case BuiltIn::kDrawIndex:
      return VertexInput::Source::kDrawIndex;
    case BuiltIn::kViewIndex:
      return VertexInput::Source::kViewIndex;
    default:
      return VertexInput::Source::kZero;
  }
}

}  // namespace

void plan_vertex_inputs(PipelinePlan& plan) {
  const State& state = *plan.state;
  plan.vertex_input_count = 0;
  for (const InterfaceSlot& slot : plan.vertex->inputs) {
    if (plan.vertex_input_count == plan.vertex_input.size()) break;
    VertexInput& input = plan.vertex_input[plan.vertex_input_count++];
    input = {};
    input.reg = slot.reg;
    input.component = slot.component;
    if (slot.built_in != BuiltIn::kNone) {
      input.source = source_of(slot.built_in);
      continue;
    }
    for (std::uint32_t i = 0; i < state.attribute_count; ++i) {
      const std::uint32_t first = state.attribute[i].location;
      // Three or four 64-bit components take two locations.
      const bool second = slot.location == first + 1 && texel::format_desc(state.attribute[i].format).block_bytes > 16;
      if (slot.location != first && !second) continue;
      input.source = VertexInput::Source::kAttribute;
      input.attribute = static_cast<std::uint8_t>(i);
      input.component = static_cast<std::uint8_t>(slot.component + (second ? 4 : 0));
    }
  }
  // Components of one attribute next to each other: it is fetched once.
  std::stable_sort(plan.vertex_input.begin(), plan.vertex_input.begin() + plan.vertex_input_count,
                   [](const VertexInput& a, const VertexInput& b) {
                     if (a.source != b.source) return a.source < b.source;
                     return a.attribute < b.attribute;
                   });
}

void plan_vertex_outputs(PipelinePlan& plan) {
  VertexOutputs& out = plan.out;
  out = {};
  out.position.fill(kNoReg);
  out.clip_distance.fill(kNoReg);
  out.cull_distance.fill(kNoReg);
  for (const InterfaceSlot& slot : *plan.outputs) {
    if (slot.stream != rasterized_stream(plan)) continue;
    switch (slot.built_in) {
      case BuiltIn::kPosition:
        out.position[slot.component & 3] = slot.reg;
        break;
      case BuiltIn::kPointSize:
        out.point_size = slot.reg;
        break;
      case BuiltIn::kClipDistance:
        out.clip_distance[slot.component & 7] = slot.reg;
        out.clip_count = std::max<std::uint32_t>(out.clip_count, (slot.component & 7u) + 1);
        break;
      case BuiltIn::kCullDistance:
        out.cull_distance[slot.component & 7] = slot.reg;
        out.cull_count = std::max<std::uint32_t>(out.cull_count, (slot.component & 7u) + 1);
        break;
      case BuiltIn::kLayer:
        out.layer = slot.reg;
        break;
      case BuiltIn::kViewportIndex:
        out.viewport_index = slot.reg;
        break;
      case BuiltIn::kPrimitiveShadingRate:
        out.shading_rate = slot.reg;
        break;
      case BuiltIn::kPrimitiveId:
        out.primitive_id = slot.reg;
        break;
      default:
        break;
    }
  }
}

}  // namespace vitrine::raster
