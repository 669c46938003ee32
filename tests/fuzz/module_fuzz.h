// One input of the fuzzers: a stage and the words of a module, from bytes to a program to its execution.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "spirv/compile.h"

namespace vitrine::fuzz {

/// How far an input came.
enum class Outcome : std::uint8_t { kRefused, kCompiled, kRan };

/// Compiles the words, once as they are and once for somebody who watches everything, and runs what became of them
/// twice; a difference between the runs ends the process, as does every fault that a sanitizer sees.
Outcome run_module(VkShaderStageFlagBits stage, std::span<const std::uint32_t> words);

/// The stages by the number that an input's first byte names them with (modulo how many there are).
inline constexpr VkShaderStageFlagBits kStages[] = {VK_SHADER_STAGE_COMPUTE_BIT,
                                                    VK_SHADER_STAGE_FRAGMENT_BIT,
                                                    VK_SHADER_STAGE_VERTEX_BIT,
                                                    VK_SHADER_STAGE_GEOMETRY_BIT,
                                                    VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                                                    VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT};
std::uint8_t number_of(VkShaderStageFlagBits stage);

/// Inputs are bytes: the first chooses the stage, the rest are words. words_of() takes at least one byte.
std::vector<std::uint32_t> words_of(std::span<const std::uint8_t> bytes);
Outcome run_bytes(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::fuzz
