// Group operations against a model of lanes: every subgroup size, divergent control flow, workgroups that do not fill
// their last subgroup, ordered sums of floats, clusters and quads.
#include <bit>
#include <functional>
#include <optional>

#include "base/numeric.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

using Lanes = std::vector<std::uint32_t>;

/// A subgroup: the values of its lanes and which of them are active.
struct Group {
  std::uint32_t size = 0;
  Lanes x;
  std::uint64_t active = 0;

  bool is_active(std::uint32_t lane) const { return lane < x.size() && (active >> lane & 1) != 0; }
  std::uint32_t first() const { return static_cast<std::uint32_t>(std::countr_zero(active)); }
  std::uint64_t ballot(const std::function<bool(std::uint32_t)>& holds) const {
    std::uint64_t result = 0;
    for (std::uint32_t lane = 0; lane < x.size(); lane++)
      if (is_active(lane) && holds(x[lane])) result |= std::uint64_t{1} << lane;
    return result;
  }
};

using Model = std::function<std::optional<std::uint32_t>(const Group&, std::uint32_t lane)>;

constexpr char kExtensions[] = R"(
#extension GL_KHR_shader_subgroup_basic : enable
#extension GL_KHR_shader_subgroup_vote : enable
#extension GL_KHR_shader_subgroup_ballot : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_KHR_shader_subgroup_shuffle_relative : enable
#extension GL_KHR_shader_subgroup_clustered : enable
#extension GL_KHR_shader_subgroup_quad : enable
#extension GL_EXT_shader_explicit_arithmetic_types_int8 : enable
#extension GL_EXT_shader_explicit_arithmetic_types_int16 : enable
#extension GL_EXT_shader_subgroup_extended_types_int8 : enable
#extension GL_EXT_shader_subgroup_extended_types_int16 : enable
)";

std::vector<std::uint32_t> dispatch_words(const std::string& source, std::uint32_t size,
                                          std::vector<std::uint32_t> values, std::uint32_t groups) {
  CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
  options.subgroup_size = size;
  dispatch_over(values, compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, kExtensions + source), options, groups);
  return values;
}

std::uint32_t input_of(std::uint32_t i) { return (i * 2654435761u) >> 27; }

/// `expression` in x where `condition` holds, for every size and for workgroups that fill their waves or do not.
void expect_group(
    const std::string& expression, const Model& model, const std::string& condition = "true",
    const std::function<bool(std::uint32_t)>& holds = [](std::uint32_t) { return true; }) {
  for (const std::uint32_t size : {8u, 16u, 32u, 64u})
    for (const std::uint32_t local : {1u, 5u, 64u, 100u}) {
      constexpr std::uint32_t kGroups = 3;
      const std::string source = "layout(local_size_x = " + std::to_string(local) +
                                 ") in;\nlayout(set = 0, binding = 0) buffer B { uint v[]; };\nvoid main() {\n"
                                 "  uint i = gl_GlobalInvocationID.x, x = v[i], r = 12345u;\n  if (" +
                                 condition + ") r = " + expression + ";\n  v[i] = r;\n}\n";
      std::vector<std::uint32_t> values(kGroups * local);
      for (std::uint32_t i = 0; i < values.size(); i++) values[i] = input_of(i);
      const std::vector<std::uint32_t> got = dispatch_words(source, size, values, kGroups);
      for (std::uint32_t i = 0; i < values.size(); i++) {
        const std::uint32_t in_workgroup = i % local, first = i - in_workgroup + in_workgroup / size * size;
        Group group;
        group.size = size;
        for (std::uint32_t k = first; k < std::min(first + size, i - in_workgroup + local); k++) {
          group.x.push_back(values[k]);
          if (holds(values[k])) group.active |= std::uint64_t{1} << (k - first);
        }
        const std::optional<std::uint32_t> wanted =
            holds(values[i]) ? model(group, i - first) : std::optional<std::uint32_t>(12345u);
        if (!wanted) continue;
        ASSERT_EQ(got[i], *wanted) << "size " << size << ", local " << local << ", at " << i << "\n" << source;
      }
    }
}

/// Everywhere, and where x is a multiple of 3.
void expect_group_divergent(const std::string& expression, const Model& model) {
  expect_group(expression, model);
  expect_group(expression, model, "x % 3u == 0u", [](std::uint32_t x) { return x % 3 == 0; });
}

template <class T>
Model reduce_model(T start, const std::function<T(T, T)>& f, int mode, std::uint32_t cluster = 64) {
  return [=](const Group& group, std::uint32_t lane) {
    const std::uint32_t size = std::min(cluster, group.size), from = lane / size * size;
    T sum = start;
    for (std::uint32_t k = from; k < from + size && !(mode == 2 && k == lane); k++) {
      if (group.is_active(k)) sum = f(static_cast<T>(group.x[k]), sum);
      if (mode == 1 && k == lane) break;
    }
    return std::optional<std::uint32_t>(std::bit_cast<std::uint32_t>(sum));
  };
}

TEST(Subgroups, IntegerReductionsAndScans) {
  struct Row {
    const char* name;
    std::uint32_t start;
    std::uint32_t (*f)(std::uint32_t, std::uint32_t);
  };
  const Row rows[] = {
      {"Add", 0, [](std::uint32_t a, std::uint32_t b) { return a + b; }},
      {"Mul", 1, [](std::uint32_t a, std::uint32_t b) { return a * b; }},
      {"Min", ~0u, [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); }},
      {"Max", 0, [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); }},
      {"And", ~0u, [](std::uint32_t a, std::uint32_t b) { return a & b; }},
      {"Or", 0, [](std::uint32_t a, std::uint32_t b) { return a | b; }},
      {"Xor", 0, [](std::uint32_t a, std::uint32_t b) { return a ^ b; }},
  };
  for (const Row& row : rows) {
    const std::string name = row.name;
    expect_group_divergent("subgroup" + name + "(x)", reduce_model<std::uint32_t>(row.start, row.f, 0));
    expect_group_divergent("subgroupInclusive" + name + "(x)", reduce_model<std::uint32_t>(row.start, row.f, 1));
    expect_group_divergent("subgroupExclusive" + name + "(x)", reduce_model<std::uint32_t>(row.start, row.f, 2));
    expect_group_divergent("subgroupClustered" + name + "(x, 4u)", reduce_model<std::uint32_t>(row.start, row.f, 0, 4));
  }
}

TEST(Subgroups, SignedMinAndMax) {
  const auto shifted = [](const Group& group, std::uint32_t, bool want_max) {
    std::int32_t best = want_max ? INT32_MIN : INT32_MAX;
    for (std::uint32_t k = 0; k < group.x.size(); k++)
      if (group.is_active(k)) {
        const std::int32_t value = static_cast<std::int32_t>(group.x[k]) - 16;
        best = want_max ? std::max(best, value) : std::min(best, value);
      }
    return std::optional<std::uint32_t>(static_cast<std::uint32_t>(best));
  };
  using namespace std::placeholders;
  expect_group_divergent("uint(subgroupMin(int(x) - 16))", std::bind(shifted, _1, _2, false));
  expect_group_divergent("uint(subgroupMax(int(x) - 16))", std::bind(shifted, _1, _2, true));
}

TEST(Subgroups, NarrowMinAndMaxOfNoLanesAreOfTheirWidth) {
  // SPIR-V, OpGroupNonUniformSMin: "The identity I for Operation is INT_MAX", that of the type.
  const auto exclusive = [](bool want_max, std::int32_t none) -> Model {
    return [=](const Group& group, std::uint32_t lane) {
      std::int32_t best = none;
      for (std::uint32_t k = 0; k < lane; k++)
        if (group.is_active(k)) {
          const std::int32_t value = static_cast<std::int32_t>(group.x[k]) - 16;
          best = want_max ? std::max(best, value) : std::min(best, value);
        }
      return std::optional<std::uint32_t>(static_cast<std::uint32_t>(best));
    };
  };
  expect_group_divergent("uint(int(subgroupExclusiveMin(int8_t(int(x) - 16))))", exclusive(false, INT8_MAX));
  expect_group_divergent("uint(int(subgroupExclusiveMax(int8_t(int(x) - 16))))", exclusive(true, INT8_MIN));
  expect_group_divergent("uint(int(subgroupExclusiveMin(int16_t(int(x) - 16))))", exclusive(false, INT16_MAX));
  expect_group_divergent("uint(int(subgroupExclusiveMax(int16_t(int(x) - 16))))", exclusive(true, INT16_MIN));
  expect_group_divergent("uint(subgroupExclusiveMin(uint8_t(x)))",
                         reduce_model<std::uint32_t>(
                             UINT8_MAX, [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); }, 2));
}

TEST(Subgroups, FloatSumsGoFromTheLowestLaneToTheHighest) {
  const auto model = [](int mode) -> Model {
    return [mode](const Group& group, std::uint32_t lane) {
      float sum = 0;
      for (std::uint32_t k = 0; k < group.x.size() && !(mode == 2 && k == lane); k++) {
        if (group.is_active(k)) sum = 1.0f / (static_cast<float>(group.x[k]) + 0.75f) + sum;
        if (mode == 1 && k == lane) break;
      }
      return std::optional<std::uint32_t>(base::bits_of(sum));
    };
  };
  expect_group_divergent("floatBitsToUint(subgroupAdd(1.0 / (float(x) + 0.75)))", model(0));
  expect_group_divergent("floatBitsToUint(subgroupInclusiveAdd(1.0 / (float(x) + 0.75)))", model(1));
  expect_group_divergent("floatBitsToUint(subgroupExclusiveAdd(1.0 / (float(x) + 0.75)))", model(2));
}

TEST(Subgroups, DoublesAndWideIntegers) {
  const auto sum = [](int mode) -> Model {
    return [mode](const Group& group, std::uint32_t lane) {
      double total = 0;
      for (std::uint32_t k = 0; k < group.x.size() && !(mode == 2 && k == lane); k++) {
        if (group.is_active(k)) total = 1.0 / (static_cast<double>(group.x[k]) + 0.75) + total;
        if (mode == 1 && k == lane) break;
      }
      const auto bits = std::bit_cast<std::uint64_t>(total);
      return std::optional<std::uint32_t>(static_cast<std::uint32_t>(bits ^ bits >> 32));
    };
  };
  const auto folded = [](const std::string& value) {
    return "unpackDouble2x32(" + value + ").x ^ unpackDouble2x32(" + value + ").y";
  };
  expect_group_divergent(folded("subgroupAdd(1.0lf / (double(x) + 0.75lf))"), sum(0));
  expect_group_divergent(folded("subgroupInclusiveAdd(1.0lf / (double(x) + 0.75lf))"), sum(1));
  expect_group_divergent(folded("subgroupExclusiveAdd(1.0lf / (double(x) + 0.75lf))"), sum(2));
  expect_group_divergent("uint(subgroupMax(double(x) + 0.5lf))", [](const Group& group, std::uint32_t) {
    std::uint32_t best = 0;
    for (std::uint32_t k = 0; k < group.x.size(); k++)
      if (group.is_active(k)) best = std::max(best, group.x[k]);
    return best;
  });
}

TEST(Subgroups, VotesAndElection) {
  const auto is_odd = [](std::uint32_t x) { return (x & 1) != 0; };
  expect_group_divergent("subgroupElect() ? 1u : 0u",
                         [](const Group& group, std::uint32_t lane) { return group.first() == lane ? 1u : 0u; });
  expect_group_divergent("subgroupAny((x & 1u) != 0u) ? 1u : 0u",
                         [=](const Group& group, std::uint32_t) { return group.ballot(is_odd) != 0 ? 1u : 0u; });
  expect_group_divergent("subgroupAll((x & 1u) != 0u) ? 1u : 0u", [=](const Group& group, std::uint32_t) {
    return group.ballot(is_odd) == group.active ? 1u : 0u;
  });
  expect_group_divergent("subgroupAllEqual(x >> 4) ? 1u : 0u", [](const Group& group, std::uint32_t) {
    const std::uint32_t value = group.x[group.first()] >> 4;
    return group.ballot([&](std::uint32_t x) { return x >> 4 == value; }) == group.active ? 1u : 0u;
  });
  expect_group_divergent("subgroupAnd(x > 3u) ? 1u : 0u", [](const Group& group, std::uint32_t) {
    return group.ballot([](std::uint32_t x) { return x > 3; }) == group.active ? 1u : 0u;
  });
}

TEST(Subgroups, BallotsAndMasks) {
  const auto small = [](std::uint32_t x) { return x < 12; };
  for (int word = 0; word < 4; word++)
    expect_group_divergent("subgroupBallot(x < 12u)[" + std::to_string(word) + "]",
                           [=](const Group& group, std::uint32_t) {
                             return word > 1 ? 0u : static_cast<std::uint32_t>(group.ballot(small) >> (32 * word));
                           });
  const auto count = [=](std::uint64_t (*mask)(std::uint32_t)) {
    return [=](const Group& group, std::uint32_t lane) {
      return static_cast<std::uint32_t>(std::popcount(group.ballot(small) & mask(lane)));
    };
  };
  expect_group_divergent("subgroupBallotBitCount(subgroupBallot(x < 12u))",
                         count([](std::uint32_t) { return ~std::uint64_t{0}; }));
  expect_group_divergent("subgroupBallotExclusiveBitCount(subgroupBallot(x < 12u))",
                         count([](std::uint32_t lane) { return (std::uint64_t{1} << lane) - 1; }));
  expect_group_divergent("subgroupBallotInclusiveBitCount(subgroupBallot(x < 12u))",
                         count([](std::uint32_t lane) { return (std::uint64_t{2} << lane) - 1; }));
  expect_group_divergent("subgroupBallotFindLSB(subgroupBallot(true))",
                         [](const Group& group, std::uint32_t) { return group.first(); });
  expect_group_divergent("subgroupBallotFindMSB(subgroupBallot(true))", [](const Group& group, std::uint32_t) {
    return 63 - static_cast<std::uint32_t>(std::countl_zero(group.active));
  });
  expect_group_divergent(
      "subgroupInverseBallot(uvec4(0xa5a5a5a5u, 0x5a5a5a5au, 0u, 0u)) ? 1u : 0u",
      [](const Group&, std::uint32_t lane) { return static_cast<std::uint32_t>(0x5a5a5a5aa5a5a5a5u >> lane & 1); });
  expect_group_divergent("subgroupBallotBitExtract(uvec4(0xa5a5a5a5u, 0x5a5a5a5au, 0u, 0u), x) ? 1u : 0u",
                         [](const Group& group, std::uint32_t lane) -> std::optional<std::uint32_t> {
                           if (group.x[lane] >= group.size) return std::nullopt;
                           return static_cast<std::uint32_t>(0x5a5a5a5aa5a5a5a5u >> group.x[lane] & 1);
                         });
  struct Mask {
    const char* name;
    std::uint64_t (*bits)(std::uint32_t lane);
  };
  for (const Mask& mask : {Mask{"Eq", [](std::uint32_t lane) { return std::uint64_t{1} << lane; }},
                           Mask{"Lt", [](std::uint32_t lane) { return (std::uint64_t{1} << lane) - 1; }},
                           Mask{"Le", [](std::uint32_t lane) { return (std::uint64_t{2} << lane) - 1; }},
                           Mask{"Ge", [](std::uint32_t lane) { return ~((std::uint64_t{1} << lane) - 1); }},
                           Mask{"Gt", [](std::uint32_t lane) { return ~((std::uint64_t{2} << lane) - 1); }}})
    for (int word = 0; word < 2; word++)
      expect_group(std::string("gl_Subgroup") + mask.name + "Mask[" + std::to_string(word) + "]",
                   [=](const Group& group, std::uint32_t lane) {
                     const std::uint64_t all =
                         group.size == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << group.size) - 1;
                     return static_cast<std::uint32_t>((mask.bits(lane) & all) >> (32 * word));
                   });
}

TEST(Subgroups, SizesAndNumbers) {
  expect_group("gl_SubgroupSize", [](const Group& group, std::uint32_t) { return group.size; });
  expect_group("gl_SubgroupInvocationID", [](const Group&, std::uint32_t lane) { return lane; });
  expect_group("gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID - gl_LocalInvocationIndex",
               [](const Group&, std::uint32_t) { return 0u; });
  expect_group("gl_NumSubgroups - (gl_WorkGroupSize.x + gl_SubgroupSize - 1u) / gl_SubgroupSize",
               [](const Group&, std::uint32_t) { return 0u; });
}

TEST(Subgroups, BroadcastsAndShuffles) {
  const auto from = [](std::uint32_t (*lane_of)(std::uint32_t lane, const Group& group)) {
    return [=](const Group& group, std::uint32_t lane) -> std::optional<std::uint32_t> {
      const std::uint32_t source = lane_of(lane, group);
      if (!group.is_active(source)) return std::nullopt;
      return group.x[source];
    };
  };
  expect_group_divergent("subgroupBroadcastFirst(x)", from([](std::uint32_t, const Group& g) { return g.first(); }));
  expect_group_divergent("subgroupBroadcast(x, 3u)", from([](std::uint32_t, const Group&) { return 3u; }));
  expect_group_divergent("subgroupShuffle(x, x & 7u)",
                         from([](std::uint32_t lane, const Group& g) { return g.x[lane] & 7; }));
  expect_group_divergent("subgroupShuffleXor(x, 5u)", from([](std::uint32_t lane, const Group&) { return lane ^ 5; }));
  expect_group_divergent("subgroupShuffleUp(x, 3u)", from([](std::uint32_t lane, const Group&) { return lane - 3; }));
  expect_group_divergent("subgroupShuffleDown(x, 2u)", from([](std::uint32_t lane, const Group&) { return lane + 2; }));
  expect_group_divergent("subgroupQuadBroadcast(x, 2u)",
                         from([](std::uint32_t lane, const Group&) { return (lane & ~3u) + 2; }));
  expect_group_divergent("subgroupQuadSwapHorizontal(x)",
                         from([](std::uint32_t lane, const Group&) { return lane ^ 1; }));
  expect_group_divergent("subgroupQuadSwapVertical(x)",
                         from([](std::uint32_t lane, const Group&) { return lane ^ 2; }));
  expect_group_divergent("subgroupQuadSwapDiagonal(x)",
                         from([](std::uint32_t lane, const Group&) { return lane ^ 3; }));
  expect_group_divergent("uint(subgroupBroadcastFirst(x > 9u))",
                         [](const Group& group, std::uint32_t) { return group.x[group.first()] > 9 ? 1u : 0u; });
  expect_group_divergent("subgroupShuffleXor(vec3(x, 2.0, x + 1u), 1u).z == 0.0 ? 0u : 7u",
                         [](const Group& group, std::uint32_t lane) -> std::optional<std::uint32_t> {
                           return group.is_active(lane ^ 1) ? std::optional(7u) : std::nullopt;
                         });
}

// Undefined, and so that of no earlier wave: x is another register in lanes that never left the loop.
TEST(Subgroups, ShufflesReadZeroFromInactiveLanes) {
  constexpr char kSource[] = R"(
layout(local_size_x = 5) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
void main() {
  uint i = gl_GlobalInvocationID.x, x = v[i];
  for (;;)
    if (subgroupBroadcastFirst(x) == x) { x *= subgroupAdd(3u); break; }
  v[i] = subgroupShuffleXor(x, 7u) + subgroupShuffle(x, 6u);
}
)";
  constexpr char kLeavesOnes[] = R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
void main() {
  uint i = gl_GlobalInvocationID.x, x[16], sum = 0u;
  for (uint k = 0u; k < 16u; k++) x[k] = v[(i + k) % 16u] | 1u;
  for (uint k = 0u; k < 16u; k++) sum += x[(k + i) % 16u] * x[k];
  v[i] = sum | 0x01010101u;
}
)";
  for (const std::uint32_t size : {8u, 64u}) {
    dispatch_words(kLeavesOnes, size, Lanes(64, ~0u), 1);
    const Lanes values{4, 4, 4, 4, 4};
    // Lanes 0, 1 and 2 ask lanes 7, 6 and 5; nobody is lane 6.
    EXPECT_EQ(dispatch_words(kSource, size, values, 1), (Lanes{0, 0, 0, 60, 60})) << size;
  }
}

TEST(Subgroups, ActiveLanesInLoopsAfterContinueBreakAndReturn) {
  for (const std::uint32_t size : {8u, 64u}) {
    const std::uint32_t local = 64;
    std::vector<std::uint32_t> values(local);
    for (std::uint32_t i = 0; i < local; i++) values[i] = input_of(i);
    const std::vector<std::uint32_t> got = dispatch_words(R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
void main() {
  uint i = gl_GlobalInvocationID.x, x = v[i], r = 0u;
  v[i] = 77u;
  if (x == 5u) return;
  for (uint k = 0u; k < 40u; k++) {
    if (k == x) break;
    if (((k + x) & 3u) == 0u) continue;
    r = r * 7u + subgroupAdd(1u) + subgroupBallotBitCount(subgroupBallot((x & 1u) == (k & 1u)));
  }
  v[i] = r + 1000u * subgroupAdd(1u);
})",
                                                          size, values, 1);
    for (std::uint32_t first = 0; first < local; first += size)
      for (std::uint32_t i = first; i < first + size; i++) {
        const auto in_loop = [&](std::uint32_t lane, std::uint32_t k) {
          const std::uint32_t x = values[lane];
          return x != 5 && k < x && ((k + x) & 3) != 0;
        };
        const auto alive = [&](std::uint32_t k, const std::function<bool(std::uint32_t)>& also) {
          std::uint32_t count = 0;
          for (std::uint32_t lane = first; lane < first + size; lane++) count += in_loop(lane, k) && also(values[lane]);
          return count;
        };
        std::uint32_t r = 0, returned = 0;
        for (std::uint32_t k = 0; k < 40 && k != values[i]; k++) {
          if (!in_loop(i, k)) continue;
          r = r * 7 + alive(k, [](std::uint32_t) { return true; }) +
              alive(k, [&](std::uint32_t x) { return (x & 1) == (k & 1); });
        }
        for (std::uint32_t lane = first; lane < first + size; lane++) returned += values[lane] != 5;
        ASSERT_EQ(got[i], values[i] == 5 ? 77u : r + 1000 * returned) << "size " << size << ", lane " << i;
      }
  }
}

/// A loop over the distinct values of a subgroup: every invocation gets its turn exactly once.
TEST(Subgroups, SerializationLoopEnds) {
  std::vector<std::uint32_t> values(64);
  for (std::uint32_t i = 0; i < 64; i++) values[i] = i % 5;
  const std::vector<std::uint32_t> got = dispatch_words(R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
void main() {
  uint i = gl_GlobalInvocationID.x, x = v[i], turns = 0u;
  for (;;) {
    turns++;
    if (subgroupBroadcastFirst(x) == x) break;
  }
  v[i] = turns;
})",
                                                        64, values, 1);
  for (std::uint32_t i = 0; i < 64; i++) EXPECT_EQ(got[i], i % 5 + 1);
}

}  // namespace
}  // namespace vitrine::spirv::test
