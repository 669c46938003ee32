// VK_EXT_descriptor_buffer, which the reference does not know: what shaders see of descriptors in buffers is what they
// see of the same descriptors in sets.
#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/icd/descriptor_buffers_fixture.h"
#include "tests/icd/maintenance5_draws_fixture.h"

namespace vitrine::icd::test {
namespace {

TEST_F(DescriptorBuffers, IsOfferedWithItsSizes) {
  auto features = make_struct<VkPhysicalDeviceDescriptorBufferFeaturesEXT>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.descriptorBuffer);
  EXPECT_TRUE(features.descriptorBufferImageLayoutIgnored);
  EXPECT_TRUE(features.descriptorBufferPushDescriptors);
  EXPECT_FALSE(features.descriptorBufferCaptureReplay);
  // Every byte of every descriptor is written, and none behind it.
  for (const VkDescriptorType type : kTypes) {
    std::array<unsigned char, 64> a, b;
    a.fill(0xaa);
    b.fill(0x55);
    get(type, a.data(), data);
    get(type, b.data(), data);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), size_of(type)), 0) << type;
    EXPECT_EQ(a[size_of(type)], 0xaa) << type;
  }
}

TEST_F(DescriptorBuffers, LayoutsPlaceBindingsOneAfterTheOther) {
  VkMutableDescriptorTypeListEXT lists[4]{};
  const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
  lists[3] = {2, types};
  auto mutables = make_struct<VkMutableDescriptorTypeCreateInfoEXT>();
  mutables.mutableDescriptorTypeListCount = 4;
  mutables.pMutableDescriptorTypeLists = lists;
  const VkDescriptorSetLayout layout =
      make_buffer_layout({{9, VK_DESCRIPTOR_TYPE_SAMPLER, 3, VK_SHADER_STAGE_ALL, nullptr},
                          {2, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 2, VK_SHADER_STAGE_ALL, nullptr},
                          {4, VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, 20, VK_SHADER_STAGE_ALL, nullptr},
                          {12, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 4, VK_SHADER_STAGE_ALL, nullptr}},
                         0, &mutables);
  const auto offset = [&](std::uint32_t binding) {
    return static_cast<std::size_t>(place(layout, 0, binding) - reinterpret_cast<std::byte*>(descriptors.floats));
  };
  VkDeviceSize size = 0;
  VK_CALL(GetDescriptorSetLayoutSizeEXT)(device, layout, &size);
  EXPECT_EQ(offset(2), 0u);
  EXPECT_GE(offset(4), 2 * size_of(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER));
  EXPECT_EQ(offset(4) % 16, 0u);
  EXPECT_GE(offset(9), offset(4) + 20);
  EXPECT_GE(offset(12), offset(9) + 3 * size_of(VK_DESCRIPTOR_TYPE_SAMPLER));
  // "the maximum size of any type" in the list is the stride.
  EXPECT_EQ(size, offset(12) + 4 * size_of(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER));
}

TEST_F(DescriptorBuffers, EveryKindIsAsInASet) {
  const VkDescriptorSetLayout sets = make_set_layout_of(kTypes);
  const VkPipelineLayout plain = make_layout(sets);
  dispatch(make_compute(plain), plain, make_full_set(sets, kTypes), output);
  const std::vector<float> wanted(result.floats, result.floats + kKinds);
  EXPECT_EQ(wanted[2], 7.0f);
  EXPECT_EQ(wanted[6], 2.0f);
  data.floats[0] = 2;
  memories[2].floats[0] = 7;
  const VkDescriptorSetLayout inputs = make_buffer_layout_of(kTypes);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  for (std::uint32_t i = 0; i < kKinds; ++i) get(kTypes[i], place(inputs, 1, i), data);
  const VkPipeline pipeline = make_compute(layout);
  dispatch_from_buffer(pipeline, layout, 1);
  EXPECT_EQ(std::vector<float>(result.floats, result.floats + kKinds), wanted);
  // Zeros are null descriptors.
  dispatch_from_buffer(pipeline, layout, 2);
  for (std::uint32_t i = 0; i < kKinds; ++i) EXPECT_EQ(result.floats[i], 0.0f) << i;
  // So is what was never bound.
  dispatch(pipeline, layout, VK_NULL_HANDLE, output);
  for (std::uint32_t i = 0; i < kKinds; ++i) EXPECT_EQ(result.floats[i], 0.0f) << i;
}

#ifdef VK_EXT_shader_object
/// Shader objects have no flag for it: their set layouts say where descriptors lie.
TEST_F(DescriptorBuffers, ShaderObjectsSeeThem) {
  const VkDescriptorSetLayout inputs = make_buffer_layout_of(kTypes);
  const VkDescriptorSetLayout out = make_buffer_layout_of(std::array{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  for (std::uint32_t i = 0; i < kKinds; ++i) get(kTypes[i], place(inputs, 1, i), data);
  dispatch_from_buffer(make_compute(layout), layout, 1);
  const std::vector<float> wanted(result.floats, result.floats + kKinds);
  EXPECT_EQ(wanted[2], 7.0f);
  memories[2].floats[0] = 7;
  data.floats[0] = 2;
  const VkDescriptorSetLayout sets[] = {inputs, out};
  const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, 4};
  auto info = make_struct<VkShaderCreateInfoEXT>();
  info.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.codeType = VK_SHADER_CODE_TYPE_SPIRV_EXT;
  info.codeSize = sizeof kEveryResourceWords;
  info.pCode = kEveryResourceWords;
  info.pName = "main";
  info.setLayoutCount = 2;
  info.pSetLayouts = sets;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  VkShaderEXT shader = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateShadersEXT)(device, 1, &info, nullptr, &shader), VK_SUCCESS);
  std::fill_n(result.floats, kBytes / sizeof(float), -1.0f);
  const VkCommandBuffer commands = begin();
  VK_CALL(CmdBindShadersEXT)(commands, 1, &info.stage, &shader);
  bind(commands, layout, 1, 3);
  VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  run(commands);
  EXPECT_EQ(std::vector<float>(result.floats, result.floats + kKinds), wanted);
  VK_CALL(DestroyShaderEXT)(device, shader, nullptr);
}
#endif

TEST_F(DescriptorBuffers, NullDescriptorsCanBeGot) {
  const VkDescriptorSetLayout inputs = make_buffer_layout_of(kTypes);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  std::memset(descriptors.floats, 0xff, kSetBytes);
  for (std::uint32_t i = 0; i < kKinds; ++i) {
    const VkDescriptorImageInfo none{sampler, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED};
    auto info = make_struct<VkDescriptorGetInfoEXT>();
    info.type = kTypes[i];
    if (kTypes[i] == VK_DESCRIPTOR_TYPE_SAMPLER)
      info.data.pSampler = &sampler;
    else if (kTypes[i] == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)
      info.data.pCombinedImageSampler = &none;
    else
      info.data.pSampledImage = nullptr;
    VK_CALL(GetDescriptorEXT)(device, &info, size_of(kTypes[i]), place(inputs, 0, i));
  }
  dispatch_from_buffer(make_compute(layout), layout);
  for (std::uint32_t i = 0; i < kKinds; ++i) EXPECT_EQ(result.floats[i], 0.0f) << i;
}

TEST_F(DescriptorBuffers, AnyBytesAreHarmless) {
  const VkDescriptorSetLayout inputs = make_buffer_layout_of(kTypes);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  const VkPipeline pipeline = make_compute(layout);
  std::mt19937_64 random(1);
  auto* const bytes = reinterpret_cast<unsigned char*>(descriptors.floats);
  for (int round = 0; round < 2000; ++round) {
    for (std::uint32_t i = 0; i < kKinds; ++i) get(kTypes[i], place(inputs, 0, i), data);
    for (int change = 0; change < 1 + round % 64; ++change) {
      const std::uint64_t chosen = random();
      unsigned char& byte = bytes[chosen % 160];
      byte = chosen >> 32 & 1 ? static_cast<unsigned char>(chosen >> 40) : static_cast<unsigned char>(chosen >> 33 & 7);
    }
    dispatch_from_buffer(pipeline, layout);
  }
  get(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, place(inputs, 0, 0), data);
  dispatch_from_buffer(pipeline, layout);
  EXPECT_EQ(result.floats[0], data.floats[0]);
  // Buffers of descriptors that are not there.
  const VkCommandBuffer commands = begin();
  auto info = make_struct<VkDescriptorBufferBindingInfoEXT>();
  info.address = 0x1000;
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  VK_CALL(CmdBindDescriptorBuffersEXT)(commands, 1, &info);
  const std::uint32_t indices[] = {0, 77};
  const VkDeviceSize offsets[] = {~0ull, 0};
  VK_CALL(CmdSetDescriptorBufferOffsetsEXT)
  (commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, indices, offsets);
  VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  run(commands);
}

TEST_F(DescriptorBuffers, WhatIsDestroyedIsNull) {
  const VkDescriptorSetLayout inputs = make_buffer_layout_of(kTypes);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  for (std::uint32_t i = 0; i < kKinds; ++i) get(kTypes[i], place(inputs, 0, i), data);
  const VkPipeline pipeline = make_compute(layout);
  VK_CALL(DestroyImageView)(device, view, nullptr);
  view = VK_NULL_HANDLE;
  dispatch_from_buffer(pipeline, layout);
  for (const std::uint32_t i : {2u, 3u, 4u, 5u}) EXPECT_EQ(result.floats[i], 0.0f) << i;
  EXPECT_EQ(result.floats[0], 2.0f);
  // Its successor is another one.
  auto view_info = make_struct<VkImageViewCreateInfo>();
  view_info.image = image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = VK_FORMAT_R32_SFLOAT;
  view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  ASSERT_EQ(VK_CALL(CreateImageView)(device, &view_info, nullptr, &view), VK_SUCCESS);
  std::byte unused[16];
  get(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, unused, data);
  dispatch_from_buffer(pipeline, layout);
  EXPECT_EQ(result.floats[3], 0.0f);
  get(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, place(inputs, 0, 3), data);
  dispatch_from_buffer(pipeline, layout);
  EXPECT_EQ(result.floats[3], 7.0f);
}

TEST_F(DescriptorBuffers, EmbeddedSamplersNeedNoMemory) {
  const VkDescriptorSetLayout textures = make_buffer_layout_of(std::array{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE});
  const VkDescriptorSetLayout samplers =
      make_buffer_layout({{0, VK_DESCRIPTOR_TYPE_SAMPLER, 1, VK_SHADER_STAGE_ALL, &sampler}},
                         VK_DESCRIPTOR_SET_LAYOUT_CREATE_EMBEDDED_IMMUTABLE_SAMPLERS_BIT_EXT);
  const VkDescriptorSetLayout out = make_buffer_layout_of(std::array{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  const VkDescriptorSetLayout sets[] = {textures, out, samplers};
  auto info = make_struct<VkPipelineLayoutCreateInfo>();
  info.setLayoutCount = 3;
  info.pSetLayouts = sets;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
  layouts.push_back(layout);
  get(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, place(textures, 0, 0), data);
  get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, place(out, 3, 0), result);
  const VkPipeline pipeline = compile_compute(layout,
                                              "layout(set = 0, binding = 0) uniform texture2D t;\n"
                                              "layout(set = 1, binding = 0) buffer O { float o[]; };\n"
                                              "layout(set = 2, binding = 0) uniform sampler s;\n"
                                              "void main() { o[0] = textureLod(sampler2D(t, s), vec2(0.5), 0).x; }");
  const auto bind_samplers = [&](VkCommandBuffer commands, [[maybe_unused]] bool newer) {
#ifdef VK_KHR_maintenance6
    auto where = make_struct<VkBindDescriptorBufferEmbeddedSamplersInfoEXT>();
    where.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    where.layout = layout;
    where.set = 2;
    if (newer) return VK_CALL(CmdBindDescriptorBufferEmbeddedSamplers2EXT)(commands, &where);
#endif
    VK_CALL(CmdBindDescriptorBufferEmbeddedSamplersEXT)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 2);
  };
  for (const int way : {0, 1, 2}) {  // by the newer command, by the older one, not at all
    const bool bound = way < 2;
    result.floats[0] = 0;
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    bind(commands, layout, 0, 3);
    if (bound) bind_samplers(commands, way == 0);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    run(commands);
    EXPECT_TRUE(!bound || result.floats[0] == 7.0f);
  }
}

TEST_F(DescriptorBuffers, PushedSetsGoBeside) {
  const VkDescriptorSetLayout pushed =
      make_buffer_layout({{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr}},
                         VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(pushed);
  const VkPipeline pipeline = compile_compute(layout,
                                              "layout(set = 0, binding = 0) buffer I { float i[]; };\n"
                                              "layout(set = 1, binding = 0) buffer O { float o[]; };\n"
                                              "void main() { o[0] = i[1]; }");
  const VkCommandBuffer commands = begin();
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  bind(commands, layout, 2, 3);
  const VkDescriptorBufferInfo range{data.buffer, 8, VK_WHOLE_SIZE};
  auto write = make_struct<VkWriteDescriptorSet>();
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &range;
  VK_CALL(CmdPushDescriptorSetKHR)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &write);
  VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  run(commands);
  EXPECT_EQ(result.floats[0], data.floats[3]);
}

TEST_F(DescriptorBuffers, BlocksAndMutableDescriptorsLieInIt) {
  const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                    VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};
  const VkMutableDescriptorTypeListEXT lists[] = {{}, {3, types}, {3, types}, {3, types}};
  auto mutables = make_struct<VkMutableDescriptorTypeCreateInfoEXT>();
  mutables.mutableDescriptorTypeListCount = 4;
  mutables.pMutableDescriptorTypeLists = lists;
  const VkDescriptorSetLayout inputs =
      make_buffer_layout({{0, VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, 16, VK_SHADER_STAGE_ALL, nullptr},
                          {1, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 1, VK_SHADER_STAGE_ALL, nullptr},
                          {2, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 1, VK_SHADER_STAGE_ALL, nullptr},
                          {3, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 1, VK_SHADER_STAGE_ALL, nullptr}},
                         0, &mutables);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  const float block[] = {11, 12, 13, 14};
  std::memcpy(place(inputs, 0, 0), block, sizeof block);
  get(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, place(inputs, 0, 1), data);
  get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, place(inputs, 0, 2), data);
  get(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, place(inputs, 0, 3), data);
  const VkPipeline pipeline =
      compile_compute(layout,
                      "#extension GL_EXT_samplerless_texture_functions : require\n"
                      "layout(set = 0, binding = 0) uniform U { vec4 u; };\n"
                      "layout(set = 0, binding = 1) uniform texture2D t;\n"
                      "layout(set = 0, binding = 2) buffer I { float i[]; };\n"
                      "layout(set = 0, binding = 3, r32f) uniform imageBuffer w;\n"
                      "layout(set = 1, binding = 0) buffer O { float o[]; };\n"
                      "void main() { o[0] = u.z; o[1] = texelFetch(t, ivec2(0), 0).x; o[2] = i[1];\n"
                      "  o[3] = imageLoad(w, 2).x; }");
  dispatch_from_buffer(pipeline, layout);
  EXPECT_EQ(std::vector<float>(result.floats, result.floats + 4), std::vector<float>({13, 7, 3, 4}));
}

/// Sets that are kept from one command to the next (icd/replay/descriptor_buffers.h): what changes is seen.
TEST_F(DescriptorBuffers, LargeSetsFollowTheirBytes) {
  constexpr std::uint32_t kCount = 5000;
  const auto flags = std::array{VkDescriptorBindingFlags{VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT}};
  auto binding_flags = make_struct<VkDescriptorSetLayoutBindingFlagsCreateInfo>();
  binding_flags.bindingCount = 1;
  binding_flags.pBindingFlags = flags.data();
  const VkDescriptorSetLayout inputs = make_buffer_layout(
      {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCount, VK_SHADER_STAGE_ALL, nullptr}}, 0, &binding_flags);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  const VkPipeline pipeline =
      compile_compute(layout,
                      "#extension GL_EXT_nonuniform_qualifier : require\n"
                      "layout(set = 0, binding = 0) buffer I { float i[]; } all[];\n"
                      "layout(set = 1, binding = 0) buffer O { float o[]; };\n"
                      "layout(push_constant) uniform P { uint which; };\n"
                      "void main() { o[0] = all[which].i[0]; o[1] = float(all[which].i.length()); }");
  // The buffer of descriptors has room for a few elements only; the others are not there.
  Memory large;
  auto allocate = make_struct<VkMemoryAllocateInfo>();
  allocate.allocationSize = kCount * 16;
  ASSERT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &large.memory), VK_SUCCESS);
  auto info = make_struct<VkBufferCreateInfo>();
  info.size = allocate.allocationSize;
  info.usage = VK_BUFFER_USAGE_RESOURCE_DESCRIPTOR_BUFFER_BIT_EXT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  ASSERT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &large.buffer), VK_SUCCESS);
  ASSERT_EQ(VK_CALL(BindBufferMemory)(device, large.buffer, large.memory, 0), VK_SUCCESS);
  void* mapped = nullptr;
  ASSERT_EQ(VK_CALL(MapMemory)(device, large.memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
  large.floats = static_cast<float*>(mapped);
  memories.push_back(large);
  auto* const bytes = static_cast<std::byte*>(mapped);
  const auto read = [&](std::uint32_t which) {
    std::fill_n(result.floats, 2, -1.0f);
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VkDescriptorBufferBindingInfoEXT infos[] = {make_struct<VkDescriptorBufferBindingInfoEXT>(),
                                                make_struct<VkDescriptorBufferBindingInfoEXT>()};
    infos[0].address = address_of(large);
    infos[1].address = address_of(descriptors);
    VK_CALL(CmdBindDescriptorBuffersEXT)(commands, 2, infos);
    const std::uint32_t indices[] = {0, 1};
    const VkDeviceSize offsets[] = {0, 3 * kSetBytes};
    VK_CALL(CmdSetDescriptorBufferOffsetsEXT)
    (commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, indices, offsets);
    VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, 4, &which);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    run(commands);
    return std::pair(result.floats[0], result.floats[1]);
  };
  using Pair = std::pair<float, float>;
  EXPECT_EQ(read(4999), Pair(0, 0));
  get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, bytes + 4999 * 16, data, 64);
  get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, bytes + 17 * 16, descriptors, 32);
  EXPECT_EQ(read(4999), Pair(data.floats[0], 16));
  EXPECT_EQ(read(17).second, 8);
  EXPECT_EQ(read(18), Pair(0, 0));
  std::memcpy(bytes + 18 * 16, bytes + 4999 * 16, 16);
  EXPECT_EQ(read(18), Pair(data.floats[0], 16));
  // The memory that a descriptor names goes.
  Memory gone = make_buffer();
  gone.floats[0] = 99;
  get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, bytes + 300 * 16, gone, 64);
  EXPECT_EQ(read(300), Pair(99, 16));
  std::memset(bytes, 0, kCount * 16);
  EXPECT_EQ(read(4999), Pair(0, 0));
}

/// What a dispatch writes into the buffer is what the next one is given.
TEST_F(DescriptorBuffers, ShadersMayWriteDescriptors) {
  const auto types = std::array{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
  const VkDescriptorSetLayout inputs = make_buffer_layout_of(types);
  const VkPipelineLayout layout = make_buffer_pipeline_layout(inputs);
  get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, place(inputs, 0, 0), descriptors);
  get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, place(inputs, 1, 0), data);
  // Copies the words of set 1 to where set 2 lies, then reads it.
  const VkPipeline writes = compile_compute(layout,
                                            "layout(set = 0, binding = 0) buffer I { uint d[]; };\n"
                                            "void main() { for (int i = 0; i < 8; ++i) d[512 + i] = d[256 + i]; }");
  const VkPipeline reads = compile_compute(layout,
                                           "layout(set = 0, binding = 0) buffer I { float i[]; };\n"
                                           "layout(set = 1, binding = 0) buffer O { float o[]; };\n"
                                           "void main() { o[0] = i[5]; }");
  const VkCommandBuffer commands = begin();
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, writes);
  bind(commands, layout, 0, 3);
  VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  VK_CALL(CmdPipelineBarrier)
  (commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 0,
   nullptr);
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, reads);
  bind(commands, layout, 2, 3);
  VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  run(commands);
  EXPECT_EQ(result.floats[0], data.floats[5]);
}

#ifdef VK_KHR_maintenance6
using DescriptorBuffersDraws = Maintenance5Draws;

/// Draws of one pass see the sets that were bound when they were recorded, by either command.
TEST_F(DescriptorBuffersDraws, EachDrawHasItsSet) {
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr};
  auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
  shape.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_DESCRIPTOR_BUFFER_BIT_EXT;
  shape.bindingCount = 1;
  shape.pBindings = &binding;
  VkDescriptorSetLayout inputs;
  ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &inputs), VK_SUCCESS);
  const VkDescriptorSetLayout first_layout = std::exchange(set_layout, inputs);
  auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &inputs;
  VkPipelineLayout buffers_layout;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &buffers_layout), VK_SUCCESS);
  const VkPipelineLayout plain = std::exchange(layout, buffers_layout);
  const Bytes bytes = make_bytes(4096);
  const auto address = reinterpret_cast<VkDeviceAddress>(bytes.data);
  for (std::uint32_t i = 0; i < 16; ++i) {
    const float color = static_cast<float>(i) / 255;
    std::memcpy(bytes.data + 2048 + i * 64, &color, 4);
    auto range = make_struct<VkDescriptorAddressInfoEXT>();
    range.address = address + 2048 + i * 64;
    range.range = 16;
    auto info = make_struct<VkDescriptorGetInfoEXT>();
    info.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    info.data.pUniformBuffer = &range;
    VK_CALL(GetDescriptorEXT)(device, &info, 16, bytes.data + i * 64);
  }
  Draw draw;
  draw.fragment =
      "layout(set = 0, binding = 0) uniform U { float u; }; layout(location = 0) out vec4 c;\n"
      "void main() { c = vec4(u); }";
  draw.dynamic = {VK_DYNAMIC_STATE_SCISSOR};
  for (const bool by_structure : {false, true}) {
    const Picture picture = render(draw, [&](VkCommandBuffer commands) {
      auto bound = make_struct<VkDescriptorBufferBindingInfoEXT>();
      bound.address = address;
      VK_CALL(CmdBindDescriptorBuffersEXT)(commands, 1, &bound);
      for (std::uint32_t i = 0; i < 16; ++i) {
        const VkRect2D row{{0, static_cast<std::int32_t>(i)}, {kSide, 1}};
        VK_CALL(CmdSetScissor)(commands, 0, 1, &row);
        const std::uint32_t index = 0;
        const VkDeviceSize offset = i * 64;
        auto info = make_struct<VkSetDescriptorBufferOffsetsInfoEXT>();
        info.stageFlags = VK_SHADER_STAGE_ALL_GRAPHICS;
        info.layout = layout;
        info.setCount = 1;
        info.pBufferIndices = &index;
        info.pOffsets = &offset;
        if (by_structure)
          VK_CALL(CmdSetDescriptorBufferOffsets2EXT)(commands, &info);
        else
          VK_CALL(CmdSetDescriptorBufferOffsetsEXT)
        (commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &index, &offset);
        VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
      }
    });
    for (std::uint32_t y = 0; y < 16; ++y) EXPECT_EQ(texel(picture, 3, y, 4), 0x01010101u * y) << by_structure << y;
  }
  layout = plain;
  set_layout = first_layout;
  VK_CALL(DestroyPipelineLayout)(device, buffers_layout, nullptr);
  VK_CALL(DestroyDescriptorSetLayout)(device, inputs, nullptr);
}
#endif

}  // namespace
}  // namespace vitrine::icd::test
