// Group operations. Both devices run with subgroups of 8 invocations, the reference's size (subgroup size control), so
// that sizes, masks and the order of sums compare.
#include <algorithm>
#include <cstring>

#include "cases/common/subgroup_pipeline.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kSize = kSubgroupSize;

constexpr char kHeader[] = R"(// target: vulkan1.1
#extension GL_KHR_shader_subgroup_basic : enable
#extension GL_KHR_shader_subgroup_vote : enable
#extension GL_KHR_shader_subgroup_ballot : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_KHR_shader_subgroup_shuffle_relative : enable
#extension GL_KHR_shader_subgroup_quad : enable
)";

/// Runs statements on r (uint, 0 at first), x (a random word), y (a small number) and f (a float in 0..1).
void run_statements(Run& run, const std::string& statements, uint32_t local_size, const char* extensions = kHeader) {
  const std::string code = std::string(extensions) + "layout(local_size_x = " + std::to_string(local_size) +
                           ") in;\n"
                           "layout(std430, binding = 0) buffer A { uint a[]; };\n"
                           "layout(std430, binding = 1) buffer R { uint o[]; };\n"
                           "void main() {\n"
                           "  uint x = a[gl_GlobalInvocationID.x], y = x >> 28, r = 0u;\n"
                           "  float f = float(x >> 8) / 16777216.0;\n" +
                           statements + "  o[gl_GlobalInvocationID.x] = r + (y << 24);\n}\n";
  run.note("shader", code);
  constexpr uint32_t kGroups = 4;
  std::vector<uint32_t> words(local_size * kGroups);
  for (uint32_t& word : words) word = run.random.bits();
  const Buffer in = run.buffer_of(words), out = run.buffer(in.size);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = subgroup_pipeline(run, res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, kGroups);
  run.out("result", out);
}

void add(const std::string& name, const std::string& expression) {
  AddCase("subgroups", name, [=](Run& run) { run_statements(run, "  r = " + expression + ";\n", 40); });
  AddCase("subgroups", name + ".divergent",
          [=](Run& run) { run_statements(run, "  if (y != 3u && y > 1u) r = " + expression + ";\n", 40); });
}

const bool kOperations = [] {
  for (const char* op : {"Add", "Mul", "Min", "Max"})
    for (const char* mode : {"", "Inclusive", "Exclusive"}) {
      const std::string call = std::string("subgroup") + mode + op;
      add("arithmetic.uint." + call, call + "(x)");
      add("arithmetic.int." + call, "uint(" + call + "(int(x)))");
      add("arithmetic.float." + call, "floatBitsToUint(" + call + "(f))");
      add("arithmetic.vec2." + call, "floatBitsToUint(" + call + "(vec2(f, f * 3.0)).y)");
    }
  for (const char* op : {"And", "Or", "Xor"})
    for (const char* mode : {"", "Inclusive", "Exclusive"}) {
      const std::string call = std::string("subgroup") + mode + op;
      add("arithmetic.uint." + call, call + "(x)");
    }
  add("basic.elect", "subgroupElect() ? x : 1u");
  add("basic.sizes", "gl_SubgroupSize + gl_NumSubgroups * 100u + gl_SubgroupID * 10000u + gl_SubgroupInvocationID");
  for (const char* mask : {"Eq", "Ge", "Gt", "Le", "Lt"})
    add(std::string("ballot.mask_") + mask, std::string("gl_Subgroup") + mask + "Mask.x");
  add("vote.any", "subgroupAny(y == 5u) ? 1u : 2u");
  add("vote.all", "subgroupAll(y > 2u) ? 1u : 2u");
  add("vote.all_equal", "subgroupAllEqual(y >> 3) ? 1u : 2u");
  add("vote.all_equal_float", "subgroupAllEqual(float(y >> 3)) ? 1u : 2u");
  add("vote.all_equal_nan", "subgroupAllEqual(uintBitsToFloat(0x7fc00000u + (y & 1u))) ? 1u : 2u");
  add("ballot.ballot", "subgroupBallot(y < 7u).x");
  add("ballot.bit_count", "subgroupBallotBitCount(subgroupBallot(y < 7u))");
  add("ballot.inclusive_bit_count", "subgroupBallotInclusiveBitCount(subgroupBallot(y < 7u))");
  add("ballot.exclusive_bit_count", "subgroupBallotExclusiveBitCount(subgroupBallot(y < 7u))");
  add("ballot.find_lsb", "subgroupBallotFindLSB(subgroupBallot(true))");
  add("ballot.find_msb", "subgroupBallotFindMSB(subgroupBallot(true))");
  add("ballot.inverse", "subgroupInverseBallot(uvec4(0x35u, 0u, 0u, 0u)) ? x : 1u");
  add("ballot.bit_extract", "subgroupBallotBitExtract(uvec4(0x35u, 0u, 0u, 0u), y & 7u) ? x : 1u");
  add("ballot.broadcast_first", "subgroupBroadcastFirst(x)");
  return true;
}();

/// The types beyond 32 bits that the device has.
void extended_types(Run& run, const char* extensions, const std::string& statements, bool wide = true) {
  run.require(run.gpu.extension_features.shaderSubgroupExtendedTypes, "shaderSubgroupExtendedTypes");
  run.require(!wide || (run.gpu.features.shaderInt64 && run.gpu.features.shaderFloat64),
              "shaderInt64 and shaderFloat64");
  run_statements(run, statements, 40, (std::string(kHeader) + extensions).c_str());
}
CTS_CASE("subgroups", "extended_types.int64") {
  extended_types(run,
                 "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n"
                 "#extension GL_EXT_shader_subgroup_extended_types_int64 : require\n",
                 "  uint64_t w = packUint2x32(uvec2(x, x * 77u + y));\n"
                 "  int64_t v = int64_t(w);\n"
                 "  w = subgroupAdd(w) ^ subgroupInclusiveMul(w | 1ul) ^ subgroupExclusiveMax(w) ^\n"
                 "      uint64_t(subgroupMin(v)) ^ subgroupShuffleXor(w, 3u) ^ subgroupBroadcastFirst(w) ^\n"
                 "      subgroupXor(w) ^ subgroupQuadSwapHorizontal(w);\n"
                 "  uvec2 both = unpackUint2x32(w);\n"
                 "  r = both.x ^ both.y ^ (subgroupAllEqual(w) ? 1u : 0u);\n");
}
CTS_CASE("subgroups", "extended_types.double") {
  extended_types(run, "",
                 "  double d = double(f) * 3.0lf - 1.0lf;\n"
                 "  dvec2 e = subgroupInclusiveAdd(dvec2(d, d * 0.5lf)) + subgroupMax(d) * subgroupShuffle(d, 5u);\n"
                 "  uvec2 first = unpackDouble2x32(e.x), second = unpackDouble2x32(e.y);\n"
                 "  r = first.x ^ first.y * 3u ^ second.x * 5u ^ second.y * 7u;\n");
}

CTS_CASE("subgroups", "extended_types.small") {
  run.require(run.gpu.extension_features.shaderFloat16 && run.gpu.features.shaderInt16,
              "shaderFloat16 and shaderInt16");
  extended_types(run,
                 "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
                 "#extension GL_EXT_shader_subgroup_extended_types_float16 : require\n"
                 "#extension GL_EXT_shader_subgroup_extended_types_int16 : require\n",
                 "  float16_t h = float16_t(f) + float16_t(0.25);\n"
                 "  uint16_t s = uint16_t(x);\n"
                 "  f16vec2 sum = f16vec2(subgroupAdd(h), subgroupInclusiveMul(h));\n"
                 "  sum += f16vec2(subgroupMin(h), subgroupShuffleXor(h, 3u));\n"
                 "  s = subgroupAdd(s) ^ subgroupExclusiveMax(s) ^ subgroupShuffle(s, 2u);\n"
                 "  r = packFloat2x16(sum) ^ uint(s) * 77u;\n",
                 false);
}

CTS_CASE("subgroups", "ballot.broadcast") {
  run_statements(run, "  r = subgroupBroadcast(x, 5u) + floatBitsToUint(subgroupBroadcast(f, 2u));\n", 40);
}
CTS_CASE("subgroups", "shuffle.any") { run_statements(run, "  r = subgroupShuffle(x, y & 7u);\n", 40); }
CTS_CASE("subgroups", "shuffle.xor") { run_statements(run, "  r = subgroupShuffleXor(x, 3u);\n", 40); }
CTS_CASE("subgroups", "shuffle.up_and_down") {
  run_statements(run,
                 "  uint up = subgroupShuffleUp(x, 2u), down = subgroupShuffleDown(x, 3u);\n"
                 "  r = (gl_SubgroupInvocationID >= 2u ? up : 0u) ^ (gl_SubgroupInvocationID < 5u ? down : 0u);\n",
                 40);
}
CTS_CASE("subgroups", "quad.all") {
  run_statements(run,
                 "  r = subgroupQuadSwapHorizontal(x) * 3u + subgroupQuadSwapVertical(x) * 5u +\n"
                 "      subgroupQuadSwapDiagonal(x) * 7u + subgroupQuadBroadcast(x, 2u) * 11u;\n",
                 40);
}

CTS_CASE("subgroups", "loops") {
  run_statements(run,
                 "  for (uint k = 0u; k < 12u; k++) {\n"
                 "    if (k == y) break;\n"
                 "    if (((k + y) & 3u) == 0u) continue;\n"
                 "    r = r * 7u + subgroupAdd(x >> k) + subgroupBallot((y & 1u) == (k & 1u)).x;\n"
                 "  }\n"
                 "  r += subgroupBroadcastFirst(r);\n",
                 40);
}

CTS_CASE("subgroups", "serialization_loop") {
  run_statements(run,
                 "  for (;;) {\n"
                 "    uint first = subgroupBroadcastFirst(y);\n"
                 "    r++;\n"
                 "    if (first == y) break;\n"
                 "  }\n",
                 40);
}

/// The turn in which an invocation leaves, and 100 times the sum of y over those that leave with it.
std::string check_group_values_leave(const std::vector<Output>& device, const std::vector<Output>& reference) {
  const auto words = [](const Output& output) {
    std::vector<uint32_t> result(output.bytes.size() / 4);
    std::memcpy(result.data(), output.bytes.data(), output.bytes.size());
    return result;
  };
  const std::vector<uint32_t> ours = words(device.at(0));
  for (size_t first = 0; first < ours.size(); first += kSize) {
    std::vector<uint32_t> seen;
    for (size_t i = first; i < first + kSize; i++) {
      const uint32_t y = ours[i] >> 24;
      if (std::find(seen.begin(), seen.end(), y) == seen.end()) seen.push_back(y);
      const auto turn = static_cast<uint32_t>(std::find(seen.begin(), seen.end(), y) - seen.begin()) + 1;
      uint32_t together = 0;
      for (size_t k = first; k < first + kSize; k++) together += ours[k] >> 24 == y;
      if ((ours[i] & 0xffffff) != turn + 100 * y * together) return "element " + std::to_string(i) + " is wrong";
    }
  }
  return ours == words(reference.at(0)) ? "the reference is right" : "";
}

[[maybe_unused]] const AddCase kLeaving("subgroups", "deviation.group_value_leaves_loop", "group-value-leaves-loop",
                                        check_group_values_leave, [](Run& run) {
                                          run_statements(run,
                                                         "  for (;;) {\n"
                                                         "    uint first = subgroupBroadcastFirst(y);\n"
                                                         "    r++;\n"
                                                         "    if (first == y) {\n"
                                                         "      r += subgroupAdd(y) * 100u;\n"
                                                         "      break;\n"
                                                         "    }\n"
                                                         "  }\n",
                                                         40);
                                        });

CTS_CASE("subgroups", "older_extensions") {
  run.require(run.gpu.features.shaderInt64, "shaderInt64");  // the type of a ballot in GLSL
  run.require(run.gpu.has("VK_EXT_shader_subgroup_ballot") && run.gpu.has("VK_EXT_shader_subgroup_vote"),
              "VK_EXT_shader_subgroup_ballot, VK_EXT_shader_subgroup_vote");
  run_statements(run,
                 "  uvec2 b = unpackUint2x32(ballotARB(y < 7u));\n"
                 "  r = b.x + readFirstInvocationARB(x) + readInvocationARB(x, 3u);\n"
                 "  if (anyInvocationARB(y == 5u)) r += 100u;\n"
                 "  if (allInvocationsARB(y > 1u)) r += 1000u;\n"
                 "  if (allInvocationsEqualARB(y > 0u)) r += 10000u;\n",
                 40,
                 "// target: vulkan1.1\n#extension GL_ARB_shader_ballot : enable\n#extension "
                 "GL_ARB_shader_group_vote : enable\n#extension GL_ARB_gpu_shader_int64 : enable\n");
}

/// Random statements in which invocations part and meet again.
std::string random_block(Random& random, int depth) {
  std::string text;
  const uint32_t count = 1 + random.below(3);
  for (uint32_t i = 0; i < count; i++) {
    const std::string condition = random.pick({"(x & 1u) != 0u", "y < 8u", "(r & 4u) == 0u", "f > 0.3", "y == 2u",
                                               "subgroupAny(y > 13u)", "subgroupElect()"});
    const uint32_t kind = depth > 0 ? random.below(5) : 0;
    if (kind == 1) {
      const std::string otherwise = random_block(random, depth - 1);
      text += "if (" + condition + ") {\n" + random_block(random, depth - 1) + "} else {\n" + otherwise + "}\n";
    } else if (kind == 2) {
      const std::string k = "k" + std::to_string(depth);
      const std::string jump = random.pick({"break", "continue"});
      text += "for (uint " + k + " = 0u; " + k + " < (y & 3u) + 1u; " + k + "++) {\n" +
              random_block(random, depth - 1) + "if (" + condition + ") " + jump + ";\nr += 3u;\n}\n";
    } else {
      const std::string operand = random.pick({"x", "r", "y", "(x ^ r)"});
      text +=
          "r = r * 5u + " +
          random.pick({"subgroupAdd(" + operand + ")", "subgroupExclusiveAdd(" + operand + ")",
                       "subgroupInclusiveMax(" + operand + ")", "subgroupMin(" + operand + ")",
                       "subgroupBallot(" + condition + ").x", "subgroupBroadcastFirst(" + operand + ")",
                       "subgroupBallotExclusiveBitCount(subgroupBallot(" + condition + "))",
                       "(subgroupAllEqual(" + operand + ") ? 9u : 4u)", "(subgroupAll(" + condition + ") ? 1u : 0u)",
                       "floatBitsToUint(subgroupAdd(float(" + operand + " & 1023u) * 0.37))",
                       "subgroupXor(" + operand + ")"}) +
          ";\n";
    }
  }
  return text;
}

CTS_RANDOM("subgroups", "random", 40) {
  const uint32_t size = run.random.pick({8u, 5u, 40u, 64u});
  run_statements(run, random_block(run.random, 3), size);
}

/// Quads of fragments, helpers at the edges included, as derivatives see them.
CTS_CASE("subgroups", "quad.fragment") {
  run.require(run.gpu.extension_features.subgroupSizeControl, "subgroupSizeControl");
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_SFLOAT}});
  GraphicsSpec spec;
  spec.vertex =
      "layout(location = 0) out vec2 uv;\n"
      "void main() { uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 3.0 - 1.0;\n"
      "  gl_Position = vec4(uv * 0.7, 0.0, 1.0); }\n";
  spec.fragment =
      std::string(kHeader) +
      "layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 o;\n"
      "void main() {\n"
      "  float v = sin(uv.x * 9.0) + uv.y;\n"
      "  o = vec4(subgroupQuadSwapHorizontal(v), subgroupQuadSwapVertical(v), subgroupQuadSwapDiagonal(v),\n"
      "           subgroupQuadBroadcast(v, 1u));\n"
      "}\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
