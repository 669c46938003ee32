// See shadow.h.
#include "glass/race/shadow.h"

#include <cstring>

namespace vitrine::glass::race {

void Page::clear() {
  for (Slots* slots : {&write, &read, &other, &atomic}) {
    std::memset(slots->time, 0, sizeof slots->time);
    slots->used = 0;
  }
}

Page& Shadow::find(std::uint64_t number) {
  const auto [at, added] = by_number_.try_emplace(number, static_cast<std::uint32_t>(used_));
  if (added) {
    if (used_ == pages_.size()) pages_.push_back(std::make_unique<Page>());
    pages_[used_]->number = number;
    pages_[used_++]->clear();
  }
  return *(recent_[number % kRecent] = pages_[at->second].get());
}

void Shadow::reset() {
  constexpr std::size_t kKept = 1024;
  by_number_.clear();
  used_ = 0;
  recent_ = {};
  if (pages_.size() > kKept) pages_.resize(kKept);
}

}  // namespace vitrine::glass::race
