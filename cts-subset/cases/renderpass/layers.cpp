// Render passes over several layers: multiview with load operations, clears, input attachments and resolves per view;
// clears of layered framebuffers.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kLayers = 4;

const char kViewVertex[] = R"(
#extension GL_EXT_multiview : require
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() {
  passed = color + vec4(0.0, 0.2 * float(gl_ViewIndex), 0.0, 0.0);
  gl_Position = position + vec4(0.15 * float(gl_ViewIndex), 0.0, 0.0, 0.0);
})";

const char kFirstFragment[] = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = passed; })";

const char kSecondFragment[] = R"(
#extension GL_EXT_multiview : require
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
layout(input_attachment_index = 0, binding = 0) uniform subpassInput first;
void main() { result = subpassLoad(first) + passed * (0.1 * float(gl_ViewIndex)); })";

const char kViewGeometry[] = R"(
#extension GL_EXT_multiview : require
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color;
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position * vec4(vec2(1.0 - 0.2 * float(gl_ViewIndex)), 1.0, 1.0);
    color = passed[(i + gl_ViewIndex) % 3];
    EmitVertex();
  }
})";

const char kViewControl[] = R"(
#extension GL_EXT_multiview : require
layout(vertices = 3) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color[];
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  color[gl_InvocationID] = passed[gl_InvocationID];
  gl_TessLevelOuter = float[4](1.0 + float(gl_ViewIndex), 2.0, 3.0, 0.0);
  gl_TessLevelInner = float[2](2.0 + float(gl_ViewIndex), 0.0);
})";

const char kViewEvaluation[] = R"(
#extension GL_EXT_multiview : require
layout(triangles, equal_spacing, cw) in;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 passed;
void main() {
  gl_Position = vec4(0.0);
  for (int i = 0; i < 3; ++i) gl_Position += gl_in[i].gl_Position * gl_TessCoord[i];
  passed = color[gl_ViewIndex % 3] * gl_TessCoord.x + color[0] * 0.5;
})";

VkAttachmentDescription describe(const Image& image, VkAttachmentLoadOp load) {
  VkAttachmentDescription result{};
  result.format = image.spec.format;
  result.samples = image.spec.samples;
  result.loadOp = result.stencilLoadOp = load;
  result.storeOp = result.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
  result.initialLayout = result.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  return result;
}

/// Two subpasses: the first draws to `first` and depth, the second reads it and draws to `second`.
VkRenderPass make_pass(Run& run, const std::vector<VkAttachmentDescription>& attachments, const uint32_t masks[2]) {
  const VkAttachmentReference references[] = {
      {0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}, {2, VK_IMAGE_LAYOUT_GENERAL}};
  const uint32_t preserve[] = {2, 1};
  VkSubpassDescription subpasses[2]{};
  for (VkSubpassDescription& s : subpasses) {
    s.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    s.colorAttachmentCount = 1;
    s.preserveAttachmentCount = 1;
  }
  subpasses[0].pColorAttachments = &references[0];
  subpasses[0].pDepthStencilAttachment = &references[2];
  subpasses[0].pPreserveAttachments = &preserve[1];
  subpasses[1].pColorAttachments = &references[1];
  subpasses[1].inputAttachmentCount = 1;
  subpasses[1].pInputAttachments = &references[0];
  subpasses[1].pPreserveAttachments = &preserve[0];
  constexpr VkAccessFlags kAll = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  constexpr VkPipelineStageFlags kStages = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
  const VkDependencyFlags flags = VK_DEPENDENCY_BY_REGION_BIT | (masks[0] ? VK_DEPENDENCY_VIEW_LOCAL_BIT : 0);
  const VkSubpassDependency dependency{0, 1, kStages, kStages, kAll, kAll, flags};
  VkRenderPassMultiviewCreateInfo views{VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO};
  views.subpassCount = 2;
  views.pViewMasks = masks;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO, &views};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 2;
  info.pSubpasses = subpasses;
  info.dependencyCount = 1;
  info.pDependencies = &dependency;
  return make_render_pass(run, info);
}

/// `reach` above 1: some are clipped.
std::vector<float> random_vertices(Random& random, int count, float reach = 1.2f) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) {
    for (const float v : {random.real(-reach, reach), random.real(-reach, reach), random.unit(), 1.0f})
      values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  return values;
}

struct ViewScene {
  VkExtent2D extent;
  uint32_t layers;
  VkAttachmentLoadOp load, second_load;
  bool clears_inside;
  Buffer vertices;
  bool geometry = false, tessellates = false;
  uint32_t drawn = 9;  ///< vertices in each subpass
};

struct ViewImages {
  Image first, second, depth;
};

ViewImages make_images(Run& run, VkExtent2D extent, uint32_t layers) {
  ImageSpec spec;
  spec.extent = {extent.width, extent.height, 1};
  spec.layers = layers;
  spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  ViewImages images;
  images.first = run.image(spec);
  images.second = run.image(spec);
  spec.format = VK_FORMAT_D32_SFLOAT;
  spec.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  images.depth = run.image(spec);
  for (const Image* image : {&images.first, &images.second, &images.depth}) run.fill_random(*image);
  return images;
}

/// One render pass instance that draws the scene for the views of `mask`.
void draw_views(Run& run, const ViewScene& scene, const ViewImages& images, uint32_t mask) {
  const uint32_t masks[2] = {mask, mask};
  const VkRenderPass pass = make_pass(run,
                                      {describe(images.first, scene.load), describe(images.second, scene.second_load),
                                       describe(images.depth, VK_ATTACHMENT_LOAD_OP_CLEAR)},
                                      masks);
  const VkFramebuffer framebuffer =
      make_framebuffer(run, pass, {images.first.view, images.second.view, images.depth.view}, scene.extent, 1);
  const Resources resources = run.resources({input_attachment(0, images.first)});
  VkPipeline pipelines[2];
  for (uint32_t i = 0; i < 2; ++i) {
    GraphicsSpec graphics;
    graphics.vertex = kViewVertex;
    graphics.fragment = i ? kSecondFragment : kFirstFragment;
    graphics.layout = resources.layout;
    graphics.floats({4, 4});
    if (scene.geometry) graphics.geometry = kViewGeometry;
    if (scene.tessellates) {
      graphics.control = kViewControl;
      graphics.evaluation = kViewEvaluation;
      graphics.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
      graphics.tessellation.patchControlPoints = 3;
    }
    graphics.depth.depthTestEnable = graphics.depth.depthWriteEnable = i == 0;
    pipelines[i] = make_pipeline(run, graphics, pass, i, 1, scene.extent, VK_SAMPLE_COUNT_1_BIT);
  }
  run.once([&](VkCommandBuffer cmd) {
    VkClearValue clears[3]{};
    clears[0].color = {{0.1f, 0.2f, 0.3f, 0.4f}};
    clears[1].color = {{0.5f, 0.6f, 0.7f, 0.8f}};
    clears[2].depthStencil = {0.8f, 0};
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, scene.extent};
    begin.clearValueCount = 3;
    begin.pClearValues = clears;
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipelines[0]);
    resources.bind(cmd);
    bind_vertices(cmd, scene.vertices);
    vkCmdDraw(cmd, scene.drawn, 1, 0, 0);
    if (scene.clears_inside) {
      const VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, 0, {{{0.9f, 0.0f, 0.9f, 0.0f}}}};
      const VkClearRect rect{{{2, 3}, {scene.extent.width / 2, scene.extent.height / 3}}, 0, 1};
      vkCmdClearAttachments(cmd, 1, &clear, 1, &rect);
    }
    vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipelines[1]);  // with multiview nothing stays bound over subpasses
    resources.bind(cmd);
    bind_vertices(cmd, scene.vertices);
    vkCmdDraw(cmd, scene.drawn, 1, scene.drawn, 0);
    vkCmdEndRenderPass(cmd);
  });
}

/// One view at a time: with several the reference is wrong (deviations.md, multiview-layers).
CTS_RANDOM("renderpass", "random_multiview", 40) {
  Random& random = run.random;
  run.require(run.gpu.extension_features.multiview, "multiview");
  const auto op = [&] { return static_cast<VkAttachmentLoadOp>(random.below(2)); };  // LOAD or CLEAR
  ViewScene scene{
      {16 + random.below(60), 16 + random.below(60)}, kLayers, op(), op(), random.chance(0.5f), {}, false, false};
  scene.vertices = run.buffer_of(random_vertices(random, 18));
  const ViewImages images = make_images(run, scene.extent, kLayers);
  draw_views(run, scene, images, 1u << random.below(kLayers));
  run.out("first", images.first);
  run.out("second", images.second);
  run.out("depth", images.depth);
}

/// The reference takes the layer of a clipped primitive from memory that it has not written, when a stage behind the
/// vertex shader chose it; gl_ViewIndex moves vertices by up to 0.45.
constexpr float kInside = 0.5f;

/// With shaders behind the vertex shader that read gl_ViewIndex too.
CTS_RANDOM("renderpass", "random_multiview_stages", 20) {
  Random& random = run.random;
  const bool geometry = random.chance(0.5f), tessellates = !geometry || random.chance(0.5f);
  run.require(run.gpu.extension_features.multiview, "multiview");
  run.require(!geometry || run.gpu.extension_features.multiviewGeometryShader, "multiviewGeometryShader");
  run.require(!tessellates || run.gpu.extension_features.multiviewTessellationShader, "multiviewTessellationShader");
  constexpr VkAttachmentLoadOp kClear = VK_ATTACHMENT_LOAD_OP_CLEAR;
  ViewScene scene{
      {16 + random.below(60), 16 + random.below(60)}, kLayers, kClear, kClear, false, {}, geometry, tessellates};
  scene.vertices = run.buffer_of(random_vertices(random, 18, kInside));
  const ViewImages images = make_images(run, scene.extent, kLayers);
  draw_views(run, scene, images, 1u << random.below(kLayers));
  run.out("first", images.first);
  run.out("second", images.second);
  run.out("depth", images.depth);
}

/// Output 0 is all views at once, output 1 the control: one pass per view.
std::string judge_views(const std::vector<Output>& device, const std::vector<Output>& reference) {
  if (const Comparison c = compare(device[1], reference[1]); !c.first.empty()) return "the control: " + c.first;
  if (compare(reference[0], reference[1]).first.empty()) return "the reference's fault does not show";
  if (const Comparison c = compare(device[0], reference[1]); !c.first.empty()) return "the device: " + c.first;
  return "";
}

void draw_together_and_alone(Run& run, bool geometry, bool tessellates, uint32_t drawn = 9) {
  run.require(run.gpu.extension_features.multiview, "multiview");
  constexpr VkAttachmentLoadOp kClear = VK_ATTACHMENT_LOAD_OP_CLEAR;
  ViewScene scene{
      {60, 50}, 3,           kClear,
      kClear,   true,        run.buffer_of(random_vertices(run.random, 2 * drawn, geometry ? kInside : 1.2f)),
      geometry, tessellates, drawn};
  const ViewImages together = make_images(run, scene.extent, scene.layers);
  const ViewImages alone = make_images(run, scene.extent, scene.layers);
  draw_views(run, scene, together, 7);
  for (const uint32_t mask : {1u, 2u, 4u}) draw_views(run, scene, alone, mask);
  run.out("together", together.second);
  run.out("alone", alone.second);
}

const AddCase kViews("renderpass", "deviation.multiview_layers", "multiview-layers", judge_views,
                     [](Run& run) { draw_together_and_alone(run, false, false); });

/// More than the reference collects at a time: then some views get to their layers.
const AddCase kViewsOverflow("renderpass", "deviation.multiview_layers_of_many", "multiview-layers", judge_views,
                             [](Run& run) { draw_together_and_alone(run, false, false, 180); });

/// With stages behind the vertex shader the reference does it right.
const AddCase kViewsBehindStages("renderpass", "multiview_behind_stages", [](Run& run) {
  run.require(
      run.gpu.extension_features.multiviewGeometryShader && run.gpu.extension_features.multiviewTessellationShader,
      "multiview with all stages");
  draw_together_and_alone(run, true, true);
});

/// Layered framebuffers without multiview: load operations reach every layer, draws the first one.
CTS_RANDOM("renderpass", "random_layered_clears", 30) {
  Random& random = run.random;
  const VkExtent2D extent{16 + random.below(60), 16 + random.below(60)};
  const auto [first, second, depth] = make_images(run, extent, kLayers);
  const auto op = [&] { return static_cast<VkAttachmentLoadOp>(random.below(2)); };  // LOAD or CLEAR
  const uint32_t masks[2] = {0, 0};
  const VkRenderPass pass =
      make_pass(run, {describe(first, op()), describe(second, op()), describe(depth, op())}, masks);
  const uint32_t layers = 1 + random.below(kLayers);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {first.view, second.view, depth.view}, extent, layers);
  const VkRect2D area{{static_cast<int32_t>(random.below(8)), static_cast<int32_t>(random.below(8))},
                      {4 + random.below(extent.width - 12), 4 + random.below(extent.height - 12)}};
  const VkClearRect rect{area, random.below(layers), 1};
  const VkClearAttachment inside{VK_IMAGE_ASPECT_COLOR_BIT, 0, {{{0.9f, 0.0f, 0.9f, 0.0f}}}};
  run.once([&](VkCommandBuffer cmd) {
    VkClearValue clears[3]{};
    clears[0].color = {{0.1f, 0.2f, 0.3f, 0.4f}};
    clears[1].color = {{0.5f, 0.6f, 0.7f, 0.8f}};
    clears[2].depthStencil = {0.8f, 0};
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = area;
    begin.clearValueCount = 3;
    begin.pClearValues = clears;
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdClearAttachments(cmd, 1, &inside, 1, &rect);
    vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdEndRenderPass(cmd);
  });
  run.out("first", first);
  run.out("second", second);
  run.out("depth", depth);
}

/// The view is 0 where the layer comes from a shader.
CTS_CASE("renderpass", "view_index_without_views") {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  TargetSpec layered;
  layered.layers = kLayers;
  const Target target = make_target(run, layered);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.geometry = R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color;
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Layer = gl_PrimitiveIDIn % 4;
    gl_Position = gl_in[i].gl_Position;
    color = passed[i];
    EmitVertex();
  }
})";
  spec.fragment = R"(
#extension GL_EXT_multiview : require
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = passed * 0.5 + 0.15 * float(gl_ViewIndex); })";
  spec.floats({4, 4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values;
  for (uint32_t i = 0; i < 24; ++i) {
    for (const float v : {run.random.real(-1.0f, 1.0f), run.random.real(-1.0f, 1.0f), 0.5f, 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(run.random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 24, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
