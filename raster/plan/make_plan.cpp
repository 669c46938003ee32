// The parts of a plan in the order in which they need each other.
#include "raster/plan/make_plan.h"

#include "raster/plan/fragment_operations.h"
#include "raster/plan/fragment_rates.h"
#include "raster/plan/rectangles.h"
#include "raster/plan/reference_ways.h"
#include "raster/plan/routes.h"
#include "raster/plan/stages.h"
#include "raster/plan/varyings.h"
#include "raster/plan/vertex_interface.h"
#include "raster/plan/viewports.h"

namespace vitrine::raster {
namespace {

using spirv::ShaderInterface;

const ShaderInterface* interface_of(const spirv::Shader* shader, const NativeShader* native) {
  if (native) return &native->interface;
  return shader ? &shader->interface() : nullptr;
}

}  // namespace

bool make_plan(const DrawCall& draw, const PassDesc& pass, PipelinePlan& plan) {
  plan.state = draw.state;
  plan.vertex = interface_of(draw.vertex, draw.native_vertex);
  plan.fragment = interface_of(draw.fragment, draw.native_fragment);
  if (!plan.vertex || pass.samples > kMaxSamples) return false;
  if (!plan_stages(draw, plan)) return false;
  plan_captures(plan);
  plan_vertex_inputs(plan);
  plan_vertex_outputs(plan);
  plan_rasterization(plan, pass);
  plan_fragment_rates(plan, pass);
  plan_varyings(plan);
  plan_reference_ways(plan, draw, pass);
  plan_rectangles(plan, draw, pass);
  plan_viewports(plan, pass);
  plan_tests(plan, pass);
  plan_colors(plan, pass, draw.general_path);
  // Whoever observes a draw sees what its shaders do, wherever their colours go.
  plan.shades |= plan.fragment && draw.fragment_resources.command;
  plan_routes(plan, draw.general_path, draw.observer != nullptr);
  return true;
}

}  // namespace vitrine::raster
