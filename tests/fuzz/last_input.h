// The input that a fuzzer is at, kept in a file when the process dies of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace vitrine::fuzz {

/// From now on a signal that ends the process leaves the input in "fuzz-input" in the working folder.
void keep_input_on_death();
/// The input that runs next; its bytes stay where they are until the next call.
void set_input(std::span<const std::uint8_t> bytes);
/// Writes it now.
void keep_input();

/// Whether the words behind a fuzzer's name are files or folders of inputs to be run again, not seconds.
bool names_files(int count, char** arguments);
/// Runs them, those of a folder in the order of their names. The status to exit with.
int run_files(int count, char** arguments);
/// SECONDS and SEED behind its name, else a minute and 1.
struct Rounds {
  double seconds = 60;
  std::uint64_t seed = 1;
};
Rounds rounds_of(int count, char** arguments);
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path);

}  // namespace vitrine::fuzz
