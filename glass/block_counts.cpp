// How often the blocks of one program ran.
#include "glass/block_counts.h"

namespace vitrine::glass {
namespace {

#ifdef __x86_64__
/// The driver's oldest SIMD target has POPCNT, though the compiler is not told of it.
#define VITRINE_POPCNT [[gnu::target("popcnt")]]
#else
#define VITRINE_POPCNT
#endif

/// Of a number that this thread alone writes.
void add(std::atomic<std::uint64_t>& to, std::uint64_t more) {
  to.store(to.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

}  // namespace

class BlockCounts::Counter final : public spirv::exec::Watch {
 public:
  explicit Counter(Cells& cells) : cells_(cells) {}
  VITRINE_POPCNT void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override { probes(wave, op, 1); }
  VITRINE_POPCNT void probes(const spirv::Wave& wave, const spirv::ProbeOp& op, std::uint64_t times) override {
    const base::LaneMask lanes = op.guards.empty() ? wave.active : spirv::exec::lanes_at(wave, op);
    if (lanes == 0) return;
    Cell& cell = cells_[static_cast<std::size_t>(&op - wave.program->probe_ops.data())];
    add(cell.invocations, times * static_cast<std::uint64_t>(__builtin_popcountll(lanes & wave.live)));
    add(cell.waves, times);
    if (const base::LaneMask helpers = lanes & ~wave.live; helpers != 0)
      add(cell.helpers, times * static_cast<std::uint64_t>(__builtin_popcountll(helpers)));
  }

 private:
  Cells& cells_;
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
