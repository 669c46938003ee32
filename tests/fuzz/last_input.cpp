// See last_input.h.
#include "tests/fuzz/last_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/fuzz/target.h"

namespace vitrine::fuzz {
namespace {

std::span<const std::uint8_t> input;

constexpr int kDeaths[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL};
struct sigaction otherwise[std::size(kDeaths)];  // the sanitizer's

extern "C" void on_death(int signal) {
  keep_input();
  for (std::size_t i = 0; i < std::size(kDeaths); i++)
    if (kDeaths[i] == signal) sigaction(signal, &otherwise[i], nullptr);
  if (signal == SIGABRT) std::raise(signal);  // the others come again where this returns to
}

}  // namespace

void set_input(std::span<const std::uint8_t> bytes) { input = bytes; }

void keep_input() {
  const int file = open("fuzz-input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || write(file, input.data(), input.size()) < 0) return;
  close(file);
}

/// On a stack of its own, as the usual one may be what has run out.
void keep_input_on_death() {
  static char stack[1 << 16];
  stack_t given{};
  if (sigaltstack(nullptr, &given) != 0 || given.ss_flags == SS_DISABLE) {
    given.ss_sp = stack;
    given.ss_size = sizeof stack;
    given.ss_flags = 0;
    sigaltstack(&given, nullptr);
  }
  struct sigaction action {};
  action.sa_handler = on_death;
  action.sa_flags = SA_ONSTACK;
  for (std::size_t i = 0; i < std::size(kDeaths); i++) sigaction(kDeaths[i], &action, &otherwise[i]);
}

bool names_files(int count, char** arguments) {
  return count > 1 && std::isdigit(static_cast<unsigned char>(arguments[1][0])) == 0;
}

int run_files(int count, char** arguments) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i) {
    const std::size_t before = files.size();
    if (std::filesystem::is_directory(arguments[i])) {
      for (const auto& entry : std::filesystem::directory_iterator(arguments[i])) files.push_back(entry.path());
    } else {
      files.emplace_back(arguments[i]);
    }
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
  }
  for (const std::filesystem::path& file : files) {
    const std::vector<std::uint8_t> bytes = read_bytes(file);
    set_input(bytes);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%zu inputs\n", files.size());
  return files.empty() ? 1 : 0;
}

Rounds rounds_of(int count, char** arguments) {
  Rounds rounds;
  if (count > 1) rounds.seconds = std::atof(arguments[1]);
  if (count > 2) rounds.seed = std::strtoull(arguments[2], nullptr, 10);
  return rounds;
}

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace vitrine::fuzz
