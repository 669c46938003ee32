// What an invocation knows to have happened before it through atomic operations (Vulkan 1.3.239, Memory Model:
// synchronizes-with, happens-before). Sparse: most invocations know nothing of others but through barriers.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include "glass/race/sites.h"

namespace vitrine::glass::race {

/// A moment for each kind of memory: accesses before it are known.
using Times = std::array<std::uint32_t, kMemories>;

inline void raise(Times& to, const Times& from) {
  for (std::size_t m = 0; m < kMemories; ++m) to[m] = std::max(to[m], from[m]);
}

class Clock {
 public:
  bool empty() const { return !any_; }
  /// Of one invocation, and of all of a workgroup.
  void add_invocation(std::uint32_t who, const Times& times) { raise_in(invocations_, who, times); }
  void add_group(std::uint32_t group, const Times& times) { raise_in(groups_, group, times); }
  void join(const Clock& other) {
    if (!other.any_) return;
    raise(all_, other.all_);
    for (const auto& [who, times] : other.invocations_) raise_in(invocations_, who, times);
    for (const auto& [group, times] : other.groups_) raise_in(groups_, group, times);
  }
  /// Whether an access at `time` is known.
  bool knows(std::uint32_t who, std::uint32_t group, std::uint32_t time, std::size_t memory) const {
    if (!any_) return false;
    if (time < all_[memory]) return true;
    const auto one = invocations_.find(who);
    if (one != invocations_.end() && time < one->second[memory]) return true;
    const auto whole = groups_.find(group);
    return whole != groups_.end() && time < whole->second[memory];
  }
  void clear() { *this = Clock(); }

 private:
  /// Clocks that know more than this are taken to know everything before: races are missed rather than made up.
  static constexpr std::size_t kMost = 1024;
  using Entries = std::map<std::uint32_t, Times>;

  void raise_in(Entries& entries, std::uint32_t key, const Times& times) {
    any_ = true;
    raise(entries.try_emplace(key, Times{}).first->second, times);
    if (invocations_.size() + groups_.size() <= kMost) return;
    for (const Entries* part : {&invocations_, &groups_})
      for (const auto& [who, known] : *part) raise(all_, known);
    invocations_.clear();
    groups_.clear();
  }

  bool any_ = false;
  Times all_{};
  Entries invocations_, groups_;
};

}  // namespace vitrine::glass::race
