// See last_input.h.
#include "tests/fuzz/last_input.h"

#include <fcntl.h>
#include <unistd.h>
#include <cctype>
#include <fstream>

#include <csignal>
#include <iterator>

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

std::vector<std::uint8_t> read_bytes(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace vitrine::fuzz
