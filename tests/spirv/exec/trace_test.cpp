// One invocation's trace: its text, by the same name in every SIMD target, and that looking changes nothing.
#include "spirv/exec/trace.h"

#include <gtest/gtest.h>

#include <regex>

#include "base/numeric.h"
#include "spirv/lower/lower.h"
#include "tests/simd_targets.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

using exec::parse_trace_target;

/// The text without the numbers of SPIR-V ids, which glslang chooses, and the lines of the disassembly.
std::string without_ids(std::string_view text) {
  static constexpr std::string_view kFile = " main.spvasm:";
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.substr(i, kFile.size()) == kFile) {
      i = text.find_first_not_of("0123456789", i + kFile.size()) - 1;
      continue;
    }
    result += text[i];
    if (text[i] != '%') continue;
    while (i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9') ++i;
    result += "id";
  }
  return std::regex_replace(result, std::regex(" *;(\n|  lane)"), "$1");
}

/// What the tracer writes, run by run.
struct Recorded {
  std::vector<std::string> runs;
  std::shared_ptr<const exec::Observer> tracer(const char* target) {
    return exec::make_tracer(*parse_trace_target(target),
                             [this](std::string_view text) { runs.push_back(without_ids(text)); });
  }
};

/// A module compiled for the target, watched or not.
std::unique_ptr<Shader> shader_of(VkShaderStageFlagBits stage, const std::string& glsl,
                                  std::shared_ptr<const exec::Observer> observer) {
  CompileOptions options = options_for(stage);
  options.observer = std::move(observer);
  auto shader = compile(compile_glsl(stage, glsl), options);
  if (!shader) throw std::runtime_error(shader.message());
  return shader.take();
}

const char kCompute[] = R"(
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { float v[]; } b;
layout(push_constant) uniform P { float scale; float bias; } p;
void main() {
  uint i = gl_GlobalInvocationID.x;
  float x = b.v[i] * (p.scale + p.bias);
  if (x > 9.0) x = sqrt(x);
  b.v[i] = x;
}
)";

/// Runs kCompute over four workgroups; the buffer afterwards.
std::vector<std::uint32_t> run_compute(std::shared_ptr<const exec::Observer> observer) {
  std::vector<std::uint32_t> words;
  for (int i = 0; i < 32; ++i) words.push_back(base::bits_of(static_cast<float>(i)));
  const auto shader = shader_of(VK_SHADER_STAGE_COMPUTE_BIT, kCompute, std::move(observer));
  Buffers buffers{&words};
  const float push[32] = {2.0f, 1.0f};
  buffers.table.push_constants = reinterpret_cast<const std::byte*>(push);
  Fault fault;
  const BoundShader bound(*shader, buffers.table, fault);
  const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {4, 1, 1};
  dispatch(bound, base, counts);
  return words;
}

TEST(Trace, Compute) {
  base::for_each_simd_target([] {
    Recorded recorded;
    const auto seen = run_compute(recorded.tracer("compute:11,0,0"));
    EXPECT_EQ(seen, run_compute(nullptr));
    ASSERT_EQ(recorded.runs.size(), 1u);
    EXPECT_EQ(recorded.runs[0], R"(compute 11,0,0 (workgroup 0,0,0, lane 11)
preamble
    0  load_push         u6 = 40000000 2 <- u0 00000000 0  set 0 slot 0  ; %id
    1  load_push         u7 = 3f800000 1 <- u0 00000000 0  set 0 slot 0 +4  ; %id
    2  FAdd              u8 = 40400000 3 <- u6 40000000 2, u7 3f800000 1  ; %id
code
    0  SubgroupInvocation r0 = 0000000b 11  ; %id
    1  And               r1 = 00000003 3 <- r0 0000000b 11, u1 00000007 7  ; %id
    2  WorkgroupId       u9 = 00000000 0  ; %id
    3  WorkgroupId       u10 = 00000000 0  ; %id
    4  WorkgroupId       u11 = 00000000 0  ; %id
    5  UShr              r0 = 00000001 1 <- r0 0000000b 11, u2 00000003 3  ; %id
    6  IAdd              r0 = 00000001 1 <- r0 00000001 1, u9 00000000 0  ; %id
    7  And               r1 = 00000003 3 <- u1 00000007 7, r1 00000003 3  ; %id
    8  IMulAdd           r0 = 0000000b 11 <- r0 00000001 1, u3 00000008 8, r1 00000003 3  ; %id
    9  Shl               r0 = 0000002c 44 <- r0 0000000b 11, u4 00000002 2  ; %id
   10  load_storage      r1 = 41300000 11 <- r0 0000002c 44  set 0 slot 0  ; %id
   11  FMul              r1 = 42040000 33 <- r1 41300000 11, u8 40400000 3  ; %id
   12  FLt               m0 = 1 <- u5 41100000 9, r1 42040000 33  ; %id
   13  FSqrt             r2 = 40b7d375 5.74456263 <- r1 42040000 33  ; %id
   14  Select            r1 = 40b7d375 5.74456263 <- m0 1, r2 40b7d375 5.74456263, r1 42040000 33
   15  store_storage     <- r0 0000002c 44, r1 40b7d375 5.74456263  set 0 slot 0
   16  end
)");
  });
}

TEST(Trace, Vertex) {
  base::for_each_simd_target([] {
    Recorded recorded;
    const auto shader = shader_of(VK_SHADER_STAGE_VERTEX_BIT, R"(
layout(location = 0) in vec2 p;
layout(location = 0) out float o;
void main() { o = p.x * p.y; })",
                                  recorded.tracer("vertex:7"));
    Fault fault;
    const BoundShader bound(*shader, {}, fault);
    WaveRunner wave;
    wave.bind(bound);
    for (const InterfaceSlot& slot : shader->interface().inputs)
      for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
        wave.input(slot.reg).lane[lane] = slot.built_in == BuiltIn::kVertexIndex ? lane + 5
                                          : slot.built_in != BuiltIn::kNone      ? 3
                                                                                 : base::bits_of(0.5f);
    wave.run(base::kAllLanes, 0);
    ASSERT_EQ(recorded.runs.size(), 1u);
    EXPECT_EQ(recorded.runs[0], R"(vertex 7,3 (lane 2)
code
    0  FMul              r0 = 3e800000 0.25 <- r0 3f000000 0.5, r1 3f000000 0.5  ; %id
    1  end
outputs
       location 0.x      r0 = 3e800000 0.25
)");
  });
}

TEST(Trace, FragmentTellsEveryLaneOfThePixel) {
  base::for_each_simd_target([] {
    Recorded recorded;
    const auto shader = shader_of(VK_SHADER_STAGE_FRAGMENT_BIT, R"(
layout(location = 0) in float v;
layout(location = 0) out float o;
void main() {
  if (v < 2.0) discard;
  o = v + 1.0;
})",
                                  recorded.tracer("fragment:1,0"));
    Fault fault;
    const BoundShader bound(*shader, {}, fault);
    WaveRunner wave;
    wave.bind(bound);
    for (const InterfaceSlot& slot : shader->interface().inputs)
      for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
        wave.input(slot.reg).lane[lane] =
            base::bits_of(slot.built_in == BuiltIn::kNone ? static_cast<float>(lane)
                                                          : static_cast<float>(lane >> slot.component & 1) + 0.5f);
    wave.run(base::first_lanes(8), 0);
    ASSERT_EQ(recorded.runs.size(), 2u);  // two quads at the same place
    EXPECT_EQ(recorded.runs[0], R"(fragment 1,0 (lane 1)
code
    0  FLt               m0 = 1 <- r0 3f800000 1, u0 40000000 2  ; %id
    1  if                m1 = 0 <- m0 1
    2  demote
    3  else              m1 = 1  lane off
    4  endif             <- m1 1  lane on
    5  FAdd              r0 = 40000000 2 <- r0 3f800000 1, u1 3f800000 1  ; %id
    6  end
outputs
       location 0.x      r0 = 40000000 2
)");
    EXPECT_EQ(recorded.runs[1], R"(fragment 1,0 (lane 5)
code
    0  FLt               m0 = 0 <- r0 40a00000 5, u0 40000000 2  ; %id
    1  if                m1 = 1 <- m0 0  lane off
    3  else              m1 = 0  lane on
    4  endif             <- m1 0
    5  FAdd              r0 = 40c00000 6 <- r0 40a00000 5, u1 3f800000 1  ; %id
    6  end
outputs
       location 0.x      r0 = 40c00000 6
)");
  });
}

/// A wave that waits at a barrier goes on as another run.
TEST(Trace, BarrierAndWideNumbers) {
  Recorded recorded;
  const std::string glsl = R"(
layout(local_size_x = 128) in;
layout(set = 0, binding = 0) buffer B { uint v[]; } b;
shared uint s[128];
void main() {
  uint i = gl_LocalInvocationIndex;
  s[i] = b.v[i] + 1u;
  barrier();
  double d = double(s[127u - i]) * 0.5lf;
  b.v[i] = uint(d);
})";
  const auto run = [&](std::shared_ptr<const exec::Observer> observer) {
    std::vector<std::uint32_t> words(128);
    for (std::uint32_t i = 0; i < 128; ++i) words[i] = i;
    const auto shader = shader_of(VK_SHADER_STAGE_COMPUTE_BIT, glsl, std::move(observer));
    const Buffers buffers{&words};
    Fault fault;
    const BoundShader bound(*shader, buffers.table, fault);
    const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {1, 1, 1};
    dispatch(bound, base, counts);
    return words;
  };
  EXPECT_EQ(run(recorded.tracer("compute:70,0,0")), run(nullptr));
  ASSERT_EQ(recorded.runs.size(), 2u);
  EXPECT_TRUE(recorded.runs[0].starts_with("compute 70,0,0 (workgroup 0,0,0, lane 6)\n")) << recorded.runs[0];
  EXPECT_TRUE(recorded.runs[1].starts_with("compute 70,0,0 (workgroup 0,0,0, lane 6, behind a barrier)\n"));
  EXPECT_NE(recorded.runs[0].find("barrier"), std::string::npos) << recorded.runs[0];
  EXPECT_NE(recorded.runs[1].find("DMul"), std::string::npos) << recorded.runs[1];
}

TEST(Trace, NamesIdAndLine) {
  ComputeText module;
  module.annotations = "%file = OpString \"a.comp\"\n";
  module.body =
      load_word("%x", "in") + "OpLine %file 7 3\n%sum = OpIAdd %uint %x %n\nOpNoLine\n" + store_word("%sum", "out");
  std::string text;
  CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
  options.observer = exec::make_tracer(*parse_trace_target("compute:3,0,0"), [&](std::string_view run) { text = run; });
  std::vector<std::uint32_t> words(64, 5);
  dispatch_over(words, assemble(module.text()), options, 1);
  EXPECT_TRUE(std::regex_search(text, std::regex("IAdd +r\\d+ = 00000008 8 <- .*  ; %\\d+ a.comp:7:3\n"))) << text;
}

TEST(Trace, TargetsAreParsed) {
  const auto vertex = parse_trace_target("vertex:12");
  ASSERT_TRUE(vertex.has_value());
  EXPECT_EQ(vertex->stage, VK_SHADER_STAGE_VERTEX_BIT);
  EXPECT_EQ(vertex->id[0], 12u);
  EXPECT_EQ(vertex->count, 1u);
  EXPECT_TRUE(parse_trace_target("vertex:1,2").has_value());
  EXPECT_TRUE(parse_trace_target("fragment:1,2").has_value());
  EXPECT_TRUE(parse_trace_target("compute:1,2,3").has_value());
  for (const char* wrong : {"", "compute", "compute:", "compute:1,2", "compute:1,2,3,4", "fragment:1", "fragment:1,2,3",
                            "geometry:1", "vertex:x", "vertex:1 2", "vertex:-1", "vertex:"})
    EXPECT_FALSE(parse_trace_target(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace vitrine::spirv::test
