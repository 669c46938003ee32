// Compute dispatch: workgroups over the workers, waves of a workgroup one after the other; a barrier suspends a wave
// until the others have reached it.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <deque>
#include <vector>

#include "base/float_mode.h"
#include "base/lasting.h"
#include "base/log.h"
#include "base/workers.h"
#include "spirv/exec/dispatch_order.h"
#include "spirv/exec/observe.h"
#include "spirv/exec/wave_memory.h"

namespace vitrine::spirv {
namespace {

constexpr std::uint64_t kWidth = base::kWaveWidth;

/// Work below this many (instructions x waves) is done on the caller: waking a worker costs more.
constexpr std::uint64_t kInlineWork = 20000;
/// Workgroups are handed out in items of about this much work.
constexpr std::uint64_t kItemWork = 4000;
/// But in as many for each thread at least, if there are enough workgroups: nobody knows how often their loops turn.
constexpr std::uint64_t kItemsPerThread = 4;

struct Launch {
  const BoundShader& shader;
  const Program& program;
  const Loop loop;
  const std::uint32_t* base;
  const std::uint32_t* groups;
  const exec::DispatchOrder order;
  std::uint64_t invocations = 0;              ///< of a workgroup
  std::int64_t budget = 0;                    ///< of a wave
  std::uint32_t columns = 0;                  ///< of the grid in x: workgroups, or waves full of them
  mutable std::atomic<bool> reported{false};  ///< a divergent barrier
};

/// Memory of one thread's workgroup; kept between dispatches.
struct GroupMemory {
  std::deque<exec::WaveMemory> memory;  ///< one per wave when waves may be suspended, else one for all
  std::vector<Wave> waves;
  std::vector<std::uint32_t> shared;  ///< words, so that atomics are aligned
};

GroupMemory& thread_memory() { return base::per_thread<GroupMemory>(); }

void bind(GroupMemory& memory, const Launch& launch) {
  const std::size_t resident = launch.program.has_barrier ? launch.order.pieces() : 1;
  while (memory.memory.size() < resident) memory.memory.emplace_back();
  memory.waves.assign(resident, Wave{});
  memory.shared.resize((launch.program.shared_bytes + 3) / 4);
  for (std::size_t w = 0; w < resident; ++w) {
    memory.memory[w].bind(launch.shader, memory.waves[w]);
    memory.waves[w].shared = reinterpret_cast<std::byte*>(memory.shared.data());
    memory.waves[w].shared_size = launch.program.shared_bytes;
    std::copy_n(launch.groups, 3, memory.waves[w].num_workgroups);
  }
}

void start(Wave& wave, const Launch& launch, std::uint32_t piece, const std::uint32_t group[3]) {
  std::copy_n(group, 3, wave.workgroup_id);
  wave.first_invocation = static_cast<std::uint32_t>(launch.order.wave_of(piece) * kWidth);
  std::uint64_t lanes = launch.invocations - wave.first_invocation;
  if (const std::uint32_t most = launch.program.groups_per_wave; most > 1)
    lanes *= std::min(most, launch.base[0] + launch.groups[0] - group[0]);
  wave.launched = base::first_lanes(static_cast<std::size_t>(std::min(kWidth, lanes))) & launch.order.lanes_of(piece);
  wave.active = wave.live = wave.launched;
  wave.budget = launch.budget;
  wave.resume = launch.program.code.data();
}

/// Runs a wave of the n-th workgroup to its end or next barrier. False after a fault.
bool run(Wave& wave, const Launch& launch, std::uint64_t n) {
  launch.loop(wave, wave.resume);
  if (wave.status != Wave::Status::kFault) return true;
  exec::raise_fault(launch.shader.fault(), wave, n);
  return false;
}

/// Waves that wait at a barrier which others have not reached or will not reach: the application's fault. They go on
/// as if all had met; reported once per dispatch.
void report_divergence(const GroupMemory& memory, const Launch& launch) {
  const Wave* waiting = nullptr;
  bool apart = false;
  for (const Wave& wave : memory.waves) {
    if (wave.status != Wave::Status::kAtBarrier || wave.active != wave.launched) apart = true;
    if (wave.status != Wave::Status::kAtBarrier) continue;
    if (waiting != nullptr && waiting->resume != wave.resume) apart = true;
    waiting = &wave;
  }
  if (!apart || waiting == nullptr) return;
  if (launch.program.observation) launch.program.observation->observer->apart(*waiting);
  if (launch.reported.exchange(true)) return;
  base::log("error", "a barrier is not reached by all invocations of the workgroup" + exec::place_of(*waiting));
}

/// Runs the pieces of a workgroup one after the other; `run_piece`: false after a fault. Whether all have run.
template <class RunPiece>
bool run_pieces(const Launch& launch, std::uint64_t n, std::uint32_t barriers, RunPiece run_piece) {
  const std::uint32_t pieces = launch.order.pieces();
  if (!launch.order.shaken()) {
    for (std::uint32_t piece = 0; piece < pieces; ++piece)
      if (!run_piece(piece)) return false;
    return true;
  }
  const base::Shuffle order = launch.order.pieces_in(n, barriers);
  for (std::uint32_t i = 0; i < pieces; ++i)
    if (!run_piece(static_cast<std::uint32_t>(order(i)))) return false;
  return true;
}

/// What a workgroup may expect to be zero; the rest of its memory is, too, or noise (base/shake.h).
void reset_shared(GroupMemory& memory, const Program& program) {
  std::ranges::fill(memory.shared, 0u);
  if (memory.shared.empty() || !base::shakes(base::ShakeKind::kPoison)) return;
  std::byte* const bytes = reinterpret_cast<std::byte*>(memory.shared.data());
  base::poison(bytes, program.shared_bytes);
  for (const auto& [begin, end] : program.zeroed_shared) std::memset(bytes + begin, 0, end - begin);
}

void run_group(GroupMemory& memory, const Launch& launch, const std::uint32_t group[3], std::uint64_t n) {
  reset_shared(memory, launch.program);
  if (!launch.program.has_barrier) {
    run_pieces(launch, n, 0, [&](std::uint32_t piece) {
      start(memory.waves[0], launch, piece, group);
      return memory.waves[0].launched == 0 || run(memory.waves[0], launch, n);
    });
    return;
  }
  for (std::uint32_t piece = 0; piece < launch.order.pieces(); ++piece) {
    Wave& wave = memory.waves[piece];
    start(wave, launch, piece, group);
    if (wave.launched == 0) wave.status = Wave::Status::kDone;
  }
  bool waiting = true;
  for (std::uint32_t barriers = 0; waiting; ++barriers) {
    waiting = false;
    const bool done = run_pieces(launch, n, barriers, [&](std::uint32_t piece) {
      Wave& wave = memory.waves[piece];
      if (wave.status == Wave::Status::kDone) return true;
      const bool goes_on = run(wave, launch, n);
      waiting |= wave.status == Wave::Status::kAtBarrier;
      return goes_on;
    });
    if (!done) return;
    if (waiting) report_divergence(memory, launch);
  }
}

void run_range(const Launch& launch, std::uint64_t first, std::uint64_t last) {
  const base::ScopedFloatMode mode(base::Denormals::kHonour);
  GroupMemory& memory = thread_memory();
  bind(memory, launch);
  for (std::uint64_t position = first; position < last; ++position) {
    const std::uint64_t g = launch.order.group(position);
    // After a fault the workgroups before that one still run, so that it is the same one every time.
    if (g >= launch.shader.fault().order.load(std::memory_order_relaxed)) {
      if (launch.order.shaken()) continue;
      break;
    }
    const std::uint64_t x = launch.columns, y = launch.groups[1];
    const std::uint32_t group[3] = {launch.base[0] + static_cast<std::uint32_t>(g % x) * launch.program.groups_per_wave,
                                    launch.base[1] + static_cast<std::uint32_t>(g / x % y),
                                    launch.base[2] + static_cast<std::uint32_t>(g / x / y)};
    for (Wave& wave : memory.waves) wave.status = Wave::Status::kRunning;
    run_group(memory, launch, group, g);
  }
}

}  // namespace

void dispatch(const BoundShader& shader, const std::uint32_t base[3], const std::uint32_t groups[3]) {
  const Program& program = shader.shader().program();
  const std::uint32_t per_wave = program.groups_per_wave;
  const std::uint32_t columns = groups[0] / per_wave + (groups[0] % per_wave != 0 ? 1 : 0);
  const std::uint64_t total = std::uint64_t{columns} * groups[1] * groups[2];
  if (total == 0) return;
  const std::uint32_t* size = program.local_size;
  const std::uint64_t invocations = std::uint64_t{size[0]} * size[1] * size[2];
  const auto waves = static_cast<std::uint32_t>((invocations + kWidth - 1) / kWidth);
  Launch launch{shader, program, loop_of(program), base, groups, exec::DispatchOrder(program, total, waves)};
  launch.columns = columns;
  launch.invocations = invocations;
  // Waves that wait for each other take turns: together they have the budget of one.
  launch.budget = exec::shader_budget() / (program.has_barrier ? launch.order.pieces() : 1);
  const std::uint64_t group_work = waves * program.cost;
  const bool in_order = program.observation && program.observation->observer->in_order();
  if (in_order || launch.order.shaken() || group_work * total <= kInlineWork) return run_range(launch, 0, total);
  const std::uint64_t most = std::max<std::uint64_t>(1, total / (kItemsPerThread * base::worker_count()));
  const std::uint64_t per_item = std::clamp<std::uint64_t>(kItemWork / group_work, 1, most);
  base::parallel_for(static_cast<std::size_t>((total + per_item - 1) / per_item), [&](std::size_t item, std::size_t) {
    run_range(launch, item * per_item, std::min(total, (item + 1) * per_item));
  });
}

}  // namespace vitrine::spirv
