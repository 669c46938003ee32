// The state of a random draw in words, for the notes of a case that fails.
#include "cases/pipeline/state/draw_state.h"

namespace vitrine::cts {

using namespace std::string_literals;

std::string describe(const Scene& scene, const DrawState& draw) {
  std::string text;
  const auto add = [&](const char* what, auto value) {
    text += what;
    text += " ";
    text += std::to_string(value);
    text += "\n";
  };
  const GraphicsSpec& spec = draw.spec;
  for (const VkFormat format : scene.target.colors) text += format_info(format).name + "\n"s;
  if (scene.target.depth) text += format_info(scene.target.depth).name + "\n"s;
  add("samples", scene.target.samples);
  add("view mask", scene.target.view_mask);
  add("dynamic rendering", scene.dynamic_rendering);
  add("suspends", scene.suspends);
  add("secondary", scene.secondary);
  add("resolves depth", scene.resolves_depth);
  add("unrestricted depth", scene.unrestricted);
  add("topology", draw.stages.topology);
  text += "tessellation " + draw.stages.tessellation + "\ngeometry " + draw.stages.geometry + "\n";
  add("polygon mode", spec.raster.polygonMode);
  add("line mode", draw.line.lineRasterizationMode);
  add("stippled", draw.line.stippledLineEnable);
  add("line width", spec.raster.lineWidth);
  add("cull", spec.raster.cullMode);
  add("front face", spec.raster.frontFace);
  add("provoking", draw.provoking.provokingVertexMode);
  add("clipped", draw.clipped);
  add("clip distances", draw.stages.clip_distances);
  add("cull distances", draw.stages.cull_distances);
  add("layers", draw.stages.layers);
  add("viewports", draw.stages.viewports);
  add("rasterizer discard", spec.raster.rasterizerDiscardEnable);
  add("depth bias", spec.raster.depthBiasEnable);
  add("depth clamp", spec.raster.depthClampEnable);
  add("negative one to one", spec.viewport_next != nullptr);
  add("depth test", spec.depth.depthTestEnable);
  add("depth write", spec.depth.depthWriteEnable);
  add("depth compare", spec.depth.depthCompareOp);
  add("stencil test", spec.depth.stencilTestEnable);
  add("logic op", spec.blend.logicOpEnable ? static_cast<int>(spec.blend.logicOp) : -1);
  add("alpha to coverage", spec.multisample.alphaToCoverageEnable);
  add("alpha to one", spec.multisample.alphaToOneEnable);
  add("sample mask", draw.sample_mask);
  add("sample shading", spec.multisample.sampleShadingEnable);
  for (const VkPipelineColorBlendAttachmentState& b : spec.blends)
    text += "blend " + std::to_string(b.blendEnable) + " color " + std::to_string(b.srcColorBlendFactor) + " " +
            std::to_string(b.colorBlendOp) + " " + std::to_string(b.dstColorBlendFactor) + " alpha " +
            std::to_string(b.srcAlphaBlendFactor) + " " + std::to_string(b.alphaBlendOp) + " " +
            std::to_string(b.dstAlphaBlendFactor) + " mask " + std::to_string(b.colorWriteMask) + "\n";
  add("vertices", draw.vertices);
  add("instances", draw.instances);
  add("captured", draw.stages.captured);
  add("queried", draw.queried);
  add("indirect", draw.indirect);
  add("conditional", draw.conditional ? static_cast<int>(draw.predicate + 2 * draw.predicate_flags) : -1);
  for (const VkBool32 write : draw.color_writes) add("color write", write);
  add("domain origin", draw.origin.domainOrigin);
  for (const VkViewport& v : spec.viewports)
    text += "viewport " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.width) + " " +
            std::to_string(v.height) + " depth " + std::to_string(v.minDepth) + " " + std::to_string(v.maxDepth) + "\n";
  return text + spec.vertex + spec.evaluation + spec.geometry + spec.fragment;
}

}  // namespace vitrine::cts
