// How often the blocks of one program ran. Every thread counts for itself, so that counting waits for nobody.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "spirv/exec/observe.h"

namespace vitrine::glass {

class BlockCounts {
 public:
  /// Of one block.
  struct Count {
    std::uint64_t invocations = 0;  ///< that came by, without helpers
    std::uint64_t helpers = 0;
    std::uint64_t waves = 0;  ///< in which any did
  };

  explicit BlockCounts(const spirv::Program& program);

  /// Counts what waves of the calling thread do.
  spirv::exec::Watch& lasting_watch();
  /// The same for one that is destroyed after each.
  std::unique_ptr<spirv::exec::Watch> watch();
  /// So far, by row of Program::probes.
  std::vector<Count> sum() const;

 private:
  using Cells = std::vector<spirv::exec::BlockCell>;
  class Counter;
  struct OfThread {
    explicit OfThread(std::size_t size);
    ~OfThread();
    Cells cells;
    std::unique_ptr<Counter> counter;
  };

  OfThread& of_this_thread();

  const std::uint64_t serial_;  ///< of all that this process made: addresses come again
  const std::size_t probes_;    ///< rows
  /// What the program's instructions tell of: rows. A cell belongs to each instruction.
  std::vector<std::vector<std::uint32_t>> told_;
  mutable std::mutex mutex_;
  std::map<std::thread::id, OfThread> of_thread_;
};

}  // namespace vitrine::glass
