// What the tool sanitize tells an application of its commands and objects, through messengers.
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
  const VkCommandBuffer commands = begin();
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  VK_CALL(CmdDispatchIndirect)(commands, data.buffer, kBytes - 8);
  run(commands);
  EXPECT_EQ(
      heard,
      Lines{"vitrine: error: arguments of a dispatch: 12 bytes at offset 4088, outside of buffer 'arguments' (4096 "
            "bytes) [vitrine/out-of-bounds-arguments]"});
}

}  // namespace
}  // namespace vitrine::icd::test
