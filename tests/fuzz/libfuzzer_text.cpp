// What libFuzzer asks for beside the target (readers.cpp): the readers' seeds to begin with, and mutation that knows
// what readers look for.
#include <cstring>

#include "tests/fuzz/mutate_text.h"
#include "tests/fuzz/readers.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace vitrine::fuzz {
namespace {

std::size_t mutate_input(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  static const std::vector<std::string> seeds = reader_seeds();
  Random random(seed);
  if (size > 1 && random() % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  std::string input =
      size > 1 ? std::string(reinterpret_cast<const char*>(data), size) : seeds[below(random, seeds.size())];
  std::string text = input.substr(1);
  mutate_text(text, seeds, random);
  input.replace(1, std::string::npos, text);
  if (input.size() > most) return LLVMFuzzerMutate(data, size, most);
  std::memcpy(data, input.data(), input.size());
  return input.size();
}

}  // namespace
}  // namespace vitrine::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  return vitrine::fuzz::mutate_input(data, size, most, seed);
}
