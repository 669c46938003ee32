// Image instructions on views that they were not made for, which no valid application has: every dimension on every
// kind of view, of formats that the instruction does not expect. Nothing is read or written outside of the image.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kLayers = 6;
constexpr std::uint32_t kSize = 4;
constexpr std::byte kGuard{0x5a};
constexpr std::size_t kGuardBytes = 1 << 16;

constexpr VkImageViewType kViews[] = {
    VK_IMAGE_VIEW_TYPE_1D,       VK_IMAGE_VIEW_TYPE_2D,       VK_IMAGE_VIEW_TYPE_3D,        VK_IMAGE_VIEW_TYPE_CUBE,
    VK_IMAGE_VIEW_TYPE_1D_ARRAY, VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_IMAGE_VIEW_TYPE_CUBE_ARRAY};
constexpr VkFormat kFormats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R8_UINT,  VK_FORMAT_R8G8B8A8_UNORM,
                                 VK_FORMAT_D32_SFLOAT, VK_FORMAT_R32_UINT, VK_FORMAT_BC1_RGBA_UNORM_BLOCK,
                                 VK_FORMAT_R16_SFLOAT, VK_FORMAT_R64_UINT};

/// An image with a view of all of it, and bytes behind it that must stay.
struct Picture {
  std::vector<std::byte> memory;
  texel::ImageLayout layout;
  texel::ImageView view;

  Picture(VkImageViewType type, VkFormat format, std::uint32_t samples) {
    texel::ImageDesc desc;
    const bool one = type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    desc.type = one ? VK_IMAGE_TYPE_1D : type == VK_IMAGE_VIEW_TYPE_3D ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    desc.format = format;
    desc.extent = {kSize, one ? 1 : kSize, type == VK_IMAGE_VIEW_TYPE_3D ? kSize : 1};
    desc.levels = samples == 1 ? 2 : 1;
    desc.samples = samples;
    const bool single = type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_2D || type == VK_IMAGE_VIEW_TYPE_3D;
    desc.layers = single ? 1 : kLayers;
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    memory.assign(layout.size + kGuardBytes, kGuard);
    texel::ImageViewDesc view_desc;
    view_desc.type = type;
    view_desc.format = format;
    view_desc.aspect = format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    view_desc.level_count = desc.levels;
    view_desc.layer_count = desc.layers;
    view = texel::make_image_view(layout, memory.data(), view_desc);
  }

  bool is_guard_intact() const {
    return std::all_of(memory.end() - kGuardBytes, memory.end(), [](std::byte b) { return b == kGuard; });
  }
};

std::unique_ptr<Shader> shader_of(const std::string& declaration, const std::string& statement) {
  const std::string text =
      "layout(location=0) in vec4 p;\nlayout(location=0) out vec4 color;\n"
      "layout(set=0,binding=0" +
      declaration + " r;\nvoid main() {\n  vec4 v = vec4(0);\n  " + statement + "\n  color = v;\n}\n";
  auto shader = compile(compile_glsl(VK_SHADER_STAGE_FRAGMENT_BIT, text), options_for(VK_SHADER_STAGE_FRAGMENT_BIT));
  EXPECT_TRUE(shader) << shader.message() << text;
  return shader ? shader.take() : nullptr;
}

void run(const Shader& shader, const Descriptor& descriptor) {
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  Fault fault;
  const BoundShader bound(shader, table, fault);
  WaveRunner runner;
  runner.bind(bound);
  for (const InterfaceSlot& slot : shader.interface().inputs)
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; lane++)
      runner.input(slot.reg).lane[lane] = 0x3e000000u + lane * 0x012345u;  // floats from 0.125 on
  runner.run(base::kAllLanes, 0);
}

/// Runs the shader on every view of every format.
void run_on_all(const Shader& shader) {
  texel::Sampler samplers[3];
  samplers[1].mag_filter = samplers[1].min_filter = VK_FILTER_LINEAR;
  samplers[1].mip_mode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  samplers[1].max_lod = 4;
  samplers[2] = samplers[1];
  samplers[2].max_anisotropy = 4;
  samplers[2].compare = true;
  samplers[2].compare_op = VK_COMPARE_OP_LESS;
  for (const VkImageViewType type : kViews)
    for (const VkFormat format : kFormats)
      for (const std::uint32_t samples : {1u, 4u}) {
        if (samples == 4 && type != VK_IMAGE_VIEW_TYPE_2D && type != VK_IMAGE_VIEW_TYPE_2D_ARRAY) continue;
        Picture picture(type, format, samples);
        for (const texel::Sampler& sampler : samplers) {
          Descriptor descriptor;
          descriptor.image = &picture.view;
          descriptor.sampler = &sampler;
          run(shader, descriptor);
          ASSERT_TRUE(picture.is_guard_intact()) << "view " << type << ", format " << format;
        }
      }
}

TEST(MismatchedViews, Sampling) {
  struct Row {
    const char *dimension, *coord, *spatial;  ///< `spatial`: without the layer
    bool gathers;
  };
  constexpr Row kRows[] = {{"1D", "p.x", "p.x", false},       {"2D", "p.xy", "p.xy", true},
                           {"3D", "p.xyz", "p.xyz", false},   {"Cube", "p.xyz", "p.xyz", true},
                           {"1DArray", "p.xy", "p.x", false}, {"2DArray", "p.xyz", "p.xy", true},
                           {"CubeArray", "p", "p.xyz", true}};
  for (const Row& row : kRows) {
    const std::string at = row.coord, spatial = row.spatial;
    std::string text = "v += texture(r, " + at + "); v += textureLod(r, " + at + ", p.w); v += textureGrad(r, " + at +
                       ", " + spatial + ", " + spatial + " * 2.0); v += vec4(textureQueryLod(r, " + spatial +
                       "), textureSize(r, 1)" + (at == "p.x" ? "" : ".x") + ", textureQueryLevels(r));";
    if (row.gathers) text += " v += textureGather(r, " + at + ", 1);";
    const auto shader = shader_of(std::string(") uniform sampler") + row.dimension, text);
    ASSERT_NE(shader, nullptr);
    run_on_all(*shader);
  }
  for (const auto& [dimension, at] : {std::pair{"2DShadow", "p.xyz"}, std::pair{"CubeShadow", "p"}}) {
    const auto shader =
        shader_of(std::string(") uniform sampler") + dimension, std::string("v += vec4(texture(r, ") + at + "));");
    ASSERT_NE(shader, nullptr);
    run_on_all(*shader);
  }
}

TEST(MismatchedViews, FetchesStoresAndAtomics) {
  const char* const kDimensions[][2] = {
      {"1D", "n.x"}, {"2D", "n.xy"}, {"3D", "n.xyz"}, {"1DArray", "n.xy"}, {"2DArray", "n.xyz"}};
  const std::string n = "ivec4 n = ivec4(p * 97.0) - 3; ";
  for (const auto& [dimension, at] : kDimensions) {
    const std::string name = dimension, coord = at;
    const auto fetch = shader_of(") uniform sampler" + name, n + "v += texelFetch(r, " + coord + ", n.w);");
    const auto access = shader_of(",r32f) uniform image" + name,
                                  n + "v += imageLoad(r, " + coord + "); imageStore(r, " + coord +
                                      ", p); v.x += float(imageSize(r)" + (name == "1D" ? "" : ".x") + ");");
    const auto atomic =
        shader_of(",r32ui) uniform uimage" + name, n + "v.x += float(imageAtomicAdd(r, " + coord + ", 5u));");
    for (const auto* shader : {&fetch, &access, &atomic})
      if (*shader != nullptr) run_on_all(**shader);
  }
  const auto samples =
      shader_of(") uniform sampler2DMS", n + "v += texelFetch(r, n.xy, n.z); v.x += float(textureSamples(r));");
  if (samples != nullptr) run_on_all(*samples);
}

/// 64-bit texels, of views that have them and of others.
constexpr char kWideTexels[] =
    "#extension GL_EXT_shader_image_int64 : require\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n";

std::string wide_accesses(const std::string& at) {
  return "i64vec4 w = imageLoad(r, " + at + "); imageStore(r, " + at + ", w + 5l); w.x += imageAtomicAdd(r, " + at +
         ", 5l) + imageAtomicCompSwap(r, " + at + ", 7l, 9l); v.x += float(w.x);";
}

std::unique_ptr<Shader> wide_shader_of(const std::string& dimension, const std::string& statement) {
  const std::string text = std::string(kWideTexels) +
                           "layout(location=0) in vec4 p;\nlayout(location=0) out vec4 color;\n"
                           "layout(set=0,binding=0,r64i) uniform i64image" +
                           dimension + " r;\nvoid main() {\n  vec4 v = vec4(0);\n  " + statement +
                           "\n  color = v;\n}\n";
  auto shader = compile(compile_glsl(VK_SHADER_STAGE_FRAGMENT_BIT, text), options_for(VK_SHADER_STAGE_FRAGMENT_BIT));
  EXPECT_TRUE(shader) << shader.message() << text;
  return shader ? shader.take() : nullptr;
}

TEST(MismatchedViews, WideTexels) {
  const char* const kDimensions[][2] = {{"1D", "n.x"},       {"2D", "n.xy"},       {"3D", "n.xyz"},
                                        {"1DArray", "n.xy"}, {"2DArray", "n.xyz"}, {"Cube", "n.xyz"}};
  for (const auto& [dimension, at] : kDimensions) {
    const auto shader = wide_shader_of(dimension, "ivec4 n = ivec4(p * 97.0) - 3; " + wide_accesses(at));
    ASSERT_NE(shader, nullptr);
    run_on_all(*shader);
  }
}

TEST(MismatchedViews, TexelBuffers) {
  const std::string n = "int n = int(p.x * 97.0) - 3; ";
  const auto fetch = shader_of(") uniform samplerBuffer", n + "v += texelFetch(r, n); v.x += float(textureSize(r));");
  const auto access = shader_of(",r32f) uniform imageBuffer", n + "v += imageLoad(r, n); imageStore(r, n, p);");
  const auto atomic = shader_of(",r32ui) uniform uimageBuffer", n + "v.x += float(imageAtomicAdd(r, n, 5u));");
  const auto wide = wide_shader_of("Buffer", n + wide_accesses("n"));
  for (const VkFormat format : kFormats) {
    const texel::FormatDesc& desc = texel::view_format_desc(format);
    constexpr std::size_t kTexels = 20;
    std::vector<std::byte> memory(kTexels * desc.block_bytes + 4096, kGuard);
    texel::BufferTexelView view;
    view.data = memory.data();
    view.count = kTexels;
    view.format = &desc;
    Descriptor descriptor;
    descriptor.texels = &view;
    for (const auto* shader : {&fetch, &access, &atomic, &wide}) {
      ASSERT_NE(*shader, nullptr);
      run(**shader, descriptor);
      const auto behind = memory.begin() + static_cast<std::ptrdiff_t>(kTexels * desc.block_bytes);
      EXPECT_TRUE(std::all_of(behind, memory.end(), [](std::byte b) { return b == kGuard; })) << format;
    }
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
