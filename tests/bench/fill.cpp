// Full-screen fills: what a pixel costs with little shading. Layers carry a depth attachment, because without one the
// reference drops hidden opaque layers of a tile.
#include "bench.h"

namespace vitrine::bench {
namespace {

constexpr std::uint32_t kWidth = 1280, kHeight = 720, kLayers = 8;
constexpr char kFlat[] = "layout(location=0) out vec4 c; void main() { c = vec4(0.2, 0.4, 0.6, 0.5); }";

struct FillSpec {
  const char* fragment = kFlat;
  bool blend = false, depth_test = false, depth_attachment = true;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  const char* vertex = cts::kFullScreenVertex;
};

double measure(Run& run, const FillSpec& fill) {
  const cts::Target target = make_screen(run, kWidth, kHeight, fill.depth_attachment, fill.samples);
  cts::GraphicsSpec spec;
  spec.vertex = fill.vertex;
  spec.fragment = fill.fragment;
  if (fill.depth_test) {
    spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
    spec.depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  }
  if (fill.blend) {
    VkPipelineColorBlendAttachmentState state{};
    state.blendEnable = VK_TRUE;
    state.srcColorBlendFactor = state.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.colorWriteMask = 0xf;
    spec.blends = {state};
  }
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  for (std::uint32_t i = 0; i < kLayers; ++i) vkCmdDraw(cmd, 3, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  return kWidth * kHeight * static_cast<double>(kLayers) / time_submissions(run, finish(cmd)) / 1e6;
}

constexpr char kVary16Vertex[] =
    "layout(location=0) out vec4 a; layout(location=1) out vec4 b; layout(location=2) out vec4 c; layout(location=3) "
    "out vec4 d;"
    "void main() { vec2 p = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);"
    " a = vec4(p, p.yx) * 0.1; b = a * 0.5; c = a.wzyx; d = a * a; gl_Position = vec4(p, 0.5, 1.0); }";
constexpr char kVary16[] =
    "layout(location=0) in vec4 a; layout(location=1) in vec4 b; layout(location=2) in vec4 c; layout(location=3) in "
    "vec4 d;"
    "layout(location=0) out vec4 o; void main() { o = a + b + c + d; }";
constexpr char kDiscard[] =
    "layout(location=0) in vec2 uv; layout(location=0) out vec4 o;"
    "void main() { if (fract(uv.x * 64.0) < 0.5) discard; o = vec4(uv, 0.0, 1.0); }";

}  // namespace

std::vector<Workload> fill_workloads() {
  const auto row = [](const char* name, FillSpec spec) {
    return Workload{name, "Mpix/s", false, [spec](Run& run) { return measure(run, spec); }};
  };
  FillSpec blend, depth, hidden, vary, discard, msaa;
  blend.blend = true;
  depth.depth_test = true;
  hidden.depth_attachment = false;
  vary.vertex = kVary16Vertex;
  vary.fragment = kVary16;
  discard.fragment = kDiscard;
  msaa.samples = VK_SAMPLE_COUNT_4_BIT;
  return {row("fill_flat", {}),     row("fill_hidden", hidden),   row("fill_blend", blend), row("fill_depth", depth),
          row("fill_vary16", vary), row("fill_discard", discard), row("fill_msaa4", msaa)};
}

}  // namespace vitrine::bench
