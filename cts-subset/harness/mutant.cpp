// Mutates modules until one is valid.
#include "harness/mutant.h"

#include <spirv-tools/libspirv.hpp>

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

}  // namespace

std::vector<uint32_t> mutant_of(const std::vector<uint32_t>& words, uint64_t seed) {
  const std::string_view bytes(reinterpret_cast<const char*>(words.data()), words.size() * 4);
  fuzz::Random random(hash_name(bytes, seed));
  if (!is_valid(words)) return words;
  constexpr int kTries = 40;
  for (int i = 0; i < kTries; i++) {
    std::vector<uint32_t> mutant = words;
    fuzz::mutate_values(mutant, random);
    if (mutant != words && is_valid(mutant)) return mutant;
  }
  return words;
}

std::string disassemble(const std::vector<uint32_t>& words) {
  std::string text;
  spvtools::SpirvTools(SPV_ENV_VULKAN_1_3).Disassemble(words, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER);
  return text;
}

}  // namespace vitrine::cts
