// Mutable descriptors: bindings that take a buffer, an image, texels or a sampler, one after the other; copied between
// sets and from and to bindings of one type. The reference gets the same through bindings of one type each.
#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

constexpr VkDescriptorType kTypes[] = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,       VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                       VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_SAMPLER};
constexpr uint32_t kCount = static_cast<uint32_t>(std::size(kTypes));

constexpr char kCode[] = R"(
layout(local_size_x = 64) in;
layout(binding = 0) uniform U { uvec4 u; };
layout(binding = 1) buffer S { uint s[]; };
layout(binding = 2) uniform texture2D image;
layout(binding = 3, r32ui) uniform uimage2D stored;
layout(binding = 4) uniform usamplerBuffer texels;
layout(binding = 5) uniform sampler filtering;
void main() {
  uint i = gl_LocalInvocationIndex;
  ivec2 at = ivec2(i & 7u, i >> 3);
  vec4 color = textureLod(sampler2D(image, filtering), vec2(at) / 7.0, 0.0);
  uint sum = u.y + s[i] * 3u + packUnorm4x8(color) * 5u + texelFetch(texels, int(i)).x * 7u;
  sum += imageLoad(stored, at).x * 11u;
  imageStore(stored, at, uvec4(sum));
  s[64u + i] = sum;
})";

/// What the bindings may be given, one of each type.
struct Things {
  Buffer uniform, storage, texels;
  Image image, stored;
  VkBufferView view = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
};

Buffer random_buffer(Run& run, VkBufferUsageFlags usage = 0) {
  const Buffer buffer = run.buffer(512, usage);
  for (uint32_t i = 0; i < 128; ++i) buffer.as<uint32_t>()[i] = run.random.bits();
  return buffer;
}

Things make_things(Run& run) {
  Things out{
      random_buffer(run), random_buffer(run), random_buffer(run, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT), {}, {}};
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = out.texels.handle;
  info.format = VK_FORMAT_R32_UINT;
  info.range = VK_WHOLE_SIZE;
  CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &out.view));
  run.own(out.view, vkDestroyBufferView);
  ImageSpec spec;
  spec.extent = {8, 8, 1};
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  out.image = run.image(spec);
  run.fill_random(out.image);
  spec.format = VK_FORMAT_R32_UINT;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  out.stored = run.image(spec);
  run.fill_random(out.stored);
  out.sampler = run.sampler(VK_FILTER_LINEAR);
  return out;
}

/// Writes the thing of kTypes[what] to a binding.
void write(Run& run, VkDescriptorSet set, uint32_t binding, uint32_t what, const Things& things) {
  const VkDescriptorBufferInfo buffer{what == 0 ? things.uniform.handle : things.storage.handle, 0,
                                      what == 0 ? 16u : VK_WHOLE_SIZE};
  const VkDescriptorImageInfo image{things.sampler, what == 2 ? things.image.view : things.stored.view,
                                    VK_IMAGE_LAYOUT_GENERAL};
  VkWriteDescriptorSet info{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  info.dstSet = set;
  info.dstBinding = binding;
  info.descriptorCount = 1;
  info.descriptorType = kTypes[what];
  info.pBufferInfo = &buffer;
  info.pImageInfo = &image;
  info.pTexelBufferView = &things.view;
  vkUpdateDescriptorSets(run.device, 1, &info, 0, nullptr);
}

void copy(Run& run, VkDescriptorSet from, VkDescriptorSet to, uint32_t binding) {
  VkCopyDescriptorSet info{VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET};
  info.srcSet = from;
  info.dstSet = to;
  info.srcBinding = info.dstBinding = binding;
  info.descriptorCount = 1;
  vkUpdateDescriptorSets(run.device, 0, nullptr, 1, &info);
}

struct Sets {
  VkDescriptorSetLayout layout[2];
  VkDescriptorSet set[2];
};

/// Two sets; of the first the bindings in `changing` are mutable, of the second the others, where the device has that.
Sets make_sets(Run& run, bool has, uint32_t changing) {
  Sets out{};
  VkDescriptorPoolSize sizes[kCount + 1];
  for (uint32_t i = 0; i < kCount; ++i) sizes[i] = {kTypes[i], 2};
  sizes[kCount] = {VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 2 * kCount};
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = 2;
  pool_info.poolSizeCount = has ? kCount + 1 : kCount;
  pool_info.pPoolSizes = sizes;
  VkDescriptorPool pool;
  CTS_VK(vkCreateDescriptorPool(run.device, &pool_info, nullptr, &pool));
  run.own(pool, vkDestroyDescriptorPool);
  for (uint32_t set = 0; set < 2; ++set) {
    VkDescriptorSetLayoutBinding bindings[kCount];
    VkMutableDescriptorTypeListEXT lists[kCount]{};
    for (uint32_t i = 0; i < kCount; ++i) {
      const bool changes = has && (changing >> i & 1) == (set == 0 ? 1u : 0u);
      bindings[i] = {i, changes ? VK_DESCRIPTOR_TYPE_MUTABLE_EXT : kTypes[i], 1, VK_SHADER_STAGE_ALL, nullptr};
      if (changes) lists[i] = {kCount, kTypes};
    }
    const VkMutableDescriptorTypeCreateInfoEXT types{VK_STRUCTURE_TYPE_MUTABLE_DESCRIPTOR_TYPE_CREATE_INFO_EXT, nullptr,
                                                     kCount, lists};
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, has ? &types : nullptr};
    info.bindingCount = kCount;
    info.pBindings = bindings;
    CTS_VK(vkCreateDescriptorSetLayout(run.device, &info, nullptr, &out.layout[set]));
    run.own(out.layout[set], vkDestroyDescriptorSetLayout);
  }
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocate.descriptorPool = pool;
  allocate.descriptorSetCount = 2;
  allocate.pSetLayouts = out.layout;
  CTS_VK(vkAllocateDescriptorSets(run.device, &allocate, out.set));
  return out;
}

CTS_RANDOM("descriptor_indexing", "mutable", 12) {
  run.require(gpus().device.extension_features.mutableDescriptorType, "mutableDescriptorType");
  const bool has = run.gpu.extension_features.mutableDescriptorType;
  Random& random = run.random;
  const uint32_t changing = random.bits() & ((1u << kCount) - 1), copied = random.bits();
  const Things things = make_things(run);
  const Sets sets = make_sets(run, has, changing);
  for (uint32_t i = 0; i < kCount; ++i) {
    // A mutable descriptor is something else before.
    const uint32_t before = random.below(kCount);
    if (has) write(run, sets.set[changing >> i & 1 ? 0 : 1], i, before, things);
    write(run, sets.set[copied >> i & 1 ? 1 : 0], i, i, things);
    if (copied >> i & 1) copy(run, sets.set[1], sets.set[0], i);
  }
  Resources resources;
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = 1;
  info.pSetLayouts = &sets.layout[0];
  CTS_VK(vkCreatePipelineLayout(run.device, &info, nullptr, &resources.layout));
  run.own(resources.layout, vkDestroyPipelineLayout);
  resources.set = sets.set[0];
  run.dispatch(resources, run.compute(resources.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, kCode)), 1);
  run.out("storage", things.storage);
  run.out("stored", things.stored);
}

}  // namespace
}  // namespace vitrine::cts
