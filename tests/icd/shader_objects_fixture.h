// A device that has VK_EXT_shader_object and of other extensions no more than that asks for, and small scenes that are
// drawn once by pipelines and once by shader objects.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "tests/icd/maintenance5_fixture.h"

#ifdef VK_EXT_shader_object
namespace vitrine::icd::test {

inline constexpr VkExtent2D kCanvas{70, 66};

/// GLSL by stage; stages that are not there are not used.
using Stages = std::map<VkShaderStageFlagBits, std::string>;

/// What is drawn: the first stages, over cleared attachments.
struct Picture2D {
  Stages stages;
  std::vector<VkFormat> colors{VK_FORMAT_R8G8B8A8_UNORM};  ///< VK_FORMAT_UNDEFINED: no attachment there
  bool depth = false;                                      ///< D32, tested and written
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  std::uint32_t vertices = 3;
};

class ShaderObjectDevice : public Maintenance5Device {
 protected:
  using Contents = std::vector<std::vector<std::byte>>;  ///< of each attachment
  using Record = std::function<void(VkCommandBuffer)>;

  void make_device() override;
  void SetUp() override;
  void TearDown() override;

  VkShaderCreateInfoEXT shader_info(VkShaderStageFlagBits stage, const std::vector<std::uint32_t>& words);
  /// Null where it does not compile. Destroyed with the device, unless destroy() was.
  VkShaderEXT make_shader(VkShaderStageFlagBits stage, const std::string& glsl);
  VkShaderEXT make_shader(const VkShaderCreateInfoEXT& info);
  void destroy(VkShaderEXT shader);
  std::map<VkShaderStageFlagBits, VkShaderEXT> make_shaders(const Stages& stages);
  std::vector<std::byte> binary_of(VkShaderEXT shader);

  /// Binds them, and nothing to the other graphics stages.
  void bind(VkCommandBuffer commands, const std::map<VkShaderStageFlagBits, VkShaderEXT>& shaders);
  /// Every state that a draw by shader objects asks for.
  void set_states(VkCommandBuffer commands, const Picture2D& picture);
  VkPipeline make_pipeline(const Picture2D& picture);
  /// Calls `create` with what makes that pipeline: the info, and its stages, which may be altered.
  using Create = std::function<void(VkGraphicsPipelineCreateInfo&, std::span<VkPipelineShaderStageCreateInfo>)>;
  void with_pipeline_info(const Picture2D& picture, const Create& create);
  VkShaderModule make_module(VkShaderStageFlagBits stage, const std::string& glsl);

  /// The attachments after what `record` draws in a rendering instance.
  Contents render(const Picture2D& picture, const Record& record, VkRenderingFlags flags = 0);
  Contents by_pipeline(const Picture2D& picture);
  Contents by_pipeline(const Picture2D& picture, VkPipeline pipeline);
  Contents by_objects(const Picture2D& picture);
  /// Both, compared; something must have been drawn.
  void expect_same(const Picture2D& picture);

  const VkAllocationCallbacks* host = nullptr;        ///< of the device
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;  ///< a storage buffer for all stages
  VkDescriptorPool descriptor_pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;  ///< with it, and 16 bytes of push constants
  Bytes storage;

 private:
  std::vector<VkShaderEXT> shaders_;
  std::vector<VkPipeline> pipelines_;
  std::vector<VkShaderModule> modules_;
};

inline constexpr VkPushConstantRange kPushRange{VK_SHADER_STAGE_ALL, 0, 16};

}  // namespace vitrine::icd::test
#endif
