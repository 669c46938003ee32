// What SPIRV-Tools' validator thinks of a module. It decides nothing: the front end reads any words and refuses only
// what it cannot execute; the validator's words explain that to whoever wrote the module.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace vitrine::spirv {

/// The validator's complaint, on one line; empty where it has none, or is not asked because the module could take it
/// minutes or gigabytes.
std::string validator_message(std::span<const std::uint32_t> words);

/// Under VITRINE_LOG=validator, in debug builds also under VITRINE_LOG=shader, tells of a module that runs although the
/// validator dislikes it.
void log_diagnosis(std::span<const std::uint32_t> words);

}  // namespace vitrine::spirv
