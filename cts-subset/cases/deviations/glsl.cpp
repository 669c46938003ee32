// Listed deviations of shader arithmetic and control flow.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

/// Runs 64 invocations of `expression` over (int x, int y) pairs.
void integers(Run& run, const std::string& name, const std::string& statements, const std::vector<int32_t>& in,
              uint32_t group_size = 1, const std::string& extensions = "") {
  const Buffer input = run.buffer_of(in), out = run.buffer(in.size() * 2);
  const Resources res = run.resources({storage_buffer(0, input), storage_buffer(1, out)});
  const VkPipeline pipeline =
      run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                                         extensions + "layout(local_size_x = " + std::to_string(group_size) + R"() in;
layout(std430, binding = 0) buffer A { ivec2 a[]; };
layout(std430, binding = 1) buffer R { int r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  int x = a[id].x, y = a[id].y;
)" + statements + "\n}\n"));
  run.dispatch(res, pipeline, static_cast<uint32_t>(in.size() / 2 / group_size));
  run.out(name, out, VK_FORMAT_R32_SINT);
}

const AddCase kModulo("glsl", "deviation.signed_modulo", "signed-modulo", case_against_control, [](Run& run) {
  const std::vector<int32_t> pairs = {-7, 3, 7, -3, -7, -3, 7, 3, -1, 5, 100, -7, 0, -4, -6, 3};
  integers(run, "smod", "  r[id] = x % y;", pairs);
  integers(run, "floored", "  int q = x / y; int m = x - q * y; r[id] = m != 0 && (m < 0) != (y < 0) ? m + y : m;",
           pairs);
});

const AddCase kBudget("glsl", "deviation.loop_budget", "loop-budget", case_against_control, [](Run& run) {
  integers(run, "long_loop", "  int n = 0;\n  for (int k = 0; k < x; ++k) n += (k ^ y) & 3;\n  r[id] = n + x;",
           {70000, 1, 10, 2});
  integers(
      run, "short_loops",
      "  int n = 0;\n  if (x > 60000) n = 105000; else for (int k = 0; k < x; ++k) n += (k ^ y) & 3;\n  r[id] = n + x;",
      {70000, 1, 10, 2});
});

const AddCase kWidened("glsl", "deviation.widened_comparisons", "widened-comparisons", case_against_control,
                       [](Run& run) {
                         run.require(run.gpu.features.shaderInt64, "shaderInt64");
                         const std::vector<int32_t> x = {4, 1, -3, 2, 1, 7, 2, -5, 9, 0, 1, -1, 5, 3, 6, 8};
                         integers(run, "widened", "  r[id] = int(int64_t(x) < 5l) + 2 * int(3l >= int64_t(y));", x, 1,
                                  "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n");
                         integers(run, "control", "  r[id] = int(x < 5) + 2 * int(3 >= y);", x);
                       });

/// A value that is computed anew in each iteration from one that the loop carries, read behind the loop.
const AddCase kLeavesLoop("glsl", "deviation.value_leaves_loop", "value-leaves-loop", case_against_control,
                          [](Run& run) {
                            const std::vector<int32_t> x = {4, 1, 3, 2, 1, 7, 2, -5, 9, 0, 1, 1, 5, 3, 6, 8};
                            integers(run, "loop",
                                     "  int n = y, m = 0, k = x;\n"
                                     "  do {\n    m = n * 3;\n    n += 5;\n  } while (--k > 0);\n  r[id] = m;",
                                     x, 8);
                            integers(run, "closed", "  r[id] = (y + 5 * (x - 1)) * 3;", x, 8);
                          });

/// A derivative of a value loaded from a storage buffer, at the edges of a triangle.
const AddCase kHelper("glsl", "deviation.helper_lane_loads", "helper-lane-loads", case_against_control, [](Run& run) {
  run.require(run.gpu.features.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
  TargetSpec target;
  target.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  std::vector<float> hundred(64 * 64, 100.0f);
  for (size_t i = 0; i < hundred.size(); ++i) hundred[i] += static_cast<float>(i % 64);
  const Buffer table = run.buffer_of(hundred);
  const Resources res = run.resources({storage_buffer(0, table)});
  for (const bool loaded : {true, false}) {
    const Target where = make_target(run, target);
    GraphicsSpec spec;
    spec.layout = res.layout;
    spec.vertex = kColorVertex;
    spec.fragment =
        std::string("layout(std430, binding = 0) readonly buffer T { float t[]; };\n") +
        "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n" + "void main() { float x = " +
        (loaded ? "t[uint(gl_FragCoord.y) * 64u + uint(gl_FragCoord.x)]" : "100.0 + floor(gl_FragCoord.x)") +
        "; result = vec4(dFdx(x), dFdy(x), x, 1.0); }\n";
    spec.floats({4, 4});
    const VkPipeline pipeline = make_pipeline(run, spec, where);
    const Buffer vertices = run.buffer_of(colored({{-0.8f, -0.7f, 0, 1}, {0.7f, -0.3f, 0, 1}, {-0.1f, 0.9f, 0, 1}}));
    run.once([&](VkCommandBuffer cmd) {
      where.begin(cmd);
      bind_pipeline(cmd, pipeline);
      res.bind(cmd);
      bind_vertices(cmd, vertices);
      vkCmdDraw(cmd, 3, 1, 0, 0);
      vkCmdEndRenderPass(cmd);
    });
    run.out(loaded ? "loaded" : "computed", where.colors[0]);
  }
});

}  // namespace
}  // namespace vitrine::cts
