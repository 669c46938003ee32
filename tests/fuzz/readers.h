// One input of the readers' fuzzer: bytes that came from outside, for what reads them (block decoders, files of tools,
// the Debug Adapter Protocol, requests of debuggers, bug files).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vitrine::fuzz {

/// Gives the bytes behind the first, which names the reader (modulo how many there are), to it. Whether it took them. A
/// reader that takes what it does not write again alike, or that decodes a block in two ways differently, ends the
/// process.
bool read_input(std::span<const std::uint8_t> bytes);

/// Inputs that readers take, for mutation.
std::vector<std::string> reader_seeds();

}  // namespace vitrine::fuzz
