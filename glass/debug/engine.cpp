// See engine.h.
#include "glass/debug/engine.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "base/numeric.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::debug {
namespace {

using spirv::StepKind;

StepKind kind_of(const Run& run, const Run::Entry& entry) {
  return static_cast<StepKind>(run.subject->probes[entry.probe].number);
}

/// What a log point says: expressions in braces are replaced by their values.
std::string message_of(const std::string& text, const Viewer& viewer, const Names& names) {
  std::string message;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find('{', at), close = text.find('}', open);
    if (open == std::string::npos || close == std::string::npos) return message += text.substr(at);
    message += text.substr(at, open - at);
    const auto value = evaluate(std::string_view(text).substr(open + 1, close - open - 1), viewer, names);
    message += value ? to_text(viewer, value.value()) : '<' + value.message() + ">";
    at = close + 1;
  }
  return message;
}

/// Looks each name up once: for many lanes that are at one place.
class KnownNames : public Names {
 public:
  explicit KnownNames(const Names& names) : names_(names) {}
  std::optional<Place> find(std::string_view name) const override {
    for (const auto& [known, place] : known_)
      if (known == name) return place;
    return known_.emplace_back(name, names_.find(name)).second;
  }

 private:
  const Names& names_;
  mutable std::vector<std::pair<std::string, std::optional<Place>>> known_;
};

std::size_t first_lane(base::LaneMask lanes) { return static_cast<std::size_t>(__builtin_ctzll(lanes)); }

}  // namespace

void Engine::know(std::shared_ptr<const Subject> subject) {
  const std::unique_lock lock(mutex_);
  subjects_.push_back(std::move(subject));
}

void Engine::start() {
  std::unique_lock lock(mutex_);
  going_ = false;
  face_.stopped(*this, {}, lock);
}

Viewer Engine::view(const Run& run, std::size_t lane) const {
  const bool same =
      live_ && (&run == live_.get() || (run.resources == live_->resources && run.shared == live_->shared &&
                                        run.submission == live_->submission && run.command == live_->command));
  return {&run, lane, same};
}

int Engine::add(Breakpoint breakpoint) {
  breakpoint.number = ++last_number_;
  breakpoints_[last_number_] = std::move(breakpoint);
  stops_.clear();
  return last_number_;
}

bool Engine::remove(int number) {
  stops_.clear();
  return breakpoints_.erase(number) + watchpoints_.erase(number) != 0;
}

int Engine::watch(Watchpoint watchpoint) {
  watchpoint.number = ++last_number_;
  watchpoints_[last_number_] = std::move(watchpoint);
  if (live_) hold_watches(*live_);
  return last_number_;
}

void Engine::go(const Motion& motion) {
  motion_ = motion;
  going_ = true;
  if (motion.kind == Motion::Kind::kDetach) {
    detached_ = true;
    breakpoints_.clear();
    watchpoints_.clear();
    catches_ = 0;
    stops_.clear();
  }
  if (!focus_.run) return;
  const std::uint32_t at = focus_.run->at(focus_.lane);
  goal_depth_ = at == kNoProbe ? 0 : focus_.run->subject->depth(at);
}

const std::map<std::uint32_t, std::vector<int>>& Engine::stops_of(const Subject& subject) {
  const auto [at, added] = stops_.try_emplace(&subject);
  if (!added) return at->second;
  for (const auto& [number, breakpoint] : breakpoints_)
    for (const std::uint32_t step : steps_of(breakpoint, subject)) at->second[step].push_back(number);
  return at->second;
}

bool Engine::is_wanted(const std::shared_ptr<const Subject>& subject, const spirv::Wave& wave, const Run* known) {
  if (detached_) return false;
  const bool steps = motion_.kind != Motion::Kind::kContinue && focus_.run;
  if (known != nullptr || pausing_ || steps || (catches_ & kCatchFinding) != 0) return true;
  for (const auto& [number, watchpoint] : watchpoints_)
    if (watchpoint.is_memory() || watchpoint.subject == subject) return true;
  if (!stops_of(*subject).empty() || may_raise(*subject, catches_)) return true;
  for (const spirv::Probe& probe : subject->probes)
    if (probe.kind == spirv::Probe::Kind::kStep && probe.number == static_cast<std::uint32_t>(StepKind::kBreak))
      return true;
  std::vector<const Breakpoint*> beginnings;
  for (const auto& [number, breakpoint] : breakpoints_)
    if (is_about_beginning(breakpoint)) beginnings.push_back(&breakpoint);
  if (beginnings.empty()) return false;
  const Run probe(subject, wave);
  bool any = false;
  base::for_each_lane(probe.launched, [&](std::size_t lane) {
    for (const Breakpoint* breakpoint : beginnings) any |= begins(*breakpoint, probe, lane);
  });
  return any;
}

std::shared_ptr<Run> Engine::enter(const std::shared_ptr<const Subject>& subject, const spirv::Wave& wave,
                                   bool begins) {
  std::unique_lock lock(mutex_);
  if (begins) waiting_.erase(&wave);
  const auto known = waiting_.find(&wave);
  if (!is_wanted(subject, wave, known == waiting_.end() ? nullptr : known->second.get())) return nullptr;
  std::shared_ptr<Run> run = known == waiting_.end() ? nullptr : known->second;
  // Behind a barrier, of a wave that was not watched before it: what its invocations are is not known any more.
  if (!run && !begins) return nullptr;
  lock.unlock();
  turn_.lock();
  lock.lock();
  if (detached_) return turn_.unlock(), nullptr;
  if (!run) run = std::make_shared<Run>(subject, wave);
  live_ = run;
  history_.enter(run);
  note_reset(*run);
  aim_watches(*run);
  from_others_ = changed_by_others(run->submission);
  hold_watches(*run);
  return run;
}

/// Between workgroups their memory has been reset: nobody but this tells.
void Engine::note_reset(Run& run) {
  if (run.shared == nullptr || run.subject->context.stage != VK_SHADER_STAGE_COMPUTE_BIT) return;
  if (shared_.size() != run.shared_size || std::equal(shared_.begin(), shared_.end(), run.shared)) return;
  run.begin_stores(0);
  run.add_store({run.shared, run.shared_size, kNoLane, 1}, shared_.data());
  history_.grown();
}

namespace {

/// Nobody knows what it held.
void forget(Watchpoint& watchpoint) {
  watchpoint.held.clear();
  watchpoint.written.clear();
}

/// It holds this now, and that is known to whoever looks at it.
void hold(Watchpoint& watchpoint, std::vector<std::byte> now) {
  watchpoint.held = std::move(now);
  watchpoint.written.clear();
}

}  // namespace

/// Memory that is named by a variable lies somewhere else for every set of resources.
void Engine::aim_watches(const Run& run) {
  for (auto& [number, watchpoint] : watchpoints_) {
    if (!watchpoint.is_memory() || watchpoint.subject != run.subject) continue;
    std::vector<MemoryRange> memory = memory_of_place(view(run, 0), *watchpoint.place);
    if (memory != watchpoint.memory) forget(watchpoint);
    watchpoint.memory = std::move(memory);
    watchpoint.submission = run.submission;
  }
}

namespace {

std::vector<std::byte> bytes_of(const Watchpoint& watchpoint) {
  std::vector<std::byte> bytes;
  for (const MemoryRange& range : watchpoint.memory) bytes.insert(bytes.end(), range.at, range.at + range.bytes);
  return bytes;
}

/// Shared memory is the workgroup's: between two of them it means nothing.
bool lasts(const Watchpoint& watchpoint) {
  return watchpoint.is_memory() && watchpoint.place->variable->memory != spirv::SourceVariable::Memory::kShared;
}

}  // namespace

/// What has been freed is not looked at: while a submission runs, all that it uses is there.
void Engine::hold_watches(const Run& run) {
  for (auto& [number, watchpoint] : watchpoints_) {
    if (!lasts(watchpoint) || watchpoint.submission != run.submission) continue;
    std::vector<std::byte> now = bytes_of(watchpoint);
    if (now != watchpoint.held && watchpoint.subject == run.subject)
      watchpoint.value = to_text(view(run, 0), {watchpoint.place, {}});
    hold(watchpoint, std::move(now));
  }
}

/// In words, of a watch of which it is known.
std::string Engine::change_by_others(Watchpoint& watchpoint, const std::vector<std::byte>& now) {
  std::string text = "watch " + std::to_string(watchpoint.number) + ": " + watchpoint.text + " has changed";
  if (live_ && watchpoint.subject == live_->subject) {
    const std::string before = std::exchange(watchpoint.value, to_text(view(*live_, 0), {watchpoint.place, {}}));
    text.append(": ").append(before).append(" -> ").append(watchpoint.value);
  }
  if (now == watchpoint.written) return text.append(", by ").append(watchpoint.writer);
  return text.append(", by no shader: by a command, the host or what was drawn");
}

std::optional<Stop> Engine::changed_by_others(std::uint64_t submission) {
  std::optional<Stop> stop;
  for (auto& [number, watchpoint] : watchpoints_) {
    if (!lasts(watchpoint) || watchpoint.submission != submission || watchpoint.held.empty()) continue;
    std::vector<std::byte> now = bytes_of(watchpoint);
    if (now != watchpoint.held) {
      const std::string text = change_by_others(watchpoint, now);
      if (stop)
        stop->text.append("\n").append(text);
      else
        stop = Stop{Stop::Reason::kWatch, number, text};
    }
    hold(watchpoint, std::move(now));
  }
  return stop;
}

/// Only what the command has written is looked at: that is there, whatever has become of the rest.
void Engine::wrote(const std::byte* first, std::uint64_t size, const Address& command) {
  const std::unique_lock lock(mutex_);
  const std::byte* const end = first + size;
  for (auto& [number, watchpoint] : watchpoints_) {
    if (!lasts(watchpoint) || watchpoint.held.empty()) continue;
    std::vector<std::byte> now = watchpoint.written.empty() ? watchpoint.held : watchpoint.written;
    const std::vector<std::byte> before = now;
    std::size_t at = 0;
    for (const MemoryRange& range : watchpoint.memory) {
      const std::byte* const from = std::max<const std::byte*>(range.at, first);
      const std::byte* const to = std::min<const std::byte*>(range.at + range.bytes, end);
      if (from < to) std::copy(from, to, now.begin() + static_cast<std::ptrdiff_t>(at) + (from - range.at));
      at += range.bytes;
    }
    if (now == before) continue;
    watchpoint.written = std::move(now);
    watchpoint.writer = to_text(command);
  }
}

void Engine::commands_done() {
  std::unique_lock lock(mutex_);
  if (detached_ || live_ || history_.empty()) return;
  if (auto stop = changed_by_others(history_.running()->submission)) halt(std::move(*stop), lock);
}

void Engine::writes(Run& run, const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note,
                    StoreLog& log) {
  bool any = false;
  for_each_written(wave, i, note, [&](const Written& written) {
    if (!std::exchange(any, true)) {
      std::unique_lock lock(mutex_);
      wave_ = &wave;
      settle_stores(lock);
      run.begin_stores(note.origin.place);
    }
    log.keep(written.at, written.bytes);
    run.add_store(written);
  });
  if (!any) return;
  const std::unique_lock lock(mutex_);
  history_.grown();
  unsettled_ = !watchpoints_.empty();
}

/// Stores are recorded before they are done: whether they have changed something is known when the next thing happens.
void Engine::settle_stores(std::unique_lock<std::mutex>& lock) {
  if (!std::exchange(unsettled_, false) || detached_ || !live_ || live_->size() == 0) return;
  const std::shared_ptr<Run> live = live_;
  if (auto stop = check_memory(live, live->entry(live->size() - 1))) halt(std::move(*stop), lock);
}

void Engine::ended(const std::shared_ptr<Run>& run, const spirv::Wave& wave, bool waits) {
  std::unique_lock lock(mutex_);
  wave_ = nullptr;
  settle_stores(lock);
  if (waits) {
    waiting_[&wave] = run;
  } else {
    waiting_.erase(&wave);
    if (!detached_ && focus_.run == run && motion_.kind != Motion::Kind::kContinue)
      halt({Stop::Reason::kEnd, 0, invocation_text(*run, focus_.lane) + " has ended"}, lock), motion_ = {};
  }
}

void Engine::leave(const std::shared_ptr<Run>& run) {
  const std::unique_lock lock(mutex_);
  hold_watches(*run);
  shared_.assign(run->shared, run->shared + (run->shared == nullptr ? 0 : run->shared_size));
  live_ = nullptr;
  turn_.unlock();
}

void Engine::differs(const Run& run, const StoreLog::Difference& difference) {
  const std::unique_lock lock(mutex_);
  if (detached_ || !differing_.insert(run.subject.get()).second) return;
  const auto text = [](std::uint32_t bits) {
    char number[64];
    std::snprintf(number, sizeof(number), "0x%08x (%.9g)", bits, static_cast<double>(base::float_of(bits)));
    return std::string(number);
  };
  face_.output("note: " + run.subject->context.entry_point + " as it always runs computes " + text(difference.there) +
               " where what is shown computes " + text(difference.kept) + ", in " + std::to_string(difference.words) +
               " words of the wave of " + invocation_text(run, first_lane(run.launched)) +
               "; `vitrine debug --exact` shows the former");
}

void Engine::came_by(Run& run, const spirv::Wave& wave, const spirv::ProbeOp& op) {
  std::unique_lock lock(mutex_);
  if (detached_) return;
  wave_ = &wave;
  settle_stores(lock);
  if (auto stop = std::exchange(from_others_, std::nullopt); stop && !detached_) {
    look_at(live_, first_lane(run.launched));
    halt(std::move(*stop), lock);
  }
  if (detached_) return;
  const spirv::Probe::Kind kind = run.subject->probes[op.probe].kind;
  if (kind != spirv::Probe::Kind::kStep && kind != spirv::Probe::Kind::kAssign) {
    if (auto stop = check_exceptions(live_, wave, op)) halt(std::move(*stop), lock);
    return;
  }
  const base::LaneMask lanes = spirv::exec::lanes_at(wave, op) & run.launched;
  if (lanes == 0) return;
  run.record(wave, op, lanes);
  const std::shared_ptr<Run> live = live_;
  std::optional<Stop> stop = check(live, run.entry(run.size() - 1), true);
  history_.grown();
  if (stop) halt(std::move(*stop), lock);
}

void Engine::look_at(const std::shared_ptr<Run>& run, std::size_t lane) { focus_ = {run, lane, 0}; }

std::optional<Stop> Engine::check(const std::shared_ptr<Run>& run, const Run::Entry& entry, bool live) {
  if (entry.probe == kStores) return check_memory(run, entry);
  return run->steps(entry) ? check_step(run, entry, live) : check_watches(run, entry);
}

std::optional<Stop> Engine::check_step(const std::shared_ptr<Run>& run, const Run::Entry& entry, bool live) {
  const StepKind kind = kind_of(*run, entry);
  const Lanes fresh = run->fresh_lanes(entry), seen = entry.lanes & ~run->helpers;
  if (kind == StepKind::kBreak && seen != 0) {
    if (focus_.run != run || (seen >> focus_.lane & 1) == 0) look_at(run, first_lane(seen));
    return Stop{Stop::Reason::kBreak, 0, "DebugBreak"};
  }
  if (kind == StepKind::kLine) {
    if (auto stop = check_breakpoints(run, entry, fresh & seen, live)) return stop;
    if (pausing_ && seen != 0) {
      pausing_ = false;
      look_at(run, first_lane(seen));
      return Stop{Stop::Reason::kPause, 0, "paused"};
    }
  }
  if (!reaches_goal(*run, entry, fresh)) return std::nullopt;
  focus_.frame = 0;
  return Stop{Stop::Reason::kStep, 0, ""};
}

bool Engine::reaches_goal(const Run& run, const Run::Entry& entry, Lanes fresh) const {
  if (motion_.kind == Motion::Kind::kContinue || focus_.run.get() != &run) return false;
  if ((entry.lanes >> focus_.lane & 1) == 0 || (fresh >> focus_.lane & 1) == 0) return false;
  const std::uint32_t depth = run.subject->depth(entry.probe);
  const StepKind kind = kind_of(run, entry);
  switch (motion_.kind) {
    case Motion::Kind::kFinish:
      return depth < goal_depth_;
    case Motion::Kind::kNext:
      return kind == StepKind::kLine && depth <= goal_depth_;
    default:
      return kind == StepKind::kLine;
  }
}

bool Engine::hits(Breakpoint& breakpoint, const Viewer& viewer, const Names& names, bool live) {
  if (!breakpoint.condition.empty()) {
    if (!breakpoint.read_condition) breakpoint.read_condition = Expression::read(breakpoint.condition);
    if (!*breakpoint.read_condition) return false;
    const auto value = breakpoint.read_condition->value().evaluate(viewer, names);
    if (!value) return false;
    const std::vector<Scalar> numbers =
        value.value().place ? numbers_of(viewer, *value.value().place) : value.value().scalars;
    if (numbers.empty() || !to_bool(numbers[0])) return false;
  }
  if (live) {
    ++breakpoint.hits;
    if (!wants_hit(breakpoint)) return false;
  }
  if (breakpoint.message.empty()) return true;
  if (live) face_.output(message_of(breakpoint.message, viewer, names));
  return false;
}

std::optional<Stop> Engine::check_breakpoints(const std::shared_ptr<Run>& run, const Run::Entry& entry, Lanes lanes,
                                              bool live) {
  const auto& stops = stops_of(*run->subject);
  const auto here = stops.find(entry.probe);
  const bool any_begins =
      std::ranges::any_of(breakpoints_, [](const auto& row) { return is_about_beginning(row.second); });
  if (lanes == 0 || (here == stops.end() && !any_begins)) return std::nullopt;
  // All lanes have come to the same place by the same calls.
  const std::vector<CodeFrame> frames = frames_at(*run, first_lane(lanes));
  const FrameNames frame_names(*run, frames.empty() ? nullptr : frames.data());
  const KnownNames names(frame_names);
  int number = 0;
  std::size_t where = 0;
  const auto consider = [&](Breakpoint& breakpoint, std::size_t lane) {
    if (!hits(breakpoint, view(*run, lane), names, live) || number != 0) return;
    number = breakpoint.number;
    where = lane;
  };
  base::for_each_lane(lanes, [&](std::size_t lane) {
    if (here != stops.end())
      for (const int one : here->second) consider(breakpoints_.at(one), lane);
    if (!any_begins || !run->is_first(entry, lane)) return;
    for (auto& [one, breakpoint] : breakpoints_)
      if (begins(breakpoint, *run, lane)) consider(breakpoint, lane);
  });
  if (number == 0) return std::nullopt;
  look_at(run, where);
  Stop stop{Stop::Reason::kBreakpoint, number, "breakpoint " + std::to_string(number)};
  if (breakpoints_.at(number).once) remove(number);
  return stop;
}

/// They are not in the record: going back does not stop at them.
std::optional<Stop> Engine::check_exceptions(const std::shared_ptr<Run>& run, const spirv::Wave& wave,
                                             const spirv::ProbeOp& op) {
  if (catches_ == 0) return std::nullopt;
  const base::LaneMask lanes = spirv::exec::lanes_at(wave, op) & run->launched & ~run->helpers;
  const std::size_t preferred = focus_.run == run ? focus_.lane : first_lane(run->launched);
  auto raised = raised_at(run->subject->probes[op.probe], wave, op, lanes, preferred, catches_);
  if (!raised) return std::nullopt;
  look_at(run, raised->lane);
  return Stop{Stop::Reason::kException, 0, std::move(raised->text)};
}

std::optional<Stop> Engine::check_watches(const std::shared_ptr<Run>& run, const Run::Entry& entry) {
  for (const auto& [number, row] : watchpoints_) {
    const Watchpoint& watchpoint = row;
    if (watchpoint.is_memory() || watchpoint.subject != run->subject) continue;
    std::optional<std::size_t> found;
    base::for_each_lane(entry.lanes, [&](std::size_t lane) {
      if (run->id[lane] == watchpoint.id && run->assigns(entry, lane, watchpoint.cell, watchpoint.count, false))
        found = lane;
    });
    if (!found) continue;
    look_at(run, *found);
    return Stop{Stop::Reason::kWatch, number,
                "watch " + std::to_string(number) + ": " + watchpoint.text + " has changed"};
  }
  return std::nullopt;
}

std::optional<Stop> Engine::check_memory(const std::shared_ptr<Run>& run, const Run::Entry& entry) {
  for (auto& [number, watchpoint] : watchpoints_) {
    if (!watchpoint.is_memory()) continue;
    const auto store = run->store_to(entry, watchpoint.memory, *history_.running());
    if (!store || !store->changed || store->lane == kNoLane) continue;
    look_at(run, store->lane);
    std::string text = "watch " + std::to_string(number) + ": " + watchpoint.text + " has changed";
    if (watchpoint.subject == run->subject) {
      const std::string before =
          std::exchange(watchpoint.value, to_text(view(*run, store->lane), {watchpoint.place, {}}));
      if (before != watchpoint.value) text.append(": ").append(before).append(" -> ").append(watchpoint.value);
    }
    return Stop{Stop::Reason::kWatch, number, std::move(text)};
  }
  return std::nullopt;
}

void Engine::say(const std::string& text) {
  const std::unique_lock lock(mutex_);
  if (!detached_) face_.output(text);
}

/// To where the invocation of a finding came to its line last, if that is recorded.
bool Engine::go_back_to(const Finding& finding) {
  const Address& address = finding.address;
  const auto is_there = [&](const Run& run, const Run::Entry& entry, std::size_t lane) {
    if ((entry.lanes >> lane & 1) == 0 || run.id[lane] != address.invocation.id) return false;
    const spirv::SourcePlace& place = run.subject->place(entry.probe);
    return address.frames.empty() || place.line == address.frames[0].line;
  };
  std::size_t steps = 0;
  std::size_t found_lane = 0;
  std::shared_ptr<Run> found;
  history_.for_each_back([&](const std::shared_ptr<Run>& run, const Run::Entry& entry) {
    ++steps;
    if (!run->steps(entry) || run->subject->context.stage != address.stage) return true;
    base::for_each_lane(run->launched, [&](std::size_t lane) {
      if (!found && is_there(*run, entry, lane)) found = run, found_lane = lane;
    });
    return !found;
  });
  if (!found) return false;
  for (; steps > 1; --steps) history_.backward();
  look_at(found, found_lane);
  return true;
}

void Engine::found(const std::shared_ptr<Run>& run, const std::vector<Finding>& findings) {
  std::unique_lock lock(mutex_);
  for (const Finding& finding : findings) {
    if (detached_ || (catches_ & kCatchFinding) == 0) return;
    const bool live = run != nullptr;
    if (!live && !history_.empty()) history_.running()->shared_gone = true;
    const std::string said = finding_text(finding);
    if (!go_back_to(finding) && live) look_at(run, first_lane(run->launched));
    halt({Stop::Reason::kException, 0, said}, lock);
  }
}

/// Asks the face until it wants the shader itself to go on.
void Engine::halt(Stop stop, std::unique_lock<std::mutex>& lock) {
  for (;;) {
    going_ = false;
    face_.stopped(*this, stop, lock);
    if (motion_.kind == Motion::Kind::kDetach) {
      while (history_.forward()) continue;
      return;
    }
    if (motion_.backward) {
      stop = travel_back(stop.reason == Stop::Reason::kEnd);
      continue;
    }
    std::optional<Stop> reached = travel();
    if (!reached) return;
    stop = std::move(*reached);
  }
}

/// Forward through what has been taken back; nothing: that is all.
std::optional<Stop> Engine::travel() {
  while (history_.forward()) {
    const History::Done done = history_.done();
    if (auto stop = check(done.run, *done.entry, false)) return stop;
  }
  return std::nullopt;
}

/// `from_end`: the last entry is one to stop at.
Stop Engine::travel_back(bool from_end) {
  while (std::exchange(from_end, false) || history_.backward()) {
    const History::Done done = history_.done();
    if (done.entry == nullptr) break;
    if (auto stop = check(done.run, *done.entry, false)) return std::move(*stop);
  }
  return {Stop::Reason::kHistory, 0, "what was before is not recorded"};
}

}  // namespace vitrine::glass::debug
