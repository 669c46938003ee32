// Fragment shading rates (VK_KHR_fragment_shading_rate), which the reference lacks: rates of the pipeline, of
// primitives and of an attachment. On the reference the shader works out which fragment its pixel would be a part of,
// with the rules of the specification written in GLSL.
#include <algorithm>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// What a draw asks for.
struct Rates {
  VkExtent2D size{1, 1};
  VkFragmentShadingRateCombinerOpKHR ops[2]{};
  bool of_primitives = false, attached = false, dynamic = false;
  VkExtent2D texel{8, 8};
  uint32_t columns = 1, rows = 1, layers = 1;  ///< of the attachment
};

Rates random_rates(Random& random, const TargetSpec& target) {
  Rates rates;
  rates.size = {1u << random.below(3), 1u << random.below(3)};
  for (auto& op : rates.ops) op = static_cast<VkFragmentShadingRateCombinerOpKHR>(random.below(5));
  rates.of_primitives = random.chance(0.5f);
  rates.attached = random.chance(0.5f);
  rates.dynamic = random.chance(0.5f);
  rates.texel = {8u << random.below(3), 8u << random.below(3)};
  rates.columns = (target.width + rates.texel.width - 1) / rates.texel.width;
  rates.rows = (target.height + rates.texel.height - 1) / rates.texel.height;
  rates.layers = target.layers > 1 && random.chance(0.5f) ? target.layers : 1;
  return rates;
}

/// What a vertex has; the texels of the attachment, one a word.
constexpr const char* kData =
    "struct V { vec4 position; uint rate, id; vec2 value; };\n"
    "layout(std430, binding = 0) readonly buffer B { V v[]; };\n"
    "layout(std430, binding = 1) readonly buffer T { uint texels[]; };\n";

/// Vulkan 1.3.239, Combining the Fragment Shading Rates, of 2^x times 2^y pixels: `limit` is the binary logarithm of
/// the most pixels that a fragment of the draw's samples may have.
std::string combining(const Rates& rates, uint32_t samples) {
  const uint32_t limit = samples == 1 ? 5 : samples == 2 ? 4 : samples == 4 ? 3 : 2;
  const auto number = [](uint32_t value) { return std::to_string(value); };
  const uint32_t w = rates.size.width / 2, h = rates.size.height / 2;
  return "uvec2 clamped(uvec2 r) {\n  r = min(r, uvec2(2));\n  uvec2 best = uvec2(0);\n"
         "  for (uint x = 0; x <= r.x; ++x) for (uint y = 0; y <= r.y; ++y) {\n"
         "    if (x + y > " +
         number(limit) +
         ") continue;\n    uint sum = (1 << x) + (1 << y), best_sum = (1 << best.x) + (1 << best.y);\n"
         "    if (x + y > best.x + best.y || (x + y == best.x + best.y && (sum < best_sum ||\n"
         "        (sum == best_sum && x > best.x)))) best = uvec2(x, y);\n  }\n  return best;\n}\n"
         "uvec2 combine(int op, uvec2 a, uvec2 b) {\n"
         "  return op == 0 ? a : op == 1 ? b : op == 2 ? min(a, b) : op == 3 ? max(a, b) : a + b;\n}\n"
         "uvec2 rate_of(uint primitive, uint texel) {\n  uvec2 a = clamped(uvec2(" +
         number(w) + ", " + number(h) + "));\n  uvec2 b = clamped(uvec2(primitive >> 2 & 3u, primitive & 3u));\n" +
         "  a = clamped(combine(" + number(rates.ops[0]) + ", a, b));\n" +
         "  b = clamped(uvec2(texel >> 2 & 3u, texel & 3u));\n  return clamped(combine(" + number(rates.ops[1]) +
         ", a, b));\n}\n";
}

/// `writes`: the rate of primitives.
std::string vertex_shader(bool writes) {
  return std::string(writes ? "#extension GL_EXT_fragment_shading_rate : require\n" : "") + kData +
         "layout(location = 0) flat out uvec2 numbers;\nlayout(location = 1) noperspective out vec2 value;\n"
         "void main() {\n  V own = v[gl_VertexIndex];\n  numbers = uvec2(own.rate, own.id);\n  value = own.value;\n"
         "  gl_Position = own.position;\n" +
         (writes ? "  gl_PrimitiveShadingRateEXT = int(own.rate);\n" : "") + "}\n";
}

/// Hands triangles on.
std::string geometry_shader(bool writes) {
  return std::string(writes ? "#extension GL_EXT_fragment_shading_rate : require\n" : "") +
         "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n"
         "layout(location = 0) flat in uvec2 numbers[];\nlayout(location = 1) noperspective in vec2 value[];\n"
         "layout(location = 0) flat out uvec2 out_numbers;\nlayout(location = 1) noperspective out vec2 out_value;\n"
         "void main() {\n  for (int i = 0; i < 3; ++i) {\n    out_numbers = numbers[i];\n    out_value = value[i];\n"
         "    gl_Position = gl_in[i].gl_Position;\n" +
         (writes ? "    gl_PrimitiveShadingRateEXT = int(numbers[i].x);\n" : "") + "    EmitVertex();\n  }\n}\n";
}

struct Ways {
  bool drops = false, depth = false, multiview = false, geometry = false;
};

std::string fragment_shader(const Rates& rates, uint32_t samples, const Ways& ways, bool has) {
  std::string code = has ? "#extension GL_EXT_fragment_shading_rate : require\n" : "";
  if (ways.multiview) code += "#extension GL_EXT_multiview : require\n";
  code += std::string(kData) +
          "layout(location = 0) flat in uvec2 numbers;\nlayout(location = 1) noperspective in vec2 value;\n"
          "layout(location = 0) out uvec4 r0;\nlayout(location = 1) out vec4 r1;\n";
  if (!has) code += combining(rates, samples);
  code += "void main() {\n";
  if (has) {
    code +=
        "  uint rate = gl_ShadingRateEXT;\n  vec2 center = gl_FragCoord.xy, at = value;\n"
        "  vec2 steps = vec2(dFdx(gl_FragCoord.x), dFdy(gl_FragCoord.y));\n";
  } else {
    const std::string layer =
        ways.multiview && rates.layers > 1 ? " + gl_ViewIndex * " + std::to_string(rates.columns * rates.rows) : "";
    code +=
        "  uvec2 pixel = uvec2(gl_FragCoord.xy);\n  uint texel = " +
        (rates.attached ? "texels[pixel.x / " + std::to_string(rates.texel.width) + " + pixel.y / " +
                              std::to_string(rates.texel.height) + " * " + std::to_string(rates.columns) + layer + "]"
                        : std::string("0")) +
        ";\n  uvec2 logs = rate_of(" + (rates.of_primitives ? "numbers.x" : "0") +
        ", texel);\n  uint rate = logs.x << 2 | logs.y;\n  vec2 steps = vec2(1u << logs.x, 1u << logs.y);\n"
        "  vec2 center = vec2(pixel >> logs << logs) + 0.5 * steps;\n"
        "  vec2 at = interpolateAtOffset(value, center - gl_FragCoord.xy);\n";
  }
  if (ways.drops) code += "  if (((uint(center.x) * 7u ^ uint(center.y) * 5u ^ numbers.y) & 3u) == 0) discard;\n";
  if (ways.depth) code += "  gl_FragDepth = fract(center.x * 0.37 + center.y * 0.11 + float(numbers.y) * 0.05);\n";
  return code + "  r0 = uvec4(uvec2(2.0 * center), rate + 1, numbers.y);\n  r1 = vec4(at, steps);\n}\n";
}

/// `inside`: nothing is clipped.
std::vector<uint32_t> random_vertices(Random& random, uint32_t triangles, bool inside) {
  std::vector<uint32_t> words;
  const auto add = [&](float value) {
    uint32_t word;
    std::memcpy(&word, &value, sizeof word);
    words.push_back(word);
  };
  for (uint32_t i = 0; i < triangles; ++i) {
    const float x = random.real(-0.9f, 0.9f), y = random.real(-0.9f, 0.9f), size = random.chance(0.3f) ? 2.0f : 0.3f;
    for (int c = 0; c < 3; ++c) {
      for (const float from : {x, y}) {
        const float at = from + random.real(-size, size);
        add(inside ? std::clamp(at, -1.0f, 1.0f) : at);
      }
      add(random.real(0, 1));
      add(1);
      words.push_back(random.below(3) << 2 | random.below(3));
      words.push_back(i);
      add(random.real(-4, 4));
      add(random.real(-4, 4));
    }
  }
  return words;
}

/// The device's target with the attachment beside those that it has: the same render pass, made by its second form.
void attach(Run& run, Target& target, const Rates& rates, const Image& image) {
  std::vector<VkAttachmentDescription2> attachments;
  std::vector<VkAttachmentReference2> references;
  std::vector<VkImageView> views;
  const auto add = [&](const Image& attached, VkAttachmentLoadOp load) {
    VkAttachmentDescription2 a{VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2};
    a.format = attached.spec.format;
    a.samples = attached.spec.samples;
    a.loadOp = a.stencilLoadOp = load;
    a.storeOp = a.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
    a.initialLayout = a.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    VkAttachmentReference2 r{VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2};
    r.attachment = static_cast<uint32_t>(attachments.size());
    r.layout = VK_IMAGE_LAYOUT_GENERAL;
    r.aspectMask = attached.aspects();
    attachments.push_back(a);
    references.push_back(r);
    views.push_back(attached.view);
  };
  for (const Image& color : target.colors) add(color, VK_ATTACHMENT_LOAD_OP_CLEAR);
  if (target.depth) add(*target.depth, VK_ATTACHMENT_LOAD_OP_CLEAR);
  add(image, VK_ATTACHMENT_LOAD_OP_DONT_CARE);
  VkFragmentShadingRateAttachmentInfoKHR rate{VK_STRUCTURE_TYPE_FRAGMENT_SHADING_RATE_ATTACHMENT_INFO_KHR};
  rate.pFragmentShadingRateAttachment = &references.back();
  rate.shadingRateAttachmentTexelSize = rates.texel;
  VkSubpassDescription2 subpass{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2, &rate};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = static_cast<uint32_t>(target.colors.size());
  subpass.pColorAttachments = references.data();
  if (target.depth) subpass.pDepthStencilAttachment = &references[target.colors.size()];
  subpass.viewMask = target.spec.view_mask;
  VkRenderPassCreateInfo2 info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  CTS_VK(CTS_COMMAND(run.gpu, CreateRenderPass2KHR)(run.device, &info, nullptr, &target.pass));
  run.own(target.pass, vkDestroyRenderPass);
  target.framebuffer = make_framebuffer(run, target.pass, views, {target.spec.width, target.spec.height},
                                        target.spec.view_mask ? 1 : target.spec.layers);
}

Image rate_image(Run& run, const Rates& rates, const std::vector<uint32_t>& texels) {
  ImageSpec spec;
  spec.format = VK_FORMAT_R8_UINT;
  spec.extent = {rates.columns, rates.rows, 1};
  spec.layers = rates.layers;
  if (rates.layers > 1) spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  spec.usage = VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
  const Image image = run.image(spec);
  std::vector<unsigned char> bytes(texels.begin(), texels.end());
  run.upload(image, 0, bytes);
  return image;
}

/// Begins dynamic rendering to the target, with the attachment beside it.
void begin_rendering(Run& run, VkCommandBuffer cmd, const Target& target, const Rates& rates, VkImageView attached) {
  std::vector<VkRenderingAttachmentInfo> attachments;
  std::size_t at = 0;
  const auto add = [&](const Image& image) {
    VkRenderingAttachmentInfo& info = attachments.emplace_back();
    info = {VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = image.view;
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    info.clearValue = target.clears[at++];
  };
  for (const Image& color : target.colors) add(color);
  if (target.depth) add(*target.depth);
  VkRenderingFragmentShadingRateAttachmentInfoKHR rate{
      VK_STRUCTURE_TYPE_RENDERING_FRAGMENT_SHADING_RATE_ATTACHMENT_INFO_KHR};
  rate.imageView = attached;
  rate.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  rate.shadingRateAttachmentTexelSize = rates.texel;
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO, &rate};
  info.renderArea = target.rect();
  info.layerCount = target.spec.view_mask ? 1 : target.spec.layers;
  info.viewMask = target.spec.view_mask;
  info.colorAttachmentCount = static_cast<uint32_t>(target.colors.size());
  info.pColorAttachments = attachments.data();
  if (target.depth) info.pDepthAttachment = &attachments.back();
  CTS_COMMAND(run.gpu, CmdBeginRenderingKHR)(cmd, &info);
}

CTS_RANDOM("rasterization", "random_shading_rate", 120) {
  run.require(gpus().device.extension_features.pipelineFragmentShadingRate, "VK_KHR_fragment_shading_rate");
  Random& random = run.random;
  const bool has = run.gpu.extension_features.pipelineFragmentShadingRate;
  const bool renders = random.chance(0.4f) && has && run.gpu.extension_features.dynamicRendering;
  Ways ways;
  ways.drops = random.chance(0.4f);
  ways.depth = random.chance(0.3f);
  ways.multiview = random.chance(0.2f);
  ways.geometry = random.chance(0.2f) && run.gpu.features.geometryShader && !ways.multiview;
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R16G16B16A16_UINT, VK_FORMAT_R32G32B32A32_SFLOAT};
  target_spec.width = 20 + random.below(120);
  target_spec.height = 20 + random.below(120);
  target_spec.depth = random.pick({VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM});
  if (random.chance(0.4f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  if (ways.multiview) {
    target_spec.layers = 2;
    target_spec.view_mask = 3;
  }
  Target target = make_target(run, target_spec);
  const Rates rates = random_rates(random, target_spec);
  std::vector<uint32_t> texels(std::size_t{rates.columns} * rates.rows * rates.layers);
  for (uint32_t& texel : texels) texel = random.below(3) << 2 | random.below(3);
  const uint32_t triangles = 1 + random.below(30);
  // What is clipped goes to one layer of several views on the reference (deviations.md, multiview-layers).
  const Buffer vertices = run.buffer_of(random_vertices(random, triangles, ways.multiview)),
               words = run.buffer_of(texels);
  const Resources res = run.resources({storage_buffer(0, vertices), storage_buffer(1, words)});
  std::optional<Image> attached;
  if (has && rates.attached) attached = rate_image(run, rates, texels);
  if (attached && !renders) attach(run, target, rates, *attached);
  GraphicsSpec spec;
  spec.layout = res.layout;
  const bool writes = has && rates.of_primitives;
  spec.vertex = vertex_shader(writes);
  // What an earlier stage writes does not count.
  if (ways.geometry) spec.geometry = geometry_shader(writes);
  spec.fragment = fragment_shader(rates, target_spec.samples, ways, has);
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = target_spec.depth != VK_FORMAT_UNDEFINED;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  VkPipelineFragmentShadingRateStateCreateInfoKHR state{
      VK_STRUCTURE_TYPE_PIPELINE_FRAGMENT_SHADING_RATE_STATE_CREATE_INFO_KHR};
  state.fragmentSize = rates.size;
  std::copy_n(rates.ops, 2, state.combinerOps);
  if (has && rates.dynamic) {
    spec.dynamic.push_back(VK_DYNAMIC_STATE_FRAGMENT_SHADING_RATE_KHR);
  } else if (has) {
    spec.next = &state;
  }
  VkPipelineRenderingCreateInfo formats{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO, spec.next};
  formats.viewMask = target_spec.view_mask;
  formats.colorAttachmentCount = static_cast<uint32_t>(target.spec.colors.size());
  formats.pColorAttachmentFormats = target.spec.colors.data();
  formats.depthAttachmentFormat = target_spec.depth;
  if (renders) {
    spec.next = &formats;
    if (attached) spec.flags = VK_PIPELINE_CREATE_RENDERING_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
    target.pass = VK_NULL_HANDLE;
  }
  run.note("vertex", spec.vertex);
  run.note("fragment", spec.fragment);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    if (renders)
      begin_rendering(run, cmd, target, rates, attached ? attached->view : VK_NULL_HANDLE);
    else
      target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    if (has && rates.dynamic) CTS_COMMAND(run.gpu, CmdSetFragmentShadingRateKHR)(cmd, &rates.size, rates.ops);
    vkCmdDraw(cmd, 3 * triangles, 1, 0, 0);
    if (renders)
      CTS_COMMAND(run.gpu, CmdEndRenderingKHR)(cmd);
    else
      vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

/// Side effects happen once for each fragment, whatever it covers: on the reference in its first pixel.
CTS_RANDOM("rasterization", "shading_rate_invocations", 18) {
  run.require(gpus().device.extension_features.pipelineFragmentShadingRate, "VK_KHR_fragment_shading_rate");
  Random& random = run.random;
  const bool has = run.gpu.extension_features.pipelineFragmentShadingRate;
  run.require(run.gpu.features.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
  const VkExtent2D size{1u << run.index % 3, 1u << run.index / 3 % 3};
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32_UINT};
  target_spec.width = 61;
  target_spec.height = 59;
  if (run.index >= 9) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Target target = make_target(run, target_spec);
  // Samples leak from scissors on the reference (deviations.md, multisample-scissor).
  VkRect2D area{{static_cast<int32_t>(random.below(20)), static_cast<int32_t>(random.below(20))},
                {1 + random.below(40), 1 + random.below(40)}};
  if (run.index >= 9) area = target.rect();
  const Buffer counts = run.buffer_of(std::vector<uint32_t>(2));
  const Resources res = run.resources({storage_buffer(0, counts)});
  const auto number = [](uint32_t value) { return std::to_string(value); };
  // Of sixteen pixels with four samples each there is no room for masks: 4x2.
  const uint32_t height = run.index == 17 ? 2 : size.height;
  const std::string extent = "uvec2(" + number(size.width) + ", " + number(height) + ")";
  GraphicsSpec spec;
  spec.layout = res.layout;
  // Nothing of the triangle is clipped: an edge in it would be shaded from both sides.
  spec.vertex =
      "void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0, 0.5, 1.0); }";
  spec.viewports = {{0, 0, 256, 256, 0, 1}};
  spec.scissors = {area};
  spec.fragment =
      std::string(has ? "#extension GL_EXT_fragment_shading_rate : require\n" : "") +
      "layout(std430, binding = 0) buffer B { uint count, sum; };\nlayout(location = 0) out uvec2 c;\n"
      "void main() {\n  uvec2 size = " +
      extent + ", at = uvec2(gl_FragCoord.xy) / size;\n" +
      (has ? "  bool first = true;\n"
           : "  bool first = uvec2(gl_FragCoord.xy) == max(at * size, uvec2(" +
                 number(static_cast<uint32_t>(area.offset.x)) + ", " + number(static_cast<uint32_t>(area.offset.y)) +
                 "));\n") +
      "  if (first) {\n    atomicAdd(count, 1);\n    atomicAdd(sum, at.x * 7u + at.y * 31u);\n  }\n  c = at;\n}\n";
  VkPipelineFragmentShadingRateStateCreateInfoKHR state{
      VK_STRUCTURE_TYPE_PIPELINE_FRAGMENT_SHADING_RATE_STATE_CREATE_INFO_KHR};
  state.fragmentSize = size;
  if (has) spec.next = &state;
  draw_once(run, target, make_pipeline(run, spec, target), &res);
  out_target(run, target);
  run.out("invocations", counts);
}

}  // namespace
}  // namespace vitrine::cts
