// See shadow.h.
#include "glass/race/shadow.h"

#include <algorithm>
#include <cstring>

namespace vitrine::glass::race {

void Page::clear() {
  for (Slots* slots : {&write, &read, &other, &atomic}) {
    std::memset(slots->time, 0, sizeof slots->time);
    slots->used = 0;
  }
}

Shadow::Entry& Shadow::entry_of(std::uint64_t number) {
  std::size_t at = number * 0x9e3779b97f4a7c15 >> 40;
  while (true) {
    Entry& entry = entries_[at++ & (entries_.size() - 1)];
    if (entry.round != round_ || entry.number == number) return entry;
  }
}

void Shadow::grow() {
  entries_.assign(std::max<std::size_t>(entries_.size() * 2, 64), {});
  for (std::uint32_t i = 0; i < used_; ++i) entry_of(pages_[i]->number) = {pages_[i]->number, i, round_};
}

Page& Shadow::find(std::uint64_t number) {
  if (entries_.size() <= used_ * 2) grow();
  Entry& entry = entry_of(number);
  if (entry.round != round_) {
    entry = {number, static_cast<std::uint32_t>(used_), round_};
    if (used_ == pages_.size()) pages_.push_back(std::make_unique<Page>());
    pages_[used_]->number = number;
    pages_[used_++]->clear();
  }
  return *(recent_[number % kRecent] = pages_[entry.index].get());
}

void Shadow::reset() {
  constexpr std::size_t kKept = 1024;
  used_ = 0;
  recent_ = {};
  if (pages_.size() > kKept) {
    pages_.resize(kKept);
    entries_ = {};
  }
  if (++round_ != 0) return;
  entries_ = {};
  round_ = 1;
}

}  // namespace vitrine::glass::race
