// Every instruction of a program knows the line that it was made of, whatever the steps of the compiler did to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "spirv/exec/observe.h"
#include "spirv/program.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// A shader. Lines that access memory or an image end in "//@".
struct Source {
  const char* name;
  VkShaderStageFlagBits stage;
  const char* glsl;
};

void PrintTo(const Source& source, std::ostream* out) { *out << source.name; }

const Source kSources[] = {
    {"arrays", VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer B { float v[]; } b;
layout(set = 0, binding = 1) buffer C { uint n; uint w[]; } c;
layout(set = 0, binding = 2) uniform U { mat4 m; vec4 k[4]; int count; } u;
layout(push_constant) uniform P { float bias; } p;
shared float s[64];
float chosen(vec4 x, int n) {
  float a[4];
  for (int i = 0; i < 4; i++)
    a[(i * n) & 3] = x[i] * 0.5;  //@
  return a[(n + 1) & 3];          //@
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  float sum = p.bias;                    //@
  for (int k = 0; k < u.count; k++) {    //@
    if (b.v[k] > 3.0) continue;          //@
    vec4 x = u.m * u.k[k & 3];           //@
    sum += chosen(x, k) / 3.0;
    if (sum > 100.0)
      break;
  }
  s[gl_LocalInvocationIndex] = pow(sum, 2.5);           //@
  barrier();
  float other = s[63u - gl_LocalInvocationIndex];       //@
  atomicAdd(c.n, 1u);                                   //@
  c.w[i] = bitfieldReverse(c.w[i + 64u]) % (i + 7u);    //@
  b.v[i] = other + sin(sum);                            //@
}
)"},
    {"images", VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba8) uniform image2D i;
layout(set = 0, binding = 1, r32ui) uniform uimage2D counts;
layout(set = 0, binding = 2) uniform sampler2D t;
void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  vec4 x = imageLoad(i, at + imageSize(i) / 2);      //@
  x += textureLod(t, vec2(at) / 8.0, 1.0);           //@
  if (x.x > 0.5)
    imageAtomicAdd(counts, at, 1u);                  //@
  imageStore(i, at, x * vec4(0.5, 1.5, x.y, 2.0));   //@
}
)"},
    {"wide", VK_SHADER_STAGE_COMPUTE_BIT, R"(
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer B { double v[]; } b;
layout(set = 0, binding = 1) buffer C { int64_t v[]; } c;
void main() {
  uint i = gl_GlobalInvocationID.x;
  double d = b.v[i];                        //@
  int64_t n = c.v[i];                       //@
  for (int k = 0; k < 3; k++) {
    d = fma(d, sqrt(d), 0.5lf);
    n = n * 31l + int64_t(d) / 7l;
  }
  b.v[i] = floor(d) + inversesqrt(d);       //@
  c.v[i] = n >> 3;                          //@
}
)"},
    {"vertex", VK_SHADER_STAGE_VERTEX_BIT, R"(
layout(location = 0) in vec4 p;
layout(location = 1) in ivec4 n;
layout(location = 0) out vec4 c;
layout(location = 1) flat out int m;
layout(set = 0, binding = 0) uniform U { mat4 m; mat4 r; } u;
layout(push_constant) uniform P { layout(row_major) mat3 n; } w;
void main() {
  gl_Position = u.m * u.r * p;                     //@
  c = vec4(normalize(w.n * p.xyz), 1.0);           //@
  m = n.x + n.y * gl_VertexIndex - gl_InstanceIndex;
}
)"},
    {"fragment", VK_SHADER_STAGE_FRAGMENT_BIT, R"(
layout(location = 0) in vec4 p;
layout(location = 1) in vec3 n;
layout(location = 0) out vec4 c;
layout(location = 1) out uvec4 d;
layout(set = 0, binding = 0) uniform sampler2D t[2];
layout(set = 0, binding = 1) uniform U { vec4 light; int kind; } u;
float f(inout float x, int k) {
  for (int i = 0; i < k; i++) {
    if (x > 3.0) return x;
    x *= p.y;
  }
  return x;
}
void main() {
  float x = fwidth(p.z);
  switch (u.kind) {                                   //@
    case 1: x += 1.0;
    case 2: x = f(x, 5); break;
    default: x = mod(p.w, 3.0);
  }
  vec4 l = u.light;                                   //@
  if (dot(n, l.xyz) < 0.0) discard;
  c = texture(t[0], p.xy) * x;                        //@
  if (gl_FrontFacing) c += textureGather(t[1], p.yx, 2);  //@
  d = uvec4(gl_FragCoord.xyxy) >> 1;
}
)"},
    {"control", VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(
layout(vertices = 3) out;
layout(location = 0) in vec4 p[];
layout(location = 0) out vec4 q[];
void main() {
  q[gl_InvocationID] = p[gl_InvocationID] * 2.0;               //@
  gl_out[gl_InvocationID].gl_Position = gl_in[0].gl_Position;  //@
  if (gl_InvocationID == 0)
    gl_TessLevelOuter[1] = length(p[1]);                       //@
}
)"},
    {"geometry", VK_SHADER_STAGE_GEOMETRY_BIT, R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 6) out;
layout(location = 0) in vec4 p[];
layout(location = 0) out vec4 q;
void main() {
  for (int i = 0; i < 3; i++) {
    gl_Position = gl_in[i].gl_Position + 1.0;   //@
    q = p[2 - i];                               //@
    EmitVertex();                               //@
  }
  EndPrimitive();
}
)"},
};

class Origins : public testing::TestWithParam<std::tuple<Source, DebugInfo, bool>> {
 protected:
  /// Wants to be told of instructions, and tells nobody.
  struct Silent : exec::Observer {
    std::unique_ptr<exec::Watch> watch(const Wave&, const Instruction*) const override { return nullptr; }
  };

  void SetUp() override {
    const auto& [source, debug, observed] = GetParam();
    CompileOptions options = options_for(source.stage);
    if (observed) options.observer = std::make_shared<Silent>();
    auto compiled = compile(compile_glsl(source.stage, source.glsl, debug), options);
    ASSERT_TRUE(compiled) << compiled.message();
    shader = compiled.take();
    lines.emplace_back();
    std::istringstream text(std::string("#version 450\n") + source.glsl);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
  }

  const Program& program() const { return shader->program(); }
  std::uint32_t line_of(const InstructionNote& note) const { return program().sources->place(note.origin.place).line; }

  std::unique_ptr<Shader> shader;
  std::vector<std::string> lines;  ///< of the source, from number 1
};

/// Not made of anything in the source: where programs begin and end.
bool is_frame(const InstructionNote& note) {
  const std::string_view name = note.name;
  return name == "end" || name == "clear_arrays" || name == "move";
}

TEST_P(Origins, EveryInstructionHasALine) {
  for (const auto* notes : {&program().preamble_notes, &program().notes})
    for (std::size_t i = 0; i < notes->size(); ++i)
      if (!is_frame((*notes)[i])) {
        EXPECT_NE(line_of((*notes)[i]), 0u) << i << ' ' << (*notes)[i].name << '\n' << disassemble(program());
      }
}

TEST_P(Origins, AccessesHaveTheLineThatMakesThem) {
  std::set<std::uint32_t> expected, found;
  for (std::uint32_t i = 1; i < lines.size(); ++i)
    if (lines[i].find("//@") != std::string::npos) expected.insert(i);
  using Extra = InstructionNote::Extra;
  for (const auto* notes : {&program().preamble_notes, &program().notes})
    for (const InstructionNote& note : *notes)
      if (note.extra == Extra::kMemory || note.extra == Extra::kImage) found.insert(line_of(note));
  EXPECT_EQ(found, expected) << disassemble(program());
}

std::string name_of(const testing::TestParamInfo<Origins::ParamType>& info) {
  const auto& [source, debug, observed] = info.param;
  return std::string(source.name) + (debug == DebugInfo::kLines ? "Lines" : "NonSemantic") +
         (observed ? "Observed" : "");
}

INSTANTIATE_TEST_SUITE_P(, Origins,
                         testing::Combine(testing::ValuesIn(kSources),
                                          testing::Values(DebugInfo::kLines, DebugInfo::kNonSemantic), testing::Bool()),
                         name_of);

}  // namespace
}  // namespace vitrine::spirv::test
