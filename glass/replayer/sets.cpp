// Descriptor set layouts, sets and what is written into them.
#include <algorithm>
#include <cstdlib>
#include <optional>

#include "glass/bug/contents.h"
#include "glass/replayer/departing.h"
#include "glass/replayer/pipeline.h"

namespace vitrine::glass::replayer {
namespace {

using bug::kNone;

/// Mutable bindings are of one type on drivers that have none, where their descriptors are.
VkDescriptorType type_here(const Device& d, const bug::Bug& bug, std::uint32_t set, const bug::Binding& binding) {
  return d.has(VK_EXT_MUTABLE_DESCRIPTOR_TYPE_EXTENSION_NAME) ? binding.type : bug::plain_type(bug, set, binding);
}

VkDescriptorSetLayout make_layout(const Device& d, const bug::Bug& bug, std::uint32_t number,
                                  const Resources& resources) {
  const bug::SetLayout& set = bug.sets[number];
  std::vector<std::vector<VkSampler>> samplers(set.bindings.size());
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  std::vector<VkDescriptorBindingFlags> flags;
  std::vector<VkMutableDescriptorTypeListEXT> lists;
  for (std::size_t i = 0; i < set.bindings.size(); ++i) {
    const bug::Binding& b = set.bindings[i];
    for (const std::uint32_t sampler : b.samplers) samplers[i].push_back(resources.samplers[sampler]);
    bindings.push_back({b.binding, type_here(d, bug, number, b), b.count, b.stages,
                        b.samplers.empty() ? nullptr : samplers[i].data()});
    lists.push_back({static_cast<std::uint32_t>(b.types.size()), b.types.data()});
    flags.push_back(b.flags);
  }
  VkDescriptorSetLayoutBindingFlagsCreateInfo more{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
  more.bindingCount = static_cast<std::uint32_t>(flags.size());
  more.pBindingFlags = flags.data();
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  if (std::any_of(flags.begin(), flags.end(), [](VkFlags f) { return f != 0; })) info.pNext = &more;
  VkMutableDescriptorTypeCreateInfoEXT types{VK_STRUCTURE_TYPE_MUTABLE_DESCRIPTOR_TYPE_CREATE_INFO_EXT, info.pNext,
                                             static_cast<std::uint32_t>(lists.size()), lists.data()};
  const auto is_mutable = [](const auto& b) { return b.descriptorType == VK_DESCRIPTOR_TYPE_MUTABLE_EXT; };
  if (std::ranges::any_of(bindings, is_mutable)) info.pNext = &types;
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  must(vkCreateDescriptorSetLayout(d.device, &info, nullptr, &layout), "vkCreateDescriptorSetLayout");
  return layout;
}

VkDescriptorPool make_pool(const Device& d, const bug::Bug& bug) {
  std::vector<VkDescriptorPoolSize> sizes;
  VkDescriptorPoolInlineUniformBlockCreateInfo blocks{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_INLINE_UNIFORM_BLOCK_CREATE_INFO};
  for (std::uint32_t set = 0; set < bug.sets.size(); ++set) {
    for (const bug::Binding& b : bug.sets[set].bindings) {
      if (b.count) sizes.push_back({type_here(d, bug, set, b), b.count});
      blocks.maxInlineUniformBlockBindings += b.type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
    }
  }
  if (sizes.empty()) sizes.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1});
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  if (blocks.maxInlineUniformBlockBindings) info.pNext = &blocks;
  info.maxSets = static_cast<std::uint32_t>(std::max<std::size_t>(bug.sets.size(), 1));
  info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  must(vkCreateDescriptorPool(d.device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  return pool;
}

VkDescriptorType type_of(const bug::Bug& bug, const bug::Descriptor& at) {
  return bug::type_of(at, *std::ranges::find(bug.sets[at.set].bindings, at.binding, &bug::Binding::binding));
}

void write(const Device& d, const bug::Bug& bug, const Resources& resources, const bug::Descriptor& at,
           VkDescriptorSet set) {
  VkDescriptorBufferInfo buffer{at.buffer == kNone ? VK_NULL_HANDLE : resources.buffers[at.buffer], at.offset,
                                at.range};
  VkDescriptorImageInfo image{at.sampler == kNone ? VK_NULL_HANDLE : resources.samplers[at.sampler],
                              at.view == kNone ? VK_NULL_HANDLE : resources.views[at.view], VK_IMAGE_LAYOUT_GENERAL};
  VkWriteDescriptorSetInlineUniformBlock block{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_INLINE_UNIFORM_BLOCK};
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set;
  write.dstBinding = at.binding;
  write.dstArrayElement = at.element;
  write.descriptorCount = 1;
  write.descriptorType = type_of(bug, at);
  write.pBufferInfo = &buffer;
  write.pImageInfo = &image;
  if (at.texels != kNone) write.pTexelBufferView = &resources.buffer_views[at.texels];
  std::optional<Departing> departing;
  if (at.gone) departing.emplace(d, write.descriptorType).fill(buffer, image, write);
  if (write.descriptorType == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK) {
    block.dataSize = write.descriptorCount = static_cast<std::uint32_t>(bug::size_of(at.bytes));
    block.pData = at.bytes ? at.bytes->data() : nullptr;
    write.pNext = &block;
    if (block.dataSize == 0) return;
  }
  vkUpdateDescriptorSets(d.device, 1, &write, 0, nullptr);
}

VkPipelineLayout make_pipeline_layout(const Device& d, const bug::Bug& bug,
                                      const std::vector<VkDescriptorSetLayout>& sets) {
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = static_cast<std::uint32_t>(bug.push_ranges.size());
  info.pPushConstantRanges = bug.push_ranges.data();
  VkPipelineLayout layout = VK_NULL_HANDLE;
  must(vkCreatePipelineLayout(d.device, &info, nullptr, &layout), "vkCreatePipelineLayout");
  return layout;
}

}  // namespace

Bound make_sets(const Device& d, const bug::Bug& bug, const Resources& resources) {
  Bound out;
  std::vector<VkDescriptorSetLayout> layouts;
  for (std::uint32_t set = 0; set < bug.sets.size(); ++set) layouts.push_back(make_layout(d, bug, set, resources));
  out.layout = make_pipeline_layout(d, bug, layouts);
  const VkDescriptorPool pool = make_pool(d, bug);
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layouts[i];
    VkDescriptorSet set = VK_NULL_HANDLE;
    must(vkAllocateDescriptorSets(d.device, &info, &set), "vkAllocateDescriptorSets");
    out.sets.push_back(set);
    for (const bug::Binding& b : bug.sets[i].bindings)
      if (bug::is_dynamic(b.type)) out.dynamic_offsets.resize(out.dynamic_offsets.size() + b.count);
  }
  // What is gone is for tools to find; without any it would be read.
  const char* const tools = std::getenv("VITRINE_TOOLS");
  const bool watched = tools != nullptr && *tools != 0;
  for (const bug::Descriptor& at : bug.descriptors)
    if (!at.gone || watched) write(d, bug, resources, at, out.sets[at.set]);
  return out;
}

}  // namespace vitrine::glass::replayer
