// The worker pool: one per process, sized to the CPUs the process may use (VITRINE_THREADS overrides). Parallel loops
// only; no busy waiting. Threads start at the first loop that needs them, so a process that draws nothing has none.
#pragma once

#include <cstddef>

#include "base/function_ref.h"

namespace vitrine::base {

/// Number of threads that take part in a parallel loop, the calling one included; at least 1.
std::size_t worker_count();

/// Runs body(index, worker) for every index in [0, count). Items are handed out in increasing order; `worker` is in
/// [0, worker_count()) and no two concurrent calls of this loop share it, so it may index scratch memory that belongs
/// to this loop (memory that outlives a loop is thread_local instead). Returns when all items are done. Runs inline on
/// the caller, as worker 0, when count <= 1, when there is one worker, or when called from inside a parallel loop. When
/// the body throws, no further item starts and the first exception is rethrown here once all threads have left the
/// loop. Each thread takes the caller's floating-point mode as it finds it: set one with ScopedFloatMode inside the
/// body. Where VITRINE_SHAKE asks for another order (base/shake.h), one after the other in that, on the caller.
void parallel_for(std::size_t count, FunctionRef<void(std::size_t index, std::size_t worker)> body);

}  // namespace vitrine::base
