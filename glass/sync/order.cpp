// See order.h.
#include "glass/sync/order.h"

#include <algorithm>

namespace vitrine::glass::sync {
namespace {

template <class F>
void for_each_bit(std::uint32_t mask, F&& f) {
  for (; mask != 0; mask &= mask - 1) f(static_cast<std::size_t>(__builtin_ctz(mask)));
}

/// A write is available in the stages behind a passage: whether one of them is done in `clock` from then on.
bool comes_by(const Passage& passage, const Clock& clock) {
  bool found = false;
  for_each_bit(passage.second.executed, [&](std::size_t s) { found |= clock.done[s] >= passage.tag; });
  return found;
}

/// Behind a passage to all stages is everything that comes later, also what waits for no stage.
bool is_for_all(const Passage& passage) { return (~passage.second.executed & kAllCommands) == 0; }

/// Nothing waits for a passage to no stage; what waits for all that came before it, its commands included, does.
bool is_behind_all(const Passage& passage, const Clock& before) {
  bool all = passage.second.executed == 0;
  for_each_bit(kAllCommands, [&](std::size_t s) { all &= before.done[s] >= passage.tag; });
  return all;
}

}  // namespace

void Clock::join(const Clock& other) {
  for (std::size_t i = 0; i < done.size(); ++i) done[i] = std::max(done[i], other.done[i]);
  for (std::size_t i = 0; i < available.size(); ++i) available[i] = std::max(available[i], other.available[i]);
}

Clock Order::before(const Scope& first, Tag tag) const {
  Clock clock;
  if (first.empty()) {
    // Nothing is waited for: what comes before it are the things that every stage has waited for.
    clock = ahead_[0];
    for (std::size_t s = 1; s < index(Stage::kHost); ++s) {
      for (std::size_t i = 0; i < kStages; ++i) clock.done[i] = std::min(clock.done[i], ahead_[s].done[i]);
      for (std::size_t i = 0; i < kWrites; ++i)
        clock.available[i] = std::min(clock.available[i], ahead_[s].available[i]);
    }
    return clock;
  }
  for_each_bit(first.executed, [&](std::size_t s) { clock.join(ahead_[s]); });
  for_each_bit(first.executed, [&](std::size_t s) { clock.done[s] = tag - 1; });
  for_each_bit(first.accessed, [&](std::size_t s) {
    for_each_bit(first.accesses, [&](std::size_t a) {
      const Use use{static_cast<Stage>(s), static_cast<Access>(a)};
      if (is_write_of(use.stage, use.access)) clock.available[write_class(use)] = tag - 1;
    });
  });
  return clock;
}

void Order::after(const Scope& second, const Clock& clock, bool memory) {
  for_each_bit(second.executed, [&](std::size_t s) {
    Clock& ahead = ahead_[s];
    for (std::size_t i = 0; i < kStages; ++i) ahead.done[i] = std::max(ahead.done[i], clock.done[i]);
    if (!memory) return;
    for (std::size_t i = 0; i < kWrites; ++i) ahead.available[i] = std::max(ahead.available[i], clock.available[i]);
  });
  if (!memory) return;
  for_each_bit(second.accessed, [&](std::size_t s) {
    for_each_bit(second.accesses, [&](std::size_t a) { visible_[s][a].join(clock); });
  });
}

Standing Order::standing(const PastWrite& write, Use use) const {
  const Clock& visible = visible_[index(use.stage)][static_cast<std::size_t>(use.access)];
  const Clock& now = ahead(use.stage);
  bool ordered = now.done[index(write.use.stage)] >= write.tag;
  bool available = now.available[write_class(write.use)] >= write.tag;
  if (visible.available[write_class(write.use)] >= write.tag) return Standing::kVisible;
  for (const Passage& passage : write.passages) {
    const Scope& second = passage.second;
    const bool direct = (second.accessed & bit(use.stage)) != 0 && (second.accesses & bit(use.access)) != 0;
    if (direct || comes_by(passage, visible)) return Standing::kVisible;
    const bool behind = (second.executed & bit(use.stage)) != 0 || comes_by(passage, now);
    ordered |= behind;
    available |= behind;
  }
  return !ordered ? Standing::kUnordered : available ? Standing::kNotVisible : Standing::kNotAvailable;
}

Standing Order::standing(const PastWrite& write, const Clock& before) {
  if (before.available[write_class(write.use)] >= write.tag) return Standing::kVisible;
  for (const Passage& passage : write.passages)
    if (is_for_all(passage) || comes_by(passage, before) || is_behind_all(passage, before)) return Standing::kVisible;
  const bool ordered = before.done[index(write.use.stage)] >= write.tag;
  return ordered ? Standing::kNotAvailable : Standing::kUnordered;
}

}  // namespace vitrine::glass::sync
