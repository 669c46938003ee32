// The loop of fuzzers whose inputs are choices, for compilers without libFuzzer: random bytes, one run after the other.
// usage: NAME [SECONDS [SEED]] or FILE... The input at hand lies in "fuzz-input" in the working folder, the slowest of
// more than five seconds in "fuzz-input-slow".
#include <chrono>
#include <cstdio>
#include <random>

#include "tests/fuzz/last_input.h"
#include "tests/fuzz/target.h"

namespace vitrine::fuzz {
namespace {

constexpr std::size_t kBytes = 2048;  // more choices than a run makes

void loop(const Rounds& rounds) {
  std::mt19937_64 random(rounds.seed);
  std::vector<std::uint8_t> bytes(kBytes);
  std::size_t runs = 0;
  double slowest = 0;
  const auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  const double start = now();
  for (double at = start; at - start < rounds.seconds;) {
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    set_input(bytes);
    keep_input();  // a process that is killed for its memory says nothing
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    ++runs;
    const double after = now();
    if (after - at > slowest) {
      slowest = after - at;
      if (slowest > 5) std::rename("fuzz-input", "fuzz-input-slow");
    }
    at = after;
  }
  std::remove("fuzz-input");
  std::printf("%zu runs; the slowest took %.1f s\n", runs, slowest);
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) {
  using namespace vitrine::fuzz;
  if (names_files(count, arguments)) return run_files(count, arguments);
  loop(rounds_of(count, arguments));
  return 0;
}
