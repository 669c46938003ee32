// Texels that images and texel buffers do not have, and descriptors that lead nowhere, in compute shaders.
#include "spirv/observed_command.h"
#include "tests/glass/observed.h"
#include "texel/view.h"

namespace vitrine::glass::test {
namespace {

/// An image of 4 x 4 words.
struct Image {
  Image(VkImageViewType type, std::uint32_t levels, std::uint32_t layers) {
    texel::ImageDesc desc;
    desc.format = VK_FORMAT_R32_UINT;
    desc.extent = {4, 4, 1};
    desc.levels = levels;
    desc.layers = layers;
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    words.resize(layout.size / 4 + 16);
    texel::ImageViewDesc view_desc;
    view_desc.type = type;
    view_desc.format = VK_FORMAT_R32_UINT;
    view_desc.level_count = levels;
    view_desc.layer_count = layers;
    view = texel::make_image_view(layout, reinterpret_cast<std::byte*>(words.data()), view_desc);
  }
  texel::ImageLayout layout;
  std::vector<std::uint32_t> words;
  texel::ImageView view;
};

struct Command : spirv::ObservedCommand {
  std::string resource(std::uint32_t, std::uint32_t) const override { return {}; }
};

/// Findings of `body`, run by 8 invocations over words v (binding 0), an image with two levels (1: texture, 2: storage
/// image of level 0), an image with two layers (3), a texel buffer of 8 texels (4), nothing (5), three images of which
/// the last is not there (6).
std::vector<std::string> found(const std::string& body, bool null_descriptors = false) {
  Image flat(VK_IMAGE_VIEW_TYPE_2D, 2, 1), layered(VK_IMAGE_VIEW_TYPE_2D_ARRAY, 1, 2);
  std::vector<std::uint32_t> words(64), texels(8);
  for (std::uint32_t i = 0; i < words.size(); ++i) words[i] = i;
  const texel::BufferTexelView texel_view{reinterpret_cast<std::byte*>(texels.data()), 8,
                                          &texel::format_desc(VK_FORMAT_R32_UINT)};
  spirv::Descriptor descriptors[9];
  descriptors[0].data = reinterpret_cast<std::byte*>(words.data());
  descriptors[0].size = words.size() * 4;
  descriptors[1].image = descriptors[2].image = descriptors[6].image = descriptors[7].image = &flat.view;
  descriptors[3].image = &layered.view;
  descriptors[4].texels = &texel_view;
  Command command;
  command.null_descriptors = null_descriptors;
  spirv::ResourceTable table;
  table.set[0] = descriptors;
  table.set_size[0] = 9;
  table.command = &command;

  spirv::SetLayoutInfo set;
  const auto add = [&](std::uint32_t binding, VkDescriptorType type, std::uint32_t count = 1) {
    spirv::BindingInfo info;
    info.binding = info.first_slot = binding;
    info.type = type;
    info.count = count;
    set.bindings.push_back(info);
  };
  add(0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  add(1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  add(2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  add(3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  add(4, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER);
  add(5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  add(6, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 3);
  return found_with(table, set, R"(#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_nonuniform_qualifier : require
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
layout(set = 0, binding = 1) uniform utexture2D t;
layout(set = 0, binding = 2, r32ui) uniform uimage2D m;
layout(set = 0, binding = 3, r32ui) uniform uimage2DArray layers;
layout(set = 0, binding = 4, r32ui) uniform uimageBuffer texels;
layout(set = 0, binding = 5) buffer N { uint nothing[]; };
layout(set = 0, binding = 6, r32ui) uniform uimage2D many[3];
void main() {
  int i = int(gl_GlobalInvocationID.x);
)" + body + "}\n");
}

using Texts = std::vector<std::string>;

TEST(SanitizeImages, FindsTexelsOutsideOfImages) {
  EXPECT_EQ(found("v[i] = texelFetch(t, ivec2(i, 0), 0).x;"),
            Texts{"out-of-bounds-image x4 at 4: load of texel (4, 0), outside of an image of 4 x 4"});
  EXPECT_EQ(found("v[i] = texelFetch(t, ivec2(i % 4, i / 4), 0).x;"), Texts{});
  EXPECT_EQ(found("imageStore(m, ivec2(0, i - 2), uvec4(1u));"),
            Texts{"out-of-bounds-image x4 at 0: store to texel (0, -2), outside of an image of 4 x 4"});
  EXPECT_EQ(found("if (i >= 2 && i < 6) imageStore(m, ivec2(0, i - 2), uvec4(1u));"), Texts{});
  EXPECT_EQ(found("imageAtomicAdd(m, ivec2(i), 1u);"),
            Texts{"out-of-bounds-image x4 at 4: atomic operation on texel (4, 4), outside of an image of 4 x 4"});
  EXPECT_EQ(found("imageAtomicAdd(m, ivec2(i / 2), 1u);"), Texts{});
}

TEST(SanitizeImages, FindsLevelsAndLayersThatAreNotThere) {
  EXPECT_EQ(found("v[i] = texelFetch(t, ivec2(i / 4), i % 3).x;"),
            Texts{"out-of-bounds-image x2 at 2: load of texel (0, 0) of level 2, outside of an image of 2 levels"});
  EXPECT_EQ(found("v[i] = texelFetch(t, ivec2(i / 4), i % 2).x;"), Texts{});
  EXPECT_EQ(found("v[i] = texelFetch(t, ivec2(i / 2, 0), 1).x;"),
            Texts{"out-of-bounds-image x4 at 4: load of texel (2, 0) of level 1, outside of an image of 2 x 2"});
  EXPECT_EQ(found("v[i] = imageLoad(layers, ivec3(0, 0, i / 3)).x;"),
            Texts{"out-of-bounds-image x2 at 6: load of texel (0, 0, 2), outside of an image of 4 x 4 x 2"});
  EXPECT_EQ(found("v[i] = imageLoad(layers, ivec3(0, 0, i / 4)).x;"), Texts{});
}

TEST(SanitizeImages, FindsTexelsOutsideOfTexelBuffers) {
  EXPECT_EQ(found("imageStore(texels, i + 3, uvec4(1u));"),
            Texts{"out-of-bounds-texel-buffer x3 at 5: store to texel (8), outside of a texel buffer of 8 texels"});
  EXPECT_EQ(found("v[i] = imageLoad(texels, i).x;"), Texts{});
}

TEST(SanitizeImages, FindsDescriptorsThatLeadNowhere) {
  EXPECT_EQ(found("nothing[0] = 1u;"), Texts{"unwritten-descriptor x8 at 0: use of a descriptor, to which nothing has "
                                             "been written"});
  EXPECT_EQ(found("nothing[0] = 1u;", true), Texts{});
  EXPECT_EQ(found("if (i == 9) nothing[0] = 1u;"), Texts{});
  EXPECT_EQ(found("v[i] = imageLoad(many[nonuniformEXT(i % 3)], ivec2(0)).x;"),
            Texts{"unwritten-descriptor x2 at 2: use of a descriptor, to which nothing has been written"});
  EXPECT_EQ(found("v[i] = imageLoad(many[nonuniformEXT(i % 2)], ivec2(0)).x;"), Texts{});
  EXPECT_EQ(found("v[i] = imageLoad(many[nonuniformEXT(i / 2)], ivec2(0)).x;", true),
            Texts{"out-of-range-descriptor x2 at 6: descriptor 3 of an array of 3"});
}

}  // namespace
}  // namespace vitrine::glass::test
