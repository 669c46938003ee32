// Random fixed-function state: topologies and stages, polygon and line modes, depth, stencil, blending, samples, all
// crossed with each other. Excluded is only what deviations.md lists.
#include <algorithm>
#include <cmath>
#include <memory>

#include "cases/common/own_device.h"
#include "cases/pipeline/state/dynamic_state.h"
#include "cases/pipeline/state/render.h"
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/random_clear.h"

namespace vitrine::cts {
namespace {

bool blendable(VkFormat format) {
  return (gpus().reference.features_of(format) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0;
}

/// What was not there from the beginning is drawn from a second generator, so that the cases of a seed stay what they
/// were.
Random second_generator(const Run& run) {
  Random copy = run.random;
  return Random(hash_name("random_state", copy.bits64()));
}

/// How the draws are put into a pass.
void random_pass(Random& second, Scene& scene) {
  TargetSpec& target = scene.target;
  const bool dynamic = second.chance(0.4f), suspends = second.chance(0.4f), secondary = second.chance(0.2f);
  const bool depth = second.chance(0.5f), views = second.chance(0.1f), nothing = second.chance(0.3f);
  scene.dynamic_rendering = dynamic && both([](const auto& f) { return f.dynamicRendering; });
  scene.suspends = scene.dynamic_rendering && suspends;
  scene.secondary = secondary && !scene.suspends;
  if (target.colors.empty() && nothing) target.depth = VK_FORMAT_UNDEFINED;
  scene.resolves_depth = scene.dynamic_rendering && scene.multisampled && target.depth && depth;
  const bool all_stages =
      both([](const auto& f) { return f.multiview && f.multiviewGeometryShader && f.multiviewTessellationShader; });
  if (!views || !all_stages || scene.attachmentless()) return;
  target.layers = 3;
  // deviations.md, multiview-layers
  target.view_mask = second.chance(0.8f) ? 1u << second.below(3) : second.pick({3u, 5u, 6u, 7u});
}

Scene random_scene(Run& run, Random& second) {
  Random& random = run.random;
  Scene scene;
  TargetSpec& target = scene.target;
  scene.multisampled = random.chance(0.35f);
  // deviations.md, multisample-line-tiles
  const uint32_t most = scene.multisampled ? 48 : 100;
  target.width = 16 + random.below(most);
  target.height = 16 + random.below(most);
  target.colors.clear();
  for (uint32_t n = random.chance(0.7f) ? 1 : random.below(5); n > 0; --n) {
    VkFormat format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT});
    const VkFormat other = random.pick(color_formats()).format;
    const bool usable = (gpus().reference.features_of(other) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) != 0 &&
                        (gpus().device.features_of(other) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) != 0;
    const bool comparable = format_info(other).numeric != Numeric::kSrgb || reference_cpu().srgb_comparable;
    if (random.chance(0.5f) && usable && comparable) format = other;
    target.colors.push_back(format);
  }
  if (random.chance(0.7f) || target.colors.empty())
    target.depth = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_X8_D24_UNORM_PACK32,
                                VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_S8_UINT});
  if (target.depth && !(gpus().reference.features_of(target.depth) & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
    target.depth = VK_FORMAT_D32_SFLOAT_S8_UINT;
  if (scene.multisampled) {
    target.samples = VK_SAMPLE_COUNT_4_BIT;
    target.resolve = random.chance(0.4f) && !target.colors.empty();
  }
  if (random.chance(0.15f)) target.layers = 2 + random.below(2);
  random_pass(second, scene);
  const VkImageAspectFlags aspects = target.depth ? aspects_of(target.depth) : 0;
  scene.has_depth = (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
  scene.has_stencil = (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
  return scene;
}

void random_lines(Run& run, const Scene& scene, DrawState& draw) {
  Random& random = run.random;
  draw.line.lineRasterizationMode =
      random.pick({VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT,
                   VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT});
  draw.line.lineStippleFactor = 1 + random.below(5);
  draw.line.lineStipplePattern = static_cast<uint16_t>(random.bits());
  // deviations.md: multisample-short-lines, stipple-per-line
  const bool whole_strips =
      draw.stages.topology != VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY || !draw.stages.geometry.empty();
  draw.line.stippledLineEnable = !scene.multisampled && whole_strips && random.chance(0.3f) &&
                                 draw.line.lineRasterizationMode != VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;
  // deviations.md, smooth-line-integers
  const bool integers = std::any_of(scene.target.colors.begin(), scene.target.colors.end(),
                                    [](VkFormat format) { return is_integer(format_info(format)); });
  if (integers && draw.line.lineRasterizationMode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT)
    draw.line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
  draw.line.pNext = draw.spec.raster.pNext;
  draw.spec.raster.pNext = &draw.line;
  if (random.chance(0.5f)) draw.spec.raster.lineWidth = random.real(1.0f, 5.0f);
}

void random_rasterization(Run& run, const Scene& scene, DrawState& draw) {
  Random& random = run.random;
  VkPipelineRasterizationStateCreateInfo& raster = draw.spec.raster;
  raster.cullMode = random.chance(0.65f) ? 0 : random.chance(0.08f) ? 3 : 1 + random.below(2);
  raster.frontFace = static_cast<VkFrontFace>(random.below(2));
  draw.drawn = draw.stages.drawn;
  if (draw.drawn == Drawn::kTriangles && random.chance(0.35f)) {
    draw.polygon = true;
    // deviations.md, multisample-short-lines
    const bool lines = random.chance(0.6f) && !(scene.multisampled && !draw.stages.tessellation.empty());
    raster.polygonMode = lines ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_POINT;
    draw.drawn = lines ? Drawn::kLines : Drawn::kPoints;
  }
  draw.provoking.provokingVertexMode = static_cast<VkProvokingVertexModeEXT>(random.below(2));
  if (run.gpu.extension_features.provokingVertexLast) raster.pNext = &draw.provoking;
  if (draw.drawn == Drawn::kLines) random_lines(run, scene, draw);
  const bool stippled = draw.drawn == Drawn::kLines && draw.line.stippledLineEnable;
  // deviations.md: point-clipping, stipple-counter, multisample-short-lines
  const bool early_stages = !draw.stages.tessellation.empty() || !draw.stages.geometry.empty();
  draw.clipped = random.chance(0.4f) && draw.stages.drawn != Drawn::kPoints && !stippled &&
                 !(draw.drawn == Drawn::kPoints && early_stages) &&
                 !(scene.multisampled && draw.drawn == Drawn::kLines);
  if (random.chance(0.3f)) {
    raster.depthBiasEnable = VK_TRUE;
    raster.depthBiasConstantFactor = random.real(-200.0f, 200.0f);
    raster.depthBiasSlopeFactor = random.chance(0.7f) ? random.real(-3.0f, 3.0f) : 0.0f;
    if (random.chance(0.4f)) raster.depthBiasClamp = random.real(-0.1f, 0.1f);
  }
  raster.depthClampEnable = random.chance(0.25f);
  draw.clip.depthClipEnable = random.chance(0.5f);
  if (random.chance(0.2f)) {
    draw.clip.pNext = raster.pNext;
    raster.pNext = &draw.clip;
  }
  draw.control.negativeOneToOne = VK_TRUE;
  if (random.chance(0.15f)) draw.spec.viewport_next = &draw.control;
  raster.rasterizerDiscardEnable = random.chance(0.01f);
}

/// Only filled triangles keep away from the pixels at the rectangle's edge (deviations.md, viewport-scissor and
/// multisample-scissor).
void random_viewports(Random& random, const Scene& scene, DrawState& draw) {
  const auto width = static_cast<float>(scene.target.width), height = static_cast<float>(scene.target.height);
  const auto depth = [&](VkViewport& viewport) {
    if (random.chance(0.4f)) viewport.minDepth = random.unit();
    if (random.chance(0.4f)) viewport.maxDepth = random.unit();
  };
  const bool inner = draw.drawn == Drawn::kTriangles;
  for (uint32_t i = 0; i < draw.stages.viewports; ++i) {
    VkViewport viewport{0, 0, width, height, 0, 1};
    if (inner && random.chance(0.5f)) {
      const float step = scene.multisampled ? 1.0f : 0.125f;
      const auto length = [&](float limit) { return std::floor(random.unit() * limit / step) * step; };
      viewport.x = length(width * 0.4f);
      viewport.y = length(height * 0.4f);
      viewport.width = width - viewport.x - length(width * 0.3f);
      viewport.height = height - viewport.y - length(height * 0.3f);
    }
    if (random.chance(0.3f)) {
      viewport.y += viewport.height;
      viewport.height = -viewport.height;
    }
    depth(viewport);
    draw.spec.viewports.push_back(viewport);
    VkRect2D scissor{{0, 0}, {scene.target.width, scene.target.height}};
    if (!scene.multisampled && random.chance(0.3f))
      scissor = {{static_cast<int32_t>(random.below(scene.target.width / 2)),
                  static_cast<int32_t>(random.below(scene.target.height / 2))},
                 {1 + scene.target.width / 3 + random.below(scene.target.width / 2),
                  1 + scene.target.height / 3 + random.below(scene.target.height / 2)}};
    draw.spec.scissors.push_back(scissor);
  }
}

VkStencilOpState random_stencil(Random& random) {
  const auto op = [&] { return static_cast<VkStencilOp>(random.below(8)); };
  return {op(),
          op(),
          op(),
          static_cast<VkCompareOp>(random.below(8)),
          random.pick({0xffu, 0x0fu, 0xa5u}),
          random.pick({0xffu, 0x3cu, 0u}),
          random.below(256)};
}

void random_tests(Random& random, const Scene& scene, DrawState& draw) {
  VkPipelineDepthStencilStateCreateInfo& depth = draw.spec.depth;
  // NEVER and EQUAL leave little to see.
  const auto compare = [&](float less) {
    if (random.chance(less)) return VK_COMPARE_OP_LESS;
    if (random.chance(0.15f)) return static_cast<VkCompareOp>(random.below(8));
    return random.pick({VK_COMPARE_OP_LESS_OR_EQUAL, VK_COMPARE_OP_GREATER, VK_COMPARE_OP_NOT_EQUAL,
                        VK_COMPARE_OP_GREATER_OR_EQUAL, VK_COMPARE_OP_ALWAYS});
  };
  depth.depthTestEnable = scene.has_depth && !one_sample_lines(scene, draw) && random.chance(0.8f);
  depth.depthWriteEnable = random.chance(0.8f);
  depth.depthCompareOp = compare(0.5f);
  depth.stencilTestEnable = scene.has_stencil && !one_sample_lines(scene, draw) && random.chance(0.6f);
  depth.front = random_stencil(random);
  depth.back = random_stencil(random);
  // deviations.md, polygon-mode-facing and geometry-polygon-facing
  if (draw.polygon && depth.stencilTestEnable) {
    draw.fragment.facing = draw.stages.geometry.empty();
    if (scene.target.colors.empty() || !draw.fragment.facing) depth.back = depth.front;
  }
}

void random_fragment_needs(Run& run, const Scene& scene, DrawState& draw) {
  Random& random = run.random;
  FragmentNeeds& needs = draw.fragment;
  needs.multisampled = scene.multisampled;
  needs.reads_mask = scene.multisampled && !one_sample_lines(scene, draw);  // deviations.md, one-sample-line-masks
  // deviations.md, stipple-flat-integers and stipple-per-line
  needs.primitive_id = !draw.line.stippledLineEnable;
  needs.facing |= random.chance(0.2f) && !(draw.polygon && !draw.stages.geometry.empty());
  needs.discards = random.chance(0.15f);
  needs.writes_depth = scene.has_depth && random.chance(0.12f);
  needs.writes_stencil = scene.has_stencil && random.chance(0.1f) && run.gpu.has("VK_EXT_shader_stencil_export");
  // deviations.md, smooth-line-sample-mask and one-sample-line-masks
  needs.writes_mask = random.chance(0.15f) && !smooth_lines(draw) && !one_sample_lines(scene, draw);
  needs.early = random.chance(0.1f) && !needs.writes_depth && !needs.writes_stencil;
  const std::vector<VkFormat>& colors = scene.target.colors;
  needs.dual = colors.size() == 1 && blendable(colors[0]) && random.chance(0.15f);
}

void random_blending(Random& random, const Scene& scene, DrawState& draw) {
  const bool dual = draw.fragment.dual;
  for (const VkFormat format : scene.target.colors) {
    VkPipelineColorBlendAttachmentState blend{};
    const auto factor = [&] { return static_cast<VkBlendFactor>(random.below(dual ? 19 : 15)); };
    blend.blendEnable = blendable(format) && (dual || random.chance(0.5f));
    blend.srcColorBlendFactor = factor();
    blend.dstColorBlendFactor = factor();
    blend.colorBlendOp = static_cast<VkBlendOp>(random.below(5));
    blend.srcAlphaBlendFactor = factor();
    blend.dstAlphaBlendFactor = factor();
    blend.alphaBlendOp = static_cast<VkBlendOp>(random.below(5));
    blend.colorWriteMask = random.chance(0.7f) ? 0xf : random.chance(0.1f) ? 0 : 1 + random.below(15);
    draw.spec.blends.push_back(blend);
  }
  for (float& constant : draw.spec.blend.blendConstants) constant = random.unit();
  // deviations.md, logic-op-width
  const bool narrow = std::any_of(scene.target.colors.begin(), scene.target.colors.end(), [](VkFormat format) {
    const FormatInfo& info = format_info(format);
    return std::any_of(info.bits, info.bits + 4, [](uint8_t bits) { return bits == 2 || bits == 4; });
  });
  draw.spec.blend.logicOpEnable = !dual && !narrow && random.chance(0.15f);
  draw.spec.blend.logicOp = static_cast<VkLogicOp>(random.below(16));
}

void random_multisample(Random& random, const Scene& scene, DrawState& draw) {
  VkPipelineMultisampleStateCreateInfo& state = draw.spec.multisample;
  if (random.chance(0.2f) && !one_sample_lines(scene, draw)) {
    draw.sample_mask = random.chance(0.1f) ? random.bits() : random.bits() | 1u << random.below(scene.target.samples);
    if (scene.target.samples == 1 && draw.sample_mask != 0) draw.sample_mask |= 1;  // deviations.md, one-sample-mask
    state.pSampleMask = &draw.sample_mask;
  }
  const bool float_first = !scene.target.colors.empty() && !is_integer(format_info(scene.target.colors[0]));
  state.alphaToCoverageEnable = float_first && random.chance(0.2f);
  // deviations.md, alpha-to-one-beside-mask
  state.alphaToOneEnable = random.chance(0.15f) && !draw.fragment.writes_mask && !draw.fragment.writes_depth &&
                           !draw.fragment.writes_stencil;
  // deviations.md, alpha-to-coverage-per-sample
  draw.fragment.per_sample = scene.multisampled && !state.alphaToCoverageEnable;
  state.sampleShadingEnable = draw.fragment.per_sample && random.chance(0.3f);
  state.minSampleShading = random.pick({0.0f, 0.2f, 0.25f, 0.3f, 1.0f});
  // VUID-VkGraphicsPipelineCreateInfo-lineRasterizationMode-02766
  if (draw.drawn == Drawn::kLines &&
      (draw.line.lineRasterizationMode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT ||
       draw.line.lineRasterizationMode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT))
    state.alphaToCoverageEnable = state.alphaToOneEnable = state.sampleShadingEnable = VK_FALSE;
}

constexpr uint32_t kVertexFloats = 12;

/// Vertices in cells of a grid, no two in one, so that there are no short lines; or anywhere, also outside.
std::vector<float> random_vertices(Random& random, const DrawState& draw) {
  std::vector<uint32_t> cells;
  for (uint32_t i = 0; i < 64; ++i) cells.push_back(i);
  for (uint32_t i = 63; i > 0; --i) std::swap(cells[i], cells[random.below(i + 1)]);
  const bool grid = !draw.clipped && random.chance(0.5f);
  std::vector<float> values;
  for (uint32_t i = 0; i < draw.vertices; ++i) {
    const float w = random.chance(0.5f)                   ? 1.0f
                    : draw.clipped && random.chance(0.1f) ? random.real(-1.0f, 0.5f)
                                                          : random.real(0.3f, 3.0f);
    const float reach = draw.clipped ? random.pick({0.9f, 1.5f, 8.0f}) : 0.75f;
    float x = random.real(-reach, reach), y = random.real(-reach, reach);
    if (!draw.clipped && (grid || draw.drawn == Drawn::kLines)) {
      const uint32_t cell = cells[i % 64];
      x = (static_cast<float>(cell % 8) - 3.5f) * 0.2f + random.real(-0.03f, 0.03f);
      y = (static_cast<float>(cell / 8) - 3.5f) * 0.2f + random.real(-0.03f, 0.03f);
    }
    const float z = draw.clipped ? random.real(-0.5f, 1.5f) : random.unit();
    for (const float v : {x * w, y * w, z * w, w}) values.push_back(v);
    for (int c = 0; c < 8; ++c) values.push_back(random.unit());
  }
  return values;
}

/// What surrounds a draw, and state that the first generator does not know.
void random_surroundings(Run& run, Random& second, const Scene& scene, DrawState& draw) {
  const bool conditional = second.chance(0.15f), captured = second.chance(0.15f), queried = second.chance(0.3f);
  const bool writes = second.chance(0.15f), lower = second.chance(0.4f), left = second.chance(0.5f);
  draw.indirect = second.chance(0.2f);
  draw.dynamic_share = left ? second.unit() : 0;
  draw.conditional = conditional && both([](const auto& f) { return f.conditionalRendering; });
  draw.predicate = second.below(2);
  draw.predicate_flags = second.below(2) ? VK_CONDITIONAL_RENDERING_INVERTED_BIT_EXT : 0;
  const bool views = scene.target.view_mask != 0;
  draw.stages.captured = captured && !views && run.gpu.has("VK_EXT_transform_feedback");
  draw.queried = queried && !views;
  draw.stages.views = views;
  if (writes && both([](const auto& f) { return f.colorWriteEnable; })) {
    for (size_t i = 0; i < scene.target.colors.size(); ++i) draw.color_writes.push_back(second.chance(0.6f));
    draw.color_write_info.attachmentCount = static_cast<uint32_t>(draw.color_writes.size());
    draw.color_write_info.pColorWriteEnables = draw.color_writes.data();
    draw.spec.blend.pNext = &draw.color_write_info;
  }
  if (lower) {
    draw.origin.domainOrigin = VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT;
    draw.spec.tessellation.pNext = &draw.origin;
  }
  draw.fragment.counts = second.chance(0.1f) || scene.attachmentless();
  if (!scene.unrestricted) return;
  for (VkViewport& viewport : draw.spec.viewports) {
    viewport.minDepth = viewport.minDepth * 5 - 2;
    viewport.maxDepth = viewport.maxDepth * 4 - 1;
  }
}

void random_draw(Run& run, Random& second, const Scene& scene, DrawState& draw) {
  Random& random = run.random;
  draw.stages = random_stages(run, !scene.multisampled);
  draw.stages.layers = random.chance(0.7f) && !scene.target.view_mask ? scene.target.layers : 1;
  const bool selects = run.gpu.has("VK_EXT_shader_viewport_index_layer");
  if (!selects && draw.stages.geometry.empty()) draw.stages.layers = 1;
  random_rasterization(run, scene, draw);
  // deviations.md, clipped-polygon-layer
  if (draw.polygon && (draw.clipped || draw.stages.clip_distances != 0)) draw.stages.layers = 1;
  if (draw.drawn == Drawn::kTriangles && random.chance(0.15f) && (selects || !draw.stages.geometry.empty()))
    draw.stages.viewports = 2 + random.below(3);
  // Distances clip, too (see `clipped`).
  if (!draw.clipped && draw.drawn == Drawn::kLines) draw.stages.clip_distances = 0;
  // deviations.md, stipple-counter and stipple-flat-integers
  if (draw.line.stippledLineEnable) {
    draw.stages.cull_distances = 0;
    draw.stages.layers = 1;
  }
  random_viewports(random, scene, draw);
  random_tests(random, scene, draw);
  random_fragment_needs(run, scene, draw);
  random_blending(random, scene, draw);
  random_multisample(random, scene, draw);
  random_surroundings(run, second, scene, draw);
  write_stages(draw.stages, draw.spec);
  draw.spec.floats({4, 4, kVertexFloats - 8});
  if (!(scene.target.colors.empty() && random.chance(0.5f)))
    draw.spec.fragment = random_fragment(random, scene.target, draw.stages, draw.fragment);
  draw.vertices = 4 + random.below(44);
  draw.instances = random.chance(0.8f) ? 1 : 2 + random.below(2);
}

bool restartable(VkPrimitiveTopology topology) {
  return topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP || topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP ||
         topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN ||
         topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY ||
         topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY;
}

/// The parameters of an indirect draw.
std::vector<uint32_t> draw_words(const RecordedDraw& draw) {
  const DrawState& state = draw.state;
  if (draw.indexed) return {state.vertices, state.instances, 0, draw.first_vertex, draw.first_instance};
  return {state.vertices, state.instances, draw.first_vertex, draw.first_instance};
}

/// Indices of a type; ~0 is what restarts primitives.
Buffer index_buffer(Run& run, VkIndexType type, const std::vector<uint32_t>& order) {
  if (type == VK_INDEX_TYPE_UINT8_EXT) return run.buffer_of(std::vector<uint8_t>(order.begin(), order.end()));
  if (type == VK_INDEX_TYPE_UINT16) return run.buffer_of(std::vector<uint16_t>(order.begin(), order.end()));
  return run.buffer_of(order);
}

template <typename T>
void repeat(std::vector<T>& values, uint32_t times) {
  const size_t count = values.size();
  values.reserve(count * times);
  for (size_t i = 0; i < count * (times - 1); ++i) values.push_back(values[i]);
}

/// How a draw is issued, and a clear before it.
void random_command(Random& second, const Scene& scene, RecordedDraw& draw) {
  draw.seed = second.bits64();
  const VkIndexType type =
      second.pick({VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT32, VK_INDEX_TYPE_UINT8_EXT});
  if (type != VK_INDEX_TYPE_UINT8_EXT || both([](const auto& f) { return f.indexTypeUint8; })) draw.index_type = type;
  draw.first_vertex = second.chance(0.2f) ? 1 + second.below(9) : 0;
  draw.first_instance = second.chance(0.2f) ? 1 + second.below(2) : 0;
  if (draw.state.indirect && !gpus().reference.features.drawIndirectFirstInstance) draw.first_instance = 0;
  const bool clears = second.chance(0.1f), depth = second.chance(0.5f);
  const auto colors = static_cast<uint32_t>(scene.target.colors.size());
  if (!clears || scene.attachmentless()) return;
  draw.cleared = {{static_cast<int32_t>(second.below(scene.target.width / 2)),
                   static_cast<int32_t>(second.below(scene.target.height / 2))},
                  {1 + second.below(scene.target.width / 2), 1 + second.below(scene.target.height / 2)}};
  VkClearAttachment& clear = draw.clear.emplace();
  if (colors == 0 || (depth && scene.target.depth)) {
    clear.aspectMask = aspects_of(scene.target.depth);
    const float stencil = second.unit();
    clear.clearValue = clear_value(scene.target.depth, second.unit(), stencil, 0, 0);
    return;
  }
  clear.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
  clear.colorAttachment = second.below(colors);
  clear.clearValue = random_clear(second, scene.target.colors[clear.colorAttachment]);
}

/// What deviations.md lists is drawn, too; then the same again without it, which must be identical.
void random_state(Run& run, Random& second, bool unrestricted) {
  Random& random = run.random;
  const Scene scene = [&] {
    Scene result = random_scene(run, second);
    // deviations.md, unorm-depth-outside
    result.unrestricted = unrestricted && result.has_depth && format_info(result.target.depth).bits[0] == 32;
    return result;
  }();
  std::vector<VkClearValue> clears;
  for (const VkFormat format : scene.target.colors) clears.push_back(random_clear(random, format));
  if (scene.target.depth) {
    const float stencil = random.unit();
    clears.push_back(clear_value(scene.target.depth, random.pick({1.0f, 0.5f, 0.7f}), stencil, 0, 0));
  }
  std::vector<std::unique_ptr<RecordedDraw>> draws;
  for (uint32_t n = 1 + random.below(3); n > 0; --n) {
    RecordedDraw& r = *draws.emplace_back(std::make_unique<RecordedDraw>());
    DrawState& draw = r.state;
    random_draw(run, second, scene, draw);
    random_command(second, scene, r);
    r.indexed = random.chance(0.4f);
    draw.spec.assembly.primitiveRestartEnable = r.indexed && restartable(draw.stages.topology) && random.chance(0.6f);
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < draw.vertices; ++i)
      order.push_back(draw.spec.assembly.primitiveRestartEnable && random.chance(0.1f) ? ~0u
                                                                                       : random.below(draw.vertices));
    std::vector<float> vertices = random_vertices(random, draw);
    // Longer than what either device works on at a time.
    if (second.chance(0.05f) && draw.stages.tessellation.empty()) {
      const uint32_t copies = 24 + second.below(24);
      repeat(vertices, copies);
      repeat(order, copies);
      draw.vertices *= copies;
    }
    vertices.insert(vertices.begin(), size_t{r.first_vertex} * kVertexFloats, 0.5f);
    r.vertices = run.buffer_of(vertices);
    r.indices = index_buffer(run, r.index_type, order);
    r.command = run.buffer_of(draw_words(r));
  }
  render(run, scene, clears, draws, "");
  std::string rows;
  for (const auto& draw : draws)
    for (const std::string& row : remove_listed(scene, draw->state)) rows += row + " ";
  Scene without = scene;
  uint32_t& views = without.target.view_mask;
  if (views & (views - 1)) {
    rows += "multiview-layers ";
    views &= ~views + 1;
  }
  if (!rows.empty()) {
    for (Output& output : run.outputs) output.deviation = rows;
    render(run, without, clears, draws, "without_listed.");
  }
  run.may_be_blank();
}

CTS_RANDOM("pipeline", "random_state", 120) {
  constexpr char kUnrestricted[] = "VK_EXT_depth_range_unrestricted";
  Random second = second_generator(run);
  if (!second.chance(0.1f) || !offers_extension(gpus().device, kUnrestricted) ||
      !offers_extension(gpus().reference, kUnrestricted)) {
    random_state(run, second, false);
    return;
  }
  OwnDevice own(run.gpu, kUnrestricted);
  Run inner(own.gpu, 0, run.index);
  inner.random = run.random;
  random_state(inner, second, true);
  run.outputs = std::move(inner.outputs);
  run.notes = std::move(inner.notes);
}

}  // namespace
}  // namespace vitrine::cts
