// The instruction budget of a wave: what turns of loops cost, whose fault counts. The budget of this process is
// 1,000,000 (execute_test.cpp).
#include <atomic>
#include <cstring>

#include "base/loop_watch.h"
#include "base/workers.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

std::unique_ptr<Shader> compile_body(const std::string& head, const std::string& body) {
  const auto stage = VK_SHADER_STAGE_COMPUTE_BIT;
  const Words module = compile_glsl(stage, head + "layout(set = 0, binding = 0) buffer B { uint v[]; };\n" +
                                               "void main() {\n  uint i = gl_GlobalInvocationID.x, x = i;\n" + body +
                                               "  v[i] = x;\n}\n");
  auto shader = compile(module, options_for(stage));
  EXPECT_TRUE(shader) << shader.message();
  return shader ? shader.take() : nullptr;
}

/// What `groups` workgroups leave in `fault`.
void run(const Shader& shader, std::uint32_t groups, Fault& fault) {
  std::vector<std::uint32_t> words(65536, 1);
  const Buffers buffers{&words};
  const BoundShader bound(shader, buffers.table, fault);
  const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {groups, 1, 1};
  dispatch(bound, base, counts);
}

bool ends(const std::string& local_size, const std::string& body) {
  Fault fault;
  const auto shader = compile_body("layout(local_size_x = " + local_size + ") in;\nshared uint s;\n", body);
  if (!shader) return false;
  run(*shader, 1, fault);
  return !fault.raised;
}

/// What a turn of the only loop of a shader costs.
std::uint32_t cost_of_turn(const std::string& body) {
  const auto shader = compile_body("layout(local_size_x = 64) in;\n", body);
  if (!shader) return 0;
  const Program& program = shader->program();
  for (std::size_t k = 0; k < program.code.size(); ++k)
    if (std::string(program.notes[k].name).starts_with("loop")) return program.code[k].extra[1];
  ADD_FAILURE() << disassemble(program);
  return 0;
}

std::atomic<std::size_t> handed_out;

/// Items in which `groups` workgroups were handed to threads; 0: all ran on this one.
std::size_t items_of(const std::string& body, std::uint32_t groups) {
  const auto shader = compile_body("layout(local_size_x = 64) in;\n", body);
  if (!shader) return 0;
  handed_out = 0;
  base::set_loop_watch([](auto, auto, std::size_t items) { handed_out += items; });
  Fault fault;
  run(*shader, groups, fault);
  base::set_loop_watch(nullptr);
  EXPECT_FALSE(fault.raised);
  return handed_out;
}

TEST(Budget, FewWorkgroupsWithLoopsAreHandedToAllThreads) {
  if (base::worker_count() == 1) GTEST_SKIP() << "one thread";
  EXPECT_EQ(items_of("  x += v[i] * 3u;\n", 64), 0u);
  const std::string loop = "  for (uint k = 0u; k < v[60000] * 64u; ++k) x = x * 5u + v[50000u + k];\n";
  EXPECT_GE(items_of(loop, 64), std::min<std::size_t>(64, 4 * base::worker_count()));
}

TEST(Budget, TurnsCostTheInstructionsOfTheLoop) {
  const std::uint32_t one = cost_of_turn("  while (x != 1u) x = x * 5u;\n");
  EXPECT_GE(one, 2u);
  EXPECT_EQ(cost_of_turn("  while (x != 1u) x = (x * 5u) ^ (i + x);\n"), one + 2);
  EXPECT_GE(cost_of_turn("  while (v[x & 15u] != 0u) x = x * 5u;\n"), one + 32) << "memory takes longer";
}

TEST(Budget, LongBodiesSpendItSooner) {
  const std::string loop = "  for (uint k = 0u; k < 60000u; ++k) ";
  EXPECT_TRUE(ends("64", loop + "x = x * 5u + k;\n"));
  EXPECT_FALSE(ends("64", loop + "x = v[(x + k) & 15u];\n"));
}

TEST(Budget, WavesThatWaitForEachOtherShareIt) {
  const std::string loop = "  for (uint k = 0u; k < 4000u; ++k) { if (i == k) s = x; barrier(); x += s; }\n";
  EXPECT_TRUE(ends("64", loop));
  EXPECT_FALSE(ends("1024", loop));
}

TEST(Budget, TheFirstWorkgroupAtFaultCountsHoweverManyThreadsThereAre) {
  // Odd workgroups are soon at fault, even ones later, in another loop.
  const auto shader = compile_body("layout(local_size_x = 64) in;\n",
                                   "  if ((gl_WorkGroupID.x & 1u) == 1u) { while (v[x & 15u] != 0u) x = v[x & 7u]; }\n"
                                   "  else { while (x != 1u) x = x * 4u + 2u; }\n");
  ASSERT_TRUE(shader);
  std::uint32_t first = 0;
  for (int k = 0; k < 20; ++k) {
    Fault fault;
    run(*shader, 64, fault);
    ASSERT_TRUE(fault.raised);
    EXPECT_EQ(fault.order, 0u);
    if (k == 0) first = fault.spirv_id;
    EXPECT_EQ(fault.spirv_id, first);
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
