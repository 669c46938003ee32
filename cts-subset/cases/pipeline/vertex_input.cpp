// Vertex attributes: every format that the reference fetches, strides, offsets, instance rate, missing components.
#include "cases/deviations/deviation.h"
#include "harness/case.h"
#include "harness/graphics.h"
#include "texel/format.h"

namespace vitrine::cts {
namespace {

struct Attribute {
  VkFormat format;
  std::string name;
  uint32_t bytes;
  char kind;  ///< f, u or i: what the shader declares
};

/// Plain colour formats of up to 32 bits a component.
std::vector<Attribute> attributes() {
  std::vector<Attribute> result;
  const auto add = [&](int first, int last) {
    for (int number = first; number <= last; ++number) {
      const auto format = static_cast<VkFormat>(number);
      const texel::FormatDesc& desc = texel::format_desc(format);
      if (!desc.plain || desc.is_srgb() || desc.is_depth_stencil()) continue;
      const char kind = !desc.is_integer() ? 'f' : desc.kind == texel::Kind::kSint ? 'i' : 'u';
      result.push_back({format, std::string(desc.name), desc.block_bytes, kind});
    }
  };
  add(VK_FORMAT_R4G4B4A4_UNORM_PACK16, VK_FORMAT_E5B9G9R9_UFLOAT_PACK32);
  add(VK_FORMAT_A4R4G4B4_UNORM_PACK16, VK_FORMAT_A4B4G4R4_UNORM_PACK16);
  return result;
}

/// The reference keeps eight bits of a vertex format's number, so it takes these for others.
bool is_mistaken(const Attribute& attribute) {
  switch (attribute.format) {
    case VK_FORMAT_B4G4R4A4_UNORM_PACK16:
    case VK_FORMAT_R5G5B5A1_UNORM_PACK16:
    case VK_FORMAT_B5G5R5A1_UNORM_PACK16:
      return true;
    default:
      return false;
  }
}

/// The format whose values the shader makes the attribute's of on the reference, where that does not fetch it.
VkFormat reference_format(VkFormat format) {
  switch (format) {
    case VK_FORMAT_A2R10G10B10_SINT_PACK32:
    case VK_FORMAT_A2B10G10R10_SINT_PACK32:
      return VK_FORMAT_R32_SINT;
    case VK_FORMAT_R4G4B4A4_UNORM_PACK16:
      return VK_FORMAT_A4B4G4R4_UNORM_PACK16;
    default:
      return format;
  }
}

/// What the vertex shader takes the value from.
enum class Source { kAttribute, kOther, kTexels };

/// Bytes from one vertex to the next; the attribute lies at byte 4.
uint32_t stride_of(const Attribute& attribute) { return (attribute.bytes + 3) / 4 * 4 + 8; }

/// Declarations of the source, and VALUE.
std::string source_text(const Attribute& attribute, Source source, const std::string& type) {
  const std::string declaration = "layout(location = 3) in " + type + " value;\n#define VALUE ";
  if (source == Source::kAttribute) return declaration + "value\n";
  if (source == Source::kTexels)
    return "layout(binding = 0) uniform samplerBuffer texels;\n#define VALUE texelFetch(texels, (4 + gl_VertexIndex "
           "* " +
           std::to_string(stride_of(attribute)) + ") / " + std::to_string(attribute.bytes) + ")\n";
  if (attribute.format == VK_FORMAT_R4G4B4A4_UNORM_PACK16) return declaration + "value.abgr\n";
  const bool red_low = attribute.format == VK_FORMAT_A2B10G10R10_SINT_PACK32;
  const std::string low = "bitfieldExtract(value.x, 0, 10)", high = "bitfieldExtract(value.x, 20, 10)";
  return declaration + "ivec4(" + (red_low ? low : high) + ", bitfieldExtract(value.x, 10, 10), " +
         (red_low ? high : low) + ", bitfieldExtract(value.x, 30, 2))\n";
}

Buffer random_vertices(Run& run, const Attribute& attribute, VkBufferUsageFlags usage = 0) {
  const Buffer vertices = run.buffer(stride_of(attribute) * 4096 + 64, usage);
  for (VkDeviceSize i = 0; i < vertices.size; ++i)
    vertices.data[i] = static_cast<unsigned char>(run.random.bits() >> 24);
  return vertices;
}

/// Each vertex is one pixel of a 64x64 target that receives the attribute, unchanged and flat.
void fetch_format(Run& run, const Attribute& attribute, const Buffer& vertices, Source source) {
  TargetSpec target_spec;
  target_spec.colors = {attribute.kind == 'f'   ? VK_FORMAT_R32G32B32A32_SFLOAT
                        : attribute.kind == 'u' ? VK_FORMAT_R32G32B32A32_UINT
                                                : VK_FORMAT_R32G32B32A32_SINT};
  const Target target = make_target(run, target_spec);
  const std::string type = attribute.kind == 'f' ? "vec4" : std::string(1, attribute.kind) + "vec4";
  GraphicsSpec spec;
  spec.vertex = source_text(attribute, source, type) + "layout(location = 0) flat out " + type + R"( passed;
void main() {
  passed = VALUE;
  gl_Position = vec4((float(gl_VertexIndex & 63) + 0.5) / 32.0 - 1.0, (float(gl_VertexIndex >> 6) + 0.5) / 32.0 - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
})";
  spec.fragment = "layout(location = 0) flat in " + type + " passed;\nlayout(location = 0) out " + type +
                  " result;\nvoid main() { result = passed; }\n";
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  Resources res;
  if (source == Source::kTexels) {
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = vertices.handle;
    info.format = attribute.format;
    info.range = VK_WHOLE_SIZE;
    VkBufferView view;
    CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &view));
    run.own(view, vkDestroyBufferView);
    res = run.resources({{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, {}, {}, {view}}});
    spec.layout = res.layout;
  } else {
    spec.bindings = {{2, stride_of(attribute), VK_VERTEX_INPUT_RATE_VERTEX}};
    spec.attributes = {{3, 2, source == Source::kOther ? reference_format(attribute.format) : attribute.format, 4}};
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    if (source == Source::kTexels)
      res.bind(cmd);
    else
      bind_vertices(cmd, vertices, 2);
    vkCmdDraw(cmd, 4096, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out(source == Source::kTexels ? "texels" : "color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
}

bool fetches(const Run& run, const Attribute& attribute) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(run.gpu.physical, attribute.format, &properties);
  return properties.bufferFeatures & VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT;
}

const bool kRegistered = [] {
  for (const Attribute& attribute : attributes()) {
    if (is_mistaken(attribute)) {
      AddCase("pipeline", "deviation.vertex_format_numbers." + attribute.name, "vertex-format-numbers",
              case_against_control, [=](Run& run) {
                run.require(fetches(run, attribute), attribute.name.c_str());
                const Buffer vertices = random_vertices(run, attribute, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
                fetch_format(run, attribute, vertices, Source::kAttribute);
                fetch_format(run, attribute, vertices, Source::kTexels);
              });
      continue;
    }
    AddCase("pipeline", "vertex_input." + attribute.name, [=](Run& run) {
      const bool other = reference_format(attribute.format) != attribute.format && &run.gpu == &gpus().reference;
      run.require(other || fetches(run, attribute), attribute.name.c_str());
      fetch_format(run, attribute, random_vertices(run, attribute), other ? Source::kOther : Source::kAttribute);
    });
  }
  return true;
}();

CTS_CASE("pipeline", "vertex_input.several_bindings") {
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in mat2x4 m;
layout(location = 4) in vec3 tint;
layout(location = 5) in float alpha;
layout(location = 0) out vec4 passed;
void main() {
  passed = vec4(tint, alpha) + m[1] * 0.1;
  gl_Position = vec4(position * 0.5 + m[0].xy, m[0].z * 0.25 + 0.5, 1.0);
})";
  spec.fragment = kColorFragment;
  spec.bindings = {{0, 8, VK_VERTEX_INPUT_RATE_VERTEX},
                   {1, 32, VK_VERTEX_INPUT_RATE_INSTANCE},
                   {5, 16, VK_VERTEX_INPUT_RATE_VERTEX}};
  spec.attributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, 0},
                     {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
                     {2, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 16},
                     {4, 5, VK_FORMAT_R32G32B32_SFLOAT, 0},
                     {5, 5, VK_FORMAT_R32_SFLOAT, 12}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values(4096);
  for (float& value : values) value = run.random.real(-1, 1);
  const Buffer buffer = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    const VkBuffer buffers[] = {buffer.handle, buffer.handle};
    const VkDeviceSize offsets[] = {128, 1024}, last = 64;
    vkCmdBindVertexBuffers(cmd, 0, 2, buffers, offsets);
    vkCmdBindVertexBuffers(cmd, 5, 1, buffers, &last);
    vkCmdDraw(cmd, 18, 4, 3, 1);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_CASE("pipeline", "vertex_input.stride_zero") {
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.bindings = {{0, 16, VK_VERTEX_INPUT_RATE_VERTEX}, {1, 0, VK_VERTEX_INPUT_RATE_VERTEX}};
  spec.attributes = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0}, {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer positions = run.buffer_of<float>({-0.8f, -0.7f, 0, 1, 0.9f, -0.2f, 0, 1, 0.1f, 0.8f, 0, 1});
  const Buffer color = run.buffer_of<float>({0.3f, 0.6f, 0.9f, 1.0f});
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, positions, 0);
    bind_vertices(cmd, color, 1);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
