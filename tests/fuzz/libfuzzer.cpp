// What libFuzzer asks for beside the target (module_fuzz.cpp): mutation that knows what a module is.
// Without a corpus it starts from the seeds.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/fuzz/module_fuzz.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/seeds.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace vitrine::fuzz {
namespace {

constexpr std::size_t kHeaderBytes = 20;

std::size_t mutate_input(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  static const std::vector<Module> seeds = compile_seeds();
  Random random(seed);
  std::uint8_t stage;
  Words words;
  if (size <= kHeaderBytes) {
    const Module& module = seeds[static_cast<std::size_t>(random() % seeds.size())];
    stage = number_of(module.stage);
    words = module.words;
  } else {
    if (random() % 4 == 0) return LLVMFuzzerMutate(data, size, most);
    stage = data[0];
    words = words_of({data, size});
    mutate(words, random);
  }
  const std::size_t made = 1 + words.size() * 4;
  if (made > most) return LLVMFuzzerMutate(data, size, most);
  data[0] = stage;
  std::memcpy(data + 1, words.data(), words.size() * 4);
  return made;
}

}  // namespace
}  // namespace vitrine::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  return vitrine::fuzz::mutate_input(data, size, most, seed);
}
