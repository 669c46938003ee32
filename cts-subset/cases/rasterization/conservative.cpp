// Conservative rasterization: triangles cover exactly the pixels of which they have a part. The reference does not have
// it: there each pixel looks for the triangles that it has a part of, by the theorem of separating axes in integers.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kSide = 256;

const char kVertex[] = R"(
layout(location = 0) in vec2 position;
layout(location = 0) flat out uint number;
void main() {
  number = uint(gl_VertexIndex) / 3u + 1u;
  gl_Position = vec4(position, 0.5, 1.0);
})";
const char kFragment[] = R"(
layout(location = 0) flat in uint number;
layout(location = 0) out vec4 result;
void main() { result = vec4(float(number)); })";

/// What the last triangle gives that touches the pixel. Coordinates are in 1/256 of a pixel.
std::string searching_shader(uint32_t triangles) {
  return R"(
layout(binding = 0) buffer Corners { ivec2 corner[]; };
layout(location = 0) out vec4 result;
bool is_apart(ivec2 from, ivec2 to, ivec2 center, int turn) {
  ivec2 along = (to - from) * turn, at = center - from;
  return along.x * at.y - along.y * at.x + 128 * (abs(along.x) + abs(along.y)) <= 0;
}
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * 256, center = first + 128;
  uint found = 0u;
  for (uint i = 0u; i < )" +
         std::to_string(triangles) + R"(u; ++i) {
    ivec2 a = corner[3u * i], b = corner[3u * i + 1u], c = corner[3u * i + 2u];
    int area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), turn = sign(area);
    ivec2 low = min(a, min(b, c)), high = max(a, max(b, c));
    if (turn == 0 || any(greaterThanEqual(low, first + 256)) || any(lessThanEqual(high, first))) continue;
    if (!is_apart(a, b, center, turn) && !is_apart(b, c, center, turn) && !is_apart(c, a, center, turn)) found = i + 1u;
  }
  if (found == 0u) discard;
  result = vec4(float(found));
})";
}

/// Corners inside the target, of large, small and narrow triangles, some of them on edges of pixels.
std::vector<int32_t> random_corners(Random& random, uint32_t triangles) {
  std::vector<int32_t> corners;
  constexpr uint32_t kExtent = kSide * 256;
  for (uint32_t i = 0; i < triangles; ++i) {
    const uint32_t reach = random.pick({16384u, 2048u, 700u, 90u}), grid = random.pick({1u, 1u, 128u, 256u});
    const uint32_t x = random.below(kExtent - reach + 1), y = random.below(kExtent - reach + 1);
    for (int corner = 0; corner < 3; ++corner)
      for (const uint32_t start : {x, y})
        corners.push_back(static_cast<int32_t>((start + random.below(reach)) / grid * grid));
  }
  return corners;
}

void draw_touched(Run& run, VkSampleCountFlagBits samples, bool dynamic) {
  run.require(gpus().device.has("VK_EXT_conservative_rasterization"), "VK_EXT_conservative_rasterization");
  const bool has = run.gpu.has("VK_EXT_conservative_rasterization");
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.width = target_spec.height = kSide;
  target_spec.samples = samples;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  const uint32_t triangles = 1 + random.below(40);
  const std::vector<int32_t> corners = random_corners(random, triangles);
  std::vector<float> positions;
  for (const int32_t at : corners) positions.push_back(static_cast<float>(at) / (kSide * 128.0f) - 1.0f);
  const Buffer vertices = run.buffer_of(positions);
  const Resources resources = run.resources({storage_buffer(0, run.buffer_of(corners))});
  VkPipelineRasterizationConservativeStateCreateInfoEXT state{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_CONSERVATIVE_STATE_CREATE_INFO_EXT};
  state.conservativeRasterizationMode =
      dynamic ? VK_CONSERVATIVE_RASTERIZATION_MODE_DISABLED_EXT : VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT;
  GraphicsSpec spec;
  spec.layout = resources.layout;
  spec.vertex = has ? kVertex : kFullScreenVertex;
  spec.fragment = has ? kFragment : searching_shader(triangles);
  if (has) {
    spec.floats({2});
    spec.raster.pNext = &state;
    if (dynamic) spec.dynamic.push_back(VK_DYNAMIC_STATE_CONSERVATIVE_RASTERIZATION_MODE_EXT);
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    resources.bind(cmd);
    if (has) bind_vertices(cmd, vertices);
    if (has && dynamic) CTS_COMMAND(run.gpu, CmdSetConservativeRasterizationModeEXT)
    (cmd, VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT);
    vkCmdDraw(cmd, has ? 3 * triangles : 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

CTS_RANDOM("rasterization", "random_conservative", 30) {
  draw_touched(run, VK_SAMPLE_COUNT_1_BIT, run.random.chance(0.3f));
}
CTS_RANDOM("rasterization", "random_conservative_samples", 12) {
  draw_touched(run, VK_SAMPLE_COUNT_4_BIT, run.random.chance(0.3f));
}

}  // namespace
}  // namespace vitrine::cts
