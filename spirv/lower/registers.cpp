// Linear scan over the body with exact live ranges, after merging values that moves connect.
//
// Time: operation i reads at 2i and writes at 2i + 1. Arithmetic writes all 64 lanes, also inactive ones, so a register
// is taken wherever any lane may still need its value: a value that a loop uses but does not define lives until the
// loop ends, results of loops that lanes leave separately live from its start.
#include "spirv/lower/registers.h"

#include <algorithm>
#include <numeric>
#include <queue>

namespace vitrine::spirv::lowering {
namespace {

using Position = std::int32_t;

struct LiveRange {
  Position start, end;  ///< both included
};

struct Interval {
  std::vector<LiveRange> ranges;  ///< sorted; empty: not a value that needs a place
  Position start() const { return ranges.front().start; }
  Position end() const { return ranges.back().end; }
};

bool intersect(const std::vector<LiveRange>& a, const std::vector<LiveRange>& b) {
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i].start <= b[j].end && b[j].start <= a[i].end) return true;
    a[i].end < b[j].end ? ++i : ++j;
  }
  return false;
}

std::vector<LiveRange> unite(std::vector<LiveRange> a, const std::vector<LiveRange>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end(), [](const LiveRange& x, const LiveRange& y) { return x.start < y.start; });
  std::vector<LiveRange> merged;
  for (const LiveRange& range : a) {
    if (!merged.empty() && range.start <= merged.back().end + 1) {
      merged.back().end = std::max(merged.back().end, range.end);
    } else {
      merged.push_back(range);
    }
  }
  return merged;
}

class Allocator {
 public:
  explicit Allocator(const ScalarFunction& function)
      : f_(function), intervals_(function.scalars.size()), used_(function.scalars.size(), 0) {
    end_ = static_cast<Position>(2 * f_.body.size() + 1);
    result_.place.assign(f_.scalars.size(), kNoIndex);
    result_.slots.resize(f_.body.size());
    parent_.resize(f_.scalars.size());
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  Allocation run() {
    build_intervals();
    merge_moves();
    result_.register_count = scan(false);
    result_.mask_count = scan(true);
    for (ScalarId id = 0; id < f_.scalars.size(); ++id) result_.place[id] = result_.place[root(id)];
    return std::move(result_);
  }

 private:
  struct Slot {
    std::uint32_t op, which;
    Position start, end;
  };

  bool varying(ScalarId id) const { return f_.scalars[id].level == Level::kVarying; }

  // ---- live ranges

  void define(ScalarId id, Position at) {
    if (!varying(id)) return;
    std::vector<LiveRange>& ranges = intervals_[id].ranges;
    if (ranges.empty()) {
      ranges.push_back({at, at});
    } else {
      ranges.front().start = std::min(ranges.front().start, at);
      ranges.back().end = std::max(ranges.back().end, at);
    }
  }

  void use(ScalarId id, Position at) {
    if (id == kNoScalar || !varying(id)) return;
    used_[id] = 1;
    std::vector<LiveRange>& ranges = intervals_[id].ranges;
    if (ranges.empty()) ranges.push_back({-1, -1});  // inputs; anything else is defined before use
    for (auto loop = loops_.rbegin(); loop != loops_.rend(); ++loop) {
      const auto start = static_cast<Position>(2 * *loop);
      if (ranges.front().start >= start) break;
      at = std::max(at, static_cast<Position>(2 * end_of(*loop) + 1));
    }
    ranges.back().end = std::max(ranges.back().end, at);
  }

  std::uint32_t end_of(std::uint32_t loop) const { return f_.body[f_.body[loop].partner].partner; }

  void build_intervals() {
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) visit(i);
    for (const ScalarId id : f_.outputs)
      if (id != kNoScalar && varying(id)) use(id, end_);
    for (const ScalarId id : f_.observed) use(id, 0);
    make_holes();
  }

  void visit(std::uint32_t i) {
    const ScalarOp& op = f_.body[i];
    const auto read = static_cast<Position>(2 * i);
    Position write = read + 1;
    // Handlers of loads and images write one result while they still read operands for the next.
    if (op.kind == Kind::kIntrinsic) write = read;
    use(op.cond, read);
    for (std::uint32_t k = 0; k < op.src.count; ++k)
      if (!op.takes_accumulator(k)) use(f_.operands[op.src.begin + k], read);
    if (op.kind == Kind::kLoop) loops_.push_back(i);
    if (op.kind == Kind::kBreak && f_.body[op.partner].masked) write = static_cast<Position>(2 * op.partner + 1);
    if (op.link != exec::Link::kKeep)
      for (const ScalarId id : f_.of(op.dst)) define(id, write);
    if (op.kind == Kind::kEndLoop) loops_.pop_back();
    add_slots(i, read);
  }

  void add_slots(std::uint32_t i, Position read) {
    const ScalarOp& op = f_.body[i];
    if (op.kind == Kind::kIf && op.masked) {
      slots_.push_back({i, 0, read, static_cast<Position>(2 * f_.body[op.partner].partner + 1)});
    } else if (op.kind == Kind::kLoop && op.masked) {
      const auto end = static_cast<Position>(2 * end_of(i) + 1);
      slots_.push_back({i, 0, read, end});
      slots_.push_back({i, 1, read, end});
    } else if ((op.kind == Kind::kBreak || op.kind == Kind::kContinue) && op.cond != kNoScalar && op.dst.count != 0) {
      slots_.push_back({i, 0, read, read + 1});
    }
  }

  /// Where a value is rewritten before it is read again, its register is free in between.
  void make_holes() {
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
      const ScalarOp& op = f_.body[i];
      if (op.kind == Kind::kElse && !if_of(i).masked) {
        for (const ScalarId id : f_.of(op.dst))
          split(id, static_cast<Position>(2 * i + 1), static_cast<Position>(2 * op.partner + 1));
      } else if (op.kind == Kind::kEndLoop) {
        for (const ScalarId id : f_.of(op.dst)) split_parameter(id, i);
      }
    }
  }
  const ScalarOp& if_of(std::uint32_t else_index) const {
    return f_.body[f_.body[f_.body[else_index].partner].partner];
  }

  void split(ScalarId id, Position last_before, Position first_after) {
    std::vector<LiveRange>& ranges = intervals_[id].ranges;
    if (ranges.size() != 1 || first_after <= last_before + 1) return;
    const LiveRange whole = ranges[0];
    if (whole.start > last_before || whole.end < first_after) return;
    ranges = {{whole.start, last_before}, {first_after, whole.end}};
  }

  /// A loop parameter is dead from its last read to the back edge, unless it is read after an inner loop's extension.
  void split_parameter(ScalarId id, std::uint32_t end_loop) {
    if (!varying(id)) return;
    const std::uint32_t loop = f_.body[end_loop].partner;
    Position last = static_cast<Position>(2 * loop + 1);
    std::vector<std::uint32_t> inner;
    for (std::uint32_t i = loop + 1; i <= end_loop; ++i) {
      const ScalarOp& op = f_.body[i];
      if (op.kind == Kind::kLoop) inner.push_back(i);
      bool reads = op.cond == id;
      for (const ScalarId source : f_.of(op.src)) reads |= source == id;
      if (reads) last = static_cast<Position>(inner.empty() ? 2 * i : 2 * end_of(inner.front()) + 1);
      if (op.kind == Kind::kEndLoop && i != end_loop) inner.pop_back();
    }
    split(id, last, static_cast<Position>(2 * end_loop + 1));
  }

  // ---- merging

  ScalarId root(ScalarId id) {
    while (parent_[id] != id) id = parent_[id] = parent_[parent_[id]];
    return id;
  }

  bool mergeable(ScalarId a, ScalarId b) {
    return varying(a) && varying(b) && f_.scalars[a].boolean == f_.scalars[b].boolean && !f_.scalars[a].boolean &&
           !intervals_[root(a)].ranges.empty() && !intervals_[root(b)].ranges.empty();
  }

  void merge(ScalarId a, ScalarId b, const std::vector<LiveRange>& ranges_of_b) {
    const ScalarId ra = root(a), rb = root(b);
    if (ra == rb || intersect(intervals_[ra].ranges, ranges_of_b)) return;
    intervals_[ra].ranges = unite(std::move(intervals_[ra].ranges), intervals_[rb].ranges);
    used_[ra] |= used_[rb];
    parent_[rb] = ra;
  }

  void merge_moves() {
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
      const ScalarOp& op = f_.body[i];
      if (op.kind == Kind::kEndIf && f_.body[op.partner].masked) merge_kept_values(op, i);
    }
    for (const ScalarOp& op : f_.body) {
      const bool masked_end = op.kind == Kind::kEndIf && f_.body[op.partner].masked;
      const bool joins = op.kind == Kind::kElse || (op.kind == Kind::kEndIf && !masked_end) || op.kind == Kind::kLoop ||
                         op.kind == Kind::kEndLoop || op.kind == Kind::kMove;
      if (!joins) continue;
      for (std::uint32_t k = 0; k < op.src.count; ++k) {
        const ScalarId to = f_.operands[op.dst.begin + k], from = f_.operands[op.src.begin + k];
        if (mergeable(to, from)) merge(to, from, intervals_[root(from)].ranges);
      }
    }
  }

  /// `if (c) x = new;`: the old value, whose last use is the else-branch's, and the result share a register; the
  /// then-branch overwrites the lanes that took it.
  void merge_kept_values(const ScalarOp& op, std::uint32_t end_if) {
    const std::uint32_t if_index = op.partner;
    const auto else_write = static_cast<Position>(2 * f_.body[if_index].partner + 1);
    for (std::uint32_t k = 0; k < op.src.count; ++k) {
      const ScalarId to = f_.operands[op.dst.begin + k], from = f_.operands[op.src.begin + k];
      if (!mergeable(to, from) || root(from) != from) continue;
      const std::vector<LiveRange>& kept = intervals_[from].ranges;
      if (kept.size() != 1 || kept[0].start >= static_cast<Position>(2 * if_index) ||
          kept[0].end != static_cast<Position>(2 * end_if))
        continue;
      merge(to, from, {{kept[0].start, else_write - 1}});
    }
  }

  // ---- linear scan

  struct Item {
    Position start, end;
    ScalarId id;  ///< kNoScalar: a slot
    std::uint32_t slot = 0;
  };

  std::uint32_t scan(bool boolean) {
    std::vector<Item> items;
    for (ScalarId id = 0; id < f_.scalars.size(); ++id)
      if (f_.scalars[id].boolean == boolean && varying(id) && root(id) == id && !intervals_[id].ranges.empty() &&
          used_[id])
        items.push_back({intervals_[id].start(), intervals_[id].end(), id});
    if (boolean)
      for (std::uint32_t s = 0; s < slots_.size(); ++s) items.push_back({slots_[s].start, slots_[s].end, kNoScalar, s});
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
      return a.start != b.start ? a.start < b.start : a.id != b.id ? a.id < b.id : a.slot < b.slot;
    });
    using Busy = std::pair<Position, std::uint32_t>;
    std::priority_queue<Busy, std::vector<Busy>, std::greater<>> busy;
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> free;
    std::uint32_t count = 0;
    for (const Item& item : items) {
      while (!busy.empty() && busy.top().first < item.start) {
        free.push(busy.top().second);
        busy.pop();
      }
      std::uint32_t place = count;
      if (free.empty()) {
        ++count;
      } else {
        place = free.top();
        free.pop();
      }
      busy.emplace(item.end, place);
      if (item.id != kNoScalar) {
        result_.place[item.id] = place;
      } else {
        result_.slots[slots_[item.slot].op].slot[slots_[item.slot].which] = place;
      }
    }
    return count;
  }

  const ScalarFunction& f_;
  Position end_ = 0;
  std::vector<Interval> intervals_;
  std::vector<std::uint8_t> used_;  ///< results that nothing reads need no place
  std::vector<std::uint32_t> loops_;
  std::vector<Slot> slots_;
  std::vector<ScalarId> parent_;
  Allocation result_;
};

}  // namespace

Allocation allocate(const ScalarFunction& function) { return Allocator(function).run(); }

}  // namespace vitrine::spirv::lowering
