// A device with VK_KHR_pipeline_binary and what it meets: libraries, identifiers of modules, feedback.
#pragma once

#include "tests/icd/shader_objects_fixture.h"

#ifdef VK_KHR_pipeline_binary
namespace vitrine::icd::test {

/// What an application keeps of a binary.
struct Blob {
  VkPipelineBinaryKeyKHR key = make_struct<VkPipelineBinaryKeyKHR>();
  std::vector<std::byte> data;

  std::string key_bytes() const { return {reinterpret_cast<const char*>(key.key), key.keySize}; }
  bool operator==(const Blob& other) const { return key_bytes() == other.key_bytes() && data == other.data; }
};
using Blobs = std::vector<Blob>;
using Binaries = std::vector<VkPipelineBinaryKHR>;

/// What create infos say in their chains.
struct PipelineChain {
  VkPipelineCreateFlags2KHR flags = 0;
  Binaries binaries{};
};
inline constexpr VkPipelineCreateFlags2KHR kCapture = VK_PIPELINE_CREATE_2_CAPTURE_DATA_BIT_KHR;
inline constexpr VkPipelineCreateFlags2KHR kNoCompiling =
    VK_PIPELINE_CREATE_2_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT_KHR;

class PipelineBinaryDevice : public ShaderObjectDevice {
 protected:
  void make_device() override;
  void SetUp() override;
  void TearDown() override;

  /// A pipeline that lives as long as the device. Null where `expected` is no success.
  VkPipeline create(const VkGraphicsPipelineCreateInfo& info, const PipelineChain& chain = {},
                    VkResult expected = VK_SUCCESS);
  VkPipeline create(const VkComputePipelineCreateInfo& info, const PipelineChain& chain = {},
                    VkResult expected = VK_SUCCESS);
  VkComputePipelineCreateInfo compute_info(VkShaderModule module) const;

  /// Those of a pipeline; they live as long as the device.
  Binaries binaries_of(VkPipeline pipeline);
  Blob blob_of(VkPipelineBinaryKHR binary);
  Blobs blobs_of(VkPipeline pipeline);
  /// What is made from what an application has kept.
  VkResult read(const Blobs& blobs, Binaries& out);
  Binaries read(const Blobs& blobs);
  /// Of what is made so; of all pipelines without one.
  std::string key_of(const void* create_info);

  /// The first four words of `storage` after a dispatch with 100 pushed.
  std::vector<std::uint32_t> dispatched(VkPipeline pipeline);

  std::vector<std::string> heard;  ///< errors that a messenger was told

 private:
  template <class Info, class F>
  VkPipeline create_with(F create, const Info& info, const PipelineChain& chain, VkResult expected);

  std::vector<VkPipeline> made_;
  Binaries binaries_;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// Specialized by constants 7 and 9.
inline const std::string kMultiplies =
    "layout(local_size_x = 4) in;\n"
    "layout(constant_id = 7) const uint kFactor = 2;\n"
    "layout(constant_id = 9) const float kMore = 0;\n"
    "layout(set = 0, binding = 0) buffer B { uint v[]; };\n"
    "layout(push_constant) uniform P { uint offset; };\n"
    "void main() { v[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x * kFactor + offset + uint(kMore); }\n";

}  // namespace vitrine::icd::test
#endif
