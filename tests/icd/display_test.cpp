// The display that VITRINE_DISPLAY asks for: what is told of it, and what applications present to it.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "icd/wsi/display_setting.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

constexpr std::uint32_t kWidth = 70, kHeight = 3;

TEST(DisplaySetting, SaysSizeRefreshAndFile) {
  const auto full = wsi::parse_display("1280x720@59.94,film.y4m");
  ASSERT_TRUE(full);
  EXPECT_EQ(full->extent.width, 1280u);
  EXPECT_EQ(full->extent.height, 720u);
  EXPECT_EQ(full->millihertz, 59940u);
  EXPECT_EQ(full->file, "film.y4m");
  const auto shorter = wsi::parse_display("1x16384,a,b.png");
  ASSERT_TRUE(shorter);
  EXPECT_EQ(shorter->millihertz, 60000u);
  EXPECT_EQ(shorter->file, "a,b.png");
  EXPECT_TRUE(wsi::parse_display("8x8,-"));
  for (const char* wrong : {"", "8", "8x8", "8x8,", "x8,a.png", "0x8,a.png", "8x0,a.png", "16385x8,a.png", "-8x8,a.png",
                            "8x8@,a.png", "8x8@0,a.png", "8x8@nan,a.png", "8x8@1001,a.png", "8x8@60a.png", "8x8,a.gif",
                            "8x8,.png", "8 x 8,a.png", "99999999999x8,a.png"})
    EXPECT_FALSE(wsi::parse_display(wrong)) << wrong;
}

class DisplayTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() / ("vitrine-display-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override {
    close_instance();
    unsetenv("VITRINE_DISPLAY");
    std::filesystem::remove_all(folder);
  }

  void open_instance(const std::string& setting) {
    setting.empty() ? unsetenv("VITRINE_DISPLAY") : setenv("VITRINE_DISPLAY", setting.c_str(), 1);
    ASSERT_EQ(create_instance(&instance, nullptr,
                              {VK_KHR_SURFACE_EXTENSION_NAME, VK_KHR_DISPLAY_EXTENSION_NAME,
                               VK_KHR_GET_DISPLAY_PROPERTIES_2_EXTENSION_NAME}),
              VK_SUCCESS);
    std::uint32_t count = 1;
    ASSERT_EQ(VK_GET(instance, EnumeratePhysicalDevices)(instance, &count, &physical_device), VK_SUCCESS);
  }
  void close_instance() {
    if (instance) VK_GET(instance, DestroyInstance)(instance, nullptr);
    instance = VK_NULL_HANDLE;
  }

  std::uint32_t displays(VkDisplayPropertiesKHR* out) {
    std::uint32_t count = out ? 1 : 0;
    EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceDisplayPropertiesKHR)(physical_device, &count, out), VK_SUCCESS);
    return count;
  }

  std::vector<VkDisplayModePropertiesKHR> modes(VkDisplayKHR display) {
    const auto get = VK_GET(instance, GetDisplayModePropertiesKHR);
    std::uint32_t count = 0;
    EXPECT_EQ(get(physical_device, display, &count, nullptr), VK_SUCCESS);
    std::vector<VkDisplayModePropertiesKHR> out(count);
    EXPECT_EQ(get(physical_device, display, &count, out.data()), VK_SUCCESS);
    return out;
  }

  VkSurfaceKHR make_surface(VkDisplayPlaneAlphaFlagBitsKHR alpha, float global) {
    VkDisplayPropertiesKHR display;
    EXPECT_EQ(displays(&display), 1u);
    auto info = make_struct<VkDisplaySurfaceCreateInfoKHR>();
    info.displayMode = modes(display.display)[0].displayMode;
    info.transform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    info.alphaMode = alpha;
    info.globalAlpha = global;
    info.imageExtent = {kWidth, kHeight};
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateDisplayPlaneSurfaceKHR)(instance, &info, nullptr, &surface), VK_SUCCESS);
    return surface;
  }

  /// Presents pictures of one colour each.
  void present(const std::vector<std::array<float, 4>>& colors, VkFormat format,
               VkDisplayPlaneAlphaFlagBitsKHR alpha = VK_DISPLAY_PLANE_ALPHA_OPAQUE_BIT_KHR, float global = 1,
               VkPresentModeKHR mode = VK_PRESENT_MODE_FIFO_KHR) {
    const VkSurfaceKHR surface = make_surface(alpha, global);
    VkDevice device;
    const char* const extensions[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, nullptr, extensions), VK_SUCCESS);
    auto info = make_struct<VkSwapchainCreateInfoKHR>();
    info.surface = surface;
    info.minImageCount = 2;
    info.imageFormat = format;
    info.imageExtent = {kWidth, kHeight};
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = mode;
    VkSwapchainKHR swapchain;
    ASSERT_EQ(VK_GET(instance, CreateSwapchainKHR)(device, &info, nullptr, &swapchain), VK_SUCCESS);
    std::uint32_t count = 2;
    VkImage images[2];
    ASSERT_EQ(VK_GET(instance, GetSwapchainImagesKHR)(device, swapchain, &count, images), VK_SUCCESS);
    for (const auto& color : colors) present_one(device, swapchain, images, color);
    VK_GET(instance, DeviceWaitIdle)(device);
    VK_GET(instance, DestroySwapchainKHR)(device, swapchain, nullptr);
    VK_GET(instance, DestroyDevice)(device, nullptr);
    VK_GET(instance, DestroySurfaceKHR)(instance, surface, nullptr);
  }

  void present_one(VkDevice device, VkSwapchainKHR swapchain, const VkImage* images,
                   const std::array<float, 4>& color) {
    std::uint32_t index = 0;
    const auto acquire = VK_GET(instance, AcquireNextImageKHR);
    ASSERT_EQ(acquire(device, swapchain, UINT64_MAX, VK_NULL_HANDLE, VK_NULL_HANDLE, &index), VK_SUCCESS);
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    VkCommandPool pool;
    ASSERT_EQ(VK_GET(instance, CreateCommandPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands;
    ASSERT_EQ(VK_GET(instance, AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    VK_GET(instance, BeginCommandBuffer)(commands, &begin);
    VkClearColorValue value;
    std::copy(color.begin(), color.end(), value.float32);
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VK_GET(instance, CmdClearColorImage)(commands, images[index], VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
    VK_GET(instance, EndCommandBuffer)(commands);
    VkQueue queue;
    VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
    auto submit = make_struct<VkSubmitInfo>();
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    ASSERT_EQ(VK_GET(instance, QueueSubmit)(queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    auto show = make_struct<VkPresentInfoKHR>();
    show.swapchainCount = 1;
    show.pSwapchains = &swapchain;
    show.pImageIndices = &index;
    ASSERT_EQ(VK_GET(instance, QueuePresentKHR)(queue, &show), VK_SUCCESS);
    VK_GET(instance, QueueWaitIdle)(queue);
    VK_GET(instance, DestroyCommandPool)(device, pool, nullptr);
  }

  std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }

  std::string setting(const char* name, const char* refresh = "") {
    return std::to_string(kWidth) + "x" + std::to_string(kHeight) + refresh + "," + (folder / name).string();
  }

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  std::filesystem::path folder;
};

TEST_F(DisplayTest, WithoutTheSettingThereIsNone) {
  for (const char* setting : {"", "no display at all"}) {
    open_instance(setting);
    EXPECT_EQ(displays(nullptr), 0u);
    std::uint32_t planes = 7;
    EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceDisplayPlanePropertiesKHR)(physical_device, &planes, nullptr),
              VK_SUCCESS);
    EXPECT_EQ(planes, 0u);
    close_instance();
  }
}

TEST_F(DisplayTest, IsTold) {
  open_instance(setting("a.png", "@30"));
  VkDisplayPropertiesKHR display{};
  ASSERT_EQ(displays(&display), 1u);
  EXPECT_STREQ(display.displayName, "VITRINE_DISPLAY");
  EXPECT_EQ(display.physicalResolution.width, kWidth);
  EXPECT_EQ(display.physicalResolution.height, kHeight);
  auto wide = make_struct<VkDisplayProperties2KHR>();
  std::uint32_t count = 1;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceDisplayProperties2KHR)(physical_device, &count, &wide), VK_SUCCESS);
  EXPECT_EQ(wide.displayProperties.display, display.display);
  auto plane = make_struct<VkDisplayPlaneProperties2KHR>();
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceDisplayPlaneProperties2KHR)(physical_device, &count, &plane), VK_SUCCESS);
  EXPECT_EQ(plane.displayPlaneProperties.currentDisplay, display.display);
  VkDisplayKHR supported = VK_NULL_HANDLE;
  EXPECT_EQ(VK_GET(instance, GetDisplayPlaneSupportedDisplaysKHR)(physical_device, 0, &count, &supported), VK_SUCCESS);
  EXPECT_EQ(supported, display.display);
}

TEST_F(DisplayTest, HasModesOfItsSize) {
  open_instance(setting("a.png", "@30"));
  VkDisplayPropertiesKHR display{};
  ASSERT_EQ(displays(&display), 1u);
  ASSERT_EQ(modes(display.display).size(), 1u);
  EXPECT_EQ(modes(display.display)[0].parameters.refreshRate, 30000u);
  auto info = make_struct<VkDisplayModeCreateInfoKHR>();
  info.parameters = {{kWidth, kHeight}, 50000};
  const auto create = VK_GET(instance, CreateDisplayModeKHR);
  VkDisplayModeKHR mode = VK_NULL_HANDLE;
  ASSERT_EQ(create(physical_device, display.display, &info, nullptr, &mode), VK_SUCCESS);
  EXPECT_NE(modes(display.display)[0].displayMode, mode);
  EXPECT_EQ(modes(display.display).size(), 1u) << "only built-in modes are listed";
  for (const VkDisplayModeParametersKHR wrong : {VkDisplayModeParametersKHR{{kWidth + 1, kHeight}, 50000},
                                                 {{kWidth, 0}, 50000},
                                                 {{kWidth, kHeight}, 0},
                                                 {{kWidth, kHeight}, 0xffffffff}}) {
    info.parameters = wrong;
    EXPECT_EQ(create(physical_device, display.display, &info, nullptr, &mode), VK_ERROR_INITIALIZATION_FAILED);
  }
  VkDisplayPlaneCapabilitiesKHR capabilities{};
  EXPECT_EQ(VK_GET(instance, GetDisplayPlaneCapabilitiesKHR)(physical_device, mode, 0, &capabilities), VK_SUCCESS);
  EXPECT_EQ(capabilities.supportedAlpha, 15u);
  EXPECT_EQ(capabilities.maxDstExtent.width, kWidth);
  auto plane = make_struct<VkDisplayPlaneInfo2KHR>();
  plane.mode = mode;
  auto wide = make_struct<VkDisplayPlaneCapabilities2KHR>();
  EXPECT_EQ(VK_GET(instance, GetDisplayPlaneCapabilities2KHR)(physical_device, &plane, &wide), VK_SUCCESS);
  EXPECT_EQ(wide.capabilities.minSrcExtent.height, kHeight);
  auto properties = make_struct<VkDisplayModeProperties2KHR>();
  std::uint32_t count = 1;
  EXPECT_EQ(VK_GET(instance, GetDisplayModeProperties2KHR)(physical_device, display.display, &count, &properties),
            VK_SUCCESS);
  EXPECT_EQ(properties.displayModeProperties.parameters.refreshRate, 30000u);
}

TEST_F(DisplayTest, StreamsWhatIsPresented) {
  open_instance(setting("film.y4m", "@500"));
  const VkSurfaceKHR surface = make_surface(VK_DISPLAY_PLANE_ALPHA_OPAQUE_BIT_KHR, 1);
  VkSurfaceCapabilitiesKHR capabilities;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceCapabilitiesKHR)(physical_device, surface, &capabilities),
            VK_SUCCESS);
  EXPECT_EQ(capabilities.currentExtent.width, kWidth);
  VK_GET(instance, DestroySurfaceKHR)(instance, surface, nullptr);
  present({{1, 0, 0, 1}, {1, 1, 1, 0}}, VK_FORMAT_B8G8R8A8_UNORM);
  present({{0, 0, 1, 1}}, VK_FORMAT_R8G8B8A8_UNORM);
  const std::string film = text_of(folder / "film.y4m");
  const std::string header = "YUV4MPEG2 W70 H3 F500000:1000 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
  constexpr std::size_t kPixels = kWidth * kHeight, kFrame = 6 + 3 * kPixels;
  ASSERT_EQ(film.size(), header.size() + 3 * kFrame);
  EXPECT_EQ(film.substr(0, header.size()), header);
  constexpr int kExpected[3][3] = {{82, 90, 240}, {235, 128, 128}, {41, 240, 110}};  // BT.601
  for (std::size_t f = 0; f < 3; ++f) {
    const std::string frame = film.substr(header.size() + f * kFrame, kFrame);
    EXPECT_EQ(frame.substr(0, 6), "FRAME\n");
    for (std::size_t plane = 0; plane < 3; ++plane) {
      const char value = static_cast<char>(kExpected[f][plane]);
      EXPECT_EQ(frame.substr(6 + plane * kPixels, kPixels), std::string(kPixels, value))
          << f << " " << plane << " " << int{static_cast<unsigned char>(frame[6 + plane * kPixels])};
    }
  }
}

TEST_F(DisplayTest, PlanesLieOverBlack) {
  open_instance(setting("alpha.y4m", "@1000"));
  constexpr VkFormat kFormat = VK_FORMAT_B8G8R8A8_UNORM;
  present({{1, 1, 1, 0.5f}}, kFormat, VK_DISPLAY_PLANE_ALPHA_OPAQUE_BIT_KHR);
  present({{1, 1, 1, 0.5f}}, kFormat, VK_DISPLAY_PLANE_ALPHA_PER_PIXEL_PREMULTIPLIED_BIT_KHR);
  present({{1, 1, 1, 0}}, kFormat, VK_DISPLAY_PLANE_ALPHA_PER_PIXEL_BIT_KHR);
  present({{1, 1, 1, 1}}, kFormat, VK_DISPLAY_PLANE_ALPHA_GLOBAL_BIT_KHR, 0);
  present({{1, 1, 1, 0}}, kFormat, VK_DISPLAY_PLANE_ALPHA_GLOBAL_BIT_KHR, 1);
  const std::string film = text_of(folder / "alpha.y4m");
  const std::size_t first = film.find('\n') + 1 + 6, step = 6 + 3 * kWidth * kHeight;
  ASSERT_EQ(film.size(), first - 6 + 5 * step);
  constexpr int kLuma[] = {235, 235, 16, 16, 235};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(int{static_cast<unsigned char>(film[first + i * step])}, kLuma[i]) << i;
}

TEST_F(DisplayTest, NumbersPictures) {
  open_instance(setting("shot.png", "@1000"));
  present({{1, 0, 0, 1}, {0, 1, 0, 1}}, VK_FORMAT_B8G8R8A8_UNORM);
  EXPECT_TRUE(text_of(folder / "shot-000001.png").starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_TRUE(std::filesystem::exists(folder / "shot-000002.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "shot-000003.png"));
}

TEST_F(DisplayTest, FilesThatCannotBeWrittenStopNobody) {
  for (const char* name : {"missing/film.y4m", "missing/shot.png"}) {
    open_instance(setting(name, "@1000"));
    present({{1, 0, 0, 1}, {0, 1, 0, 1}}, VK_FORMAT_B8G8R8A8_UNORM);
    close_instance();
  }
}

/// FIFO goes at the pace of the mode, other modes at their own.
TEST_F(DisplayTest, FirstInFirstOutWaitsForTheRefresh) {
  open_instance(setting("pace.y4m", "@20"));
  const std::vector<std::array<float, 4>> six(6, {1, 1, 1, 1});
  const auto seconds = [&](VkPresentModeKHR mode) {
    const auto begin = std::chrono::steady_clock::now();
    present(six, VK_FORMAT_B8G8R8A8_UNORM, VK_DISPLAY_PLANE_ALPHA_OPAQUE_BIT_KHR, 1, mode);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  EXPECT_GE(seconds(VK_PRESENT_MODE_FIFO_KHR), 0.25);
  const std::string film = text_of(folder / "pace.y4m");
  EXPECT_EQ(film.size(), film.find('\n') + 1 + 6 * (6 + 3 * kWidth * kHeight));
}

}  // namespace
}  // namespace vitrine::icd::test
