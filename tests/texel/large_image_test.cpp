// Images of the largest sizes, whose texels lie beyond what 32 bits address. Memory is reserved, and touched at a few
// texels only.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cmath>

#include "base/numeric.h"
#include "texel/sampler.h"

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;

constexpr std::uint32_t kSide = 32768;  ///< texels, maxImageDimensionCube

class LargeCube : public ::testing::TestWithParam<VkFormat> {
 protected:
  void SetUp() override {
    ImageDesc desc;
    desc.format = GetParam();
    desc.extent = {kSide, kSide, 1};
    desc.layers = 6;
    ASSERT_TRUE(make_image_layout(desc, layout));
    void* reserved =
        mmap(nullptr, layout.size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (reserved == MAP_FAILED) GTEST_SKIP() << "no address space";
    memory = static_cast<std::byte*>(reserved);
    ImageViewDesc view_desc;
    view_desc.type = VK_IMAGE_VIEW_TYPE_CUBE;
    view_desc.format = GetParam();
    view_desc.layer_count = 6;
    view = make_image_view(layout, memory, view_desc);
  }
  void TearDown() override {
    if (memory != nullptr) munmap(memory, layout.size);
  }

  ImageLayout layout;
  std::byte* memory = nullptr;
  ImageView view;
};

/// A marked texel of each face is found, and no other is: nearest samples of its centre and of the centre beside it.
TEST_P(LargeCube, TexelsNearTheEndOfEveryFaceAreFound) {
  for (std::uint32_t face = 0; face < 6; ++face) {
    *view.block(0, face, 0, kSide - 3, kSide - 2, 0) = static_cast<std::byte>(40 + face);
  }
  Sampler sampler;
  sampler.address.fill(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  // Face coordinates to directions: "Cube Map Face Selection" (Vulkan 1.3.239), with an axis of length one.
  for (std::uint32_t face = 0; face < 6; ++face) {
    for (const std::uint32_t x : {kSide - 3, kSide - 5}) {
      const float sc = (static_cast<float>(x) + 0.5f) / (kSide / 2) - 1.0f;
      const float tc = (static_cast<float>(kSide - 2) + 0.5f) / (kSide / 2) - 1.0f;
      const float directions[6][3] = {{1, -tc, -sc}, {-1, -tc, sc}, {sc, 1, tc},
                                      {sc, -1, -tc}, {sc, -tc, 1},  {-sc, -tc, -1}};
      base::WaveRegister coord[3], result[4];
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::uint32_t& lane : coord[c].lane) lane = bits_of(directions[face][c]);
      }
      SampleRequest request;
      request.lod_mode = LodMode::kZero;
      request.coord = {&coord[0], &coord[1], &coord[2], nullptr};
      sample(view, sampler, request, result);
      const float expected = x == kSide - 3 ? static_cast<float>(40 + face) : 0.0f;
      EXPECT_EQ(std::round(float_of(result[0].lane[7]) * (GetParam() == VK_FORMAT_R8_SNORM ? 127.0f : 255.0f)),
                expected)
          << "face " << face << " x " << x;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, LargeCube,
                         ::testing::Values(VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8_SNORM));

}  // namespace
}  // namespace vitrine::texel
