// What libFuzzer asks for beside LLVMFuzzerTestOneInput (module_fuzz.cpp): mutation that knows what a module is.
// Without a corpus it starts from the seeds.
#include <algorithm>
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

/// The size of what was written; 0: it is larger than `most`.
std::size_t write(std::uint8_t stage, const Words& words, std::uint8_t* data, std::size_t most) {
  const std::size_t size = 1 + words.size() * 4;
  if (size > most) return 0;
  data[0] = stage;
  std::memcpy(data + 1, words.data(), words.size() * 4);
  return size;
}

std::size_t mutate_input(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  static const std::vector<Module> seeds = compile_seeds();
  Random random(seed);
  if (size <= kHeaderBytes) {
    const Module& module = seeds[static_cast<std::size_t>(random() % seeds.size())];
    const std::size_t written = write(number_of(module.stage), module.words, data, most);
    return written == 0 ? LLVMFuzzerMutate(data, size, most) : written;
  }
  if (random() % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  Words words((size - 1) / 4);
  std::memcpy(words.data(), data + 1, words.size() * 4);
  mutate(words, random);
  const std::size_t written = write(data[0], words, data, most);
  return written == 0 ? LLVMFuzzerMutate(data, size, most) : written;
}

}  // namespace
}  // namespace vitrine::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  return vitrine::fuzz::mutate_input(data, size, most, seed);
}
