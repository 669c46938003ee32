// Images that other devices share by the linear modifier (VK_EXT_image_drm_format_modifier): what is offered, where
// planes lie, and that commands keep to them.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "icd/registry/registry.h"
#include "tests/icd/fixture.h"
#include "texel/format.h"

namespace vitrine::icd::test {
namespace {

constexpr VkFormat kNv12 = VK_FORMAT_G8_B8R8_2PLANE_420_UNORM;
constexpr std::uint64_t kLinear = 0, kInvalid = 0x00ffffffffffffff, kOfAnotherVendor = 0x0200000000000001;
constexpr VkDeviceSize kMemory = 65536;

class DrmModifier : public DeviceTest {
 protected:
  void TearDown() override {
    for (const VkImage image : images) VK_GET(instance, DestroyImage)(device, image, nullptr);
    for (const VkDeviceMemory memory : memories) VK_GET(instance, FreeMemory)(device, memory, nullptr);
    for (const VkBuffer buffer : buffers) VK_GET(instance, DestroyBuffer)(device, buffer, nullptr);
    DeviceTest::TearDown();
  }

  static VkImageCreateInfo image_info(VkFormat format, VkExtent2D extent, const void* next) {
    auto info = make_struct<VkImageCreateInfo>(const_cast<void*>(next));
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_DRM_FORMAT_MODIFIER_EXT;
    info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return info;
  }

  VkResult create(const VkImageCreateInfo& info, VkImage* image) {
    const VkResult result = VK_GET(instance, CreateImage)(device, &info, nullptr, image);
    if (result == VK_SUCCESS) images.push_back(*image);
    return result;
  }

  /// An image with its planes where they are wanted; null: refused, which has to be by the extension's error.
  VkImage make_exact(VkFormat format, VkExtent2D extent, std::vector<VkSubresourceLayout> planes,
                     std::uint64_t modifier = kLinear, std::uint32_t layers = 1, std::uint32_t levels = 1) {
    auto exact = make_struct<VkImageDrmFormatModifierExplicitCreateInfoEXT>();
    exact.drmFormatModifier = modifier;
    exact.drmFormatModifierPlaneCount = static_cast<std::uint32_t>(planes.size());
    exact.pPlaneLayouts = planes.data();
    VkImageCreateInfo info = image_info(format, extent, &exact);
    info.arrayLayers = layers;
    info.mipLevels = levels;
    VkImage image = VK_NULL_HANDLE;
    const VkResult result = create(info, &image);
    if (result == VK_SUCCESS) return image;
    EXPECT_EQ(result, VK_ERROR_INVALID_DRM_FORMAT_MODIFIER_PLANE_LAYOUT_EXT);
    return VK_NULL_HANDLE;
  }

  VkSubresourceLayout layout_of(VkImage image, VkImageAspectFlags aspect, std::uint32_t layer = 0) {
    const VkImageSubresource subresource{aspect, 0, layer};
    VkSubresourceLayout layout{};
    VK_GET(instance, GetImageSubresourceLayout)(device, image, &subresource, &layout);
    return layout;
  }

  VkDeviceMemory make_memory(const void* next = nullptr) {
    auto info = make_struct<VkMemoryAllocateInfo>(const_cast<void*>(next));
    info.allocationSize = kMemory;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, AllocateMemory)(device, &info, nullptr, &memory), VK_SUCCESS);
    memories.push_back(memory);
    return memory;
  }

  std::uint8_t* map(VkDeviceMemory memory) {
    void* data = nullptr;
    EXPECT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    return static_cast<std::uint8_t*>(data);
  }

  std::uint32_t modifiers(VkFormat format, VkDrmFormatModifierPropertiesEXT* out) {
    auto list = make_struct<VkDrmFormatModifierPropertiesListEXT>();
    list.drmFormatModifierCount = out ? 1 : 0;
    list.pDrmFormatModifierProperties = out;
    auto properties = make_struct<VkFormatProperties2>(&list);
    VK_GET(instance, GetPhysicalDeviceFormatProperties2)(physical_device, format, &properties);
    return list.drmFormatModifierCount;
  }

  VkResult ask(VkPhysicalDeviceImageFormatInfo2 info, std::uint64_t modifier, VkImageFormatProperties& out) {
    auto wanted = make_struct<VkPhysicalDeviceImageDrmFormatModifierInfoEXT>();
    wanted.drmFormatModifier = modifier;
    info.pNext = &wanted;
    auto properties = make_struct<VkImageFormatProperties2>();
    const VkResult result =
        VK_GET(instance, GetPhysicalDeviceImageFormatProperties2)(physical_device, &info, &properties);
    out = properties.imageFormatProperties;
    return result;
  }

  void whole_image(VkCommandBuffer commands, VkImage image, VkBuffer buffer, VkImageAspectFlags aspect,
                   VkExtent2D extent) {
    VkBufferImageCopy region{};
    region.imageSubresource = {aspect, 0, 0, 1};
    region.imageExtent = {extent.width, extent.height, 1};
    const auto copy = VK_GET(instance, CmdCopyImageToBuffer);
    copy(commands, image, VK_IMAGE_LAYOUT_GENERAL, buffer, 1, &region);
  }

  VkBuffer make_buffer(VkDeviceMemory memory) {
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = kMemory;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &buffer), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, 0), VK_SUCCESS);
    buffers.push_back(buffer);
    return buffer;
  }

  std::vector<VkImage> images;
  std::vector<VkDeviceMemory> memories;
  std::vector<VkBuffer> buffers;
};

TEST_F(DrmModifier, EveryColourFormatHasTheLinearOne) {
  for (const FormatClaim& claim : format_claims()) {
    const texel::FormatDesc& format = texel::format_desc(claim.format);
    const bool shared =
        claim.properties.linearTilingFeatures != 0 && !format.is_depth_stencil() && !format.is_compressed();
    VkDrmFormatModifierPropertiesEXT found{};
    EXPECT_EQ(modifiers(claim.format, nullptr), shared ? 1u : 0u) << format.name;
    EXPECT_EQ(modifiers(claim.format, &found), shared ? 1u : 0u) << format.name;
    if (!shared) continue;
    EXPECT_EQ(found.drmFormatModifier, kLinear);
    EXPECT_EQ(found.drmFormatModifierPlaneCount, format.plane_count) << format.name;
    EXPECT_EQ(found.drmFormatModifierTilingFeatures, claim.properties.linearTilingFeatures) << format.name;
  }
}

TEST_F(DrmModifier, WideFeaturesAreThoseOfLinearTiling) {
  VkDrmFormatModifierProperties2EXT found{};
  auto list = make_struct<VkDrmFormatModifierPropertiesList2EXT>();
  list.drmFormatModifierCount = 1;
  list.pDrmFormatModifierProperties = &found;
  auto wide = make_struct<VkFormatProperties3>(&list);
  auto properties = make_struct<VkFormatProperties2>(&wide);
  VK_GET(instance, GetPhysicalDeviceFormatProperties2)(physical_device, VK_FORMAT_R8G8B8A8_UNORM, &properties);
  EXPECT_EQ(list.drmFormatModifierCount, 1u);
  EXPECT_EQ(found.drmFormatModifierTilingFeatures, wide.linearTilingFeatures);
}

TEST_F(DrmModifier, PropertiesOfImagesFollowTheModifier) {
  auto info = make_struct<VkPhysicalDeviceImageFormatInfo2>();
  info.format = VK_FORMAT_B8G8R8A8_UNORM;
  info.type = VK_IMAGE_TYPE_2D;
  info.tiling = VK_IMAGE_TILING_DRM_FORMAT_MODIFIER_EXT;
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  VkImageFormatProperties out{};
  EXPECT_EQ(ask(info, kLinear, out), VK_SUCCESS);
  EXPECT_EQ(out.maxMipLevels, 1u);
  EXPECT_EQ(out.sampleCounts, VkSampleCountFlags{VK_SAMPLE_COUNT_1_BIT});
  for (const std::uint64_t other : {kInvalid, kOfAnotherVendor})
    EXPECT_EQ(ask(info, other, out), VK_ERROR_FORMAT_NOT_SUPPORTED);
  auto plain = make_struct<VkImageFormatProperties2>();
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceImageFormatProperties2)(physical_device, &info, &plain),
            VK_ERROR_FORMAT_NOT_SUPPORTED)
      << "no modifier is named";
  info.type = VK_IMAGE_TYPE_3D;
  EXPECT_EQ(ask(info, kLinear, out), VK_ERROR_FORMAT_NOT_SUPPORTED);
  info.type = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_D32_SFLOAT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  EXPECT_EQ(ask(info, kLinear, out), VK_ERROR_FORMAT_NOT_SUPPORTED);
  info.format = kNv12;
  info.flags = VK_IMAGE_CREATE_DISJOINT_BIT;
  EXPECT_EQ(ask(info, kLinear, out), VK_SUCCESS);
}

TEST_F(DrmModifier, ListsHaveToNameTheLinearOne) {
  const std::uint64_t with[] = {kOfAnotherVendor, kLinear}, without[] = {kOfAnotherVendor, kInvalid};
  auto list = make_struct<VkImageDrmFormatModifierListCreateInfoEXT>();
  list.drmFormatModifierCount = 2;
  list.pDrmFormatModifiers = with;
  const VkImageCreateInfo info = image_info(VK_FORMAT_R8G8B8A8_UNORM, {20, 5}, &list);
  VkImage image = VK_NULL_HANDLE;
  ASSERT_EQ(create(info, &image), VK_SUCCESS);
  auto properties = make_struct<VkImageDrmFormatModifierPropertiesEXT>();
  properties.drmFormatModifier = 1;
  EXPECT_EQ(VK_GET(instance, GetImageDrmFormatModifierPropertiesEXT)(device, image, &properties), VK_SUCCESS);
  EXPECT_EQ(properties.drmFormatModifier, kLinear);
  const VkSubresourceLayout layout = layout_of(image, VK_IMAGE_ASPECT_MEMORY_PLANE_0_BIT_EXT);
  EXPECT_EQ(layout.offset, 0u);
  EXPECT_EQ(layout.rowPitch, 128u);
  list.pDrmFormatModifiers = without;
  EXPECT_EQ(create(info, &image), VK_ERROR_INVALID_DRM_FORMAT_MODIFIER_PLANE_LAYOUT_EXT);
  const VkImageCreateInfo nothing = image_info(VK_FORMAT_R8G8B8A8_UNORM, {20, 5}, nullptr);
  EXPECT_EQ(create(nothing, &image), VK_ERROR_INVALID_DRM_FORMAT_MODIFIER_PLANE_LAYOUT_EXT);
}

TEST_F(DrmModifier, PlanesLieWhereTheyAreWanted) {
  const VkImage image = make_exact(kNv12, {34, 6}, {{1024, 0, 192, 0, 0}, {256, 0, 128, 0, 0}});
  ASSERT_NE(image, VkImage{});
  const VkSubresourceLayout luma = layout_of(image, VK_IMAGE_ASPECT_MEMORY_PLANE_0_BIT_EXT);
  const VkSubresourceLayout chroma = layout_of(image, VK_IMAGE_ASPECT_MEMORY_PLANE_1_BIT_EXT);
  EXPECT_EQ(luma.offset, 1024u);
  EXPECT_EQ(luma.rowPitch, 192u);
  EXPECT_EQ(luma.size, 6u * 192);
  EXPECT_EQ(chroma.offset, 256u);
  EXPECT_EQ(chroma.rowPitch, 128u);
  EXPECT_EQ(chroma.size, 3u * 128);
  VkMemoryRequirements needs;
  VK_GET(instance, GetImageMemoryRequirements)(device, image, &needs);
  EXPECT_EQ(needs.size, 1024u + 6 * 192);
  const VkImage layers = make_exact(VK_FORMAT_R8_UNORM, {10, 4}, {{64, 0, 64, 1024, 0}}, kLinear, 3);
  ASSERT_NE(layers, VkImage{});
  EXPECT_EQ(layout_of(layers, VK_IMAGE_ASPECT_MEMORY_PLANE_0_BIT_EXT, 2).offset, 64u + 2 * 1024);
}

TEST_F(DrmModifier, PlacesThatCannotBeAreErrors) {
  constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM;
  constexpr VkExtent2D kExtent{20, 5};
  constexpr VkDeviceSize kHuge = ~VkDeviceSize{0} / 64 * 64;
  ASSERT_NE(make_exact(kColour, kExtent, {{0, 0, 128, 0, 0}}), VkImage{});
  const VkSubresourceLayout wrong[] = {
      {0, 0, 64, 0, 0},       // rows overlap
      {0, 0, 0, 0, 0},        // all rows are one
      {0, 0, 100, 0, 0},      // rows that begin anywhere
      {4, 0, 128, 0, 0},      // a plane that does
      {kHuge, 0, 128, 0, 0},  // beyond every memory
      {0, 0, kHuge, 0, 0},   {kHuge, 0, kHuge, 0, 0},
  };
  for (const VkSubresourceLayout& layout : wrong) EXPECT_EQ(make_exact(kColour, kExtent, {layout}), VkImage{});
  EXPECT_EQ(make_exact(kColour, kExtent, {}), VkImage{});
  EXPECT_EQ(make_exact(kColour, kExtent, {{0, 0, 128, 0, 0}, {1024, 0, 128, 0, 0}}), VkImage{});
  EXPECT_EQ(make_exact(kNv12, kExtent, {{0, 0, 64, 0, 0}}), VkImage{});
  EXPECT_EQ(make_exact(kColour, kExtent, {{0, 0, 128, 0, 0}}, kOfAnotherVendor), VkImage{});
  EXPECT_EQ(make_exact(kColour, kExtent, {{0, 0, 128, 0, 0}}, kLinear, 1, 2), VkImage{}) << "levels";
  EXPECT_EQ(make_exact(kColour, kExtent, {{0, 0, 128, 0, 0}}, kLinear, 2), VkImage{}) << "layers overlap";
  EXPECT_EQ(make_exact(kColour, kExtent, {{0, 0, 128, kHuge, 0}}, kLinear, 3), VkImage{});
  EXPECT_EQ(make_exact(VK_FORMAT_D32_SFLOAT, kExtent, {{0, 0, 128, 0, 0}}), VkImage{});
}

TEST_F(DrmModifier, ImagesDoNotFitIntoMemoryThatEndsBeforeThem) {
  const VkImage image = make_exact(VK_FORMAT_R8G8B8A8_UNORM, {20, 5}, {{kMemory - 4 * 128, 0, 128, 0, 0}});
  ASSERT_NE(image, VkImage{});
  EXPECT_EQ(VK_GET(instance, BindImageMemory)(device, image, make_memory(), 0), VK_ERROR_OUT_OF_DEVICE_MEMORY);
}

/// What lies between the rows is somebody else's: a picture that is a part of a larger one leaves the rest alone.
TEST_F(DrmModifier, CommandsLeaveWhatLiesBetweenTheRows) {
  constexpr VkExtent2D kExtent{19, 9};
  constexpr VkDeviceSize kOffset = 4096 + 64, kPitch = 320;
  const VkImage image = make_exact(VK_FORMAT_R8G8B8A8_UNORM, kExtent, {{kOffset, 0, kPitch, 0, 0}});
  ASSERT_NE(image, VkImage{});
  const VkDeviceMemory memory = make_memory();
  ASSERT_EQ(VK_GET(instance, BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
  std::uint8_t* const bytes = map(memory);
  std::memset(bytes, 0xab, kMemory);
  run([&](VkCommandBuffer commands) {
    const VkClearColorValue value{{1.0f, 0.0f, 0.0f, 1.0f}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VK_GET(instance, CmdClearColorImage)(commands, image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
  });
  for (VkDeviceSize at = 0; at < kMemory; ++at) {
    const bool behind = at >= kOffset;
    const VkDeviceSize row = behind ? (at - kOffset) / kPitch : 0, column = behind ? (at - kOffset) % kPitch : 0;
    const bool inside = behind && row < kExtent.height && column < kExtent.width * 4;
    const bool zero = column % 4 == 1 || column % 4 == 2;
    ASSERT_EQ(bytes[at], inside ? (zero ? 0 : 255) : 0xab) << at;
  }
}

/// The planes of a picture that another device has written to a dma-buf.
TEST_F(DrmModifier, PlanesOfAnImportedPictureAreRead) {
  auto exported = make_struct<VkExportMemoryAllocateInfo>();
  exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT;
  auto get = make_struct<VkMemoryGetFdInfoKHR>();
  get.memory = make_memory(&exported);
  get.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT;
  int descriptor = -1;
  ASSERT_EQ(VK_GET(instance, GetMemoryFdKHR)(device, &get, &descriptor), VK_SUCCESS);
  void* const pixels = mmap(nullptr, kMemory, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  ASSERT_NE(pixels, MAP_FAILED);
  auto* const bytes = static_cast<std::uint8_t*>(pixels);
  for (VkDeviceSize i = 0; i < kMemory; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  auto import = make_struct<VkImportMemoryFdInfoKHR>();
  import.handleType = get.handleType;
  import.fd = descriptor;
  const VkDeviceMemory imported = make_memory(&import);
  constexpr VkExtent2D kExtent{34, 6};
  constexpr VkDeviceSize kLuma = 1024, kLumaPitch = 192, kChroma = 256, kChromaPitch = 128;
  const VkImage image = make_exact(kNv12, kExtent, {{kLuma, 0, kLumaPitch, 0, 0}, {kChroma, 0, kChromaPitch, 0, 0}});
  ASSERT_NE(image, VkImage{});
  ASSERT_EQ(VK_GET(instance, BindImageMemory)(device, image, imported, 0), VK_SUCCESS);
  const VkDeviceMemory memory[2] = {make_memory(), make_memory()};
  const VkBuffer seen[2] = {make_buffer(memory[0]), make_buffer(memory[1])};
  run([&](VkCommandBuffer commands) {
    whole_image(commands, image, seen[0], VK_IMAGE_ASPECT_PLANE_0_BIT, kExtent);
    whole_image(commands, image, seen[1], VK_IMAGE_ASPECT_PLANE_1_BIT, {kExtent.width / 2, kExtent.height / 2});
  });
  const std::uint8_t *const luma = map(memory[0]), *const chroma = map(memory[1]);
  for (std::uint32_t y = 0; y < kExtent.height; ++y)
    EXPECT_EQ(std::memcmp(luma + y * 34, bytes + kLuma + y * kLumaPitch, 34), 0) << y;
  for (std::uint32_t y = 0; y < kExtent.height / 2; ++y)
    EXPECT_EQ(std::memcmp(chroma + y * 34, bytes + kChroma + y * kChromaPitch, 34), 0) << y;
  munmap(pixels, kMemory);
}

/// Planes with memory of their own name it by MEMORY_PLANE aspects.
TEST_F(DrmModifier, DisjointPlanesAreBoundByTheirMemoryPlanes) {
  const VkSubresourceLayout places[2] = {{128, 0, 64, 0, 0}, {64, 0, 64, 0, 0}};
  auto exact = make_struct<VkImageDrmFormatModifierExplicitCreateInfoEXT>();
  exact.drmFormatModifierPlaneCount = 2;
  exact.pPlaneLayouts = places;
  VkImageCreateInfo info = image_info(kNv12, {8, 4}, &exact);
  info.flags = VK_IMAGE_CREATE_DISJOINT_BIT;
  VkImage image = VK_NULL_HANDLE;
  ASSERT_EQ(create(info, &image), VK_SUCCESS);
  constexpr VkImageAspectFlagBits kPlanes[2] = {VK_IMAGE_ASPECT_MEMORY_PLANE_0_BIT_EXT,
                                                VK_IMAGE_ASPECT_MEMORY_PLANE_1_BIT_EXT};
  constexpr VkDeviceSize kSizes[2] = {128 + 4 * 64, 64 + 2 * 64};
  std::array<VkBindImagePlaneMemoryInfo, 2> planes;
  std::array<VkBindImageMemoryInfo, 2> binds;
  for (std::uint32_t i = 0; i < 2; ++i) {
    auto plane = make_struct<VkImagePlaneMemoryRequirementsInfo>();
    plane.planeAspect = kPlanes[i];
    auto asked = make_struct<VkImageMemoryRequirementsInfo2>(&plane);
    asked.image = image;
    auto needs = make_struct<VkMemoryRequirements2>();
    VK_GET(instance, GetImageMemoryRequirements2)(device, &asked, &needs);
    EXPECT_EQ(needs.memoryRequirements.size, kSizes[i]);
    planes[i] = make_struct<VkBindImagePlaneMemoryInfo>();
    planes[i].planeAspect = kPlanes[i];
    binds[i] = make_struct<VkBindImageMemoryInfo>(&planes[i]);
    binds[i].image = image;
    binds[i].memory = make_memory();
    binds[i].memoryOffset = 1024;
    std::memset(map(binds[i].memory), 1 + static_cast<int>(i), kMemory);
  }
  ASSERT_EQ(VK_GET(instance, BindImageMemory2)(device, 2, binds.data()), VK_SUCCESS);
  const VkDeviceMemory memory = make_memory();
  const VkBuffer seen = make_buffer(memory);
  for (const auto& [aspect, value] : {std::pair{VK_IMAGE_ASPECT_PLANE_0_BIT, 1}, {VK_IMAGE_ASPECT_PLANE_1_BIT, 2}}) {
    run([&, plane = aspect](VkCommandBuffer commands) {
      whole_image(commands, image, seen, static_cast<VkImageAspectFlags>(plane), {4, 2});
    });
    EXPECT_EQ(map(memory)[0], value);
  }
}

}  // namespace
}  // namespace vitrine::icd::test
