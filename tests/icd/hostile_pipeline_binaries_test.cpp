// VK_KHR_pipeline_binary: data that are not what the driver gave out.
#include <algorithm>
#include <cstring>

#include "icd/object/shader_module.h"
#include "tests/icd/pipeline_binaries_fixture.h"

#ifdef VK_KHR_pipeline_binary
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using Words = std::vector<std::uint32_t>;

class HostilePipelineBinaries : public PipelineBinaryDevice {
 protected:
  static constexpr std::size_t kVersion = 2, kHash = 5, kHashed = 9;  ///< words (icd/object/stage_binary.cpp)

  void SetUp() override {
    PipelineBinaryDevice::SetUp();
    info = compute_info(make_module(VK_SHADER_STAGE_COMPUTE_BIT, kMultiplies));
    const std::uint32_t factor = 3;
    const VkSpecializationMapEntry entry{7, 0, 4};
    const VkSpecializationInfo special{1, &entry, 4, &factor};
    VkComputePipelineCreateInfo specialized = info;
    specialized.stage.pSpecializationInfo = &special;
    blob = blobs_of(create(specialized, {kCapture}))[0];
    words.resize(blob.data.size() / 4);
    std::memcpy(words.data(), blob.data.data(), blob.data.size());
  }
  VkResult refusal(const Blob& altered) {
    Binaries binaries;
    heard.clear();
    const VkResult result = read({altered}, binaries);
    EXPECT_EQ(binaries[0] == VkPipelineBinaryKHR{}, result != VK_SUCCESS);
    EXPECT_EQ(heard.size(), result == VK_SUCCESS ? 0u : 1u);
    if (result == VK_SUCCESS) {
      // It may still be no shader.
      VkPipeline pipeline = VK_NULL_HANDLE;
      auto given = make_struct<VkPipelineBinaryInfoKHR>();
      given.binaryCount = 1;
      given.pPipelineBinaries = binaries.data();
      VkComputePipelineCreateInfo from = info;
      from.pNext = &given;
      const VkResult made = VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &from, nullptr, &pipeline);
      EXPECT_TRUE(made == VK_SUCCESS || made == VK_ERROR_UNKNOWN) << made;
      VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
    }
    return result;
  }
  /// `bytes` are no more than the words have.
  static Blob blob_with(const Blob& original, const Words& words, std::size_t bytes) {
    Blob out = original;
    const auto* given = reinterpret_cast<const std::byte*>(words.data());
    out.data.assign(given, given + bytes);
    return out;
  }
  /// Hash and key are right, whatever else it says.
  Blob forged(Words altered) const {
    if (altered.size() > kHashed) {
      const ShaderKey hash = identifier_of(std::span<const std::uint32_t>(altered).subspan(kHashed));
      std::memcpy(altered.data() + kHash, hash.data(), sizeof hash);
    }
    Blob out = blob_with(blob, altered, altered.size() * 4);
    const ShaderKey key = identifier_of(std::span<const std::uint32_t>(altered));
    std::memcpy(out.key.key, key.data(), sizeof key);
    return out;
  }

  VkComputePipelineCreateInfo info{};
  Blob blob;
  Words words;
};

TEST_F(HostilePipelineBinaries, AreRefusedWhereAnyBitDiffers) {
  EXPECT_EQ(refusal(blob), VK_SUCCESS);
  for (std::size_t bit = 0; bit < blob.data.size() * 8; bit += 7) {
    Blob damaged = blob;
    damaged.data[bit / 8] ^= std::byte(1 << bit % 8);
    EXPECT_EQ(refusal(damaged), VK_ERROR_INITIALIZATION_FAILED) << bit;
  }
  for (std::size_t bit = 0; bit < 128; ++bit) {
    Blob renamed = blob;
    renamed.key.key[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    EXPECT_EQ(refusal(renamed), VK_ERROR_INITIALIZATION_FAILED) << bit;
  }
}

TEST_F(HostilePipelineBinaries, AreRefusedInAnyOtherSize) {
  for (std::size_t bytes = 0; bytes < blob.data.size(); ++bytes)
    EXPECT_EQ(refusal(blob_with(blob, words, bytes)), VK_ERROR_INITIALIZATION_FAILED) << bytes;
  Words longer = words;
  longer.push_back(0);
  EXPECT_EQ(refusal(forged(longer)), VK_ERROR_INITIALIZATION_FAILED);
  for (const std::uint32_t size : {0u, 8u, 17u, 32u, ~0u}) {
    Blob named = blob;
    named.key.keySize = size;
    EXPECT_EQ(refusal(named), VK_ERROR_INITIALIZATION_FAILED) << size;
  }
}

/// The header has the UUID of pipeline caches, which has the driver's version.
TEST_F(HostilePipelineBinaries, AreRefusedFromAnotherVersionOfTheDriver) {
  VkPhysicalDeviceProperties properties;
  VK_CALL(GetPhysicalDeviceProperties)(physical_device, &properties);
  EXPECT_EQ(std::memcmp(words.data(), properties.pipelineCacheUUID, VK_UUID_SIZE), 0);
  EXPECT_EQ(words[kVersion], properties.driverVersion);
  Words newer = words;
  ++newer[kVersion];
  EXPECT_EQ(refusal(forged(newer)), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_NE(heard[0].find("another version"), std::string::npos) << heard[0];
}

TEST_F(HostilePipelineBinaries, AreRefusedWhereTheyAskForWhatCannotBe) {
  EXPECT_EQ(refusal(forged(words)), VK_SUCCESS);
  for (const std::uint32_t stage : {0u, 3u, 0x40u, 0x80u, 0x100u, 0x7fffffffu, ~0u}) {
    Words altered = words;
    altered[kHashed] = stage;
    EXPECT_EQ(refusal(forged(altered)), VK_ERROR_INITIALIZATION_FAILED) << stage;
  }
  for (const std::uint32_t size : {1u, 4u, 12u, 128u, ~0u}) {
    Words altered = words;
    altered[kHashed + 1] = size;
    EXPECT_EQ(refusal(forged(altered)), VK_ERROR_INITIALIZATION_FAILED) << size;
  }
}

/// Each entry gets an error of its own, and the result is the first one's.
TEST_F(HostilePipelineBinaries, AreRefusedAloneAmongOthers) {
  Blob damaged = blob;
  damaged.data.back() ^= std::byte{1};
  Binaries binaries;
  EXPECT_EQ(read({blob, damaged, blob}, binaries), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_NE(binaries[0], VkPipelineBinaryKHR{});
  EXPECT_EQ(binaries[1], VkPipelineBinaryKHR{});
  EXPECT_NE(binaries[2], VkPipelineBinaryKHR{});
}

TEST_F(HostilePipelineBinaries, WithTheRightHashDoNoHarm) {
  std::uint32_t state = 1;
  int refused = 0;
  const auto random = [&] { return state = state * 1664525 + 1013904223; };
  for (int i = 0; i < 3000; ++i) {
    Words damaged = words;
    for (std::uint32_t n = random() >> 30; n < 4; ++n) {
      const std::size_t at = random() >> 8;
      // Sizes, which come first, as often as all the rest.
      std::uint32_t& word = i % 2 ? damaged[kHashed + at % 6] : damaged[kHashed + at % (damaged.size() - kHashed)];
      word = random() >> 31 ? word ^ 1u << random() % 32 : random() >> random() % 32;
    }
    if (i % 5 == 0) damaged.resize(random() % damaged.size());
    const VkResult result = refusal(forged(damaged));
    refused += result != VK_SUCCESS;
    EXPECT_TRUE(result == VK_SUCCESS || result == VK_ERROR_INITIALIZATION_FAILED) << result;
  }
  EXPECT_GT(refused, 500);
  EXPECT_LT(refused, 2500);
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
