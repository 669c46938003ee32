// How often the blocks of one program ran.
#include "glass/block_counts.h"

#include "base/lane_count.h"

namespace vitrine::glass {
namespace {

/// Of a number that this thread alone writes.
void add(std::atomic<std::uint64_t>& to, base::LaneMask lanes) {
  to.store(to.load(std::memory_order_relaxed) + base::count_lanes(lanes), std::memory_order_relaxed);
}

}  // namespace

class BlockCounts::Counter : public spirv::exec::Watch {
 public:
  explicit Counter(Cells& cells) : cells_(cells) {}
  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override {
    const base::LaneMask lanes = op.guards.empty() ? wave.active : spirv::exec::lanes_at(wave, op);
    if (lanes == 0) return;
    Cell& cell = cells_[static_cast<std::size_t>(&op - wave.program->probe_ops.data())];
    add(cell.invocations, lanes & wave.live);
    add(cell.waves, 1);
    if (const base::LaneMask helpers = lanes & ~wave.live) add(cell.helpers, helpers);
  }

 private:
  Cells& cells_;
};

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

BlockCounts::Cells& BlockCounts::cells_of_this_thread() {
  static thread_local std::uint64_t serial = 0;
  static thread_local Cells* cells = nullptr;
  if (serial == serial_) return *cells;  // most waves are of the program that ran last
  const std::lock_guard lock(mutex_);
  cells = &of_thread_.try_emplace(std::this_thread::get_id(), told_.size()).first->second;
  serial = serial_;
  return *cells;
}

std::unique_ptr<spirv::exec::Watch> BlockCounts::watch() { return std::make_unique<Counter>(cells_of_this_thread()); }

std::vector<BlockCounts::Count> BlockCounts::sum() const {
  std::vector<Count> sum(probes_);
  const std::lock_guard lock(mutex_);
  for (const auto& [thread, cells] : of_thread_)
    for (std::size_t i = 0; i < told_.size(); ++i)
      for (const std::uint32_t row : told_[i]) {
        sum[row].invocations += cells[i].invocations.load(std::memory_order_relaxed);
        sum[row].helpers += cells[i].helpers.load(std::memory_order_relaxed);
        sum[row].waves += cells[i].waves.load(std::memory_order_relaxed);
      }
  return sum;
}

}  // namespace vitrine::glass
