// Wraps a shader body into a whole shader of a stage and collects its results.
#include "cases/glsl/evaluate.h"

#include "harness/execute.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kInvocations = 4096;

/// The value as uvec4 of its bits.
std::string as_bits(const Variable& v) {
  std::string value = v.name;
  if (v.type.base == Base::kFloat) value = "floatBitsToUint(" + value + ")";
  if (v.type.size == 1) return "uvec4(uint(" + value + "), 0u, 0u, 0u)";
  std::string zeros;
  for (uint32_t c = v.type.size; c < 4; ++c) zeros += ", 0u";
  return "uvec4(uvec" + std::to_string(v.type.size) + "(" + value + ")" + zeros + ")";
}

std::string shader_text(Stage stage, const ShaderBody& body) {
  std::string text = stage == Stage::kCompute ? "layout(local_size_x = 64) in;\n" : "";
  if (stage == Stage::kFragment) text += "layout(location = 0) out vec4 color;\n";
  text +=
      "layout(std430, binding = 0) readonly buffer A { vec4 in_a[]; };\n"
      "layout(std430, binding = 1) readonly buffer B { vec4 in_b[]; };\n"
      "layout(std430, binding = 2) readonly buffer I { ivec4 in_i[]; };\n"
      "layout(std430, binding = 3) readonly buffer U { uvec4 in_u[]; };\n"
      "layout(std430, binding = 4) writeonly buffer R { uvec4 results[]; };\n"
      "layout(push_constant) uniform P { vec4 p; ivec4 pi; };\n" +
      body.declarations + "void main() {\n";
  if (stage == Stage::kCompute) text += "  uint id = gl_GlobalInvocationID.x;\n";
  if (stage == Stage::kVertex)
    text += "  uint id = uint(gl_VertexIndex);\n  gl_Position = vec4(0.0, 0.0, 0.5, 1.0);\n  gl_PointSize = 1.0;\n";
  if (stage == Stage::kFragment)
    text += "  uint id = uint(gl_FragCoord.x) + 64u * uint(gl_FragCoord.y);\n  color = vec4(1.0);\n";
  text += "  vec4 a = in_a[id], b = in_b[id];\n  ivec4 i = in_i[id];\n  uvec4 u = in_u[id];\n" + body.statements;
  for (size_t k = 0; k < body.results.size(); ++k)
    text += "  results[id + " + std::to_string(k * kInvocations) + "u] = " + as_bits(body.results[k]) + ";\n";
  return text + "}\n";
}

template <typename T, typename Make>
Buffer filled(Run& run, Make make) {
  std::vector<T> values(kInvocations * 4);
  for (T& value : values) value = make();
  return run.buffer_of(values);
}

void run_graphics(Run& run, Stage stage, const std::string& text, const Resources& res, const void* push) {
  const VkPhysicalDeviceFeatures& features = run.gpu.features;
  run.require(stage == Stage::kVertex ? features.vertexPipelineStoresAndAtomics : features.fragmentStoresAndAtomics,
              "stores in graphics stages");
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = stage == Stage::kVertex ? text : kFullScreenVertex;
  if (stage == Stage::kVertex) {
    spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    spec.fragment = "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n";
  } else {
    spec.fragment = text;
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    vkCmdPushConstants(cmd, res.layout, VK_SHADER_STAGE_ALL, 0, 32, push);
    vkCmdDraw(cmd, stage == Stage::kVertex ? kInvocations : 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
}

void run_compute(Run& run, const std::string& text, const Resources& res, const void* push) {
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, text));
  run.dispatch(res, pipeline, kInvocations / 64, std::span(static_cast<const std::byte*>(push), 32));
}

}  // namespace

const std::vector<Variable>& shader_inputs() {
  static const std::vector<Variable> inputs = {{{Base::kFloat, 4}, "a"}, {{Base::kFloat, 4}, "b"},
                                               {{Base::kInt, 4}, "i"},   {{Base::kUint, 4}, "u"},
                                               {{Base::kFloat, 4}, "p"}, {{Base::kInt, 4}, "pi"}};
  return inputs;
}

void evaluate(Run& run, Stage stage, const ShaderBody& body) {
  Random& random = run.random;
  const auto real = [&] { return random.operand(body.specials); };
  const auto integer = [&] {
    return static_cast<int32_t>(random.chance(0.5f) ? random.bits() : static_cast<uint32_t>(random.between(-100, 100)));
  };
  const Buffer a = filled<float>(run, real), b = filled<float>(run, real);
  const Buffer i = filled<int32_t>(run, integer), u = filled<int32_t>(run, integer);
  const Buffer results = run.buffer(body.results.size() * kInvocations * 16);
  const Resources res = run.resources({storage_buffer(0, a), storage_buffer(1, b), storage_buffer(2, i),
                                       storage_buffer(3, u), storage_buffer(4, results)},
                                      32);
  struct {
    float p[4];
    int32_t pi[4];
  } push;
  for (float& value : push.p) value = random.operand(false);
  for (int32_t& value : push.pi) value = integer();
  const std::string text = shader_text(stage, body);
  const bool to_uint =
      body.statements.find("uint(") != std::string::npos || body.statements.find("uvec") != std::string::npos;
  if (to_uint) run.require(reference_cpu().uint_comparable, "the reference's float to uint conversion on this CPU");
  run.note("shader", text);
  if (stage == Stage::kCompute)
    run_compute(run, text, res, &push);
  else
    run_graphics(run, stage, text, res, &push);
  for (size_t k = 0; k < body.results.size(); ++k) {
    const Variable& v = body.results[k];
    Output output;
    output.name = v.name;
    const VkFormat format = v.type.base == Base::kFloat ? VK_FORMAT_R32G32B32A32_SFLOAT
                            : v.type.base == Base::kInt ? VK_FORMAT_R32G32B32A32_SINT
                                                        : VK_FORMAT_R32G32B32A32_UINT;
    output.format = format_info(format);
    output.width = kInvocations;
    output.nan_bits_free = output.may_be_blank = true;
    if (k < body.lines.size()) output.remark = body.lines[k];
    const unsigned char* first = results.data + k * kInvocations * 16;
    output.bytes.assign(first, first + kInvocations * 16);
    run.out(std::move(output));
  }
}

}  // namespace vitrine::cts
