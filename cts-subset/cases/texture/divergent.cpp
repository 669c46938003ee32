// Lookups and derivatives where some lanes of a quad wait: levels of detail and differences follow from what those
// lanes hold, which in the reference is what its registers hold (lavapipe-optimizer.md 6.6). Post-processing that
// searches along edges does so.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// `body` sets vec4 v from vec2 p (0..1 over 64 pixels), with a texture t of six levels.
void shade(Run& run, const std::string& body) {
  ImageSpec spec;
  spec.format = VK_FORMAT_R8G8B8A8_UNORM;
  spec.extent = {64, 64, 1};
  spec.levels = 6;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  sampler.maxLod = 16;
  const Resources res = run.resources({sampled(0, image, run.sampler(sampler))});
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  target_spec.width = target_spec.height = 64;
  const Target target = make_target(run, target_spec);
  GraphicsSpec graphics;
  graphics.layout = res.layout;
  graphics.vertex = kFullScreenVertex;
  graphics.fragment =
      "layout(binding = 0) uniform sampler2D t;\nlayout(location = 0) out vec4 v;\nvoid main() {\n"
      "  vec2 p = gl_FragCoord.xy * 0.015625;\n  vec4 m = texture(t, p);\n" +
      body + "}\n";
  draw_once(run, target, make_pipeline(run, graphics, target), &res);
  run.out("color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
}

struct Body {
  const char *name, *code;
};

constexpr Body kBodies[] = {
    {"loop_left_early", R"(
  vec4 s = vec4(0.0);
  for (int i = 0; i < 40; ++i) {
    s = texture(t, p);
    if (s.x + s.y < 0.4 + 0.02 * float(i)) break;
    p += vec2(0.03, 0.02) * m.xy;
  }
  v = vec4(p, s.xy);
)"},
    {"loop_unrolled", R"(
  vec4 s = vec4(0.0);
  p = m.xy;
  for (int i = 0; i < 6; ++i) {
    s = texture(t, p);
    if (s.x + s.y < 1.0) break;
    p += vec2(0.03, 0.02);
  }
  v = vec4(p, s.xy);
)"},
    {"loop_not_entered", R"(
  v = vec4(0.0);
  if (m.x < 0.5)
    for (int i = 0; float(i) < m.y * 50.0; ++i) v += texture(t, p + m.zw + float(i) * vec2(0.01, 0.03)) * 0.1;
)"},
    {"counter", R"(
  v = vec4(0.0);
  for (int i = 0; i < 50; ++i) {
    if (float(i) > m.x * 50.0) break;
    v += texture(t, p + float(i) * vec2(0.004, 0.007)) * 0.1;
  }
)"},
    {"next_value", R"(
  v = vec4(0.0);
  float left = m.x * 40.0;
  do {
    p += m.zw * 0.05;
    v += texture(t, p) * 0.1;
    left -= 1.0;
  } while (left > 0.0);
)"},
    {"join_in_branch", R"(
  v = m;
  if (m.x < 0.6) {
    vec2 q;
    if (m.y < 0.5) q = textureLod(t, p + 0.3, 0.0).xy * 3.0;
    else q = textureLod(t, p * 1.5, 1.0).zw + sin(p) * cos(p.yx * 30.0) + exp(p * 3.0) / log(p + 4.0);
    v = texture(t, q) + vec4(dFdx(q), dFdy(q));
  }
)"},
    {"behind_loop", R"(
  v = m;
  if (m.x < 0.6) {
    float sum = 0.0, next = 0.0;
    for (int i = 0; i < 60; ++i) {
      next = sum + textureLod(t, p + float(i) * 0.11, 0.0).x;
      if (next > 10.0 * m.y + 1.0) break;
      sum = next * 1.125;
    }
    v = texture(t, vec2(next, sum)) + dFdx(sum) + dFdy(next);
  }
)"},
    {"start_value", R"(
  v = m;
  if (m.x < 0.6) {
    float first = m.y * m.z, a = first, b = first;
    for (int i = 0; i < 60; ++i) {
      if (a + b > m.w * 9.0) break;
      a += textureLod(t, p + a, 0.0).x;
      b += textureLod(t, p - b, 0.0).y;
    }
    v = vec4(dFdx(first), dFdy(first), a, b);
  }
)"},
    {"edge_search", R"(
  v = m;
  if (m.x < 0.7) {
    bool done_n = false, done_p = false;
    vec2 step = m.y < 0.5 ? vec2(0.015625, 0.0) : vec2(0.0, 0.015625), n = p - step, q = p + step;
    float end_n = m.z, end_p = m.z;
    for (int i = 0; i < 40; ++i) {
      if (!done_n) end_n = texture(t, n).x;
      if (!done_p) end_p = texture(t, q).y;
      done_n = done_n || abs(end_n - m.z) >= 0.4;
      done_p = done_p || abs(end_p - m.z) >= 0.4;
      if (done_n && done_p) break;
      if (!done_n) n -= step;
      if (!done_p) q += step;
    }
    v = texture(t, p + (n - q) * (end_n < end_p ? end_n : m.z));
  }
)"},
    {"continued", R"(
  v = vec4(0.0);
  for (int i = 0; i < 40; ++i) {
    p += m.xy * 0.02;
    if (textureLod(t, p.yx, 0.0).x < 0.4) continue;
    v += texture(t, p) * 0.1;
    if (v.x > 1.0) break;
    p += m.zw * 0.01;
  }
)"},
    {"bias_and_level", R"(
  v = vec4(0.0);
  float level = 0.0;
  for (int i = 0; i < 40; ++i) {
    vec4 s = textureLod(t, p + float(i) * 0.1, level);
    if (s.x < 0.2) break;
    level = level * 0.5 + s.y * 4.0;
    v += s * 0.1 + texture(t, p, level - 2.0) * 0.1;
  }
)"},
};

const bool kDivergent = [] {
  for (const Body& body : kBodies)
    AddCase("texture", std::string("divergent.") + body.name, [&body](Run& run) { shade(run, body.code); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
