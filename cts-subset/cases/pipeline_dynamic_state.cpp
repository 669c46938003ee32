// Extended dynamic state: random pipelines of which a random part is left to commands. The static values of that part
// are wrong, so that a command without effect shows.
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

/// Whether both devices have it: what a case does must not depend on the device.
template <class F>
bool both(F claimed) {
  return claimed(gpus().device.extension_features) && claimed(gpus().reference.extension_features);
}

/// One piece of state: how to fix it in the pipeline, and how to set it by a command.
struct Piece {
  VkDynamicState state;
  bool available;
  std::function<void(GraphicsSpec&)> fix;
  std::function<void(VkCommandBuffer)> set;
};

/// What pieces point to, and more structures than GraphicsSpec has.
struct Values {
  VkViewport viewport;
  VkRect2D scissor;
  VkPipelineColorBlendAttachmentState blend[2];
  VkSampleMask sample_mask;
  VkBool32 color_writes[2];
  VkPipelineColorWriteCreateInfoEXT color_write_info{VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT};
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
};

class Pieces {
 public:
  Pieces(Run& run, Values& values, VkSampleCountFlagBits samples, const Buffer& vertices, bool depth)
      : run_(run), values_(values), vertices_(vertices) {
    // deviations.md, multisample-short-lines
    if (samples == VK_SAMPLE_COUNT_1_BIT && run.random.chance(0.4f))
      polygon_mode_ = run.random.pick({VK_POLYGON_MODE_LINE, VK_POLYGON_MODE_POINT});
    add_first(samples);
    add_depth_stencil(depth);
    add_second();
    add_blend();
    add_multisample(samples);
    add_vertex_input();
  }
  const std::vector<Piece>& list() const { return list_; }

 private:
  bool eds1() const {
    return both([](const auto& f) { return f.extended_dynamic_state.extendedDynamicState; });
  }
  bool eds2() const {
    return both([](const auto& f) { return f.extended_dynamic_state2.extendedDynamicState2; });
  }
  bool eds3(VkBool32 VkPhysicalDeviceExtendedDynamicState3FeaturesEXT::*member) const {
    return both([&](const auto& f) { return f.extended_dynamic_state3.*member; });
  }
  void add(VkDynamicState state, bool available, std::function<void(GraphicsSpec&)> fix,
           std::function<void(VkCommandBuffer)> set) {
    list_.push_back({state, available, std::move(fix), std::move(set)});
  }

  void add_first(VkSampleCountFlagBits samples) {
    Random& random = run_.random;
    const auto cull = random.pick({VK_CULL_MODE_NONE, VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT});
    const auto face = random.pick({VK_FRONT_FACE_CLOCKWISE, VK_FRONT_FACE_COUNTER_CLOCKWISE});
    const auto topology = random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
                                       VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN});
    const Gpu& gpu = run_.gpu;
    add(
        VK_DYNAMIC_STATE_CULL_MODE, eds1(), [=](GraphicsSpec& s) { s.raster.cullMode = cull; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetCullModeEXT)
          (c, cull);
        });
    add(
        VK_DYNAMIC_STATE_FRONT_FACE, eds1(), [=](GraphicsSpec& s) { s.raster.frontFace = face; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetFrontFaceEXT)
          (c, face);
        });
    add(
        VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY, eds1(), [=](GraphicsSpec& s) { s.assembly.topology = topology; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetPrimitiveTopologyEXT)
          (c, topology);
        });
    Values& v = values_;
    v.viewport = {0, 0, 64, 64, random.real(0, 0.3f), random.real(0.7f, 1)};
    v.scissor = {{static_cast<int32_t>(random.below(10)), static_cast<int32_t>(random.below(10))},
                 {40 + random.below(20), 40 + random.below(20)}};
    // The reference leaks samples through the edge of a scissor.
    if (samples != VK_SAMPLE_COUNT_1_BIT) v.scissor = {{0, 0}, {64, 64}};
    add(
        VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT, eds1(), [&v](GraphicsSpec& s) { s.viewports = {v.viewport}; },
        [&v, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetViewportWithCountEXT)
          (c, 1, &v.viewport);
        });
    add(
        VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT, eds1(), [&v](GraphicsSpec& s) { s.scissors = {v.scissor}; },
        [&v, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetScissorWithCountEXT)
          (c, 1, &v.scissor);
        });
  }

  void add_depth_stencil(bool depth) {
    Random& random = run_.random;
    const Gpu& gpu = run_.gpu;
    const VkBool32 test = depth && random.chance(0.7f), write = random.chance(0.7f),
                   stencil = depth && random.chance(0.7f);
    const auto compare = static_cast<VkCompareOp>(random.below(8));
    add(
        VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE, eds1(), [=](GraphicsSpec& s) { s.depth.depthTestEnable = test; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetDepthTestEnableEXT)
          (c, test);
        });
    add(
        VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE, eds1(), [=](GraphicsSpec& s) { s.depth.depthWriteEnable = write; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetDepthWriteEnableEXT)
          (c, write);
        });
    add(
        VK_DYNAMIC_STATE_DEPTH_COMPARE_OP, eds1(), [=](GraphicsSpec& s) { s.depth.depthCompareOp = compare; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetDepthCompareOpEXT)
          (c, compare);
        });
    add(
        VK_DYNAMIC_STATE_STENCIL_TEST_ENABLE, eds1(), [=](GraphicsSpec& s) { s.depth.stencilTestEnable = stencil; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetStencilTestEnableEXT)
          (c, stencil);
        });
    VkStencilOpState ops[2];
    for (VkStencilOpState& o : ops)
      o = {static_cast<VkStencilOp>(random.below(8)),
           static_cast<VkStencilOp>(random.below(8)),
           static_cast<VkStencilOp>(random.below(8)),
           static_cast<VkCompareOp>(random.below(8)),
           0xff,
           0xff,
           3};
    // deviations.md, polygon-mode-facing
    if (polygon_mode_ != VK_POLYGON_MODE_FILL) ops[1] = ops[0];
    const VkStencilOpState front = ops[0], back = ops[1];
    add(
        VK_DYNAMIC_STATE_STENCIL_OP, eds1(),
        [=](GraphicsSpec& s) {
          s.depth.front = front;
          s.depth.back = back;
        },
        [=, &gpu](VkCommandBuffer c) {
          const auto set = CTS_COMMAND(gpu, CmdSetStencilOpEXT);
          set(c, VK_STENCIL_FACE_FRONT_BIT, front.failOp, front.passOp, front.depthFailOp, front.compareOp);
          set(c, VK_STENCIL_FACE_BACK_BIT, back.failOp, back.passOp, back.depthFailOp, back.compareOp);
        });
  }

  void add_second() {
    Random& random = run_.random;
    const Gpu& gpu = run_.gpu;
    const VkBool32 discard = random.chance(0.05f), bias = random.chance(0.3f), logic = random.chance(0.2f);
    const auto op = static_cast<VkLogicOp>(random.below(16));
    const VkPolygonMode mode = polygon_mode_;
    add(
        VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE, eds2(),
        [=](GraphicsSpec& s) { s.raster.rasterizerDiscardEnable = discard; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetRasterizerDiscardEnableEXT)
          (c, discard);
        });
    add(
        VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE, eds2(),
        [=](GraphicsSpec& s) {
          s.raster.depthBiasEnable = bias;
          s.raster.depthBiasConstantFactor = 1000;
        },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetDepthBiasEnableEXT)
          (c, bias);
        });
    const bool logic_dynamic =
        both([](const auto& f) { return f.extended_dynamic_state2.extendedDynamicState2LogicOp; });
    add(
        VK_DYNAMIC_STATE_LOGIC_OP_EXT, logic_dynamic, [=](GraphicsSpec& s) { s.blend.logicOp = op; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetLogicOpEXT)
          (c, op);
        });
    using F = VkPhysicalDeviceExtendedDynamicState3FeaturesEXT;
    add(
        VK_DYNAMIC_STATE_LOGIC_OP_ENABLE_EXT, eds3(&F::extendedDynamicState3LogicOpEnable),
        [=](GraphicsSpec& s) { s.blend.logicOpEnable = logic; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetLogicOpEnableEXT)
          (c, logic);
        });
    add(
        VK_DYNAMIC_STATE_POLYGON_MODE_EXT, eds3(&F::extendedDynamicState3PolygonMode),
        [=](GraphicsSpec& s) { s.raster.polygonMode = mode; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetPolygonModeEXT)
          (c, mode);
        });
    const VkBool32 clamp = random.chance(0.3f);
    add(
        VK_DYNAMIC_STATE_DEPTH_CLAMP_ENABLE_EXT, eds3(&F::extendedDynamicState3DepthClampEnable),
        [=](GraphicsSpec& s) { s.raster.depthClampEnable = clamp; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetDepthClampEnableEXT)
          (c, clamp);
        });
  }

  void add_blend() {
    Random& random = run_.random;
    const Gpu& gpu = run_.gpu;
    Values& v = values_;
    const auto factor = [&] { return static_cast<VkBlendFactor>(random.below(15)); };
    for (VkPipelineColorBlendAttachmentState& b : v.blend)
      b = {random.chance(0.6f),
           factor(),
           factor(),
           static_cast<VkBlendOp>(random.below(5)),
           factor(),
           factor(),
           static_cast<VkBlendOp>(random.below(5)),
           random.chance(0.7f) ? 0xf : random.below(16)};
    v.color_writes[0] = random.chance(0.7f);
    v.color_writes[1] = random.chance(0.7f);
    using F = VkPhysicalDeviceExtendedDynamicState3FeaturesEXT;
    const auto fix_blend = [&v](GraphicsSpec& s, auto member) {
      s.blends.resize(2);
      for (int i = 0; i < 2; ++i) s.blends[i].*member = v.blend[i].*member;
    };
    using B = VkPipelineColorBlendAttachmentState;
    add(
        VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT, eds3(&F::extendedDynamicState3ColorBlendEnable),
        [=](GraphicsSpec& s) { fix_blend(s, &B::blendEnable); },
        [&v, &gpu](VkCommandBuffer c) {
          const VkBool32 enables[2] = {v.blend[0].blendEnable, v.blend[1].blendEnable};
          CTS_COMMAND(gpu, CmdSetColorBlendEnableEXT)(c, 0, 2, enables);
        });
    add(
        VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT, eds3(&F::extendedDynamicState3ColorBlendEquation),
        [=](GraphicsSpec& s) {
          fix_blend(s, &B::srcColorBlendFactor);
          fix_blend(s, &B::dstColorBlendFactor);
          fix_blend(s, &B::colorBlendOp);
          fix_blend(s, &B::srcAlphaBlendFactor);
          fix_blend(s, &B::dstAlphaBlendFactor);
          fix_blend(s, &B::alphaBlendOp);
        },
        [&v, &gpu](VkCommandBuffer c) {
          for (uint32_t i = 0; i < 2; ++i) {
            const B& b = v.blend[i];
            const VkColorBlendEquationEXT equation{b.srcColorBlendFactor, b.dstColorBlendFactor, b.colorBlendOp,
                                                   b.srcAlphaBlendFactor, b.dstAlphaBlendFactor, b.alphaBlendOp};
            CTS_COMMAND(gpu, CmdSetColorBlendEquationEXT)(c, i, 1, &equation);
          }
        });
    add(
        VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT, eds3(&F::extendedDynamicState3ColorWriteMask),
        [=](GraphicsSpec& s) { fix_blend(s, &B::colorWriteMask); },
        [&v, &gpu](VkCommandBuffer c) {
          const VkColorComponentFlags masks[2] = {v.blend[0].colorWriteMask, v.blend[1].colorWriteMask};
          CTS_COMMAND(gpu, CmdSetColorWriteMaskEXT)(c, 0, 2, masks);
        });
    const bool writes = both([](const auto& f) { return f.color_write_enable.colorWriteEnable; });
    v.color_write_info.attachmentCount = 2;
    v.color_write_info.pColorWriteEnables = v.color_writes;
    add(
        VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT, writes,
        [&v, writes](GraphicsSpec& s) {
          if (writes) s.blend.pNext = &v.color_write_info;
        },
        [&v, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetColorWriteEnableEXT)
          (c, 2, v.color_writes);
        });
  }

  void add_multisample(VkSampleCountFlagBits samples) {
    Random& random = run_.random;
    const Gpu& gpu = run_.gpu;
    Values& v = values_;
    using F = VkPhysicalDeviceExtendedDynamicState3FeaturesEXT;
    v.sample_mask = samples == VK_SAMPLE_COUNT_1_BIT ? ~0u : random.chance(0.5f) ? 0xf : random.below(15) + 1;
    const VkBool32 coverage = random.chance(0.2f), one = gpu.features.alphaToOne && random.chance(0.2f);
    add(
        VK_DYNAMIC_STATE_SAMPLE_MASK_EXT, eds3(&F::extendedDynamicState3SampleMask),
        [&v](GraphicsSpec& s) { s.multisample.pSampleMask = &v.sample_mask; },
        [&v, &gpu, samples](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetSampleMaskEXT)
          (c, samples, &v.sample_mask);
        });
    add(
        VK_DYNAMIC_STATE_RASTERIZATION_SAMPLES_EXT, eds3(&F::extendedDynamicState3RasterizationSamples),
        [](GraphicsSpec&) {},
        [&gpu, samples](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetRasterizationSamplesEXT)
          (c, samples);
        });
    add(
        VK_DYNAMIC_STATE_ALPHA_TO_COVERAGE_ENABLE_EXT, eds3(&F::extendedDynamicState3AlphaToCoverageEnable),
        [=](GraphicsSpec& s) { s.multisample.alphaToCoverageEnable = coverage; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetAlphaToCoverageEnableEXT)
          (c, coverage);
        });
    // Set by a command, alpha to one has another effect in the reference than in a pipeline.
    add(
        VK_DYNAMIC_STATE_ALPHA_TO_ONE_ENABLE_EXT, !one && eds3(&F::extendedDynamicState3AlphaToOneEnable),
        [=](GraphicsSpec& s) { s.multisample.alphaToOneEnable = one; },
        [=, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetAlphaToOneEnableEXT)
          (c, one);
        });
    const bool last = both([](const auto& f) { return f.provoking_vertex.provokingVertexLast; });
    v.provoking.provokingVertexMode = last && random.chance(0.5f) ? VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT
                                                                  : VK_PROVOKING_VERTEX_MODE_FIRST_VERTEX_EXT;
    add(
        VK_DYNAMIC_STATE_PROVOKING_VERTEX_MODE_EXT, last && eds3(&F::extendedDynamicState3ProvokingVertexMode),
        [&v, last](GraphicsSpec& s) {
          if (last) s.raster.pNext = &v.provoking;
        },
        [&v, &gpu](VkCommandBuffer c) {
          CTS_COMMAND(gpu, CmdSetProvokingVertexModeEXT)(c, v.provoking.provokingVertexMode);
        });
  }

  /// Either all of the vertex input, or the stride alone.
  void add_vertex_input() {
    const Gpu& gpu = run_.gpu;
    const bool all = both([](const auto& f) { return f.vertex_input_dynamic_state.vertexInputDynamicState; }) &&
                     run_.random.chance(0.5f);
    const Buffer& vertices = vertices_;
    if (all) {
      add(
          VK_DYNAMIC_STATE_VERTEX_INPUT_EXT, true,
          [](GraphicsSpec& s) {
            s.floats({4, 4});
          },
          [&gpu](VkCommandBuffer c) {
            const VkVertexInputBindingDescription2EXT binding{VK_STRUCTURE_TYPE_VERTEX_INPUT_BINDING_DESCRIPTION_2_EXT,
                                                              nullptr,
                                                              0,
                                                              32,
                                                              VK_VERTEX_INPUT_RATE_VERTEX,
                                                              1};
            VkVertexInputAttributeDescription2EXT attributes[2];
            for (uint32_t i = 0; i < 2; ++i)
              attributes[i] = {VK_STRUCTURE_TYPE_VERTEX_INPUT_ATTRIBUTE_DESCRIPTION_2_EXT,
                               nullptr,
                               i,
                               0,
                               VK_FORMAT_R32G32B32A32_SFLOAT,
                               i * 16};
            CTS_COMMAND(gpu, CmdSetVertexInputEXT)(c, 1, &binding, 2, attributes);
          });
      return;
    }
    add(
        VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE, eds1(),
        [](GraphicsSpec& s) {
          s.floats({4, 4});
        },
        [&gpu, &vertices](VkCommandBuffer c) {
          const VkDeviceSize offset = 0, stride = 32, size = vertices.size - 64;
          CTS_COMMAND(gpu, CmdBindVertexBuffers2EXT)(c, 0, 1, &vertices.handle, &offset, &size, &stride);
        });
  }

  Run& run_;
  VkPolygonMode polygon_mode_ = VK_POLYGON_MODE_FILL;
  Values& values_;
  const Buffer& vertices_;
  std::vector<Piece> list_;
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
  run.require(run.gpu.extension_features.extended_dynamic_state.extendedDynamicState, "extendedDynamicState");
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
  Values values;
  const Pieces pieces(run, values, target_spec.samples, vertices, target_spec.depth != 0);
  GraphicsSpec spec;
  const bool flat = random.chance(0.4f);
  spec.vertex = flat ? kFlatVertex : kColorVertex;
  spec.fragment = flat ? kFlatFragment : kFragment;
  VkPipelineColorBlendAttachmentState plain{};
  plain.colorWriteMask = 0xf;
  spec.blends = {plain, plain};
  spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
  std::vector<const Piece*> dynamic;
  bool dynamic_stride = false;
  std::string note;
  for (const Piece& piece : pieces.list()) {
    const bool chosen = random.chance(0.6f) && piece.available;
    if (!chosen || piece.state == VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE) piece.fix(spec);
    if (!chosen) continue;
    if (piece.state == VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE) spec.raster.depthBiasEnable = VK_FALSE;
    if (piece.state == VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE) {
      piece.fix(spec);
      spec.bindings[0].stride = 16;
      dynamic_stride = true;
    }
    dynamic.push_back(&piece);
    spec.dynamic.push_back(piece.state);
    note += std::to_string(piece.state) + "\n";
  }
  GraphicsSpec all;
  for (const Piece& piece : pieces.list()) piece.fix(all);
  const auto add = [&](const char* name, int value) { note += std::string(name) + " " + std::to_string(value) + "\n"; };
  add("samples", target_spec.samples);
  add("outside the depth range", outside);
  add("flat", flat);
  add("topology", all.assembly.topology);
  add("polygon mode", all.raster.polygonMode);
  add("cull", static_cast<int>(all.raster.cullMode));
  add("depth clamp", static_cast<int>(all.raster.depthClampEnable));
  add("depth bias", static_cast<int>(all.raster.depthBiasEnable));
  add("logic op", all.blend.logicOpEnable ? all.blend.logicOp : -1);
  add("alpha to coverage", static_cast<int>(all.multisample.alphaToCoverageEnable));
  add("alpha to one", static_cast<int>(all.multisample.alphaToOneEnable));
  add("sample mask", static_cast<int>(values.sample_mask));
  add("depth test", static_cast<int>(all.depth.depthTestEnable));
  add("stencil test", static_cast<int>(all.depth.stencilTestEnable));
  run.note("state", note);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    if (!dynamic_stride) bind_vertices(cmd, vertices);
    for (const Piece* piece : dynamic) piece->set(cmd);
    vkCmdDraw(cmd, 36, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
