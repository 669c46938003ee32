// VK_KHR_dynamic_rendering_local_read, which neither older headers nor the reference know: dynamic rendering that reads
// its own attachments is held against a render pass with subpasses that does the same, which the suite holds against
// the reference (cts-subset/cases/renderpass).
#include <cstdlib>

#include "tests/icd/local_read_fixture.h"

#ifdef VK_KHR_dynamic_rendering_local_read
namespace vitrine::icd::test {
namespace {

using LocalRead = LocalReadDevice;

constexpr VkFormat kUnorm = VK_FORMAT_R8G8B8A8_UNORM, kBgra = VK_FORMAT_B8G8R8A8_UNORM,
                   kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;

/// A fragment shader with `outputs` colours and `inputs`, whose declarations end as told.
std::string shader(std::uint32_t outputs, const std::vector<std::string>& inputs, const std::string& body) {
  std::string text = "layout(location = 0) in vec2 uv;\n";
  for (std::uint32_t i = 0; i < inputs.size(); ++i) {
    const std::string n = std::to_string(i);
    text.append("layout(input_attachment_index = ").append(n).append(", set = 0, binding = ").append(n);
    text.append(") uniform ").append(inputs[i]).append(" i").append(n).append(";\n");
  }
  for (std::uint32_t i = 0; i < outputs; ++i) {
    const std::string n = std::to_string(i);
    text.append("layout(location = ").append(n).append(") out vec4 o").append(n).append(";\n");
  }
  return text.append("void main() {\n").append(body).append("\n}\n");
}

/// Three surfaces are drawn, and lit into a fourth.
Scene deferred(const std::string& input = "subpassInput", const std::string& sample = "") {
  const auto load = [&](int i) { return "subpassLoad(i" + std::to_string(i) + sample + ")"; };
  Scene scene;
  scene.colors = {kFloats, kUnorm, kBgra, VK_FORMAT_R16G16B16A16_SFLOAT};
  scene.steps = {
      {shader(3, {}, "o0 = vec4(uv, uv.yx * 3); o1 = vec4(uv.x, 0.3, uv.y, 1); o2 = vec4(fract(uv * 7), 0.2, 0.9);"),
       {0, 1, 2},
       {}},
      {shader(1, {input, input, input},
              "o0 = " + load(0) + " * 2 + " + load(1) + " * vec4(1, 2, 3, 4) - " + load(2) + ".zxyw;"),
       {3},
       {0, 1, 2}}};
  return scene;
}

TEST_F(LocalRead, IsOffered) {
  auto features = make_struct<VkPhysicalDeviceDynamicRenderingLocalReadFeaturesKHR>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_GET(instance, GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.dynamicRenderingLocalRead);
}

TEST_F(LocalRead, StepsReadWhatEarlierOnesDrew) {
  Scene scene = deferred();
  expect_same(scene);
  scene.layout = VK_IMAGE_LAYOUT_GENERAL;
  expect_same(scene);
}

TEST_F(LocalRead, SamplesAreReadOneByOne) {
  Scene scene = deferred("subpassInputMS", ", gl_SampleID");
  scene.samples = VK_SAMPLE_COUNT_4_BIT;
  expect_same(scene);
}

TEST_F(LocalRead, EachLayerAndViewReadsItself) {
  Scene scene = deferred();
  scene.layers = 3;
  expect_same(scene);
  scene.view_mask = 0b101;
  expect_same(scene);
}

/// Locations in another order, one of them beyond the attachments, and attachments that nothing reaches. Blending,
/// masks and clears go by attachment.
TEST_F(LocalRead, OutputsGoToTheAttachmentsOfTheirLocations) {
  Scene scene;
  scene.colors = {kUnorm, kFloats, kBgra};
  const std::string three = "o0 = vec4(uv, 0.3, 0.6); o1 = vec4(0.7, uv, 0.2); o2 = vec4(uv.yx, 0.9, uv.x);";
  scene.steps = {
      {shader(3, {}, three), {2, 0, 1}, {}, 1, 0, true},
      {shader(3, {}, three), {kUnused, 2}, {}, 1, 2, true},
      {shader(5, {}, three + "o3 = o0.wzyx; o4 = o1.wzyx;"), {kUnused, 1, kUnused, kUnused, 2}, {}, 1, 1, true},
      {shader(3, {}, three), {0, 1, 2}, {}, 1, 0, true},
      {shader(1, {}, "o0 = vec4(uv, 0.1, 0.2);"), {1}, {}, 1, 1, false}};
  expect_same(scene);
  scene.writes_masks = true;
  expect_same(scene);
}

/// "Any writes to a fragment output location that is not mapped to an attachment must be discarded"; its alpha covers
/// samples all the same.
TEST_F(LocalRead, NothingMayBeReached) {
  Scene scene;
  scene.colors = {kUnorm, kBgra};
  scene.samples = VK_SAMPLE_COUNT_4_BIT;
  scene.steps = {{shader(2, {}, "o0 = vec4(uv, 0, 1); o1 = vec4(1);"), {0, 1}, {}},
                 {shader(2, {}, "o0 = vec4(uv, 0, 1); o1 = vec4(0.25);"), {kUnused, kUnused}, {}},
                 {shader(2, {}, "o0 = vec4(uv, 0, uv.x); o1 = vec4(0.5);"), {kUnused, 0}, {}}};
  scene.steps[2].covers_by_alpha = true;
  expect_same(scene);
}

TEST_F(LocalRead, LibrariesAndSecondariesBringTheirMappings) {
  Scene scene = deferred();
  std::swap(scene.steps[0].colors[0], scene.steps[0].colors[2]);
  std::swap(scene.steps[1].inputs[0], scene.steps[1].inputs[2]);
  scene.as_libraries = true;
  expect_same(scene);
  scene.in_secondaries = true;
  expect_same(scene);
  scene.draws_inline_too = true;  // VK_KHR_maintenance7
  expect_same(scene);
}

TEST_F(LocalRead, BarriersLetAnAttachmentBeReadWhileItIsDrawnTo) {
  Scene scene;
  scene.colors = {kUnorm, kFloats};
  scene.steps = {{shader(2, {}, "o0 = vec4(uv, 0.1, 0.2); o1 = uv.xyxy;"), {0, 1}, {}},
                 {shader(1, {"subpassInput", "subpassInput"}, "o0 = subpassLoad(i0) * 0.5 + subpassLoad(i1).wzyx;"),
                  {1},
                  {1, 0},
                  4}};
  expect_same(scene);
}

/// With VK_EXT_rasterization_order_attachment_access no barrier is needed, not even between primitives.
TEST_F(LocalRead, PrimitivesReadWhatThoseBeforeThemWrote) {
  for (const VkSampleCountFlagBits samples : {VK_SAMPLE_COUNT_1_BIT, VK_SAMPLE_COUNT_4_BIT}) {
    const bool many = samples != VK_SAMPLE_COUNT_1_BIT;
    Scene scene;
    scene.colors = {kUnorm, kFloats};
    scene.samples = samples;
    const std::string load = many ? "subpassLoad(i0, gl_SampleID)" : "subpassLoad(i0)";
    scene.steps = {
        {shader(2, {}, "o0 = vec4(uv, 0, 1); o1 = vec4(0.1);"), {0, 1}, {}},
        {shader(1, {many ? "subpassInputMS" : "subpassInput"}, "o0 = " + load + " * 0.75 + uv.xyxy * 0.2;"), {1}, {1}}};
    scene.steps[1].ordered = true;
    expect_same(scene);
  }
}

TEST_F(LocalRead, DepthAndStencilAreInputs) {
  for (const bool unnamed : {false, true}) {
    for (const VkFormat format : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT}) {
      const bool stencil = format != VK_FORMAT_D32_SFLOAT;
      Scene scene;
      scene.colors = {kUnorm, kFloats};
      scene.depth = format;
      scene.unnamed_depth = unnamed;
      std::vector<std::string> inputs = {"subpassInput", "subpassInput"};
      std::string value = "vec4(subpassLoad(i0).x, subpassLoad(i1).xy, 0)";
      if (stencil) {
        inputs.emplace_back("usubpassInput");
        value.append(" + vec4(0, 0, 0, subpassLoad(i2).x)");
      }
      scene.steps = {{shader(1, {}, "o0 = vec4(uv, 0.1, 0.2);"), {0}, {}, 2},
                     {shader(1, inputs, "o0 = " + value + ";"), {1}, {2, 0}}};
      if (stencil) scene.steps[1].inputs.push_back(3);
      expect_same(scene);
    }
  }
}

/// Where VITRINE_TOOLS=sync is on: what it finds.
class LocalReadSync : public LocalReadDevice {
 protected:
  void SetUp() override {
    if (!std::getenv("VITRINE_TOOLS")) GTEST_SKIP() << "needs VITRINE_TOOLS=sync";
    LocalReadDevice::SetUp();
    auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pUserData = this;
    info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) -> VkBool32 {
      static_cast<LocalReadSync*>(self)->found.emplace_back(data->pMessageIdName);
      static_cast<LocalReadSync*>(self)->text = data->pMessage;
      return VK_FALSE;
    };
    ASSERT_EQ(VK_GET(instance, CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  }
  void TearDown() override {
    if (!messenger) return;
    VK_GET(instance, DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
    LocalReadDevice::TearDown();
  }

  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  std::vector<std::string> found;
  std::string text;
};

TEST_F(LocalReadSync, MissesBarriersBeforeInputAttachments) {
  Scene scene = deferred();
  std::swap(scene.steps[0].colors[0], scene.steps[0].colors[2]);
  as_rendering(scene);
  EXPECT_EQ(found, std::vector<std::string>{}) << text;
  scene.lacks_barriers = true;
  as_rendering(scene);
  EXPECT_EQ(found, std::vector<std::string>(3, "sync-read-after-write")) << "of each of the three";
  EXPECT_NE(text.find("VK_DEPENDENCY_BY_REGION_BIT"), std::string::npos) << text;
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
