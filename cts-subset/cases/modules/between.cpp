// The partners of tessellation and geometry shaders are written in GLSL: what they read comes from random numbers, what
// they write is captured by transform feedback.
#include "cases/modules/between.h"

#include <algorithm>

#include "cases/modules/resources.h"
#include "cases/modules/slots.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

using spv::Op;
using Mode = spv::ExecutionMode;
using Type = Reflection::Type;

constexpr VkDeviceSize kCaptured = 1u << 20;

/// One variable of the interface, for one vertex or the patch.
struct Crossing {
  uint32_t id = 0, type = 0, location = 0, component = 0;
  bool patch = false;
  uint32_t vertices = 0;  ///< length of the array of vertices

  std::string name() const { return "x" + std::to_string(id); }
};

/// All of a storage class with locations. Built-ins are left out, blocks of them too.
std::vector<Crossing> crossings(const Reflection& r, spv::StorageClass storage) {
  std::vector<Crossing> found;
  for (const Reflection::Variable& v : r.variables) {
    if (v.storage != storage || !r.interface.contains(v.id) || r.decoration(v.id, spv::Decoration::BuiltIn)) continue;
    Crossing c;
    c.id = v.id;
    c.type = v.pointee;
    c.patch = r.decoration(v.id, spv::Decoration::Patch).has_value();
    if (!c.patch && r.type(v.pointee).op == Op::OpTypeArray) {
      c.vertices = r.length(r.type(v.pointee), 0);
      c.type = r.type(v.pointee).operands[0];
    }
    if (r.decoration(c.type, spv::Decoration::BuiltIn, 0)) continue;
    const auto location = r.decoration(v.id, spv::Decoration::Location);
    if (!location) throw Unsupported("locations of members");
    c.location = *location;
    c.component = r.decoration(v.id, spv::Decoration::Component).value_or(0);
    found.push_back(c);
  }
  return found;
}

/// Writes types, values and declarations of crossing variables.
class Writer {
 public:
  explicit Writer(const Reflection& r) : r_(r) {}

  /// The type with the lengths of its arrays; structures are declared in `structures`.
  std::pair<std::string, std::string> type(uint32_t id) {
    const Type& t = r_.type(id);
    if (t.op == Op::OpTypeArray) {
      const auto [element, lengths] = type(t.operands[0]);
      return {element, "[" + std::to_string(r_.length(t, 0)) + "]" + lengths};
    }
    if (t.op != Op::OpTypeStruct) return {glsl_type(slot_of(r_, id)), ""};
    if (r_.decoration(id, spv::Decoration::Block)) throw Unsupported("input or output of a block");
    const std::string name = "S" + std::to_string(id);
    if (declared_.insert(id).second) {
      std::string members;
      for (size_t m = 0; m < t.operands.size(); m++) {
        const auto [member, lengths] = type(t.operands[m]);
        members += " " + member + " m" + std::to_string(m) + lengths + ";";
      }
      structures += "struct " + name + " {" + members + " };\n";
    }
    return {name, ""};
  }

  /// Random numbers; counts `seed` on.
  std::string value(uint32_t id, uint32_t& seed) {
    const Type& t = r_.type(id);
    const auto [name, lengths] = type(id);
    const uint32_t parts = t.op == Op::OpTypeArray    ? r_.length(t, 0)
                           : t.op == Op::OpTypeStruct ? static_cast<uint32_t>(t.operands.size())
                                                      : 0;
    if (parts == 0) return random_value(slot_of(r_, id), seed += 16);
    std::string text = name + lengths + "(";
    for (uint32_t i = 0; i < parts; i++)
      text += (i ? ", " : "") + value(t.operands[t.op == Op::OpTypeStruct ? i : 0], seed);
    return text + ")";
  }

  /// `words`: in, out, patch out; `array`: of vertices.
  std::string declaration(const Crossing& c, const std::string& words, const std::string& array,
                          const std::string& layout = "") {
    const auto [name, lengths] = type(c.type);
    return "layout(location = " + std::to_string(c.location) +
           (c.component ? ", component = " + std::to_string(c.component) : "") + layout + ") " + words + " " + name +
           " " + c.name() + array + lengths + ";\n";
  }

  /// Words of 32 bits.
  uint32_t words(uint32_t id) {
    const Type& t = r_.type(id);
    if (t.op == Op::OpTypeArray) return r_.length(t, 0) * words(t.operands[0]);
    if (t.op != Op::OpTypeStruct) return slot_of(r_, id).components * slot_of(r_, id).columns;
    uint32_t sum = 0;
    for (const uint32_t member : t.operands) sum += words(member);
    return sum;
  }

  std::string structures;

 private:
  const Reflection& r_;
  std::set<uint32_t> declared_;
};

/// A vertex shader that gives random numbers to `inputs` of the stage behind it.
std::string vertex_for(const Reflection& r, const std::vector<Crossing>& inputs) {
  Writer writer(r);
  std::string declarations, body;
  for (const Crossing& c : inputs) {
    if (c.patch) continue;
    uint32_t seed = c.location * 64 + c.component;
    declarations += writer.declaration(c, "out", "");
    body += "  " + c.name() + " = " + writer.value(c.type, seed) + ";\n";
  }
  return writer.structures + declarations + numbers_of("gl_VertexIndex") + "void main() {\n" + body +
         "  gl_Position = vec4(number(1001u), number(1002u), number(1003u), 1.0 + number(1004u));\n"
         "  gl_PointSize = 1.0;\n}\n";
}

/// A pipeline without rasterization.
struct Stages {
  Run& run;
  std::vector<VkPipelineShaderStageCreateInfo> list;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  uint32_t patch_points = 0;

  void add(VkShaderStageFlagBits stage, VkShaderModule module) {
    list.push_back({VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, stage, module, "main", nullptr});
  }
  void add(VkShaderStageFlagBits stage, const char* name, const std::string& text) {
    run.note(name, text);
    add(stage, run.shader(stage, text));
  }
  VkPipeline pipeline(VkPipelineLayout layout, VkRenderPass pass) const;
};

VkPipeline Stages::pipeline(VkPipelineLayout layout, VkRenderPass pass) const {
  const VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = topology;
  VkPipelineTessellationStateCreateInfo tessellation{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
  tessellation.patchControlPoints = patch_points;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.rasterizerDiscardEnable = VK_TRUE;
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.stageCount = static_cast<uint32_t>(list.size());
  info.pStages = list.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pTessellationState = patch_points ? &tessellation : nullptr;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &multisample;
  info.layout = layout;
  info.renderPass = pass;
  VkPipeline result;
  CTS_VK(vkCreateGraphicsPipelines(run.device, VK_NULL_HANDLE, 1, &info, nullptr, &result));
  return run.own(result, vkDestroyPipeline);
}

/// Draws, and puts out what is captured.
void capture(Run& run, const Stages& stages, const Bound& bound, uint32_t vertices) {
  run.require(run.gpu.has("VK_EXT_transform_feedback"), "transform feedback");
  const Target target = make_target(run, {});
  const VkPipeline pipeline = stages.pipeline(bound.layout, target.pass);
  const Buffer captured = run.buffer(kCaptured, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT);
  std::memset(captured.data, 0, kCaptured);
  const VkDeviceSize offset = 0, bytes = kCaptured;
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bound.bind(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS);
    CTS_COMMAND(run.gpu, CmdBindTransformFeedbackBuffersEXT)(cmd, 0, 1, &captured.handle, &offset, &bytes);
    CTS_COMMAND(run.gpu, CmdBeginTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
    vkCmdDraw(cmd, vertices, 1, 0, 0);
    CTS_COMMAND(run.gpu, CmdEndTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
    vkCmdEndRenderPass(cmd);
  });
  run.out("captured", captured, VK_FORMAT_R32_SFLOAT);
  bound.out(run);
}

struct InputPrimitive {
  Mode mode;
  VkPrimitiveTopology topology;
  uint32_t vertices;
};
constexpr InputPrimitive kInputs[] = {
    {Mode::InputPoints, VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 1},
    {Mode::InputLines, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 2},
    {Mode::InputLinesAdjacency, VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, 4},
    {Mode::Triangles, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 3},
    {Mode::InputTrianglesAdjacency, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, 6},
};

/// The modes of a control shader that its evaluation shader may repeat, as a GLSL layout: triangles where nothing says.
std::string tessellation_layout(const Reflection& r) {
  const auto one_of = [&](std::initializer_list<std::pair<Mode, const char*>> names) -> std::string {
    for (const auto& [mode, name] : names)
      if (r.modes.contains(mode)) return std::string(", ") + name;
    return "";
  };
  const std::string domain =
      one_of({{Mode::Triangles, "triangles"}, {Mode::Quads, "quads"}, {Mode::Isolines, "isolines"}});
  return (domain.empty() ? "triangles" : domain.substr(2)) +
         one_of({{Mode::SpacingFractionalOdd, "fractional_odd_spacing"},
                 {Mode::SpacingFractionalEven, "fractional_even_spacing"},
                 {Mode::SpacingEqual, "equal_spacing"}}) +
         one_of({{Mode::VertexOrderCw, "cw"}, {Mode::VertexOrderCcw, "ccw"}}) +
         one_of({{Mode::PointMode, "point_mode"}});
}

/// Control points that arrays of inputs ask for, or `otherwise`.
uint32_t points_of(const std::vector<Crossing>& inputs, uint32_t otherwise) {
  constexpr uint32_t kUnsized = 32;  // what glslang makes of arrays without a length
  for (const Crossing& c : inputs)
    if (c.vertices != 0 && c.vertices != kUnsized) return c.vertices;
  return otherwise;
}

/// Whether some instruction names the position among the outputs.
bool writes_position(const Reflection& r) {
  const auto position = static_cast<uint32_t>(spv::BuiltIn::Position);
  return std::any_of(r.variables.begin(), r.variables.end(), [&](const Reflection::Variable& v) {
    if (v.storage != spv::StorageClass::Output || !r.used.contains(v.id)) return false;
    const Type& t = r.type(v.pointee);
    return r.decoration(v.id, spv::Decoration::BuiltIn) == position ||
           (t.op == Op::OpTypeArray && r.decoration(t.operands[0], spv::Decoration::BuiltIn, 0) == position);
  });
}

/// Captures what a control shader gives to the patch and to one of its `points` vertices, chosen by gl_TessCoord.
std::string evaluation_behind(Run& run, const Reflection& r, uint32_t points) {
  const std::vector<Crossing> crossing = crossings(r, spv::StorageClass::Output);
  Writer writer(r);
  uint32_t stride = 16;
  for (const Crossing& c : crossing) stride += 4 * writer.words(c.type);
  run.require(stride <= 512, "few outputs");
  const auto place = [&](uint32_t offset) {
    return "xfb_buffer = 0, xfb_offset = " + std::to_string(offset) + ", xfb_stride = " + std::to_string(stride);
  };
  std::string declarations, body;
  uint32_t offset = 16;
  for (const Crossing& c : crossing) {
    declarations += writer.declaration(c, c.patch ? "patch in" : "in", c.patch ? "" : "[]");
    const auto [type, lengths] = writer.type(c.type);
    declarations += "layout(location = " + std::to_string(c.location) +
                    (c.component ? ", component = " + std::to_string(c.component) : "") + ", " + place(offset) +
                    ") out " + type + " o" + c.name() + lengths + ";\n";
    body += "  o" + c.name() + " = " + c.name() + (c.patch ? "" : "[vertex]") + ";\n";
    offset += 4 * writer.words(c.type);
  }
  return "layout(" + tessellation_layout(r) + ") in;\n" + writer.structures + declarations +
         "out gl_PerVertex { layout(" + place(0) + ") vec4 gl_Position; };\nvoid main() {\n" +
         "  int vertex = min(int(gl_TessCoord.x * " + std::to_string(points) + ".0), " + std::to_string(points - 1) +
         ");\n" + body + "  gl_Position = vec4(gl_TessCoord, 0.0)" +
         (writes_position(r) ? " + gl_in[vertex].gl_Position" : "") + ";\n}\n";
}

/// Gives random numbers to the inputs of an evaluation shader.
std::string control_for(const Reflection& r, const std::vector<Crossing>& inputs, uint32_t points) {
  Writer writer(r);
  std::string declarations, body;
  for (const Crossing& c : inputs) {
    uint32_t seed = c.location * 64 + c.component;
    declarations += writer.declaration(c, c.patch ? "patch out" : "out", c.patch ? "" : "[]");
    body += (c.patch ? "  if (gl_InvocationID == 0) " + c.name() : "  " + c.name() + "[gl_InvocationID]") + " = " +
            writer.value(c.type, seed) + ";\n";
  }
  return "layout(vertices = " + std::to_string(points) + ") out;\n" + writer.structures + declarations +
         numbers_of("(gl_PrimitiveID * " + std::to_string(points) + " + gl_InvocationID)") + "void main() {\n" + body +
         "  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
         "  gl_TessLevelOuter[0] = 3.0;\n  gl_TessLevelOuter[1] = 4.5;\n  gl_TessLevelOuter[2] = 2.0;\n"
         "  gl_TessLevelOuter[3] = 5.0;\n  gl_TessLevelInner[0] = 3.3;\n  gl_TessLevelInner[1] = 2.0;\n}\n";
}

}  // namespace

void run_geometry(Run& run, const Reflection& r, const std::vector<uint32_t>& words) {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  const Bound bound = bind_everything(run, r);
  uint32_t stride = 0, vertices = 0;
  const std::vector<uint32_t> capturing = with_feedback(r, words, stride);
  run.require(stride != 0 && stride <= 512, "an output to capture");
  Stages stages{run, {}};
  stages.add(VK_SHADER_STAGE_VERTEX_BIT, "vertex", vertex_for(r, crossings(r, spv::StorageClass::Input)));
  stages.add(VK_SHADER_STAGE_GEOMETRY_BIT, run.module(capturing));
  for (const InputPrimitive& input : kInputs)
    if (r.modes.contains(input.mode)) {
      stages.topology = input.topology;
      vertices = 8 * input.vertices;
    }
  capture(run, stages, bound, vertices);
}

void run_control(Run& run, const Reflection& r, const std::vector<uint32_t>& words) {
  run.require(run.gpu.features.tessellationShader, "tessellation");
  const Bound bound = bind_everything(run, r);
  const std::vector<Crossing> inputs = crossings(r, spv::StorageClass::Input);
  const uint32_t given = r.modes.at(Mode::OutputVertices);
  Stages stages{run, {}};
  stages.patch_points = points_of(inputs, given);
  stages.add(VK_SHADER_STAGE_VERTEX_BIT, "vertex", vertex_for(r, inputs));
  stages.add(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, run.module(words));
  stages.add(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, "evaluation", evaluation_behind(run, r, given));
  capture(run, stages, bound, 4 * stages.patch_points);
}

void run_evaluation(Run& run, const Reflection& r, const std::vector<uint32_t>& words) {
  run.require(run.gpu.features.tessellationShader, "tessellation");
  const Bound bound = bind_everything(run, r);
  uint32_t stride = 0;
  const std::vector<uint32_t> capturing = with_feedback(r, words, stride);
  run.require(stride != 0 && stride <= 512, "an output to capture");
  const bool triangles = r.modes.contains(Mode::Triangles), quads = r.modes.contains(Mode::Quads);
  run.require(triangles || quads || r.modes.contains(Mode::Isolines), "a domain");
  const std::vector<Crossing> inputs = crossings(r, spv::StorageClass::Input);
  Stages stages{run, {}};
  stages.patch_points = points_of(inputs, triangles ? 3 : quads ? 4 : 2);
  stages.add(VK_SHADER_STAGE_VERTEX_BIT, "vertex", vertex_for(r, {}));
  stages.add(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, "control", control_for(r, inputs, stages.patch_points));
  stages.add(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, run.module(capturing));
  capture(run, stages, bound, 4 * stages.patch_points);
}

}  // namespace vitrine::cts
