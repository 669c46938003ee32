// interpolateAtCentroid, interpolateAtSample and interpolateAtOffset on every kind of input, with one and four samples
// (the CTS's pipeline.multisample_interpolation and draw.shader_multisample_interpolation groups).
#include <string>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 2) in vec4 extra;
layout(location = 0) out vec4 smooth_vector;
layout(location = 1) noperspective out vec3 linear_vector;
layout(location = 2) flat out vec2 flat_vector;
layout(location = 3) centroid out float centroid_scalar;
layout(location = 4) out float scalars[3];
layout(location = 7) out vec2 pairs[2];
layout(location = 9) noperspective out vec4 linear_array[2];
layout(location = 11) out Block { vec3 first; mat2 second; noperspective float third; flat int fourth; } block;
void main() {
  smooth_vector = color;
  linear_vector = extra.yzw;
  flat_vector = color.zw;
  centroid_scalar = extra.x;
  for (int i = 0; i < 3; ++i) scalars[i] = color[i] - 0.25 * float(i);
  pairs = vec2[2](color.wx, extra.yx);
  linear_array = vec4[2](extra, color.wzyx);
  block.first = extra.zyx * 3.0;
  block.second = mat2(color.x, extra.x, color.y, extra.y);
  block.third = color.x + extra.w;
  block.fourth = gl_VertexIndex;
  gl_Position = position;
})";

/// `sample` turns on sample shading, so the qualifier of one input is a choice of the case.
std::string inputs(const std::string& qualifier) {
  return "layout(location = 0) " + qualifier + R"( in vec4 smooth_vector;
layout(location = 1) noperspective in vec3 linear_vector;
layout(location = 2) flat in vec2 flat_vector;
layout(location = 3) centroid in float centroid_scalar;
layout(location = 4) in float scalars[3];
layout(location = 7) in vec2 pairs[2];
layout(location = 9) noperspective in vec4 linear_array[2];
layout(location = 11) in Block { vec3 first; mat2 second; noperspective float third; flat int fourth; } block;
layout(location = 0) out vec4 result0;
layout(location = 1) out vec4 result1;
int index(int count) { return (int(gl_FragCoord.x) + int(gl_FragCoord.y)) % count; }
)";
}

/// What is read where its qualifier says is read before anything is interpolated elsewhere (deviations.md,
/// interpolation-overwrites-input).
const char kPlainReads[] = R"(  float w = smooth_vector.w, edge = centroid_scalar;
  vec2 outer = vec2(scalars[0], scalars[2]), pair = pairs[1], column = block.second[0];
)";

struct Interpolant {
  const char* text;
  const char* as_vec4;  ///< before and after the call
  const char* end;
};

constexpr Interpolant kInterpolants[] = {
    {"smooth_vector", "", ""},
    {"smooth_vector", "vec4(", ".xyz, w)"},
    {"linear_vector", "vec4(", ", 1.0)"},
    {"flat_vector", "vec4(", ", 0.5, 1.0)"},
    {"centroid_scalar", "vec4(", ", edge, 0.0, 1.0)"},
    {"scalars[1]", "vec4(", ", outer, 1.0)"},
    {"scalars[index(3)]", "vec4(", ")"},
    {"pairs[0]", "vec4(", ", pair)"},
    {"pairs[index(2)]", "vec4(", ", 0.0, 1.0)"},
    {"linear_array[1]", "", ""},
    {"linear_array[index(2)]", "", ""},
    {"block.first", "vec4(", ", 1.0)"},
    {"block.second[1]", "vec4(", ", column)"},
    {"block.third", "vec4(", ")"},
};

std::string call(Random& random, uint32_t samples, const std::string& interpolant) {
  const auto offset = [&] { return std::to_string(random.between(-8, 7)) + ".0 / 16.0"; };
  switch (random.below(5)) {
    case 0:
      return "interpolateAtCentroid(" + interpolant + ")";
    case 1:
      return "interpolateAtSample(" + interpolant + ", " + std::to_string(random.below(samples)) + ")";
    case 2:
      return "interpolateAtSample(" + interpolant + ", index(" + std::to_string(samples) + "))";
    case 3: {
      const std::string y = offset();
      return "interpolateAtOffset(" + interpolant + ", vec2(" + offset() + ", " + y + "))";
    }
    default:
      return "interpolateAtOffset(" + interpolant + ", flat_vector - 0.5)";
  }
}

void draw(Run& run, VkSampleCountFlagBits samples, const std::string& fragment, uint32_t triangles) {
  Random& random = run.random;
  run.require(run.gpu.features.sampleRateShading, "sampleRateShading");
  TargetSpec target_spec;
  target_spec.width = 40 + random.below(60);
  target_spec.height = 40 + random.below(60);
  target_spec.samples = samples;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kVertex;
  spec.fragment = fragment;
  spec.floats({4, 4, 4});
  spec.multisample.sampleShadingEnable = random.chance(0.2f);
  spec.multisample.minSampleShading = 1.0f;
  run.note("fragment", fragment);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values;
  for (uint32_t i = 0; i < 3 * triangles; ++i) {
    const float w = random.real(0.4f, 2.5f);
    for (const float v : {random.real(-1, 1) * w, random.real(-1, 1) * w, random.unit() * w, w}) values.push_back(v);
    for (int c = 0; c < 8; ++c) values.push_back(random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 3 * triangles, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

const bool kRegistered = [] {
  // With sample shading, what earlier samples of a pixel discard moves the centroid of later ones.
  AddCase("pipeline", "multisample_interpolation.centroid_after_discard", [](Run& run) {
    draw(run, VK_SAMPLE_COUNT_4_BIT,
         inputs("") + "void main() {\n  result0 = vec4(centroid_scalar, gl_SamplePosition, 1.0);\n" +
             "  result1 = smooth_vector;\n  if (gl_SampleID == 0 || smooth_vector.x > 0.6) discard;\n}\n",
         6);
  });
  for (const VkSampleCountFlagBits samples : {VK_SAMPLE_COUNT_1_BIT, VK_SAMPLE_COUNT_4_BIT}) {
    const std::string suffix = samples == VK_SAMPLE_COUNT_1_BIT ? ".samples_1" : ".samples_4";
    for (const char* function : {"Centroid(", "Sample(", "Offset("}) {
      const std::string prefix = std::string("interpolateAt") + function;
      const std::string place = function == std::string("Sample(")   ? ", index(" + std::to_string(samples) + "))"
                                : function == std::string("Offset(") ? ", vec2(-0.5, 0.4375))"
                                                                     : ")";
      const auto at = [=](const char* input) { return prefix + input + place; };
      AddCase("pipeline", "multisample_interpolation.at_" + prefix.substr(13, prefix.size() - 14) + suffix,
              [=](Run& run) {
                draw(run, samples,
                     inputs("") + "void main() {\n  result0 = " + at("smooth_vector") + ";\n  result1 = vec4(" +
                         at("scalars[index(3)]") + ", " + at("linear_vector.y") + ", " + at("block.second[1]") +
                         ".x, " + at("flat_vector") + ".y);\n}\n",
                     6);
              });
    }
    AddGenerator("pipeline", ("multisample_interpolation.random" + suffix).c_str(), 25, [=](Run& run) {
      Random& random = run.random;
      std::string text =
          inputs(random.pick<const char*>({"", "", "centroid", "sample"})) + "void main() {\n" + kPlainReads;
      for (const char* result : {"  result0 = ", "  result1 = "}) {
        const Interpolant& interpolant = kInterpolants[random.below(std::size(kInterpolants))];
        const std::string value = call(random, samples, interpolant.text);
        text += result + (interpolant.as_vec4 + value) + interpolant.end + ";\n";
      }
      draw(run, samples, text + "}\n", 1 + random.below(12));
    });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
