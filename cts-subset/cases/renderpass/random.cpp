// Random render passes: one to four subpasses over shared attachments, input attachments, load and store operations,
// resolves, render areas.
#include "harness/case.h"
#include "harness/graphics.h"
#include "harness/random_clear.h"

namespace vitrine::cts {
namespace {

struct Attachment {
  Image image;
  VkAttachmentLoadOp load, stencil_load;
  VkClearValue clear;
};

struct Subpass {
  std::vector<uint32_t> colors, inputs;  ///< attachment numbers
  bool depth = false, resolve = false;
};

struct Plan {
  uint32_t width, height;
  VkSampleCountFlagBits samples;
  std::vector<Attachment> colors;
  std::vector<Image> resolves;
  Attachment depth;
  bool has_depth;
  std::vector<Subpass> subpasses;
};

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() { passed = color; gl_Position = position; })";

Plan random_plan(Run& run) {
  Random& random = run.random;
  Plan plan;
  plan.width = 16 + random.below(80);
  plan.height = 16 + random.below(80);
  plan.samples = random.chance(0.25f) ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
  plan.has_depth = random.chance(0.6f);
  ImageSpec spec;
  spec.extent = {plan.width, plan.height, 1};
  spec.samples = plan.samples;
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  const auto op = [&] { return static_cast<VkAttachmentLoadOp>(random.below(2)); };  // LOAD or CLEAR
  for (uint32_t n = 1 + random.below(3); n > 0; --n) {
    spec.format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                               VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT});
    plan.colors.push_back({run.image(spec), op(), op(), random_clear(random, spec.format, 1.0f)});
    ImageSpec single = spec;
    single.samples = VK_SAMPLE_COUNT_1_BIT;
    plan.resolves.push_back(plan.samples == VK_SAMPLE_COUNT_1_BIT ? Image{} : run.image(single));
  }
  if (plan.has_depth) {
    spec.format = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D24_UNORM_S8_UINT});
    spec.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const auto clear = [&] {
      const float stencil = random.unit();
      return clear_value(spec.format, 0.6f + 0.4f * random.unit(), stencil, 0, 0);
    };
    plan.depth = {run.image(spec), op(), op(), clear()};
  }
  std::vector<bool> used(plan.colors.size());  // the first use of a cleared attachment may not be as an input
  for (uint32_t n = 1 + random.below(4); n > 0; --n) {
    Subpass subpass;
    for (uint32_t i = 0; i < plan.colors.size(); ++i) {
      const bool readable = used[i] || plan.colors[i].load == VK_ATTACHMENT_LOAD_OP_LOAD;
      if (readable && random.chance(0.4f) && !(subpass.colors.empty() && i + 1 == plan.colors.size()))
        subpass.inputs.push_back(i);
      else if (random.chance(0.8f) || subpass.colors.empty())
        subpass.colors.push_back(i);
    }
    subpass.depth = plan.has_depth && random.chance(0.7f);
    subpass.resolve = plan.samples != VK_SAMPLE_COUNT_1_BIT && random.chance(0.5f);
    for (const uint32_t c : subpass.colors) used[c] = true;
    plan.subpasses.push_back(subpass);
  }
  return plan;
}

VkAttachmentDescription describe(const Image& image, VkAttachmentLoadOp load, VkAttachmentLoadOp stencil_load) {
  VkAttachmentDescription result{};
  result.format = image.spec.format;
  result.samples = image.spec.samples;
  result.loadOp = load;
  result.stencilLoadOp = stencil_load;
  result.storeOp = result.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
  result.initialLayout = result.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  return result;
}

/// Render passes by VK_KHR_create_renderpass2 and framebuffers without images, or as in Vulkan 1.0.
enum class Form { kFirst, kSecond };

void create_second_form(Run& run, const VkRenderPassCreateInfo& info, VkRenderPass* pass) {
  std::vector<VkAttachmentDescription2> attachments;
  for (uint32_t i = 0; i < info.attachmentCount; ++i) {
    const VkAttachmentDescription& a = info.pAttachments[i];
    attachments.push_back({VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2, nullptr, a.flags, a.format, a.samples, a.loadOp,
                           a.storeOp, a.stencilLoadOp, a.stencilStoreOp, a.initialLayout, a.finalLayout});
  }
  std::vector<std::vector<VkAttachmentReference2>> references;
  const auto upgrade = [&](const VkAttachmentReference* list, uint32_t count) -> const VkAttachmentReference2* {
    if (!list) return nullptr;
    references.emplace_back();
    for (uint32_t i = 0; i < count; ++i)
      references.back().push_back({VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2, nullptr, list[i].attachment,
                                   list[i].layout, VK_IMAGE_ASPECT_COLOR_BIT});
    return references.back().data();
  };
  std::vector<VkSubpassDescription2> subpasses;
  for (uint32_t i = 0; i < info.subpassCount; ++i) {
    const VkSubpassDescription& a = info.pSubpasses[i];
    VkSubpassDescription2 b{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2};
    b.pipelineBindPoint = a.pipelineBindPoint;
    b.inputAttachmentCount = a.inputAttachmentCount;
    b.pInputAttachments = upgrade(a.pInputAttachments, a.inputAttachmentCount);
    b.colorAttachmentCount = a.colorAttachmentCount;
    b.pColorAttachments = upgrade(a.pColorAttachments, a.colorAttachmentCount);
    b.pResolveAttachments = upgrade(a.pResolveAttachments, a.colorAttachmentCount);
    b.pDepthStencilAttachment = upgrade(a.pDepthStencilAttachment, 1);
    b.preserveAttachmentCount = a.preserveAttachmentCount;
    b.pPreserveAttachments = a.pPreserveAttachments;
    subpasses.push_back(b);
  }
  std::vector<VkSubpassDependency2> dependencies;
  for (uint32_t i = 0; i < info.dependencyCount; ++i) {
    const VkSubpassDependency& d = info.pDependencies[i];
    dependencies.push_back({VK_STRUCTURE_TYPE_SUBPASS_DEPENDENCY_2, nullptr, d.srcSubpass, d.dstSubpass, d.srcStageMask,
                            d.dstStageMask, d.srcAccessMask, d.dstAccessMask, d.dependencyFlags, 0});
  }
  VkRenderPassCreateInfo2 second{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  second.attachmentCount = info.attachmentCount;
  second.pAttachments = attachments.data();
  second.subpassCount = info.subpassCount;
  second.pSubpasses = subpasses.data();
  second.dependencyCount = info.dependencyCount;
  second.pDependencies = dependencies.data();
  CTS_VK(CTS_COMMAND(run.gpu, CreateRenderPass2KHR)(run.device, &second, nullptr, pass));
}

/// Attachment numbers: colours, then resolves (multisampled only), then depth.
VkRenderPass make_pass(Run& run, const Plan& plan, Form form) {
  const bool multisampled = plan.samples != VK_SAMPLE_COUNT_1_BIT;
  const auto colors = static_cast<uint32_t>(plan.colors.size());
  std::vector<VkAttachmentDescription> attachments;
  for (const Attachment& color : plan.colors) attachments.push_back(describe(color.image, color.load, color.load));
  if (multisampled)
    for (const Image& image : plan.resolves)
      attachments.push_back(describe(image, VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_LOAD_OP_LOAD));
  const auto depth_number = static_cast<uint32_t>(attachments.size());
  if (plan.has_depth) attachments.push_back(describe(plan.depth.image, plan.depth.load, plan.depth.stencil_load));

  struct References {
    std::vector<VkAttachmentReference> colors, inputs, resolves;
    std::vector<uint32_t> preserves;
    VkAttachmentReference depth;
  };
  std::vector<References> references(plan.subpasses.size());
  std::vector<VkSubpassDescription> subpasses;
  for (size_t i = 0; i < plan.subpasses.size(); ++i) {
    const Subpass& subpass = plan.subpasses[i];
    References& r = references[i];
    const auto reference = [](uint32_t number) { return VkAttachmentReference{number, VK_IMAGE_LAYOUT_GENERAL}; };
    for (const uint32_t c : subpass.colors) {
      r.colors.push_back(reference(c));
      r.resolves.push_back(reference(colors + c));
    }
    for (const uint32_t c : subpass.inputs) r.inputs.push_back(reference(c));
    std::vector<bool> used(attachments.size());
    for (const auto& ref : r.colors) used[ref.attachment] = true;
    for (const auto& ref : r.inputs) used[ref.attachment] = true;
    if (subpass.resolve)
      for (const auto& ref : r.resolves) used[ref.attachment] = true;
    if (subpass.depth) used[depth_number] = true;
    for (uint32_t n = 0; n < used.size(); ++n)
      if (!used[n]) r.preserves.push_back(n);
    r.depth = reference(depth_number);
    VkSubpassDescription description{};
    description.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    description.colorAttachmentCount = static_cast<uint32_t>(r.colors.size());
    description.pColorAttachments = r.colors.data();
    description.pResolveAttachments = subpass.resolve ? r.resolves.data() : nullptr;
    description.inputAttachmentCount = static_cast<uint32_t>(r.inputs.size());
    description.pInputAttachments = r.inputs.data();
    description.pDepthStencilAttachment = subpass.depth ? &r.depth : nullptr;
    description.preserveAttachmentCount = static_cast<uint32_t>(r.preserves.size());
    description.pPreserveAttachments = r.preserves.data();
    subpasses.push_back(description);
  }
  std::vector<VkSubpassDependency> dependencies;
  constexpr VkAccessFlags kAll = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  for (uint32_t i = 0; i + 1 < subpasses.size(); ++i)
    dependencies.push_back({i, i + 1, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, kAll,
                            kAll, VK_DEPENDENCY_BY_REGION_BIT});
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = static_cast<uint32_t>(subpasses.size());
  info.pSubpasses = subpasses.data();
  info.dependencyCount = static_cast<uint32_t>(dependencies.size());
  info.pDependencies = dependencies.data();
  VkRenderPass pass;
  if (form == Form::kSecond) {
    create_second_form(run, info, &pass);
  } else {
    CTS_VK(vkCreateRenderPass(run.device, &info, nullptr, &pass));
  }
  return run.own(pass, vkDestroyRenderPass);
}

std::vector<Image> attachments_of(const Plan& plan) {
  std::vector<Image> images;
  for (const Attachment& color : plan.colors) images.push_back(color.image);
  if (plan.samples != VK_SAMPLE_COUNT_1_BIT)
    for (const Image& image : plan.resolves) images.push_back(image);
  if (plan.has_depth) images.push_back(plan.depth.image);
  return images;
}

VkFramebuffer make_framebuffer(Run& run, const Plan& plan, VkRenderPass pass, Form form) {
  const std::vector<Image> images = attachments_of(plan);
  std::vector<VkImageView> views;
  std::vector<VkFramebufferAttachmentImageInfo> descriptions;
  for (const Image& image : images) {
    views.push_back(image.view);
    VkFramebufferAttachmentImageInfo description{VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENT_IMAGE_INFO};
    description.usage = image.spec.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    description.width = plan.width;
    description.height = plan.height;
    description.layerCount = 1;
    description.viewFormatCount = 1;
    description.pViewFormats = &image.spec.format;
    descriptions.push_back(description);
  }
  VkFramebufferAttachmentsCreateInfo imageless{VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENTS_CREATE_INFO};
  imageless.attachmentImageInfoCount = static_cast<uint32_t>(descriptions.size());
  imageless.pAttachmentImageInfos = descriptions.data();
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  if (form == Form::kSecond) {
    info.pNext = &imageless;
    info.flags = VK_FRAMEBUFFER_CREATE_IMAGELESS_BIT;
  }
  info.renderPass = pass;
  info.attachmentCount = static_cast<uint32_t>(views.size());
  info.pAttachments = views.data();
  info.width = plan.width;
  info.height = plan.height;
  info.layers = 1;
  VkFramebuffer framebuffer;
  CTS_VK(vkCreateFramebuffer(run.device, &info, nullptr, &framebuffer));
  return run.own(framebuffer, vkDestroyFramebuffer);
}

std::string fragment_text(Random& random, const Subpass& subpass, bool multisampled) {
  std::string text = "layout(location = 0) in vec4 passed;\n",
              sum = "passed * " + std::string(random.pick({"1.0", "0.5", "passed"}));
  for (uint32_t i = 0; i < subpass.inputs.size(); ++i) {
    const std::string n = std::to_string(i);
    text += "layout(input_attachment_index = " + n + ", binding = " + n + ") uniform subpassInput" +
            (multisampled ? "MS" : "") + " input" + n + ";\n";
    sum += " + subpassLoad(input" + n + (multisampled ? ", 2" : "") + ") * 0.5";
  }
  for (uint32_t i = 0; i < subpass.colors.size(); ++i)
    text += "layout(location = " + std::to_string(i) + ") out vec4 result" + std::to_string(i) + ";\n";
  text += "void main() {\n  vec4 sum = " + sum + ";\n";
  for (uint32_t i = 0; i < subpass.colors.size(); ++i)
    text += "  result" + std::to_string(i) + " = sum * " + std::to_string(i + 1) + ".0;\n";
  return text + "}\n";
}

std::string describe_subpass(const Plan& plan, const Subpass& subpass) {
  std::string text = std::to_string(plan.samples) + " samples; colors";
  for (const uint32_t c : subpass.colors)
    text += " " + std::to_string(c) + (plan.colors[c].load ? " cleared" : " loaded");
  text += "; inputs";
  for (const uint32_t c : subpass.inputs) text += " " + std::to_string(c);
  return text + (subpass.depth ? "; depth" : "") + (subpass.resolve ? "; resolve\n" : "\n");
}

void begin(Run& run, VkCommandBuffer cmd, const Plan& plan, VkRenderPassBeginInfo info, Form form) {
  if (form == Form::kFirst) return vkCmdBeginRenderPass(cmd, &info, VK_SUBPASS_CONTENTS_INLINE);
  std::vector<VkImageView> views;
  for (const Image& image : attachments_of(plan)) views.push_back(image.view);
  VkRenderPassAttachmentBeginInfo attachments{VK_STRUCTURE_TYPE_RENDER_PASS_ATTACHMENT_BEGIN_INFO};
  attachments.attachmentCount = static_cast<uint32_t>(views.size());
  attachments.pAttachments = views.data();
  info.pNext = &attachments;
  const VkSubpassBeginInfo contents{VK_STRUCTURE_TYPE_SUBPASS_BEGIN_INFO, nullptr, VK_SUBPASS_CONTENTS_INLINE};
  CTS_COMMAND(run.gpu, CmdBeginRenderPass2KHR)(cmd, &info, &contents);
}

void next_subpass(Run& run, VkCommandBuffer cmd, Form form) {
  if (form == Form::kFirst) return vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
  const VkSubpassBeginInfo contents{VK_STRUCTURE_TYPE_SUBPASS_BEGIN_INFO, nullptr, VK_SUBPASS_CONTENTS_INLINE};
  const VkSubpassEndInfo end{VK_STRUCTURE_TYPE_SUBPASS_END_INFO};
  CTS_COMMAND(run.gpu, CmdNextSubpass2KHR)(cmd, &contents, &end);
}

void end(Run& run, VkCommandBuffer cmd, Form form) {
  if (form == Form::kFirst) return vkCmdEndRenderPass(cmd);
  const VkSubpassEndInfo info{VK_STRUCTURE_TYPE_SUBPASS_END_INFO};
  CTS_COMMAND(run.gpu, CmdEndRenderPass2KHR)(cmd, &info);
}

void random_render_pass(Run& run, Form form) {
  Random& random = run.random;
  Plan plan = random_plan(run);
  const VkRenderPass pass = make_pass(run, plan, form);
  const VkFramebuffer framebuffer = make_framebuffer(run, plan, pass, form);
  if (plan.samples == VK_SAMPLE_COUNT_1_BIT) {
    for (const Attachment& color : plan.colors) run.fill_random(color.image);
    if (plan.has_depth) run.fill_random(plan.depth.image);
  } else {
    for (const Image& image : plan.resolves) run.fill_random(image);
    run.once([&](VkCommandBuffer cmd) {
      const VkClearColorValue value{{0.2f, 0.4f, 0.6f, 0.8f}};
      for (const Attachment& color : plan.colors) {
        const VkImageSubresourceRange range = color.image.range();
        vkCmdClearColorImage(cmd, color.image.handle, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
      }
      const VkClearDepthStencilValue depth{0.5f, 3};
      const VkImageSubresourceRange range = plan.has_depth ? plan.depth.image.range() : VkImageSubresourceRange{};
      if (plan.has_depth)
        vkCmdClearDepthStencilImage(cmd, plan.depth.image.handle, VK_IMAGE_LAYOUT_GENERAL, &depth, 1, &range);
    });
  }
  std::vector<VkPipeline> pipelines;
  std::vector<Resources> resources;
  for (uint32_t i = 0; i < plan.subpasses.size(); ++i) {
    const Subpass& subpass = plan.subpasses[i];
    std::vector<Binding> bindings;
    for (uint32_t n = 0; n < subpass.inputs.size(); ++n)
      bindings.push_back(input_attachment(n, plan.colors[subpass.inputs[n]].image));
    resources.push_back(run.resources(bindings));
    GraphicsSpec spec;
    spec.vertex = kVertex;
    spec.fragment = fragment_text(random, subpass, plan.samples != VK_SAMPLE_COUNT_1_BIT);
    run.note("subpass" + std::to_string(i), describe_subpass(plan, subpass) + spec.fragment);
    spec.layout = resources.back().layout;
    spec.floats({4, 4});
    spec.depth.depthTestEnable = spec.depth.depthWriteEnable = subpass.depth;
    pipelines.push_back(make_pipeline(run, spec, pass, i, static_cast<uint32_t>(subpass.colors.size()),
                                      {plan.width, plan.height}, plan.samples));
  }
  std::vector<float> values;
  for (int i = 0; i < 4 * 12; ++i) {
    for (const float v : {random.real(-1.5f, 1.5f), random.real(-1.5f, 1.5f), random.unit(), 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  std::vector<VkClearValue> clears;
  for (const Attachment& color : plan.colors) clears.push_back(color.clear);
  if (plan.samples != VK_SAMPLE_COUNT_1_BIT) clears.resize(plan.colors.size() * 2);
  if (plan.has_depth) clears.push_back(plan.depth.clear);
  run.once([&](VkCommandBuffer cmd) {
    VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    info.renderPass = pass;
    info.framebuffer = framebuffer;
    info.renderArea = {{0, 0}, {plan.width, plan.height}};
    info.clearValueCount = static_cast<uint32_t>(clears.size());
    info.pClearValues = clears.data();
    begin(run, cmd, plan, info, form);
    for (uint32_t i = 0; i < pipelines.size(); ++i) {
      if (i) next_subpass(run, cmd, form);
      bind_pipeline(cmd, pipelines[i]);
      resources[i].bind(cmd);
      bind_vertices(cmd, vertices);
      vkCmdDraw(cmd, 12, 1, i * 12, 0);
    }
    end(run, cmd, form);
  });
  for (uint32_t i = 0; i < plan.colors.size(); ++i) {
    run.out("color" + std::to_string(i), plan.colors[i].image);
    if (plan.samples != VK_SAMPLE_COUNT_1_BIT) run.out("resolve" + std::to_string(i), plan.resolves[i]);
  }
  if (plan.has_depth) run.out("depth", plan.depth.image);
  run.may_be_blank();
}

CTS_RANDOM("renderpass", "random", 200) { random_render_pass(run, Form::kFirst); }

CTS_RANDOM("renderpass", "random_renderpass2_imageless", 40) {
  run.require(run.gpu.has("VK_KHR_create_renderpass2"), "VK_KHR_create_renderpass2");
  run.require(run.gpu.extension_features.imagelessFramebuffer, "imagelessFramebuffer");
  random_render_pass(run, Form::kSecond);
}

/// Load and clear inside a part of the attachment only.
CTS_RANDOM("renderpass", "random_render_area", 40) {
  Random& random = run.random;
  TargetSpec spec;
  spec.width = 30 + random.below(80);
  spec.height = 30 + random.below(80);
  spec.depth = random.chance(0.5f) ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
  spec.load = random.pick({VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_LOAD_OP_CLEAR});
  const Target target = make_target(run, spec);
  run.fill_random(target.colors[0]);
  if (target.depth) run.fill_random(*target.depth);
  GraphicsSpec graphics;
  graphics.vertex = kColorVertex;
  graphics.fragment = kColorFragment;
  graphics.floats({4, 4});
  graphics.depth.depthTestEnable = graphics.depth.depthWriteEnable = spec.depth != 0;
  const uint32_t x = random.below(20), y = random.below(20);
  const VkRect2D area{{static_cast<int32_t>(x), static_cast<int32_t>(y)},
                      {1 + random.below(spec.width - x), 1 + random.below(spec.height - y)}};
  // Drawing outside the render area is undefined: the scissor keeps inside.
  graphics.scissors = {area};
  const VkPipeline pipeline = make_pipeline(run, graphics, target);
  std::vector<float> values;
  for (int i = 0; i < 9 * 8; ++i) values.push_back(i % 8 == 3 ? 1.0f : i % 8 == 2 ? random.unit() : random.real(-1, 1));
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd, area);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 9, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
