// SPIR-V words in, a Module out.
#pragma once

#include <cstdint>
#include <span>

#include "spirv/front/module.h"
#include "spirv/front/sources.h"

namespace vitrine::spirv::front {

/// Splits the words and reads every declaration; constants are specialised and folded. Throws Failure.
Module parse_module(std::span<const std::uint32_t> words, const CompileOptions& options, SourceTexts texts);

}  // namespace vitrine::spirv::front
