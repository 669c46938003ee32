// VK_KHR_pipeline_binary: keys, and binaries from pipelines and from what an application has kept of them.
#include <algorithm>
#include <cstring>
#include <set>

#include "tests/icd/pipeline_binaries_fixture.h"

#ifdef VK_KHR_pipeline_binary
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using Words = std::vector<std::uint32_t>;

class PipelineBinaries : public PipelineBinaryDevice {
 protected:
  void SetUp() override {
    PipelineBinaryDevice::SetUp();
    info = compute_info(make_module(VK_SHADER_STAGE_COMPUTE_BIT, kMultiplies));
  }
  /// The module's name in its place, in `naming`.
  void name_module(VkPipelineShaderStageCreateInfo& stage) {
    VK_CALL(GetShaderModuleIdentifierEXT)(device, stage.module, &identifier);
    naming.identifierSize = identifier.identifierSize;
    naming.pIdentifier = identifier.identifier;
    stage.module = VK_NULL_HANDLE;
    stage.pNext = &naming;
  }

  VkComputePipelineCreateInfo info{};
  VkShaderModuleIdentifierEXT identifier = make_struct<VkShaderModuleIdentifierEXT>();
  VkPipelineShaderStageModuleIdentifierCreateInfoEXT naming =
      make_struct<VkPipelineShaderStageModuleIdentifierCreateInfoEXT>();
};

const Picture2D kTriangle{
    {{VK_SHADER_STAGE_VERTEX_BIT, "void main() { gl_Position = vec4(gl_VertexIndex - 1, 0, 0, 1); }\n"},
     {VK_SHADER_STAGE_FRAGMENT_BIT, "layout(location = 0) out vec4 o; void main() { o = vec4(1); }\n"}}};

TEST_F(PipelineBinaries, AreOfferedWithoutACacheOfTheDriver) {
  auto features = make_struct<VkPhysicalDevicePipelineBinaryFeaturesKHR>();
  auto whole = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &whole);
  EXPECT_TRUE(features.pipelineBinaries);
  auto properties = make_struct<VkPhysicalDevicePipelineBinaryPropertiesKHR>();
  properties.pipelineBinaryInternalCache = properties.pipelineBinaryInternalCacheControl = VK_TRUE;
  properties.pipelineBinaryPrefersInternalCache = properties.pipelineBinaryPrecompiledInternalCache = VK_TRUE;
  properties.pipelineBinaryCompressedData = VK_TRUE;
  auto all = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &all);
  EXPECT_FALSE(properties.pipelineBinaryInternalCache);
  EXPECT_FALSE(properties.pipelineBinaryInternalCacheControl);
  EXPECT_FALSE(properties.pipelineBinaryPrefersInternalCache);
  EXPECT_FALSE(properties.pipelineBinaryPrecompiledInternalCache);
  EXPECT_FALSE(properties.pipelineBinaryCompressedData);
  // Whoever asks for what is in that cache is told that it is not there.
  auto create_info = make_struct<VkPipelineCreateInfoKHR>(&info);
  auto from = make_struct<VkPipelineBinaryCreateInfoKHR>();
  from.pPipelineCreateInfo = &create_info;
  auto handles = make_struct<VkPipelineBinaryHandlesInfoKHR>();
  EXPECT_EQ(VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles), VK_PIPELINE_BINARY_MISSING_KHR);
  EXPECT_EQ(handles.pipelineBinaryCount, 0u);
  VkPipelineBinaryKHR binary;
  std::memset(&binary, 0xee, sizeof binary);
  handles.pipelineBinaryCount = 1;
  handles.pPipelineBinaries = &binary;
  EXPECT_EQ(VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles), VK_PIPELINE_BINARY_MISSING_KHR);
  EXPECT_EQ(handles.pipelineBinaryCount, 0u);
  EXPECT_EQ(binary, VkPipelineBinaryKHR{});
}

// ---- keys

TEST_F(PipelineBinaries, KeysDifferWithWhatIsMade) {
  std::set<std::string> keys{key_of(nullptr), key_of(&info)};
  EXPECT_EQ(keys.size(), 2u);
  const auto expect_another = [&](const void* create_info) { EXPECT_TRUE(keys.insert(key_of(create_info)).second); };
  const VkComputePipelineCreateInfo other = compute_info(make_module(VK_SHADER_STAGE_COMPUTE_BIT, "void main() {}\n"));
  expect_another(&other);
  VkComputePipelineCreateInfo altered = info;
  altered.stage.pName = "Main";
  expect_another(&altered);
  altered = info;
  auto size = make_struct<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>();
  altered.stage.pNext = &size;
  for (const std::uint32_t invocations : {8u, 64u}) {
    size.requiredSubgroupSize = invocations;
    expect_another(&altered);
  }
  altered = info;
  std::uint32_t factor = 2;
  VkSpecializationMapEntry entry{7, 0, 4};
  const VkSpecializationInfo special{1, &entry, sizeof factor, &factor};
  altered.stage.pSpecializationInfo = &special;
  expect_another(&altered);
  factor = 3;
  expect_another(&altered);
  entry.constantID = 9;
  expect_another(&altered);
  with_pipeline_info(kTriangle,
                     [&](VkGraphicsPipelineCreateInfo& graphics, std::span<VkPipelineShaderStageCreateInfo> stages) {
                       expect_another(&graphics);
                       std::swap(stages[0], stages[1]);
                       expect_another(&graphics);
                       std::swap(stages[0], stages[1]);
                       graphics.stageCount = 1;
                       expect_another(&graphics);
                     });
}

TEST_F(PipelineBinaries, KeysAreTheSameWhateverElseDiffers) {
  const std::string global = key_of(nullptr), key = key_of(&info);
  VkComputePipelineCreateInfo again = compute_info(make_module(VK_SHADER_STAGE_COMPUTE_BIT, kMultiplies));
  EXPECT_NE(again.stage.module, info.stage.module);
  EXPECT_EQ(key_of(&again), key);
  again.flags = VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
  EXPECT_EQ(key_of(&again), key);
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, kMultiplies);
  const VkShaderModuleCreateInfo inlined = module_info(words);
  again.stage.module = VK_NULL_HANDLE;
  again.stage.pNext = &inlined;
  EXPECT_EQ(key_of(&again), key);
  again = info;
  name_module(again.stage);
  EXPECT_EQ(key_of(&again), key);
  // What lies between specialized values.
  const VkSpecializationMapEntry entries[] = {{7, 0, 4}, {9, 8, 4}};
  std::string with_gaps;
  for (const std::uint32_t gap : {0u, 1u}) {
    const std::uint32_t data[4] = {5, gap, 0, gap};
    const VkSpecializationInfo special{2, entries, sizeof data, data};
    again = info;
    again.stage.pSpecializationInfo = &special;
    EXPECT_EQ(gap ? with_gaps : key_of(&again), key_of(&again));
    with_gaps = key_of(&again);
  }
  // Another device of another instance.
  VkInstance other_instance;
  VkDevice other_device;
  std::uint32_t count = 1;
  VkPhysicalDevice other_physical;
  ASSERT_EQ(create_instance(&other_instance), VK_SUCCESS);
  VK_GET(other_instance, EnumeratePhysicalDevices)(other_instance, &count, &other_physical);
  ASSERT_EQ(create_device(other_instance, other_physical, &other_device), VK_SUCCESS);
  std::swap(device, other_device);
  EXPECT_EQ(key_of(nullptr), global);
  again = info;
  again.stage.module = VK_NULL_HANDLE;
  again.stage.pNext = &inlined;
  EXPECT_EQ(key_of(&again), key);
  std::swap(device, other_device);
  VK_GET(other_instance, DestroyDevice)(other_device, nullptr);
  VK_GET(other_instance, DestroyInstance)(other_instance, nullptr);
}

// ---- from pipelines

TEST_F(PipelineBinaries, AreAsManyAsThePipelineHasStages) {
  with_pipeline_info(kTriangle, [&](const VkGraphicsPipelineCreateInfo& graphics, auto) {
    auto from = make_struct<VkPipelineBinaryCreateInfoKHR>();
    from.pipeline = create(graphics, {kCapture});
    auto handles = make_struct<VkPipelineBinaryHandlesInfoKHR>();
    EXPECT_EQ(VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles), VK_SUCCESS);
    EXPECT_EQ(handles.pipelineBinaryCount, 2u);
    VkPipelineBinaryKHR binaries[3];
    for (const std::uint32_t room : {0u, 1u, 2u, 3u}) {
      std::memset(binaries, 0xee, sizeof binaries);
      const VkPipelineBinaryKHR untouched = binaries[2];
      handles.pipelineBinaryCount = room;
      handles.pPipelineBinaries = binaries;
      EXPECT_EQ(VK_CALL(CreatePipelineBinariesKHR)(device, &from, nullptr, &handles),
                room < 2 ? VK_INCOMPLETE : VK_SUCCESS);
      EXPECT_EQ(handles.pipelineBinaryCount, std::min(room, 2u));
      for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(binaries[i] == untouched, i >= handles.pipelineBinaryCount);
        if (binaries[i] != untouched) VK_CALL(DestroyPipelineBinaryKHR)(device, binaries[i], nullptr);
      }
    }
  });
  VK_CALL(DestroyPipelineBinaryKHR)(device, VK_NULL_HANDLE, nullptr);
}

TEST_F(PipelineBinaries, HaveTheSameContentsForTheSameStage) {
  const Blobs first = blobs_of(create(info, {kCapture})), second = blobs_of(create(info, {kCapture}));
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first, second);
  // Also where an equal shader is alive that something else asked for in another way.
  auto size = make_struct<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>();
  size.requiredSubgroupSize = 64;
  VkComputePipelineCreateInfo sized = info;
  sized.stage.pNext = &size;
  const Blobs other = blobs_of(create(sized, {kCapture}));
  EXPECT_NE(other, first);
  EXPECT_EQ(blobs_of(create(info, {kCapture})), first);
  EXPECT_NE(other[0].key_bytes(), first[0].key_bytes());
}

TEST_F(PipelineBinaries, OfModulesThatAreNamedAreThoseOfTheModules) {
  const VkPipeline pipeline = create(info, {kCapture});
  VkComputePipelineCreateInfo named = info;
  name_module(named.stage);
  EXPECT_EQ(blobs_of(create(named, {kCapture | kNoCompiling})), blobs_of(pipeline));
  // A module that nothing has been made of.
  named = compute_info(make_module(VK_SHADER_STAGE_COMPUTE_BIT, "void main() {}\n"));
  name_module(named.stage);
  create(named, {kCapture | kNoCompiling}, VK_PIPELINE_COMPILE_REQUIRED);
}

/// Their shaders are compiled when they are linked: nothing is there before that could stand for the module.
TEST_F(PipelineBinaries, LibrariesOfModulesThatAreNamedAloneHaveToBeCompiled) {
  with_pipeline_info(
      kTriangle, [&](VkGraphicsPipelineCreateInfo& graphics, std::span<VkPipelineShaderStageCreateInfo> stages) {
        create(graphics);
        auto part = make_struct<VkGraphicsPipelineLibraryCreateInfoEXT>(const_cast<void*>(graphics.pNext));
        part.flags = VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT;
        graphics.pNext = &part;
        name_module(stages[1]);
        create(graphics, {kNoCompiling | VK_PIPELINE_CREATE_2_LIBRARY_BIT_KHR}, VK_PIPELINE_COMPILE_REQUIRED);
      });
}

TEST_F(PipelineBinaries, AreThereUntilTheyAreReleased) {
  const VkPipeline pipeline = create(info, {kCapture});
  const Binaries binaries = binaries_of(pipeline);
  const Blob blob = blob_of(binaries[0]);
  auto release = make_struct<VkReleaseCapturedPipelineDataInfoKHR>();
  release.pipeline = pipeline;
  EXPECT_EQ(VK_CALL(ReleaseCapturedPipelineDataKHR)(device, &release, nullptr), VK_SUCCESS);
  EXPECT_TRUE(binaries_of(pipeline).empty());
  EXPECT_EQ(blob_of(binaries[0]), blob);
  EXPECT_EQ(dispatched(pipeline), (Words{100, 102, 104, 106}));
  EXPECT_TRUE(binaries_of(create(info)).empty()) << "nothing was to be kept of it";
}

// ---- their data

TEST_F(PipelineBinaries, DataComeInTheSizeThatIsTold) {
  const VkPipelineBinaryKHR binary = binaries_of(create(info, {kCapture}))[0];
  const Blob blob = blob_of(binary);
  auto of = make_struct<VkPipelineBinaryDataInfoKHR>();
  of.pipelineBinary = binary;
  std::vector<std::byte> room(blob.data.size() + 16, std::byte{0x5a});
  for (const std::size_t too_little : {std::size_t{0}, blob.data.size() - 1}) {
    std::size_t size = too_little;
    auto key = make_struct<VkPipelineBinaryKeyKHR>();
    EXPECT_EQ(VK_CALL(GetPipelineBinaryDataKHR)(device, &of, &key, &size, room.data()), VK_ERROR_NOT_ENOUGH_SPACE_KHR);
    EXPECT_EQ(size, blob.data.size());
    EXPECT_EQ(key.keySize, 0u);
    EXPECT_TRUE(std::all_of(room.begin(), room.end(), [](std::byte b) { return b == std::byte{0x5a}; }));
  }
  std::size_t size = room.size();
  auto key = make_struct<VkPipelineBinaryKeyKHR>();
  EXPECT_EQ(VK_CALL(GetPipelineBinaryDataKHR)(device, &of, &key, &size, room.data()), VK_SUCCESS);
  EXPECT_EQ(size, blob.data.size());
  EXPECT_EQ(room[size], std::byte{0x5a});
  EXPECT_TRUE(std::equal(blob.data.begin(), blob.data.end(), room.begin()));
}

/// What makes the stage comes with the binary: neither a module is needed nor anything of what specialized it.
TEST_F(PipelineBinaries, ReadAgainMakeTheSamePipeline) {
  const struct {
    float more = 1000;
    std::uint32_t factor = 5;
  } data;
  const VkSpecializationMapEntry entries[] = {{7, 4, 4}, {9, 0, 4}};
  const VkSpecializationInfo special{2, entries, sizeof data, &data};
  info.stage.pSpecializationInfo = &special;
  const Blobs blobs = blobs_of(create(info, {kCapture}));
  info.stage.module = VK_NULL_HANDLE;
  const Binaries again = read(blobs);
  EXPECT_EQ(blob_of(again[0]), blobs[0]);
  VkPipelineCreationFeedback whole{}, stage{};
  auto feedback = make_struct<VkPipelineCreationFeedbackCreateInfo>();
  feedback.pPipelineCreationFeedback = &whole;
  feedback.pipelineStageCreationFeedbackCount = 1;
  feedback.pPipelineStageCreationFeedbacks = &stage;
  info.pNext = &feedback;
  const VkPipeline pipeline = create(info, {kCapture, again});
  EXPECT_EQ(whole.flags, VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT);
  EXPECT_EQ(stage.flags, VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT);
  EXPECT_EQ(dispatched(pipeline), (Words{1100, 1105, 1110, 1115}));
  EXPECT_EQ(blobs_of(pipeline), blobs);
  EXPECT_TRUE(heard.empty());
}

/// Even of a shader that nothing else has, and whatever module is named beside them.
TEST_F(PipelineBinaries, StandForTheModuleAndNeedNoCompiling) {
  const Blobs blobs = blobs_of(create(info, {kCapture}));
  const Binaries read_again = read(blobs);
  TearDown();
  SetUp();
  VkComputePipelineCreateInfo other = compute_info(make_module(VK_SHADER_STAGE_COMPUTE_BIT, "void main() {}\n"));
  EXPECT_EQ(dispatched(create(other, {kNoCompiling, read(blobs)})), (Words{100, 102, 104, 106}));
}

TEST_F(PipelineBinaries, HaveToSuitThePipeline) {
  const Blob compute = blobs_of(create(info, {kCapture}))[0];
  with_pipeline_info(kTriangle, [&](const VkGraphicsPipelineCreateInfo& graphics, auto) {
    const Blobs both = blobs_of(create(graphics, {kCapture}));
    const Blobs wrong[] = {{both[0]}, {both[0], both[1], both[1]}, {both[1], both[0]}, {compute, both[1]}};
    for (const Blobs& blobs : wrong) {
      heard.clear();
      create(graphics, {0, read(blobs)}, VK_ERROR_UNKNOWN);
      EXPECT_EQ(heard.size(), 1u);
    }
    create(graphics, {0, {read(both)[0], VK_NULL_HANDLE}}, VK_ERROR_UNKNOWN);
    create(info, {0, read({both[0]})}, VK_ERROR_UNKNOWN);
    create(info, {0, read({compute, compute})}, VK_ERROR_UNKNOWN);
    EXPECT_NE(heard.back().find("2 stages"), std::string::npos) << heard.back();
    create(graphics, {0, read(both)});
  });
}

TEST_F(PipelineBinaries, RunningOutOfMemoryLeavesNothing) {
  const VkPipeline pipeline = create(info, {kCapture});
  const Blob blob = blobs_of(pipeline)[0];
  const VkPipelineBinaryDataKHR data{blob.data.size(), const_cast<std::byte*>(blob.data.data())};
  const VkPipelineBinaryKeysAndDataKHR given{1, &blob.key, &data};
  for (const bool from_data : {false, true}) {
    auto from = make_struct<VkPipelineBinaryCreateInfoKHR>();
    if (from_data)
      from.pKeysAndDataInfo = &given;
    else
      from.pipeline = pipeline;
    for (std::size_t n = 0;; ++n) {
      CountingAllocator allocator;
      allocator.fail_after(n);
      VkPipelineBinaryKHR binary;
      auto handles = make_struct<VkPipelineBinaryHandlesInfoKHR>();
      handles.pipelineBinaryCount = 1;
      handles.pPipelineBinaries = &binary;
      const VkResult result = VK_CALL(CreatePipelineBinariesKHR)(device, &from, allocator.callbacks(), &handles);
      EXPECT_EQ(result, allocator.failed() ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_SUCCESS);
      EXPECT_EQ(binary == VkPipelineBinaryKHR{}, result != VK_SUCCESS);
      VK_CALL(DestroyPipelineBinaryKHR)(device, binary, allocator.callbacks());
      EXPECT_EQ(allocator.live(), 0u);
      if (result == VK_SUCCESS) break;
      ASSERT_LT(n, 100u);
    }
  }
}

TEST_F(PipelineBinaries, HaveNames) {
  auto name = make_struct<VkDebugUtilsObjectNameInfoEXT>();
  name.objectType = VK_OBJECT_TYPE_PIPELINE_BINARY_KHR;
  name.objectHandle = reinterpret_cast<std::uint64_t>(binaries_of(create(info, {kCapture}))[0]);
  name.pObjectName = "multiplies";
  EXPECT_EQ(VK_CALL(SetDebugUtilsObjectNameEXT)(device, &name), VK_SUCCESS);
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
