// Whether all workgroups of a dispatch do the same to shared memory: then what is found of one holds of all.
#pragma once

#include "spirv/ir.h"

namespace vitrine::spirv::lowering {

/// In: what rewrite() gives, of a compute shader, with Origin::order (exec::Interest::order). If offsets in shared
/// memory, and what decides which accesses and barriers an invocation comes to, depend neither on which workgroup it is
/// in nor on what shaders write, Origin::order of accesses to shared memory says so (MemoryOrder::alike). If they
/// depend on what buffers hold, all of that is loaded with MemoryOrder::given. Fences with atomic operations are not
/// followed.
void mark_alike(ir::Function& function);

}  // namespace vitrine::spirv::lowering
