// See log.h.
#include "glass/race/log.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "glass/race/rows.h"

namespace vitrine::glass::race {
namespace {

/// Appends details, few for a row. Returns its period.
std::uint8_t append(std::vector<Detail>& details, const Slots& slots, std::uint64_t words,
                    const std::uint32_t* values) {
  Row row;
  for (const std::uint32_t shift : {0u, 2u, 1u}) {
    if (words == 0 || !is_row(slots, words, shift, row)) continue;
    const std::uint32_t period = 1u << shift;
    for (std::uint32_t k = 0; k < period; ++k) {
      const std::uint64_t there = words & row_words(k, shift);
      details.push_back({row.who, there != 0 ? slots.site[std::countr_zero(there)] : 0, 0});
    }
    return static_cast<std::uint8_t>(period);
  }
  for (std::uint64_t rest = words; rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    details.push_back({slots.who[k], slots.site[k], values != nullptr ? values[k] : 0});
  }
  return 0;
}

void append_values(std::vector<std::uint32_t>& to, const std::uint32_t* from, std::uint64_t words) {
  if (words == ~std::uint64_t{0}) {
    to.insert(to.end(), from, from + kPageWords);
    return;
  }
  for (; words != 0; words &= words - 1) to.push_back(from[std::countr_zero(words)]);
}

/// Holds the entries of one page against each other, in order.
class PageSweep {
 public:
  PageSweep(const std::vector<Detail>& details, const std::vector<std::uint32_t>& values, Pairs& pairs,
            const spirv::ObservedCommand* command)
      : details_(details), values_(values), pairs_(pairs), command_(command) {}

  void add(const PageEntry& entry) {
    compare(entry, Kind::kWrite, Kind::kWrite);
    compare(entry, Kind::kWrite, Kind::kRead);
    compare(entry, Kind::kWrite, Kind::kAtomic);
    compare(entry, Kind::kRead, Kind::kWrite);
    compare(entry, Kind::kRead, Kind::kAtomic);
    compare(entry, Kind::kAtomic, Kind::kWrite);
    compare(entry, Kind::kAtomic, Kind::kRead);
    compare(entry, Kind::kAtomic, Kind::kAtomic);
    for (const Kind kind : {Kind::kWrite, Kind::kRead, Kind::kAtomic}) {
      const auto k = static_cast<std::size_t>(kind);
      for (std::uint64_t fresh = words(entry, kind) & ~seen_[k]; fresh != 0; fresh &= fresh - 1)
        first_[k][static_cast<std::size_t>(std::countr_zero(fresh))] = &entry;
      seen_[k] |= words(entry, kind);
    }
  }

 private:
  enum class Kind : std::uint8_t { kWrite, kRead, kAtomic };

  static std::uint64_t words(const PageEntry& entry, Kind kind) {
    return kind == Kind::kWrite ? entry.writes : kind == Kind::kRead ? entry.reads : entry.atomics;
  }
  static std::size_t details_of(const PageEntry& entry, Kind kind) {
    if (const std::uint8_t period = entry.period[static_cast<std::size_t>(kind)]; period != 0) return period;
    return static_cast<std::size_t>(std::popcount(words(entry, kind)));
  }
  Detail detail(const PageEntry& entry, Kind kind, std::uint32_t word) const {
    std::size_t at = entry.first;
    if (kind != Kind::kWrite) at += details_of(entry, Kind::kWrite);
    if (kind == Kind::kAtomic) at += details_of(entry, Kind::kRead);
    const std::uint64_t before = words(entry, kind) & ((std::uint64_t{1} << word) - 1);
    const auto number = static_cast<std::size_t>(std::popcount(before));
    const std::uint32_t period = entry.period[static_cast<std::size_t>(kind)];
    if (period == 0) return details_[at + number];
    Detail detail = details_[at + word % period];
    detail.who += word / period;
    if (kind == Kind::kWrite) detail.value = values_[entry.values + number];
    return detail;
  }
  static Access access_of(const PageEntry& entry, const Detail& detail) {
    const std::uint32_t site = (detail.site & ~kInterlocked) >> 4;
    if (!entry.program->compute()) return {entry.program, site, {{}, detail.who}};
    const std::uint32_t* size = entry.program->size;
    const std::uint32_t invocations = size[0] * size[1] * size[2];
    Who who = entry.who;
    who.group[0] += detail.who / invocations;
    who.local = detail.who % invocations;
    return {entry.program, site, who};
  }

  void compare(const PageEntry& entry, Kind now, Kind then) {
    const auto k = static_cast<std::size_t>(then);
    for (std::uint64_t both = words(entry, now) & seen_[k]; both != 0; both &= both - 1) {
      const auto word = static_cast<std::uint32_t>(std::countr_zero(both));
      meet(entry, detail(entry, now, word), *first_[k][word], detail(*first_[k][word], then, word), word);
    }
  }

  void meet(const PageEntry& entry, const Detail& now, const PageEntry& other, const Detail& then, std::uint32_t word) {
    const std::uint32_t bytes = now.site & then.site & 15;
    if (bytes == 0) return;
    Conflict conflict;
    conflict.earlier = access_of(other, then);
    conflict.later = access_of(entry, now);
    const Site &a = conflict.earlier.what(), &b = conflict.later.what();
    if (!a.writes() && !b.writes()) return;
    if (a.is_atomic() && b.is_atomic()) {
      if (covers_device(a.order.memory) && covers_device(b.order.memory)) return;
      conflict.kind = Conflict::Kind::kScope;
    }
    // Critical sections of fragments of one pixel come one after the other.
    if ((now.site & then.site & kInterlocked) != 0 && now.who == then.who) return;
    conflict.equal = a.action == spirv::Access::kStore && b.action == spirv::Access::kStore && now.value == then.value;
    conflict.address = entry.page * kPageBytes + word * 4 + static_cast<std::uint32_t>(std::countr_zero(bytes));
    pairs_.add(conflict, command_);
  }

  const std::vector<Detail>& details_;
  const std::vector<std::uint32_t>& values_;
  Pairs& pairs_;
  const spirv::ObservedCommand* const command_;
  std::uint64_t seen_[3] = {};
  const PageEntry* first_[3][kPageWords] = {};
};

}  // namespace

void CommandLog::add(const Told& program, const Who& who, Shadow& shadow) {
  compute_ = program.compute();
  for (std::size_t i = 0; i < shadow.size(); ++i) {
    const Page& page = shadow.at(i);
    PageEntry entry;
    entry.page = page.number;
    entry.who = who;
    entry.program = &program;
    entry.writes = page.write.used;
    entry.reads = page.read.used;
    entry.atomics = page.atomic.used;
    entry.first = details_.size();
    entry.period[0] = append(details_, page.write, entry.writes, page.value);
    entry.period[1] = append(details_, page.read, entry.reads, nullptr);
    entry.period[2] = append(details_, page.atomic, entry.atomics, nullptr);
    entry.values = values_.size();
    if (entry.period[0] != 0) append_values(values_, page.value, entry.writes);
    entries_.push_back(entry);
  }
}

void CommandLog::take(CommandLog& other) {
  if (empty()) {
    std::swap(*this, other);
    return;
  }
  for (PageEntry entry : other.entries_) {
    entry.first += details_.size();
    entry.values += values_.size();
    entries_.push_back(entry);
  }
  details_.insert(details_.end(), other.details_.begin(), other.details_.end());
  values_.insert(values_.end(), other.values_.begin(), other.values_.end());
  other.clear();
}

void CommandLog::clear() {
  entries_.clear();
  details_.clear();
  values_.clear();
}

bool CommandLog::less(const PageEntry& a, const PageEntry& b) const {
  // Waves of draws may be called the same: what they did tells them apart.
  const auto key = [](const PageEntry& e) {
    return std::tuple(std::tuple(e.who.group[2], e.who.group[1], e.who.group[0], e.who.local), e.program->context.stage,
                      e.writes, e.reads, e.atomics);
  };
  if (key(a) != key(b)) return key(a) < key(b);
  const auto content = [&](const PageEntry& entry) {
    const auto count = [&](std::uint64_t words, std::uint8_t period) {
      return period != 0 ? std::size_t{period} : static_cast<std::size_t>(std::popcount(words));
    };
    return std::span(details_).subspan(entry.first, count(entry.writes, entry.period[0]) +
                                                        count(entry.reads, entry.period[1]) +
                                                        count(entry.atomics, entry.period[2]));
  };
  const auto left = content(a), right = content(b);
  return std::lexicographical_compare(
      left.begin(), left.end(), right.begin(), right.end(), [](const Detail& one, const Detail& other) {
        return std::tuple(one.who, one.site, one.value) < std::tuple(other.who, other.site, other.value);
      });
}

bool CommandLog::is_small() const {
  constexpr std::size_t kSmall = 64 << 20;  // bytes
  return entries_.capacity() * sizeof(PageEntry) + details_.capacity() * sizeof(Detail) + values_.capacity() * 4 <
         kSmall;
}

void CommandLog::settle(Pairs& pairs, const spirv::ObservedCommand* command) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;  // page, entry
  order.reserve(entries_.size());
  for (const PageEntry& entry : entries_) order.emplace_back(entry.page, static_cast<std::uint32_t>(order.size()));
  if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && order[end].first == order[first].first) ++end;
    if (end - first > 1) {
      const auto begin = order.begin();
      std::sort(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(end),
                [&](const auto& a, const auto& b) { return less(entries_[a.second], entries_[b.second]); });
      PageSweep sweep(details_, values_, pairs, command);
      for (std::size_t i = first; i < end; ++i) sweep.add(entries_[order[i].second]);
    }
    first = end;
  }
  clear();
}

}  // namespace vitrine::glass::race
