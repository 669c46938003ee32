// What more threads would do for the workloads (base/simulated_workers.h).
#pragma once

#include <string>

namespace vitrine::bench {

/// Prints a table: workloads whose name has `filter` in it by the numbers of threads in `list` ("4,8,16").
int run_threads(const std::string& manifest, const std::string& list, const std::string& filter);

}  // namespace vitrine::bench
