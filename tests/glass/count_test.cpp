// What shaders cost, by kind of instruction.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

/// The shader's counters.
nlohmann::json counts_of(const std::string& body, std::uint32_t groups = 1) {
  const auto file = std::filesystem::temp_directory_path() / ("vitrine-count-" + std::to_string(::getpid()) + ".json");
  ::setenv("VITRINE_COUNTS", file.c_str(), 1);
  const auto tool = make_count();
  std::vector<std::uint32_t> words(64);
  for (std::uint32_t i = 0; i < words.size(); ++i) words[i] = i;
  run_observed(tool.get(), R"(#version 460
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
shared uint s[8];
void main() {
  uint i = gl_GlobalInvocationID.x;
)" + body + "}\n",
               words, groups);
  tool->write();
  nlohmann::json json;
  std::ifstream(file) >> json;
  std::filesystem::remove(file);
  return json["total"];
}

TEST(Count, CountsWhatInvocationsRun) {
  const auto counts = counts_of("if (i < 3u) v[i] = v[i] + 1u;");
  EXPECT_EQ(counts["invocations"], 8);
  EXPECT_EQ(counts["branches"], 8);
  EXPECT_EQ(counts["loads"], 3);
  EXPECT_EQ(counts["stores"], 3);
  EXPECT_EQ(counts["bytesLoaded"], 12);
  EXPECT_EQ(counts["bytesStored"], 12);
  EXPECT_EQ(counts["arithmetic"], 8 + 3);  // the comparison, the addition
}

TEST(Count, CountsLoopsThatAreUnrolled) {
  const auto counts = counts_of("uint x = 0u; for (uint k = 0u; k < 4u; ++k) x += v[k]; v[i] = x;");
  EXPECT_EQ(counts["loads"], 4 * 8);
  EXPECT_EQ(counts["branches"], 5 * 8);
}

TEST(Count, CountsLanesThatHaveNothingToDo) {
  const auto one = counts_of("v[i] = 1u;"), eight = counts_of("v[i] = 1u;", 8);
  EXPECT_EQ(one["idleInstructions"], 7 * one["instructions"].get<int>());  // 8 of 64 lanes
  EXPECT_EQ(eight["idleInstructions"], 0);                                 // 8 workgroups share a wave
  EXPECT_EQ(eight["instructions"], 8 * one["instructions"].get<int>());
}

TEST(Count, TellsSharedMemoryAtomicsAndBarriersApart) {
  const auto counts = counts_of("s[i % 8u] = i; barrier(); atomicAdd(v[0], s[7u - i % 8u]);");
  EXPECT_EQ(counts["stores"], 8);
  EXPECT_EQ(counts["loads"], 8);
  EXPECT_EQ(counts["atomics"], 8);
  EXPECT_EQ(counts["barriers"], 8);
}

}  // namespace
}  // namespace vitrine::glass::test
