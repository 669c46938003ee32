// Descriptor indexing: arrays of every kind of descriptor, indexed differently by neighbouring invocations; sets that
// are written after they are bound, partially bound, and as long as each set says. The reference has none of it: there
// the same results come from constant indices and ordinary sets.
#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kElements = 4;

bool is_claimed(Run& run) { return run.gpu.extension_features.runtimeDescriptorArray; }

/// Both devices take part only if ours claims the extension.
void require_indexing(Run& run) {
  run.require(gpus().device.extension_features.runtimeDescriptorArray, "descriptor indexing");
}

/// An expression whose '#' is an element: once with the index itself, or chosen among constant ones.
std::string pick(bool indexed, const std::string& expression, const std::string& index) {
  const auto with = [&](const std::string& element) {
    std::string text = expression;
    text.replace(text.find('#'), 1, element);
    return text;
  };
  if (indexed) return with("nonuniformEXT(" + index + ")");
  std::string text = with(std::to_string(kElements - 1));
  for (uint32_t i = kElements - 1; i-- > 0;)
    text = "(" + index + " == " + std::to_string(i) + "u ? " + with(std::to_string(i)) + " : " + text + ")";
  return text;
}

std::string stores(bool indexed, const std::string& statement, const std::string& index) {
  std::string text;
  for (uint32_t i = 0; i < (indexed ? 1 : kElements); ++i) {
    std::string one = statement;
    one.replace(one.find('#'), 1, indexed ? "nonuniformEXT(" + index + ")" : std::to_string(i));
    text += indexed ? one : "if (" + index + " == " + std::to_string(i) + "u) " + one;
  }
  return text;
}

std::string nonuniform_code(bool indexed) {
  return std::string(indexed ? "#extension GL_EXT_nonuniform_qualifier : require\n" : "") + R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform U { uvec4 value; } u[4];
layout(set = 0, binding = 1) buffer S { uint value[]; } s[4];
layout(set = 0, binding = 2) uniform sampler2D images[4];
layout(set = 0, binding = 3, r32ui) uniform uimage2D stored[4];
layout(set = 0, binding = 4) uniform usamplerBuffer texels[4];
layout(set = 0, binding = 5, r32ui) uniform uimageBuffer written[4];
layout(set = 0, binding = 6) buffer R { uint r[]; };
void main() {
  uint i = gl_LocalInvocationIndex, k = (i * 7u + i / 5u) & 3u, l = (i / 3u) & 3u;
  vec2 at = vec2(float(i & 7u), float(i >> 3)) / 8.0 + 0.03;
  uint sum = )" +
         pick(indexed, "u[#].value.y", "k") + ";\n  sum = sum * 3u + " + pick(indexed, "s[#].value[i]", "l") +
         ";\n  sum = sum * 3u + packUnorm4x8(" + pick(indexed, "textureLod(images[#], at, 0.0)", "k") +
         ");\n  sum = sum * 3u + " + pick(indexed, "imageLoad(stored[#], ivec2(i & 7u, i >> 3)).x", "l") +
         ";\n  sum = sum * 3u + " + pick(indexed, "texelFetch(texels[#], int(i)).x", "k") + ";\n  sum = sum * 3u + " +
         pick(indexed, "imageLoad(written[#], int(i)).x", "l") + ";\n  r[i] = sum;\n  " +
         stores(indexed, "s[#].value[64u + i] = sum;", "k") + "\n  " +
         stores(indexed, "imageStore(stored[#], ivec2(i & 7u, i >> 3), uvec4(sum));", "k") + "\n  " +
         stores(indexed, "imageStore(written[#], int(64u + i), uvec4(sum));", "l") + "\n}\n";
}

VkBufferView texel_view(Run& run, const Buffer& buffer) {
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = buffer.handle;
  info.format = VK_FORMAT_R32_UINT;
  info.range = VK_WHOLE_SIZE;
  VkBufferView view;
  CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &view));
  return run.own(view, vkDestroyBufferView);
}

Buffer random_buffer(Run& run, uint32_t words, VkBufferUsageFlags usage = 0) {
  const Buffer buffer = run.buffer(words * 4, usage);
  for (uint32_t i = 0; i < words; ++i) buffer.as<uint32_t>()[i] = run.random.bits();
  return buffer;
}

CTS_CASE("descriptor_indexing", "nonuniform") {
  require_indexing(run);
  Binding uniforms{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {}, {}, {}};
  Binding buffers{1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {}, {}, {}};
  Binding images{2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {}, {}, {}};
  Binding stored{3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {}, {}, {}};
  Binding texels{4, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, {}, {}, {}};
  Binding written{5, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, {}, {}, {}};
  std::vector<Buffer> out_buffers;
  std::vector<Image> out_images;
  const VkSampler sampler = run.sampler(VK_FILTER_LINEAR);
  for (uint32_t i = 0; i < kElements; ++i) {
    uniforms.buffers.push_back({random_buffer(run, 64).handle, 0, 16});
    out_buffers.push_back(random_buffer(run, 128));
    buffers.buffers.push_back({out_buffers.back().handle, 0, VK_WHOLE_SIZE});
    ImageSpec spec;
    spec.extent = {8, 8, 1};
    spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    const Image sampled_image = run.image(spec);
    run.fill_random(sampled_image);
    images.images.push_back({sampler, sampled_image.view, VK_IMAGE_LAYOUT_GENERAL});
    spec.format = VK_FORMAT_R32_UINT;
    spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    out_images.push_back(run.image(spec));
    run.fill_random(out_images.back());
    stored.images.push_back({VK_NULL_HANDLE, out_images.back().view, VK_IMAGE_LAYOUT_GENERAL});
    texels.views.push_back(texel_view(run, random_buffer(run, 64, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT)));
    out_buffers.push_back(random_buffer(run, 128, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT));
    written.views.push_back(texel_view(run, out_buffers.back()));
  }
  const Buffer result = run.buffer(256);
  const Resources res = run.resources({uniforms, buffers, images, stored, texels, written, storage_buffer(6, result)});
  const VkPipeline pipeline =
      run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, nonuniform_code(is_claimed(run))));
  run.dispatch(res, pipeline, 1);
  run.out("result", result);
  for (size_t i = 0; i < out_buffers.size(); ++i) run.out("buffer" + std::to_string(i), out_buffers[i]);
  for (size_t i = 0; i < out_images.size(); ++i) run.out("image" + std::to_string(i), out_images[i]);
}

/// A set of five buffers, two of which are never written and never used; another is replaced between recording and
/// submission.
CTS_CASE("descriptor_indexing", "late_partial_and_variable") {
  require_indexing(run);
  const bool claimed = is_claimed(run);
  constexpr uint32_t kUsed[3] = {0, 2, 4};
  std::vector<Buffer> sources;
  for (int i = 0; i < 4; ++i) sources.push_back(random_buffer(run, 64));
  const Buffer result = run.buffer(256);
  const uint32_t count = claimed ? 1000 : 5;
  const VkDescriptorSetLayoutBinding bindings[2] = {
      {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
      {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}};
  const VkDescriptorBindingFlags binding_flags[2] = {0, VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT |
                                                            VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT |
                                                            VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT |
                                                            VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT};
  VkDescriptorSetLayoutBindingFlagsCreateInfo flags{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
  flags.bindingCount = 2;
  flags.pBindingFlags = binding_flags;
  VkDescriptorSetLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layout_info.bindingCount = 2;
  layout_info.pBindings = bindings;
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 6};
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = pool_info.poolSizeCount = 1;
  pool_info.pPoolSizes = &size;
  const uint32_t variable = 5;
  VkDescriptorSetVariableDescriptorCountAllocateInfo counts{
      VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_ALLOCATE_INFO, nullptr, 1, &variable};
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  if (claimed) {
    layout_info.pNext = &flags;
    layout_info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
    pool_info.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
    allocate.pNext = &counts;
  }
  VkDescriptorSetLayout set_layout;
  CTS_VK(vkCreateDescriptorSetLayout(run.device, &layout_info, nullptr, &set_layout));
  run.own(set_layout, vkDestroyDescriptorSetLayout);
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = 1;
  info.pSetLayouts = &set_layout;
  VkPipelineLayout layout;
  CTS_VK(vkCreatePipelineLayout(run.device, &info, nullptr, &layout));
  run.own(layout, vkDestroyPipelineLayout);
  VkDescriptorPool pool;
  CTS_VK(vkCreateDescriptorPool(run.device, &pool_info, nullptr, &pool));
  run.own(pool, vkDestroyDescriptorPool);
  allocate.descriptorPool = pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout;
  VkDescriptorSet set;
  CTS_VK(vkAllocateDescriptorSets(run.device, &allocate, &set));
  const auto write = [&](uint32_t binding, uint32_t element, const Buffer& buffer) {
    const VkDescriptorBufferInfo buffer_info{buffer.handle, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    w.dstSet = set;
    w.dstBinding = binding;
    w.dstArrayElement = element;
    w.descriptorCount = 1;
    w.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    w.pBufferInfo = &buffer_info;
    vkUpdateDescriptorSets(run.device, 1, &w, 0, nullptr);
  };
  write(0, 0, result);
  for (uint32_t i = 0; i < 5; ++i)
    if (!claimed) write(3, i, sources[3]);
  for (uint32_t i = 0; i < 3; ++i) write(3, kUsed[i], sources[claimed && i == 2 ? 0 : i]);
  const std::string code =
      std::string(claimed ? "#extension GL_EXT_nonuniform_qualifier : require\n" : "") +
      "layout(local_size_x = 64) in;\nlayout(binding = 0) buffer R { uint r[]; };\nlayout(binding = 3) buffer S { uint "
      "v[]; } s[" +
      (claimed ? "" : "5") + "];\nvoid main() { uint i = gl_LocalInvocationIndex, k = (i % 3u) * 2u;\n  r[i] = " +
      (claimed ? "s[nonuniformEXT(k)].v[i]" : "(k == 0u ? s[0].v[i] : k == 2u ? s[2].v[i] : s[4].v[i])") + "; }\n";
  const VkPipeline pipeline = run.compute(layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  const VkCommandBuffer cmd = run.begin();
  vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
  vkCmdDispatch(cmd, 1, 1, 1);
  if (claimed) write(3, 4, sources[2]);
  run.submit(cmd);
  run.out("result", result);
}

}  // namespace
}  // namespace vitrine::cts
