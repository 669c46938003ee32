// Two and eight samples, which the reference lacks: where a device does not offer a count it puts out what the
// specification says instead.
#include "cases/multisample/located.h"
#include "cases/multisample/samples.h"
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Alpha grows with x; alpha to coverage keeps sample s of n where alpha > s / n (lavapipe-rasterization.md 8.6).
void alpha_to_coverage(Run& run, uint32_t samples, bool to_one) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  if (!draws(run, samples)) {
    std::vector<float> values;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          const float alpha = static_cast<float>(x) / 32;
          const bool kept = alpha > static_cast<float>(s) / static_cast<float>(samples);
          values.insert(values.end(), {0, 0, kept ? 1.0f : 0.0f, !kept ? 0 : to_one ? 1 : alpha});
        }
    put(run, "color", kExtent, samples, values);
    return;
  }
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  Target target = make_target(run, target_spec);
  target.clears[0] = {};
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "layout(location = 0) out vec4 result;\n"
      "void main() { result = vec4(0, 0, 1, floor(gl_FragCoord.x) / 32); }\n";
  spec.multisample.alphaToCoverageEnable = VK_TRUE;
  spec.multisample.alphaToOneEnable = to_one;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  put(run, "color", kExtent, samples, fetch(run, target.colors[0], VK_IMAGE_ASPECT_COLOR_BIT));
}

// ---- images of samples

/// A number per sample and pixel, exact in every format used here.
float sample_value(uint32_t s, uint32_t x, uint32_t y) { return static_cast<float>((s * 89 + x * 7 + y * 13) % 256); }

const char kSampleValueFragment[] =
    "layout(location = 0) out VECTOR result;\n"
    "void main() {\n"
    "  int value = (gl_SampleID * 89 + int(gl_FragCoord.x) * 7 + int(gl_FragCoord.y) * 13) % 256;\n"
    "  result = VECTOR(value, 255 - value, 0, 255) / SCALE;\n"
    "}\n";

/// In the render pass and by command: floats are averaged, sample by sample, integers take sample 0.
void resolve(Run& run, uint32_t samples, VkFormat format) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  const bool bytes = format == VK_FORMAT_R8G8B8A8_UNORM, whole = format == VK_FORMAT_R32G32B32A32_UINT;
  if (!draws(run, samples)) {
    std::vector<float> floats;
    std::vector<uint32_t> words;
    for (uint32_t y = 0; y < kSide; ++y)
      for (uint32_t x = 0; x < kSide; ++x)
        for (uint32_t c = 0; c < 4; ++c) {
          float sum = 0;
          const auto value = [&](uint32_t s) {
            const float v = sample_value(s, x, y);
            return c == 0 ? v : c == 1 ? 255 - v : c == 2 ? 0 : 255;
          };
          for (uint32_t s = 0; s < samples; ++s) sum += bytes ? value(s) * (1.0f / 255.0f) : value(s);
          const float average = sum * (1.0f / static_cast<float>(samples));
          // To nearest by adding 2^15: a byte's unit is the last bit of the sum.
          const float clamped = std::min(average, 1.0f) * (255.0f / 256.0f) + 32768.0f;
          uint32_t low;
          std::memcpy(&low, &clamped, 4);
          floats.push_back(bytes ? static_cast<float>(low & 0xff) * (1.0f / 255.0f) : average);
          words.push_back(static_cast<uint32_t>(value(0)));
        }
    for (const char* name : {"in_pass", "by_command"}) {
      if (whole)
        put(run, name, kExtent, 1, words);
      else
        put(run, name, kExtent, 1, floats);
    }
    return;
  }
  TargetSpec target_spec;
  target_spec.colors = {format};
  target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  target_spec.resolve = true;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = std::string("#define VECTOR ") + (whole ? "uvec4\n" : "vec4\n") + "#define SCALE " +
                  (whole   ? "1u\n"
                   : bytes ? "255.0\n"
                           : "1.0\n") +
                  kSampleValueFragment;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  ImageSpec single;
  single.format = format;
  single.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image resolved = run.image(single);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
    run.barrier(cmd);
    const VkImageResolve region{target.colors[0].layers(), {}, resolved.layers(), {}, {kSide, kSide, 1}};
    vkCmdResolveImage(cmd, target.colors[0].handle, VK_IMAGE_LAYOUT_GENERAL, resolved.handle, VK_IMAGE_LAYOUT_GENERAL,
                      1, &region);
  });
  Image in_pass = target.resolves[0];
  ImageSpec copy_spec = single;
  const Image copy = run.image(copy_spec);
  run.once([&](VkCommandBuffer cmd) {
    const VkImageCopy region{in_pass.layers(), {}, copy.layers(), {}, {kSide, kSide, 1}};
    vkCmdCopyImage(cmd, in_pass.handle, VK_IMAGE_LAYOUT_GENERAL, copy.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  });
  put(run, "in_pass", kExtent, 1, fetch(run, copy, VK_IMAGE_ASPECT_COLOR_BIT));
  put(run, "by_command", kExtent, 1, fetch(run, resolved, VK_IMAGE_ASPECT_COLOR_BIT));
}

/// Stores to every sample, a copy of a part to a cleared image, and loads.
void storage_copy_clear(Run& run, uint32_t samples) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  constexpr VkOffset3D kFrom{5, 9, 0}, kTo{20, 3, 0};
  constexpr VkExtent3D kCopied{33, 27, 1};
  const auto stored = [](uint32_t s, uint32_t x, uint32_t y) { return s << 20 | y << 10 | x; };
  if (!draws(run, samples)) {
    std::vector<uint32_t> first, second;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          const uint32_t dx = x - kTo.x, dy = y - kTo.y;
          const bool inside = dx < kCopied.width && dy < kCopied.height;
          first.insert(first.end(), {stored(s, x, y), 0, 0, 1});
          second.insert(second.end(), {inside ? stored(s, dx + kFrom.x, dy + kFrom.y) : 77, 0, 0, 1});
        }
    put(run, "stored", kExtent, samples, first);
    put(run, "copied", kExtent, samples, second);
    put(run, "loaded", kExtent, samples, first);
    return;
  }
  run.require(run.gpu.features.shaderStorageImageMultisample, "shaderStorageImageMultisample");
  ImageSpec spec;
  spec.format = VK_FORMAT_R32_UINT;
  spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image image = run.image(spec), copy = run.image(spec);
  const Buffer loaded = run.buffer(size_t{16} * kSide * kSide * samples);
  const Resources res = run.resources({storage_image(0, image), storage_buffer(1, loaded)});
  const std::string head =
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(binding = 0, r32ui) uniform uimage2DMS image;\n"
      "layout(binding = 1) buffer Loaded { uvec4 loaded[]; };\n"
      "void main() {\n"
      "  uvec3 at = gl_GlobalInvocationID;\n";
  const VkPipeline store = run.compute(
      res.layout,
      run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                 head + "  imageStore(image, ivec2(at.xy), int(at.z), uvec4(at.z << 20 | at.y << 10 | at.x));\n}\n"));
  const VkPipeline load = run.compute(
      res.layout,
      run.shader(
          VK_SHADER_STAGE_COMPUTE_BIT,
          head + "  loaded[(at.z * 64u + at.y) * 64u + at.x] = imageLoad(image, ivec2(at.xy), int(at.z));\n}\n"));
  run.once([&](VkCommandBuffer cmd) {
    VkClearColorValue color{};
    color.uint32[0] = 77;
    const VkImageSubresourceRange range = copy.range();
    vkCmdClearColorImage(cmd, copy.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, store);
    vkCmdDispatch(cmd, kSide / 8, kSide / 8, samples);
    run.barrier(cmd);
    const VkImageCopy region{image.layers(), kFrom, copy.layers(), kTo, kCopied};
    vkCmdCopyImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, copy.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, load);
    vkCmdDispatch(cmd, kSide / 8, kSide / 8, samples);
  });
  put(run, "stored", kExtent, samples, fetch(run, image, VK_IMAGE_ASPECT_COLOR_BIT));
  put(run, "copied", kExtent, samples, fetch(run, copy, VK_IMAGE_ASPECT_COLOR_BIT));
  put(run, "loaded", kExtent, samples,
      std::vector<uint32_t>(loaded.as<uint32_t>(), loaded.as<uint32_t>() + loaded.size / 4));
}

/// Each sample takes what an input attachment holds in the next sample.
void input_attachment_of_samples(Run& run, uint32_t samples) {
  constexpr VkExtent2D kExtent{kSide, kSide};
  if (!draws(run, samples)) {
    std::vector<float> values;
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
          const float v = sample_value((s + 1) % samples, x, y);
          values.insert(values.end(), {v, 255 - v, 0, 255});
        }
    put(run, "color", kExtent, samples, values);
    return;
  }
  ImageSpec spec;
  spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image written = run.image(spec), result = run.image(spec);
  VkAttachmentDescription attachment{};
  attachment.format = spec.format;
  attachment.samples = spec.samples;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.initialLayout = attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  const VkAttachmentDescription attachments[] = {attachment, attachment};
  const VkAttachmentReference references[] = {{0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}};
  VkSubpassDescription subpasses[2]{};
  subpasses[0].colorAttachmentCount = subpasses[1].colorAttachmentCount = subpasses[1].inputAttachmentCount = 1;
  subpasses[0].pColorAttachments = subpasses[1].pInputAttachments = &references[0];
  subpasses[1].pColorAttachments = &references[1];
  const VkSubpassDependency dependency{0,
                                       1,
                                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                       VK_ACCESS_INPUT_ATTACHMENT_READ_BIT,
                                       VK_DEPENDENCY_BY_REGION_BIT};
  VkRenderPassCreateInfo pass_info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  pass_info.attachmentCount = pass_info.subpassCount = 2;
  pass_info.pAttachments = attachments;
  pass_info.pSubpasses = subpasses;
  pass_info.dependencyCount = 1;
  pass_info.pDependencies = &dependency;
  VkRenderPass pass;
  CTS_VK(vkCreateRenderPass(run.device, &pass_info, nullptr, &pass));
  run.own(pass, vkDestroyRenderPass);
  const VkImageView views[] = {written.view, result.view};
  VkFramebufferCreateInfo framebuffer_info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  framebuffer_info.renderPass = pass;
  framebuffer_info.attachmentCount = 2;
  framebuffer_info.pAttachments = views;
  framebuffer_info.width = framebuffer_info.height = kSide;
  framebuffer_info.layers = 1;
  VkFramebuffer framebuffer;
  CTS_VK(vkCreateFramebuffer(run.device, &framebuffer_info, nullptr, &framebuffer));
  run.own(framebuffer, vkDestroyFramebuffer);
  const Resources res = run.resources({input_attachment(0, written)});
  GraphicsSpec write;
  write.vertex = kFullScreenVertex;
  write.fragment = std::string("#define VECTOR vec4\n#define SCALE 1.0\n") + kSampleValueFragment;
  GraphicsSpec read;
  read.vertex = kFullScreenVertex;
  read.fragment =
      "layout(input_attachment_index = 0, binding = 0) uniform subpassInputMS written;\n"
      "layout(location = 0) out vec4 result;\n"
      "void main() { result = subpassLoad(written, (gl_SampleID + 1) % " +
      std::to_string(samples) + "); }\n";
  read.layout = res.layout;
  const VkPipeline first = make_pipeline(run, write, pass, 0, 1, kExtent, spec.samples);
  const VkPipeline second = make_pipeline(run, read, pass, 1, 1, kExtent, spec.samples);
  run.once([&](VkCommandBuffer cmd) {
    const VkClearValue clears[2]{};
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, kExtent};
    begin.clearValueCount = 2;
    begin.pClearValues = clears;
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, first);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, second);
    res.bind(cmd);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  put(run, "color", kExtent, samples, fetch(run, result, VK_IMAGE_ASPECT_COLOR_BIT));
}

/// Without attachments the pipeline's count holds: runs per sample and samples that pass are counted.
void without_attachments(Run& run, uint32_t samples) {
  std::vector<uint32_t> counted(8, 0);
  if (!draws(run, samples)) {
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) counted[s] += covered(standard_places(samples)[s], x, y) ? 1 : 0;
    put(run, "runs", {2, 1}, 1, counted);
    return;
  }
  TargetSpec target_spec;
  target_spec.colors.clear();
  target_spec.samples = static_cast<VkSampleCountFlagBits>(samples);
  const Target target = make_target(run, target_spec);
  const Buffer runs = run.buffer_of(counted);
  const Resources res = run.resources({storage_buffer(0, runs)});
  GraphicsSpec spec;
  spec.vertex = kCutVertex;
  spec.fragment =
      "layout(binding = 0) buffer Runs { uint runs[8]; };\n"
      "void main() { atomicAdd(runs[gl_SampleID], 1u); }\n";
  spec.layout = res.layout;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res);
  put(run, "runs", {2, 1}, 1, std::vector<uint32_t>(runs.as<uint32_t>(), runs.as<uint32_t>() + 8));
}

/// Without attachments each pipeline of a subpass has a count of its own (variableMultisampleRate).
void several_counts(Run& run) {
  const uint32_t kCounts[] = {4, 1, 8, 2};
  std::vector<uint32_t> counted(8 * std::size(kCounts), 0);
  if (!draws(run, 8)) {
    for (size_t i = 0; i < std::size(kCounts); ++i)
      for (uint32_t s = 0; s < kCounts[i]; ++s)
        for (uint32_t y = 0; y < kSide; ++y)
          for (uint32_t x = 0; x < kSide; ++x)
            counted[8 * i + s] += covered(kCounts[i] == 1 ? Place{8, 8} : standard_places(kCounts[i])[s], x, y) ? 1 : 0;
    put(run, "runs", {8, 1}, 1, counted);
    return;
  }
  run.require(run.gpu.features.variableMultisampleRate, "variableMultisampleRate");
  TargetSpec target_spec;
  target_spec.colors.clear();
  Target target = make_target(run, target_spec);
  const Buffer runs = run.buffer_of(counted);
  const Resources res = run.resources({storage_buffer(0, runs)});
  std::vector<VkPipeline> pipelines;
  for (size_t i = 0; i < std::size(kCounts); ++i) {
    target.spec.samples = static_cast<VkSampleCountFlagBits>(kCounts[i]);
    GraphicsSpec spec;
    spec.vertex = kCutVertex;
    spec.fragment = "layout(binding = 0) buffer Runs { uint runs[32]; };\nvoid main() { atomicAdd(runs[" +
                    std::to_string(8 * i) + " + gl_SampleID], 1u); }\n";
    spec.layout = res.layout;
    pipelines.push_back(make_pipeline(run, spec, target));
  }
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    res.bind(cmd);
    for (const VkPipeline pipeline : pipelines) {
      bind_pipeline(cmd, pipeline);
      vkCmdDraw(cmd, 3, 1, 0, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  put(run, "runs", {8, 1}, 1, std::vector<uint32_t>(runs.as<uint32_t>(), runs.as<uint32_t>() + counted.size()));
}

const bool kRegistered = [] {
  AddCase("multisample", "several_counts", several_counts);
  for (const uint32_t samples : {2u, 4u, 8u}) {
    const std::string suffix = ".samples_" + std::to_string(samples);
    static const char* const kGenerators[] = {
        nullptr, nullptr, "random_triangles.samples_2", nullptr, "random_triangles.samples_4", nullptr,
        nullptr, nullptr, "random_triangles.samples_8"};
    AddGenerator("multisample", kGenerators[samples], 20,
                 [=](Run& run) { samples_as_viewports(run, standard(samples)); });
    for (size_t i = 0; i < kSeenCount; ++i) {
      AddCase("multisample", kSeenNames[i] + suffix,
              [=](Run& run) { seen_by_shaders(run, standard(samples), i, ~0u); });
      AddCase("multisample", kSeenNames[i] + std::string("_masked") + suffix,
              [=](Run& run) { seen_by_shaders(run, standard(samples), i, 0x5a); });
    }
    AddCase("multisample", "alpha_to_coverage" + suffix, [=](Run& run) { alpha_to_coverage(run, samples, false); });
    AddCase("multisample", "alpha_to_one" + suffix, [=](Run& run) { alpha_to_coverage(run, samples, true); });
    AddCase("multisample", "resolve.float" + suffix,
            [=](Run& run) { resolve(run, samples, VK_FORMAT_R32G32B32A32_SFLOAT); });
    AddCase("multisample", "resolve.unorm" + suffix,
            [=](Run& run) { resolve(run, samples, VK_FORMAT_R8G8B8A8_UNORM); });
    AddCase("multisample", "resolve.uint" + suffix,
            [=](Run& run) { resolve(run, samples, VK_FORMAT_R32G32B32A32_UINT); });
    AddCase("multisample", "storage_copy_clear" + suffix, [=](Run& run) { storage_copy_clear(run, samples); });
    AddCase("multisample", "input_attachment" + suffix, [=](Run& run) { input_attachment_of_samples(run, samples); });
    AddCase("multisample", "without_attachments" + suffix, [=](Run& run) { without_attachments(run, samples); });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
