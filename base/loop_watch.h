// Who wants to know when threads are at work on parallel loops (base/workers.h): at most one, for good.
#pragma once

#include <chrono>
#include <cstddef>

namespace vitrine::base {

/// A thread has done `items` items of a loop. Called on that thread; throws nothing.
using LoopWatch = void (*)(std::chrono::steady_clock::time_point begin, std::chrono::steady_clock::time_point end,
                           std::size_t items);

void set_loop_watch(LoopWatch watch);

}  // namespace vitrine::base
