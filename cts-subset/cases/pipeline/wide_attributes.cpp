// Vertex attributes of 64-bit integers, next to the same bytes fetched as pairs of 32-bit ones.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

struct WideAttribute {
  VkFormat format;
  const char* name;
  uint32_t components;
  bool is_signed;
};

/// What the vertex shader makes `low` and `high` (halves of each component, 0 where the format has none) of.
std::string declarations(const WideAttribute& attribute, bool as_words) {
  const uint32_t n = attribute.components;
  std::string text = "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n";
  if (as_words) {
    for (uint32_t c = 0; c < n; ++c)
      text += "layout(location = " + std::to_string(c) + ") in uvec2 part" + std::to_string(c) + ";\n";
    return text;
  }
  const std::string scalar = attribute.is_signed ? "int64_t" : "uint64_t";
  const std::string vector = (attribute.is_signed ? "i64vec" : "u64vec") + std::to_string(n);
  return text + "layout(location = 3) in " + (n == 1 ? scalar : vector) + " value;\n";
}

std::string assignments(const WideAttribute& attribute, bool as_words) {
  std::string text;
  for (uint32_t c = 0; c < attribute.components; ++c) {
    const std::string number = std::to_string(c);
    const std::string part = attribute.components == 1 ? "value" : "value[" + number + "]";
    text += "  low[" + number + "] = " + (as_words ? "part" + number + ".x" : "uint(" + part + " & 0xffffffffL)") +
            ";\n  high[" + number + "] = " + (as_words ? "part" + number + ".y" : "uint(" + part + " >> 32)") + ";\n";
  }
  return text;
}

/// Each vertex is a pixel of the upper half of a 64x64 target that receives the low words, and one of the lower half
/// that receives the high words.
void fetch(Run& run, const WideAttribute& attribute, const Buffer& vertices, uint32_t stride, bool as_words) {
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_UINT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = declarations(attribute, as_words) + R"(
layout(location = 0) flat out uvec4 passed;
void main() {
  uvec4 low = uvec4(0u), high = uvec4(0u);
)" + assignments(attribute, as_words) +
                R"(
  passed = gl_InstanceIndex == 0 ? low : high;
  int row = (gl_VertexIndex >> 6) + 32 * gl_InstanceIndex;
  gl_Position = vec4((float(gl_VertexIndex & 63) + 0.5) / 32.0 - 1.0, (float(row) + 0.5) / 32.0 - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
})";
  spec.fragment =
      "layout(location = 0) flat in uvec4 passed;\nlayout(location = 0) out uvec4 result;\n"
      "void main() { result = passed; }\n";
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  spec.bindings = {{2, stride, VK_VERTEX_INPUT_RATE_VERTEX}};
  if (as_words)
    for (uint32_t c = 0; c < attribute.components; ++c)
      spec.attributes.push_back({c, 2, VK_FORMAT_R32G32_UINT, 8 + 8 * c});
  else
    spec.attributes = {{3, 2, attribute.format, 8}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices, 2);
    vkCmdDraw(cmd, 2048, 2, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out(as_words ? "words" : "wide", target.colors[0]);
}

void fetch_both(Run& run, const WideAttribute& attribute) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(run.gpu.physical, attribute.format, &properties);
  run.require(properties.bufferFeatures & VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT, attribute.name);
  run.require(run.gpu.features.shaderInt64, "shaderInt64");
  const uint32_t stride = 8 + 8 * attribute.components;
  const Buffer vertices = run.buffer(stride * 2048);
  for (VkDeviceSize i = 0; i < vertices.size; ++i)
    vertices.data[i] = static_cast<unsigned char>(run.random.bits() >> 24);
  fetch(run, attribute, vertices, stride, false);
  fetch(run, attribute, vertices, stride, true);
}

#define ROW(name, components, is_signed) \
  { VK_FORMAT_##name, #name, components, is_signed }
constexpr WideAttribute kSame[] = {ROW(R64_UINT, 1, false), ROW(R64G64_UINT, 2, false)};
constexpr WideAttribute kDifferent[] = {ROW(R64_SINT, 1, true),           ROW(R64G64_SINT, 2, true),
                                        ROW(R64G64B64_UINT, 3, false),    ROW(R64G64B64_SINT, 3, true),
                                        ROW(R64G64B64A64_UINT, 4, false), ROW(R64G64B64A64_SINT, 4, true)};
#undef ROW

const bool kRegistered = [] {
  for (const WideAttribute& attribute : kSame)
    AddCase("pipeline", std::string("vertex_input.") + attribute.name,
            [&attribute](Run& run) { fetch_both(run, attribute); });
  for (const WideAttribute& attribute : kDifferent)
    AddCase("pipeline", std::string("deviation.wide_attributes.") + attribute.name, "wide-attributes",
            case_against_control, [&attribute](Run& run) { fetch_both(run, attribute); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
