// Descriptors of newer kinds: pushed with the commands, inline uniform blocks.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

VkDescriptorSetLayout make_layout(Run& run, const std::vector<VkDescriptorSetLayoutBinding>& bindings,
                                  VkDescriptorSetLayoutCreateFlags flags) {
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.flags = flags;
  info.bindingCount = static_cast<uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  VkDescriptorSetLayout layout;
  CTS_VK(vkCreateDescriptorSetLayout(run.device, &info, nullptr, &layout));
  return run.own(layout, vkDestroyDescriptorSetLayout);
}

VkPipelineLayout make_pipeline_layout(Run& run, const std::vector<VkDescriptorSetLayout>& sets) {
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = static_cast<uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  VkPipelineLayout layout;
  CTS_VK(vkCreatePipelineLayout(run.device, &info, nullptr, &layout));
  return run.own(layout, vkDestroyPipelineLayout);
}

std::vector<uint32_t> random_words(Run& run, size_t count) {
  std::vector<uint32_t> words(count);
  for (uint32_t& word : words) word = run.random.bits();
  return words;
}

constexpr VkDescriptorSetLayoutBinding kBuffer(uint32_t binding, VkDescriptorType type) {
  return {binding, type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
}

const char kSum[] = R"(#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) uniform A { uint a[64]; };
layout(std430, set = 0, binding = 1) readonly buffer B { uint b[]; };
layout(std430, set = 0, binding = 3) buffer R { uint r[]; };
void main() { uint i = gl_LocalInvocationIndex; r[i] = r[i] * 3u + a[i & 15u] + b[i]; })";

struct Push {
  Buffer uniform, first, second, result;
  VkPipelineLayout layout;
  VkPipeline pipeline;

  explicit Push(Run& run) {
    run.require(run.gpu.has("VK_KHR_push_descriptor"), "VK_KHR_push_descriptor");
    run.require(run.gpu.extension_features.uniformBufferStandardLayout, "uniformBufferStandardLayout");
    uniform = run.buffer_of(random_words(run, 64));
    first = run.buffer_of(random_words(run, 64));
    second = run.buffer_of(random_words(run, 64));
    result = run.buffer(256);
    const VkDescriptorSetLayout set =
        make_layout(run,
                    {kBuffer(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER), kBuffer(1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                     kBuffer(3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)},
                    VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR);
    layout = make_pipeline_layout(run, {set});
    pipeline = run.compute(layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, kSum));
    set_layout = set;
  }
  VkDescriptorSetLayout set_layout;
};

/// What is not pushed again stays as it was.
CTS_CASE("descriptors", "push.buffers") {
  const Push p(run);
  run.once([&](VkCommandBuffer cmd) {
    const VkDescriptorBufferInfo infos[4] = {{p.uniform.handle, 0, VK_WHOLE_SIZE},
                                             {p.first.handle, 0, VK_WHOLE_SIZE},
                                             {p.result.handle, 0, VK_WHOLE_SIZE},
                                             {p.second.handle, 0, VK_WHOLE_SIZE}};
    const auto write = [&](uint32_t binding, VkDescriptorType type, const VkDescriptorBufferInfo* info) {
      VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
      w.dstBinding = binding;
      w.descriptorCount = 1;
      w.descriptorType = type;
      w.pBufferInfo = info;
      return w;
    };
    const VkWriteDescriptorSet writes[3] = {write(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &infos[0]),
                                            write(1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &infos[1]),
                                            write(3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &infos[2])};
    const VkWriteDescriptorSet again = write(1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &infos[3]);
    const auto push = CTS_COMMAND(run.gpu, CmdPushDescriptorSetKHR);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p.pipeline);
    push(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p.layout, 0, 3, writes);
    vkCmdDispatch(cmd, 1, 1, 1);
    run.barrier(cmd);
    push(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p.layout, 0, 1, &again);
    vkCmdDispatch(cmd, 1, 1, 1);
  });
  run.out("result", p.result);
}

CTS_CASE("descriptors", "push.template") {
  const Push p(run);
  struct Data {
    VkDescriptorBufferInfo uniform, storage, result;
  };
  const VkDescriptorUpdateTemplateEntry entries[3] = {
      {0, 0, 1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, offsetof(Data, uniform), 0},
      {1, 0, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, offsetof(Data, storage), 0},
      {3, 0, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, offsetof(Data, result), 0}};
  VkDescriptorUpdateTemplateCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_UPDATE_TEMPLATE_CREATE_INFO};
  info.descriptorUpdateEntryCount = 3;
  info.pDescriptorUpdateEntries = entries;
  info.templateType = VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_PUSH_DESCRIPTORS_KHR;
  info.descriptorSetLayout = p.set_layout;
  info.pipelineBindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
  info.pipelineLayout = p.layout;
  VkDescriptorUpdateTemplate update;
  CTS_VK(vkCreateDescriptorUpdateTemplate(run.device, &info, nullptr, &update));
  run.own(update, vkDestroyDescriptorUpdateTemplate);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p.pipeline);
    for (const Buffer* source : {&p.first, &p.second}) {
      const Data data{{p.uniform.handle, 0, VK_WHOLE_SIZE},
                      {source->handle, 0, VK_WHOLE_SIZE},
                      {p.result.handle, 0, VK_WHOLE_SIZE}};
      CTS_COMMAND(run.gpu, CmdPushDescriptorSetWithTemplateKHR)(cmd, update, p.layout, 0, &data);
      vkCmdDispatch(cmd, 1, 1, 1);
      run.barrier(cmd);
    }
  });
  run.out("result", p.result);
}

struct InlineBlocks {
  Buffer result;
  VkDescriptorSetLayout set_layout;
  VkPipelineLayout layout;
  VkPipeline pipeline;
  VkDescriptorPool pool;

  explicit InlineBlocks(Run& run) {
    run.require(run.gpu.extension_features.inlineUniformBlock, "inlineUniformBlock");
    result = run.buffer(256);
    set_layout =
        make_layout(run,
                    {{0, VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK_EXT, 64, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
                     {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
                     {2, VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK_EXT, 36, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}},
                    0);
    layout = make_pipeline_layout(run, {set_layout});
    pipeline = run.compute(layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform A { uvec4 a[4]; };
layout(set = 0, binding = 1) buffer R { uint r[]; };
layout(set = 0, binding = 2) uniform B { uvec4 b[2]; uint last; };
void main() { uint i = gl_LocalInvocationIndex; r[i] += a[(i >> 2) & 3u][i & 3u] * 7u + b[i & 1u].w + last; })"));
    VkDescriptorPoolInlineUniformBlockCreateInfo blocks{
        VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_INLINE_UNIFORM_BLOCK_CREATE_INFO};
    blocks.maxInlineUniformBlockBindings = 4;
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK_EXT, 200},
                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2}};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, &blocks};
    info.maxSets = 2;
    info.poolSizeCount = 2;
    info.pPoolSizes = sizes;
    CTS_VK(vkCreateDescriptorPool(run.device, &info, nullptr, &pool));
    run.own(pool, vkDestroyDescriptorPool);
  }
  VkDescriptorSet allocate(Run& run) const {
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &set_layout;
    VkDescriptorSet set;
    CTS_VK(vkAllocateDescriptorSets(run.device, &info, &set));
    return set;
  }
};

void write_block(Run& run, VkDescriptorSet set, uint32_t binding, uint32_t offset, const std::vector<uint32_t>& words) {
  VkWriteDescriptorSetInlineUniformBlock block{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_INLINE_UNIFORM_BLOCK};
  block.dataSize = static_cast<uint32_t>(words.size() * 4);
  block.pData = words.data();
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, &block};
  write.dstSet = set;
  write.dstBinding = binding;
  write.dstArrayElement = offset;
  write.descriptorCount = block.dataSize;
  write.descriptorType = VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK_EXT;
  vkUpdateDescriptorSets(run.device, 1, &write, 0, nullptr);
}

CTS_CASE("descriptors", "inline_uniform_block.written_and_copied") {
  const InlineBlocks b(run);
  const VkDescriptorSet first = b.allocate(run), second = b.allocate(run);
  for (const VkDescriptorSet set : {first, second}) {
    const VkDescriptorBufferInfo info{b.result.handle, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.dstBinding = 1;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &info;
    vkUpdateDescriptorSets(run.device, 1, &write, 0, nullptr);
    write_block(run, set, 0, 0, random_words(run, 16));
    write_block(run, set, 2, 0, random_words(run, 9));
  }
  write_block(run, first, 0, 20, random_words(run, 3));
  VkCopyDescriptorSet copy{VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET};
  copy.srcSet = first;
  copy.srcBinding = 0;
  copy.srcArrayElement = 16;
  copy.dstSet = second;
  copy.dstBinding = 0;
  copy.dstArrayElement = 32;
  copy.descriptorCount = 28;
  vkUpdateDescriptorSets(run.device, 0, nullptr, 1, &copy);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, b.pipeline);
    for (const VkDescriptorSet& set : {first, second}) {
      vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, b.layout, 0, 1, &set, 0, nullptr);
      vkCmdDispatch(cmd, 1, 1, 1);
      run.barrier(cmd);
    }
  });
  run.out("result", b.result);
}

}  // namespace
}  // namespace vitrine::cts
