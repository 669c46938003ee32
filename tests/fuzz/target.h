// What a fuzzer is for: a run over an input's bytes. The name is libFuzzer's.
#pragma once

#include <cstddef>
#include <cstdint>

/// Ends the process where what is fuzzed does what it must not do. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
