// The loop of fuzzers whose inputs are choices, for compilers without libFuzzer: random bytes, one run after the other.
// usage: NAME [SECONDS [SEED]] or FILE... The input at hand lies in "fuzz-input" in the working folder, the slowest of
// more than five seconds in "fuzz-input-slow".
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "tests/fuzz/last_input.h"
#include "tests/fuzz/target.h"

namespace vitrine::fuzz {
namespace {

constexpr std::size_t kBytes = 2048;  // more choices than a run makes

void loop(double seconds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::uint8_t> bytes(kBytes);
  std::size_t runs = 0;
  double slowest = 0;
  const auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  const double start = now();
  for (double at = start; at - start < seconds;) {
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
  loop(count > 1 ? std::atof(arguments[1]) : 60, count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1);
  return 0;
}
