// See history.h.
#include "glass/debug/history.h"

namespace vitrine::glass::debug {

void History::enter(std::shared_ptr<Run> run) {
  run_ = run;
  next_ = run->size();
  segments_.push_back({std::move(run), next_, next_});
  segment_ = segments_.size() - 1;
  close_previous();
  forget_old();
}

void History::pack(const Segment& segment) const {
  if (segment.run != last().run && segment.begin == 0 && segment.end == segment.run->size()) segment.run->pack();
}

/// Of a run with several segments its bytes count for each: the bound is kept, not met.
void History::close_previous() {
  if (segments_.size() < 2) return;
  Segment& closed = segments_[segments_.size() - 2];
  pack(closed);
  closed.bytes = closed.run->bytes();
  closed_bytes_ += closed.bytes;
}

void History::forget_old() {
  while (segments_.size() > 1 && closed_bytes_ > kMostHistory / 2) {
    closed_bytes_ -= segments_.front().bytes;
    segments_.pop_front();
    if (segment_ > 0) --segment_;
  }
}

void History::go_to(std::size_t segment) {
  pack(segments_[segment_]);
  segment_ = segment;
}

void History::grown() {
  Segment& segment = segments_.back();
  if (segment.run->bytes() > kMostHistory / 2) {
    for (std::size_t i = segments_.size() - 1; i-- > 0;) {
      if (segments_[i].run != segment.run) continue;
      closed_bytes_ -= segments_[i].bytes;
      segments_.erase(segments_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    segment_ = segments_.size() - 1;
    Segment& left = segments_.back();
    left.run->forget();
    left.begin = left.end = next_ = 0;
    return;
  }
  segment.end = next_ = segment.run->size();
}

bool History::forward() {
  while (segment_ < segments_.size() && next_ == segments_[segment_].end) {
    if (segment_ + 1 == segments_.size()) return false;
    go_to(segment_ + 1);
    next_ = segments_[segment_].begin;
  }
  if (segment_ >= segments_.size()) return false;
  run_ = segments_[segment_].run;
  run_->exchange(run_->entry(next_++), false, *last().run);
  return true;
}

bool History::backward() {
  if (segments_.empty()) return false;
  while (next_ == segments_[segment_].begin) {
    if (segment_ == 0) return false;
    go_to(segment_ - 1);
    next_ = segments_[segment_].end;
  }
  run_ = segments_[segment_].run;
  run_->exchange(run_->entry(--next_), true, *last().run);
  return true;
}

std::size_t History::position_in(const Run& run) const {
  for (std::size_t i = segments_.size(); i-- > 0;) {
    const Segment& segment = segments_[i];
    if (segment.run.get() != &run || i > segment_) continue;
    return i == segment_ ? next_ : segment.end;
  }
  return 0;
}

History::Done History::done() const {
  std::size_t segment = segment_, next = next_;
  if (segments_.empty()) return {};
  while (next == segments_[segment].begin) {
    if (segment == 0) return {};
    next = segments_[--segment].end;
  }
  return {segments_[segment].run, &segments_[segment].run->entry(next - 1)};
}

}  // namespace vitrine::glass::debug
