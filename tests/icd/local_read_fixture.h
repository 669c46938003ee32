// Scenes of steps that read what earlier ones drew, each drawn as a render pass with a subpass a step and as one
// dynamic rendering instance (VK_KHR_dynamic_rendering_local_read), with the bytes that either leaves.
#pragma once

#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "tests/icd/maintenance5_fixture.h"

#ifdef VK_KHR_dynamic_rendering_local_read
namespace vitrine::icd::test {

inline constexpr VkExtent2D kSceneSize{70, 66};
inline constexpr std::uint32_t kUnused = VK_ATTACHMENT_UNUSED, kMaxInputs = 4;

/// A subpass of the render pass: attachments are numbered through the colours, then depth, then stencil.
struct Step {
  std::string fragment;
  std::vector<std::uint32_t> colors;  ///< attachments by location
  std::vector<std::uint32_t> inputs;  ///< attachments by input index
  std::uint32_t draws = 1;            ///< with a barrier between any two
  std::uint32_t cleared = kUnused;    ///< a colour attachment, in part, before the draws
  bool blends = false;                ///< each colour otherwise
  bool covers_by_alpha = false;
  bool ordered = false;  ///< each draw reads what its earlier primitives wrote
};

struct Scene {
  std::vector<VkFormat> colors;
  std::vector<Step> steps;
  VkFormat depth = VK_FORMAT_UNDEFINED;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  std::uint32_t layers = 1, view_mask = 0;
  bool writes_masks = false;  ///< masks of writing are dynamic state
  // of dynamic rendering alone
  bool unnamed_depth = false;  ///< depth is the input attachment without an index
  bool as_libraries = false, in_secondaries = false;
  bool draws_inline_too = false;  ///< every other step is in no secondary command buffer
  bool lacks_barriers = false;
  VkImageLayout layout = VK_IMAGE_LAYOUT_RENDERING_LOCAL_READ_KHR;

  std::uint32_t depth_number() const { return static_cast<std::uint32_t>(colors.size()); }
};

/// Where a value is; kUnused: nowhere.
std::uint32_t index_of(const std::vector<std::uint32_t>& all, std::uint32_t value);

class LocalReadDevice : public Maintenance5Device {
 protected:
  struct Target {
    Picture picture;
    VkFormat format;
    std::vector<VkImageView> inputs;  ///< of each aspect
  };
  using Contents = std::vector<std::byte>;

  void make_device() override;
  void SetUp() override;
  void TearDown() override;

  /// The bytes of all attachments; the scene's render pass has its steps as subpasses.
  std::vector<Contents> as_subpasses(const Scene& scene);
  std::vector<Contents> as_rendering(const Scene& scene);
  /// Both, compared; something must have been drawn.
  void expect_same(const Scene& scene);

 private:
  std::vector<Target> make_targets(const Scene& scene);
  Target make_target(const Scene& scene, VkFormat format, VkImageAspectFlags aspects);
  VkDescriptorSet make_set(const Scene& scene, const Step& step, const std::vector<Target>& targets);
  VkRenderPass make_render_pass(const Scene& scene);
  VkFramebuffer make_framebuffer(const Scene& scene, VkRenderPass pass, const std::vector<Target>& targets);
  VkPipeline make_pipeline(const Scene& scene, std::size_t step, VkRenderPass pass);
  VkPipeline create_pipeline(VkGraphicsPipelineCreateInfo& info, const Scene& scene, const void* rendering);
  void draw_step(VkCommandBuffer commands, const Scene& scene, const Step& step, VkPipeline pipeline,
                 VkDescriptorSet set, bool by_location);
  void barrier(VkCommandBuffer commands);
  void to_layout(VkCommandBuffer commands, const Scene& scene, const Target& target);
  static std::vector<Contents> bytes_of(const std::vector<Target>& targets);
  VkCommandBuffer make_secondary(const Scene& scene, const Step& step);

  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkCommandPool secondaries_ = VK_NULL_HANDLE;
  std::vector<std::function<void()>> cleanup_;
};

/// The mapping of a step in dynamic rendering, with what its structures point to.
struct StepMapping {
  StepMapping(const Scene& scene, const Step& step);
  StepMapping(const StepMapping&) = delete;
  StepMapping& operator=(const StepMapping&) = delete;

  std::vector<std::uint32_t> locations, indices;
  std::uint32_t depth_index, stencil_index;
  VkRenderingAttachmentLocationInfoKHR attachments;
  VkRenderingInputAttachmentIndexInfoKHR inputs;
};

}  // namespace vitrine::icd::test
#endif
