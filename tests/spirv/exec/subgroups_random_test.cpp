// Group operations that the reference does not have (clusters, relative shuffles, quads, rotations) in random divergent
// control flow: each result equals what the same invocations compute from shuffles and ballots alone.
#include <random>
#include <string>
#include <vector>

#include "tests/spirv/buffers.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kGroups = 2;

constexpr char kFunctions[] = R"(
#extension GL_KHR_shader_subgroup_basic : enable
#extension GL_KHR_shader_subgroup_vote : enable
#extension GL_KHR_shader_subgroup_ballot : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_KHR_shader_subgroup_shuffle_relative : enable
#extension GL_KHR_shader_subgroup_clustered : enable
#extension GL_KHR_shader_subgroup_quad : enable
#extension GL_EXT_spirv_intrinsics : enable
layout(set = 0, binding = 0) buffer B { uint v[]; };
spirv_instruction(extensions = ["SPV_KHR_subgroup_rotate"], capabilities = [6026], id = 4431)
uint rotate(uint scope, uint x, uint distance);
spirv_instruction(extensions = ["SPV_KHR_subgroup_rotate"], capabilities = [6026], id = 4431)
uint rotate_in_cluster(uint scope, uint x, uint distance, uint size);
bool live(uint lane) { return lane < gl_SubgroupSize && subgroupBallotBitExtract(subgroupBallot(true), lane & 127u); }
uint combine(uint kind, uint a, uint b) {
  switch (kind) {
    case 0u: return a + b;
    case 1u: return a * b;
    case 2u: return min(a, b);
    case 3u: return max(a, b);
    case 4u: return a & b;
    case 5u: return a | b;
    default: return a ^ b;
  }
}
uint start(uint kind) { return kind == 1u ? 1u : kind == 2u || kind == 4u ? ~0u : 0u; }
// Over the invocations first .. end - 1.
uint fold(uint kind, uint x, uint first, uint end) {
  uint result = start(kind);
  for (uint k = 0u; k < gl_SubgroupSize; k++) {
    bool there = live(k);
    uint other = subgroupShuffle(x, k);
    if (there && k >= first && k < end) result = combine(kind, result, other);
  }
  return result;
}
uint cluster(uint kind, uint x, uint size) {
  uint first = gl_SubgroupInvocationID & ~(size - 1u);
  return fold(kind, x, first, first + size);
}
uint bits(uvec4 ballot, uint first, uint end) {
  uint count = 0u;
  for (uint k = first; k < end; k++) count += ballot[k >> 5] >> (k & 31u) & 1u;
  return count;
}
// What comes from an invocation that does not take part is undefined.
uint only(uint lane, uint value) { return live(lane) ? value : 77u; }
)";

class Writer {
 public:
  explicit Writer(std::uint32_t seed) : random_(seed) {}

  std::string block(int depth) {
    std::string text;
    for (std::uint32_t n = 1 + below(3); n > 0; n--) text += statement(depth);
    return text;
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  std::string pick(std::initializer_list<const char*> all) {
    return all.begin()[below(static_cast<std::uint32_t>(all.size()))];
  }
  std::string condition() {
    return pick({"(x & 1u) != 0u", "(x & 12u) == 4u", "y < 9u", "l % 3u != 1u", "(r & 16u) == 0u", "y == 2u",
                 "subgroupElect()", "l > 20u"});
  }

  /// The operation on `operand`, and the same from shuffles.
  std::pair<std::string, std::string> operation() {
    constexpr const char* kKinds[] = {"Add", "Mul", "Min", "Max", "And", "Or", "Xor"};
    const std::string operand = pick({"x", "(x ^ r)", "(y + 3u)", "(r | 1u)"}), lane = "gl_SubgroupInvocationID";
    const std::uint32_t which = below(7);
    const std::string kind = kKinds[which], number = std::to_string(which) + "u";
    const std::string distance = std::to_string(1 + below(7)) + "u", size = std::to_string(1u << below(4)) + "u";
    switch (below(14)) {
      case 0:
      case 1:
      case 2:
        return {"subgroupClustered" + kind + "(" + operand + ", " + size + ")",
                "cluster(" + number + ", " + operand + ", " + size + ")"};
      case 3:
        return {"subgroupInclusive" + kind + "(" + operand + ")",
                "fold(" + number + ", " + operand + ", 0u, " + lane + " + 1u)"};
      case 4:
        return {"subgroupExclusive" + kind + "(" + operand + ")",
                "fold(" + number + ", " + operand + ", 0u, " + lane + ")"};
      case 5:
        return {"subgroup" + kind + "(" + operand + ")", "fold(" + number + ", " + operand + ", 0u, 64u)"};
      case 6:
        return {
            "only(" + lane + " - " + distance + ", subgroupShuffleUp(" + operand + ", " + distance + "))",
            "only(" + lane + " - " + distance + ", subgroupShuffle(" + operand + ", " + lane + " - " + distance + "))"};
      case 7:
        return {
            "only(" + lane + " + " + distance + ", subgroupShuffleDown(" + operand + ", " + distance + "))",
            "only(" + lane + " + " + distance + ", subgroupShuffle(" + operand + ", " + lane + " + " + distance + "))"};
      case 8:
        return {
            "only(" + lane + " ^ " + distance + ", subgroupShuffleXor(" + operand + ", " + distance + "))",
            "only(" + lane + " ^ " + distance + ", subgroupShuffle(" + operand + ", " + lane + " ^ " + distance + "))"};
      case 9: {
        const std::uint32_t swap = below(3);
        const std::string name = swap == 0 ? "Horizontal" : swap == 1 ? "Vertical" : "Diagonal";
        const std::string source = lane + " ^ " + std::to_string(swap + 1) + "u";
        return {"only(" + source + ", subgroupQuadSwap" + name + "(" + operand + "))",
                "only(" + source + ", subgroupShuffle(" + operand + ", " + source + "))"};
      }
      case 10: {
        const std::string index = std::to_string(below(4)) + "u", source = "(" + lane + " & ~3u) + " + index;
        return {"only(" + source + ", subgroupQuadBroadcast(" + operand + ", " + index + "))",
                "only(" + source + ", subgroupShuffle(" + operand + ", " + source + "))"};
      }
      case 11:
        return rotation("3u, " + operand + ", " + distance, "rotate", "gl_SubgroupSize", operand, distance);
      case 12:
        return rotation("3u, " + operand + ", " + distance + ", " + size, "rotate_in_cluster", size, operand, distance);
      default: {
        const std::string ballot = "subgroupBallot((" + operand + " & 4u) != 0u)";
        return {"subgroupBallotInclusiveBitCount(" + ballot + ") * 64u + subgroupBallotExclusiveBitCount(" + ballot +
                    ") + subgroupBroadcastFirst(" + operand + ")",
                "bits(" + ballot + ", 0u, " + lane + " + 1u) * 64u + bits(" + ballot + ", 0u, " + lane +
                    ") + subgroupShuffle(" + operand + ", subgroupBallotFindLSB(subgroupBallot(true)))"};
      }
    }
  }

  static std::pair<std::string, std::string> rotation(const std::string& arguments, const std::string& function,
                                                      const std::string& size, const std::string& operand,
                                                      const std::string& distance) {
    const std::string lane = "gl_SubgroupInvocationID", inside = "(" + size + " - 1u)";
    const std::string source = "(" + lane + " & ~" + inside + " | (" + lane + " + " + distance + ") & " + inside + ")";
    return {"only(" + source + ", " + function + "(" + arguments + "))",
            "only(" + source + ", subgroupShuffle(" + operand + ", " + source + "))"};
  }

  std::string statement(int depth) {
    switch (depth > 0 ? below(6) : 5) {
      case 0:
        return "if (" + condition() + ") {\n" + block(depth - 1) + "}\n";
      case 1:
        return "if (" + condition() + ") {\n" + block(depth - 1) + "} else {\n" + block(depth - 1) + "}\n";
      case 2: {
        const std::string k = std::string("k").append(std::to_string(next_++));
        return "for (uint " + k + " = 0u; " + k + " < (y & 3u) + 1u; " + k + "++) {\n" + block(depth - 1) + "if (" +
               condition() + ") " + pick({"break", "continue"}) + ";\nr += 3u;\n}\n";
      }
      case 3:
        return "switch (y & 3u) {\ncase 0u:\n" + block(depth - 1) + pick({"break;\n", ""}) + "case 1u:\n" +
               block(depth - 1) + "break;\ndefault:\n" + block(depth - 1) + "}\n";
      default: {
        const auto [given, model] = operation();
        return "{ uint a = " + given + ", b = " + model + "; if (a != b) wrong++; r = r * 5u + b; }\n";
      }
    }
  }

  std::mt19937 random_;
  int next_ = 0;
};

/// Invocations whose results were wrong.
std::uint32_t count_wrong(const std::string& text, std::uint32_t size, std::uint32_t local_size, std::uint32_t seed) {
  CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
  options.subgroup_size = size;
  std::mt19937 random(seed);
  std::vector<std::uint32_t> values(std::size_t{kGroups} * local_size);
  for (std::uint32_t& value : values) value = static_cast<std::uint32_t>(random());
  if (!dispatch_over(values, compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, text), options, kGroups)) {
    ADD_FAILURE() << text;
    return ~0u;
  }
  std::uint32_t wrong = 0;
  for (const std::uint32_t value : values) wrong += value != 0;
  return wrong;
}

TEST(SubgroupsRandom, EqualWhatShufflesGive) {
  constexpr std::uint32_t kShaders = 16;
  for (std::uint32_t seed = 1; seed <= kShaders; seed++) {
    Writer writer(seed);
    const std::string body = writer.block(3);
    const std::uint32_t local_size = std::vector<std::uint32_t>{8, 13, 64, 100}[seed % 4];
    const std::string text = std::string(kFunctions) + "layout(local_size_x = " + std::to_string(local_size) +
                             ") in;\nvoid main() {\n  uint l = gl_LocalInvocationIndex, x = "
                             "v[gl_GlobalInvocationID.x], y = x >> 28, r = 0u, wrong = 0u;\n" +
                             body + "  v[gl_GlobalInvocationID.x] = wrong;\n}\n";
    for (const std::uint32_t size : {8u << seed % 3, 64u})
      ASSERT_EQ(count_wrong(text, size, local_size, seed), 0u) << "seed " << seed << ", size " << size << "\n" << text;
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
