// The input that a fuzzer is at, kept in a file when the process dies of it.
#pragma once

#include <cstdint>
#include <span>

namespace vitrine::fuzz {

/// From now on a signal that ends the process leaves the input in "fuzz-input" in the working folder.
void keep_input_on_death();
/// The input that runs next; its bytes stay where they are until the next call.
void set_input(std::span<const std::uint8_t> bytes);
/// Writes it now.
void keep_input();

}  // namespace vitrine::fuzz
