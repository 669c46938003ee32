// The commands of the scripts of sync_scene.h.
#include <algorithm>
#include <array>
#include <sstream>

#include "tests/icd/sync_scene.h"

namespace vitrine::icd::test {
namespace {

constexpr std::uint32_t kSize = 8;

const std::map<std::string, VkPipelineStageFlags2> kStages{
    {"TOP", VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT},
    {"BOTTOM", VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT},
    {"ALL", VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT},
    {"GRAPHICS", VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT},
    {"TRANSFER", VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT},
    {"COPY", VK_PIPELINE_STAGE_2_COPY_BIT},
    {"CLEAR", VK_PIPELINE_STAGE_2_CLEAR_BIT},
    {"BLIT", VK_PIPELINE_STAGE_2_BLIT_BIT},
    {"RESOLVE", VK_PIPELINE_STAGE_2_RESOLVE_BIT},
    {"COMPUTE", VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT},
    {"VERTEX", VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT},
    {"FRAGMENT", VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT},
    {"INPUT", VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT},
    {"INDEX", VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT},
    {"ATTRIBUTE", VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT},
    {"INDIRECT", VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT},
    {"COLOR", VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT},
    {"RATES", VK_PIPELINE_STAGE_2_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR},
    {"EARLY", VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT},
    {"LATE", VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT},
    {"TESTS", VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT},
    {"HOST", VK_PIPELINE_STAGE_2_HOST_BIT},
};

const std::map<std::string, VkAccessFlags2> kAccesses{
    {"0", 0},
    {"R", VK_ACCESS_2_MEMORY_READ_BIT},
    {"W", VK_ACCESS_2_MEMORY_WRITE_BIT},
    {"RW", VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT},
    {"SR", VK_ACCESS_2_SHADER_READ_BIT},
    {"SW", VK_ACCESS_2_SHADER_WRITE_BIT},
    {"SAMPLED", VK_ACCESS_2_SHADER_SAMPLED_READ_BIT},
    {"STORAGE", VK_ACCESS_2_SHADER_STORAGE_READ_BIT},
    {"UR", VK_ACCESS_2_UNIFORM_READ_BIT},
    {"TR", VK_ACCESS_2_TRANSFER_READ_BIT},
    {"TW", VK_ACCESS_2_TRANSFER_WRITE_BIT},
    {"CR", VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT},
    {"CW", VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
    {"CRW", VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
    {"DR", VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT},
    {"DW", VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT},
    {"DRW", VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT},
    {"AR", VK_ACCESS_2_INPUT_ATTACHMENT_READ_BIT},
    {"RR", VK_ACCESS_2_FRAGMENT_SHADING_RATE_ATTACHMENT_READ_BIT_KHR},
    {"XR", VK_ACCESS_2_INDEX_READ_BIT},
    {"VR", VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT},
    {"IR", VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT},
    {"HR", VK_ACCESS_2_HOST_READ_BIT},
    {"HW", VK_ACCESS_2_HOST_WRITE_BIT},
};

const std::map<std::string, VkImageLayout> kLayouts{
    {"UNDEFINED", VK_IMAGE_LAYOUT_UNDEFINED},
    {"GENERAL", VK_IMAGE_LAYOUT_GENERAL},
    {"SOURCE", VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
    {"TARGET", VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL},
    {"COLOR", VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
    {"READ", VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
};

std::pair<std::string, std::string> halves(const std::string& text, char between) {
  const std::size_t at = text.find(between);
  EXPECT_NE(at, std::string::npos) << text;
  return {text.substr(0, at), text.substr(at + 1)};
}

template <class T>
T mask_of(const std::map<std::string, T>& names, const std::string& text) {
  T mask = 0;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, '|');) mask |= names.at(word);
  return mask;
}

/// "COPY.TW>COMPUTE.SR".
VkMemoryBarrier2 masks_of(const std::string& text) {
  const auto [first, second] = halves(text, '>');
  const auto [first_stages, first_accesses] = halves(first, '.');
  const auto [second_stages, second_accesses] = halves(second, '.');
  auto barrier = make_struct<VkMemoryBarrier2>();
  barrier.srcStageMask = mask_of(kStages, first_stages);
  barrier.srcAccessMask = mask_of(kAccesses, first_accesses);
  barrier.dstStageMask = mask_of(kStages, second_stages);
  barrier.dstAccessMask = mask_of(kAccesses, second_accesses);
  return barrier;
}

template <class B>
void set_masks(const VkMemoryBarrier2& masks, B& barrier) {
  barrier.srcStageMask = masks.srcStageMask;
  barrier.srcAccessMask = masks.srcAccessMask;
  barrier.dstStageMask = masks.dstStageMask;
  barrier.dstAccessMask = masks.dstAccessMask;
}

constexpr char kResources[] =
    "#version 450\n"
    "layout(set = 0, binding = 0) buffer A_ { uint A[64]; };\n"
    "layout(set = 0, binding = 1) buffer B_ { uint B[64]; };\n"
    "layout(set = 0, binding = 2) buffer C_ { uint C[64]; };\n"
    "layout(set = 0, binding = 3, std140) uniform U_ { uvec4 U[16]; };\n"
    "layout(set = 0, binding = 4, rgba8) uniform image2D Mi;\n"
    "layout(set = 0, binding = 5) uniform sampler2D Ms;\n"
    "layout(set = 0, binding = 6, rgba8) uniform image2D Ni;\n"
    "layout(set = 0, binding = 7) uniform sampler2D Ns;\n"
    "layout(set = 0, binding = 8) uniform sampler2D Ls;\n";

/// What a shader does, its invocation `i` of 64; nothing of it leaves other traces.
std::string body_of(const std::string& verb, const std::string& what) {
  const std::string name = what.substr(0, 1), texel = "ivec2(i % 8u, i / 8u)";
  const bool image = name == "M" || name == "N";
  if (verb == "store") return image ? "imageStore(" + name + "i, " + texel + ", vec4(1));" : name + "[i] = i;";
  if (verb == "add") return "atomicAdd(" + name + "[i], 1u);";
  if (verb == "sample")
    return "if (textureLod(" + name + "s, (vec2(" + texel + ") + 0.5) / 8.0, 0.0).x > 5.0) C[63] = 1u;";
  if (verb == "lookup") return "if (texture(Ls, gl_FragCoord.xy / 8.0).x > 5.0) C[63] = 1u;";
  if (verb == "uniform") return "if (U[i / 4u][i % 4u] == 77777u) C[63] = 1u;";
  const std::string value = image ? "imageLoad(" + name + "i, " + texel + ").x > 5.0" : name + "[i] == 77777u";
  return "if (" + value + ") C[63] = 1u;";
}

}  // namespace

SyncScene::Range SyncScene::range(const std::string& text) {
  const VkBuffer buffer = buffers_.at(text.substr(0, 1)).buffer;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {buffer, 0, 256};
  const auto [offset, size] = halves(text.substr(colon + 1), '+');
  return {buffer, static_cast<VkDeviceSize>(std::stoi(offset)), static_cast<VkDeviceSize>(std::stoi(size))};
}

void SyncScene::command(const Words& words) {
  const std::string& verb = words[0];
  const auto is_one_of = [&](std::initializer_list<const char*> verbs) {
    return std::any_of(verbs.begin(), verbs.end(), [&](const char* one) { return verb == one; });
  };
  if (is_one_of({"fill", "update", "copy", "clear", "blit", "resolve", "queries"})) return transfer(words);
  if (is_one_of({"load", "store", "add", "sample", "uniform"})) return dispatch(body_of(verb, words[1]));
  if (is_one_of({"dispatch", "draws", "indices", "vertices", "draw", "vertex"})) return fixed_stage(words);
  if (is_one_of({"render", "depth", "rates", "kept", "end"})) return rendering(words);
  if (is_one_of({"barrier", "old", "to", "set", "wait"})) return order(words);
  if (is_one_of({"submit", "semaphore", "timeline", "fence", "idle"})) return submission(words);
  if (is_one_of({"flush", "invalidate"})) return host(words);
#ifdef VK_EXT_host_image_copy
  if (is_one_of({"put", "get", "turn"})) return host_copy(words);
#endif
  if (verb == "pass") return pass(words);
  FAIL() << verb;
}

void SyncScene::transfer(const Words& words) {
  const std::string& verb = words[0];
  constexpr VkImageSubresourceLayers kLayers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  constexpr VkExtent3D kExtent{kSize, kSize, 1};
  if (verb == "copy") return copy(words[1], words[2]);
  if (verb == "fill") {
    const Range r = range(words[1]);
    VK_CALL(CmdFillBuffer)(commands_, r.buffer, r.offset, r.size, 1);
  } else if (verb == "update") {
    const std::array<std::uint32_t, 64> data{3, 1, 1, 1, 1};
    const Range r = range(words[1]);
    VK_CALL(CmdUpdateBuffer)(commands_, r.buffer, r.offset, r.size, data.data());
  } else if (verb == "queries") {
    VK_CALL(CmdResetQueryPool)(commands_, queries_, 0, 1);
    VK_CALL(CmdCopyQueryPoolResults)
    (commands_, queries_, 0, 1, range(words[1]).buffer, 0, 8, VK_QUERY_RESULT_PARTIAL_BIT);
  } else if (verb == "clear") {
    const Image& target = image(words[1]);
    const bool one = words[1].size() > 1;
    const VkImageSubresourceRange all{target.aspect, one ? 1u : 0u, one ? 1 : VK_REMAINING_MIP_LEVELS, 0, 1};
    const VkClearColorValue color{};
    const VkClearDepthStencilValue depth{};
    if (words[1] == "D")
      VK_CALL(CmdClearDepthStencilImage)(commands_, target.image, VK_IMAGE_LAYOUT_GENERAL, &depth, 1, &all);
    else
      VK_CALL(CmdClearColorImage)(commands_, target.image, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &all);
  } else if (verb == "blit") {
    const VkImageBlit region{kLayers, {{}, {kSize, kSize, 1}}, kLayers, {{}, {kSize, kSize, 1}}};
    VK_CALL(CmdBlitImage)
    (commands_, image(words[1]).image, VK_IMAGE_LAYOUT_GENERAL, image(words[2]).image, VK_IMAGE_LAYOUT_GENERAL, 1,
     &region, VK_FILTER_NEAREST);
  } else {
    const VkImageResolve region{kLayers, {}, kLayers, {}, kExtent};
    VK_CALL(CmdResolveImage)
    (commands_, image(words[1]).image, VK_IMAGE_LAYOUT_GENERAL, image(words[2]).image, VK_IMAGE_LAYOUT_GENERAL, 1,
     &region);
  }
}

void SyncScene::copy(const std::string& from, const std::string& to) {
  const auto layers = [&](const std::string& name) { return VkImageSubresourceLayers{image(name).aspect, 0, 0, 1}; };
  constexpr VkExtent3D kExtent{kSize, kSize, 1};
  constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
  if (is_image(from) && is_image(to)) {
    const VkImageCopy region{layers(from), {}, layers(to), {}, kExtent};
    VK_CALL(CmdCopyImage)(commands_, image(from).image, kGeneral, image(to).image, kGeneral, 1, &region);
  } else if (is_image(from)) {
    const VkBufferImageCopy region{0, 0, 0, layers(from), {}, kExtent};
    VK_CALL(CmdCopyImageToBuffer)(commands_, image(from).image, kGeneral, range(to).buffer, 1, &region);
  } else if (is_image(to)) {
    const VkBufferImageCopy region{0, 0, 0, layers(to), {}, kExtent};
    VK_CALL(CmdCopyBufferToImage)(commands_, range(from).buffer, image(to).image, kGeneral, 1, &region);
  } else {
    const Range source = range(from), target = range(to);
    const VkBufferCopy region{source.offset, target.offset, source.size};
    VK_CALL(CmdCopyBuffer)(commands_, source.buffer, target.buffer, 1, &region);
  }
}

void SyncScene::dispatch(const std::string& body) {
  auto info = make_struct<VkComputePipelineCreateInfo>();
  const std::string number = std::to_string(++bodies_) + "000u";
  info.stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, std::string(kResources) +
                                                         "layout(local_size_x = 64) in;\nvoid main() {\n  uint i = "
                                                         "gl_LocalInvocationIndex;\n  " +
                                                         body + "\n  if (i == " + number + ") C[63] = 1u;\n}\n");
  info.layout = layout_;
  VkPipeline pipeline = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
  VK_CALL(DestroyShaderModule)(device, info.stage.module, nullptr);
  pipelines_.push_back(pipeline);
  VK_CALL(CmdBindPipeline)(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  VK_CALL(CmdBindDescriptorSets)
  (commands_, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
  VK_CALL(CmdDispatch)(commands_, 1, 1, 1);
}

void SyncScene::draw(const Words& words) {
  const bool attributes = words[0] == "vertices";
  const std::string number = std::to_string(++bodies_) + "000u";
  std::string vertex = kResources, fragment = kResources;
  if (attributes) vertex += "layout(location = 0) in uint a;\n";
  vertex += "void main() {\n  uint i = uint(gl_VertexIndex);\n";
  if (words[0] == "vertex") vertex += body_of(words[1], words[2]);
  vertex += attributes ? "  float x = a == 77777u ? 0.0 : 1.0;\n" : "  float x = 1.0;\n";
  vertex += "  gl_Position = vec4(vec2(gl_VertexIndex % 2, gl_VertexIndex / 2) * 4.0 - 1.0, 0.0, x);\n}\n";
  fragment += has_depth_ ? "" : "layout(location = 0) out vec4 c;\n";
  fragment += "void main() {\n  uint i = uint(gl_FragCoord.y) * 8u + uint(gl_FragCoord.x);\n";
  if (words[0] == "draw" && words.size() > 2) fragment += body_of(words[1], words[2]);
  fragment += has_depth_ ? "" : "  c = vec4(1);\n";
  fragment += "  if (i == " + number + ") C[63] = 1u;\n}\n";
  const VkPipeline pipeline = draw_pipeline(vertex, fragment, VK_NULL_HANDLE, attributes);
  VK_CALL(CmdBindPipeline)(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  VK_CALL(CmdBindDescriptorSets)
  (commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
}

void SyncScene::fixed_stage(const Words& words) {
  if (words[0] == "dispatch") {
    VK_CALL(CmdBindDescriptorSets)
    (commands_, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, std::string(kResources) + "void main() {}\n");
    info.layout = layout_;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    VK_CALL(DestroyShaderModule)(device, info.stage.module, nullptr);
    pipelines_.push_back(pipeline);
    VK_CALL(CmdBindPipeline)(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    return VK_CALL(CmdDispatchIndirect)(commands_, range(words[1]).buffer, 0);
  }
  draw(words);
  if (words[0] == "indices") {
    VK_CALL(CmdBindIndexBuffer)(commands_, range(words[1]).buffer, 0, VK_INDEX_TYPE_UINT32);
    return VK_CALL(CmdDrawIndexed)(commands_, 3, 1, 0, 0, 0);
  }
  if (words[0] == "draws") return VK_CALL(CmdDrawIndirect)(commands_, range(words[1]).buffer, 0, 1, 16);
  if (words[0] == "vertices") {
    const Range r = range(words[1]);
    VK_CALL(CmdBindVertexBuffers)(commands_, 0, 1, &r.buffer, &r.offset);
  }
  VK_CALL(CmdDraw)(commands_, 3, 1, 0, 0);
}

void SyncScene::rendering(const Words& words) {
  if (words[0] == "end") return VK_CALL(CmdEndRendering)(commands_);
  has_depth_ = words[0] == "depth";
  has_rates_ = words[0] == "rates";
  const bool attached = has_rates_ || words[0] == "kept";
  auto attachment = make_struct<VkRenderingAttachmentInfo>();
  attachment.imageView = image(words[1]).view;
  attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  attachment.loadOp = attached || words.size() < 3 || words[2] == "CLEAR" ? VK_ATTACHMENT_LOAD_OP_CLEAR
                      : words[2] == "LOAD"                                ? VK_ATTACHMENT_LOAD_OP_LOAD
                                                                          : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  auto info = make_struct<VkRenderingInfo>();
  info.renderArea.extent = {kSize, kSize};
  info.layerCount = 1;
  info.colorAttachmentCount = has_depth_ ? 0 : 1;
  info.pColorAttachments = &attachment;
  if (has_depth_) info.pDepthAttachment = &attachment;
  auto rate = make_struct<VkRenderingFragmentShadingRateAttachmentInfoKHR>();
  rate.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  rate.shadingRateAttachmentTexelSize = {8, 8};
  if (attached) rate.imageView = image(words[2]).view;
  if (attached) info.pNext = &rate;
  VK_CALL(CmdBeginRendering)(commands_, &info);
}

void SyncScene::order(const Words& words) {
  if (words[0] == "old") return old_barrier(words[1]);
  if (words[0] == "set" || words[0] == "wait") return event(words);
  if (words[0] == "barrier")
    return barrier(words, words[1], VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL,
                   words.size() > 2 ? words[2] : std::string());
  const auto [from, to] = halves(words[2], '>');
  barrier(words, words[3], kLayouts.at(from), kLayouts.at(to), words[1]);
}

void SyncScene::barrier(const Words&, const std::string& masks, VkImageLayout from, VkImageLayout to,
                        const std::string& resource) {
  const VkMemoryBarrier2 memory = masks_of(masks);
  auto info = make_struct<VkDependencyInfo>();
  auto of_buffer = make_struct<VkBufferMemoryBarrier2>();
  auto of_image = make_struct<VkImageMemoryBarrier2>();
  if (resource.empty()) {
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
  } else if (is_image(resource)) {
    set_masks(memory, of_image);
    of_image.oldLayout = from;
    of_image.newLayout = to;
    of_image.image = image(resource).image;
    of_image.subresourceRange = {image(resource).aspect, 0, 1, 0, 1};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &of_image;
  } else {
    const Range r = range(resource);
    set_masks(memory, of_buffer);
    of_buffer.buffer = r.buffer;
    of_buffer.offset = r.offset;
    of_buffer.size = r.size;
    info.bufferMemoryBarrierCount = 1;
    info.pBufferMemoryBarriers = &of_buffer;
  }
  VK_CALL(CmdPipelineBarrier2)(commands_, &info);
}

void SyncScene::old_barrier(const std::string& text) {
  const VkMemoryBarrier2 masks = masks_of(text);
  auto memory = make_struct<VkMemoryBarrier>();
  memory.srcAccessMask = static_cast<VkAccessFlags>(masks.srcAccessMask);
  memory.dstAccessMask = static_cast<VkAccessFlags>(masks.dstAccessMask);
  VK_CALL(CmdPipelineBarrier)
  (commands_, static_cast<VkPipelineStageFlags>(masks.srcStageMask),
   static_cast<VkPipelineStageFlags>(masks.dstStageMask), 0, 1, &memory, 0, nullptr, 0, nullptr);
}

void SyncScene::event(const Words& words) {
  const VkMemoryBarrier2 memory = masks_of(words[1]);
  auto info = make_struct<VkDependencyInfo>();
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &memory;
  if (words[0] == "set") return VK_CALL(CmdSetEvent2)(commands_, event_, &info);
  VK_CALL(CmdWaitEvents2)(commands_, 1, &event_, &info);
}

void SyncScene::submission(const Words& words) {
  if (words[0] == "submit") return submit();
  if (words[0] == "idle") {
    submit();
    EXPECT_EQ(VK_CALL(QueueWaitIdle)(queue_), VK_SUCCESS);
    return;
  }
  if (words[0] == "fence") {
    const auto info = make_struct<VkFenceCreateInfo>();
    VkFence fence = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateFence)(device, &info, nullptr, &fence), VK_SUCCESS);
    submit(VK_NULL_HANDLE, 0, fence);
    EXPECT_EQ(VK_CALL(WaitForFences)(device, 1, &fence, VK_TRUE, ~0ull), VK_SUCCESS);
    return VK_CALL(DestroyFence)(device, fence, nullptr);
  }
  auto type = make_struct<VkSemaphoreTypeCreateInfo>();
  type.semaphoreType = words[0] == "timeline" ? VK_SEMAPHORE_TYPE_TIMELINE : VK_SEMAPHORE_TYPE_BINARY;
  const auto info = make_struct<VkSemaphoreCreateInfo>(&type);
  VkSemaphore semaphore = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(CreateSemaphore)(device, &info, nullptr, &semaphore), VK_SUCCESS);
  semaphores_.push_back(semaphore);
  const std::uint64_t value = words[0] == "timeline" ? 7 : 0;
  submit(semaphore, value);
  wait_ = semaphore;
  wait_value_ = value;
  wait_stages_ = static_cast<VkPipelineStageFlags>(mask_of(kStages, words[1]));
}

void SyncScene::host(const Words& words) {
  auto range = make_struct<VkMappedMemoryRange>();
  range.memory = buffers_.at(words[1]).memory;
  range.size = VK_WHOLE_SIZE;
  if (words[0] == "flush")
    EXPECT_EQ(VK_CALL(FlushMappedMemoryRanges)(device, 1, &range), VK_SUCCESS);
  else
    EXPECT_EQ(VK_CALL(InvalidateMappedMemoryRanges)(device, 1, &range), VK_SUCCESS);
}

#ifdef VK_EXT_host_image_copy
/// Copies of the whole image and transitions that the host makes, without commands.
void SyncScene::host_copy(const Words& words) {
  const Image& used = image(words[1]);
  std::array<std::uint32_t, kSize * kSize> texels{};
  const VkImageSubresourceLayers all{used.aspect, 0, 0, 1};
  if (words[0] == "put") {
    auto region = make_struct<VkMemoryToImageCopyEXT>();
    region.pHostPointer = texels.data();
    region.imageSubresource = all;
    region.imageExtent = {kSize, kSize, 1};
    auto info = make_struct<VkCopyMemoryToImageInfoEXT>();
    info.dstImage = used.image;
    info.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.regionCount = 1;
    info.pRegions = &region;
    EXPECT_EQ(VK_CALL(CopyMemoryToImageEXT)(device, &info), VK_SUCCESS);
  } else if (words[0] == "get") {
    auto region = make_struct<VkImageToMemoryCopyEXT>();
    region.pHostPointer = texels.data();
    region.imageSubresource = all;
    region.imageExtent = {kSize, kSize, 1};
    auto info = make_struct<VkCopyImageToMemoryInfoEXT>();
    info.srcImage = used.image;
    info.srcImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.regionCount = 1;
    info.pRegions = &region;
    EXPECT_EQ(VK_CALL(CopyImageToMemoryEXT)(device, &info), VK_SUCCESS);
  } else {
    const auto [from, to] = halves(words[2], '>');
    auto info = make_struct<VkHostImageLayoutTransitionInfoEXT>();
    info.image = used.image;
    info.oldLayout = kLayouts.at(from);
    info.newLayout = kLayouts.at(to);
    info.subresourceRange = {used.aspect, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
    EXPECT_EQ(VK_CALL(TransitionImageLayoutEXT)(device, 1, &info), VK_SUCCESS);
  }
}
#endif

/// pass IMAGE LOAD INITIAL>FINAL [MASKS in front] [MASKS behind]: one subpass that clears or loads; "-": no dependency.
/// pass IMAGE two [MASKS]: a second subpass draws to what the first one has cleared.
void SyncScene::pass(const Words& words) {
  auto begin = make_struct<VkRenderPassBeginInfo>();
  make_pass(words, begin);
  const VkClearValue value{};
  begin.renderArea.extent = {kSize, kSize};
  begin.clearValueCount = 1;
  begin.pClearValues = &value;
  VK_CALL(CmdBeginRenderPass)(commands_, &begin, VK_SUBPASS_CONTENTS_INLINE);
  if (words[2] == "two") {
    VK_CALL(CmdNextSubpass)(commands_, VK_SUBPASS_CONTENTS_INLINE);
    const VkPipeline pipeline = draw_pipeline(
        "#version 450\nvoid main() { gl_Position = vec4(vec2(gl_VertexIndex % 2, gl_VertexIndex / 2) * 4.0 - 1.0, 0, "
        "1); }",
        "#version 450\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(1); }", begin.renderPass, false);
    VK_CALL(CmdBindPipeline)(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    VK_CALL(CmdDraw)(commands_, 3, 1, 0, 0);
  }
  VK_CALL(CmdEndRenderPass)(commands_);
}

void SyncScene::make_pass(const Words& words, VkRenderPassBeginInfo& begin) {
  const bool two = words[2] == "two";
  const Image& target = image(words[1]);
  const auto [from, to] = two ? std::pair<std::string, std::string>("GENERAL", "GENERAL") : halves(words[3], '>');
  VkAttachmentDescription attachment{};
  attachment.format = target.format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = !two && words[2] == "LOAD" ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.initialLayout = kLayouts.at(from);
  attachment.finalLayout = kLayouts.at(to);
  const VkAttachmentReference references[] = {
      {0, two || words[2] == "LOAD" ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
      {0, VK_IMAGE_LAYOUT_GENERAL}};
  VkSubpassDescription subpasses[2] = {};
  subpasses[0].colorAttachmentCount = 1;
  subpasses[0].pColorAttachments = &references[0];
  subpasses[1].colorAttachmentCount = 1;
  subpasses[1].pColorAttachments = &references[1];
  std::vector<VkSubpassDependency> dependencies;
  for (std::size_t i = two ? 3 : 4; i < words.size(); ++i) {
    if (words[i] == "-") continue;
    const VkMemoryBarrier2 masks = masks_of(words[i]);
    const bool behind = !two && i == 5;
    dependencies.push_back(
        {two || behind ? 0 : VK_SUBPASS_EXTERNAL,
         two      ? 1
         : behind ? VK_SUBPASS_EXTERNAL
                  : 0,
         static_cast<VkPipelineStageFlags>(masks.srcStageMask), static_cast<VkPipelineStageFlags>(masks.dstStageMask),
         static_cast<VkAccessFlags>(masks.srcAccessMask), static_cast<VkAccessFlags>(masks.dstAccessMask), 0});
  }
  auto info = make_struct<VkRenderPassCreateInfo>();
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = two ? 2 : 1;
  info.pSubpasses = subpasses;
  info.dependencyCount = static_cast<std::uint32_t>(dependencies.size());
  info.pDependencies = dependencies.data();
  EXPECT_EQ(VK_CALL(CreateRenderPass)(device, &info, nullptr, &begin.renderPass), VK_SUCCESS);
  passes_.push_back(begin.renderPass);
  auto framebuffer = make_struct<VkFramebufferCreateInfo>();
  framebuffer.renderPass = begin.renderPass;
  framebuffer.attachmentCount = 1;
  framebuffer.pAttachments = &target.view;
  framebuffer.width = framebuffer.height = kSize;
  framebuffer.layers = 1;
  EXPECT_EQ(VK_CALL(CreateFramebuffer)(device, &framebuffer, nullptr, &begin.framebuffer), VK_SUCCESS);
  framebuffers_.push_back(begin.framebuffer);
}

}  // namespace vitrine::icd::test
