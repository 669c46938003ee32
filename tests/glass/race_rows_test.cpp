// What the tool race looks at all at once, or later, is what it finds word by word: random accesses of a workgroup.
#include <random>

#include "glass/race/group.h"
#include "tests/glass/scene.h"
#include "tests/simd_targets.h"

namespace vitrine::glass::race {
namespace {

using spirv::Access;
using spirv::MemoryOrder;

constexpr char kSource[] = R"(#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) coherent buffer B { uint v[]; };
layout(set = 0, binding = 7) coherent buffer C { uvec4 w[]; } c[4];
shared uint s[1024];
shared uvec4 t[512];
void main() {
  uint i = gl_LocalInvocationIndex;
  s[i] = v[i + 1u];
  t[i] = c[0].w[i];
  barrier();
  v[i] = s[i + 1u] + atomicAdd(s[i + 2u], 1u);
  c[0].w[i + 1u] = t[i + 1u];
  atomicAdd(v[i + 2u], 1u);
}
)";

/// Keeps what the tool knows of the program.
struct Catcher : Tool {
  spirv::exec::Interest interest() const override { return {.accesses = true, .order = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    told = std::make_unique<Told>(shader, program);
    return nullptr;
  }
  std::unique_ptr<Told> told;
};

/// Where lanes access memory: bytes of it, a multiple of four.
void choose_offsets(std::mt19937& random, std::uint32_t bytes, std::uint32_t (&offsets)[base::kWaveWidth]) {
  const std::uint32_t pattern = random() % 6;
  const std::uint32_t start = random() % 3 == 0 ? random() % bytes & ~3u : random() % 8 * 64;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) {
    const std::uint32_t steps[] = {4, 8, 16, 0};
    if (pattern < 4) offsets[lane] = start + lane * steps[pattern];
    if (pattern == 4) offsets[lane] = start + (lane / 16 + lane % 16 * 2) * 4;
    if (pattern == 5) offsets[lane] = random() % 64 == 0 ? random() : random() % bytes & ~3u;
  }
}

base::LaneMask choose_lanes(std::mt19937& random) {
  const std::uint32_t pattern = random() % 4;
  const base::LaneMask bits = std::uint64_t{random()} << 32 | random();
  return pattern < 2 ? base::kAllLanes : pattern == 2 ? base::first_lanes(1 + random() % 64) : bits | 1;
}

void access(std::mt19937& random, const Told& told, Group (&groups)[2], std::uint32_t first) {
  const auto site = static_cast<std::uint32_t>(random() % told.sites.all.size());
  const Site& what = told.sites.all[site];
  const bool shared = what.memory == Memory::kShared;
  std::uint32_t offsets[base::kWaveWidth], values[4][base::kWaveWidth];
  choose_offsets(random, 4096, offsets);
  for (auto& component : values)
    for (std::uint32_t& value : component) value = random() % 2;
  Span span{{site, {first}}, choose_lanes(random), {offsets, 0}};
  if (random() % 8 == 0) span.offsets = {nullptr, static_cast<std::uint32_t>(random() % 1024) * 4};
  span.base = shared ? 0 : 0x10000;
  span.size = shared ? 12288 : 4096;
  for (std::uint32_t c = 0; c < 4 && what.action == Access::kStore; ++c) span.values[c] = values[c];
  for (Group& group : groups) {
    span.by.time = group.order().time();
    if (!shared) {
      group.touch_span(span);
    } else if (!what.is_logged() || !group.log_shared(span.by, span.lanes, span.offsets)) {
      group.touch_shared(span);
    }
  }
}

/// Barriers of several kinds, and none.
void order(std::mt19937& random, Group (&groups)[2]) {
  constexpr std::uint32_t kBoth = 0x8, kShared = MemoryOrder::kWorkgroupMemory, kBuffers = MemoryOrder::kUniformMemory;
  const std::uint32_t bits[] = {kBoth | kShared, kBoth | kShared | kBuffers, kBoth | kBuffers};
  MemoryOrder order{static_cast<std::uint16_t>(bits[random() % 3]), spirv::MemoryScope::kWorkgroup,
                    spirv::MemoryScope::kWorkgroup};
  const std::uint32_t kind = random() % 12, wave = random() % 4;
  for (Group& group : groups) {
    if (kind == 0) group.fence(wave, order, {wave * 64}, base::kAllLanes);
    if (kind == 1) {
      order.memory = order.execution = spirv::MemoryScope::kSubgroup;
      group.subgroup_barrier(order, wave * 64);
    }
    for (std::uint32_t w = 0; w < 4 && kind >= 2 && kind < 5; ++w) group.arrive(w, order, false);
    for (std::uint32_t w = 0; w < 4 && kind >= 2 && kind < 5; ++w) group.resume(w);
  }
}

std::vector<std::string> texts_of(Pairs& pairs) {
  std::vector<std::string> texts;
  for (const Finding& finding : pairs.take())
    texts.push_back(std::to_string(finding.count) + " x " + finding.message + " " +
                    to_text(finding.address.invocation));
  return texts;
}

/// The tool's knowledge of kSource.
std::unique_ptr<Told> told_of_source() {
  std::string log;
  const auto module =
      vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, kSource, vitrine::test::VulkanVersion::k12, log);
  EXPECT_FALSE(module.empty()) << log;
  Catcher catcher;
  glass::test::Scene scene;
  scene.run(catcher, VK_SHADER_STAGE_COMPUTE_BIT, module);
  return std::move(catcher.told);
}

/// Two workgroups store four words for each of the invocations 1 to 63, or single words, from the same place on.
TEST(RaceRows, OfWorkgroupsNameInvocations) {
  const auto told = told_of_source();
  for (const std::uint32_t parts : {1u, 4u}) {
    std::uint32_t site = 0;
    while (told->sites.all[site].memory != Memory::kBuffer || told->sites.all[site].action != Access::kStore ||
           told->sites.all[site].touched.count != parts)
      ++site;
    std::uint32_t offsets[base::kWaveWidth];
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) offsets[lane] = lane * parts * 4;
    Span span{{site}, base::kAllLanes - 1, {offsets, 0}, 0x10000, 4096};
    for (const std::uint32_t*& values : span.values) values = offsets;
    Pairs pairs;
    Group group(pairs);
    CommandLog log;
    for (std::uint32_t workgroup = 0; workgroup < 2; ++workgroup) {
      group.begin(*told, nullptr, {{workgroup, 0, 0}, 0}, false, 0);
      span.by.time = group.order().time();
      group.touch_span(span);
      group.end(log);
    }
    log.settle(pairs, nullptr);
    const auto findings = pairs.take();
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].count, 63u * parts);
    EXPECT_EQ(to_text(findings[0].address.invocation), "invocation (257, 0, 0)");
    EXPECT_NE(findings[0].message.find(" by invocation (1, 0, 0)"), std::string::npos) << findings[0].message;
    EXPECT_NE(findings[0].message.find("the same value"), std::string::npos) << findings[0].message;
  }
}

TEST(RaceRows, FindWhatWordsFind) {
  const auto owner = told_of_source();
  const Told& told = *owner;
  ASSERT_GE(told.sites.all.size(), 10u);
  base::for_each_simd_target([&] {
    std::size_t found = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
      std::mt19937 random(seed);
      Pairs pairs[2];
      Group groups[2] = {Group(pairs[0]), Group(pairs[1], true)};
      CommandLog logs[2];
      for (std::uint32_t workgroup = 0; workgroup < 3; ++workgroup) {
        for (Group& group : groups) group.begin(told, nullptr, {{workgroup, 0, 0}, 0}, seed % 4 == 3, 12288);
        for (std::uint32_t step = random() % (seed % 2 != 0 ? 40 : 4); step != 0; --step) {
          access(random, told, groups, groups[0].base() + random() % 4 * 64);
          order(random, groups);
        }
        for (std::size_t i = 0; i < 2 && seed % 4 != 3; ++i) groups[i].end(logs[i]);
      }
      for (std::size_t i = 0; i < 2; ++i) {
        if (groups[i].is_open()) groups[i].end(logs[i]);
        logs[i].settle(pairs[i], nullptr);
      }
      const auto texts = texts_of(pairs[0]);
      ASSERT_EQ(texts, texts_of(pairs[1])) << "seed " << seed;
      found += texts.size();
    }
    EXPECT_GT(found, 300u);
  });
}

}  // namespace
}  // namespace vitrine::glass::race
