// Planted faults and their correct twins, in compute shaders.
#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

/// "rule xCOUNT first: message" of each finding.
std::vector<std::string> found(const std::string& declarations, const std::string& body, std::uint32_t groups = 1) {
  const auto tool = make_sanitize();
  std::vector<std::uint32_t> words(64);
  for (std::uint32_t i = 0; i < words.size(); ++i) words[i] = i;
  run_observed(tool.get(), R"(#version 460
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
)" + declarations + R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
)" + body + "}\n",
               words, groups);
  std::vector<std::string> texts;
  for (const Finding& finding : tool->take_findings())
    texts.push_back(std::string(finding.rule->id) + " x" + std::to_string(finding.count) + " at " +
                    std::to_string(finding.address.invocation.id[0]) + ": " + finding.message);
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Sanitize, FindsLoadsOutsideOfBuffers) {
  EXPECT_EQ(found("", "v[0] = v[i + 60u];"),
            Texts{"out-of-bounds-load x4 at 4: load of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "v[0] = v[i + 56u];"), Texts{});
}

TEST(Sanitize, FindsStoresOutsideOfBuffers) {
  EXPECT_EQ(found("", "v[i + 61u] = 1u;"),
            Texts{"out-of-bounds-store x5 at 3: store of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "if (i < 3u) v[i + 61u] = 1u;"), Texts{});
}

TEST(Sanitize, FindsAtomicsOutsideOfBuffers) {
  EXPECT_EQ(
      found("", "atomicAdd(v[i * 10u], 1u);"),
      Texts{
          "out-of-bounds-atomic x1 at 7: atomic operation on 4 bytes at offset 280, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "atomicAdd(v[i * 9u], 1u);"), Texts{});
}

TEST(Sanitize, FindsLoadsThatAllInvocationsShare) {
  EXPECT_EQ(found("", "v[i] = v[v[63] + 1u];"),
            Texts{"out-of-bounds-load x8 at 0: load of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "if (i > 100u) v[i] = v[v[63] + 1u];"), Texts{});
}

TEST(Sanitize, FindsWhatWrapsAround) {
  EXPECT_EQ(
      found("", "v[i] = v[i - 1u];"),
      Texts{"out-of-bounds-load x1 at 0: load of 4 bytes at offset 4294967292, outside of a buffer of 256 bytes"});
}

TEST(Sanitize, FindsAccessesOutsideOfSharedMemory) {
  const std::string shared = "shared uint s[12];";
  EXPECT_EQ(found(shared, "s[i + 8u] = i; barrier(); v[i] = s[i];"),
            Texts{"out-of-bounds-shared x4 at 4: store of 4 bytes at offset 48, outside of shared memory (48 bytes)"});
  EXPECT_EQ(found(shared, "s[i + 4u] = i; barrier(); v[i] = s[i];"), Texts{});
}

TEST(Sanitize, FindsIndicesPastTheEndOfArrays) {
  const std::string fill = "uint a[5]; for (uint k = 0u; k < 5u; ++k) a[k] = v[k]; ";
  EXPECT_EQ(found("", fill + "v[i] = a[v[i]];"),
            Texts{"out-of-bounds-array x3 at 5: load of word 5 of an array variable of 5 words"});
  EXPECT_EQ(found("", fill + "v[i] = a[v[i] % 5u];"), Texts{});
}

TEST(Sanitize, CountsAPlaceOnce) {
  EXPECT_EQ(found("", "for (uint k = 0u; k < v[4]; ++k) v[64u + k + i] = k;", 2),
            Texts{"out-of-bounds-store x64 at 0: store of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
}

}  // namespace
}  // namespace vitrine::glass::test
