// A module of others: compute shaders run on random resources, fragment shaders behind a vertex shader of random
// outputs, of vertex shaders the outputs are captured; between.cpp has the stages between them. With
// CTS_MODULES_FILTERS fragment shaders are filters of a whole picture of the format of windows.
#include "cases/modules/run_module.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "cases/modules/between.h"
#include "cases/modules/reflect.h"
#include "cases/modules/resources.h"
#include "cases/modules/slots.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

using Type = Reflection::Type;

void run_compute(Run& run, const Reflection& r, const std::vector<uint32_t>& words, const ModuleRun& how) {
  const Bound bound = bind_everything(run, r, how.scale);  // texels for all
  const VkPipeline pipeline = run.compute(bound.layout, run.module(words));
  const bool flat = r.local_size[1] <= 1;
  const auto groups = [&](int i) { return how.scale * std::max(1u, std::min(8u, 64u / r.local_size[i])); };
  how.submit(run, [&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    bound.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, flat ? how.scale * groups(0) : groups(0), flat ? 1 : groups(1), 1);
  });
  bound.out(run);
}

bool filters() { return std::getenv("CTS_MODULES_FILTERS") != nullptr; }

/// Two triangles that are the whole target; `coordinates` go from 0 to 1 over it.
std::string rectangle_of(const std::string& declarations, const std::string& body) {
  return declarations +
         "void main() {\n  vec2 at = vec2[](vec2(0), vec2(1, 0), vec2(0, 1), vec2(1, 0), vec2(0, 1), vec2(1))"
         "[gl_VertexIndex];\n  vec4 coordinates = at.xyxy;\n" +
         body + "  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);\n}\n";
}

/// Triangles over everything with a random value for every input of the fragment shader.
std::string vertex_for(const Reflection& r) {
  std::string declarations, body;
  for (const Reflection::Variable& v : r.variables) {
    const auto location = r.decoration(v.id, spv::Decoration::Location);
    if (v.storage != spv::StorageClass::Input || !r.interface.contains(v.id)) continue;
    if (!location) {
      if (!r.decoration(v.id, spv::Decoration::BuiltIn)) throw Unsupported("input of a block");
      continue;
    }
    const Slot slot = slot_of(r, v.pointee);
    if (slot.lengths.size() > 1) throw Unsupported("input array of arrays");
    const std::string name = "o" + std::to_string(v.id);
    const auto component = r.decoration(v.id, spv::Decoration::Component);
    declarations += "layout(location = " + std::to_string(*location) +
                    (component ? ", component = " + std::to_string(*component) : "") + ") out " + glsl_type(slot) +
                    " " + name + (slot.lengths.empty() ? "" : "[" + std::to_string(slot.lengths[0]) + "]") + ";\n";
    for (uint32_t i = 0; i < (slot.lengths.empty() ? 1 : slot.lengths[0]); i++)
      body += "  " + name + (slot.lengths.empty() ? "" : "[" + std::to_string(i) + "]") + " = " +
              (filters() && slot.scalar == "float" && slot.columns == 1
                   ? glsl_type(slot) + "(coordinates)"
                   : random_value(slot, (*location + i) * 16 + component.value_or(0))) +
              ";\n";
  }
  if (filters()) return rectangle_of(declarations + numbers_of("0"), body);
  return declarations + numbers_of("gl_VertexIndex") + "void main() {\n" + body +
         R"(
  vec2 at = gl_VertexIndex < 3 ? vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0
                               : vec2(number(1001u), number(1002u)) * 2.0 - 1.0;
  float w = 1.0 + 0.25 * float(gl_VertexIndex % 3);
  gl_Position = vec4(at * w, 0.5 * w, w);
})";
}

void run_fragment(Run& run, const Reflection& r, const std::vector<uint32_t>& words, const ModuleRun& how) {
  const Bound bound = bind_everything(run, r);
  TargetSpec target_spec;
  target_spec.colors.clear();
  for (const Reflection::Variable& v : r.variables) {
    const auto location = r.decoration(v.id, spv::Decoration::Location);
    if (v.storage != spv::StorageClass::Output || !location || !r.interface.contains(v.id)) continue;
    if (r.decoration(v.id, spv::Decoration::Index).value_or(0) != 0) throw Unsupported("dual sources");
    const Slot slot = slot_of(r, v.pointee);
    if (*location + slot.locations() > 8) throw Unsupported("many outputs");
    target_spec.colors.resize(std::max<size_t>(target_spec.colors.size(), *location + slot.locations()),
                              VK_FORMAT_R32G32B32A32_SFLOAT);
    if (filters() && slot.scalar == "float") {
      target_spec.colors[*location] = VK_FORMAT_B8G8R8A8_UNORM;
      continue;
    }
    for (uint32_t i = 0; i < slot.locations(); i++)
      target_spec.colors[*location + i] = slot.scalar == "float" ? VK_FORMAT_R32G32B32A32_SFLOAT
                                          : slot.scalar == "int" ? VK_FORMAT_R32G32B32A32_SINT
                                                                 : VK_FORMAT_R32G32B32A32_UINT;
  }
  if (target_spec.colors.empty()) target_spec.depth = VK_FORMAT_D32_SFLOAT;
  if (filters()) {
    run.require(target_spec.colors.size() == 1, "one colour");
    target_spec.width = 320;
    target_spec.height = 180;
  }
  target_spec.width *= how.scale;
  target_spec.height *= how.scale;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = vertex_for(r);
  spec.fragment_module = run.module(words);
  spec.layout = bound.layout;
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = target_spec.colors.empty();
  spec.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  run.note("vertex", spec.vertex);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  how.submit(run, [&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bound.bind(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS);
    vkCmdDraw(cmd, filters() ? 6 : 24, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  bound.out(run);
}

void run_vertex(Run& run, const Reflection& r, const std::vector<uint32_t>& words, const ModuleRun& how) {
  run.require(run.gpu.has("VK_EXT_transform_feedback"), "transform feedback");
  constexpr uint32_t kVertices = 3;  // shaders index arrays of three
  const uint32_t instances = 16 * how.scale * how.scale;
  const Bound bound = bind_everything(run, r);
  uint32_t stride = 0;
  GraphicsSpec spec;
  spec.vertex_module = run.module(with_feedback(r, words, stride));
  run.require(stride != 0 && stride <= 512, "an output to capture");
  spec.layout = bound.layout;
  uint32_t end = 0;
  for (const Reflection::Variable& v : r.variables) {
    const auto location = r.decoration(v.id, spv::Decoration::Location);
    if (v.storage != spv::StorageClass::Input || !location) continue;
    const Slot slot = slot_of(r, v.pointee);
    for (uint32_t i = 0; i < slot.locations(); i++, end += 16)
      spec.attributes.push_back({*location + i, 0,
                                 slot.scalar == "float" ? VK_FORMAT_R32G32B32A32_SFLOAT
                                 : slot.scalar == "int" ? VK_FORMAT_R32G32B32A32_SINT
                                                        : VK_FORMAT_R32G32B32A32_UINT,
                                 end});
  }
  if (end != 0) spec.bindings.push_back({0, end, VK_VERTEX_INPUT_RATE_VERTEX});
  const Buffer vertices = run.buffer(std::max(16u, end * kVertices));
  for (const VkVertexInputAttributeDescription& a : spec.attributes)
    for (uint32_t i = 0; i < kVertices * 4; i++) {
      unsigned char* const at = vertices.data + i / 4 * end + a.offset + i % 4 * 4;
      const float number = run.random.real(-1, 1);
      const uint32_t integer = run.random.below(4);
      std::memcpy(at, a.format == VK_FORMAT_R32G32B32A32_SFLOAT ? static_cast<const void*>(&number) : &integer, 4);
    }
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  spec.raster.rasterizerDiscardEnable = VK_TRUE;
  const Target target = make_target(run, {});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const VkDeviceSize bytes = VkDeviceSize{stride} * kVertices * instances, offset = 0;
  const Buffer captured = run.buffer(bytes, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT);
  how.submit(run, [&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bound.bind(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS);
    bind_vertices(cmd, vertices);
    CTS_COMMAND(run.gpu, CmdBindTransformFeedbackBuffersEXT)(cmd, 0, 1, &captured.handle, &offset, &bytes);
    CTS_COMMAND(run.gpu, CmdBeginTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
    vkCmdDraw(cmd, kVertices, instances, 0, 0);
    CTS_COMMAND(run.gpu, CmdEndTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
    vkCmdEndRenderPass(cmd);
  });
  run.out("captured", captured, VK_FORMAT_R32_SFLOAT);
  bound.out(run);
}

}  // namespace

void run_module(Run& run, const std::filesystem::path& path, const ModuleRun& how) try {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::vector<uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  const Reflection r(words);
  using C = spv::Capability;
  for (const C capability :
       {C::RayTracingKHR, C::RayTracingNV, C::RayQueryKHR, C::MeshShadingEXT, C::MeshShadingNV,
        C::FragmentShadingRateKHR, C::FragmentBarycentricKHR, C::PhysicalStorageBufferAddresses, C::FragmentDensityEXT})
    run.require(!r.capabilities.contains(capability), "a capability of the module");
  run.require(r.entry_name == "main", "an entry point main");
  if (r.model == spv::ExecutionModel::GLCompute)
    run_compute(run, r, words, how);
  else if (r.model == spv::ExecutionModel::Fragment)
    run_fragment(run, r, words, how);
  else if (r.model == spv::ExecutionModel::Vertex)
    run_vertex(run, r, words, how);
  else if (how.scaled_stages_only)
    throw Unsupported("the stage");
  else if (r.model == spv::ExecutionModel::Geometry)
    run_geometry(run, r, words);
  else if (r.model == spv::ExecutionModel::TessellationControl)
    run_control(run, r, words);
  else if (r.model == spv::ExecutionModel::TessellationEvaluation)
    run_evaluation(run, r, words);
  else
    throw Unsupported("the stage");
  run.may_be_blank();
} catch (const std::out_of_range&) {
  throw Unsupported("types that the reflection does not know");
}

}  // namespace vitrine::cts
