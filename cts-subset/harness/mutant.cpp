// Mutates modules until one is valid.
#include "harness/mutant.h"

#include <spirv-tools/libspirv.hpp>
#include <spirv/unified1/spirv.hpp11>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "harness/random.h"
#include "tests/fuzz/mutate.h"

namespace vitrine::cts {
namespace {

bool is_valid(const std::vector<uint32_t>& words) {
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  spvtools::ValidatorOptions options;
  options.SetAllowLocalSizeId(true);
  options.SetScalarBlockLayout(true);
  options.SetWorkgroupScalarBlockLayout(true);
  return tools.Validate(words.data(), words.size(), options);
}

/// What a walk over a module's instructions keeps of its loops, whose blocks stand between header and merge block.
struct LoopWalk {
  std::vector<std::pair<uint32_t, uint32_t>> open;  ///< merge block and number of each loop around, outermost first
  std::unordered_map<uint32_t, uint32_t> loop_of;   ///< the innermost loop's number of each result in a loop
  std::vector<uint32_t> of_block;                   ///< results of the block so far
  uint32_t loops = 0;
  uint32_t reads_behind = 0;
};

bool is_around(const LoopWalk& walk, uint32_t loop) {
  for (const auto& [merge, number] : walk.open)
    if (number == loop) return true;
  return false;
}

spv_result_t visit(void* user, const spv_parsed_instruction_t* inst) {
  LoopWalk& walk = *static_cast<LoopWalk*>(user);
  const auto op = static_cast<spv::Op>(inst->opcode);
  if (op == spv::Op::OpLabel) {
    walk.of_block.clear();
    while (!walk.open.empty() && walk.open.back().first == inst->result_id) walk.open.pop_back();
  }
  for (uint16_t i = 0; op != spv::Op::OpPhi && i < inst->num_operands; i++) {
    const spv_parsed_operand_t& operand = inst->operands[i];
    if (operand.type != SPV_OPERAND_TYPE_ID) continue;
    const auto found = walk.loop_of.find(inst->words[operand.offset]);
    walk.reads_behind += found != walk.loop_of.end() && !is_around(walk, found->second);
  }
  if (op == spv::Op::OpLoopMerge) {
    walk.open.emplace_back(inst->words[1], ++walk.loops);
    for (const uint32_t result : walk.of_block) walk.loop_of[result] = walk.loops;
  } else if (inst->result_id != 0 && op != spv::Op::OpLabel && op != spv::Op::OpPhi) {
    walk.of_block.push_back(inst->result_id);
    if (!walk.open.empty()) walk.loop_of[inst->result_id] = walk.open.back().second;
  }
  return SPV_SUCCESS;
}

/// Which results have a literal zero as a component, and how many floats are divided by one.
struct ZeroWalk {
  std::unordered_set<uint32_t> zeros;
  uint32_t divisions = 0;
};

spv_result_t visit_division(void* user, const spv_parsed_instruction_t* inst) {
  ZeroWalk& walk = *static_cast<ZeroWalk*>(user);
  const auto is_zero = [&](uint16_t word) { return walk.zeros.count(inst->words[word]) != 0; };
  bool zero = false;
  switch (static_cast<spv::Op>(inst->opcode)) {
    case spv::Op::OpFDiv:
    case spv::Op::OpFRem:
    case spv::Op::OpFMod:
      walk.divisions += is_zero(4);
      break;
    case spv::Op::OpConstantNull:
      zero = true;
      break;
    case spv::Op::OpConstant:
      zero = (inst->words[inst->num_words - 1] & 0x7fffffffu) == 0;
      break;
    case spv::Op::OpConstantComposite:
    case spv::Op::OpCompositeConstruct:
    case spv::Op::OpVectorShuffle:
    case spv::Op::OpCompositeExtract:
    case spv::Op::OpCompositeInsert:
    case spv::Op::OpCopyObject:
    case spv::Op::OpFNegate:
    case spv::Op::OpSelect:
      for (uint16_t i = 2; i < inst->num_operands; i++)
        zero |= inst->operands[i].type == SPV_OPERAND_TYPE_ID && is_zero(inst->operands[i].offset);
      break;
    default:
      break;
  }
  if (zero) walk.zeros.insert(inst->result_id);
  return SPV_SUCCESS;
}

template <typename Walk>
Walk walked(const std::vector<uint32_t>& words, spv_parsed_instruction_fn_t visit_instruction) {
  static const spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_3);
  Walk walk;
  spvBinaryParse(context, &walk, words.data(), words.size(), nullptr, visit_instruction, nullptr);
  return walk;
}

/// What has no result in the reference to compare with.
struct Incomparable {
  uint32_t reads_behind;  ///< operands that read a value of a loop behind it (deviations.md, value-leaves-loop)
  uint32_t divisions;     ///< of floats by a literal zero, which the reference leaves to chance
};

Incomparable incomparable_in(const std::vector<uint32_t>& words) {
  return {walked<LoopWalk>(words, visit).reads_behind, walked<ZeroWalk>(words, visit_division).divisions};
}

}  // namespace

std::vector<uint32_t> mutant_of(const std::vector<uint32_t>& words, uint64_t seed) {
  const std::string_view bytes(reinterpret_cast<const char*>(words.data()), words.size() * 4);
  fuzz::Random random(hash_name(bytes, seed));
  if (!is_valid(words)) return words;
  const Incomparable original = incomparable_in(words);
  constexpr int kTries = 40;
  for (int i = 0; i < kTries; i++) {
    std::vector<uint32_t> mutant = words;
    fuzz::mutate_values(mutant, random);
    if (mutant == words || !is_valid(mutant)) continue;
    const Incomparable made = incomparable_in(mutant);
    if (made.reads_behind <= original.reads_behind && made.divisions <= original.divisions) return mutant;
  }
  return words;
}

std::string disassemble(const std::vector<uint32_t>& words) {
  std::string text;
  spvtools::SpirvTools(SPV_ENV_VULKAN_1_3).Disassemble(words, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER);
  return text;
}

}  // namespace vitrine::cts
