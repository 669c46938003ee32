// A device on which sync is on, and scripts of commands for it: what is planted, and its correct twin.
//
// A script is commands, one a line or with ';' between them: a word and its operands.
//   buffers A, B, C (256 bytes; ranges "A:64+32"), images M, N (8 x 8, in GENERAL), S (four samples), D (depth), L (two
//   levels), X (its memory can be exported), R (shading rates)
//   fill A | update A | copy A B | copy M A | copy A M | copy M N | clear M | clear L:1 (a level) | blit M N |
//   resolve S M | queries A load A | store A | add A | uniform A | load M | store M | sample M       a dispatch that
//   does it, in all words dispatch A (indirect) | draws A (indirect, by arguments) | indices A | vertices A render M
//   [LOAD|CLEAR|DONT_CARE] | end | draw | draw load A | draw store A | draw sample M | draw lookup L | vertex load A
//   depth D [LOAD|CLEAR] (rendering with depth) | rates M R (rendering with rates) | kept M R (that no draw looks at)
//   barrier STAGES.ACCESSES>STAGES.ACCESSES [A or M] | old ... (the same by vkCmdPipelineBarrier)
//   to M LAYOUT>LAYOUT STAGES.ACCESSES>STAGES.ACCESSES
//   set STAGES.ACCESSES>STAGES.ACCESSES | wait STAGES.ACCESSES>STAGES.ACCESSES   (an event)
//   submit | semaphore STAGES (submits, and the next submission waits there) | timeline STAGES | fence | idle
//   flush A | invalidate A
//   put M | get M | turn M LAYOUT>LAYOUT   (the host copies all of an image, or transitions it)
//   pass M KIND   a render pass of one subpass or two (sync_passes in the .cpp)
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/glsl/compile.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {

#define VK_CALL(name) VK_GET(instance, name)

struct PlantedHazard {
  const char* name;
  const char* rule;
  const char* fault;
  const char* twin;
};

/// The rules that a script breaks, each once; `text`: of the last finding.
class SyncScene {
 public:
  SyncScene();
  ~SyncScene();
  SyncScene(const SyncScene&) = delete;

  std::vector<std::string> run(const std::string& script);
  const std::string& text() const { return text_; }

 private:
  using Words = std::vector<std::string>;
  struct Buffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
  };
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  };
  struct Range {
    VkBuffer buffer;
    VkDeviceSize offset, size;
  };

  void make_buffer(const char* name);
  void make_image(const char* name, VkFormat format, VkSampleCountFlagBits samples, std::uint32_t levels = 1,
                  bool exported = false);
  void make_set();
  void to_general();
  template <class H>
  void name(VkObjectType type, H handle, const char* text);
  bool is_image(const std::string& name) const { return images_.count(name.substr(0, 1)) != 0; }
  Image& image(const std::string& name) { return images_.at(name.substr(0, 1)); }
  Range range(const std::string& name);

  void command(const Words& words);
  void transfer(const Words& words);
  void copy(const std::string& from, const std::string& to);
  void dispatch(const std::string& body);
  void shader_command(const Words& words);
  void draw(const Words& words);
  void rendering(const Words& words);
  void fixed_stage(const Words& words);
  void order(const Words& words);
  void barrier(const Words& words, const std::string& masks, VkImageLayout from, VkImageLayout to,
               const std::string& resource);
  void old_barrier(const std::string& masks);
  void event(const Words& words);
  void submission(const Words& words);
  void host(const Words& words);
  void host_copy(const Words& words);
  void pass(const Words& words);
  void make_pass(const Words& words, VkRenderPassBeginInfo& begin);

  void begin();
  void submit(VkSemaphore signal = VK_NULL_HANDLE, std::uint64_t value = 0, VkFence fence = VK_NULL_HANDLE);
  VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage, const std::string& glsl);
  VkPipeline draw_pipeline(const std::string& vertex, const std::string& fragment, VkRenderPass pass, bool attributes);

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::map<std::string, Buffer> buffers_;
  std::map<std::string, Image> images_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkEvent event_ = VK_NULL_HANDLE;
  VkQueryPool queries_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkSemaphore wait_ = VK_NULL_HANDLE;  ///< of the next submission
  std::uint64_t wait_value_ = 0;
  VkPipelineStageFlags wait_stages_ = 0;
  std::uint32_t bodies_ = 0;
  bool has_depth_ = false;  ///< the rendering at hand
  bool has_rates_ = false;
  std::vector<VkPipeline> pipelines_;
  std::vector<VkSemaphore> semaphores_;
  std::vector<VkRenderPass> passes_;
  std::vector<VkFramebuffer> framebuffers_;
  std::vector<std::string> found_;
  std::string text_;
};

void expect_hazard(const PlantedHazard& planted);

}  // namespace vitrine::icd::test
