// Group operations in vertex processing stages: the lanes of a wave are a subgroup there too, whatever they stand for.
#include <bit>

#include "tests/spirv/buffers.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kLanes = 64, kWords = 8;

constexpr char kHead[] = R"(
#extension GL_KHR_shader_subgroup_basic : enable
#extension GL_KHR_shader_subgroup_vote : enable
#extension GL_KHR_shader_subgroup_ballot : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_KHR_shader_subgroup_clustered : enable
#extension GL_KHR_shader_subgroup_quad : enable
layout(set = 0, binding = 0) buffer B { uint v[]; };
void results(uint i) {
  uint x = i * 7u % 32u;
  v[i * 8u] = subgroupAdd(x);
  v[i * 8u + 1u] = subgroupExclusiveMax(x);
  v[i * 8u + 2u] = subgroupBallotBitCount(subgroupBallot(x < 9u));
  v[i * 8u + 3u] = subgroupElect() ? 1u : 0u;
  v[i * 8u + 4u] = subgroupBroadcastFirst(x) + (subgroupAny(x == 31u) ? 100u : 0u);
  v[i * 8u + 5u] = subgroupClusteredMin(x, 4u);
  v[i * 8u + 6u] = gl_SubgroupSize * 100u + gl_SubgroupInvocationID;
  if (x > 15u) v[i * 8u + 7u] = subgroupAdd(1u) + subgroupQuadSwapHorizontal(x) * 0u;
}
)";

std::uint32_t value_of(std::uint32_t lane) { return lane * 7 % 32; }

/// Runs the lanes of `active`, lane i with the primitive number i.
std::vector<std::uint32_t> run_stage(VkShaderStageFlagBits stage, const std::string& source, std::uint32_t size,
                                     base::LaneMask active) {
  std::vector<std::uint32_t> values(kLanes * kWords), memory(kLanes * 256);
  CompileOptions options = options_for(stage);
  options.subgroup_size = size;
  auto shader = compile(compile_glsl(stage, kHead + source), options);
  EXPECT_TRUE(shader) << shader.message();
  if (!shader) return values;
  const Buffers buffers{&values};
  Fault fault;
  const BoundShader bound(*shader.value(), buffers.table, fault);
  WaveRunner runner;
  runner.bind(bound);
  runner.set_stage_memory(memory.data(), memory.size());
  for (const InterfaceSlot& slot : shader.value()->interface().inputs)
    for (std::uint32_t lane = 0; lane < kLanes; lane++)
      runner.input(slot.reg).lane[lane] = slot.built_in == BuiltIn::kPrimitiveId ? lane : 0;
  runner.run(active, 0);
  EXPECT_FALSE(fault.raised) << fault.message;
  return values;
}

struct Sums {
  std::uint32_t sum = 0, below = 0, small = 0, lowest = ~0u, any = 0, cluster = ~0u, large = 0;
};

/// Of the subgroup of `lane`.
Sums model(std::uint32_t lane, std::uint32_t size, base::LaneMask active) {
  Sums sums;
  const std::uint32_t first = lane / size * size;
  for (std::uint32_t k = first; k < first + size; k++) {
    if ((active >> k & 1) == 0) continue;
    const std::uint32_t x = value_of(k);
    sums.sum += x;
    if (k < lane) sums.below = std::max(sums.below, x);
    sums.small += x < 9;
    sums.lowest = std::min(sums.lowest, k);
    sums.any |= x == 31;
    if (k / 4 == lane / 4) sums.cluster = std::min(sums.cluster, x);
    sums.large += x > 15;
  }
  return sums;
}

void expect_stage(VkShaderStageFlagBits stage, const std::string& source) {
  for (const std::uint32_t size : {8u, 64u})
    for (const base::LaneMask active : {~base::LaneMask{0}, base::LaneMask{0x0123456789abcdef}, base::LaneMask{0x1f}}) {
      const std::vector<std::uint32_t> got = run_stage(stage, source, size, active);
      for (std::uint32_t lane = 0; lane < kLanes; lane++) {
        if ((active >> lane & 1) == 0) continue;
        const Sums sums = model(lane, size, active);
        const std::uint32_t x = value_of(lane);
        const std::uint32_t wanted[kWords] = {sums.sum,
                                              sums.below,
                                              sums.small,
                                              sums.lowest == lane ? 1u : 0u,
                                              value_of(sums.lowest) + 100 * sums.any,
                                              sums.cluster,
                                              size * 100 + lane % size,
                                              x > 15 ? sums.large : 0};
        for (std::uint32_t k = 0; k < kWords; k++)
          ASSERT_EQ(got[lane * kWords + k], wanted[k]) << "size " << size << ", lane " << lane << ", word " << k;
      }
    }
}

TEST(SubgroupsInStages, Vertex) {
  // Nothing numbers the lanes of a vertex wave but the vertices themselves.
  const std::string source = "void main() { results(gl_SubgroupInvocationID); gl_Position = vec4(0.0); }\n";
  const std::vector<std::uint32_t> got = run_stage(VK_SHADER_STAGE_VERTEX_BIT, source, 64, ~base::LaneMask{0});
  for (std::uint32_t lane = 0; lane < kLanes; lane++)
    ASSERT_EQ(got[lane * kWords], model(lane, 64, ~base::LaneMask{0}).sum);
}

TEST(SubgroupsInStages, Geometry) {
  expect_stage(VK_SHADER_STAGE_GEOMETRY_BIT,
               "layout(points) in;\nlayout(points, max_vertices = 1) out;\n"
               "void main() { results(uint(gl_PrimitiveIDIn)); }\n");
}

TEST(SubgroupsInStages, TessellationControl) {
  expect_stage(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
               "layout(vertices = 1) out;\nvoid main() { results(uint(gl_PrimitiveID)); }\n");
}

TEST(SubgroupsInStages, TessellationEvaluation) {
  expect_stage(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
               "layout(triangles) in;\nvoid main() { results(uint(gl_PrimitiveID)); gl_Position = vec4(0.0); }\n");
}

}  // namespace
}  // namespace vitrine::spirv::test
