// A loop over mutated inputs of readers. usage: vitrine_reader_fuzz [SECONDS [SEED]] or FILE... Inputs that were taken
// are mutated beside the seeds. The input at hand is kept in "fuzz-input" in the working folder when the process dies.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <random>

#include "tests/fuzz/last_input.h"
#include "tests/fuzz/readers.h"

namespace vitrine::fuzz {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t count) { return static_cast<std::size_t>(random() % count); }

/// What readers look for, and numbers that they do not expect.
constexpr const char* kTokens[] = {"\"",
                                   "{",
                                   "}",
                                   "[",
                                   "]",
                                   ",",
                                   ":",
                                   "\n",
                                   "\r\n\r\n",
                                   "null",
                                   "true",
                                   "-1",
                                   "0",
                                   "1e999",
                                   "4294967296",
                                   "18446744073709551616",
                                   "9223372036854775807",
                                   "-9223372036854775809",
                                   "NaN",
                                   "\\ud800",
                                   "\xff",
                                   "end_of_record\n",
                                   "DA:",
                                   "BRDA:",
                                   "FN:",
                                   "SF:",
                                   "arguments",
                                   "Content-Length: ",
                                   "(",
                                   ")",
                                   "+",
                                   "?",
                                   "."};

/// Another run of digits for one that is there.
void change_number(std::string& text, Random& random) {
  const std::size_t from = below(random, text.size());
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto first = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(), digit);
  if (first == text.end()) return;
  const auto last = std::find_if_not(first, text.end(), digit);
  static constexpr const char* kNumbers[] = {"0",
                                             "1",
                                             "2",
                                             "65535",
                                             "65536",
                                             "2147483648",
                                             "4294967295",
                                             "4294967296",
                                             "18446744073709551615",
                                             "99999999999999999999",
                                             "-1",
                                             "1.5"};
  text.replace(first, last,
               random() % 2 != 0 ? kNumbers[below(random, std::size(kNumbers))] : std::to_string(random() % 300));
}

void mutate_once(std::string& text, const std::vector<std::string>& pool, Random& random) {
  const std::size_t at = below(random, text.size());
  const std::size_t length = std::min(text.size() - at, 1 + below(random, random() % 4 == 0 ? 200 : 8));
  switch (random() % 8) {
    case 0:
      text[at] = static_cast<char>(random());
      return;
    case 1:
      text[at] = static_cast<char>(text[at] ^ 1 << random() % 8);
      return;
    case 2:
      text.erase(at, length);
      return;
    case 3:
      text.insert(below(random, text.size() + 1), text.substr(at, length));
      return;
    case 4:
      text.insert(at, kTokens[below(random, std::size(kTokens))]);
      return;
    case 5:
      text.replace(at, length, kTokens[below(random, std::size(kTokens))]);
      return;
    case 6: {
      const std::string& other = pool[below(random, pool.size())];
      text.insert(at, other.substr(below(random, other.size() + 1), length));
      return;
    }
    default:
      change_number(text, random);
  }
}

/// Inputs of one reader, without the byte that names it. The first are seeds and stay.
struct Pool {
  std::vector<std::string> inputs;
  std::size_t seeds = 0;
};

void keep(Pool& pool, std::string text, Random& random) {
  constexpr std::size_t kKept = 300;
  if (pool.inputs.size() < pool.seeds + kKept)
    pool.inputs.push_back(std::move(text));
  else
    pool.inputs[pool.seeds + below(random, kKept)] = std::move(text);
}

void loop(double seconds, std::uint64_t seed) {
  constexpr std::size_t kLongest = 20000;
  std::map<char, Pool> pools;
  for (const std::string& input : reader_seeds()) {
    pools[input[0]].inputs.push_back(input.substr(1));
    ++pools[input[0]].seeds;
  }
  Random random(seed);
  std::size_t runs = 0, taken = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  while (elapsed() < seconds) {
    auto& [reader, pool] = *std::next(pools.begin(), static_cast<std::ptrdiff_t>(below(random, pools.size())));
    std::string text = pool.inputs[below(random, pool.inputs.size())];
    for (std::size_t count = 1 + below(random, 4); count > 0 && !text.empty(); --count)
      mutate_once(text, pool.inputs, random);
    if (text.size() > kLongest) continue;
    const std::string input = reader + text;
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    set_input(bytes);
    ++runs;
    if (!read_input(bytes)) continue;
    ++taken;
    keep(pool, std::move(text), random);
  }
  std::printf("%zu inputs, %zu of them taken\n", runs, taken);
}

int main(int count, char** arguments) {
  keep_input_on_death();
  for (const std::string& seed : reader_seeds()) {
    if (read_input({reinterpret_cast<const std::uint8_t*>(seed.data()), seed.size()})) continue;
    std::fprintf(stderr, "a seed of reader %d is not taken\n", seed[0]);
    return 1;
  }
  if (names_files(count, arguments)) {
    for (int i = 1; i < count; ++i) {
      const std::vector<std::uint8_t> bytes = read_bytes(arguments[i]);
      LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
    return 0;
  }
  loop(count > 1 ? std::atof(arguments[1]) : 60, count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1);
  return 0;
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) { return vitrine::fuzz::main(count, arguments); }
