// Atomics of binary16: operand in data[0] of the memory row, each number in element_bytes of memory; the old values go
// to register dst.
#pragma once

#include "spirv/exec/handlers.h"

namespace vitrine::spirv::exec {

Handler atomic_half(Space space, bool uniform);

}  // namespace vitrine::spirv::exec
