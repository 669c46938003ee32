// Descriptor pools and their limits; writes and copies into sets; dynamic buffers.
#include "icd/object/descriptors.h"

#include "icd/object/memory.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

class DescriptorSets : public DeviceTest {
 protected:
  VkDescriptorSetLayout make_layout(std::initializer_list<VkDescriptorSetLayoutBinding> bindings) {
    auto info = make_struct<VkDescriptorSetLayoutCreateInfo>();
    info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    info.pBindings = bindings.begin();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
    layouts.push_back(layout);
    return layout;
  }
  VkDescriptorPool make_pool(std::uint32_t sets, std::initializer_list<VkDescriptorPoolSize> sizes) {
    auto info = make_struct<VkDescriptorPoolCreateInfo>();
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = sets;
    info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    info.pPoolSizes = sizes.begin();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateDescriptorPool)(device, &info, nullptr, &pool), VK_SUCCESS);
    pools.push_back(pool);
    return pool;
  }
  VkResult allocate(VkDescriptorPool pool, std::vector<VkDescriptorSetLayout> wanted, VkDescriptorSet* sets) {
    auto info = make_struct<VkDescriptorSetAllocateInfo>();
    info.descriptorPool = pool;
    info.descriptorSetCount = static_cast<std::uint32_t>(wanted.size());
    info.pSetLayouts = wanted.data();
    return VK_GET(instance, AllocateDescriptorSets)(device, &info, sets);
  }
  void update(const VkWriteDescriptorSet& write) {
    VK_GET(instance, UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
  }
  void TearDown() override {
    for (VkDescriptorPool pool : pools) VK_GET(instance, DestroyDescriptorPool)(device, pool, nullptr);
    for (VkDescriptorSetLayout layout : layouts) VK_GET(instance, DestroyDescriptorSetLayout)(device, layout, nullptr);
    DeviceTest::TearDown();
  }
  /// A buffer object without an API behind it: `bytes` long, somewhere.
  Buffer& fake_buffer(std::uint64_t bytes) {
    buffers.push_back(std::make_unique<Buffer>(HostMemory()));
    buffers.back()->size = bytes;
    buffers.back()->data = storage;
    return *buffers.back();
  }

  std::vector<VkDescriptorSetLayout> layouts;
  std::vector<VkDescriptorPool> pools;
  std::vector<std::unique_ptr<Buffer>> buffers;
  std::byte storage[4096];
};

VkWriteDescriptorSet buffer_write(VkDescriptorSet set, std::uint32_t binding, std::uint32_t element,
                                  VkDescriptorType type, const std::vector<VkDescriptorBufferInfo>& infos) {
  auto write = make_struct<VkWriteDescriptorSet>();
  write.dstSet = set;
  write.dstBinding = binding;
  write.dstArrayElement = element;
  write.descriptorType = type;
  write.descriptorCount = static_cast<std::uint32_t>(infos.size());
  write.pBufferInfo = infos.data();
  return write;
}

TEST_F(DescriptorSets, PoolsHoldWhatWasAskedForAndNoMore) {
  const VkDescriptorSetLayout layout =
      make_layout({{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 3, VK_SHADER_STAGE_ALL, {}}});
  const VkDescriptorPool pool = make_pool(3, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 6}});
  VkDescriptorSet sets[3];
  EXPECT_EQ(allocate(pool, {layout, layout}, sets), VK_SUCCESS);
  EXPECT_EQ(allocate(pool, {layout}, &sets[2]), VK_ERROR_OUT_OF_POOL_MEMORY) << "descriptors are used up";
  EXPECT_EQ(sets[2], VkDescriptorSet{VK_NULL_HANDLE});
  EXPECT_EQ(VK_GET(instance, FreeDescriptorSets)(device, pool, 1, sets), VK_SUCCESS);
  EXPECT_EQ(allocate(pool, {layout, layout}, sets), VK_ERROR_OUT_OF_POOL_MEMORY);
  EXPECT_EQ(sets[0], VkDescriptorSet{VK_NULL_HANDLE}) << "all or none";
  EXPECT_EQ(allocate(pool, {layout}, sets), VK_SUCCESS) << "the failed call took nothing";
  EXPECT_EQ(VK_GET(instance, ResetDescriptorPool)(device, pool, 0), VK_SUCCESS);
  EXPECT_EQ(allocate(pool, {layout, layout}, sets), VK_SUCCESS);
}

TEST_F(DescriptorSets, PoolsCountSetsAndTypes) {
  const VkDescriptorSetLayout empty = make_layout({});
  const VkDescriptorSetLayout uniform =
      make_layout({{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, {}}});
  const VkDescriptorPool pool =
      make_pool(2, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 6}, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}});
  VkDescriptorSet set;
  EXPECT_EQ(allocate(pool, {uniform}, &set), VK_ERROR_OUT_OF_POOL_MEMORY) << "no such type in the pool";
  EXPECT_EQ(allocate(pool, {empty}, &set), VK_SUCCESS);
  EXPECT_EQ(allocate(pool, {empty}, &set), VK_SUCCESS);
  EXPECT_EQ(allocate(pool, {empty}, &set), VK_ERROR_OUT_OF_POOL_MEMORY) << "maxSets";
}

/// VkDescriptorPoolInlineUniformBlockCreateInfo may be too small, or missing: the bytes decide.
TEST_F(DescriptorSets, PoolsCountInlineUniformBlocksInBytes) {
  const VkDescriptorSetLayout block =
      make_layout({{0, VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, 16, VK_SHADER_STAGE_ALL, {}}});
  const VkDescriptorPool pool = make_pool(3, {{VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, 32}});
  VkDescriptorSet sets[3];
  EXPECT_EQ(allocate(pool, {block, block}, sets), VK_SUCCESS);
  EXPECT_EQ(allocate(pool, {block}, &sets[2]), VK_ERROR_OUT_OF_POOL_MEMORY);
}

TEST_F(DescriptorSets, WritesGoOnInTheNextBinding) {
  constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  const VkDescriptorSetLayout layout = make_layout({{7, kType, 2, VK_SHADER_STAGE_ALL, {}},
                                                    {3, kType, 2, VK_SHADER_STAGE_ALL, {}},
                                                    {5, kType, 0, VK_SHADER_STAGE_ALL, {}}});
  VkDescriptorSet set;
  ASSERT_EQ(allocate(make_pool(1, {{kType, 4}}), {layout}, &set), VK_SUCCESS);
  const VkBuffer buffer = to_handle(&fake_buffer(100));
  update(buffer_write(set, 3, 1, kType, {{buffer, 0, 10}, {buffer, 20, VK_WHOLE_SIZE}, {buffer, 90, 30}}));
  const DescriptorSet& s = from_handle<DescriptorSet>(set);
  EXPECT_EQ(s.slots[0].data, nullptr);
  EXPECT_EQ(s.slots[1].data, storage);
  EXPECT_EQ(s.slots[1].size, 10u);
  EXPECT_EQ(s.slots[2].data, storage + 20);
  EXPECT_EQ(s.slots[2].size, 80u);
  EXPECT_EQ(s.slots[3].size, 10u) << "cut at the end of the buffer";
}

TEST_F(DescriptorSets, TheLastBindingMayHaveACountOfEachSet) {
  constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  const VkDescriptorSetLayoutBinding bindings[2] = {{0, kType, 2, VK_SHADER_STAGE_ALL, {}},
                                                    {4, kType, 100, VK_SHADER_STAGE_ALL, {}}};
  const VkDescriptorBindingFlags binding_flags[2] = {0, VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT |
                                                            VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT |
                                                            VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT};
  auto flags = make_struct<VkDescriptorSetLayoutBindingFlagsCreateInfo>();
  flags.bindingCount = 2;
  flags.pBindingFlags = binding_flags;
  auto info = make_struct<VkDescriptorSetLayoutCreateInfo>(&flags);
  info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
  info.bindingCount = 2;
  info.pBindings = bindings;
  auto variable_support = make_struct<VkDescriptorSetVariableDescriptorCountLayoutSupport>();
  auto support = make_struct<VkDescriptorSetLayoutSupport>(&variable_support);
  VK_GET(instance, GetDescriptorSetLayoutSupport)(device, &info, &support);
  EXPECT_TRUE(support.supported);
  EXPECT_GE(variable_support.maxVariableDescriptorCount, 1000000u);
  VkDescriptorSetLayout layout;
  ASSERT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
  layouts.push_back(layout);

  const VkDescriptorPool pool = make_pool(2, {{kType, 12}});
  const std::uint32_t wanted[2] = {5, 3};
  auto counts = make_struct<VkDescriptorSetVariableDescriptorCountAllocateInfo>();
  counts.descriptorSetCount = 2;
  counts.pDescriptorCounts = wanted;
  const VkDescriptorSetLayout twice[2] = {layout, layout};
  auto allocate_info = make_struct<VkDescriptorSetAllocateInfo>(&counts);
  allocate_info.descriptorPool = pool;
  allocate_info.descriptorSetCount = 2;
  allocate_info.pSetLayouts = twice;
  VkDescriptorSet sets[2];
  ASSERT_EQ(VK_GET(instance, AllocateDescriptorSets)(device, &allocate_info, sets), VK_SUCCESS);
  EXPECT_EQ(from_handle<DescriptorSet>(sets[0]).slot_count, 7u);
  EXPECT_EQ(from_handle<DescriptorSet>(sets[1]).slot_count, 5u);
  const VkBuffer buffer = to_handle(&fake_buffer(100));
  update(buffer_write(sets[1], 4, 2, kType, {{buffer, 0, 16}, {buffer, 0, 16}}));  // the second is beyond the end
  EXPECT_EQ(from_handle<DescriptorSet>(sets[1]).slots[4].size, 16u);
  EXPECT_EQ(VK_GET(instance, FreeDescriptorSets)(device, pool, 2, sets), VK_SUCCESS);
  const std::uint32_t all = 10;
  counts.descriptorSetCount = allocate_info.descriptorSetCount = 1;
  counts.pDescriptorCounts = &all;
  EXPECT_EQ(VK_GET(instance, AllocateDescriptorSets)(device, &allocate_info, sets), VK_SUCCESS)
      << "the sets gave back what they had";
}

TEST_F(DescriptorSets, CopiesMoveElementsBetweenSets) {
  constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  const VkDescriptorSetLayout layout = make_layout({{0, kType, 2, VK_SHADER_STAGE_ALL, {}}});
  VkDescriptorSet sets[2];
  ASSERT_EQ(allocate(make_pool(2, {{kType, 4}}), {layout, layout}, sets), VK_SUCCESS);
  const VkBuffer buffer = to_handle(&fake_buffer(100));
  update(buffer_write(sets[0], 0, 0, kType, {{buffer, 0, 16}, {buffer, 16, 16}}));
  auto copy = make_struct<VkCopyDescriptorSet>();
  copy.srcSet = sets[0];
  copy.dstSet = sets[1];
  copy.dstArrayElement = 1;
  copy.descriptorCount = 1;
  VK_GET(instance, UpdateDescriptorSets)(device, 0, nullptr, 1, &copy);
  EXPECT_EQ(from_handle<DescriptorSet>(sets[1]).slots[0].data, nullptr);
  EXPECT_EQ(from_handle<DescriptorSet>(sets[1]).slots[1].data, storage);
}

/// A mutable descriptor is what was last written to it, and nothing else; dynamic buffers and inline blocks are beyond
/// it.
TEST_F(DescriptorSets, MutableDescriptorsChangeTheirType) {
  const VkDescriptorSetLayout layout = make_layout({{0, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 2, VK_SHADER_STAGE_ALL, {}}});
  const VkDescriptorPool pool = make_pool(1, {{VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 2}});
  VkDescriptorSet set;
  ASSERT_EQ(allocate(pool, {layout}, &set), VK_SUCCESS);
  const std::vector<VkDescriptorBufferInfo> infos = {{to_handle(&fake_buffer(100)), 0, 16}};
  VkWriteDescriptorSet write = buffer_write(set, 0, 1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, infos);
  update(write);
  const spirv::Descriptor& slot = from_handle<DescriptorSet>(set).slots[1];
  EXPECT_EQ(slot.size, 16u);
  const VkDescriptorImageInfo nothing{};
  write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  write.pImageInfo = &nothing;
  update(write);
  EXPECT_EQ(slot.data, nullptr) << "no buffer any more";
  write = buffer_write(set, 0, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, infos);
  update(write);
  EXPECT_EQ(slot.data, nullptr) << "refused";
}

TEST_F(DescriptorSets, MutableTypesAreThoseThatSlotsHold) {
  const VkDescriptorType good[] = {VK_DESCRIPTOR_TYPE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                         bad[] = {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK};
  for (const auto* types : {&good, &bad}) {
    const VkMutableDescriptorTypeListEXT list{2, *types};
    auto lists = make_struct<VkMutableDescriptorTypeCreateInfoEXT>();
    lists.mutableDescriptorTypeListCount = 1;
    lists.pMutableDescriptorTypeLists = &list;
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, 1, VK_SHADER_STAGE_ALL, nullptr};
    auto info = make_struct<VkDescriptorSetLayoutCreateInfo>(&lists);
    info.bindingCount = 1;
    info.pBindings = &binding;
    auto support = make_struct<VkDescriptorSetLayoutSupport>();
    VK_GET(instance, GetDescriptorSetLayoutSupport)(device, &info, &support);
    EXPECT_EQ(support.supported, types == &good ? VK_TRUE : VK_FALSE);
  }
}

TEST_F(DescriptorSets, DynamicOffsetsStayInsideTheBuffer) {
  constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
  const VkDescriptorSetLayout layout = make_layout({{0, kType, 2, VK_SHADER_STAGE_ALL, {}}});
  VkDescriptorSet set;
  ASSERT_EQ(allocate(make_pool(1, {{kType, 2}}), {layout}, &set), VK_SUCCESS);
  const VkBuffer buffer = to_handle(&fake_buffer(256));
  update(buffer_write(set, 0, 0, kType, {{buffer, 64, 64}, {buffer, 64, VK_WHOLE_SIZE}}));
  const DynamicBuffer* dynamic = from_handle<DescriptorSet>(set).dynamic;
  EXPECT_EQ(apply_offset(dynamic[0], 64).data, storage + 128);
  EXPECT_EQ(apply_offset(dynamic[0], 64).size, 64u);
  EXPECT_EQ(apply_offset(dynamic[0], 160).size, 32u);
  EXPECT_EQ(apply_offset(dynamic[0], 192).size, 0u);
  EXPECT_EQ(apply_offset(dynamic[0], 0xffffffff).data, nullptr);
  EXPECT_EQ(apply_offset(dynamic[1], 64).size, 128u);
}

TEST_F(DescriptorSets, PipelineLayoutsNumberDynamicBuffersInOrder) {
  constexpr VkDescriptorType kDynamic = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
  const VkDescriptorSetLayout first = make_layout(
      {{0, kDynamic, 2, VK_SHADER_STAGE_ALL, {}}, {1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_ALL, {}}});
  const VkDescriptorSetLayout second = make_layout({{4, kDynamic, 1, VK_SHADER_STAGE_ALL, {}}});
  const VkDescriptorSetLayout both[] = {first, second};
  auto info = make_struct<VkPipelineLayoutCreateInfo>();
  info.setLayoutCount = 2;
  info.pSetLayouts = both;
  VkPipelineLayout layout;
  ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
  const auto infos = set_layout_infos(*from_handle<PipelineLayout>(layout).shape);
  ASSERT_EQ(infos.size(), 2u);
  EXPECT_EQ(infos[0].bindings[0].set, spirv::kDynamicSet);
  EXPECT_EQ(infos[0].bindings[0].first_slot, 0u);
  EXPECT_EQ(infos[0].bindings[1].set, 0u);
  EXPECT_EQ(infos[0].bindings[1].first_slot, 0u);
  EXPECT_EQ(infos[1].bindings[0].set, spirv::kDynamicSet);
  EXPECT_EQ(infos[1].bindings[0].first_slot, 2u);
  VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
}

TEST_F(DescriptorSets, ImmutableSamplersOutliveTheLayoutAndIgnoreWrites) {
  auto sampler_info = make_struct<VkSamplerCreateInfo>();
  sampler_info.magFilter = VK_FILTER_LINEAR;
  sampler_info.maxLod = 3;
  VkSampler sampler;
  ASSERT_EQ(VK_GET(instance, CreateSampler)(device, &sampler_info, nullptr, &sampler), VK_SUCCESS);
  constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  const VkDescriptorSetLayout layout = make_layout({{0, kType, 1, VK_SHADER_STAGE_ALL, &sampler}});
  VkDescriptorSet set;
  ASSERT_EQ(allocate(make_pool(1, {{kType, 1}}), {layout}, &set), VK_SUCCESS);
  VK_GET(instance, DestroySampler)(device, sampler, nullptr);
  auto write = make_struct<VkWriteDescriptorSet>();
  const VkDescriptorImageInfo image{};
  write.dstSet = set;
  write.descriptorCount = 1;
  write.descriptorType = kType;
  write.pImageInfo = &image;
  update(write);
  VK_GET(instance, DestroyDescriptorSetLayout)(device, layout, nullptr);
  layouts.clear();
  const texel::Sampler* kept = from_handle<DescriptorSet>(set).slots[0].sampler;
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->mag_filter, VK_FILTER_LINEAR);
  EXPECT_EQ(kept->max_lod, 3.0f);
}

}  // namespace
}  // namespace vitrine::icd::test
