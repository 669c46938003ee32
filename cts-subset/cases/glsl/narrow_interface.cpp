// Inputs and outputs of 16 bits (storageInputOutput16): attributes, what stages hand on, colours. The reference, which
// has none, hands 32-bit numbers on and converts where it reads and writes them.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

struct Number {
  const char *scalar, *vector;            ///< inside the shader
  const char *wide_scalar, *wide_vector;  ///< what the reference hands on
  char kind;                              ///< f, i, u
};
constexpr Number kHalf = {"float16_t", "f16vec", "float", "vec", 'f'};
constexpr Number kShort = {"int16_t", "i16vec", "int", "ivec", 'i'};
constexpr Number kUshort = {"uint16_t", "u16vec", "uint", "uvec", 'u'};
constexpr Number kFloat = {"float", "vec", "float", "vec", 'f'};

std::string named(const char* scalar, const char* vector, uint32_t components) {
  return components == 1 ? scalar : vector + std::to_string(components);
}

/// One variable of the interface between two stages.
struct Varying {
  Number number = kHalf;
  uint32_t components = 1, location = 0, component = 0;
  uint32_t length = 0;  ///< of an array; 0: none
  bool in_struct = false;
  std::string qualifier;  ///< as the fragment shader's input

  std::string type() const { return named(number.scalar, number.vector, components); }
  uint32_t elements() const { return std::max(length, 1u); }
};

class Interface {
 public:
  explicit Interface(const Run& run) : narrow_(run.gpu.extension_features.storageInputOutput16) {
    const auto& sizes = run.gpu.extension_features;
    run.require(run.gpu.features.shaderInt16 && sizes.shaderFloat16, "16-bit arithmetic");
  }

  std::string head() const {
    return std::string("#version 450\n#extension GL_EXT_shader_explicit_arithmetic_types : require\n") +
           (narrow_ ? "#extension GL_EXT_shader_16bit_storage : require\n" : "");
  }
  std::string crossing(const Number& number, uint32_t components) const {
    return narrow_ ? named(number.scalar, number.vector, components)
                   : named(number.wide_scalar, number.wide_vector, components);
  }
  /// `array`: of vertices, such as "[]".
  std::string declaration(const Varying& v, const std::string& words, const std::string& name,
                          const std::string& array = "") const {
    const std::string count = v.length != 0 ? "[" + std::to_string(v.length) + "]" : "";
    std::string text = "layout(location = " + std::to_string(v.location);
    if (v.component != 0) text += ", component = " + std::to_string(v.component);
    text += ") " + words + " ";
    const std::string type = crossing(v.number, v.components);
    if (!v.in_struct) return text + type + " " + name + array + count + ";\n";
    return "struct S" + name + " { " + type + " x" + count + "; };\n" + text + "S" + name + " " + name + array + ";\n";
  }
  static std::string element(const Varying& v, const std::string& name, uint32_t i) {
    return name + (v.in_struct ? ".x" : "") + (v.length != 0 ? "[" + std::to_string(i) + "]" : "");
  }
  static std::string read(const Varying& v, const std::string& name, uint32_t i) {
    return v.type() + "(" + element(v, name, i) + ")";
  }
  std::string write(const Varying& v, const std::string& name, uint32_t i, const std::string& value) const {
    return "  " + element(v, name, i) + " = " + crossing(v.number, v.components) + "(" + value + ");\n";
  }

 private:
  bool narrow_;
};

/// The bits of a number as a uvec4.
std::string bits_of(const Varying& v, const std::string& value) {
  std::string bits = value;
  if (v.number.kind == 'f')
    bits = v.number.scalar == kFloat.scalar ? "floatBitsToUint(" + value + ")" : "float16BitsToUint16(" + value + ")";
  std::string text = "uvec4(" + named("uint", "uvec", v.components) + "(" + bits + ")";
  for (uint32_t c = v.components; c < 4; ++c) text += ", 0u";
  return text + ")";
}

std::string literal(const Varying& v, const char* number) { return std::string(v.number.scalar) + "(" + number + ")"; }

// ---- attributes

struct Attribute {
  VkFormat format;
  const char* name;
  Number number;
};
#define ROW(format, number) \
  { VK_FORMAT_##format, #format, number }
constexpr Attribute kAttributes[] = {
    ROW(R16_SFLOAT, kHalf),          ROW(R16G16_SFLOAT, kHalf),
    ROW(R16G16B16A16_SFLOAT, kHalf), ROW(R32G32B32A32_SFLOAT, kHalf),
    ROW(R8G8B8A8_UNORM, kHalf),      ROW(R16G16_SNORM, kHalf),
    ROW(R16_SINT, kShort),           ROW(R16G16B16A16_SINT, kShort),
    ROW(R8G8_SINT, kShort),          ROW(R32G32_SINT, kShort),
    ROW(R16_UINT, kUshort),          ROW(R16G16B16A16_UINT, kUshort),
    ROW(R8G8B8A8_UINT, kUshort),     ROW(R32G32B32A32_UINT, kUshort),
    ROW(B8G8R8A8_UNORM, kHalf),      ROW(A2B10G10R10_UINT_PACK32, kUshort),
};
#undef ROW

/// Each vertex is a pixel of the target, which receives the attribute's bits.
void fetch(Run& run, const Attribute& attribute) {
  const Interface interface(run);
  Varying v;
  v.number = attribute.number;
  v.components = 1 + run.random.below(4);
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_UINT}});
  GraphicsSpec spec;
  spec.vertex = interface.head() + interface.declaration(v, "in", "a") +
                "layout(location = 0) flat out uvec4 passed;\nvoid main() {\n  " + v.type() +
                " value = " + Interface::read(v, "a", 0) + ";\n  passed = " + bits_of(v, "value") + R"(;
  gl_Position = vec4((float(gl_VertexIndex & 63) + 0.5) / 32.0 - 1.0, (float(gl_VertexIndex >> 6) + 0.5) / 32.0 - 1.0,
                     0.0, 1.0);
  gl_PointSize = 1.0;
})";
  spec.fragment =
      "layout(location = 0) flat in uvec4 passed;\nlayout(location = 0) out uvec4 result;\n"
      "void main() { result = passed; }\n";
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  const uint32_t bytes = format_info(attribute.format).bytes, stride = (bytes + 3) & ~3u;
  spec.bindings = {{0, stride, VK_VERTEX_INPUT_RATE_VERTEX}};
  spec.attributes = {{0, 0, attribute.format, 0}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_texels(run.random, attribute.format, size_t{stride} * 4096));
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 4000, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

// ---- from stage to stage

std::vector<Varying> random_varyings(Random& random) {
  std::vector<Varying> varyings;
  uint32_t location = 0;
  while (varyings.size() < 7) {
    Varying v;
    v.number = random.pick({kHalf, kHalf, kShort, kUshort, kFloat});
    v.components = 1 + random.below(4);
    v.location = location;
    if (v.number.kind != 'f' || random.chance(0.2f))
      v.qualifier = "flat";
    else
      v.qualifier = random.pick<const char*>({"", "", "noperspective", "centroid", "noperspective sample"});
    if (random.chance(0.25f)) v.length = 2 + random.below(2);
    v.in_struct = random.chance(0.2f);
    location += v.elements();
    varyings.push_back(v);
    // The rest of the location for another of its kind.
    if (v.in_struct || v.length != 0 || v.components > 2 || random.chance(0.5f)) continue;
    v.component = v.components;
    v.components = 1 + random.below(4 - v.component);
    varyings.push_back(v);
  }
  return varyings;
}

/// The text of the stages: the variables of stage s are named by its letter and their number.
class StageWriter {
 public:
  StageWriter(const Interface& interface, std::vector<Varying> varyings)
      : interface_(interface), varyings_(std::move(varyings)) {}

  uint32_t count() const { return static_cast<uint32_t>(varyings_.size()); }

  std::string vertex() const {
    std::string text = interface_.head() + "layout(location = 0) in vec4 position;\n";
    for (size_t k = 0; k < varyings_.size(); ++k) text += interface_.declaration(input(k), "in", name('a', k));
    text += outputs("out", 'v') + "void main() {\n  gl_Position = position;\n";
    for (size_t k = 0; k < varyings_.size(); ++k)
      for (uint32_t i = 0; i < varyings_[k].elements(); ++i)
        text += interface_.write(
            varyings_[k], name('v', k), i,
            Interface::read(input(k), name('a', k), 0) + " + " + literal(varyings_[k], i == 0 ? "1" : "3"));
    return text + "}\n";
  }

  /// Three variables cross as the patch's, too.
  std::string control() const {
    std::string text =
        interface_.head() + "layout(vertices = 3) out;\n" + inputs('v', "[]") + outputs("out", 'c', "[]");
    for (size_t k = 0; k < kPatchEnd; k += 2) text += interface_.declaration(patch(k), "patch out", name('p', k));
    text +=
        "void main() {\n  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
        "  gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 3.0;\n  gl_TessLevelInner[0] = 2.0;\n";
    const std::string own = "[gl_InvocationID]", next = "[(gl_InvocationID + 1) % 3]";
    for (size_t k = 0; k < varyings_.size(); ++k)
      for (uint32_t i = 0; i < varyings_[k].elements(); ++i) {
        const Varying& v = varyings_[k];
        text += interface_.write(v, name('c', k) + own, i,
                                 Interface::read(v, name('v', k) + own, i) + " + " +
                                     Interface::read(v, name('v', k) + next, i) + " * " + literal(v, "2"));
        if (is_patch(k))
          text += "  if (gl_InvocationID == 1)" +
                  interface_.write(patch(k), name('p', k), i, Interface::read(v, name('v', k) + next, i));
      }
    return text + "}\n";
  }

  std::string evaluation() const {
    std::string text = interface_.head() + "layout(triangles) in;\n" + inputs('c', "[]");
    for (size_t k = 0; k < kPatchEnd; k += 2) text += interface_.declaration(patch(k), "patch in", name('p', k));
    text += outputs("out", 'e') +
            "void main() {\n  gl_Position = gl_in[0].gl_Position * gl_TessCoord.x + gl_in[1].gl_Position * "
            "gl_TessCoord.y + gl_in[2].gl_Position * gl_TessCoord.z;\n";
    for (size_t k = 0; k < varyings_.size(); ++k)
      for (uint32_t i = 0; i < varyings_[k].elements(); ++i) {
        const Varying& v = varyings_[k];
        std::string value =
            Interface::read(v, name('c', k) + "[0]", i) + " - " + Interface::read(v, name('c', k) + "[2]", i) + " * " +
            (v.number.kind == 'f' ? std::string(v.number.scalar) + "(gl_TessCoord.x)" : literal(v, "3"));
        if (is_patch(k)) value += " + " + Interface::read(patch(k), name('p', k), i);
        text += interface_.write(v, name('e', k), i, value);
      }
    return text + "}\n";
  }

  std::string geometry(char from) const {
    std::string text = interface_.head() + "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 6) out;\n" +
                       inputs(from, "[]") + outputs("out", 'g') +
                       "void main() {\n  for (int n = 0; n < 6; n++) {\n    int j = n % 3;\n"
                       "    gl_Position = gl_in[j].gl_Position * vec4(n < 3 ? 1.0 : 0.6, 1.0, 1.0, 1.0);\n";
    for (size_t k = 0; k < varyings_.size(); ++k)
      for (uint32_t i = 0; i < varyings_[k].elements(); ++i) {
        const Varying& v = varyings_[k];
        text += interface_.write(v, name('g', k), i,
                                 Interface::read(v, name(from, k) + "[j]", i) + " + " + v.number.scalar + "(n)");
      }
    return text + "    EmitVertex();\n    if (j == 2) EndPrimitive();\n  }\n}\n";
  }

  /// Four colours of the variables' bits, and the first float, signed and unsigned ones as colours of their own.
  std::string fragment(char from, const std::vector<Number>& colors) const {
    std::string text = interface_.head();
    for (size_t k = 0; k < varyings_.size(); ++k)
      text += interface_.declaration(varyings_[k], varyings_[k].qualifier + " in", name(from, k));
    for (uint32_t c = 0; c < 4; ++c)
      text += "layout(location = " + std::to_string(c) + ") out uvec4 bits" + std::to_string(c) + ";\n";
    for (uint32_t c = 0; c < colors.size(); ++c) text += color_declarations(colors[c], c);
    text += "void main() {\n  uvec4 sum[4] = uvec4[4](uvec4(0u), uvec4(0u), uvec4(0u), uvec4(0u));\n";
    for (size_t k = 0; k < varyings_.size(); ++k)
      for (uint32_t i = 0; i < varyings_[k].elements(); ++i)
        text += "  sum[" + std::to_string(k % 4) + "] = sum[" + std::to_string(k % 4) + "] * 69069u + " +
                bits_of(varyings_[k], Interface::read(varyings_[k], name(from, k), i)) + ";\n";
    for (uint32_t c = 0; c < 4; ++c) text += "  bits" + std::to_string(c) + " = sum[" + std::to_string(c) + "];\n";
    for (uint32_t c = 0; c < colors.size(); ++c) text += color_values(colors[c], c, from);
    return text + "}\n";
  }

  /// Attribute k: one element, a location of its own.
  Varying input(size_t k) const {
    Varying v = varyings_[k];
    v.location = static_cast<uint32_t>(k) + 1;
    v.component = 0;
    v.length = 0;
    v.in_struct = false;
    return v;
  }

 private:
  static std::string name(char stage, size_t k) { return stage + std::to_string(k); }
  /// Behind the locations of the vertices' variables.
  Varying patch(size_t k) const {
    Varying v = varyings_[k];
    v.location = 22 + static_cast<uint32_t>(k / 2) * 3;
    return v;
  }
  static constexpr size_t kPatchEnd = 6;
  static bool is_patch(size_t k) { return k % 2 == 0 && k < kPatchEnd; }
  std::string outputs(const std::string& words, char stage, const std::string& array = "") const {
    std::string text;
    for (size_t k = 0; k < varyings_.size(); ++k) {
      const bool last = array.empty() && varyings_[k].qualifier.starts_with("flat");
      text += interface_.declaration(varyings_[k], (last ? "flat " : "") + words, name(stage, k), array);
    }
    return text;
  }
  std::string inputs(char stage, const std::string& array) const {
    std::string text;
    for (size_t k = 0; k < varyings_.size(); ++k)
      text += interface_.declaration(varyings_[k], "in", name(stage, k), array);
    return text;
  }
  /// Odd colours come as two variables of two components.
  std::string color_declarations(const Number& number, uint32_t c) const {
    const std::string at = "layout(location = " + std::to_string(c + 4), name = "color" + std::to_string(c);
    if (c % 2 == 0) return at + ") out " + interface_.crossing(number, 4) + " " + name + ";\n";
    return at + ") out " + interface_.crossing(number, 2) + " " + name + "_low;\n" + at + ", component = 2) out " +
           interface_.crossing(number, 2) + " " + name + "_high;\n";
  }
  std::string color_values(const Number& number, uint32_t c, char from) const {
    const std::string name = "color" + std::to_string(c), low = named(number.scalar, number.vector, 2);
    std::string value = std::string(number.scalar) + "(2)";
    for (size_t k = 0; k < varyings_.size(); ++k)
      if (varyings_[k].number.scalar == number.scalar && varyings_[k].components == 1)
        value = Interface::read(varyings_[k], StageWriter::name(from, k), 0);
    const std::string all = named(number.scalar, number.vector, 4) + "(" + value + ") + " +
                            named(number.scalar, number.vector, 4) + "(gl_FragCoord.x * " +
                            (number.kind == 'f' ? "0.01" : "1.0") + ", gl_FragCoord.y, 1.0, 0.5)";
    if (c % 2 == 0) return "  " + name + " = " + interface_.crossing(number, 4) + "(" + all + ");\n";
    return "  " + name + "_low = " + interface_.crossing(number, 2) + "(" + low + "((" + all + ").xw));\n  " + name +
           "_high = " + interface_.crossing(number, 2) + "(" + low + "((" + all + ").zy));\n";
  }

  const Interface& interface_;
  std::vector<Varying> varyings_;
};

VkFormat random_color_format(Random& random, const Number& number) {
  if (number.kind == 'f')
    return random.pick({VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8B8A8_UNORM,
                        VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R8G8B8A8_SNORM});
  if (number.kind == 'i')
    return random.pick(
        {VK_FORMAT_R16G16B16A16_SINT, VK_FORMAT_R32G32B32A32_SINT, VK_FORMAT_R32G32_SINT, VK_FORMAT_R16_SINT});
  return random.pick(
      {VK_FORMAT_R16G16B16A16_UINT, VK_FORMAT_R32G32B32A32_UINT, VK_FORMAT_R32_UINT, VK_FORMAT_R16G16_UINT});
}

struct Shape {
  bool tessellates, has_geometry;
};

void draw_stages(Run& run, const Shape& shape) {
  const Interface interface(run);
  Random& random = run.random;
  run.require(!shape.tessellates || run.gpu.features.tessellationShader, "tessellation");
  run.require(!shape.has_geometry || run.gpu.features.geometryShader, "geometry shaders");
  const StageWriter writer(interface, random_varyings(random));
  const std::vector<Number> numbers = {kHalf, random.pick({kHalf, kShort, kUshort}), kShort, kUshort};
  TargetSpec target_spec;
  target_spec.colors.assign(4, VK_FORMAT_R32G32B32A32_UINT);
  for (const Number& number : numbers) target_spec.colors.push_back(random_color_format(random, number));
  if (random.chance(0.3f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = writer.vertex();
  char last = 'v';
  if (shape.tessellates) {
    spec.control = writer.control();
    spec.evaluation = writer.evaluation();
    spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
    spec.tessellation.patchControlPoints = 3;
    last = 'e';
  }
  if (shape.has_geometry) {
    spec.geometry = writer.geometry(last);
    last = 'g';
  }
  spec.fragment = writer.fragment(last, numbers);
  spec.floats({4});
  constexpr uint32_t kVertices = 36, kStride = 128;
  std::vector<float> positions;
  for (uint32_t i = 0; i < kVertices; ++i)
    for (const float x : {random.real(-1.3f, 1.3f), random.real(-1.3f, 1.3f), random.unit(), random.real(0.7f, 1.5f)})
      positions.push_back(x);
  std::vector<int16_t> halves;  // small numbers, and as binary16 between 1/8 and 8
  for (uint32_t i = 0; i < kVertices * kStride / 2; ++i)
    halves.push_back(static_cast<int16_t>((random.chance(0.5f) ? 0 : 0x8000) | (0x3000 + random.below(0x1800))));
  const Buffer position_buffer = run.buffer_of(positions), half_buffer = run.buffer_of(halves);
  spec.bindings.push_back({1, kStride, VK_VERTEX_INPUT_RATE_VERTEX});
  for (uint32_t k = 0; k < writer.count(); ++k) {
    const char kind = writer.input(k).number.kind;
    spec.attributes.push_back({k + 1, 1,
                               kind == 'f'   ? VK_FORMAT_R16G16B16A16_SFLOAT
                               : kind == 'i' ? VK_FORMAT_R16G16B16A16_SINT
                                             : VK_FORMAT_R16G16B16A16_UINT,
                               8 * k});
  }
  for (const auto& [stage, text] :
       {std::pair("vertex", spec.vertex), std::pair("control", spec.control), std::pair("evaluation", spec.evaluation),
        std::pair("geometry", spec.geometry), std::pair("fragment", spec.fragment)})
    if (!text.empty()) run.note(stage, text);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, position_buffer);
    bind_vertices(cmd, half_buffer, 1);
    vkCmdDraw(cmd, kVertices, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

/// Columns of matrices take a location each, also where vertices lie in arrays.
void draw_matrices(Run& run, bool has_geometry) {
  const Interface interface(run);
  run.require(!has_geometry || run.gpu.features.geometryShader, "geometry shaders");
  const std::string matrix = run.gpu.extension_features.storageInputOutput16 ? "f16mat3x2" : "mat3x2";
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_UINT}});
  GraphicsSpec spec;
  spec.vertex = interface.head() + "layout(location = 0) in vec4 position;\nlayout(location = 0) out " + matrix +
                " m[2];\n" + R"(
void main() {
  gl_Position = position;
  f16vec4 a = f16vec4(position * 3.0);
  f16mat3x2 x = f16mat3x2(a.xy, a.zw, a.yx + a.ww);
  m[0] = )" + matrix +
                "(x);\n  m[1] = " + matrix + "(-x);\n}\n";
  if (has_geometry)
    spec.geometry = interface.head() +
                    "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\nlayout(location = 0) in " +
                    matrix + " m[][2];\nlayout(location = 0) out " + matrix + " g[2];\n" + R"(
void main() {
  for (int i = 0; i < 3; i++) {
    gl_Position = gl_in[i].gl_Position;
    g[1] = m[2 - i][0];
    g[0] = m[i][i & 1];
    EmitVertex();
  }
})";
  spec.fragment = interface.head() + "layout(location = 0) in " + matrix + " m[2];\n" + R"(
layout(location = 0) out uvec4 result;
void main() {
  f16mat3x2 x = f16mat3x2(m[0]), y = f16mat3x2(m[1]);
  result = uvec4(packFloat2x16(x[0]), packFloat2x16(x[1]), packFloat2x16(x[2]), packFloat2x16(y[2] + y[1]));
})";
  spec.floats({4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> positions;
  for (uint32_t i = 0; i < 12; ++i)
    for (const float x :
         {run.random.real(-1.3f, 1.3f), run.random.real(-1.3f, 1.3f), run.random.unit(), run.random.real(0.7f, 1.5f)})
      positions.push_back(x);
  const Buffer vertices = run.buffer_of(positions);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 12, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}
CTS_CASE("glsl", "narrow_interface.matrices.vertex") { draw_matrices(run, false); }
CTS_CASE("glsl", "narrow_interface.matrices.geometry") { draw_matrices(run, true); }

CTS_RANDOM("glsl", "narrow_interface.vertex", 20) { draw_stages(run, {false, false}); }
CTS_RANDOM("glsl", "narrow_interface.tessellation", 12) { draw_stages(run, {true, false}); }
CTS_RANDOM("glsl", "narrow_interface.geometry", 12) { draw_stages(run, {false, true}); }
CTS_RANDOM("glsl", "narrow_interface.all", 12) { draw_stages(run, {true, true}); }

const bool kRegistered = [] {
  for (const Attribute& attribute : kAttributes)
    AddCase("glsl", std::string("narrow_interface.attribute.") + attribute.name,
            [&attribute](Run& run) { fetch(run, attribute); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
