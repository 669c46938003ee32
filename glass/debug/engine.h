// The debugger's engine: one wave runs at a time; it is told of every line and every value, decides whether to stop,
// and then asks its face what to do. A thread that is stopped waits in the face; so does whoever waits for the command.
#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "glass/debug/breakpoint.h"
#include "glass/debug/command_watch.h"
#include "glass/debug/exceptions.h"
#include "glass/debug/frame.h"
#include "glass/debug/history.h"
#include "glass/debug/placed.h"
#include "glass/debug/stores.h"
#include "glass/finding.h"

namespace vitrine::glass::debug {

class Engine;

struct Stop {
  enum class Reason : std::uint8_t {
    kStart,  ///< nothing has run
    kStep,
    kBreakpoint,
    kBreak,    ///< NonSemantic.DebugBreak
    kWatch,    ///< a watched value has changed
    kEnd,      ///< the invocation has ended
    kHistory,  ///< what was before is not known any more
    kPause,
    kException,  ///< something that is caught has happened
  } reason = Reason::kStart;
  int number = 0;    ///< of the breakpoint or watch
  std::string text;  ///< for people
};

/// Who tells the engine what to do.
class Face {
 public:
  virtual ~Face() = default;
  /// The running thread has stopped; returns when it is to go on. `lock`: holds the engine, released while waiting.
  virtual void stopped(Engine& engine, const Stop& stop, std::unique_lock<std::mutex>& lock) = 0;
  /// A log point says something.
  virtual void output(const std::string& text) = 0;
};

/// A value that is watched: cells of one invocation, or memory.
struct Watchpoint {
  int number = 0;
  std::string text, owner;  ///< who has set it: requests replace their own
  std::shared_ptr<const Subject> subject;
  std::array<std::uint32_t, 3> id{};
  std::uint32_t cell = 0, count = 0;
  std::optional<Place> place;       ///< of memory, in any invocation
  std::vector<MemoryRange> memory;  ///< where that is for the run that began last
  std::string value;                ///< what it held when it was looked at last
  std::vector<std::byte> held;      ///< the same, bytes, when a run left it; empty: nobody knows
  std::vector<std::byte> written;   ///< the same, as the last command left it that wrote there since; empty: none has
  std::string writer;               ///< that command, in words
  std::uint64_t submission = 0;     ///< in which `memory` is there
  bool is_memory() const { return place.has_value(); }
};

/// How to go on.
struct Motion {
  enum class Kind : std::uint8_t { kContinue, kStep, kNext, kFinish, kDetach } kind = Kind::kContinue;
  bool backward = false;
};

/// Whom the person looks at.
struct Focus {
  std::shared_ptr<Run> run;  ///< null: nothing has begun
  std::size_t lane = 0;
  std::size_t frame = 0;
};

class Engine : public CommandWatch {
 public:
  explicit Engine(Face& face) : face_(face) {}

  // ---- the threads that run shaders
  /// Before anything runs: the face may set breakpoints.
  void start();
  /// A shader that may run from now on.
  void know(std::shared_ptr<const Subject> subject);
  /// A run of a wave: whether it is watched. Then nothing else runs until leave().
  std::shared_ptr<Run> enter(const std::shared_ptr<const Subject>& subject, const spirv::Wave& wave, bool begins);
  void came_by(Run& run, const spirv::Wave& wave, const spirv::ProbeOp& op);
  /// An instruction is about to write memory, perhaps: what it writes goes into `log`, too.
  void writes(Run& run, const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note,
              StoreLog& log);
  /// Where a rehearsal keeps what it writes, while it runs; null: none does.
  void rehearses(StoreLog* stores) { stores_ = stores; }
  /// What tools have found in the run that goes on (null: in a command that is done).
  void found(const std::shared_ptr<Run>& run, const std::vector<Finding>& findings);
  /// Something that the person should know.
  void say(const std::string& text);
  /// The wave has ended, if it does not wait for others.
  void ended(const std::shared_ptr<Run>& run, const spirv::Wave& wave, bool waits);
  void leave(const std::shared_ptr<Run>& run);
  void wrote(const std::byte* first, std::uint64_t size, const Address& command) override;
  /// Work of commands is done: what is watched may have been changed by others than shaders.
  void commands_done();
  /// The wave itself has done otherwise than its rehearsal did.
  void differs(const Run& run, const StoreLog::Difference& difference);

  // ---- the face, with the engine held
  std::mutex& mutex() { return mutex_; }
  int add(Breakpoint breakpoint);
  bool remove(int number);
  int watch(Watchpoint watchpoint);
  /// Gives a variable, memory or a texel other values (placed_numbers()) in the lane in focus. Not empty: why that
  /// cannot be.
  std::string change(const Place& place, std::size_t lane, const std::vector<PlacedScalar>& numbers);
  const std::map<int, Breakpoint>& breakpoints() const { return breakpoints_; }
  const std::map<int, Watchpoint>& watchpoints() const { return watchpoints_; }
  /// Bits of Catch: what stops a shader besides. NaNs are seen in shaders that are made from then on.
  void set_catches(unsigned catches) { catches_ = catches; }
  unsigned catches() const { return catches_; }
  /// Stops at the next line of anything.
  void pause() { pausing_ = true; }
  /// What the stopped thread does next.
  void go(const Motion& motion);
  bool going() const { return going_; }
  bool detached() const { return detached_; }
  Focus& focus() { return focus_; }
  const History& history() const { return history_; }
  const std::vector<std::shared_ptr<const Subject>>& subjects() const { return subjects_; }
  /// How to look at the variables of a run.
  Viewer view(const Run& run, std::size_t lane) const;
  /// The wave that runs; null: none does.
  const Run* live() const { return live_.get(); }
  /// Whether stores are recorded: not of shaders that are shown as they always run.
  bool records_stores() const { return stores_ != nullptr; }

 private:
  using Lanes = base::LaneMask;

  void note_reset(Run& run);
  bool is_wanted(const std::shared_ptr<const Subject>& subject, const spirv::Wave& wave, const Run* known);
  const std::map<std::uint32_t, std::vector<int>>& stops_of(const Subject& subject);
  std::optional<Stop> check(const std::shared_ptr<Run>& run, const Run::Entry& entry, bool live);
  std::optional<Stop> check_step(const std::shared_ptr<Run>& run, const Run::Entry& entry, bool live);
  std::optional<Stop> check_breakpoints(const std::shared_ptr<Run>& run, const Run::Entry& entry, Lanes lanes,
                                        bool live);
  std::optional<Stop> check_watches(const std::shared_ptr<Run>& run, const Run::Entry& entry);
  std::optional<Stop> check_memory(const std::shared_ptr<Run>& run, const Run::Entry& entry);
  void settle_stores(std::unique_lock<std::mutex>& lock);
  void aim_watches(const Run& run);
  void hold_watches(const Run& run);
  std::optional<Stop> changed_by_others(std::uint64_t submission);
  std::string change_by_others(Watchpoint& watchpoint, const std::vector<std::byte>& now);
  std::string change_cells(std::size_t lane, const std::vector<PlacedScalar>& numbers);
  std::string change_memory(std::size_t lane, const std::vector<PlacedScalar>& numbers);
  std::string change_texel(const Place& place, std::size_t lane, const std::vector<PlacedScalar>& numbers);
  /// Other bytes of memory.
  struct Patch {
    MemoryRange at;
    std::array<std::byte, 16> bytes{};
  };
  void change_bytes(std::size_t lane, const std::vector<Patch>& patches);
  bool go_back_to(const Finding& finding);
  std::optional<Stop> check_exceptions(const std::shared_ptr<Run>& run, const spirv::Wave& wave,
                                       const spirv::ProbeOp& op);
  bool hits(Breakpoint& breakpoint, const Viewer& viewer, const Names& names, bool live);
  bool reaches_goal(const Run& run, const Run::Entry& entry, Lanes fresh) const;
  void halt(Stop stop, std::unique_lock<std::mutex>& lock);
  std::optional<Stop> travel();
  Stop travel_back(bool from_end);
  void look_at(const std::shared_ptr<Run>& run, std::size_t lane);

  Face& face_;
  std::mutex mutex_;
  std::mutex turn_;  ///< of the wave that runs
  std::map<int, Breakpoint> breakpoints_;
  std::map<int, Watchpoint> watchpoints_;
  int last_number_ = 0;
  std::map<const Subject*, std::map<std::uint32_t, std::vector<int>>>
      stops_;                                                             ///< by probe, for the breakpoints as they are
  std::unordered_map<const spirv::Wave*, std::shared_ptr<Run>> waiting_;  ///< at barriers
  std::vector<std::shared_ptr<const Subject>> subjects_;                  ///< of all shaders so far
  History history_;
  std::shared_ptr<Run> live_;
  const spirv::Wave* wave_ = nullptr;   ///< the same, while a thread is in came_by() or writes()
  StoreLog* stores_ = nullptr;          ///< of a rehearsal
  std::optional<Stop> from_others_;     ///< to be told at the next line
  bool unsettled_ = false;              ///< the last entry is of stores that were about to be done
  std::vector<std::byte> shared_;       ///< what the memory of the last workgroup held when its wave stopped
  std::set<const Subject*> differing_;  ///< those of which it has been said
  Focus focus_;
  Motion motion_;
  std::uint32_t goal_depth_ = 0;
  std::atomic<unsigned> catches_ = 0;  ///< shaders are made while others wait
  bool going_ = true, detached_ = false, pausing_ = false;
};

}  // namespace vitrine::glass::debug
