// Random draws in which the reference is known to be wrong: which row of deviations.md they are, and what the same draw
// is without it.
#include <algorithm>

#include "cases/pipeline/state/draw_state.h"

namespace vitrine::cts {
namespace {

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// The polygon's facing must not be seen: neither by the shader nor by the stencil test.
void hide_facing(DrawState& draw) {
  replace_all(draw.spec.fragment, "gl_FrontFacing", "true");
  draw.spec.depth.back = draw.spec.depth.front;
}

bool sees_facing(const DrawState& draw) {
  return contains(draw.spec.fragment, "gl_FrontFacing") || draw.spec.depth.stencilTestEnable;
}

/// The reference draws the lines with its stage of smooth lines; it does not in a multisampled pass if they are
/// outlines.
bool stage_of_smooth_lines(const Scene& scene, const DrawState& draw) {
  return smooth_lines(draw) && !(scene.multisampled && draw.polygon);
}

/// The diamond rule takes less than a pixel from each end of a line, and so may leave a line that has no pixel corner
/// in its bounding box of one that is shorter than three pixels. Vertices are 0.14 of the volume's half apart.
bool short_bresenham_outlines(const Scene& scene, const DrawState& draw) {
  const auto shorter = static_cast<float>(std::min(scene.target.width, scene.target.height));
  return scene.multisampled && draw.polygon && draws_lines_as(draw, VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT) &&
         0.14f * 0.5f * shorter < 3.0f;
}

}  // namespace

bool draws_lines_as(const DrawState& draw, VkLineRasterizationModeEXT mode) {
  return draw.drawn == Drawn::kLines && draw.line.lineRasterizationMode == mode;
}

bool smooth_lines(const DrawState& draw) {
  return draws_lines_as(draw, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT);
}

bool one_sample_lines(const Scene& scene, const DrawState& draw) {
  return scene.multisampled && (smooth_lines(draw) || draws_lines_as(draw, VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT));
}

std::vector<std::string> remove_listed(const Scene& scene, DrawState& draw) {
  std::vector<std::string> rows;
  Stages& stages = draw.stages;
  std::string& fragment = draw.spec.fragment;
  const bool tessellated = !stages.tessellation.empty(), geometry = !stages.geometry.empty();
  if (stages.clip_distances + stages.cull_distances > 4) {
    rows.push_back("cull-distances-beyond-four");
    stages.cull_distances = 4 - stages.clip_distances;
    write_stages(stages, draw.spec);
  }
  if (tessellated && !geometry && stages.viewports > 1) {
    rows.push_back("tessellated-viewports");
    replace_all(draw.spec.evaluation, "gl_ViewportIndex = (gl_PrimitiveID)", "gl_ViewportIndex = (1)");
  }
  if (!geometry && contains(draw.spec.evaluation, "gl_PrimitiveID") && contains(fragment, "gl_PrimitiveID")) {
    rows.push_back("tessellation-primitive-id");
    replace_all(fragment, "gl_PrimitiveID", "3");
  }
  if (one_sample_lines(scene, draw) && !draw.polygon && contains(fragment, "gl_SampleMaskIn")) {
    rows.push_back("one-sample-line-masks");
    replace_all(fragment, "gl_SampleMaskIn[0]", "15");
  }
  if (draw.queried && one_sample_lines(scene, draw)) {
    rows.push_back("one-sample-line-masks");
    draw.queried = false;
  }
  if (draw.queried && draw.spec.raster.rasterizerDiscardEnable) {
    rows.push_back("discarded-clipping-invocations");
    draw.queried = false;
  }
  if (draw.queried && draw.vertices > 1000) {
    rows.push_back("long-strip-vertices");
    draw.queried = false;
  }
  const bool kills = draw.fragment.discards || draw.fragment.writes_mask || draw.spec.multisample.alphaToCoverageEnable;
  if (draw.queried && draw.fragment.early && kills && !fragment.empty()) {
    rows.push_back("early-sample-counting");
    draw.queried = false;
  }
  if (scene.multisampled && draw.polygon && draw.drawn == Drawn::kLines && geometry) {
    rows.push_back("multisample-short-lines");
    draw.spec.raster.polygonMode = VK_POLYGON_MODE_FILL;
    draw.drawn = Drawn::kTriangles;
    draw.line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;  // line-state-depth-bias
    return rows;
  }
  if (short_bresenham_outlines(scene, draw)) {
    rows.push_back("multisample-short-lines");
    draw.line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
  }
  if (draw.polygon && tessellated && contains(fragment, "gl_FrontFacing")) {
    rows.push_back("geometry-polygon-facing");
    hide_facing(draw);
  }
  if (!stage_of_smooth_lines(scene, draw)) return rows;
  if (draw.polygon && sees_facing(draw)) {
    rows.push_back("smooth-outline-facing");
    hide_facing(draw);
  }
  if (draw.spec.raster.depthClampEnable && draw.spec.depth.depthTestEnable) {
    rows.push_back("smooth-line-depth-clamp");
    draw.spec.raster.depthClampEnable = VK_FALSE;
  }
  if (scene.unrestricted && draw.spec.depth.depthTestEnable) {
    rows.push_back("smooth-line-depth-clamp");
    draw.line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
  }
  if (contains(fragment, "gl_PrimitiveID")) {
    rows.push_back("smooth-line-vertices");
    replace_all(fragment, "gl_PrimitiveID", "3");
  }
  if (tessellated || geometry) {
    rows.push_back("smooth-line-vertices");
    draw.line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
  }
  return rows;
}

}  // namespace vitrine::cts
