// Advanced blend operations: every operation with every overlap, premultiplied or not, set statically or dynamically.
// The reference does not have them: there the fragment shader computes the specification's formulas from the pixel as
// an input of its own. In floats, so that every bit shows.
#include <array>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

struct Operation {
  const char* name;
  VkBlendOp op;
  const char* terms;            ///< X, Y, Z; null: of the table of additional RGB operations
  const char* code;             ///< f of components s and d; or the result's component with sa, da, both premultiplied
  const char* alpha = nullptr;  ///< of additional operations
};

constexpr char kHard[] = "(s <= 0.5 ? 2.0 * s * d : 1.0 - 2.0 * (1.0 - s) * (1.0 - d))";
constexpr char kOverlay[] = "(d <= 0.5 ? 2.0 * d * s : 1.0 - 2.0 * (1.0 - d) * (1.0 - s))";
constexpr char kSoft[] =
    "(s <= 0.5 ? d - (1.0 - 2.0 * s) * d * (1.0 - d) : d <= 0.25 ? d + (2.0 * s - 1.0) * d * ((16.0 * d - 12.0) * d + "
    "3.0) : d + (2.0 * s - 1.0) * (sqrt(d) - d))";
constexpr char kVivid[] =
    "(s <= 0.0 ? 0.0 : s < 0.5 ? 1.0 - min(1.0, (1.0 - d) / (2.0 * s)) : s < 1.0 ? min(1.0, d / (2.0 * (1.0 - s))) : "
    "1.0)";
constexpr char kPin[] = "(2.0 * s - 1.0 > d ? (s < 0.5 ? 0.0 : 2.0 * s - 1.0) : s < 0.5 * d ? 2.0 * s : d)";

constexpr Operation kOperations[] = {
    {"zero", VK_BLEND_OP_ZERO_EXT, "0, 0, 0", "0.0"},
    {"src", VK_BLEND_OP_SRC_EXT, "1, 1, 0", "s"},
    {"dst", VK_BLEND_OP_DST_EXT, "1, 0, 1", "d"},
    {"src_over", VK_BLEND_OP_SRC_OVER_EXT, "1, 1, 1", "s"},
    {"dst_over", VK_BLEND_OP_DST_OVER_EXT, "1, 1, 1", "d"},
    {"src_in", VK_BLEND_OP_SRC_IN_EXT, "1, 0, 0", "s"},
    {"dst_in", VK_BLEND_OP_DST_IN_EXT, "1, 0, 0", "d"},
    {"src_out", VK_BLEND_OP_SRC_OUT_EXT, "0, 1, 0", "0.0"},
    {"dst_out", VK_BLEND_OP_DST_OUT_EXT, "0, 0, 1", "0.0"},
    {"src_atop", VK_BLEND_OP_SRC_ATOP_EXT, "1, 0, 1", "s"},
    {"dst_atop", VK_BLEND_OP_DST_ATOP_EXT, "1, 1, 0", "d"},
    {"xor", VK_BLEND_OP_XOR_EXT, "0, 1, 1", "0.0"},
    {"multiply", VK_BLEND_OP_MULTIPLY_EXT, "1, 1, 1", "s * d"},
    {"screen", VK_BLEND_OP_SCREEN_EXT, "1, 1, 1", "s + d - s * d"},
    {"overlay", VK_BLEND_OP_OVERLAY_EXT, "1, 1, 1", kOverlay},
    {"darken", VK_BLEND_OP_DARKEN_EXT, "1, 1, 1", "min(s, d)"},
    {"lighten", VK_BLEND_OP_LIGHTEN_EXT, "1, 1, 1", "max(s, d)"},
    {"colordodge", VK_BLEND_OP_COLORDODGE_EXT, "1, 1, 1", "(d <= 0.0 ? 0.0 : s < 1.0 ? min(1.0, d / (1.0 - s)) : 1.0)"},
    {"colorburn", VK_BLEND_OP_COLORBURN_EXT, "1, 1, 1",
     "(d >= 1.0 ? 1.0 : s > 0.0 ? 1.0 - min(1.0, (1.0 - d) / s) : 0.0)"},
    {"hardlight", VK_BLEND_OP_HARDLIGHT_EXT, "1, 1, 1", kHard},
    {"softlight", VK_BLEND_OP_SOFTLIGHT_EXT, "1, 1, 1", kSoft},
    {"difference", VK_BLEND_OP_DIFFERENCE_EXT, "1, 1, 1", "abs(d - s)"},
    {"exclusion", VK_BLEND_OP_EXCLUSION_EXT, "1, 1, 1", "s + d - 2.0 * s * d"},
    {"invert", VK_BLEND_OP_INVERT_EXT, "1, 0, 1", "1.0 - d"},
    {"invert_rgb", VK_BLEND_OP_INVERT_RGB_EXT, "1, 0, 1", "s * (1.0 - d)"},
    {"lineardodge", VK_BLEND_OP_LINEARDODGE_EXT, "1, 1, 1", "(s + d <= 1.0 ? s + d : 1.0)"},
    {"linearburn", VK_BLEND_OP_LINEARBURN_EXT, "1, 1, 1", "(s + d > 1.0 ? s + d - 1.0 : 0.0)"},
    {"vividlight", VK_BLEND_OP_VIVIDLIGHT_EXT, "1, 1, 1", kVivid},
    {"linearlight", VK_BLEND_OP_LINEARLIGHT_EXT, "1, 1, 1", "clamp(2.0 * s + d - 1.0, 0.0, 1.0)"},
    {"pinlight", VK_BLEND_OP_PINLIGHT_EXT, "1, 1, 1", kPin},
    {"hardmix", VK_BLEND_OP_HARDMIX_EXT, "1, 1, 1", "(s + d < 1.0 ? 0.0 : 1.0)"},
    {"hsl_hue", VK_BLEND_OP_HSL_HUE_EXT, "1, 1, 1", "set_saturation(S, D, D)[c]"},
    {"hsl_saturation", VK_BLEND_OP_HSL_SATURATION_EXT, "1, 1, 1", "set_saturation(D, S, D)[c]"},
    {"hsl_color", VK_BLEND_OP_HSL_COLOR_EXT, "1, 1, 1", "set_luminosity(S, D)[c]"},
    {"hsl_luminosity", VK_BLEND_OP_HSL_LUMINOSITY_EXT, "1, 1, 1", "set_luminosity(D, S)[c]"},
    {"plus", VK_BLEND_OP_PLUS_EXT, nullptr, "s + d", "sa + da"},
    {"plus_clamped", VK_BLEND_OP_PLUS_CLAMPED_EXT, nullptr, "min(1.0, s + d)", "min(1.0, sa + da)"},
    {"plus_clamped_alpha", VK_BLEND_OP_PLUS_CLAMPED_ALPHA_EXT, nullptr, "min(min(1.0, sa + da), s + d)",
     "min(1.0, sa + da)"},
    {"plus_darker", VK_BLEND_OP_PLUS_DARKER_EXT, nullptr, "max(0.0, min(1.0, sa + da) - ((sa - s) + (da - d)))",
     "min(1.0, sa + da)"},
    {"minus", VK_BLEND_OP_MINUS_EXT, nullptr, "d - s", "da - sa"},
    {"minus_clamped", VK_BLEND_OP_MINUS_CLAMPED_EXT, nullptr, "max(0.0, d - s)", "max(0.0, da - sa)"},
    {"contrast", VK_BLEND_OP_CONTRAST_EXT, nullptr, "da / 2.0 + 2.0 * (d - da / 2.0) * (s - sa / 2.0)", "da"},
    {"invert_ovg", VK_BLEND_OP_INVERT_OVG_EXT, nullptr, "sa * (1.0 - d) + (1.0 - sa) * d", "sa + da - sa * da"},
    {"red", VK_BLEND_OP_RED_EXT, nullptr, "(c == 0 ? s : d)", "da"},
    {"green", VK_BLEND_OP_GREEN_EXT, nullptr, "(c == 1 ? s : d)", "da"},
    {"blue", VK_BLEND_OP_BLUE_EXT, nullptr, "(c == 2 ? s : d)", "da"},
};

constexpr char kFunctions[] = R"(
float luminosity(vec3 c) {
  precise float sum = 0.30 * c.r + 0.59 * c.g;
  precise float all = sum + 0.11 * c.b;
  return all;
}
vec3 clip_color(vec3 color) {
  float lum = luminosity(color), low = min(min(color.r, color.g), color.b), high = max(max(color.r, color.g), color.b);
  precise vec3 moved = color;
  if (low < 0.0) moved = lum + (moved - lum) * lum / (lum - low);
  if (high > 1.0) moved = lum + (moved - lum) * (1.0 - lum) / (high - lum);
  return moved;
}
vec3 set_luminosity(vec3 base, vec3 lum) {
  precise vec3 moved = base + (luminosity(lum) - luminosity(base));
  return clip_color(moved);
}
vec3 set_saturation(vec3 base, vec3 saturation, vec3 lum) {
  float low = min(min(base.r, base.g), base.b);
  precise float own = max(max(base.r, base.g), base.b) - low;
  precise float wanted =
      max(max(saturation.r, saturation.g), saturation.b) - min(min(saturation.r, saturation.g), saturation.b);
  precise vec3 color = vec3(0.0);
  if (own > 0.0) color = (base - low) * wanted / own;
  return set_luminosity(color, lum);
}
)";

/// How an operation is used.
struct Use {
  bool src_premultiplied, dst_premultiplied, clamped;
  VkBlendOverlapEXT overlap;
};

/// vec4 blend(vec4 src, vec4 dst).
std::string blending_code(const Operation& operation, const Use& use) {
  static constexpr const char* kWeights[] = {"vec3(sa * da, sa * (1.0 - da), da * (1.0 - sa))",
                                             "vec3(max(sa + da - 1.0, 0.0), min(sa, 1.0 - da), min(da, 1.0 - sa))",
                                             "vec3(min(sa, da), max(sa - da, 0.0), max(da - sa, 0.0))"};
  const bool weighted = operation.terms != nullptr;
  const auto base = [&](const char* color, bool premultiplied) {
    const std::string rgb = std::string(color) + ".rgb", a = std::string(color) + ".a";
    if (premultiplied == !weighted) return rgb;
    return weighted ? "(" + a + " == 0.0 ? vec3(0.0) : " + rgb + " / " + a + ")" : rgb + " * " + a;
  };
  std::string code = std::string(kFunctions) +
                     "vec4 blend(vec4 src, vec4 dst) {\n  float sa = src.a, da = dst.a;\n  precise vec3 S = " +
                     base("src", use.src_premultiplied) + ", D = " + base("dst", use.dst_premultiplied) +
                     ";\n  precise vec4 result;\n";
  if (weighted)
    code += "  precise vec3 p = " + std::string(kWeights[use.overlap]) + ", t = vec3(" + operation.terms + ");\n";
  code += "  for (int c = 0; c < 3; ++c) {\n    float s = S[c], d = D[c];\n    precise float f = " +
          std::string(operation.code) + ";\n";
  code += weighted ? "    precise float term = f * p.x + t.y * s * p.y;\n    result[c] = term + t.z * d * p.z;\n  }\n"
                     "  precise float a = t.x * p.x + t.y * p.y;\n  result.a = a + t.z * p.z;\n"
                   : "    result[c] = f;\n  }\n  result.a = " + std::string(operation.alpha) + ";\n";
  if (!use.dst_premultiplied) code += "  result.rgb = result.a == 0.0 ? vec3(0.0) : result.rgb / result.a;\n";
  if (use.clamped) code += "  result = clamp(result, 0.0, 1.0);\n";
  return code + "  return result;\n}\n";
}

/// Colours whose alpha is often 0 or 1; well-formed where they are premultiplied.
std::vector<float> random_colors(Random& random, bool premultiplied) {
  std::vector<float> values;
  for (int i = 0; i < 64 * 64; ++i) {
    const float alpha = random.chance(0.15f) ? static_cast<float>(random.below(2)) : random.unit();
    for (int c = 0; c < 3; ++c) {
      const float value = random.chance(0.1f) ? 0.5f * static_cast<float>(random.below(3)) : random.unit();
      values.push_back(premultiplied ? value * alpha : value);
    }
    values.push_back(alpha);
  }
  return values;
}

std::string shader_of(bool has, const Operation& operation, const Use& use) {
  const std::string head =
      "layout(binding = 0) buffer Sources { vec4 source[]; };\nlayout(binding = 1) buffer Pixels { vec4 pixel[]; };\n"
      "layout(location = 0) out vec4 result;\n";
  const std::string number = "  int i = int(gl_FragCoord.y) * 64 + int(gl_FragCoord.x);\n";
  if (has) return head + "void main() {\n" + number + "  result = source[i];\n}\n";
  return head + blending_code(operation, use) + "void main() {\n" + number +
         "  result = blend(source[i], pixel[i]);\n}\n";
}

void blend_once(Run& run, const Operation& operation, const Use& use, bool dynamic, uint32_t number) {
  const bool has = run.gpu.has("VK_EXT_blend_operation_advanced");
  const std::vector<float> pixels = random_colors(run.random, use.dst_premultiplied);
  const Buffer sources = run.buffer_of(random_colors(run.random, use.src_premultiplied));
  const Resources resources = run.resources({storage_buffer(0, sources), storage_buffer(1, run.buffer_of(pixels))});
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  target_spec.load = VK_ATTACHMENT_LOAD_OP_LOAD;
  const Target target = make_target(run, target_spec);
  run.upload(target.colors[0], 0,
             {reinterpret_cast<const unsigned char*>(pixels.data()), pixels.size() * sizeof(float)});
  GraphicsSpec spec;
  spec.layout = resources.layout;
  spec.vertex = kFullScreenVertex;
  spec.fragment = shader_of(has, operation, use);
  VkPipelineColorBlendAdvancedStateCreateInfoEXT state{
      VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_ADVANCED_STATE_CREATE_INFO_EXT};
  state.srcPremultiplied = use.src_premultiplied;
  state.dstPremultiplied = use.dst_premultiplied;
  state.blendOverlap = use.overlap;
  const VkColorBlendAdvancedEXT command{operation.op, use.src_premultiplied, use.dst_premultiplied, use.overlap,
                                        use.clamped};
  if (has) {
    spec.blends = {{VK_TRUE, {}, {}, operation.op, {}, {}, operation.op, 0xf}};
    if (dynamic) spec.dynamic.push_back(VK_DYNAMIC_STATE_COLOR_BLEND_ADVANCED_EXT);
    if (!dynamic) spec.blend.pNext = &state;
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    resources.bind(cmd);
    if (has && dynamic) CTS_COMMAND(run.gpu, CmdSetColorBlendAdvancedEXT)(cmd, 0, 1, &command);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("color" + std::to_string(number), target.colors[0]);
  run.may_be_blank();
}

const bool kCases = [] {
  for (const Operation& operation : kOperations)
    AddCase("pipeline", std::string("blend_advanced.") + operation.name, [&operation](Run& run) {
      run.require(gpus().device.has("VK_EXT_blend_operation_advanced"), "VK_EXT_blend_operation_advanced");
      for (uint32_t i = 0; i < 6; ++i) {
        const bool dynamic = i % 2 != 0;
        blend_once(
            run, operation,
            {run.random.chance(0.5f), run.random.chance(0.5f), dynamic && i > 3, static_cast<VkBlendOverlapEXT>(i % 3)},
            dynamic, i);
      }
    });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
