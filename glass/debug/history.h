// What has happened in the waves that a debugger watches, in the order in which it happened, and a position in it. One
// wave runs at a time. Bounded: what is too old is forgotten.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "glass/debug/run.h"

namespace vitrine::glass::debug {

/// Bytes of all logs together.
inline constexpr std::size_t kMostHistory = std::size_t{256} << 20;

class History {
 public:
  /// From here on entries are those of `run`: it starts, or goes on behind a barrier.
  void enter(std::shared_ptr<Run> run);
  /// The running wave has one more entry.
  void grown();

  /// Nothing has been taken back.
  bool at_end() const { return segment_ + 1 >= segments_.size() && (segments_.empty() || next_ == last().end); }
  /// Does the next entry again; false: there is none.
  bool forward();
  /// Takes the last one back; false: what was before it is forgotten.
  bool backward();
  struct Done {
    std::shared_ptr<Run> run;  ///< null: there is none
    const Run::Entry* entry = nullptr;
  };
  /// The last entry that is done.
  Done done() const;
  const std::shared_ptr<Run>& run() const { return run_; }
  /// As run(), of the wave that runs.
  const std::shared_ptr<Run>& running() const { return last().run; }
  /// Calls f(run, entry) for what is done, the last first, until it is false.
  template <class F>
  void for_each_back(F&& f) const {
    for (std::size_t segment = segment_, end = next_; segment < segments_.size(); end = segments_[--segment].end) {
      const Segment& at = segments_[segment];
      for (std::size_t i = end; i-- > at.begin;)
        if (!f(at.run, at.run->entry(i))) return;
      if (at.run != run_) pack(at);
      if (segment == 0) return;
    }
  }
  /// Entries of a run that are done.
  std::size_t position_in(const Run& run) const;
  bool empty() const { return segments_.empty(); }

 private:
  struct Segment {
    std::shared_ptr<Run> run;
    std::size_t begin = 0, end = 0;  ///< entries
    std::size_t bytes = 0;           ///< that count in closed_bytes_
  };
  const Segment& last() const { return segments_.back(); }
  /// It is left. A run that waits at barriers is left as often as others run in between, and stays as it is.
  void pack(const Segment& segment) const;
  /// The last segment but one has ended.
  void close_previous();
  void forget_old();
  /// The position moves to another segment.
  void go_to(std::size_t segment);

  std::deque<Segment> segments_;
  std::size_t segment_ = 0, next_ = 0;  ///< position: the next entry
  std::shared_ptr<Run> run_;            ///< whose entry was done or taken back last
  std::size_t closed_bytes_ = 0;        ///< of the runs of all segments but the last
};

}  // namespace vitrine::glass::debug
