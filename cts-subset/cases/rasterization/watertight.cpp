// Meshes with shared edges cover every sample exactly once, whatever their triangles' size; and input at the limits.
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// A grid whose inner vertices are moved by up to 0.24 cells, so that no triangle turns over, and whose border is the
/// viewport's; each cell is cut along one of its diagonals.
struct Mesh {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

Mesh random_mesh(Random& random, uint32_t columns, uint32_t rows) {
  Mesh mesh;
  for (uint32_t y = 0; y <= rows; ++y)
    for (uint32_t x = 0; x <= columns; ++x) {
      const auto place = [&](uint32_t cell, uint32_t cells) {
        const bool border = cell == 0 || cell == cells;
        const float at = static_cast<float>(cell) + (border ? 0.0f : random.real(-0.24f, 0.24f));
        return border ? (cell == 0 ? -1.0f : 1.0f) : at / static_cast<float>(cells) * 2.0f - 1.0f;
      };
      mesh.positions.push_back(place(x, columns));
      mesh.positions.push_back(place(y, rows));
    }
  for (uint32_t y = 0; y < rows; ++y)
    for (uint32_t x = 0; x < columns; ++x) {
      const uint32_t a = y * (columns + 1) + x, b = a + 1, c = a + columns + 1, d = c + 1;
      const uint32_t falling[] = {a, b, d, a, d, c}, rising[] = {a, b, c, c, b, d};
      const uint32_t* corners = random.chance(0.5f) ? falling : rising;
      mesh.indices.insert(mesh.indices.end(), corners, corners + 6);
    }
  return mesh;
}

/// Every triangle adds 1 to each channel of 8 bits.
CTS_RANDOM("rasterization", "watertight", 8) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.width = 32 + random.below(300);
  target_spec.height = 32 + random.below(300);
  if (random.chance(0.4f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  Target target = make_target(run, target_spec);
  target.clears[0] = {};
  GraphicsSpec spec;
  spec.vertex = "layout(location = 0) in vec2 position;\nvoid main() { gl_Position = vec4(position, 0.5, 1.0); }\n";
  spec.fragment = "layout(location = 0) out vec4 result;\nvoid main() { result = vec4(1.0 / 255.0); }\n";
  spec.floats({2});
  spec.blends = {{VK_TRUE, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD, VK_BLEND_FACTOR_ONE,
                  VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD, 0xf}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const uint32_t columns = random.pick({1u, 7u, 40u, 150u, 300u}), rows = random.pick({1u, 3u, 40u, 200u, 300u});
  const Mesh mesh = random_mesh(random, columns, rows);
  const Buffer vertices = run.buffer_of(mesh.positions), indices = run.buffer_of(mesh.indices);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(cmd, static_cast<uint32_t>(mesh.indices.size()), 1, 0, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("coverage", target.colors[0]);
  run.may_be_blank();
  const Output& output = run.outputs.back();
  uint32_t wrong = 0;
  if (target_spec.samples == VK_SAMPLE_COUNT_1_BIT) {
    for (const unsigned char count : output.bytes) wrong += count != 1;
  } else {
    for (size_t at = 0; at < output.bytes.size(); at += 4) {
      float value;
      std::memcpy(&value, &output.bytes[at], 4);
      wrong += std::lround(value * 255.0f) != 1;
    }
  }
  if (wrong != 0) throw std::runtime_error(std::to_string(wrong) + " holes or doubles");
}

/// Clip coordinates of one vertex that no honest program has. `finite`: neither w nor the window coordinates become
/// infinite or NaN, and clipping does not overflow, so that it is defined what is drawn.
std::array<float, 4> extreme_position(Random& random, float chance, bool finite) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float big = finite ? 0x1p30f : 1e38f;
  std::array<float, 4> position = {random.real(-1.2f, 1.2f), random.real(-1.2f, 1.2f), random.real(-0.2f, 1.2f), 1.0f};
  for (float& v : position)
    if (random.chance(chance))
      v = random.pick({0.0f, -0.0f, 0x1p30f, -0x1p30f, 0x1p-30f, big, -big, 1e-40f, -1.0f, 32768.0f, infinity,
                       -infinity, std::numeric_limits<float>::quiet_NaN()});
  auto& [x, y, z, w] = position;
  if (!finite) return position;
  w = std::min(std::max(w, -1.0f), big);  // keeps NaN
  const bool at_eye = std::fabs(x) < 0x1p-100f && std::fabs(y) < 0x1p-100f && std::fabs(w) < 0x1p-100f;
  if (at_eye) x = 1.0f;
  return position;
}

void draw_extreme_positions(Run& run, bool finite) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.raster.depthClampEnable = random.chance(0.3f);
  spec.assembly.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
                                        VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, VK_PRIMITIVE_TOPOLOGY_LINE_LIST});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  spec.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  const VkPipeline cover = make_pipeline(run, spec, target);
  std::vector<float> values;
  const float chance = random.pick({0.03f, 0.1f, 0.3f});
  for (int i = 0; i < 64; ++i) {
    std::array<float, 4> position = extreme_position(random, chance, finite);
    // The last four are those of `cover`.
    if (i >= 60) position = {i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, 0.5f, 1.0f};
    values.insert(values.end(), position.begin(), position.end());
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 60, 1, 0, 0);
    vkCmdDraw(cmd, 0, 1, 0, 0);
    vkCmdDraw(cmd, 60, 0, 0, 0);
    vkCmdDraw(cmd, 2, 1, 0, 0);
    if (!finite) {
      bind_pipeline(cmd, cover);
      vkCmdDraw(cmd, 4, 1, 60, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  if (finite) run.may_be_blank();
}

CTS_RANDOM("clipping", "extreme_positions", 40) { draw_extreme_positions(run, true); }
/// What these draw is undefined (deviations.md, wrapped-coordinates and clipped-denormals), and is covered before it is
/// looked at.
CTS_RANDOM("clipping", "undefined_positions", 20) { draw_extreme_positions(run, false); }

/// Triangles thinner than the grid of snapped positions, with corners in a row, and with corners that are the same.
CTS_RANDOM("rasterization", "random_slivers", 20) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  if (random.chance(0.3f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.raster.cullMode = random.chance(0.2f) ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  constexpr uint32_t kCount = 150;
  // Clipped ones change how the reference culls the others (deviations.md, neighbour-culling).
  const float reach = spec.raster.cullMode != VK_CULL_MODE_NONE || random.chance(0.5f) ? 0.9f : 1.3f;
  std::vector<float> values;
  for (uint32_t i = 0; i < kCount; i += 3) {
    const float x = random.real(-reach, reach), y = random.real(-reach, reach), w = random.real(0.5f, 2.0f);
    const float dx = random.real(-1, 1) * reach - x, dy = random.real(-1, 1) * reach - y, along = random.real(0, 1);
    // In pixels of 1/32: on the line, less than a step of 1/256 beside it, and some steps.
    const float beside = random.pick({0.0f, 0x1p-20f, 0x1p-14f, 0x1p-12f, 0x1p-8f}) * random.real(-1, 1);
    const bool same = random.chance(0.1f);
    const float corner[3][2] = {
        {x, y}, {x + dx, y + dy}, {same ? x : x + along * dx - beside * dy, same ? y : y + along * dy + beside * dx}};
    for (const auto& at : corner) {
      for (const float v : {at[0] * w, at[1] * w, 0.5f * w, w}) values.push_back(v);
      for (int c = 0; c < 4; ++c) values.push_back(random.unit());
    }
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, kCount, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

/// Viewports without area or with hardly any, and empty scissors; the last draw goes through one that has some.
CTS_RANDOM("rasterization", "random_thin_viewports", 20) {
  Random& random = run.random;
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.assembly.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
                                        VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP});
  spec.dynamic = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_colored_vertices(random, 24));
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    for (uint32_t i = 0; i < 4; ++i) {
      // Their edges keep away from the centres of pixels (deviations.md, viewport-scissor).
      const auto place = [&] { return static_cast<float>(random.below(60)) + random.pick({0.2f, 0.7f}); };
      const float x = place(), y = place();
      VkViewport viewport{x, y, 20, 20, 0, 1};
      VkRect2D scissor{{0, 0}, {64, 64}};
      if (i < 3) {
        viewport.width = random.pick({1e-6f, 1e-3f, 0.25f, 1.0f, 30.0f});
        viewport.height = random.pick({0.0f, 0.0f, 1e-6f, -1e-3f, 0.25f, -0.5f, 1.0f});
        if (random.chance(0.2f)) scissor.extent = {random.below(2) * 64, 0};
      }
      vkCmdSetViewport(cmd, 0, 1, &viewport);
      vkCmdSetScissor(cmd, 0, 1, &scissor);
      vkCmdDraw(cmd, 24, 1, 0, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

/// Attachments as wide or high as an image may be.
void draw_long(Run& run, uint32_t width, uint32_t height, uint32_t layers, const char* select) {
  TargetSpec target_spec;
  target_spec.width = width;
  target_spec.height = height;
  target_spec.layers = layers;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = std::string(layers > 1 ? "#extension GL_ARB_shader_viewport_layer_array : require\n" : "") +
                "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n"
                "layout(location = 0) out vec4 passed;\nvoid main() {\n  passed = color;\n"
                "  gl_Position = position;\n" +
                select + "}\n";
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values;
  for (int i = 0; i < 24; ++i) {
    for (const float v : {run.random.real(-1.1f, 1.1f), run.random.real(-1.1f, 1.1f), run.random.unit(), 1.0f})
      values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(run.random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    if (layers == 1)
      vkCmdDraw(cmd, 24, 1, 0, 0);
    else
      vkCmdDraw(cmd, 24, layers, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_CASE("rasterization", "extreme_size.wide") { draw_long(run, 16384, 5, 1, ""); }
CTS_CASE("rasterization", "extreme_size.high") { draw_long(run, 5, 16384, 1, ""); }
/// Attachments as wide and high as an image may be (1 GiB each), of which a render area in a corner or anywhere is
/// drawn: no more than that needs memory. One in 500 is drawn as a whole.
CTS_RANDOM("rasterization", "extreme_size.square", 6) {
  Random& random = run.random;
  constexpr uint32_t kSize = 16384, kArea = 192;
  TargetSpec target_spec;
  target_spec.width = target_spec.height = kSize;
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const auto place = [&] { return random.pick({0u, kSize - kArea, random.below(kSize - kArea)}); };
  const VkRect2D area{{static_cast<int32_t>(place()), static_cast<int32_t>(place())}, {kArea, kArea}};
  std::vector<float> values = random_colored_vertices(random, 6);
  for (uint32_t i = 0; i < 60; ++i) {
    const auto inside = [&](int32_t first) {
      return (static_cast<float>(first) + random.real(-20, kArea + 20)) * (2.0f / kSize) - 1;
    };
    for (const float v : {inside(area.offset.x), inside(area.offset.y), random.unit(), 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  const Buffer color = run.buffer(kArea * kArea * 4), depth = run.buffer(kArea * kArea * 4);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd, run.index % 500 == 499 ? target.rect() : area);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 66, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
    run.barrier(cmd);
    VkBufferImageCopy region{};
    region.imageOffset = {area.offset.x, area.offset.y, 0};
    region.imageExtent = {kArea, kArea, 1};
    region.imageSubresource = target.colors[0].layers();
    vkCmdCopyImageToBuffer(cmd, target.colors[0].handle, VK_IMAGE_LAYOUT_GENERAL, color.handle, 1, &region);
    region.imageSubresource = target.depth->layers();
    vkCmdCopyImageToBuffer(cmd, target.depth->handle, VK_IMAGE_LAYOUT_GENERAL, depth.handle, 1, &region);
  });
  run.out("color", color, VK_FORMAT_R8G8B8A8_UNORM);
  run.out("depth", depth, VK_FORMAT_D32_SFLOAT);
}
CTS_CASE("rasterization", "extreme_size.layers") {
  run.require(run.gpu.has("VK_EXT_shader_viewport_index_layer"), "VK_EXT_shader_viewport_index_layer");
  draw_long(run, 8, 8, 2000, "  gl_Layer = gl_InstanceIndex;\n");
}

}  // namespace
}  // namespace vitrine::cts
