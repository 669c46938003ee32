// Time per lane and operation of the executor's inner shape, by wave width and SIMD target: instructions of 32 bytes
// that name registers of W lanes, each run by an indirect call whose handler loops over the lanes. Only the width
// changes. usage: vitrine_wave_width
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/waves/wave_width.cpp"
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef VITRINE_WAVE_WIDTH_COMMON
#define VITRINE_WAVE_WIDTH_COMMON
namespace vitrine::waves {

struct Machine;
struct Instruction;
using Handler = const Instruction* (*)(Machine&, const Instruction*);

struct Instruction {
  Handler handler;
  std::uint32_t dst, src[3], extra[2];
};

struct Machine {
  std::byte* registers;
};

/// A program that looks like a shader: mostly multiply-adds and multiplications over a live set of this many registers.
constexpr std::uint32_t kRegisters = 20, kInstructions = 200;

}  // namespace vitrine::waves
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::waves::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;

template <int kWidth>
float* lanes(Machine& machine, std::uint32_t offset) {
  return reinterpret_cast<float*>(machine.registers + offset);
}

template <int kWidth>
const Instruction* multiply(Machine& machine, const Instruction* i) {
  const Floats d;
  float* to = lanes<kWidth>(machine, i->dst);
  const float *a = lanes<kWidth>(machine, i->src[0]), *b = lanes<kWidth>(machine, i->src[1]);
  for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(d))
    hn::Store(hn::Mul(hn::Load(d, a + lane), hn::Load(d, b + lane)), d, to + lane);
  return i + 1;
}

template <int kWidth>
const Instruction* multiply_add(Machine& machine, const Instruction* i) {
  const Floats d;
  float* to = lanes<kWidth>(machine, i->dst);
  const float *a = lanes<kWidth>(machine, i->src[0]), *b = lanes<kWidth>(machine, i->src[1]),
              *c = lanes<kWidth>(machine, i->src[2]);
  for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(d))
    hn::Store(hn::Add(hn::Mul(hn::Load(d, a + lane), hn::Load(d, b + lane)), hn::Load(d, c + lane)), d, to + lane);
  return i + 1;
}

const Instruction* end(Machine&, const Instruction*) { return nullptr; }

/// Nanoseconds per lane and operation: the best of many short runs.
template <int kWidth>
double measure() {
  alignas(64) static float registers[kRegisters * kWidth];
  std::fill(std::begin(registers), std::end(registers), 0.999f);
  std::vector<Instruction> program;
  std::uint32_t state = 1;
  const auto pick = [&] {
    state = state * 1664525u + 1013904223u;
    return (state >> 16) % kRegisters * kWidth * 4;
  };
  for (std::uint32_t k = 0; k < kInstructions; k++)
    program.push_back({k % 3 == 0 ? multiply<kWidth> : multiply_add<kWidth>, pick(), {pick(), pick(), pick()}, {}});
  program.push_back({end, 0, {}, {}});
  Machine machine{reinterpret_cast<std::byte*>(registers)};
  const int waves = 100 * 64 / kWidth;
  double best = 1e9;
  for (int round = 0; round < 400; round++) {
    std::fill(std::begin(registers), std::end(registers), 0.999f);
    const auto start = std::chrono::steady_clock::now();
    for (int wave = 0; wave < waves; wave++)
      for (const Instruction* i = program.data(); i != nullptr;) i = i->handler(machine, i);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count() / (double{kInstructions} * waves * kWidth));
  }
  return best;
}

void measure_all(double* results) {
  results[0] = measure<16>();
  results[1] = measure<32>();
  results[2] = measure<64>();
  results[3] = measure<128>();
}

}  // namespace vitrine::waves::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::waves {
HWY_EXPORT(measure_all);

/// The row of the target that VITRINE_TARGET asks for.
void print_row() {
  base::select_simd_target();
  double results[4];
  HWY_DYNAMIC_DISPATCH(measure_all)(results);
  std::printf("| %-6s | %8.3f | %8.3f | %8.3f | %8.3f |\n", base::simd_target_name(), results[0], results[1],
              results[2], results[3]);
}

}  // namespace vitrine::waves

/// The target is chosen once per process: without VITRINE_TARGET, one process per target.
int main(int, char** arguments) {
  if (std::getenv("VITRINE_TARGET") != nullptr) {
    vitrine::waves::print_row();
    return 0;
  }
  std::printf(
      "ns per lane and operation, by lanes of a wave\n| target |       16 |       32 |       64 |      128 |\n");
  std::printf("|---|---:|---:|---:|---:|\n");
  std::fflush(stdout);
  for (const char* target : {"sse4", "avx2", "avx3"})
    if (std::system(("VITRINE_TARGET=" + std::string(target) + " '" + arguments[0] + "'").c_str()) != 0) return 1;
  return 0;
}
#endif
