// The methods of the textbook, each as a small scene: vertices and the state that they are drawn with. The demo program
// shows them (./run demo NAME), cts-subset compares them with the reference (textbook.NAME).
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::demo {

inline constexpr std::uint32_t kTextbookWidth = 72, kTextbookHeight = 48;  ///< pixels
inline constexpr std::uint32_t kTextureSize = 8;                           ///< texels along a side

struct TextbookVertex {
  std::array<float, 4> position, color;
  std::array<float, 2> uv{};
};

enum class Shading : std::int32_t { kSmooth, kFlat, kPerspectiveChecker, kAffineChecker, kTexture };

struct TextbookDraw {
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  std::vector<TextbookVertex> vertices;
  Shading shading = Shading::kSmooth;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  bool depth_test = false;
  bool bresenham = false;  ///< of lines
  VkBlendFactor source = VK_BLEND_FACTOR_ONE, destination = VK_BLEND_FACTOR_ZERO;
  VkViewport viewport{0, 0, kTextbookWidth, kTextbookHeight, 0, 1};
};

struct TextbookScene {
  std::string name, title;
  std::vector<TextbookDraw> draws;
};

inline constexpr std::array<float, 4> kRed{1, 0.25f, 0.2f, 1}, kGreen{0.3f, 0.9f, 0.35f, 1}, kBlue{0.3f, 0.45f, 1, 1},
    kYellow{1, 0.85f, 0.3f, 1}, kGrey{0.5f, 0.5f, 0.5f, 1};

/// A rectangle as two triangles; texture coordinates 0..1.
inline std::vector<TextbookVertex> rectangle(float x0, float y0, float x1, float y1, float z,
                                             const std::array<float, 4>& color) {
  const TextbookVertex a{{x0, y0, z, 1}, color, {0, 0}}, b{{x1, y0, z, 1}, color, {1, 0}};
  const TextbookVertex c{{x0, y1, z, 1}, color, {0, 1}}, d{{x1, y1, z, 1}, color, {1, 1}};
  return {a, b, c, c, b, d};
}

inline std::vector<TextbookVertex> rgb_triangle(float scale) {
  return {{{0, -scale, 0.5f, 1}, kRed}, {{scale, scale, 0.5f, 1}, kGreen}, {{-scale, scale, 0.5f, 1}, kBlue}};
}

/// From the centre in all eight octants: the midpoint method steps along the longer axis.
inline TextbookScene lines_scene() {
  TextbookDraw draw;
  draw.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
  draw.bresenham = true;
  constexpr int kSpokes = 24;
  for (int i = 0; i < kSpokes; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / kSpokes;
    const float c = std::cos(angle), s = std::sin(angle);
    draw.vertices.push_back({{0.15f * c, 0.2f * s, 0, 1}, i % 2 ? kYellow : kBlue});
    draw.vertices.push_back({{0.9f * c, 0.9f * s, 0, 1}, i % 2 ? kRed : kGreen});
  }
  return {"lines", "midpoint lines in all octants", {draw}};
}

inline TextbookScene edges_scene() {
  TextbookDraw draw;
  draw.vertices = rgb_triangle(0.9f);
  return {"edge-functions", "three edge functions cover, and weigh the corners' colours", {draw}};
}

/// Half of the light per triangle, added up: a hole would be black, a double white.
inline TextbookScene shared_edges_scene() {
  TextbookDraw draw;
  draw.source = draw.destination = VK_BLEND_FACTOR_ONE;
  constexpr int kSlices = 23;
  for (int i = 0; i < kSlices; ++i)
    for (const int k : {-1, i, i + 1}) {
      const float angle = 6.2831853f * static_cast<float>(k % kSlices) / kSlices;
      if (k < 0)
        draw.vertices.push_back({{0.03f, -0.02f, 0, 1}, kGrey});
      else
        draw.vertices.push_back({{0.85f * std::cos(angle), 0.9f * std::sin(angle), 0, 1}, kGrey});
    }
  return {"shared-edges", "pixels on shared edges belong to one triangle: no hole, no double", {draw}};
}

inline TextbookScene clipping_scene() {
  TextbookDraw frame, draw;
  frame.vertices = rectangle(-0.6f, -0.6f, 0.6f, 0.6f, 0, {0.16f, 0.2f, 0.28f, 1});
  draw.vertices = {{{-1.6f, 0.3f, 0.5f, 1}, kRed}, {{0.8f, -1.9f, 0.5f, 1}, kGreen}, {{1.2f, 1.5f, 0.5f, 1}, kBlue}};
  draw.viewport = {kTextbookWidth * 0.2f, kTextbookHeight * 0.2f, kTextbookWidth * 0.6f, kTextbookHeight * 0.6f, 0, 1};
  return {"clipping", "new vertices on the planes, with interpolated colours", {frame, draw}};
}

inline TextbookScene flat_scene() {
  TextbookScene scene{"flat-shading", "the provoking vertex colours the triangle; interpolation beside it", {}};
  for (const bool flat : {true, false}) {
    TextbookDraw draw;
    draw.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    draw.shading = flat ? Shading::kFlat : Shading::kSmooth;
    const std::array<float, 4> colors[] = {kRed, kGreen, kBlue, kYellow, kGrey, kRed};
    for (int i = 0; i < 6; ++i)
      draw.vertices.push_back(
          {{(flat ? -0.9f : 0.1f) + 0.16f * static_cast<float>(i), i % 2 ? 0.7f : -0.7f, 0, 1}, colors[i]});
    scene.draws.push_back(draw);
  }
  return scene;
}

inline TextbookScene perspective_scene() {
  TextbookScene scene{"perspective", "perspective-correct texture coordinates, and affine ones", {}};
  for (const bool correct : {true, false}) {
    TextbookDraw draw;
    draw.shading = correct ? Shading::kPerspectiveChecker : Shading::kAffineChecker;
    draw.vertices = rectangle(-0.9f, -0.8f, 0.9f, 0.8f, 0, correct ? kGreen : kRed);
    for (TextbookVertex& v : draw.vertices) {
      const float w = v.position[1] < 0 ? 3.0f : 1.0f;
      v.position[1] *= w;
      v.position[3] = w;
      v.position[0] = v.position[0] * 0.48f * (v.position[1] < 0 ? 1.5f : 1.0f) + (correct ? -0.5f : 0.5f) * w;
    }
    scene.draws.push_back(draw);
  }
  return scene;
}

inline TextbookScene viewport_scene() {
  TextbookScene scene{"viewport", "one triangle through four viewports: small, wide, upside down, behind", {}};
  constexpr float kW = kTextbookWidth, kH = kTextbookHeight;
  for (const VkViewport& viewport :
       {VkViewport{0, 0, kW / 4, kH / 2, 0, 1}, VkViewport{kW / 4, 0, kW * 0.75f, kH / 2, 0, 1},
        VkViewport{0, kH, kW / 2, -kH / 2, 0, 0.5f}, VkViewport{kW * 0.3f, kH / 2, kW * 0.7f, kH / 2, 0.5f, 1}}) {
    TextbookDraw draw;
    draw.vertices = rgb_triangle(0.95f);
    draw.depth_test = true;
    draw.viewport = viewport;
    scene.draws.push_back(draw);
  }
  return scene;
}

/// Columns: no culling, back faces, front faces. The upper triangle of each goes round counter-clockwise.
inline TextbookScene culling_scene() {
  TextbookScene scene{"culling", "orientation decides: cull none, back, front", {}};
  float x = -0.95f;
  for (const VkCullModeFlags cull : {VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT, VK_CULL_MODE_FRONT_BIT}) {
    TextbookDraw draw;
    draw.cull = cull;
    const float right = x + 0.5f;
    draw.vertices = {{{x, -0.9f, 0, 1}, kGreen}, {{x, -0.1f, 0, 1}, kGreen},  {{right, -0.5f, 0, 1}, kGreen},
                     {{x, 0.1f, 0, 1}, kRed},    {{right, 0.5f, 0, 1}, kRed}, {{x, 0.9f, 0, 1}, kRed}};
    scene.draws.push_back(draw);
    x += 0.68f;
  }
  return scene;
}

inline TextbookScene depth_scene() {
  TextbookDraw draw;
  draw.depth_test = true;
  draw.vertices = {
      {{-0.9f, -0.8f, 0.1f, 1}, kRed},  {{0.9f, -0.2f, 0.9f, 1}, kRed},   {{-0.7f, 0.3f, 0.2f, 1}, kRed},
      {{0.9f, -0.9f, 0.1f, 1}, kGreen}, {{0.5f, 0.8f, 0.3f, 1}, kGreen},  {{-0.9f, -0.3f, 0.9f, 1}, kGreen},
      {{-0.6f, 0.9f, 0.1f, 1}, kBlue},  {{-0.4f, -0.9f, 0.8f, 1}, kBlue}, {{0.8f, 0.6f, 0.4f, 1}, kBlue}};
  return {"depth-buffer", "triangles that pierce each other", {draw}};
}

inline TextbookScene texture_scene() {
  TextbookDraw draw;
  draw.shading = Shading::kTexture;
  draw.vertices = {{{-0.8f, -0.9f, 0, 1}, kGrey, {0, 0}}, {{0.9f, -0.5f, 0, 1}, kGrey, {1, 0}},
                   {{-0.9f, 0.7f, 0, 1}, kGrey, {0, 1}},  {{-0.9f, 0.7f, 0, 1}, kGrey, {0, 1}},
                   {{0.9f, -0.5f, 0, 1}, kGrey, {1, 0}},  {{0.6f, 0.9f, 0, 1}, kGrey, {1, 1}}};
  return {"texture-mapping", "an image of 8x8 texels over two triangles, bilinear", {draw}};
}

inline TextbookScene blending_scene() {
  TextbookScene scene{"blending", "three panes of half the opacity, one over the other", {}};
  const std::array<float, 4> colors[] = {kRed, kGreen, kBlue};
  for (int i = 0; i < 3; ++i) {
    TextbookDraw draw;
    draw.source = VK_BLEND_FACTOR_SRC_ALPHA;
    draw.destination = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    std::array<float, 4> color = colors[i];
    color[3] = 0.5f;
    const float x = -0.85f + 0.4f * static_cast<float>(i), y = i == 1 ? -0.35f : -0.85f;
    draw.vertices = rectangle(x, y, x + 0.9f, y + 1.2f, 0, color);
    scene.draws.push_back(draw);
  }
  return scene;
}

inline std::vector<TextbookScene> textbook_scenes() {
  return {lines_scene(), edges_scene(),       shared_edges_scene(), clipping_scene(),
          flat_scene(),  perspective_scene(), viewport_scene(),     culling_scene(),
          depth_scene(), texture_scene(),     blending_scene()};
}

/// RGBA8 texels of the image that kTexture reads.
inline std::vector<unsigned char> textbook_texels() {
  std::vector<unsigned char> texels;
  for (std::uint32_t y = 0; y < kTextureSize; ++y)
    for (std::uint32_t x = 0; x < kTextureSize; ++x) {
      const bool dark = ((x ^ y) & 1) != 0;
      texels.push_back(static_cast<unsigned char>(dark ? 40 : 255 - 20 * y));
      texels.push_back(static_cast<unsigned char>(dark ? 30 + 20 * x : 220));
      texels.push_back(static_cast<unsigned char>(dark ? 120 : 30 * x));
      texels.push_back(255);
    }
  return texels;
}

/// Pipeline state of one draw. Members point into each other: not to be copied.
struct TextbookState {
  explicit TextbookState(const TextbookDraw& draw) {
    assembly.topology = draw.topology;
    raster.cullMode = draw.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;
    line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    if (draw.bresenham) raster.pNext = &line;
    depth.depthTestEnable = depth.depthWriteEnable = draw.depth_test;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    blend.blendEnable = draw.destination != VK_BLEND_FACTOR_ZERO;
    blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = draw.source;
    blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = draw.destination;
    blend.colorWriteMask = 0xf;
    shading = static_cast<std::int32_t>(draw.shading);
    special.mapEntryCount = 1;
    special.pMapEntries = &entry;
    special.dataSize = sizeof shading;
    special.pData = &shading;
  }
  TextbookState(const TextbookState&) = delete;

  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineRasterizationLineStateCreateInfoEXT line{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendAttachmentState blend{};
  std::int32_t shading = 0;
  VkSpecializationMapEntry entry{0, 0, sizeof(std::int32_t)};
  VkSpecializationInfo special{};
};

}  // namespace vitrine::demo
