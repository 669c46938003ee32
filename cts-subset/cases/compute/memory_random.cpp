// Random shaders with memory: storage buffers, shared memory and barriers, atomics whose results do not depend on their
// order, and group operations among them, all in divergent control flow.
#include "cases/common/subgroup_pipeline.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kGroups = 3;
constexpr uint32_t kInputWords = 256;
constexpr uint32_t kOwnWords = 4;       ///< of `o`, per invocation
constexpr uint32_t kAccumulators = 28;  ///< four of each operation of accumulate()

constexpr char kHeader[] = R"(// target: vulkan1.1
#extension GL_KHR_shader_subgroup_basic : enable
#extension GL_KHR_shader_subgroup_vote : enable
#extension GL_KHR_shader_subgroup_ballot : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_KHR_shader_subgroup_quad : enable
)";

/// Writes statements on x (a random word), y (a small number), r (the running result), l (the local index).
class MemoryWriter {
 public:
  MemoryWriter(Random& random, uint32_t local_size) : random_(random), local_size_(std::to_string(local_size)) {}

  /// Statements in uniform control flow: what each invocation does alone, barriers, what it reads of the others.
  std::string phases() {
    std::string text;
    for (uint32_t n = 1 + random_.below(3); n > 0; n--) {
      if (random_.chance(0.25f)) {
        const std::string body = phase();
        text += "for (uint p = 0u; p < " + std::to_string(1 + random_.below(3)) + "u; p++) {\n" + body + "}\n";
      } else {
        text += phase();
      }
    }
    return text;
  }

 private:
  std::string number(uint32_t below) { return std::to_string(random_.below(below)) + "u"; }
  std::string any_index() { return "(" + random_.pick<std::string>({"x", "r", "y", "l", "x >> 9", "l + r"}) + ")"; }
  std::string other_slot() {
    const std::string by = number(64);
    return "(l * " + number(9) + " + " + by + ") % " + local_size_ + "u";
  }
  std::string own() { return "o[id * 4u + " + random_.pick<std::string>({number(4), "(y & 3u)", "(r & 3u)"}) + "]"; }
  std::string condition() {
    return random_.pick<std::string>({"(x & 1u) != 0u", "y < 8u", "(r & 4u) == 0u", "l % 3u != 1u", "y == 2u",
                                      "(s[l] & 2u) == 0u", "r > 0x60000000u", "l < 9u"});
  }

  std::string word(int depth = 2) {
    switch (random_.below(depth > 0 ? 12 : 4)) {
      case 0:
        return "x";
      case 1:
        return "r";
      case 2:
        return random_.pick<std::string>({"y", "l", "id", number(1000)});
      case 3:
        return "s[l]";
      case 4:
        return "a[" + any_index() + " & 255u]";
      case 5: {
        const std::string end = random_.pick<std::string>({" % 300u]", " & 0x7fffu]", "]"});  // robust access
        return "a[" + any_index() + end;
      }
      case 6: {
        const std::string component = random_.pick<std::string>({"x", "y", "w", "zy.y"});
        return "v[" + any_index() + " & 63u]." + component;
      }
      case 7:
        return own();
      case 8:
        return "q[l]." + random_.pick<std::string>({"x", "y"});
      case 9:
        return "u." + random_.pick<std::string>({"first", "row[1].z", "row[" + any_index() + " & 3u].y"});
      case 10: {
        const std::string right = word(depth - 1);
        const std::string op = random_.pick<std::string>({" + ", " ^ ", " * ", " & ", " | ", " - "});
        return "(" + word(depth - 1) + op + right + ")";
      }
      default: {
        const std::string no = word(depth - 1), yes = word(depth - 1);
        return "(" + condition() + " ? " + yes + " : " + no + ")";
      }
    }
  }

  /// Each accumulator belongs to one operation that commutes with itself, so that their order does not matter.
  std::string accumulate() {
    const bool shared = random_.chance(0.5f);
    const uint32_t kind = random_.below(7);
    const std::string at = std::to_string(kind * 4) + "u + (" + any_index() + " & 3u)]";
    const std::string target = (kind >= 5 ? (shared ? "wi[" : "ti[") : (shared ? "w[" : "t[")) +
                               (kind >= 5 ? std::to_string((kind - 5) * 4) + "u + (" + any_index() + " & 3u)]" : at);
    const char* names[] = {"Add", "Max", "Min", "Or", "Xor", "Min", "Max"};
    return "atomic" + std::string(names[kind]) + "(" + target + ", " + (kind >= 5 ? "int(" + word() + ")" : word()) +
           ");\n";
  }

  std::string group_operation() {
    const std::string operand = word(1), c = condition();
    return random_.pick<std::string>(
        {"subgroupAdd(" + operand + ")", "subgroupExclusiveAdd(" + operand + ")",
         "subgroupInclusiveMax(" + operand + ")", "subgroupMin(" + operand + ")",
         "subgroupInclusiveXor(" + operand + ")", "uint(subgroupExclusiveMin(int(" + operand + ")))",
         "subgroupMul(" + operand + " | 1u)", "subgroupBallot(" + c + ").x", "subgroupBroadcastFirst(" + operand + ")",
         "subgroupBallotExclusiveBitCount(subgroupBallot(" + c + "))", "(subgroupAllEqual(" + operand + ") ? 9u : 4u)",
         "(subgroupAll(" + c + ") ? 1u : 0u)", "(subgroupAny(" + c + ") ? 7u : 2u)", "(subgroupElect() ? 3u : 1u)",
         "floatBitsToUint(subgroupAdd(float(" + operand + " & 1023u) * 0.37))", "subgroupAnd(" + operand + ")",
         "subgroupOr(" + operand + " & 0xffu)"});
  }

  std::string assignment() {
    switch (random_.below(10)) {
      case 0: {
        const std::string value = word();
        return own() + " = " + value + ";\n";
      }
      case 1:
        return "s[l] = " + word() + ";\n";
      case 2:
        return random_.pick<std::string>(
            {"q[l].x = " + word() + ";\n", "q[l] = q[l].yx + uvec2(" + word() + ", r);\n"});
      case 3: {
        const std::string value = word();
        return "r ^= atomicExchange(" + random_.pick<std::string>({own(), "s[l]"}) + ", " + value + ");\n";
      }
      case 4: {
        const std::string value = word(), compared = random_.pick<std::string>({"r", "s[l]", "y"});
        return "r += atomicCompSwap(" + random_.pick<std::string>({own(), "s[l]"}) + ", " + compared + ", " + value +
               ");\n";
      }
      case 5: {
        const std::string value = word();
        return "r = r * 3u + atomicAdd(" + random_.pick<std::string>({own(), "s[l]"}) + ", " + value + ");\n";
      }
      case 6:
      case 7:
        return accumulate();
      case 8:
        return "r = r * 5u + " + group_operation() + ";\n";
      default:
        return "r = " + word() + " ^ r * 7u;\n";
    }
  }

  std::string block(int depth) {
    std::string text;
    for (uint32_t n = 1 + random_.below(3); n > 0; n--) text += statement(depth);
    return text;
  }

  std::string statement(int depth) {
    switch (depth > 0 ? random_.below(7) : 0) {
      case 1: {
        const std::string then = block(depth - 1);
        return "if (" + condition() + ") {\n" + then + "}\n";
      }
      case 2: {
        const std::string otherwise = block(depth - 1), then = block(depth - 1);
        return "if (" + condition() + ") {\n" + then + "} else {\n" + otherwise + "}\n";
      }
      case 3: {
        const std::string k = "k" + std::to_string(next_name_++);
        std::string leave;
        if (random_.chance(0.5f)) {
          const std::string jump = random_.pick<std::string>({"break", "continue"});
          leave = "if (" + condition() + ") " + jump + ";\n";
        }
        const std::string body = block(depth - 1);
        return "for (uint " + k + " = 0u; " + k + " < (" + random_.pick<std::string>({"y", "x", "l"}) +
               " & 3u) + 1u; " + k + "++) {\n" + body + leave + "r += 3u;\n}\n";
      }
      case 4: {
        const std::string last = block(depth - 1), second = block(depth - 1);
        const std::string end = random_.pick<std::string>({"break;\n", ""}), first = block(depth - 1);
        return "switch (" + random_.pick<std::string>({"y", "r", "x"}) + " & 3u) {\ncase 0u:\n" + first + end +
               "case 2u:\n" + second + "break;\ndefault:\n" + last + "}\n";
      }
      default:
        return assignment();
    }
  }

  std::string phase() {
    const std::string slot = other_slot();
    std::string text = block(3) + "barrier();\nr = r * 5u + s[" + slot + "]";
    if (random_.chance(0.5f)) text += " + q[" + other_slot() + "].y";
    if (random_.chance(0.5f)) {
      const std::string sum = number(8);
      text += " + w[" + number(20) + "] + uint(wi[" + sum + "])";
    }
    return text + ";\nbarrier();\n";
  }

  Random& random_;
  std::string local_size_;
  int next_name_ = 0;
};

std::string shader_text(Random& random, uint32_t local_size) {
  const std::string n = std::to_string(local_size);
  MemoryWriter writer(random, local_size);
  return std::string(kHeader) + "layout(local_size_x = " + n + ") in;\n" +
         R"(layout(std430, binding = 0) readonly buffer A { uint a[]; };
layout(std430, binding = 1) readonly buffer V { uvec4 v[]; };
layout(std140, binding = 2) uniform U { uint first; uvec3 row[4]; } u;
layout(std430, binding = 3) buffer O { uint o[]; };
layout(std430, binding = 4) buffer T { uint t[28]; int ti[8]; uint groups[]; };
shared uint s[)" +
         n + "];\nshared uvec2 q[" + n + R"(];
shared uint w[28];
shared int wi[8];
void main() {
  uint id = gl_GlobalInvocationID.x, l = gl_LocalInvocationIndex;
  uint x = a[id & 255u], y = x >> 28, r = 0u;
  s[l] = x * 3u;
  q[l] = uvec2(y, x ^ l);
  for (uint k = l; k < 28u; k += gl_WorkGroupSize.x) w[k] = a[k];
  for (uint k = l; k < 8u; k += gl_WorkGroupSize.x) wi[k] = int(a[k + 30u]);
  barrier();
)" + writer.phases() +
         R"(  o[id * 4u] += r;
  for (uint k = l; k < 36u; k += gl_WorkGroupSize.x)
    groups[gl_WorkGroupID.x * 36u + k] = k < 28u ? w[k] : uint(wi[k - 28u]);
}
)";
}

CTS_RANDOM("compute", "random_memory", 60) {
  Random& random = run.random;
  const uint32_t local_size = random.pick({8u, 5u, 40u, 64u, 100u, 128u});
  const auto words = [&](size_t count) {
    std::vector<uint32_t> result(count);
    for (uint32_t& word : result) word = random.bits();
    return result;
  };
  const Buffer a = run.buffer_of(words(kInputWords)), v = run.buffer_of(words(kInputWords));
  const Buffer u = run.buffer_of(words(20));
  const Buffer o = run.buffer_of(words(size_t{kGroups} * local_size * kOwnWords));
  const Buffer t = run.buffer_of(words(kAccumulators + 8 + kGroups * 36));
  const std::string code = shader_text(random, local_size);
  run.note("shader", code);
  const Resources res = run.resources(
      {storage_buffer(0, a), storage_buffer(1, v), uniform_buffer(2, u), storage_buffer(3, o), storage_buffer(4, t)});
  const VkPipeline pipeline = subgroup_pipeline(run, res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, kGroups);
  run.out("own words", o);
  run.out("accumulators", t);
}

}  // namespace
}  // namespace vitrine::cts
