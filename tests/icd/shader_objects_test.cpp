// VK_EXT_shader_object: making shader objects, and what input no valid application gives.
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "icd/object/device.h"
#include "icd/object/shader_module.h"
#include "tests/icd/shader_objects_fixture.h"

#ifdef VK_EXT_shader_object
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using ShaderObjects = ShaderObjectDevice;
using ShaderBinaries = ShaderObjectDevice;

const std::string kDoubles =
    "layout(local_size_x = 4) in;\n"
    "layout(constant_id = 7) const uint kFactor = 2;\n"
    "layout(constant_id = 9) const float kMore = 0;\n"
    "layout(set = 0, binding = 0) buffer B { uint v[]; };\n"
    "layout(push_constant) uniform P { uint offset; };\n"
    "void main() { v[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x * kFactor + offset + uint(kMore); }\n";

TEST_F(ShaderObjects, AreOffered) {
  auto features = make_struct<VkPhysicalDeviceShaderObjectFeaturesEXT>();
  auto whole = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &whole);
  EXPECT_TRUE(features.shaderObject);
  auto properties = make_struct<VkPhysicalDeviceShaderObjectPropertiesEXT>();
  auto all = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &all);
  EXPECT_EQ(std::memcmp(properties.shaderBinaryUUID, "Vitrine shaders1", VK_UUID_SIZE), 0);
  EXPECT_EQ(properties.shaderBinaryVersion, 1u);
}

/// The extension brings commands of others that are not enabled here.
TEST_F(ShaderObjects, CommandsAreThereByThisExtensionAlone) {
  VkDevice plain;
  ASSERT_EQ(create_device(instance, physical_device, &plain), VK_SUCCESS);
  const auto address = VK_CALL(GetDeviceProcAddr);
  for (const char* name :
       {"vkCreateShadersEXT", "vkDestroyShaderEXT", "vkGetShaderBinaryDataEXT", "vkCmdBindShadersEXT",
        "vkCmdSetVertexInputEXT", "vkCmdSetPatchControlPointsEXT", "vkCmdSetLogicOpEXT",
        "vkCmdSetTessellationDomainOriginEXT", "vkCmdSetDepthClampEnableEXT", "vkCmdSetPolygonModeEXT",
        "vkCmdSetRasterizationSamplesEXT", "vkCmdSetSampleMaskEXT", "vkCmdSetAlphaToCoverageEnableEXT",
        "vkCmdSetAlphaToOneEnableEXT", "vkCmdSetLogicOpEnableEXT", "vkCmdSetColorBlendEnableEXT",
        "vkCmdSetColorBlendEquationEXT", "vkCmdSetColorWriteMaskEXT", "vkCmdSetCullModeEXT", "vkCmdSetFrontFaceEXT",
        "vkCmdSetPrimitiveTopologyEXT", "vkCmdSetViewportWithCountEXT", "vkCmdSetScissorWithCountEXT",
        "vkCmdBindVertexBuffers2EXT", "vkCmdSetDepthTestEnableEXT", "vkCmdSetDepthWriteEnableEXT",
        "vkCmdSetDepthCompareOpEXT", "vkCmdSetDepthBoundsTestEnableEXT", "vkCmdSetStencilTestEnableEXT",
        "vkCmdSetStencilOpEXT", "vkCmdSetRasterizerDiscardEnableEXT", "vkCmdSetDepthBiasEnableEXT",
        "vkCmdSetPrimitiveRestartEnableEXT",
        // Those whose states come with other extensions.
        "vkCmdSetProvokingVertexModeEXT", "vkCmdSetSampleLocationsEnableEXT", "vkCmdSetColorBlendAdvancedEXT",
        "vkCmdSetLineStippleEnableEXT", "vkCmdSetLineRasterizationModeEXT", "vkCmdSetRasterizationStreamEXT",
        "vkCmdSetConservativeRasterizationModeEXT", "vkCmdSetExtraPrimitiveOverestimationSizeEXT",
        "vkCmdSetDepthClipEnableEXT", "vkCmdSetDepthClipNegativeOneToOneEXT", "vkCmdSetViewportWScalingEnableNV",
        "vkCmdSetViewportSwizzleNV", "vkCmdSetCoverageToColorEnableNV", "vkCmdSetCoverageToColorLocationNV",
        "vkCmdSetCoverageModulationModeNV", "vkCmdSetCoverageModulationTableEnableNV",
        "vkCmdSetCoverageModulationTableNV", "vkCmdSetShadingRateImageEnableNV",
        "vkCmdSetRepresentativeFragmentTestEnableNV", "vkCmdSetCoverageReductionModeNV"}) {
    EXPECT_NE(address(device, name), nullptr) << name;
    EXPECT_EQ(address(plain, name), nullptr) << name;
  }
  VK_CALL(DestroyDevice)(plain, nullptr);
}

/// Vulkan 1.4.309, vkCreateShadersEXT: the first null handle tells which of them the result is of.
TEST_F(ShaderObjects, NoneIsMadeFromTheOneThatFailsOn) {
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
  std::vector<std::uint32_t> damaged = words;
  damaged.resize(damaged.size() / 2);
  VkShaderCreateInfoEXT infos[] = {shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words),
                                   shader_info(VK_SHADER_STAGE_COMPUTE_BIT, damaged),
                                   shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words)};
  VkShaderEXT shaders[3];
  std::memset(shaders, 0xee, sizeof shaders);
  EXPECT_EQ(VK_CALL(CreateShadersEXT)(device, 3, infos, nullptr, shaders), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_NE(shaders[0], VkShaderEXT{});
  EXPECT_EQ(shaders[1], VkShaderEXT{});
  EXPECT_EQ(shaders[2], VkShaderEXT{});
  for (const VkShaderEXT shader : shaders) VK_CALL(DestroyShaderEXT)(device, shader, nullptr);
  infos[1].codeType = VK_SHADER_CODE_TYPE_BINARY_EXT;
  EXPECT_EQ(VK_CALL(CreateShadersEXT)(device, 3, infos, nullptr, shaders), VK_INCOMPATIBLE_SHADER_BINARY_EXT);
  EXPECT_NE(shaders[0], VkShaderEXT{});
  EXPECT_EQ(shaders[1], VkShaderEXT{});
  VK_CALL(DestroyShaderEXT)(device, shaders[0], nullptr);
}

TEST_F(ShaderObjects, WordsThatAreNoShaderAreRefused) {
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
  for (std::size_t size = 0; size < words.size(); ++size) {
    const std::vector<std::uint32_t> part(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(size));
    const VkShaderCreateInfoEXT info = shader_info(VK_SHADER_STAGE_COMPUTE_BIT, part);
    VkShaderEXT shader = VK_NULL_HANDLE;
    const VkResult result = VK_CALL(CreateShadersEXT)(device, 1, &info, nullptr, &shader);
    EXPECT_EQ(result == VK_SUCCESS, shader != VkShaderEXT{}) << size;
    VK_CALL(DestroyShaderEXT)(device, shader, nullptr);
  }
  VkShaderCreateInfoEXT info = shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words);
  VkShaderEXT shader;
  for (const VkShaderStageFlagBits stage : {VK_SHADER_STAGE_VERTEX_BIT, VK_SHADER_STAGE_FRAGMENT_BIT,
                                            VK_SHADER_STAGE_MESH_BIT_EXT, VK_SHADER_STAGE_ALL_GRAPHICS}) {
    info.stage = stage;
    EXPECT_EQ(VK_CALL(CreateShadersEXT)(device, 1, &info, nullptr, &shader), VK_ERROR_INITIALIZATION_FAILED);
    EXPECT_EQ(shader, VkShaderEXT{});
  }
  info.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.pName = "nothing";
  EXPECT_EQ(VK_CALL(CreateShadersEXT)(device, 1, &info, nullptr, &shader), VK_ERROR_INITIALIZATION_FAILED);
}

TEST_F(ShaderObjects, RunningOutOfMemoryLeavesNothing) {
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
  const VkShaderCreateInfoEXT info = shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words);
  for (std::size_t n = 0;; ++n) {
    CountingAllocator allocator;
    allocator.fail_after(n);
    VkShaderEXT shader;
    const VkResult result = VK_CALL(CreateShadersEXT)(device, 1, &info, allocator.callbacks(), &shader);
    EXPECT_EQ(result, allocator.failed() ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_SUCCESS);
    EXPECT_EQ(shader == VkShaderEXT{}, result != VK_SUCCESS);
    VK_CALL(DestroyShaderEXT)(device, shader, allocator.callbacks());
    EXPECT_EQ(allocator.live(), 0u);
    if (result == VK_SUCCESS) break;
    ASSERT_LT(n, 100u);
  }
}

TEST_F(ShaderObjects, HaveNames) {
  const VkShaderEXT shader = make_shader(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
  auto info = make_struct<VkDebugUtilsObjectNameInfoEXT>();
  info.objectType = VK_OBJECT_TYPE_SHADER_EXT;
  info.objectHandle = reinterpret_cast<std::uint64_t>(shader);
  info.pObjectName = "doubles";
  EXPECT_EQ(VK_CALL(SetDebugUtilsObjectNameEXT)(device, &info), VK_SUCCESS);
}

// ---- dispatches

class ShaderObjectDispatches : public ShaderObjectDevice {
 protected:
  using Words = std::vector<std::uint32_t>;

  /// What four invocations leave.
  Words dispatch_by(const std::function<void(VkCommandBuffer)>& bind_shader) {
    std::memset(storage.data, 0xff, storage.size);
    run([&](VkCommandBuffer commands) {
      bind_shader(commands);
      const std::uint32_t offset[4] = {100, 0, 0, 0};
      VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, sizeof offset, offset);
      const auto bind_sets = VK_CALL(CmdBindDescriptorSets);
      bind_sets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
      VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    });
    Words out(4);
    std::memcpy(out.data(), storage.data, 16);
    return out;
  }
  Words dispatch_of(VkShaderEXT shader) {
    return dispatch_by([&](VkCommandBuffer commands) { bind_compute(commands, shader); });
  }
  void bind_compute(VkCommandBuffer commands, VkShaderEXT shader) {
    const VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
    VK_CALL(CmdBindShadersEXT)(commands, 1, &stage, shader ? &shader : nullptr);
  }
};

const std::vector<std::uint32_t> kUntouched{~0u, ~0u, ~0u, ~0u};

TEST_F(ShaderObjectDispatches, ComputeWhatTheShaderSays) {
  EXPECT_EQ(dispatch_of(make_shader(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles)), (Words{100, 102, 104, 106}));
}

TEST_F(ShaderObjectDispatches, AreSpecialized) {
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
  VkShaderCreateInfoEXT info = shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words);
  const struct {
    float more = 1000;
    std::uint32_t factor = 5;
  } data;
  const VkSpecializationMapEntry entries[] = {{7, 4, 4}, {9, 0, 4}};
  const VkSpecializationInfo special{2, entries, sizeof data, &data};
  info.pSpecializationInfo = &special;
  const VkShaderEXT shader = make_shader(info);
  EXPECT_EQ(dispatch_of(shader), (Words{1100, 1105, 1110, 1115}));
  // A binary is the specialized shader.
  const auto binary = binary_of(shader);
  info.pSpecializationInfo = nullptr;
  info.codeType = VK_SHADER_CODE_TYPE_BINARY_EXT;
  info.codeSize = binary.size();
  info.pCode = binary.data();
  const VkShaderEXT again = make_shader(info);
  EXPECT_EQ(dispatch_of(again), (Words{1100, 1105, 1110, 1115}));
  EXPECT_EQ(binary_of(again), binary);
}

TEST_F(ShaderObjectDispatches, SubgroupsHaveTheSizeThatIsRequired) {
  const std::string text =
      "#extension GL_KHR_shader_subgroup_basic : require\n"
      "layout(local_size_x = 64) in;\n"
      "layout(set = 0, binding = 0) buffer B { uint v[]; };\n"
      "void main() { if (gl_LocalInvocationID.x < 4) v[gl_LocalInvocationID.x] = gl_SubgroupSize; }\n";
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, text);
  VkShaderCreateInfoEXT info = shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words);
  EXPECT_EQ(dispatch_of(make_shader(info)), (Words{64, 64, 64, 64}));
  auto size = make_struct<VkShaderRequiredSubgroupSizeCreateInfoEXT>();
  size.requiredSubgroupSize = 16;
  info.pNext = &size;
  info.flags = VK_SHADER_CREATE_REQUIRE_FULL_SUBGROUPS_BIT_EXT;
  const VkShaderEXT shader = make_shader(info);
  EXPECT_EQ(dispatch_of(shader), (Words{16, 16, 16, 16}));
  const auto binary = binary_of(shader);
  info = shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words);
  info.flags = VK_SHADER_CREATE_ALLOW_VARYING_SUBGROUP_SIZE_BIT_EXT | VK_SHADER_CREATE_DISPATCH_BASE_BIT_EXT;
  info.codeType = VK_SHADER_CODE_TYPE_BINARY_EXT;
  info.codeSize = binary.size();
  info.pCode = binary.data();
  EXPECT_EQ(dispatch_of(make_shader(info)), (Words{16, 16, 16, 16}));
}

TEST_F(ShaderObjectDispatches, ShadersAndPipelinesReplaceEachOther) {
  const VkShaderEXT shader = make_shader(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT,
                             "layout(local_size_x = 4) in;\n"
                             "layout(set = 0, binding = 0) buffer B { uint v[]; };\n"
                             "void main() { v[gl_LocalInvocationID.x] = 5; }\n");
  VkShaderModuleCreateInfo module = module_info(words);
  auto info = make_struct<VkComputePipelineCreateInfo>();
  info.stage = make_struct<VkPipelineShaderStageCreateInfo>(&module);
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.pName = "main";
  info.layout = layout;
  VkPipeline pipeline;
  ASSERT_EQ(VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
  const auto bind_pipeline = [&](VkCommandBuffer commands) {
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  };
  EXPECT_EQ(dispatch_by([&](VkCommandBuffer c) { bind_compute(c, shader), bind_pipeline(c); }), (Words{5, 5, 5, 5}));
  EXPECT_EQ(dispatch_by([&](VkCommandBuffer c) { bind_pipeline(c), bind_compute(c, shader); }),
            (Words{100, 102, 104, 106}));
  // Nothing is bound any more: nothing runs.
  EXPECT_EQ(dispatch_by([&](VkCommandBuffer c) { bind_pipeline(c), bind_compute(c, VK_NULL_HANDLE); }), kUntouched);
  EXPECT_EQ(dispatch_by([&](VkCommandBuffer c) { bind_compute(c, shader), bind_compute(c, VK_NULL_HANDLE); }),
            kUntouched);
  EXPECT_EQ(dispatch_by([&](VkCommandBuffer) {}), kUntouched);
  VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
}

TEST_F(ShaderObjectDispatches, AShaderOfAnotherStageIsNone) {
  const VkShaderEXT vertex = make_shader(VK_SHADER_STAGE_VERTEX_BIT, "void main() { gl_Position = vec4(0); }\n");
  EXPECT_EQ(dispatch_of(vertex), kUntouched);
}

// ---- what tools tell

/// Tools are chosen for the process: these tests run in one of their own (tests/CMakeLists.txt).
class ShaderObjectFindings : public ShaderObjectDispatches {
 protected:
  void SetUp() override {
    if (!std::getenv("VITRINE_TOOLS")) GTEST_SKIP() << "needs a process of its own";
    ShaderObjectDispatches::SetUp();
    auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) -> VkBool32 {
      auto& test = *static_cast<ShaderObjectFindings*>(self);
      test.heard.push_back(data->pMessage);
      for (std::uint32_t i = 0; i < data->objectCount; ++i)
        if (data->pObjects[i].objectType == VK_OBJECT_TYPE_SHADER_EXT)
          test.named.push_back(data->pObjects[i].pObjectName ? data->pObjects[i].pObjectName : "");
      return VK_FALSE;
    };
    info.pUserData = this;
    ASSERT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  }
  void TearDown() override {
    if (!instance) return;
    VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
    ShaderObjectDispatches::TearDown();
  }
  VkShaderEXT named_shader(VkShaderStageFlagBits stage, const std::string& glsl, const char* name) {
    const VkShaderEXT shader = make_shader(stage, glsl);
    auto info = make_struct<VkDebugUtilsObjectNameInfoEXT>();
    info.objectType = VK_OBJECT_TYPE_SHADER_EXT;
    info.objectHandle = reinterpret_cast<std::uint64_t>(shader);
    info.pObjectName = name;
    EXPECT_EQ(VK_CALL(SetDebugUtilsObjectNameEXT)(device, &info), VK_SUCCESS);
    return shader;
  }

  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  std::vector<std::string> heard, named;
};

TEST_F(ShaderObjectFindings, OfDispatchesNameTheShader) {
  const VkShaderEXT shader = named_shader(VK_SHADER_STAGE_COMPUTE_BIT,
                                          "layout(local_size_x = 4) in;\n"
                                          "layout(set = 0, binding = 0) buffer B { uint v[]; };\n"
                                          "void main() { v[1000 + gl_LocalInvocationID.x] = 1; }\n",
                                          "overrun");
  dispatch_of(shader);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("out-of-bounds"), std::string::npos) << heard[0];
  EXPECT_NE(heard[0].find("pipeline 'overrun'"), std::string::npos) << heard[0];
  EXPECT_EQ(named, std::vector<std::string>{"overrun"});
}

TEST_F(ShaderObjectFindings, OfDrawsNameAllShaders) {
  Picture2D picture;
  const auto vertex = named_shader(VK_SHADER_STAGE_VERTEX_BIT, "void main() { gl_Position = vec4(0); }\n", "corner");
  const auto fragment = named_shader(VK_SHADER_STAGE_FRAGMENT_BIT,
                                     "layout(location = 0) out vec4 o;\nvoid main() { o = vec4(1); }\n", "white");
  render(picture, [&](VkCommandBuffer commands) {
    set_states(commands, picture);
    bind(commands, {{VK_SHADER_STAGE_VERTEX_BIT, vertex}, {VK_SHADER_STAGE_FRAGMENT_BIT, fragment}});
    VK_CALL(CmdDrawIndirect)(commands, storage.buffer, storage.size - 4, 1, 16);
  });
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("out-of-bounds-arguments"), std::string::npos) << heard[0];
  EXPECT_EQ(named, (std::vector<std::string>{"corner", "white"}));
}

// ---- binaries

TEST_F(ShaderBinaries, ComeInTheSizeThatIsTold) {
  const VkShaderEXT shader = make_shader(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
  const auto binary = binary_of(shader);
  std::vector<std::byte> room(binary.size() + 16, std::byte{0x5a});
  std::size_t size = binary.size() - 1;
  EXPECT_EQ(VK_CALL(GetShaderBinaryDataEXT)(device, shader, &size, room.data()), VK_INCOMPLETE);
  EXPECT_EQ(size, 0u);
  EXPECT_TRUE(std::all_of(room.begin(), room.end(), [](std::byte b) { return b == std::byte{0x5a}; }));
  size = room.size();
  EXPECT_EQ(VK_CALL(GetShaderBinaryDataEXT)(device, shader, &size, room.data()), VK_SUCCESS);
  EXPECT_EQ(size, binary.size());
  EXPECT_EQ(room[size], std::byte{0x5a});
}

class HostileBinaries : public ShaderObjectDevice {
 protected:
  static constexpr std::size_t kHash = 5, kHashed = 9;  ///< words of the format (icd/object/stage_binary.cpp)

  void SetUp() override {
    ShaderObjectDevice::SetUp();
    const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, kDoubles);
    VkShaderCreateInfoEXT info = shader_info(VK_SHADER_STAGE_COMPUTE_BIT, words);
    const std::uint32_t factor = 3;
    const VkSpecializationMapEntry entry{7, 0, 4};
    const VkSpecializationInfo special{1, &entry, 4, &factor};
    info.pSpecializationInfo = &special;
    const auto bytes = binary_of(make_shader(info));
    binary.resize(bytes.size() / 4);
    std::memcpy(binary.data(), bytes.data(), bytes.size());
  }
  VkResult create(const void* code, std::size_t bytes, VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT) {
    VkShaderCreateInfoEXT info = shader_info(stage, {});
    info.codeType = VK_SHADER_CODE_TYPE_BINARY_EXT;
    info.codeSize = bytes;
    info.pCode = code;
    VkShaderEXT shader = VK_NULL_HANDLE;
    const VkResult result = VK_CALL(CreateShadersEXT)(device, 1, &info, nullptr, &shader);
    EXPECT_EQ(shader != VkShaderEXT{}, result == VK_SUCCESS);
    VK_CALL(DestroyShaderEXT)(device, shader, nullptr);
    return result;
  }
  /// Its hash is right, whatever else it says.
  VkResult create_hashed(std::vector<std::uint32_t> words) {
    if (words.size() > kHashed) {
      const ShaderKey hash = identifier_of(std::span<const std::uint32_t>(words).subspan(kHashed));
      std::memcpy(words.data() + kHash, hash.data(), sizeof hash);
    }
    return create(words.data(), words.size() * 4);
  }

  std::vector<std::uint32_t> binary;
};

TEST_F(HostileBinaries, AreIncompatibleWhereAnyBitDiffers) {
  EXPECT_EQ(create(binary.data(), binary.size() * 4), VK_SUCCESS);
  for (std::size_t bit = 0; bit < binary.size() * 32; bit += 7) {
    std::vector<std::uint32_t> damaged = binary;
    damaged[bit / 32] ^= 1u << bit % 32;
    EXPECT_EQ(create(damaged.data(), damaged.size() * 4), VK_INCOMPATIBLE_SHADER_BINARY_EXT) << bit;
  }
}

TEST_F(HostileBinaries, AreIncompatibleInAnyOtherSizeOrStage) {
  for (std::size_t bytes = 0; bytes < binary.size() * 4; ++bytes)
    EXPECT_EQ(create(binary.data(), bytes), VK_INCOMPATIBLE_SHADER_BINARY_EXT) << bytes;
  std::vector<std::uint32_t> longer = binary;
  longer.push_back(0);
  EXPECT_EQ(create_hashed(longer), VK_INCOMPATIBLE_SHADER_BINARY_EXT);
  EXPECT_EQ(create(nullptr, 0), VK_INCOMPATIBLE_SHADER_BINARY_EXT);
  EXPECT_EQ(create(binary.data(), binary.size() * 4, VK_SHADER_STAGE_VERTEX_BIT), VK_INCOMPATIBLE_SHADER_BINARY_EXT);
}

TEST_F(HostileBinaries, AreIncompatibleWhereTheyAskForSubgroupsThatCannotBe) {
  for (const std::uint32_t size : {0u, 1u, 4u, 8u, 12u, 64u, 128u, ~0u}) {
    std::vector<std::uint32_t> altered = binary;
    altered[kHashed + 1] = size;
    const bool can_be = size == 0 || size == 8 || size == 64;
    EXPECT_EQ(create_hashed(altered), can_be ? VK_SUCCESS : VK_INCOMPATIBLE_SHADER_BINARY_EXT) << size;
  }
}

TEST_F(HostileBinaries, WithTheRightHashDoNoHarm) {
  EXPECT_EQ(create_hashed(binary), VK_SUCCESS);
  std::uint32_t state = 1;
  const auto random = [&] { return state = state * 1664525 + 1013904223; };
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint32_t> damaged = binary;
    for (std::uint32_t n = random() >> 30; n < 4; ++n) {
      const std::size_t at = random() >> 8;
      // Sizes, which come first, as often as all the rest.
      std::uint32_t& word = i % 2 ? damaged[kHashed + at % 6] : damaged[kHashed + at % (damaged.size() - kHashed)];
      word = random() >> 31 ? word ^ 1u << random() % 32 : random() >> random() % 32;
    }
    if (i % 5 == 0) damaged.resize(random() % damaged.size());
    const VkResult result = create_hashed(damaged);
    EXPECT_TRUE(result == VK_SUCCESS || result == VK_INCOMPATIBLE_SHADER_BINARY_EXT) << result;
  }
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
