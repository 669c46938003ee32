// See follow.h.
#include "glass/race/follow.h"

#include <algorithm>
#include <bit>

namespace vitrine::glass::race {

void Follower::begin(const Told& program, std::uint32_t bytes) {
  if (program_ != &program || bytes_ != bytes) {
    program_ = &program;
    bytes_ = bytes;
    failures_ = 0;
    way_ = 0;
    ways_.clear();
    patterns_.clear();
    patterns_.reserve(kMostPatterns);
  }
  at_ = since_barrier_ = 0;
  stores_ = 0;
  values_.clear();
  own_.clear();
  state_ = failures_ == kMostFailures ? State::kAlone : ways_.empty() ? State::kLeads : State::kFollows;
  if (state_ == State::kLeads) ++failures_;
}

void Follower::end(bool quiet) {
  if (state_ == State::kFollows && failures_ != 0) --failures_;
  if (state_ == State::kLeads && quiet) ways_.push_back(std::move(own_));
  state_ = State::kAlone;
}

template <class F>
bool Follower::find_other(F&& fits) {
  const auto here = ways_[way_].begin();
  for (std::size_t other = 0; other < ways_.size(); ++other) {
    const Steps& steps = ways_[other];
    if (other == way_ || steps.size() <= at_ || !fits(steps[at_])) continue;
    if (!std::equal(here, here + static_cast<std::ptrdiff_t>(at_), steps.begin())) continue;
    way_ = other;
    return true;
  }
  return false;
}

void Follower::leave() {
  if (failures_ < kMostFailures) ++failures_;
  state_ = ways_.size() < kMostWays ? State::kLeads : State::kAlone;
  if (state_ == State::kLeads) own_.assign(ways_[way_].begin(), ways_[way_].begin() + static_cast<std::ptrdiff_t>(at_));
  stores_ = values_.size();
}

Follower::Way Follower::access_other(std::uint32_t site, std::uint32_t first, base::LaneMask lanes,
                                     const Offsets& offsets, const Values& values) {
  Way way = Way::kOwn;
  if (state_ == State::kFollows) {
    const auto fits = [&](const Step& step) { return is(step, site, first, lanes, offsets); };
    if (find_other(fits)) {
      if (ways_[way_][at_].stored != 0) keep(values);
      ++at_;
      return Way::kSame;
    }
    leave();
    way = Way::kLeft;
  }
  if (state_ != State::kLeads) return way;
  Step step{site, first, offsets[static_cast<std::size_t>(std::countr_zero(lanes))], 0, lanes};
  for (std::uint32_t c = 0; c < 4; ++c) step.stored |= values[c] != nullptr ? 1u << c : 0;
  stores_ += static_cast<std::size_t>(std::popcount(step.stored));
  if (stores_ > kMostValues || (offsets.words != nullptr && !find_pattern(offsets, lanes, step)))
    give_up();
  else
    lead(step);
  return way;
}

void Follower::keep(const Values& values) {
  for (const std::uint32_t* const from : values)
    if (from != nullptr) std::copy_n(from, base::kWaveWidth, values_.emplace_back().lane);
}

bool Follower::find_pattern(const Offsets& offsets, base::LaneMask lanes, Step& step) {
  // The first one that fits, so that the same steps are the same in all ways.
  for (std::size_t i = 0; i < patterns_.size(); ++i) {
    step.more = patterns_[i].lane;
    if (are_behind(offsets.words, lanes, step.base, step.more)) return true;
  }
  if (patterns_.size() == kMostPatterns) return false;
  base::WaveRegister& pattern = patterns_.emplace_back();
  step.more = pattern.lane;
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) pattern.lane[lane] = offsets[lane] - step.base;
  return true;
}

void Follower::lead(const Step& step) {
  own_.push_back(step);
  if (own_.size() > kMostSteps) give_up();
}

void Follower::barrier() {
  const auto is_barrier = [](const Step& step) { return step.site == kBarrier; };
  if (state_ == State::kFollows) {
    if ((at_ < ways_[way_].size() && is_barrier(ways_[way_][at_])) || find_other(is_barrier)) {
      since_barrier_ = ++at_;
      values_.clear();
      return;
    }
    leave();
  }
  stores_ = 0;
  if (state_ == State::kLeads) lead({kBarrier});
}

bool Follower::give_up() {
  const bool followed = state_ == State::kFollows;
  state_ = State::kAlone;
  failures_ = kMostFailures;
  return followed;
}

}  // namespace vitrine::glass::race
