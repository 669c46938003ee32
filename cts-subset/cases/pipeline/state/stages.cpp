// Text of random stages: vertices pass a position, a perspective, a linear and a flat colour on.
#include "cases/pipeline/state/stages.h"

namespace vitrine::cts {
namespace {

std::string number(uint32_t n) { return std::to_string(n); }

const char kVaryings[] = R"(
layout(location = 0) out vec4 smooth_color;
layout(location = 1) noperspective out vec4 linear_color;
layout(location = 2) flat out vec4 flat_color;
)";
const char kCapturedVaryings[] = R"(
layout(location = 0, xfb_buffer = 0, xfb_offset = 16, xfb_stride = 32) out vec4 smooth_color;
layout(location = 1, xfb_buffer = 1, xfb_offset = 4, xfb_stride = 40) noperspective out vec4 linear_color;
layout(location = 2, xfb_buffer = 1, xfb_offset = 20) flat out vec4 flat_color;
)";

std::string varyings(const Stages& stages, bool last) {
  return last && stages.captured ? kCapturedVaryings : kVaryings;
}

std::string extensions(const Stages& stages, bool selects) {
  std::string text;
  if (selects && (stages.layers > 1 || stages.viewports > 1))
    text += "#extension GL_ARB_shader_viewport_layer_array : require\n";
  if (stages.views) text += "#extension GL_EXT_multiview : require\n";
  return text;
}

std::string built_in_outputs(const Stages& stages) {
  std::string text = "out gl_PerVertex {";
  text += stages.captured ? " layout(xfb_buffer = 0, xfb_offset = 0, xfb_stride = 32) vec4 gl_Position;"
                          : " vec4 gl_Position;";
  text += " float gl_PointSize;";
  if (stages.clip_distances) text += " float gl_ClipDistance[" + number(stages.clip_distances) + "];";
  if (stages.cull_distances) text += " float gl_CullDistance[" + number(stages.cull_distances) + "];";
  return text + " };\n";
}

/// Distances from the linear colour; layer and viewport from `selector`.
std::string last_stage_writes(const Stages& stages, const std::string& selector) {
  std::string text;
  for (uint32_t i = 0; i < stages.clip_distances; ++i)
    text += "  gl_ClipDistance[" + number(i) + "] = linear_color[" + number(i) + "] - 0.15;\n";
  for (uint32_t i = 0; i < stages.cull_distances; ++i)
    text += "  gl_CullDistance[" + number(i) + "] = linear_color[" + number(3 - i) + "] - 0.4;\n";
  if (stages.layers > 1) text += "  gl_Layer = (" + selector + ") % " + number(stages.layers) + ";\n";
  if (stages.viewports > 1) text += "  gl_ViewportIndex = (" + selector + ") % " + number(stages.viewports) + ";\n";
  return text;
}

std::string vertex_text(const Stages& stages) {
  const bool last = stages.tessellation.empty() && stages.geometry.empty();
  std::string text = extensions(stages, last);
  text += "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n";
  text += "layout(location = 2) in vec4 extra;\n";
  text += varyings(stages, last);
  if (last) text += built_in_outputs(stages);
  text += R"(void main() {
  smooth_color = color;
  linear_color = extra;
  flat_color = color.zwxy;
  gl_Position = position + vec4(0.05, -0.03, 0.0, 0.0) * (position.w * float(gl_InstanceIndex));
  gl_PointSize = 1.0 + extra.x * 8.0;
)";
  if (stages.views) text += "  smooth_color.xy *= 0.4 + 0.2 * float(gl_ViewIndex);\n";
  // A whole instance at a time: the provoking vertex must not matter.
  if (last) text += last_stage_writes(stages, "gl_InstanceIndex");
  return text + "}\n";
}

const char kControl[] = R"(
layout(vertices = 4) out;
layout(location = 0) in vec4 smooth_color[];
layout(location = 1) noperspective in vec4 linear_color[];
layout(location = 2) flat in vec4 flat_color[];
layout(location = 0) out vec4 point_smooth[];
layout(location = 1) out vec4 point_linear[];
layout(location = 2) out vec4 point_flat[];
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  point_smooth[gl_InvocationID] = smooth_color[gl_InvocationID];
  point_linear[gl_InvocationID] = linear_color[gl_InvocationID];
  point_flat[gl_InvocationID] = flat_color[gl_InvocationID];
  if (gl_InvocationID == 0) {
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = 1.0 + smooth_color[i].x * 5.0;
    for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = 1.0 + linear_color[i].y * 5.0;
  }
}
)";

std::string evaluation_text(const Stages& stages) {
  const bool last = stages.geometry.empty();
  std::string text = extensions(stages, last) + "layout(" + stages.tessellation + R"() in;
layout(location = 0) in vec4 point_smooth[];
layout(location = 1) in vec4 point_linear[];
layout(location = 2) in vec4 point_flat[];
)";
  text += varyings(stages, last);
  if (last) text += built_in_outputs(stages);
  text += R"(void main() {
  vec3 at = gl_TessCoord;
  vec4 top = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, at.x);
  vec4 bottom = mix(gl_in[3].gl_Position, gl_in[2].gl_Position, at.x);
  gl_Position = mix(top, bottom, at.y);
  smooth_color = mix(point_smooth[0], point_smooth[2], at.x);
  linear_color = mix(point_linear[1], point_linear[3], at.y);
  flat_color = point_flat[1];
  gl_PointSize = 1.0 + linear_color.x * 4.0;
)";
  if (last) text += last_stage_writes(stages, "gl_PrimitiveID");
  return text + "}\n";
}

struct InputPrimitive {
  const char* layout;
  uint32_t vertices;
};
InputPrimitive input_primitive(VkPrimitiveTopology topology) {
  switch (topology) {
    case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
      return {"points", 1};
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
      return {"lines", 2};
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
      return {"lines_adjacency", 4};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
      return {"triangles_adjacency", 6};
    default:
      return {"triangles", 3};
  }
}

InputPrimitive geometry_input(const Stages& stages) {
  if (stages.tessellation.empty()) return input_primitive(stages.topology);
  if (stages.tessellation.find("point_mode") != std::string::npos) return {"points", 1};
  if (stages.tessellation.find("isolines") != std::string::npos) return {"lines", 2};
  return {"triangles", 3};
}

/// Every input vertex, and every one again a little further; of points three times. Strips are long enough to draw
/// something: the reference crashes where none ever can.
std::string geometry_text(const Stages& stages) {
  const InputPrimitive in = geometry_input(stages);
  const uint32_t copies = in.vertices == 1 ? 3 : 2;
  const char* end = "EndPrimitive();\n";
  std::string text = std::string("layout(") + in.layout + ") in;\nlayout(" + stages.geometry +
                     ", max_vertices = " + number(copies * in.vertices) + R"() out;
layout(location = 0) in vec4 in_smooth[];
layout(location = 1) noperspective in vec4 in_linear[];
layout(location = 2) flat in vec4 in_flat[];
)" + varyings(stages, true) +
                     built_in_outputs(stages) + "void main() {\n  for (int copy = 0; copy < " + number(copies) +
                     "; ++copy) {\n    for (int i = 0; i < " + number(in.vertices) + R"(; ++i) {
      smooth_color = in_smooth[i];
      linear_color = in_linear[i];
      flat_color = in_flat[i].wxyz;
      gl_Position = gl_in[i].gl_Position + vec4(0.05, float(copy) * 0.04, 0.0, 0.0) * (gl_in[i].gl_Position.w * float(copy));
      gl_PointSize = 1.0 + in_linear[i].y * 5.0;
)" + last_stage_writes(stages, "gl_PrimitiveIDIn" + std::string(in.vertices > 2 ? " + copy" : ""));
  if (stages.primitive_id) text += "      gl_PrimitiveID = gl_PrimitiveIDIn * 2 + copy;\n";
  text += "      EmitVertex();\n    }\n";
  if (in.vertices > 2) text += std::string("    ") + end;
  return text + "  }\n" + (in.vertices > 2 ? "" : std::string("  ") + end) + "}\n";
}

void random_tessellation(Run& run, Stages& stages) {
  Random& random = run.random;
  const std::string domain = random.pick({"triangles", "quads", "isolines"});
  stages.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  const std::string order = random.pick({"cw", "ccw"});
  stages.tessellation = domain + ", " +
                        random.pick({"equal_spacing", "fractional_odd_spacing", "fractional_even_spacing"}) + ", " +
                        order;
  stages.drawn = domain == "isolines" ? Drawn::kLines : Drawn::kTriangles;
  if (random.chance(0.2f)) {
    stages.tessellation += ", point_mode";
    stages.drawn = Drawn::kPoints;
  }
}

Drawn drawn_by(VkPrimitiveTopology topology) {
  const uint32_t vertices = input_primitive(topology).vertices;
  if (vertices == 1) return Drawn::kPoints;
  return vertices == 2 || vertices == 4 ? Drawn::kLines : Drawn::kTriangles;
}

}  // namespace

Stages random_stages(Run& run, bool short_lines_allowed) {
  Random& random = run.random;
  Stages stages;
  stages.topology = static_cast<VkPrimitiveTopology>(
      random.chance(0.5f) ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST + static_cast<int>(random.below(3)) : random.below(10));
  stages.drawn = drawn_by(stages.topology);
  if (random.chance(0.15f)) random_tessellation(run, stages);
  if (random.chance(0.25f)) {
    const uint32_t output = random.below(3);
    stages.geometry = output == 0 ? "points" : output == 1 ? "line_strip" : "triangle_strip";
    stages.drawn = output == 0 ? Drawn::kPoints : output == 1 ? Drawn::kLines : Drawn::kTriangles;
    stages.primitive_id = random.chance(0.5f);
  }
  if (!short_lines_allowed && stages.drawn == Drawn::kLines) {
    stages = {};
    stages.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP,
                                   VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY});
    stages.drawn = Drawn::kLines;
  }
  if (random.chance(0.15f)) stages.clip_distances = 1 + random.below(3);
  if (random.chance(0.15f)) stages.cull_distances = 1 + random.below(2);
  return stages;
}

void write_stages(const Stages& stages, GraphicsSpec& spec) {
  spec.vertex = vertex_text(stages);
  if (!stages.tessellation.empty()) {
    spec.control = kControl;
    spec.evaluation = evaluation_text(stages);
    spec.tessellation.patchControlPoints = 4;
  }
  if (!stages.geometry.empty()) spec.geometry = geometry_text(stages);
  spec.assembly.topology = stages.topology;
}

std::string random_fragment(Random& random, const TargetSpec& target, const Stages& stages,
                            const FragmentNeeds& needs) {
  const char* where = needs.multisampled ? random.pick({"", "", "centroid ", needs.per_sample ? "sample " : ""}) : "";
  std::string text = extensions(stages, false);
  if (needs.writes_stencil) text += "#extension GL_ARB_shader_stencil_export : require\n";
  if (needs.early) text += "layout(early_fragment_tests) in;\n";
  text += std::string("layout(location = 0) ") + where + "in vec4 smooth_color;\nlayout(location = 1) noperspective " +
          where + "in vec4 linear_color;\nlayout(location = 2) flat in vec4 flat_color;\n";
  std::vector<const char*> values = {"smooth_color",
                                     "linear_color",
                                     "flat_color",
                                     "smooth_color + linear_color",
                                     "gl_FragCoord * vec4(0.015, 0.015, 1.0, 1.0)",
                                     "smooth_color * flat_color",
                                     "smooth_color * 2.0 - 0.5"};
  if (needs.facing) values.push_back("(gl_FrontFacing ? smooth_color : linear_color)");
  if (needs.primitive_id && (stages.geometry.empty() || stages.primitive_id))
    values.push_back("vec4(float(gl_PrimitiveID & 7) * 0.125, smooth_color.yzw)");
  if (stages.drawn == Drawn::kPoints) values.push_back("vec4(gl_PointCoord, smooth_color.zw)");
  if (stages.layers > 1) values.push_back("vec4(float(gl_Layer) * 0.25, linear_color.yzw)");
  if (stages.viewports > 1) values.push_back("vec4(float(gl_ViewportIndex) * 0.25, linear_color.yzw)");
  if (needs.reads_mask) values.push_back("vec4(float(gl_SampleMaskIn[0] & 15) / 15.0, linear_color.yzw)");
  if (stages.views) values.push_back("vec4(float(gl_ViewIndex) * 0.25, smooth_color.yzw)");
  if (needs.per_sample) values.push_back("vec4(float(gl_SampleID) * 0.25, gl_SamplePosition, smooth_color.w)");
  std::string writes;
  for (size_t i = 0; i < target.colors.size(); ++i) {
    const FormatInfo& info = format_info(target.colors[i]);
    const std::string prefix = info.numeric == Numeric::kUint ? "u" : info.numeric == Numeric::kSint ? "i" : "";
    const std::string n = number(static_cast<uint32_t>(i)), value = random.pick(values);
    text +=
        "layout(location = " + n + (needs.dual ? ", index = 0" : "") + ") out " + prefix + "vec4 result" + n + ";\n";
    writes += "  result" + n + " = " + prefix + "vec4(" + (prefix.empty() ? value : "(" + value + ") * 100.0") + ");\n";
  }
  if (needs.dual) {
    text += "layout(location = 0, index = 1) out vec4 second;\n";
    writes += "  second = linear_color.wzyx;\n";
  }
  if (needs.facing && !target.colors.empty()) writes += "  if (gl_FrontFacing) result0 = result0.yzwx;\n";
  if (needs.discards) writes += "  if (smooth_color.x > 0.7) discard;\n";
  if (needs.writes_depth) writes += "  gl_FragDepth = linear_color.y;\n";
  if (needs.writes_stencil) writes += "  gl_FragStencilRefARB = int(linear_color.z * 300.0);\n";
  if (needs.counts) {
    text += "layout(binding = 0) buffer Counters { uint counters[]; };\n";
    writes +=
        "  atomicAdd(counters[uint(gl_FragCoord.y) * " + number(kCountedRow) + "u + uint(gl_FragCoord.x)], 1u);\n";
  }
  if (needs.writes_mask) writes += "  gl_SampleMask[0] = int(linear_color.x * 16.0);\n";
  return text + "void main() {\n" + writes + "}\n";
}

}  // namespace vitrine::cts
