// What the front end makes of GLSL: shapes of control flow, interface, memory, refusals.
#include "spirv/front/translate.h"

#include <algorithm>
#include <cstring>

#include "spirv/ir_passes.h"
#include "spirv/ir_walk.h"
#include "spirv/rewrite/rewrite.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr auto kVertex = VK_SHADER_STAGE_VERTEX_BIT;
constexpr auto kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr auto kCompute = VK_SHADER_STAGE_COMPUTE_BIT;

ir::Function translated(VkShaderStageFlagBits stage, const std::string& source, const CompileOptions* given = nullptr) {
  base::Result<ir::Function> result =
      translate(compile_glsl(stage, source), given != nullptr ? *given : options_for(stage));
  EXPECT_TRUE(result) << result.message();
  if (!result) return {};
  EXPECT_EQ(ir::verify(result.value()), "") << ir::dump(result.value());
  return result.take();
}

std::string refusal(VkShaderStageFlagBits stage, const std::string& source) {
  const base::Result<ir::Function> result = translate(compile_glsl(stage, source), options_for(stage));
  return result ? "accepted" : result.message();
}

std::size_t count(ir::Function& function, ir::Op op) {
  std::size_t found = 0;
  ir::each_node(function.body, [&](ir::Node& node) {
    if (node.kind == ir::Node::Kind::kInstr) found += node.instr.op == op;
  });
  return found;
}

std::size_t count(ir::Function& function, ir::Node::Kind kind) {
  std::size_t found = 0;
  ir::each_node(function.body, [&](ir::Node& node) { found += node.kind == kind; });
  return found;
}

TEST(Translate, StraightLine) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in float x; layout(location = 0) out float y;
    void main() { y = x * 2.0 + 1.0; })");
  EXPECT_EQ(ir::dump(f), R"(%1:1 = Const 0x40000000
%3:1 = Const 0x3f800000
%7:1 = LoadInput
%2:1 = FMul %7, %1
%4:1 = FAdd %2, %3
StoreOutput %4
)");
}

TEST(Translate, IfYieldsWhatItsBranchesStore) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in float x; layout(location = 0) out float y;
    void main() { float v = x; if (x > 1.0) v = x * x; y = v; })");
  EXPECT_EQ(ir::dump(f), R"(%2:1 = Const 0x3f800000
%10:1 = LoadInput
%3:1b = FLt! %2, %10
If %3 -> %12:1
  %6:1 = FMul %10, %10
  Yield %6
Else
  Yield %10
StoreOutput %12
)");
}

TEST(Translate, EarlyReturnPutsTheRestIntoElse) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in float x; layout(location = 0) out float y;
    void main() { y = x; if (x > 1.0) return; y = x * x; })");
  EXPECT_EQ(count(f, ir::Node::Kind::kIf), 1u);
  EXPECT_EQ(count(f, ir::Op::kReturn), 0u);
  EXPECT_EQ(count(f, ir::Op::kStoreOutput), 1u);
}

TEST(Translate, ReturnInsideNestedLoopsBreaksOutOfBoth) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) flat in int n; layout(location = 0) out int y;
    int f() { for (int i = 0; i < n; i++) for (int j = 0; j < i; j++) if (i * j == 42) return i; return -1; }
    void main() { y = f(); })");
  EXPECT_EQ(count(f, ir::Node::Kind::kLoop), 2u);
  // The two conditions, the return and the flag behind the inner loop.
  EXPECT_EQ(count(f, ir::Op::kBreak), 4u);
  EXPECT_EQ(count(f, ir::Op::kExit), 0u);
}

TEST(Translate, LoopCarriesOnlyWhatChanges) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) flat in int n; layout(location = 0) out float y;
    void main() { float s = 0.0, unchanged = float(n), unused = 0.0;
                  for (int i = 0; i < n; i++) { s += unchanged; unused += s; } y = s; })");
  ir::each_node(f.body, [](ir::Node& node) {
    if (node.kind != ir::Node::Kind::kLoop) return;
    EXPECT_EQ(node.params.size(), 3u);  // counter, sum, and whether an iteration came before
    EXPECT_EQ(node.results.size(), 1u);
  });
}

TEST(Translate, ArrayIndexedByConstantsIsSsa) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in vec2 x; layout(location = 0) out float y;
    void main() { float a[2] = float[2](x.x, x.y); y = a[0] + a[1]; })");
  EXPECT_TRUE(f.arrays.empty());
}

TEST(Translate, ArrayIndexedAtRunTimeStaysInMemory) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in vec2 x; layout(location = 1) flat in int i; layout(location = 0) out float y;
    struct S { float fixed_part; float a[3]; };
    void main() { S s; s.fixed_part = x.x; s.a[0] = x.x; s.a[1] = x.y; s.a[2] = 0.0; y = s.a[i] + s.fixed_part; })");
  ASSERT_EQ(f.arrays.size(), 1u);
  EXPECT_EQ(f.arrays[0].elements, 3u);
  EXPECT_EQ(count(f, ir::Op::kStoreArray), 3u);
  EXPECT_EQ(count(f, ir::Op::kLoadArray), 1u);
}

TEST(Translate, InterfaceListsWhatIsUsed) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in vec4 unused; layout(location = 1) noperspective centroid in vec3 v;
    layout(location = 2) flat in ivec2 i; layout(location = 3, component = 2) in float c;
    layout(location = 0) out vec4 color; layout(location = 1) out float never;
    void main() { color.y = v.z + float(i.y) + c + gl_FragCoord.w; })");
  const auto& inputs = f.interface.inputs;
  ASSERT_EQ(inputs.size(), 4u);
  EXPECT_EQ(inputs[0].location, 1);
  EXPECT_EQ(inputs[0].component, 2);
  EXPECT_EQ(inputs[0].interpolation, Interpolation::kLinear);
  EXPECT_EQ(inputs[0].sample_location, SampleLocation::kCentroid);
  EXPECT_EQ(inputs[1].location, 2);
  EXPECT_EQ(inputs[1].component, 1);
  EXPECT_EQ(inputs[1].type, BaseType::kInt);
  EXPECT_EQ(inputs[1].interpolation, Interpolation::kFlat);
  EXPECT_EQ(inputs[2].component, 2);
  EXPECT_EQ(inputs[3].built_in, BuiltIn::kFragCoord);
  EXPECT_EQ(inputs[3].component, 3);
  ASSERT_EQ(f.interface.outputs.size(), 1u);
  EXPECT_EQ(f.interface.outputs[0].component, 1);
}

TEST(Translate, InterpolateAtCentroidIsAnotherSlot) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in vec2 v; layout(location = 1) flat in float c; layout(location = 0) out vec4 color;
    void main() { color = vec4(v.x, interpolateAtCentroid(v), interpolateAtCentroid(c)); })");
  const auto& inputs = f.interface.inputs;
  ASSERT_EQ(inputs.size(), 4u);
  const auto centroids = std::count_if(inputs.begin(), inputs.end(), [](const InterfaceSlot& slot) {
    return slot.sample_location == SampleLocation::kCentroid && slot.location == 0;
  });
  EXPECT_EQ(centroids, 2);
  EXPECT_FALSE(f.interface.per_sample);
}

TEST(Translate, InterpolateAtOffsetReadsPlanes) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in vec2 v[2]; layout(location = 2) noperspective in float n;
    layout(location = 0) out vec2 color;
    void main() { color = vec2(interpolateAtOffset(v[1].y, vec2(0.25, n)), interpolateAtSample(n, 1)); })");
  const auto planes = [&](unsigned location, unsigned component) {
    const auto& inputs = f.interface.inputs;
    return std::count_if(inputs.begin(), inputs.end(), [&](const InterfaceSlot& slot) {
      return slot.built_in == BuiltIn::kNone && slot.part != InputPart::kValue && slot.location == location &&
             slot.component == component;
    });
  };
  EXPECT_EQ(planes(0, 0), 0);
  EXPECT_EQ(planes(1, 0), 0);
  EXPECT_EQ(planes(1, 1), 3);
  EXPECT_EQ(planes(2, 0), 3);
  EXPECT_EQ(count(f, ir::Op::kFFused), 2u + 2u + 1u + 2u);  // offset, plane and scale; plane
}

TEST(Translate, DeclaredSampleInputsMakeShadingPerSample) {
  const auto per_sample = [](const char* declaration) {
    return translated(kFragment,
                      std::string(declaration) + " layout(location = 0) out float y; void main() { y = 1.0; }")
        .interface.per_sample;
  };
  EXPECT_TRUE(per_sample("layout(location = 0) sample in vec2 v;"));
  EXPECT_TRUE(per_sample("layout(location = 0) in Block { float a; sample float b; } block;"));
  EXPECT_FALSE(per_sample("layout(location = 0) centroid in vec2 v;"));
}

TEST(Translate, MatricesAndArraysTakeConsecutiveLocations) {
  ir::Function f = translated(kVertex, R"(
    layout(location = 2) in mat2 m; layout(location = 0) out vec2 v[2];
    void main() { v[0] = m[0]; v[1] = m[1]; gl_Position = vec4(1.0); })");
  ASSERT_EQ(f.interface.inputs.size(), 4u);
  EXPECT_EQ(f.interface.inputs[2].location, 3);
  ASSERT_EQ(f.interface.outputs.size(), 8u);
}

TEST(Translate, OutputsWithoutAttachmentAreDead) {
  CompileOptions options = options_for(kFragment);
  options.live_color_outputs = 2;
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in float x; layout(location = 0) out float a; layout(location = 1) out float b;
    void main() { a = exp(x); b = x; })",
                              &options);
  ASSERT_EQ(f.interface.outputs.size(), 1u);
  EXPECT_EQ(f.interface.outputs[0].location, 1);
  EXPECT_EQ(count(f, ir::Op::kFExp2), 0u);
}

TEST(Translate, RowMajorMatrixIsGathered) {
  ir::Function f = translated(kFragment, R"(
    layout(set = 0, binding = 1, std140, row_major) uniform U { mat3x2 m; } u;
    layout(location = 0) out vec2 y; void main() { y = u.m[1]; })");
  ASSERT_EQ(count(f, ir::Op::kLoadUniform), 2u);
  std::vector<std::uint32_t> offsets;
  ir::each_node(f.body, [&](ir::Node& node) {
    if (node.instr.op == ir::Op::kLoadUniform) offsets.push_back(node.instr.data[3]);
  });
  EXPECT_EQ(offsets, (std::vector<std::uint32_t>{4, 20}));
}

TEST(Translate, DescriptorArraysAndDynamicOffsets) {
  ir::Function f = translated(kFragment, R"(
    layout(set = 1, binding = 2) buffer B { vec4 pad; float a[]; } b[4];
    layout(location = 0) flat in ivec2 i; layout(location = 0) out float y;
    void main() { y = b[i.x].a[i.y] + float(b[3].a.length()); })");
  ir::each_node(f.body, [&](ir::Node& node) {
    if (node.instr.op != ir::Op::kLoadStorage) return;
    EXPECT_EQ(node.instr.data[0], 1u);
    EXPECT_EQ(node.instr.data[1], 8u);
    EXPECT_EQ(node.instr.data[2], 4u);
    EXPECT_EQ(node.instr.data[3], 16u);
  });
  EXPECT_EQ(count(f, ir::Op::kArrayLength), 1u);
}

TEST(Translate, SpecializationChoosesTheBranch) {
  const std::string source = R"(
    layout(constant_id = 7) const int k = 1;
    layout(location = 0) in float x; layout(location = 0) out float y;
    void main() { if (k == 2) y = sqrt(x); else y = x; })";
  ir::Function f = translated(kFragment, source);
  rewrite(f);
  EXPECT_EQ(count(f, ir::Node::Kind::kIf), 0u);
  EXPECT_EQ(count(f, ir::Op::kFSqrt), 0u);
  CompileOptions options = options_for(kFragment);
  const std::uint32_t two = 2;
  SpecializationConstant constant{7, std::vector<std::byte>(4)};
  std::memcpy(constant.bytes.data(), &two, 4);
  options.specialization.push_back(constant);
  f = translated(kFragment, source, &options);
  rewrite(f);
  EXPECT_EQ(count(f, ir::Op::kFSqrt), 1u);
}

TEST(Translate, PreciseAndInvariantAreExact) {
  ir::Function f = translated(kVertex, R"(
    layout(location = 0) in vec4 a; layout(location = 0) out float other; invariant gl_Position;
    void main() { gl_Position = a * a.x + a; other = a.y * a.z; })");
  ir::each_node(f.body, [](ir::Node& node) {
    if (node.instr.op == ir::Op::kFAdd) {
      EXPECT_TRUE(node.instr.exact);
    }
    if (node.instr.op == ir::Op::kFMul) {
      EXPECT_EQ(node.instr.exact, node.instr.components == 4);
    }
  });
}

TEST(Translate, TextureOperands) {
  ir::Function f = translated(kFragment, R"(
    layout(set = 0, binding = 3) uniform sampler2DArrayShadow s; layout(location = 0) in vec4 p;
    layout(location = 0) out float y; void main() { y = textureGradOffset(s, p, p.xy, p.zw, ivec2(1, -1)); })");
  ir::each_node(f.body, [](ir::Node& node) {
    if (node.instr.op != ir::Op::kImage) return;
    const ir::ImageInfo& info = *node.instr.image;
    EXPECT_EQ(info.access, ir::ImageAccess::kSample);
    EXPECT_TRUE(info.arrayed && info.combined);
    EXPECT_EQ(info.slot, 12u);
    auto bit = [](ir::ImageOperand operand) { return 1u << static_cast<unsigned>(operand); };
    EXPECT_EQ(info.operands, bit(ir::ImageOperand::kCoord) | bit(ir::ImageOperand::kDref) |
                                 bit(ir::ImageOperand::kGradX) | bit(ir::ImageOperand::kGradY) |
                                 bit(ir::ImageOperand::kOffset));
  });
  EXPECT_EQ(count(f, ir::Op::kImage), 1u);
}

TEST(Translate, KillGoesOnAsHelperOutsideLoopsAndLeavesInsideThem) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in float x; layout(location = 0) out float y;
    void main() { if (x < 0.0) discard; y = dFdx(x); })");
  EXPECT_EQ(count(f, ir::Op::kDemote), 1u);
  EXPECT_TRUE(f.interface.uses_discard);
  EXPECT_TRUE(f.interface.needs_helpers);
  f = translated(kFragment, R"(
    layout(location = 0) in float x; layout(location = 0) out float y;
    void main() { y = x; while (y < 9.0) { if (y < 0.0) discard; y += x; } })");
  EXPECT_EQ(count(f, ir::Op::kKill), 1u);
}

TEST(Translate, OriginNamesTheInstruction) {
  ir::Function f = translated(kFragment, R"(
    layout(location = 0) in float x; layout(location = 0) out float y; void main() { y = x * 2.0; })");
  ir::each_node(f.body, [](ir::Node& node) {
    if (node.instr.op == ir::Op::kFMul) {
      EXPECT_NE(node.instr.origin.spirv_id, 0u);
    }
  });
}

TEST(Translate, RefusalsNameTheInstruction) {
  EXPECT_NE(refusal(kFragment,
                    "layout(set = 3, binding = 9) uniform U { vec4 v; } u; "
                    "layout(location = 0) out vec4 c; void main() { c = u.v; }")
                .find("pipeline layout"),
            std::string::npos);
}

TEST(Translate, DeepNestingIsRefusedNotCrashed) {
  std::string source = "layout(location = 0) in float x; layout(location = 0) out float y; void main() { y = x;\n";
  for (int i = 0; i < 400; i++) source.append("if (x > ").append(std::to_string(i)).append(".0) {\n");
  source.append("y += 1.0;\n").append(401, '}');
  EXPECT_NE(refusal(kFragment, source).find("nested"), std::string::npos);
}

TEST(Translate, ExponentialInliningIsRefused) {
  std::string source =
      "layout(location = 0) in float x; layout(location = 0) out float y; float f0(float a) "
      "{ return a * a + x; }\n";
  for (int i = 1; i < 40; i++) {
    const std::string before = std::string("f").append(std::to_string(i - 1));
    source += "float f" + std::to_string(i) + "(float a) { return " + before + "(a) + " + before + "(a + 1.0); }\n";
  }
  EXPECT_NE(refusal(kFragment, source + "void main() { y = f39(x); }").find("too many"), std::string::npos);
}

TEST(Translate, SharedMemoryAndBarrier) {
  ir::Function f = translated(kCompute, R"(
    layout(local_size_x = 8, local_size_y = 4) in; layout(set = 0, binding = 0) buffer B { float v[]; } b;
    shared float pad; shared vec3 s[32];
    void main() { pad = 1.0; s[gl_LocalInvocationIndex] = vec3(b.v[gl_GlobalInvocationID.x]); barrier();
                  b.v[gl_GlobalInvocationID.x] = s[31 - gl_LocalInvocationIndex].y + pad; })");
  EXPECT_EQ(f.interface.local_size[0], 8u);
  EXPECT_EQ(f.interface.local_size[1], 4u);
  EXPECT_EQ(f.interface.shared_bytes, 4u + 32 * 12);
  EXPECT_EQ(count(f, ir::Op::kBarrier), 1u);
  EXPECT_TRUE(f.interface.writes_memory);
}

}  // namespace
}  // namespace vitrine::spirv::test
