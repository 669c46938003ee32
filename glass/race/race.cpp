// The tool `race`: two accesses to the same bytes by different invocations of one command, one of them a write, that
// neither barriers nor atomic operations order (Vulkan 1.3.239, Memory Model: Data Race).
#include <algorithm>
#include <atomic>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "base/lasting.h"
#include "glass/output.h"
#include "glass/race/accesses.h"
#include "glass/tools.h"
#include "spirv/exec/invocation.h"

namespace vitrine::glass {
namespace {

using race::CommandLog;
using race::Group;
using race::Told;
using spirv::Instruction;
using spirv::InstructionNote;
using spirv::ObservedCommand;
using spirv::Wave;

constexpr std::uint16_t kOpControlBarrier = 224, kOpMemoryBarrier = 225, kOpBeginInterlock = 5364;

const void* owner_of(const ObservedCommand* command) { return command != nullptr ? command->owner : nullptr; }

/// What one thread runs.
struct ThreadGroup {
  explicit ThreadGroup(race::Pairs& pairs) : group(pairs) {}
  std::mutex mutex;  ///< of beginnings and ends, and of the log
  Group group;
  /// What its workgroups that have ended did, of one command, until that has another one or is settled.
  CommandLog log;
  const ObservedCommand* log_command = nullptr;
  race::Tracked tracked;
  const Told* tracked_program = nullptr;
  const ObservedCommand* tracked_command = nullptr;
  std::uint64_t tracked_number = 0;
  bool shared_is_quiet = false;  ///< known of the workgroup that runs: what it does to shared memory is not looked at
  bool idle = false;             ///< and it does nothing else
  std::uint32_t names[base::kWaveWidth] = {};  ///< of a wave of a draw: what invocations are called by
};

/// Shared by the programs of a tool.
class Races {
 public:
  ThreadGroup& here();
  void begin(ThreadGroup& thread, const Told& program, const Wave& wave, const race::Who& who);
  /// The same of the workgroup of a wave.
  void begin_compute(ThreadGroup& thread, const Told& program, const Wave& wave);
  void end(ThreadGroup& thread);
  /// What commands of `owner` did is held against each other. `but`: it goes on.
  void settle(const void* owner, const ObservedCommand* but);

  race::Pairs pairs;

 private:
  /// A tool that is made where another one was is not the same.
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }
  const std::uint64_t number_ = next_number();
  CommandLog& log_of(const ObservedCommand* command);
  /// What its workgroup did goes into a log. The thread's mutex is locked.
  void close(ThreadGroup& thread, CommandLog& log);
  /// What its log has goes into that of the command. Both mutexes are locked.
  void hand_over(ThreadGroup& thread);
  std::mutex mutex_;
  std::map<std::thread::id, std::unique_ptr<ThreadGroup>> threads_;
  std::map<const ObservedCommand*, std::unique_ptr<CommandLog>> logs_;
  std::unique_ptr<CommandLog> spare_;  ///< one that has been settled: its memory is there already
};

ThreadGroup& Races::here() {
  thread_local std::pair<std::uint64_t, ThreadGroup*> recent{0, nullptr};
  if (recent.first == number_) return *recent.second;
  const std::lock_guard lock(mutex_);
  std::unique_ptr<ThreadGroup>& thread = threads_[std::this_thread::get_id()];
  if (!thread) thread = std::make_unique<ThreadGroup>(pairs);
  recent = {number_, thread.get()};
  return *thread;
}

CommandLog& Races::log_of(const ObservedCommand* command) {
  std::unique_ptr<CommandLog>& log = logs_[command];
  if (!log) log = spare_ ? std::move(spare_) : std::make_unique<CommandLog>();
  return *log;
}

void Races::begin(ThreadGroup& thread, const Told& program, const Wave& wave, const race::Who& who) {
  const ObservedCommand* const command = wave.resources->command;
  const std::uint64_t number = command != nullptr ? command->submission << 32 | command->command : 0;
  const bool known = command != nullptr && thread.tracked_program == &program && thread.tracked_command == command &&
                     thread.tracked_number == number;
  // The dispatches of a device come one after the other.
  if (program.compute() && !known) settle(owner_of(command), command);
  const bool whole = program.sites.orders_device;
  if (!whole || !thread.group.runs(program, command)) end(thread);
  const std::lock_guard lock(thread.mutex);
  if (!known) thread.tracked.update(program.sites, wave);
  thread.tracked_program = &program;
  thread.tracked_command = command;
  thread.tracked_number = number;
  if (!known) thread.shared_is_quiet = false;
  if (!thread.shared_is_quiet && thread.tracked.alike()) thread.shared_is_quiet = program.quiet.holds(command);
  thread.idle = thread.shared_is_quiet && !thread.tracked.has_device_sites();
  if (thread.idle) return;
  thread.group.begin(program, command, who, whole, program.compute() && !thread.shared_is_quiet ? wave.shared_size : 0);
}

void Races::begin_compute(ThreadGroup& thread, const Told& program, const Wave& wave) {
  race::Who who;
  std::copy_n(wave.workgroup_id, 3, who.group.begin());
  begin(thread, program, wave, who);
}

/// Threads meet once a command, not once a workgroup.
void Races::end(ThreadGroup& thread) {
  if (!thread.group.is_open()) return;
  if (thread.log_command != thread.group.command()) {
    const std::lock_guard lock(mutex_);
    const std::lock_guard own(thread.mutex);
    hand_over(thread);
    thread.log_command = thread.group.command();
  }
  const std::lock_guard own(thread.mutex);
  close(thread, thread.log);
}

void Races::hand_over(ThreadGroup& thread) {
  if (thread.log.empty()) return;
  log_of(thread.log_command).take(thread.log);
  if (!thread.log.is_small()) thread.log = {};
}

void Races::close(ThreadGroup& thread, CommandLog& log) {
  Group& group = thread.group;
  const Told& program = group.program();
  if (!thread.shared_is_quiet && thread.tracked.alike() && group.shared_is_quiet())
    program.quiet.set(group.command(), !program.sites.alike_if_given);
  group.end(log);
}

void Races::settle(const void* owner, const ObservedCommand* but) {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, thread] : threads_) {
    const std::lock_guard own(thread->mutex);
    if (!thread->log.empty() && owner_of(thread->log_command) == owner) hand_over(*thread);
    const Group& group = thread->group;
    if (!group.is_open() || owner_of(group.command()) != owner) continue;
    if (but != nullptr && (group.command() == but || !group.program().compute())) continue;
    close(*thread, log_of(group.command()));
  }
  for (auto at = logs_.begin(); at != logs_.end();) {
    const bool other = owner_of(at->first) != owner || (but != nullptr && (at->first == but || !at->second->compute()));
    if (!other) {
      at->second->settle(pairs, at->first);
      if (at->second->is_small()) spare_ = std::move(at->second);
    }
    at = other ? std::next(at) : logs_.erase(at);
  }
}

class RaceWatch : public spirv::exec::Watch {
 public:
  /// Of a workgroup that has begun.
  RaceWatch(Races& races, ThreadGroup& thread, const Told& program, const Wave& wave, const Instruction* start)
      : races_(races), program_(program), thread_(thread) {
    program.compute() ? begin_compute(wave, start) : begin_draw(wave);
  }
  RaceWatch(const RaceWatch&) = delete;
  ~RaceWatch() override {
    if (!program_.compute()) races_.end(thread_);
  }
  /// One at a time of a thread, with every barrier a new one: its memory stays.
  static void* operator new(std::size_t size) {
    void* const kept = std::exchange(spare().memory, nullptr);
    return kept != nullptr ? kept : ::operator new(size);
  }
  static void operator delete(void* memory) {
    if (void* const other = std::exchange(spare().memory, memory)) ::operator delete(other);
  }

  void access(const Wave& wave, const Instruction* i, const InstructionNote& note) override {
    const auto index = static_cast<std::size_t>(i - wave.program->code.data());
    const race::Tracked& tracked = thread_.tracked;
    const std::uint32_t site = thread_.shared_is_quiet ? tracked.device_site(index) : tracked.site(index);
    if (site == race::Sites::kNone) return;
    if (tracked.shared_site(index) != race::Sites::kNone &&
        race::skip_shared(thread_.group, site, wave, i, note, first_))
      return;
    race::record_access(thread_.group, site, wave, i, note, names());
  }

  void probe(const Wave& wave, const spirv::ProbeOp& op) override {
    const spirv::Probe& probe = wave.program->probes[op.probe];
    if (probe.kind != spirv::Probe::Kind::kOrder) return;
    const base::LaneMask lanes = spirv::exec::lanes_at(wave, op) & wave.live;
    const spirv::MemoryOrder order = spirv::MemoryOrder::of(probe.number);
    if (lanes == 0) return;
    if (probe.opcode == kOpMemoryBarrier) {
      thread_.group.fence(number_, order, names(), lanes);
    } else if (probe.opcode != kOpControlBarrier) {
      thread_.group.interlock(probe.opcode == kOpBeginInterlock);
    } else if (order.execution == spirv::MemoryScope::kSubgroup) {
      if (program_.compute()) thread_.group.subgroup_barrier(order, first_);
    } else if (program_.compute()) {
      thread_.group.arrive(number_, order, !wave.program->has_barrier);
    }
  }

 private:
  void begin_compute(const Wave& wave, const Instruction* start) {
    number_ = wave.first_invocation / static_cast<std::uint32_t>(base::kWaveWidth);
    first_ = thread_.group.base() + wave.first_invocation;
    if (start != wave.program->code.data()) thread_.group.resume(number_);
  }

  race::WaveNames names() const { return {first_, program_.compute() ? nullptr : thread_.names}; }

  void begin_draw(const Wave& wave) {
    const spirv::exec::Invocations invocations(wave);
    std::ranges::fill(thread_.names, 0u);
    base::for_each_lane(wave.active, [&](std::size_t lane) {
      const auto id = invocations(wave, lane);
      thread_.names[lane] = id[0] | id[1] << 16;
    });
    if (program_.context.stage != VK_SHADER_STAGE_FRAGMENT_BIT && program_.context.stage != VK_SHADER_STAGE_VERTEX_BIT)
      for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) thread_.names[lane] = lane;
    races_.begin(thread_, program_, wave, {{}, wave.active != 0 ? thread_.names[std::countr_zero(wave.active)] : 0});
  }

  struct Spare {
    void* memory = nullptr;
    ~Spare() { ::operator delete(memory); }
  };
  static Spare& spare() { return base::per_thread<Spare>(); }

  Races& races_;
  const Told& program_;
  ThreadGroup& thread_;
  std::uint32_t first_ = 0, number_ = 0;  ///< the wave's first invocation; its number in the workgroup
};

/// VITRINE_RACE_SAMPLE: of how many workgroups one is watched.
std::uint32_t wanted_sample() {
  const char* const text = std::getenv("VITRINE_RACE_SAMPLE");
  std::uint32_t sample = 1;
  if (text == nullptr || *text == 0) return sample;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), sample);
  if (error == std::errc() && *end == 0 && sample != 0) return sample;
  complain("VITRINE_RACE_SAMPLE: '" + std::string(text) + "' is no number from 1 on");
  return 1;
}

class RacedProgram : public ProgramTool {
 public:
  RacedProgram(Races& races, const Told& told, std::uint32_t sample) : races_(races), told_(told), sample_(sample) {}
  bool in_order() const override { return told_.sites.orders_device; }
  std::unique_ptr<spirv::exec::Watch> watch(const Wave& wave, const Instruction* start) override {
    if (told_.sites.all.empty() || !is_watched(wave)) return nullptr;
    ThreadGroup& thread = races_.here();
    if (told_.compute()) {
      if (start == wave.program->code.data() && wave.first_invocation == 0) races_.begin_compute(thread, told_, wave);
      if (thread.idle) return nullptr;
    }
    return std::make_unique<RaceWatch>(races_, thread, told_, wave, start);
  }

 private:
  /// Whoever may order workgroups is watched in all of them: an order that is not seen looks like a race.
  bool is_watched(const Wave& wave) const {
    if (sample_ == 1 || !told_.compute() || told_.sites.orders_device) return true;
    return (wave.workgroup_id[0] + wave.workgroup_id[1] + wave.workgroup_id[2]) % sample_ == 0;
  }

  Races& races_;
  const Told& told_;
  const std::uint32_t sample_;
};

class RaceTool : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {.accesses = true, .order = true}; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    const std::lock_guard lock(mutex_);
    programs_.push_back(std::make_unique<Told>(shader, program));
    return std::make_shared<RacedProgram>(races_, *programs_.back(), sample_);
  }
  void commands_done(const void* owner) override { races_.settle(owner, nullptr); }
  std::vector<Finding> take_findings() override {
    races_.settle(nullptr, nullptr);  // of programs that no device runs
    return races_.pairs.take();
  }

 private:
  const std::uint32_t sample_ = wanted_sample();
  std::mutex mutex_;
  std::vector<std::unique_ptr<Told>> programs_;
  Races races_;
};

}  // namespace

std::unique_ptr<Tool> make_race() { return std::make_unique<RaceTool>(); }

}  // namespace vitrine::glass
