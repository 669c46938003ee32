// How long work would take with another number of threads: loops run one item after the other, each item is timed, and
// the times are handed to as many threads as VITRINE_SIMULATED_THREADS says, each item to the one that is free first,
// as base/workers.h does. What threads do to each other (caches, memory, locks, waking up) is left out: it is the most
// that the division into items allows. Told when the process ends (VITRINE_LOG=threads).
#pragma once

#include <cstddef>

#include "base/function_ref.h"

namespace vitrine::base {

/// How many are asked for, at most 256; 0: none are simulated.
std::size_t simulated_workers();

/// As parallel_for(), where simulated_workers() is not 0 and no loop is running on this thread.
void simulate_loop(std::size_t count, FunctionRef<void(std::size_t index, std::size_t worker)> body);

/// Work of one thread whose loops are simulated, from its making to its end.
class SimulatedWork {
 public:
  SimulatedWork();
  ~SimulatedWork();
  SimulatedWork(const SimulatedWork&) = delete;
  SimulatedWork& operator=(const SimulatedWork&) = delete;

 private:
  double begin_ = 0;
};

}  // namespace vitrine::base
