// Extended dynamic state: random pipelines of which a random part is left to commands. The static values of that part
// are wrong, so that a command without effect shows.
#include "cases/pipeline/state/dynamic_state.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

const char kFragment[] = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;
void main() { first = passed; second = passed.wzyx; })";
const char kFlatVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) flat out vec4 passed;
void main() { passed = color; gl_Position = position; })";
const char kFlatFragment[] = R"(
layout(location = 0) flat in vec4 passed;
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;
void main() { first = passed; second = passed.wzyx; })";

/// A random pipeline for two colours, and what it points to.
struct RandomPipeline {
  GraphicsSpec spec;
  VkBool32 color_writes[2];
  VkPipelineColorWriteCreateInfoEXT color_write_info{VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT};
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
  VkSampleMask sample_mask = ~0u;

  RandomPipeline(Random& random, const TargetSpec& target, const Gpu& gpu) {
    const bool multisampled = target.samples != VK_SAMPLE_COUNT_1_BIT, depth = target.depth != 0;
    rasterize(random, multisampled);
    test(random, depth);
    blend(random);
    sample(random, multisampled, gpu);
    spec.floats({4, 4});
  }
  RandomPipeline(const RandomPipeline&) = delete;

 private:
  void rasterize(Random& random, bool multisampled) {
    VkPipelineRasterizationStateCreateInfo& raster = spec.raster;
    // deviations.md, multisample-short-lines
    if (!multisampled && random.chance(0.4f))
      raster.polygonMode = random.pick({VK_POLYGON_MODE_LINE, VK_POLYGON_MODE_POINT});
    raster.cullMode = random.pick({VK_CULL_MODE_NONE, VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT});
    raster.frontFace = random.pick({VK_FRONT_FACE_CLOCKWISE, VK_FRONT_FACE_COUNTER_CLOCKWISE});
    raster.rasterizerDiscardEnable = random.chance(0.05f);
    raster.depthClampEnable = random.chance(0.3f);
    raster.depthBiasEnable = random.chance(0.3f);
    raster.depthBiasConstantFactor = 1000;
    if (both([](const auto& f) { return f.provokingVertexLast; })) {
      provoking.provokingVertexMode = static_cast<VkProvokingVertexModeEXT>(random.below(2));
      raster.pNext = &provoking;
    }
    spec.assembly.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
                                          VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN});
    spec.viewports = {{0, 0, 64, 64, random.real(0, 0.3f), random.real(0.7f, 1)}};
    spec.scissors = {{{static_cast<int32_t>(random.below(10)), static_cast<int32_t>(random.below(10))},
                      {40 + random.below(20), 40 + random.below(20)}}};
    // deviations.md, multisample-scissor
    if (multisampled) spec.scissors = {{{0, 0}, {64, 64}}};
  }
  void test(Random& random, bool depth) {
    spec.depth.depthTestEnable = depth && random.chance(0.7f);
    spec.depth.depthWriteEnable = random.chance(0.7f);
    spec.depth.depthCompareOp = static_cast<VkCompareOp>(random.below(8));
    spec.depth.stencilTestEnable = depth && random.chance(0.7f);
    for (VkStencilOpState* state : {&spec.depth.front, &spec.depth.back}) {
      const auto op = [&] { return static_cast<VkStencilOp>(random.below(8)); };
      *state = {op(), op(), op(), static_cast<VkCompareOp>(random.below(8)), 0xff, 0xff, 3};
    }
    // deviations.md, polygon-mode-facing
    if (spec.raster.polygonMode != VK_POLYGON_MODE_FILL) spec.depth.back = spec.depth.front;
  }
  void blend(Random& random) {
    const auto factor = [&] { return static_cast<VkBlendFactor>(random.below(15)); };
    const auto op = [&] { return static_cast<VkBlendOp>(random.below(5)); };
    for (int i = 0; i < 2; ++i)
      spec.blends.push_back({random.chance(0.6f), factor(), factor(), op(), factor(), factor(), op(),
                             random.chance(0.7f) ? 0xf : random.below(16)});
    for (float& constant : spec.blend.blendConstants) constant = random.unit();
    spec.blend.logicOpEnable = random.chance(0.2f);
    spec.blend.logicOp = static_cast<VkLogicOp>(random.below(16));
    if (!both([](const auto& f) { return f.colorWriteEnable; })) return;
    for (VkBool32& write : color_writes) write = random.chance(0.7f);
    color_write_info.attachmentCount = 2;
    color_write_info.pColorWriteEnables = color_writes;
    spec.blend.pNext = &color_write_info;
  }
  void sample(Random& random, bool multisampled, const Gpu& gpu) {
    if (multisampled) sample_mask = random.chance(0.5f) ? 0xf : random.below(15) + 1;
    spec.multisample.pSampleMask = &sample_mask;
    spec.multisample.alphaToCoverageEnable = random.chance(0.2f);
    spec.multisample.alphaToOneEnable = gpu.features.alphaToOne && random.chance(0.2f);
  }
};

Buffer random_vertices(Run& run, bool outside_depth) {
  std::vector<float> values;
  for (int i = 0; i < 40; ++i) {
    const float z = outside_depth ? run.random.real(-0.5f, 1.5f) : run.random.unit();
    for (const float x : {run.random.real(-1.2f, 1.2f), run.random.real(-1.2f, 1.2f), z, 1.0f}) values.push_back(x);
    for (int c = 0; c < 4; ++c) values.push_back(run.random.unit());
  }
  return run.buffer_of(values);
}

CTS_RANDOM("pipeline", "random_dynamic_state", 80) {
  run.require(run.gpu.extension_features.extendedDynamicState, "extendedDynamicState");
  run.require(run.gpu.features.independentBlend && run.gpu.features.logicOp && run.gpu.features.depthClamp &&
                  run.gpu.features.fillModeNonSolid,
              "features of Vulkan 1.0");
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_UNORM};
  if (random.chance(0.7f)) target_spec.depth = VK_FORMAT_D24_UNORM_S8_UINT;
  target_spec.samples = random.chance(0.3f) ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
  const Target target = make_target(run, target_spec);
  const bool outside = random.chance(0.3f);
  const Buffer vertices = random_vertices(run, outside);
  RandomPipeline right(random, target_spec, run.gpu);
  const bool flat = random.chance(0.4f);
  right.spec.vertex = flat ? kFlatVertex : kColorVertex;
  right.spec.fragment = flat ? kFlatFragment : kFragment;
  const DynamicState state(run, random, 0.6f, right.spec, target_spec.samples, 2);
  std::string note = "dynamic" + state.text() + "\n";
  const auto add = [&](const char* name, int64_t value) {
    note += std::string(name) + " " + std::to_string(value) + "\n";
  };
  const GraphicsSpec& all = right.spec;
  add("samples", target_spec.samples);
  add("outside the depth range", outside);
  add("flat", flat);
  add("topology", all.assembly.topology);
  add("polygon mode", all.raster.polygonMode);
  add("cull", all.raster.cullMode);
  add("depth clamp", all.raster.depthClampEnable);
  add("depth bias", all.raster.depthBiasEnable);
  add("logic op", all.blend.logicOpEnable ? all.blend.logicOp : -1);
  add("alpha to coverage", all.multisample.alphaToCoverageEnable);
  add("alpha to one", all.multisample.alphaToOneEnable);
  add("sample mask", right.sample_mask);
  add("depth test", all.depth.depthTestEnable);
  add("stencil test", all.depth.stencilTestEnable);
  run.note("state", note);
  const VkPipeline pipeline = make_pipeline(run, state.spec(), target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    state.set(cmd, vertices);
    vkCmdDraw(cmd, 36, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
