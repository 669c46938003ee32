// No lookup reads a texel that is not of its footprint: with ones there and zeros elsewhere, one comes out.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "glass/sanitize/footprint.h"

namespace vitrine::glass::sanitize::test {
namespace {

struct Shape {
  VkImageType type;
  VkImageViewType view;
  texel::Extent extent;
  std::uint32_t layers, levels;
};

constexpr Shape kShapes[] = {
    {VK_IMAGE_TYPE_1D, VK_IMAGE_VIEW_TYPE_1D, {13, 1, 1}, 1, 1},
    {VK_IMAGE_TYPE_2D, VK_IMAGE_VIEW_TYPE_2D, {16, 8, 1}, 1, 1},
    {VK_IMAGE_TYPE_2D, VK_IMAGE_VIEW_TYPE_2D, {13, 7, 1}, 1, 3},
    {VK_IMAGE_TYPE_2D, VK_IMAGE_VIEW_TYPE_2D_ARRAY, {9, 9, 1}, 3, 2},
    {VK_IMAGE_TYPE_3D, VK_IMAGE_VIEW_TYPE_3D, {8, 5, 6}, 1, 1},
    {VK_IMAGE_TYPE_2D, VK_IMAGE_VIEW_TYPE_CUBE, {16, 16, 1}, 6, 1},
};
constexpr VkSamplerAddressMode kModes[] = {
    VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE};

class FootprintTest : public ::testing::TestWithParam<Shape> {
 protected:
  FootprintTest() {
    const Shape& shape = GetParam();
    texel::ImageDesc desc;
    desc.type = shape.type;
    desc.format = VK_FORMAT_R32_SFLOAT;
    desc.extent = shape.extent;
    desc.levels = shape.levels;
    desc.layers = shape.layers;
    EXPECT_TRUE(texel::make_image_layout(desc, layout_));
    memory_.resize(layout_.size / 4 + 16);
    texel::ImageViewDesc view;
    view.type = shape.view;
    view.format = VK_FORMAT_R32_SFLOAT;
    view.level_count = shape.levels;
    view.layer_count = shape.layers;
    view_ = texel::make_image_view(layout_, reinterpret_cast<std::byte*>(memory_.data()), view);
  }

  template <class T>
  T pick(std::initializer_list<T> values) {
    return values.begin()[random_() % values.size()];
  }
  float real(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

  texel::Sampler random_sampler() {
    texel::Sampler sampler;
    sampler.mag_filter = sampler.min_filter = pick({VK_FILTER_NEAREST, VK_FILTER_LINEAR, VK_FILTER_CUBIC_EXT});
    sampler.mip_mode = pick({VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_SAMPLER_MIPMAP_MODE_LINEAR});
    for (VkSamplerAddressMode& mode : sampler.address) mode = kModes[random_() % std::size(kModes)];
    sampler.max_lod = 2;
    return sampler;
  }
  Lookup random_lookup() {
    const bool cube = GetParam().view == VK_IMAGE_VIEW_TYPE_CUBE;
    Lookup lookup;
    for (float& at : lookup.at) at = cube ? real(-1, 1) : pick({real(0, 1), real(-2, 3), real(0, 16) / 16});
    if (!cube)
      for (std::int32_t& offset : lookup.offset) offset = pick({0, 0, 1, -2});
    lookup.layer = real(0, 2);
    lookup.lod = pick({0.0f, 0.0f, 1.0f, real(0, 2)});
    lookup.gather = GetParam().type == VK_IMAGE_TYPE_2D && pick({0, 0, 1});
    return lookup;
  }
  float sample(const texel::Sampler& sampler, const Lookup& lookup) const;

  texel::ImageLayout layout_;
  std::vector<float> memory_;
  texel::ImageView view_;
  std::mt19937 random_{1};
};

float FootprintTest::sample(const texel::Sampler& sampler, const Lookup& lookup) const {
  const std::uint32_t dims = view_.type == VK_IMAGE_VIEW_TYPE_1D                                            ? 1
                             : view_.type == VK_IMAGE_VIEW_TYPE_3D || view_.type == VK_IMAGE_VIEW_TYPE_CUBE ? 3
                                                                                                            : 2;
  base::WaveRegister coord[4]{}, offset[3]{}, lod{}, result[4]{};
  texel::SampleRequest request;
  request.active = 1;
  request.quads = false;
  for (std::uint32_t c = 0; c < dims; ++c) {
    std::memcpy(&coord[c].lane[0], &lookup.at[c], 4);
    request.coord[c] = &coord[c];
    offset[c].lane[0] = static_cast<std::uint32_t>(lookup.offset[c]);
    if (view_.type != VK_IMAGE_VIEW_TYPE_CUBE) request.offset[c] = &offset[c];
  }
  if (view_.type == VK_IMAGE_VIEW_TYPE_2D_ARRAY) {
    std::memcpy(&coord[2].lane[0], &lookup.layer, 4);
    request.coord[2] = &coord[2];
  }
  request.op = lookup.gather ? texel::SampleOp::kGather : texel::SampleOp::kSample;
  request.lod_mode = lookup.gather ? texel::LodMode::kZero : texel::LodMode::kExplicit;
  std::memcpy(&lod.lane[0], &*lookup.lod, 4);
  request.lod = &lod;
  texel::sample(view_, sampler, request, result);
  float value = 0;
  std::memcpy(&value, &result[0].lane[0], 4);
  return value;
}

TEST_P(FootprintTest, HasAllTexelsThatALookupReads) {
  int known = 0;
  for (int i = 0; i < 20000; ++i) {
    const texel::Sampler sampler = random_sampler();
    const Lookup lookup = random_lookup();
    std::vector<float*> texels;
    const bool all = all_of_footprint(view_, sampler, lookup, [&](const std::byte* block) {
      texels.push_back(reinterpret_cast<float*>(const_cast<std::byte*>(block)));
      return true;
    });
    if (!all) continue;
    ++known;
    for (float* texel : texels) *texel = 1;
    ASSERT_NEAR(sample(sampler, lookup), 1, 1e-5f)
        << i << ": at " << lookup.at[0] << ", " << lookup.at[1] << ", lod " << *lookup.lod;
    for (float* texel : texels) *texel = 0;
  }
  EXPECT_GT(known, 5000);
}

TEST_P(FootprintTest, StopsAtTheFirstTexelThatIsNotWanted) {
  const texel::Sampler sampler;
  int asked = 0;
  Lookup lookup;
  lookup.at = {0.3f, 0.4f, 0.6f};
  lookup.lod = 0.0f;
  EXPECT_FALSE(all_of_footprint(view_, sampler, lookup, [&](const std::byte*) { return ++asked, false; }));
  EXPECT_EQ(asked, 1);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FootprintTest, ::testing::ValuesIn(kShapes));

}  // namespace
}  // namespace vitrine::glass::sanitize::test
