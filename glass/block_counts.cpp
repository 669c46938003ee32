// How often the blocks of one program ran.
#include "glass/block_counts.h"

#include <atomic>

namespace vitrine::glass {

/// Next to other watches, or of waves that need not run, it is told; otherwise probes count in its cells.
class BlockCounts::Counter final : public spirv::exec::Watch {
 public:
  explicit Counter(Cells& cells) { cells_ = cells.data(); }
  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override { probes(wave, op, 1); }
  void probes(const spirv::Wave& wave, const spirv::ProbeOp& op, std::uint64_t times) override {
    spirv::exec::BlockCell& cell = cells_[&op - wave.program->probe_ops.data()];
    spirv::exec::count_block(wave, cell, spirv::exec::lanes_at(wave, op), times);
  }
};

BlockCounts::OfThread::OfThread(std::size_t size) : cells(size), counter(std::make_unique<Counter>(cells)) {}
BlockCounts::OfThread::~OfThread() = default;

BlockCounts::BlockCounts(const spirv::Program& program)
    : serial_([] {
        static std::atomic<std::uint64_t> made{0};
        return ++made;
      }()),
      probes_(program.probes.size()) {
  for (const spirv::ProbeOp& op : program.probe_ops) {
    told_.push_back({op.probe});
    told_.back().insert(told_.back().end(), op.also.begin(), op.also.end());
  }
}

BlockCounts::OfThread& BlockCounts::of_this_thread() {
  static thread_local std::uint64_t serial = 0;
  static thread_local OfThread* mine = nullptr;
  if (serial == serial_) return *mine;  // most waves are of the program that ran last
  const std::lock_guard lock(mutex_);
  mine = &of_thread_.try_emplace(std::this_thread::get_id(), told_.size()).first->second;
  serial = serial_;
  return *mine;
}

spirv::exec::Watch& BlockCounts::lasting_watch() { return *of_this_thread().counter; }

std::unique_ptr<spirv::exec::Watch> BlockCounts::watch() { return std::make_unique<Counter>(of_this_thread().cells); }

std::vector<BlockCounts::Count> BlockCounts::sum() const {
  std::vector<Count> sum(probes_);
  const std::lock_guard lock(mutex_);
  for (const auto& [thread, mine] : of_thread_)
    for (std::size_t i = 0; i < told_.size(); ++i)
      for (const std::uint32_t row : told_[i]) {
        sum[row].invocations += mine.cells[i].invocations.load(std::memory_order_relaxed);
        sum[row].helpers += mine.cells[i].helpers.load(std::memory_order_relaxed);
        sum[row].waves += mine.cells[i].waves.load(std::memory_order_relaxed);
      }
  return sum;
}

}  // namespace vitrine::glass
