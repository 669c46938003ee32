// Which capabilities a module may declare.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace vitrine::spirv {

/// Why a module (that check_module() let pass) is refused: the name of the first capability that the device lacks.
/// Empty: it lacks none.
std::string missing_device_capability(std::span<const std::uint32_t> words);

}  // namespace vitrine::spirv
