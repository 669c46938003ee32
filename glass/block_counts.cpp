// How often the blocks of one program ran.
#include "glass/block_counts.h"

#include <bit>

namespace vitrine::glass {
namespace {

/// Of a number that this thread alone writes.
void add(std::atomic<std::uint64_t>& to, base::LaneMask lanes) {
  const auto count = static_cast<std::uint64_t>(std::popcount(lanes));
  to.store(to.load(std::memory_order_relaxed) + count, std::memory_order_relaxed);
}

}  // namespace

class BlockCounts::Counter : public spirv::exec::Watch {
 public:
  explicit Counter(Cells& cells) : cells_(cells) {}
  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override {
    const base::LaneMask lanes = op.guards.empty() ? wave.active : spirv::exec::lanes_at(wave, op);
    if (lanes == 0) return;
    Cell& cell = cells_[op.probe];
    add(cell.invocations, lanes & wave.live);
    add(cell.waves, 1);
    if (const base::LaneMask helpers = lanes & ~wave.live) add(cell.helpers, helpers);
  }

 private:
  Cells& cells_;
};

BlockCounts::BlockCounts(std::size_t probes)
    : serial_([] {
        static std::atomic<std::uint64_t> made{0};
        return ++made;
      }()),
      probes_(probes) {}

BlockCounts::Cells& BlockCounts::cells_of_this_thread() {
  static thread_local std::uint64_t serial = 0;
  static thread_local Cells* cells = nullptr;
  if (serial == serial_) return *cells;  // most waves are of the program that ran last
  const std::lock_guard lock(mutex_);
  cells = &of_thread_.try_emplace(std::this_thread::get_id(), probes_).first->second;
  serial = serial_;
  return *cells;
}

std::unique_ptr<spirv::exec::Watch> BlockCounts::watch() { return std::make_unique<Counter>(cells_of_this_thread()); }

std::vector<BlockCounts::Count> BlockCounts::sum() const {
  std::vector<Count> sum(probes_);
  const std::lock_guard lock(mutex_);
  for (const auto& [thread, cells] : of_thread_)
    for (std::size_t i = 0; i < probes_; ++i) {
      sum[i].invocations += cells[i].invocations.load(std::memory_order_relaxed);
      sum[i].helpers += cells[i].helpers.load(std::memory_order_relaxed);
      sum[i].waves += cells[i].waves.load(std::memory_order_relaxed);
    }
  return sum;
}

}  // namespace vitrine::glass
