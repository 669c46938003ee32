// VK_EXT_multisampled_render_to_single_sampled: attachments of one sample that are drawn to with more. Against the
// reference: its four samples, subpasses that read what others resolved, dynamic rendering in one or two parts. Against
// samples that are there: the same scope in explicit multisampled attachments of the device under test, which begin
// with the attachments' texels in every sample and are resolved.
#include <algorithm>
#include <array>
#include <optional>

#include "cases/deviations/deviation.h"
#include "harness/case.h"
#include "harness/format.h"
#include "harness/graphics.h"
#include "harness/random_clear.h"

namespace vitrine::cts {
namespace {

constexpr char kExtension[] = "VK_EXT_multisampled_render_to_single_sampled";
constexpr VkExtent2D kExtent{61, 47};
constexpr uint32_t kColors = 2;

/// Views of one layer.
struct Attachments {
  std::vector<Image> colors;
  std::optional<Image> depth;
  uint32_t layer = 0;
  std::vector<VkImageView> views() const {
    std::vector<VkImageView> all;
    for (const Image& color : colors) all.push_back(color.view);
    if (depth) all.push_back(depth->view);
    return all;
  }
};

/// What happens in one render pass instance.
struct Scope {
  VkRect2D area;
  VkAttachmentLoadOp color_load[kColors], depth_load, stencil_load;
  VkClearValue clears[kColors + 1];
  VkResolveModeFlagBits depth_mode, stencil_mode;
  uint32_t first, count;  ///< vertices
};

VkMultisampledRenderToSingleSampledInfoEXT forced(uint32_t samples) {
  VkMultisampledRenderToSingleSampledInfoEXT info{VK_STRUCTURE_TYPE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_INFO_EXT};
  info.multisampledRenderToSingleSampledEnable = VK_TRUE;
  info.rasterizationSamples = static_cast<VkSampleCountFlagBits>(samples);
  return info;
}

/// One of the layers. `fetchable`: of depth formats, those whose numbers survive being fetched and written; 24 bits do
/// not, as floats.
Attachments random_attachments(Run& run, uint32_t layers, bool fetchable) {
  Random& random = run.random;
  Attachments out;
  out.layer = random.below(layers);
  const auto make = [&](const ImageSpec& image_spec) {
    Image image = run.image(image_spec);
    run.fill_random(image);
    image.view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, image_spec.format, {image.aspects(), 0, 1, out.layer, 1});
    return image;
  };
  ImageSpec spec;
  spec.layers = layers;
  if (layers > 1) spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  spec.extent = {kExtent.width, kExtent.height, 1};
  spec.flags = VK_IMAGE_CREATE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_BIT_EXT;
  for (uint32_t i = 0; i < kColors; ++i) {
    spec.format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_UNORM});
    if (i == 1 && random.chance(0.3f)) spec.format = VK_FORMAT_R16G16B16A16_UINT;
    spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
    out.colors.push_back(make(spec));
  }
  if (random.chance(0.3f)) return out;
  spec.format = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_S8_UINT,
                             fetchable ? VK_FORMAT_S8_UINT : VK_FORMAT_D24_UNORM_S8_UINT});
  spec.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  out.depth = make(spec);
  return out;
}

Scope random_scope(Random& random, const Attachments& images) {
  const auto load = [&] { return random.pick({VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_LOAD_OP_CLEAR}); };
  Scope scope{};
  scope.area = {{0, 0}, kExtent};
  if (random.chance(0.4f)) {
    const uint32_t x = random.below(30), y = random.below(20);
    scope.area = {{static_cast<int32_t>(x), static_cast<int32_t>(y)}, {1 + random.below(30), 1 + random.below(26)}};
  }
  for (uint32_t i = 0; i < kColors; ++i) {
    scope.color_load[i] = load();
    scope.clears[i] = random_clear(random, images.colors[i].spec.format);
  }
  scope.depth_load = load();
  scope.stencil_load = load();
  scope.clears[kColors].depthStencil = {random.real(0.5f, 1.0f), random.below(256)};
  scope.depth_mode = scope.stencil_mode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
  return scope;
}

/// Triangles, and the state that draws them to all attachments.
struct Drawing {
  Buffer vertices;
  uint32_t count;  ///< vertices, of all triangles
  GraphicsSpec spec;
};

std::string outputs_of(const Attachments& images) {
  const bool whole = format_info(images.colors[1].spec.format).numeric == Numeric::kUint;
  return std::string("layout(location = 1) out ") +
         (whole ? "uvec4 second;\nuvec4 shade(vec4 c) { return uvec4(c.yxwz * 60000); }\n"
                : "vec4 second;\nvec4 shade(vec4 c) { return c.yxwz; }\n");
}

Drawing random_drawing(Run& run, const Attachments& images) {
  Random& random = run.random;
  Drawing drawing;
  drawing.count = 6 * (1 + random.below(6));
  std::vector<float> values;
  for (uint32_t i = 0; i < drawing.count; ++i) {
    for (const float v : {random.real(-1, 1), random.real(-1, 1), random.unit(), 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  drawing.vertices = run.buffer_of(values);
  GraphicsSpec& spec = drawing.spec;
  spec.vertex = kColorVertex;
  spec.fragment = "layout(location = 0) in vec4 color;\nlayout(location = 0) out vec4 first;\n" + outputs_of(images) +
                  "void main() { first = color; second = shade(color); }\n";
  spec.floats({4, 4});
  const VkImageAspectFlags aspects = images.depth ? images.depth->aspects() : 0;
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
  spec.depth.stencilTestEnable = (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_INVERT, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 1};
  return drawing;
}

VkAttachmentDescription2 describe(const Image& image, VkAttachmentLoadOp load, VkAttachmentLoadOp stencil_load) {
  VkAttachmentDescription2 a{VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2};
  a.format = image.spec.format;
  a.samples = image.spec.samples;
  a.loadOp = load;
  a.stencilLoadOp = stencil_load;
  a.initialLayout = a.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  return a;
}

VkAttachmentReference2 refer(uint32_t attachment, VkImageAspectFlags aspects) {
  return {VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2, nullptr, attachment, VK_IMAGE_LAYOUT_GENERAL, aspects};
}

/// A subpass of the reference's comparison.
struct Part {
  bool reads;       ///< the first attachment, and draws to the second only
  uint32_t forced;  ///< samples
};

/// One subpass per part.
VkRenderPass make_pass(Run& run, const Scope& scope, const Attachments& images, const std::vector<Part>& parts) {
  std::vector<VkAttachmentDescription2> attachments;
  for (uint32_t i = 0; i < kColors; ++i)
    attachments.push_back(describe(images.colors[i], scope.color_load[i], VK_ATTACHMENT_LOAD_OP_DONT_CARE));
  if (images.depth) attachments.push_back(describe(*images.depth, scope.depth_load, scope.stencil_load));
  const VkAttachmentReference2 colors[] = {refer(0, VK_IMAGE_ASPECT_COLOR_BIT), refer(1, VK_IMAGE_ASPECT_COLOR_BIT)};
  const VkAttachmentReference2 unused = refer(VK_ATTACHMENT_UNUSED, 0);
  const VkAttachmentReference2 second[] = {unused, colors[1]};
  const VkAttachmentReference2 depth = refer(kColors, images.depth ? images.depth->aspects() : 0);
  std::vector<VkSubpassDescription2> subpasses;
  std::vector<VkSubpassDependency2> dependencies;
  std::vector<VkMultisampledRenderToSingleSampledInfoEXT> samples(parts.size());
  std::vector<VkSubpassDescriptionDepthStencilResolve> resolves(parts.size());
  for (uint32_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    samples[i] = forced(part.forced);
    resolves[i] = {VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE, &samples[i], scope.depth_mode,
                   scope.stencil_mode, nullptr};
    VkSubpassDescription2 subpass{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2};
    subpass.colorAttachmentCount = kColors;
    subpass.pColorAttachments = part.reads ? second : colors;
    subpass.inputAttachmentCount = part.reads;
    subpass.pInputAttachments = colors;
    const bool tests = images.depth && !part.reads;
    subpass.pDepthStencilAttachment = tests ? &depth : nullptr;
    if (part.forced > 1)
      subpass.pNext = tests ? static_cast<const void*>(&resolves[i]) : static_cast<const void*>(&samples[i]);
    subpasses.push_back(subpass);
    if (i == 0) continue;
    VkSubpassDependency2 dependency{VK_STRUCTURE_TYPE_SUBPASS_DEPENDENCY_2};
    dependency.srcSubpass = i - 1;
    dependency.dstSubpass = i;
    dependency.srcStageMask = dependency.dstStageMask = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
    dependency.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    dependency.dstAccessMask = dependency.srcAccessMask | VK_ACCESS_INPUT_ATTACHMENT_READ_BIT |
                               VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    dependency.dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT;
    dependencies.push_back(dependency);
  }
  VkRenderPassCreateInfo2 info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = static_cast<uint32_t>(subpasses.size());
  info.pSubpasses = subpasses.data();
  info.dependencyCount = static_cast<uint32_t>(dependencies.size());
  info.pDependencies = dependencies.data();
  VkRenderPass pass;
  CTS_VK(CTS_COMMAND(run.gpu, CreateRenderPass2KHR)(run.device, &info, nullptr, &pass));
  return run.own(pass, vkDestroyRenderPass);
}

GraphicsSpec reading(const Drawing& drawing, const Attachments& images, VkPipelineLayout layout) {
  GraphicsSpec spec = drawing.spec;
  spec.fragment =
      "layout(location = 0) in vec4 color;\n"
      "layout(input_attachment_index = 0, binding = 0) uniform subpassInput other;\n" +
      outputs_of(images) + "void main() { second = shade(0.5 * (color + clamp(subpassLoad(other), 0.0, 1.0))); }\n";
  spec.layout = layout;
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = spec.depth.stencilTestEnable = VK_FALSE;
  return spec;
}

VkRenderPassBeginInfo begin_info(Run& run, VkRenderPass pass, const Scope& scope,
                                 const std::vector<VkImageView>& views) {
  VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  begin.renderPass = pass;
  begin.framebuffer = make_framebuffer(run, pass, views, kExtent);
  begin.renderArea = scope.area;
  begin.clearValueCount = kColors + 1;
  begin.pClearValues = scope.clears;
  return begin;
}

void draw_part(VkCommandBuffer cmd, const Scope& scope, uint32_t part, uint32_t parts) {
  const uint32_t triangles = scope.count / 3;
  const uint32_t from = triangles * part / parts, to = triangles * (part + 1) / parts;
  vkCmdDraw(cmd, 3 * (to - from), 1, scope.first + 3 * from, 0);
}

void in_render_pass(Run& run, const Scope& scope, const Attachments& images, const Drawing& drawing,
                    const std::vector<Part>& parts) {
  const VkRenderPass pass = make_pass(run, scope, images, parts);
  const Resources res = run.resources({input_attachment(0, images.colors[0])});
  std::vector<VkPipeline> pipelines;
  for (uint32_t i = 0; i < parts.size(); ++i) {
    GraphicsSpec spec = parts[i].reads ? reading(drawing, images, res.layout) : drawing.spec;
    pipelines.push_back(
        make_pipeline(run, spec, pass, i, kColors, kExtent, static_cast<VkSampleCountFlagBits>(parts[i].forced)));
  }
  const VkRenderPassBeginInfo begin = begin_info(run, pass, scope, images.views());
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_vertices(cmd, drawing.vertices);
    for (uint32_t i = 0; i < parts.size(); ++i) {
      if (i != 0) vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
      bind_pipeline(cmd, pipelines[i]);
      if (parts[i].reads) res.bind(cmd);
      draw_part(cmd, scope, i, static_cast<uint32_t>(parts.size()));
    }
    vkCmdEndRenderPass(cmd);
  });
}

void in_dynamic_rendering(Run& run, const Scope& scope, const Attachments& images, const Drawing& drawing,
                          uint32_t samples, bool suspends) {
  const auto attachment = [&](const Image& image, VkAttachmentLoadOp load, const VkClearValue& clear,
                              VkResolveModeFlagBits mode) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = image.view;
    info.imageLayout = info.resolveImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.resolveMode = mode;
    info.loadOp = load;
    info.clearValue = clear;
    return info;
  };
  std::vector<VkRenderingAttachmentInfo> colors;
  std::vector<VkFormat> color_formats;
  for (uint32_t i = 0; i < kColors; ++i) {
    const VkFormat format = images.colors[i].spec.format;
    const bool whole = format_info(format).numeric == Numeric::kUint;
    colors.push_back(attachment(images.colors[i], scope.color_load[i], scope.clears[i],
                                whole ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : VK_RESOLVE_MODE_AVERAGE_BIT));
    color_formats.push_back(format);
  }
  const VkMultisampledRenderToSingleSampledInfoEXT forced_samples = forced(samples);
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO, &forced_samples};
  rendering.renderArea = scope.area;
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = kColors;
  rendering.pColorAttachments = colors.data();
  VkPipelineRenderingCreateInfo formats{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  formats.colorAttachmentCount = kColors;
  formats.pColorAttachmentFormats = color_formats.data();
  VkRenderingAttachmentInfo depth{}, stencil{};
  if (images.depth) {
    const VkImageAspectFlags aspects = images.depth->aspects();
    if (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) {
      depth = attachment(*images.depth, scope.depth_load, scope.clears[kColors], scope.depth_mode);
      rendering.pDepthAttachment = &depth;
      formats.depthAttachmentFormat = images.depth->spec.format;
    }
    if (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) {
      stencil = attachment(*images.depth, scope.stencil_load, scope.clears[kColors], scope.stencil_mode);
      rendering.pStencilAttachment = &stencil;
      formats.stencilAttachmentFormat = images.depth->spec.format;
    }
  }
  GraphicsSpec spec = drawing.spec;
  spec.next = &formats;
  const VkPipeline pipeline =
      make_pipeline(run, spec, VK_NULL_HANDLE, 0, kColors, kExtent, static_cast<VkSampleCountFlagBits>(samples));
  const uint32_t parts = suspends ? 2 : 1;
  run.once([&](VkCommandBuffer cmd) {
    for (uint32_t part = 0; part < parts; ++part) {
      rendering.flags = part + 1 < parts ? VkRenderingFlags{VK_RENDERING_SUSPENDING_BIT} : 0;
      if (part != 0) rendering.flags |= VK_RENDERING_RESUMING_BIT;
      CTS_COMMAND(run.gpu, CmdBeginRenderingKHR)(cmd, &rendering);
      bind_pipeline(cmd, pipeline);
      bind_vertices(cmd, drawing.vertices);
      draw_part(cmd, scope, part, parts);
      CTS_COMMAND(run.gpu, CmdEndRenderingKHR)(cmd);
    }
  });
}

void put_out(Run& run, const Attachments& images) {
  for (uint32_t i = 0; i < kColors; ++i) run.out("color" + std::to_string(i), images.colors[i]);
  if (images.depth) run.out("depth", *images.depth);
  run.may_be_blank();
}

const AddCase kResume("multisample", "deviation.single_sampled_resume", "single-sampled-resume", case_against_control,
                      [](Run& run) {
                        run.require(run.gpu.has(kExtension), kExtension);
                        const Attachments images = random_attachments(run, 1, false);
                        Drawing drawing = random_drawing(run, images);
                        drawing.vertices = run.buffer_of(colored({{-0.9f, -0.9f, 0, 1},
                                                                  {0, -0.9f, 0, 1},
                                                                  {-0.5f, 0.8f, 0, 1},
                                                                  {0.9f, 0.9f, 0, 1},
                                                                  {0, 0.9f, 0, 1},
                                                                  {0.5f, -0.8f, 0, 1}}));
                        Scope scope = random_scope(run.random, images);
                        scope.area = {{0, 0}, kExtent};
                        for (VkAttachmentLoadOp& load : scope.color_load) load = VK_ATTACHMENT_LOAD_OP_CLEAR;
                        scope.depth_load = scope.stencil_load = VK_ATTACHMENT_LOAD_OP_CLEAR;
                        scope.count = 6;
                        for (const bool suspends : {true, false}) {
                          in_dynamic_rendering(run, scope, images, drawing, 4, suspends);
                          run.out(suspends ? "in_two_parts" : "in_one", images.colors[0]);
                        }
                      });

/// Without suspension, which the reference has wrong.
CTS_RANDOM("multisample", "random_single_sampled", 60) {
  run.require(run.gpu.has(kExtension), kExtension);
  Random& random = run.random;
  const Attachments images = random_attachments(run, 1, false);
  const Drawing drawing = random_drawing(run, images);
  for (uint32_t half = 0; half < 2; ++half) {
    Scope scope = random_scope(random, images);
    scope.count = drawing.count / 2;
    scope.first = half * scope.count;
    if (random.chance(0.5f)) {
      run.note("half" + std::to_string(half), "dynamic");
      in_dynamic_rendering(run, scope, images, drawing, 4, false);
      continue;
    }
    std::vector<Part> parts(1 + random.below(3));
    for (Part& part : parts) part = {random.chance(0.4f), random.chance(0.7f) ? 4u : 1u};
    parts[0].reads = false;
    std::string text = "subpasses";
    for (const Part& part : parts) text += (part.reads ? " reading_" : " plain_") + std::to_string(part.forced);
    run.note("half" + std::to_string(half), text);
    in_render_pass(run, scope, images, drawing, parts);
  }
  put_out(run, images);
}

// ---- explicit samples

/// Multisampled images with the texels of `images` in every sample.
Attachments replicate(Run& run, const Attachments& images, uint32_t samples) {
  TargetSpec target_spec;
  target_spec.width = kExtent.width;
  target_spec.height = kExtent.height;
  target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  target_spec.colors.clear();
  for (const Image& color : images.colors) target_spec.colors.push_back(color.spec.format);
  if (images.depth) target_spec.depth = images.depth->spec.format;
  const Target target = make_target(run, target_spec);
  const VkImageAspectFlags aspects = images.depth ? images.depth->aspects() : 0;
  const VkSampler sampler = run.sampler(VK_FILTER_NEAREST);
  std::vector<Binding> bindings;
  std::string declarations, body;
  const auto add = [&](uint32_t binding, const Image& image, VkImageAspectFlags aspect, const std::string& prefix,
                       const std::string& assignment) {
    Image readable = image;
    readable.view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, image.spec.format, {aspect, 0, 1, images.layer, 1});
    bindings.push_back(sampled(binding, readable, sampler));
    const std::string number = std::to_string(binding);
    declarations += "layout(binding = " + number + ") uniform " + prefix + "sampler2D from" + number + ";\n";
    body += assignment + " = " + (prefix == "u" && binding == 3 ? "int" : "") + "(texelFetch(from" + number +
            ", ivec2(gl_FragCoord.xy), 0)" + (binding >= 2 ? ".x" : "") + ");\n";
  };
  for (uint32_t i = 0; i < kColors; ++i) {
    const bool whole = format_info(images.colors[i].spec.format).numeric == Numeric::kUint;
    const std::string name = "result" + std::to_string(i), prefix = whole ? "u" : "";
    declarations += "layout(location = " + std::to_string(i) + ") out " + prefix + "vec4 " + name + ";\n";
    add(i, images.colors[i], VK_IMAGE_ASPECT_COLOR_BIT, prefix, name);
  }
  if (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) add(2, *images.depth, VK_IMAGE_ASPECT_DEPTH_BIT, "", "gl_FragDepth");
  if (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) {
    declarations = "#extension GL_ARB_shader_stencil_export : require\n" + declarations;
    add(3, *images.depth, VK_IMAGE_ASPECT_STENCIL_BIT, "u", "gl_FragStencilRefARB");
  }
  const Resources res = run.resources(bindings);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = declarations + "void main() {\n" + body + "}\n";
  spec.layout = res.layout;
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
  spec.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  spec.depth.stencilTestEnable = (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_REPLACE, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 0};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res);
  return {target.colors, target.depth, 0};
}

/// The scope in `many`, resolved to `images`.
void in_samples(Run& run, const Scope& scope, const Attachments& images, const Attachments& many,
                const Drawing& drawing) {
  std::vector<VkAttachmentDescription2> attachments;
  std::vector<VkImageView> views;
  const auto add = [&](const Image& image, VkAttachmentLoadOp load, VkAttachmentLoadOp stencil_load) {
    attachments.push_back(describe(image, load, stencil_load));
    views.push_back(image.view);
    return static_cast<uint32_t>(views.size() - 1);
  };
  constexpr VkAttachmentLoadOp kLoad = VK_ATTACHMENT_LOAD_OP_LOAD;
  std::vector<VkAttachmentReference2> colors, resolves;
  for (uint32_t i = 0; i < kColors; ++i)
    colors.push_back(refer(add(many.colors[i], scope.color_load[i], kLoad), VK_IMAGE_ASPECT_COLOR_BIT));
  const VkImageAspectFlags aspects = images.depth ? images.depth->aspects() : 0;
  VkAttachmentReference2 depth{}, single{};
  if (images.depth) depth = refer(add(*many.depth, scope.depth_load, scope.stencil_load), aspects);
  for (uint32_t i = 0; i < kColors; ++i)
    resolves.push_back(refer(add(images.colors[i], kLoad, kLoad), VK_IMAGE_ASPECT_COLOR_BIT));
  if (images.depth) single = refer(add(*images.depth, kLoad, kLoad), aspects);
  const VkSubpassDescriptionDepthStencilResolve modes{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE,
                                                      nullptr, scope.depth_mode, scope.stencil_mode, &single};
  VkSubpassDescription2 subpass{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2, images.depth ? &modes : nullptr};
  subpass.colorAttachmentCount = kColors;
  subpass.pColorAttachments = colors.data();
  subpass.pResolveAttachments = resolves.data();
  subpass.pDepthStencilAttachment = images.depth ? &depth : nullptr;
  VkRenderPassCreateInfo2 info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass;
  CTS_VK(CTS_COMMAND(run.gpu, CreateRenderPass2KHR)(run.device, &info, nullptr, &pass));
  run.own(pass, vkDestroyRenderPass);
  const VkPipeline pipeline = make_pipeline(run, drawing.spec, pass, 0, kColors, kExtent, many.colors[0].spec.samples);
  const VkRenderPassBeginInfo begin = begin_info(run, pass, scope, views);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, drawing.vertices);
    draw_part(cmd, scope, 0, 1);
    vkCmdEndRenderPass(cmd);
  });
}

void random_modes(Random& random, const Attachments& images, Scope& scope) {
  const VkImageAspectFlags aspects = images.depth ? images.depth->aspects() : 0;
  scope.depth_mode = random.pick({VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_AVERAGE_BIT,
                                  VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MAX_BIT});
  scope.stencil_mode = random.pick(
      {VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MAX_BIT});
  if (!(aspects & VK_IMAGE_ASPECT_DEPTH_BIT)) scope.depth_mode = VK_RESOLVE_MODE_NONE;
  if (!(aspects & VK_IMAGE_ASPECT_STENCIL_BIT)) scope.stencil_mode = VK_RESOLVE_MODE_NONE;
  if (scope.depth_mode || scope.stencil_mode) return;
  if (aspects & VK_IMAGE_ASPECT_DEPTH_BIT)
    scope.depth_mode = VK_RESOLVE_MODE_AVERAGE_BIT;
  else
    scope.stencil_mode = VK_RESOLVE_MODE_MAX_BIT;
}

/// `spelled_out`: with samples that are there.
void any_samples(Run& run, bool spelled_out) {
  Random& random = run.random;
  const uint32_t samples = random.pick({2u, 4u, 8u});
  const Attachments images = random_attachments(run, 3, true);
  const Drawing drawing = random_drawing(run, images);
  for (uint32_t half = 0; half < 2; ++half) {
    Scope scope = random_scope(random, images);
    random_modes(random, images, scope);
    scope.count = drawing.count / 2;
    scope.first = half * scope.count;
    const bool dynamic = random.chance(0.5f), suspends = random.chance(0.3f);
    if (spelled_out)
      in_samples(run, scope, images, replicate(run, images, samples), drawing);
    else if (dynamic)
      in_dynamic_rendering(run, scope, images, drawing, samples, suspends);
    else
      in_render_pass(run, scope, images, drawing, {{false, samples}});
  }
  put_out(run, images);
}

CTS_RANDOM("multisample", "random_single_sampled_spelled_out", 40) {
  const Gpu& device = gpus().device;
  run.require(device.has(kExtension), kExtension);
  if (&run.gpu == &device) return any_samples(run, false);
  Run explicit_run(gpus().device, 0, run.index);
  explicit_run.random = run.random;
  any_samples(explicit_run, true);
  run.outputs = std::move(explicit_run.outputs);
}

/// Every format may be slow to resolve; asking for it is what must work.
CTS_CASE("multisample", "resolve_performance_query") {
  run.require(run.gpu.has(kExtension), kExtension);
  VkSubpassResolvePerformanceQueryEXT performance{VK_STRUCTURE_TYPE_SUBPASS_RESOLVE_PERFORMANCE_QUERY_EXT};
  performance.optimal = 77;
  VkFormatProperties2 properties{VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2, &performance};
  vkGetPhysicalDeviceFormatProperties2(run.gpu.physical, VK_FORMAT_R8G8B8A8_UNORM, &properties);
  const Buffer answered = run.buffer_of(std::vector<uint32_t>{performance.optimal <= 1 ? 1u : 0u, 1, 2, 3});
  run.out("answered", answered);
}

}  // namespace
}  // namespace vitrine::cts
