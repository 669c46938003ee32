// Workgroups that do to shared memory what others without races did are not looked at, and what is found is the same.
#include <random>

#include "glass/race/group.h"
#include "tests/glass/scene.h"

namespace vitrine::glass::race {
namespace {

using spirv::Access;
using spirv::MemoryOrder;

constexpr char kSource[] = R"(#version 460
layout(local_size_x = 128) in;
layout(set = 0, binding = 0) coherent buffer B { uint v[]; };
shared uint s[1024];
void main() {
  uint i = gl_LocalInvocationIndex;
  s[i] = v[i];
  barrier();
  v[i] = s[i + 1u] + atomicAdd(s[i + 2u], 1u);
}
)";
constexpr std::uint32_t kBytes = 4096;

struct Catcher : Tool {
  spirv::exec::Interest interest() const override { return {.accesses = true, .order = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    told = std::make_unique<Told>(shader, program);
    return nullptr;
  }
  std::unique_ptr<Told> told;
};

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

std::uint32_t site_of(const Told& told, Access action) {
  std::uint32_t site = 0;
  while (told.sites.all[site].memory != Memory::kShared || told.sites.all[site].action != action) ++site;
  return site;
}

/// What a wave does: an access with a word for each lane, all with the same one, or a barrier of the workgroup.
struct Step {
  enum class Kind : std::uint8_t { kRow, kOneWord, kBarrier, kFence, kSubgroup } kind = Kind::kRow;
  std::uint32_t site = 0, wave = 0, offset = 0, shuffle = 0, value = 0;
  base::LaneMask lanes = base::kAllLanes;
};

/// Told of the same workgroups, one that follows and one that does not.
struct Both {
  explicit Both(const Told& source) : told(source) {}
  void begin(std::uint32_t workgroup) {
    for (Group& group : groups) group.begin(told, nullptr, {{workgroup, 0, 0}, 0}, false, kBytes);
    groups[1].stop_following();
  }
  void end() {
    for (std::size_t i = 0; i < 2; ++i) groups[i].end(logs[i]);
  }
  void does(const Step& step) {
    if (step.kind != Step::Kind::kRow && step.kind != Step::Kind::kOneWord) return orders(step);
    std::uint32_t offsets[base::kWaveWidth], stored[base::kWaveWidth];
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) {
      offsets[lane] = step.offset + (lane ^ step.shuffle) * 4;
      stored[lane] = step.value;
    }
    const bool stores = told.sites.all[step.site].action == Access::kStore;
    Span span{{step.site, {step.wave * 64}}, step.lanes, {.words = offsets}, 0, kBytes};
    if (step.kind == Step::Kind::kOneWord) span.offsets = {nullptr, step.offset, 0};
    if (stores) span.values[0] = stored;
    for (Group& group : groups) {
      if (group.may_follow() && group.follows(step.site, step.wave * 64, step.lanes, span.offsets, span.values)) {
        ++followed;
        continue;
      }
      span.by.time = group.order().time();
      if (stores || !group.log_shared(span.by, span.lanes, span.offsets)) group.touch_shared(span);
    }
  }
  std::vector<std::string> texts(std::size_t which) {
    std::vector<std::string> texts;
    for (const Finding& finding : pairs[which].take())
      texts.push_back(std::to_string(finding.count) + " x " + finding.message + " " +
                      to_text(finding.address.invocation));
    return texts;
  }

  const Told& told;
  Pairs pairs[2];
  Group groups[2] = {Group(pairs[0]), Group(pairs[1])};
  CommandLog logs[2];
  std::size_t followed = 0;

 private:
  void orders(const Step& step) {
    constexpr std::uint32_t kShared = 0x8 | MemoryOrder::kWorkgroupMemory;
    MemoryOrder order{static_cast<std::uint16_t>(kShared), spirv::MemoryScope::kWorkgroup,
                      spirv::MemoryScope::kWorkgroup};
    for (Group& group : groups) {
      if (step.kind == Step::Kind::kFence) group.fence(step.wave, order, {step.wave * 64}, base::kAllLanes);
      for (std::uint32_t w = 0; w < 2 && step.kind == Step::Kind::kBarrier; ++w) group.arrive(w, order, false);
      for (std::uint32_t w = 0; w < 2 && step.kind == Step::Kind::kBarrier; ++w) group.resume(w);
      if (step.kind != Step::Kind::kSubgroup) continue;
      order.memory = order.execution = spirv::MemoryScope::kSubgroup;
      group.subgroup_barrier(order, step.wave * 64);
    }
  }
};

Step random_step(std::mt19937& random, const Told& told) {
  Step step;
  step.wave = random() % 2;
  step.value = random() % 2;
  if (random() % 4 == 0) {
    step.kind = Step::Kind::kBarrier;
    return step;
  }
  step.site = site_of(told, random() % 2 != 0 ? Access::kStore : random() % 4 != 0 ? Access::kLoad : Access::kAtomic);
  // Mostly a place of the wave alone.
  step.offset = random() % 8 != 0 ? step.wave * 256 : random() % 2 * 256;
  step.shuffle = random() % 16 == 0 ? random() % 4 : 0;
  if (random() % 4 == 0) step.lanes = std::uint64_t{random()} << 32 | random() | 1;
  if (random() % 16 == 0) step.kind = Step::Kind::kOneWord;
  return step;
}

/// Another one, so that a workgroup leaves its way.
void change(std::mt19937& random, const Told& told, std::vector<Step>& steps) {
  const std::size_t at = random() % steps.size();
  const std::uint32_t pattern = random() % 5;
  if (pattern == 0) steps.resize(at);
  if (pattern == 1) steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(at));
  if (pattern == 2) steps.insert(steps.begin() + static_cast<std::ptrdiff_t>(at), random_step(random, told));
  if (pattern == 3) steps[at] = random_step(random, told);
  if (pattern == 4 && random() % 4 == 0)
    steps[at].kind = random() % 2 != 0 ? Step::Kind::kFence : Step::Kind::kSubgroup;
}

TEST(RaceFollow, WhatAnotherDidIsNotLookedAtAgain) {
  const auto told = told_of_source();
  const std::uint32_t store = site_of(*told, Access::kStore), load = site_of(*told, Access::kLoad);
  Both both(*told);
  std::vector<Step> steps = {{.site = store}, {.site = store, .wave = 1, .offset = 256}};
  steps.push_back({.kind = Step::Kind::kBarrier});
  for (std::uint32_t wave = 0; wave < 2; ++wave)
    steps.push_back({.site = load, .wave = wave, .offset = 256, .shuffle = 5});
  for (std::uint32_t workgroup = 0; workgroup < 10; ++workgroup) {
    both.begin(workgroup);
    for (const Step& step : steps) both.does(step);
    both.end();
  }
  EXPECT_EQ(both.followed, 9 * 4u);  // all but the first one's
  EXPECT_EQ(both.texts(0), std::vector<std::string>{});
}

TEST(RaceFollow, TwoWaysAreFollowedInTurn) {
  const auto told = told_of_source();
  const std::uint32_t store = site_of(*told, Access::kStore);
  Both both(*told);
  for (std::uint32_t workgroup = 0; workgroup < 10; ++workgroup) {
    both.begin(workgroup);
    both.does({.site = store});
    both.does({.site = store, .wave = 1, .offset = 256 + workgroup % 2 * 256});
    both.end();
  }
  EXPECT_EQ(both.followed, 8 * 2 + 1u);
}

/// A race of what has been followed with what comes when the way is left, with invocation and value.
TEST(RaceFollow, WhatWasFollowedIsKnownWhenTheWayIsLeft) {
  const auto told = told_of_source();
  const std::uint32_t store = site_of(*told, Access::kStore);
  Both both(*told);
  for (std::uint32_t workgroup = 0; workgroup < 3; ++workgroup) {
    both.begin(workgroup);
    both.does({.site = store, .value = workgroup});
    both.does({.site = store, .wave = 1, .offset = workgroup < 2 ? 256u : 0u, .value = 2});
    both.end();
  }
  const auto texts = both.texts(0);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts, both.texts(1));
  EXPECT_NE(texts[0].find("the same value"), std::string::npos) << texts[0];
  EXPECT_GT(both.followed, 0u);
}

TEST(RaceFollow, NobodyFollowsWhereAllDoSomethingElse) {
  const auto told = told_of_source();
  const std::uint32_t store = site_of(*told, Access::kStore);
  Both both(*told);
  for (std::uint32_t workgroup = 0; workgroup < 40; ++workgroup) {
    both.begin(workgroup);
    EXPECT_EQ(both.groups[0].may_follow(), workgroup < 16) << workgroup;
    both.does({.site = store, .offset = workgroup * 4});
    both.end();
  }
}

TEST(RaceFollow, FindsWhatIsFoundWithoutIt) {
  const auto told = told_of_source();
  std::size_t found = 0, followed = 0;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    std::vector<Step> steps;
    for (std::uint32_t count = 2 + random() % 12; count != 0; --count) steps.push_back(random_step(random, *told));
    Both both(*told);
    for (std::uint32_t workgroup = 0; workgroup < 8; ++workgroup) {
      std::vector<Step> own = steps;
      if (random() % 2 == 0) change(random, *told, own);
      both.begin(workgroup);
      for (const Step& step : own) both.does(step);
      both.end();
    }
    const auto texts = both.texts(0);
    ASSERT_EQ(texts, both.texts(1)) << "seed " << seed;
    found += texts.size();
    followed += both.followed;
  }
  EXPECT_GT(found, 500u);
  EXPECT_GT(followed, 5000u);
}

}  // namespace
}  // namespace vitrine::glass::race
