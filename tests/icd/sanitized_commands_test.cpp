// What the tool sanitize tells an application of its commands and objects, through messengers.
#include <algorithm>
#include <string>

#include "tests/icd/resources_fixture.h"

namespace vitrine::icd::test {
namespace {

class SanitizedCommands : public ResourceTest {
 protected:
  /// Tools are chosen for the process: these tests run in one of their own (tests/CMakeLists.txt).
  void SetUp() override {
    if (!std::getenv("VITRINE_TOOLS")) GTEST_SKIP() << "needs a process of its own";
    ResourceTest::SetUp();
    auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) -> VkBool32 {
      const std::string message = data->pMessage;
      static_cast<SanitizedCommands*>(self)->heard.push_back(message.substr(0, message.find('\n')));
      return VK_FALSE;
    };
    info.pUserData = this;
    ASSERT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  }
  void TearDown() override {
    if (!instance) return;
    VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
    ResourceTest::TearDown();
  }

  template <class H>
  void name(VkObjectType type, H handle, const char* text) {
    auto info = make_struct<VkDebugUtilsObjectNameInfoEXT>();
    info.objectType = type;
    info.objectHandle = reinterpret_cast<std::uint64_t>(handle);
    info.pObjectName = text;
    EXPECT_EQ(VK_CALL(SetDebugUtilsObjectNameEXT)(device, &info), VK_SUCCESS);
  }

  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  std::vector<std::string> heard;  ///< first lines
};

using Lines = std::vector<std::string>;

TEST_F(SanitizedCommands, ArgumentsOutsideOfTheirBuffer) {
  name(VK_OBJECT_TYPE_BUFFER, data.buffer, "arguments");
  const VkDescriptorSetLayout set_layout = make_set_layout_of(kTypes);
  const VkPipelineLayout layout = make_layout(set_layout);
  const VkPipeline pipeline = make_compute(layout);
  const auto dispatch_at = [&](VkDeviceSize offset) {
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdFillBuffer)(commands, data.buffer, 0, VK_WHOLE_SIZE, 0);
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_CALL(CmdDispatchIndirect)(commands, data.buffer, offset);
    run(commands);
  };
  dispatch_at(kBytes - 12);
  EXPECT_EQ(heard, Lines{});
  dispatch_at(kBytes - 8);
  EXPECT_EQ(
      heard,
      Lines{"vitrine: error: arguments of a dispatch: 12 bytes at offset 4088, outside of buffer 'arguments' (4096 "
            "bytes) [vitrine/out-of-bounds-arguments]"});
}

/// One dispatch that uses every resource, after `end` has ended some.
class DepartedResources : public SanitizedCommands {
 protected:
  void SetUp() override {
    SanitizedCommands::SetUp();
    if (!device) return;
    name(VK_OBJECT_TYPE_BUFFER, data.buffer, "data");
    name(VK_OBJECT_TYPE_IMAGE, image, "picture");
    name(VK_OBJECT_TYPE_BUFFER_VIEW, texels, "table");
    name(VK_OBJECT_TYPE_SAMPLER, sampler, "nearest");
    set_layout = make_set_layout_of(kTypes);
    layout = make_layout(set_layout);
    pipeline = make_compute(layout);
    set = make_full_set(set_layout, kTypes);
    use_all();
    EXPECT_EQ(heard, Lines{}) << "everything is alive";
  }

  void use_all() {
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    const VkDescriptorSet sets[] = {set, output};
    VK_CALL(CmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, sets, 0, nullptr);
    const std::uint32_t zero = 0;
    VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, sizeof zero, &zero);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    run(commands);
  }

  /// Ends of first lines of what is found in a dispatch, by rule and resource.
  std::vector<std::string> found() {
    use_all();
    for (std::string& line : heard) {
      const std::size_t use = line.find("use of ");
      if (use != std::string::npos) line.erase(0, use);
    }
    std::sort(heard.begin(), heard.end());
    heard.erase(std::unique(heard.begin(), heard.end()), heard.end());
    return heard;
  }

  void end_data_buffer() {
    VK_CALL(DestroyBuffer)(device, data.buffer, nullptr);
    forget([&](const Memory& m) { return m.buffer == data.buffer; }, true);
  }
  /// The fixture ends it no more. `keep_memory`: that it does.
  template <class F>
  void forget(F&& which, bool keep_memory) {
    for (Memory& m : memories) {
      if (!which(m)) continue;
      m.buffer = VK_NULL_HANDLE;
      if (!keep_memory) m.memory = VK_NULL_HANDLE;
    }
  }

  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
};

constexpr const char* kGone = " [vitrine/destroyed-descriptor]";

TEST_F(DepartedResources, BuffersAndTheirViews) {
  end_data_buffer();
  EXPECT_EQ(
      found(),
      (Lines{
          std::string("use of storage buffer (set 0, binding 1, buffer 'data', destroyed after submission 1)") + kGone,
          std::string("use of storage texel buffer (set 0, binding 7, buffer view 'table', whose buffer 'data' was "
                      "destroyed after submission 1)") +
              kGone,
          std::string("use of uniform buffer (set 0, binding 0, buffer 'data', destroyed after submission 1)") + kGone,
          std::string("use of uniform texel buffer (set 0, binding 6, buffer view 'table', whose buffer 'data' was "
                      "destroyed after submission 1)") +
              kGone}));
}

TEST_F(DepartedResources, MemoryThatIsGivenBackIsNotRead) {
  VK_CALL(FreeMemory)(device, data.memory, nullptr);
  for (Memory& m : memories)
    if (m.buffer == data.buffer) m.memory = VK_NULL_HANDLE;
  const Lines lines = found();
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0],
            std::string("use of storage buffer (set 0, binding 1, buffer 'data', whose memory was freed after "
                        "submission 1)") +
                kGone);
}

TEST_F(DepartedResources, ImagesWithTheirViews) {
  VK_CALL(DestroyImage)(device, image, nullptr);
  image = VK_NULL_HANDLE;
  const Lines lines = found();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0],
            std::string("use of combined image sampler (set 0, binding 2, image view, whose image 'picture' was "
                        "destroyed after submission 1)") +
                kGone);
}

TEST_F(DepartedResources, ViewsWhoseAddressesComeAgain) {
  VK_CALL(DestroyImageView)(device, view, nullptr);
  VK_CALL(DestroyBufferView)(device, texels, nullptr);
  // The same sizes: allocators give the same memory.
  auto view_info = make_struct<VkImageViewCreateInfo>();
  view_info.image = image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = VK_FORMAT_R32_SFLOAT;
  view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  ASSERT_EQ(VK_CALL(CreateImageView)(device, &view_info, nullptr, &view), VK_SUCCESS);
  auto texels_info = make_struct<VkBufferViewCreateInfo>();
  texels_info.buffer = data.buffer;
  texels_info.format = VK_FORMAT_R32_SFLOAT;
  texels_info.range = VK_WHOLE_SIZE;
  ASSERT_EQ(VK_CALL(CreateBufferView)(device, &texels_info, nullptr, &texels), VK_SUCCESS);
  EXPECT_EQ(found().size(), 5u) << "two texel buffers, three images";
  heard.clear();
  set = make_full_set(set_layout, kTypes);
  EXPECT_EQ(found(), Lines{}) << "written anew";
}

TEST_F(DepartedResources, Samplers) {
  VK_CALL(DestroySampler)(device, sampler, nullptr);
  sampler = VK_NULL_HANDLE;
  EXPECT_EQ(found(),
            (Lines{std::string("use of combined image sampler (set 0, binding 2, sampler 'nearest', destroyed after "
                               "submission 1)") +
                       kGone,
                   std::string("use of sampler (set 0, binding 4, sampler 'nearest', destroyed after submission 1)") +
                       kGone}));
}

}  // namespace
}  // namespace vitrine::icd::test
