// See hazards.h.
#include "glass/sync/hazards.h"

#include <algorithm>
#include <utility>

#include "glass/sync/clash.h"

namespace vitrine::glass::sync {
namespace {

/// Pieces of memory that are kept before what is done with is dropped.
constexpr std::size_t kPrune = 4096;
/// Dependencies for ranges that are kept of a write: the last ones.
constexpr std::size_t kMostPassages = 8;
/// Signals of a timeline that are kept apart.
constexpr std::size_t kMostSignals = 64;

PastWrite past_write(const State& state) { return {state.write.use, state.write.tag, state.passages}; }

bool same_pass(const Past& a, const Past& b) { return a.pass != 0 && a.pass == b.pass; }

/// A clock of all that happened up to a tag.
Clock everything_until(Tag tag) {
  Clock clock;
  clock.done.fill(tag);
  clock.available.fill(tag);
  return clock;
}

}  // namespace

void Hazards::touch(Tag tag, Touch touch) {
  const std::lock_guard lock(mutex_);
  if (!touch.ranges.empty() || !touch.alternatives.empty()) pending_[tag].push_back(std::move(touch));
}

void Hazards::settle() {
  const std::lock_guard lock(mutex_);
  settle_locked();
}

void Hazards::settle_locked() {
  for (auto& [tag, touches] : pending_) {
    // What a command reads, it reads of what was there before it.
    std::stable_partition(touches.begin(), touches.end(), [](const Touch& t) { return !writes(t.use.access); });
    for (const Touch& touch : touches) apply(tag, touch);
  }
  pending_.clear();
}

void Hazards::apply(Tag tag, const Touch& touch) {
  const Past access{touch.use, tag, touch.pass, touch.who, touch.several};
  if (!touch.alternatives.empty()) apply_alternatives(access, touch);
  for (const Range& range : touch.ranges) {
    records_.update(range, [&](const Range& bytes, State& state) {
      check(bytes, state, access, touch.since);
      if (writes(access.use.access)) {
        state = {access, {}, {}};
        return;
      }
      const auto same = std::ranges::find_if(state.reads, [&](const Past& read) { return read.use == access.use; });
      if (same == state.reads.end())
        state.reads.push_back(access);
      else
        *same = access;
    });
  }
}

/// Whichever it is, it clashes: the first one is told. Nobody is taken to have read any of them.
void Hazards::apply_alternatives(const Past& access, const Touch& touch) {
  std::optional<std::pair<Range, State>> first;
  for (const std::vector<Range>& ranges : touch.alternatives) {
    bool clashes = false;
    for (const Range& range : ranges) {
      records_.look(range, [&](const Range& bytes, const State& state) {
        if (clashes || is_done(state.write) || state.write.tag == access.tag) return;
        clashes = order_.standing(past_write(state), access.use) != Standing::kVisible;
        if (clashes && !first) first.emplace(bytes, state);
      });
      if (clashes) break;
    }
    if (!clashes) return;
  }
  if (first) check(first->first, first->second, access, touch.since);
}

void Hazards::check(const Range& bytes, const State& state, const Past& access, Tag since) {
  const bool write = writes(access.use.access);
  // A read that is ordered has seen the write: to be behind the read is enough. Atomic operations on the same bytes are
  // no race (Vulkan 1.3.239, Memory Model: Data Race), whatever commands they are of.
  const auto in_order = [&](const Past& past) {
    if (past.use.atomic && access.use.atomic) return true;
    return is_done(past) || past.tag == access.tag || past.tag >= since || same_pass(past, access);
  };
  if (!in_order(state.write) && !(write && !state.reads.empty())) {
    const Standing standing = order_.standing(past_write(state), access.use);
    if (standing != Standing::kVisible) add({&state.write, access, standing, bytes});
  }
  if (!write) return;
  for (const Past& read : state.reads) {
    if (!in_order(read) && !order_.is_before(read.use.stage, read.tag, access.use))
      add({&read, access, Standing::kUnordered, bytes});
  }
}

void Hazards::depend(Tag tag, std::span<const Barrier> barriers) {
  const std::lock_guard lock(mutex_);
  settle_locked();
  std::vector<Clock> before;
  for (const Barrier& barrier : barriers) {
    before.push_back(order_.before(barrier.first, tag));
    for (const auto& [first, second] : barrier.more) before.back().join(order_.before(first, tag));
  }
  apply(tag, barriers, before);
}

void Hazards::apply(Tag tag, std::span<const Barrier> barriers, std::span<const Clock> before) {
  for (std::size_t i = 0; i < barriers.size(); ++i) {
    const Barrier& barrier = barriers[i];
    for (const Range& range : barrier.ranges) {
      records_.update(range, [&](const Range& bytes, State& state) {
        if (barrier.who)
          transition(bytes, state, tag, barrier, before[i]);
        else
          pass(state, tag, barrier, before[i]);
      });
    }
    order_.after(barrier.second, before[i], barrier.is_global);
    for (const auto& [first, second] : barrier.more) order_.after(second, before[i], barrier.is_global);
  }
}

void Hazards::pass(State& state, Tag tag, const Barrier& barrier, const Clock& before) {
  if (is_done(state.write) || Order::standing(past_write(state), before) != Standing::kVisible) return;
  if (state.passages.size() == kMostPassages) state.passages.erase(state.passages.begin());
  state.passages.push_back({barrier.second, tag});
}

void Hazards::transition(const Range& bytes, State& state, Tag tag, const Barrier& barrier, const Clock& before) {
  const Past later{{Stage::kTransition, Access::kTransitionWrite}, tag, 0, barrier.who};
  if (!is_done(state.write) && state.reads.empty()) {
    const Standing standing = Order::standing(past_write(state), before);
    if (standing != Standing::kVisible) add({&state.write, later, standing, bytes});
  }
  for (const Past& read : state.reads) {
    if (!is_done(read) && before.done[static_cast<std::size_t>(read.use.stage)] < read.tag)
      add({&read, later, Standing::kUnordered, bytes});
  }
  state = {later, {{barrier.second, tag}}, {}};
  for (const auto& [first, second] : barrier.more) state.passages.push_back({second, tag});
}

void Hazards::set_event(const void* event, Tag tag, const Scope& first) {
  const std::lock_guard lock(mutex_);
  settle_locked();
  events_[event] = {first, tag, order_.before(first, tag)};
}

void Hazards::set_event_by_host(const void* event) {
  const std::lock_guard lock(mutex_);
  events_[event] = {{}, host_, everything_until(host_)};
}

void Hazards::wait_events(std::span<const void* const> events, Tag tag, std::span<const Barrier> barriers) {
  const std::lock_guard lock(mutex_);
  settle_locked();
  std::vector<Clock> before(barriers.size());
  for (const void* const event : events) {
    const auto found = events_.find(event);
    if (found == events_.end()) continue;
    const Event& set = found->second;
    for (std::size_t i = 0; i < barriers.size(); ++i) {
      // What was written before the event was set, as far as both name it.
      const Scope& wanted = barriers[i].first;
      Clock clock = set.clock;
      clock.available.fill(0);
      const Stages both = set.first.accessed & wanted.accessed;
      const Clock written = order_.before({both, both, wanted.accesses}, set.tag);
      for (std::size_t w = 0; w < kWrites; ++w)
        clock.available[w] = std::max(set.clock.available[w], std::min(written.available[w], set.tag - 1));
      before[i].join(clock);
    }
  }
  apply(tag, barriers, before);
}

Hazards::Signal* Hazards::find_signal(const void* semaphore, std::uint64_t value) {
  std::vector<Signal>& signals = signals_[semaphore];
  const auto at = std::ranges::find_if(signals, [&](const Signal& s) { return s.value >= value; });
  return at == signals.end() ? nullptr : &*at;
}

void Hazards::signal(const void* semaphore, std::uint64_t value, const Scope& first) {
  const std::lock_guard lock(mutex_);
  settle_locked();
  std::vector<Signal>& signals = signals_[semaphore];
  Signal signal{value, order_.before(first, now() + 1), now()};
  if (value != 0 && !signals.empty()) signal.clock.join(signals.back().clock);
  signals.push_back(std::move(signal));
  if (signals.size() > kMostSignals) signals.erase(signals.begin());
}

void Hazards::wait(const void* semaphore, std::uint64_t value, const Scope& second, bool from_outside) {
  const std::lock_guard lock(mutex_);
  settle_locked();
  if (from_outside) order_.after(second, everything_until(now()), true);
  const Signal* const signal = find_signal(semaphore, value);
  if (signal == nullptr) return;
  order_.after(second, signal->clock, true);
  // A binary semaphore is unsignalled by the wait.
  if (value == 0 && signal->value == 0) signals_[semaphore].erase(signals_[semaphore].begin());
}

void Hazards::signal_by_host(const void* semaphore, std::uint64_t value) {
  const std::lock_guard lock(mutex_);
  std::vector<Signal>& signals = signals_[semaphore];
  Signal signal{value, everything_until(host_), host_};
  if (!signals.empty()) signal.clock.join(signals.back().clock);
  signals.push_back(std::move(signal));
}

void Hazards::present(std::span<const SwapchainImage> images, std::span<const void* const> semaphores) {
  const std::lock_guard lock(mutex_);
  Signal done;
  for (const void* const semaphore : semaphores) {
    std::vector<Signal>& signals = signals_[semaphore];
    if (signals.empty()) continue;
    done.clock.join(signals.front().clock);
    done.tag = std::max(done.tag, signals.front().tag);
    signals.erase(signals.begin());
  }
  for (const SwapchainImage& image : images) presented_[image] = done;
}

void Hazards::acquire(const SwapchainImage& image, const void* semaphore, const void* fence) {
  const std::lock_guard lock(mutex_);
  const Signal& done = presented_[image];
  if (semaphore != nullptr) signals_[semaphore].push_back({0, done.clock, done.tag});
  if (fence != nullptr) fences_[fence] = done.tag;
}

void Hazards::begin_submission(std::uint64_t number, Tag host) {
  const std::lock_guard lock(mutex_);
  submission_ = number;
  floor_ = std::max(floor_, host);
  if (records_.size() < std::max(kPrune, 2 * pruned_size_)) return;
  records_.forget_until(floor_);
  pruned_size_ = records_.size();
}

void Hazards::end_submission() {
  const std::lock_guard lock(mutex_);
  settle_locked();
}

Tag Hazards::host() const {
  const std::lock_guard lock(mutex_);
  return host_;
}

void Hazards::signal_fence(const void* fence) {
  const std::lock_guard lock(mutex_);
  fences_[fence] = now();
}

void Hazards::host_waited(const void* fence) {
  const std::lock_guard lock(mutex_);
  if (const auto found = fences_.find(fence); found != fences_.end()) host_ = std::max(host_, found->second);
}

void Hazards::host_waited_for(const void* semaphore, std::uint64_t value) {
  const std::lock_guard lock(mutex_);
  if (const Signal* const signal = find_signal(semaphore, value)) host_ = std::max(host_, signal->tag);
}

void Hazards::host_waited_for_all() {
  const std::lock_guard lock(mutex_);
  host_ = now();
}

void Hazards::host_access(const Range& range, bool write, std::shared_ptr<const Who> who) {
  const std::lock_guard lock(mutex_);
  const Use use{Stage::kHost, write ? Access::kHostWrite : Access::kHostRead};
  const Past access{use, now() + 1, 0, std::move(who)};
  records_.look(range, [&](const Range& bytes, const State& state) {
    if (state.write.who) {
      const bool known = state.write.tag <= host_;
      const Standing standing = known ? order_.standing(past_write(state), use) : Standing::kUnordered;
      // Memory is the host's to write once it knows that the device is done.
      if (write ? !known : standing != Standing::kVisible) add({&state.write, access, standing, bytes});
    }
    for (const Past& read : state.reads)
      if (write && read.tag > host_) add({&read, access, Standing::kUnordered, bytes});
  });
}

void Hazards::forget(const Range& range) {
  const std::lock_guard lock(mutex_);
  records_.forget(range);
}

void Hazards::add(const Clash& clash) {
  const Told told{*clash.earlier, clash.later, clash.standing, clash.bytes};
  Entry& entry = entries_[key_of(told)];
  if (entry.count == 0) {
    entry.first = {clash.later.tag, clash.earlier->tag};
    entry.finding = finding_of(told);
  }
  if (entry.count == 0 || entry.last != clash.later.tag) ++entry.count;
  entry.last = clash.later.tag;
}

void Hazards::report(Tag tag, const Finding& finding) {
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[std::string(finding.rule->id) + finding.message + finding.address.command_name];
  if (entry.count++ != 0) return;
  entry.first = {tag, 0};
  entry.finding = finding;
}

std::vector<Finding> Hazards::take() {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<std::pair<Tag, Tag>, Finding>> found;
  for (auto& [key, entry] : entries_) {
    if (std::exchange(entry.delivered, true)) continue;
    entry.finding.count = entry.count;
    found.emplace_back(entry.first, std::move(entry.finding));
  }
  std::ranges::stable_sort(found, {}, [](const auto& one) { return one.first; });
  std::vector<Finding> findings;
  for (auto& [first, finding] : found) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace vitrine::glass::sync
