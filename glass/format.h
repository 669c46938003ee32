// The text of a printf in a shader, with the rules of the validation layer's DebugPrintf: C's conversions, "%v3f" for
// vectors (with flags and precision in front of the v: "%1.2v3f"), "%ul", "%lu", "%lx" for 64 bits.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "spirv/probe.h"

namespace vitrine::glass {

/// `words`: what the probe's values are made of. Conversions without a value, and those that are none, stay as they
/// are.
std::string format_text(std::string_view format, std::span<const spirv::ProbeValue> values,
                        std::span<const std::uint32_t> words);

}  // namespace vitrine::glass
