// Draws with more vertices than the device keeps at a time: their order, numbers and, in a window's format, batches of
// clipped triangles reach over the places where it cuts them.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Small triangles anywhere, some of them partly outside; the colour tells which vertex was the provoking one.
const char kVertex[] = R"(
layout(location = 0) flat out uvec2 number;
uint hash(uint x) { x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; return x ^ x >> 16; }
void main() {
  const uint at = hash(uint(gl_VertexIndex / 3 + gl_InstanceIndex * 7919)), corner = hash(uint(gl_VertexIndex));
  const vec2 centre = vec2(at & 1023u, at >> 10 & 1023u) / 400.0 - 1.28;
  gl_Position = vec4(centre + vec2(corner & 255u, corner >> 8 & 255u) / 1000.0, float(corner >> 16) / 65536.0, 1.0);
  number = uvec2(gl_VertexIndex, gl_InstanceIndex);
})";
const char kFragment[] = R"(
layout(location = 0) flat in uvec2 number;
layout(location = 0) out vec4 color;
void main() {
  color = unpackUnorm4x8(number.x * 40503u + number.y * 2654435761u + uint(gl_PrimitiveID)) * vec4(1, 1, 1, 0.25);
})";

void draw(Run& run, VkPrimitiveTopology topology, VkFormat format, uint32_t vertices, uint32_t instances) {
  // The triangles of a fan are large.
  const uint32_t size = topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN ? 12 : 100;
  Target target = make_target(run, {.colors = {format}, .width = size, .height = size});
  GraphicsSpec spec;
  spec.vertex = kVertex;
  spec.fragment = kFragment;
  spec.assembly.topology = topology;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, vertices, instances, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

constexpr VkFormat kPlain = VK_FORMAT_R8G8B8A8_UNORM, kWindow = VK_FORMAT_B8G8R8A8_UNORM;
CTS_CASE("draw", "large.list") { draw(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, kPlain, 900'001, 1); }
CTS_CASE("draw", "large.strip") { draw(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, kPlain, 400'000, 1); }
CTS_CASE("draw", "large.fan") { draw(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, kPlain, 300'000, 1); }
CTS_CASE("draw", "large.lines") { draw(run, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, kPlain, 600'000, 1); }
CTS_CASE("draw", "large.instances") { draw(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, kPlain, 9, 100'000); }
CTS_CASE("draw", "large.window_list") { draw(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, kWindow, 900'000, 1); }
CTS_CASE("draw", "large.window_strip") { draw(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, kWindow, 400'000, 1); }
CTS_CASE("draw", "large.window_instances") { draw(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, kWindow, 9, 100'000); }

}  // namespace
}  // namespace vitrine::cts
