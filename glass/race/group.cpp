// See group.h.
#include "glass/race/group.h"

#include <bit>
#include <utility>

namespace vitrine::glass::race {
namespace {

std::uint32_t site_of(std::uint32_t slot) { return (slot & ~kInterlocked) >> 4; }

Record record_of(const Slots& slots, std::uint32_t k) { return {slots.who[k], slots.time[k], slots.site[k]}; }

void put(Slots& slots, std::uint32_t k, const Record& record) {
  slots.who[k] = record.who;
  slots.time[k] = record.time;
  slots.site[k] = record.site;
}

/// Whether another invocation has done something to one of `count` words since `from`; who: `first` and those behind.
bool any_other(const Slots& slots, std::uint32_t k, std::uint32_t count, std::uint32_t first, std::uint32_t from) {
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < count; ++i)
    found |= static_cast<std::uint32_t>(slots.time[k + i] >= from) &
             static_cast<std::uint32_t>(slots.who[k + i] != first + i);
  return found != 0;
}

void put_row(Slots& slots, std::uint32_t k, std::uint32_t count, std::uint32_t first, std::uint32_t time,
             std::uint32_t site) {
  for (std::uint32_t i = 0; i < count; ++i) slots.who[k + i] = first + i;
  for (std::uint32_t i = 0; i < count; ++i) slots.time[k + i] = time;
  for (std::uint32_t i = 0; i < count; ++i) slots.site[k + i] = site;
}

}  // namespace

void Group::begin(const Told& program, const spirv::ObservedCommand* command, const Who& who, bool whole,
                  std::uint32_t shared_bytes) {
  const bool goes_on = whole && whole_ && runs(program, command);
  program_ = &program;
  command_ = command;
  whole_ = whole;
  interlocked_ = false;
  size_ = program.compute() ? program.size[0] * program.size[1] * program.size[2] : ~0u;
  waves_.clear();
  rounds_ = 0;
  arrived_ = {};
  arrived_fenced_ = 0;
  ++generation_;
  shared_.resize((shared_bytes + kPageBytes - 1) / kPageBytes);
  if (!goes_on) {
    device_.reset();
    groups_.clear();
    order_.begin(size_, program.sites.vulkan_model);
  }
  groups_.push_back(who);
  if (goes_on) order_.begin_group(static_cast<std::uint32_t>(groups_.size() - 1));
  base_ = static_cast<std::uint32_t>(groups_.size() - 1) * size_;
}

void Group::end(CommandLog& log) {
  if (!whole_ && device_.size() != 0) log.add(*program_, groups_[0], device_);
  device_.reset();
  program_ = nullptr;
}

Page& Group::page_of(const Site& site, std::uint64_t word) {
  const std::uint64_t number = word / kPageWords;
  if (site.memory != Memory::kShared) return device_.page(number);
  Page& page = shared_[number < shared_.size() ? number : shared_.size() - 1];
  if (page.generation != generation_) page.clear();
  page.generation = generation_;
  return page;
}

Access Group::access_of(std::uint32_t site, std::uint32_t who) const {
  if (!program_->compute()) return {program_, site, {{}, who}};
  Who there = groups_[std::min<std::size_t>(whole_ ? who / size_ : 0, groups_.size() - 1)];
  // Small workgroups share a wave: they lie one behind the other in x.
  there.group[0] += whole_ ? 0 : who / size_;
  there.local = who % size_;
  return {program_, site, there};
}

void Group::tell(const Record& earlier, std::uint32_t site, std::uint32_t who, const Touch& touch, Conflict::Kind kind,
                 bool equal) {
  Conflict conflict;
  conflict.earlier = access_of(site_of(earlier.site), earlier.who);
  conflict.later = access_of(site, who);
  conflict.address = touch.word * 4 + static_cast<std::uint32_t>(std::countr_zero(touch.bytes));
  conflict.kind = kind;
  conflict.equal = equal;
  pairs_.add(conflict, command_);
}

void Group::check(const Slots& slots, std::uint32_t k, std::uint32_t site, std::uint32_t who, const Touch& touch,
                  const Page& page) {
  if (slots.time[k] == 0 || slots.who[k] == who || (slots.site[k] & touch.bytes) == 0) return;
  const Record earlier = record_of(slots, k);
  const Site &now = program_->sites.all[site], &then = program_->sites.all[site_of(earlier.site)];
  Conflict::Kind kind = Conflict::Kind::kRace;
  if (now.is_atomic() && then.is_atomic()) {
    const bool near = order_.same_group(who, earlier.who);
    const auto covers = near ? spirv::covers_workgroup : spirv::covers_device;
    if (covers(now.order.memory) && covers(then.order.memory)) return;
    kind = Conflict::Kind::kScope;
  } else if (!now.writes() && !then.writes()) {
    return;
  }
  if (!order_.before(earlier, who, now.memory)) {
    const bool both = now.action == spirv::Access::kStore && then.action == spirv::Access::kStore;
    const bool locked = interlocked_ && (earlier.site & kInterlocked) != 0 && earlier.who == who;
    if (!locked) tell(earlier, site, who, touch, kind, both && page.value[k] == touch.value);
  } else if (then.writes() && now.action == spirv::Access::kLoad &&
             (now.is_private || then.is_private || order_.hidden(earlier, now.memory))) {
    tell(earlier, site, who, touch, Conflict::Kind::kVisibility, false);
  }
}

void Group::touch(std::uint32_t site, std::uint32_t who, const Touch& touch) {
  const Site& now = program_->sites.all[site];
  Page& page = page_of(now, touch.word);
  const auto k = static_cast<std::uint32_t>(touch.word % kPageWords);
  check(page.write, k, site, who, touch, page);
  check(page.atomic, k, site, who, touch, page);
  if (now.writes()) {
    check(page.read, k, site, who, touch, page);
    check(page.other, k, site, who, touch, page);
  }
  const Record record{who, order_.time(), site << 4 | touch.bytes | (interlocked_ ? kInterlocked : 0)};
  if (now.is_atomic()) {
    put(page.atomic, k, record);
    return order_.atomic(now, std::uint64_t{now.memory == Memory::kShared} << 63 | touch.word, who);
  }
  if (now.writes()) {
    page.value[k] = touch.value;
    return put(page.write, k, record);
  }
  const bool first =
      page.read.time[k] == 0 || page.read.who[k] == who || order_.before(record_of(page.read, k), who, now.memory);
  put(first ? page.read : page.other, k, record);
}

bool Group::fast(const Site& site) const {
  if (whole_ || order_.hides(site.memory) || interlocked_ || !program_->compute()) return false;
  if (!site.is_atomic()) return true;
  return !program_->sites.has_narrow_scope && !site.order.releases() && !site.order.acquires() && order_.is_plain();
}

std::uint32_t Group::writes_from(const Site& site) const {
  return site.memory != Memory::kShared && program_->sites.has_private ? 1 : order_.from(site.memory);
}

bool Group::load_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t from,
                         std::uint32_t writes_from) {
  const auto other = [&](const Slots& slots, std::uint32_t since) {
    return slots.time[k] >= since && slots.who[k] != record.who;
  };
  if (other(page.write, writes_from) || other(page.atomic, writes_from)) return false;
  if (!other(page.read, from)) {
    put(page.read, k, record);
  } else if (page.other.time[k] < from || page.other.who[k] == page.read.who[k]) {
    put(page.other, k, record);
  }
  return true;
}

bool Group::store_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t value, std::uint32_t from) {
  const auto other = [&](const Slots& slots) { return slots.time[k] >= from && slots.who[k] != record.who; };
  if (other(page.write) || other(page.atomic) || other(page.read) || other(page.other)) return false;
  put(page.write, k, record);
  page.value[k] = value;
  return true;
}

void Group::touch_row(std::uint32_t site, std::uint32_t first, std::uint64_t word, const std::uint32_t* values) {
  const Site& now = program_->sites.all[site];
  const std::uint32_t from = order_.from(now.memory), time = order_.time(), slot = site << 4 | 15;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth;) {
    const auto k = static_cast<std::uint32_t>((word + lane) % kPageWords);
    const std::uint32_t count = std::min<std::uint32_t>(kPageWords - k, base::kWaveWidth - lane);
    Page& page = page_of(now, word + lane);
    const std::uint32_t who = first + lane;
    const std::uint32_t written = values != nullptr ? from : writes_from(now);
    bool slow = !fast(now) || any_other(page.write, k, count, who, written) ||
                any_other(page.atomic, k, count, who, written) || any_other(page.read, k, count, who, from);
    if (!slow && values != nullptr) slow = any_other(page.other, k, count, who, from);
    if (slow) {
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t value = values != nullptr ? values[lane + i] : 0;
        const Record record{who + i, time, slot};
        const bool done = fast(now) && (values != nullptr ? store_quickly(page, k + i, record, value, from)
                                                          : load_quickly(page, k + i, record, from, written));
        if (!done) touch(site, who + i, {word + lane + i, 15, value});
      }
    } else {
      put_row(values != nullptr ? page.write : page.read, k, count, who, time, slot);
      for (std::uint32_t i = 0; i < count && values != nullptr; ++i) page.value[k + i] = values[lane + i];
    }
    lane += count;
  }
}

bool Group::operate_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t from) {
  const auto other = [&](const Slots& slots) { return slots.time[k] >= from && slots.who[k] != record.who; };
  if (other(page.write) || other(page.read) || other(page.other)) return false;
  put(page.atomic, k, record);
  return true;
}

void Group::touch_words(std::uint32_t site, base::LaneMask lanes, const std::uint64_t* words, std::uint32_t first,
                        const std::uint32_t* names, const std::uint32_t* values) {
  const Site& now = program_->sites.all[site];
  const bool quick = fast(now);
  const std::uint32_t from = order_.from(now.memory), written = writes_from(now);
  Record record{0, order_.time(), site << 4 | 15};
  const auto quickly = [&](std::uint64_t word, std::uint32_t value) {
    Page& page = page_of(now, word);
    const auto k = static_cast<std::uint32_t>(word % kPageWords);
    if (now.is_atomic()) return operate_quickly(page, k, record, from);
    return now.writes() ? store_quickly(page, k, record, value, from) : load_quickly(page, k, record, from, written);
  };
  std::uint64_t last = ~std::uint64_t{0}, before = last;
  base::for_each_lane(lanes, [&](std::size_t lane) {
    // Two readers of a word are kept: the others of a row add nothing.
    if (quick && now.action == spirv::Access::kLoad && words[lane] == last && last == before) return;
    before = std::exchange(last, words[lane]);
    record.who = names != nullptr ? names[lane] : first + static_cast<std::uint32_t>(lane);
    const std::uint32_t value = values != nullptr ? values[lane] : 0;
    if (!quick || !quickly(words[lane], value)) touch(site, record.who, {words[lane], 15, value});
  });
}

Group::WaveState& Group::state(std::uint32_t wave) {
  if (waves_.size() <= wave) waves_.resize(wave + 1);
  return waves_[wave];
}

void Group::arrive(std::uint32_t wave, const spirv::MemoryOrder& order, bool alone) {
  WaveState& here = state(wave);
  ++here.rounds;
  arrived_ = order;
  arrived_fenced_ |= std::exchange(here.fenced, 0);
  if (!alone) return;
  rounds_ = here.rounds;
  order_.barrier(arrived_, std::exchange(arrived_fenced_, 0));
}

void Group::resume(std::uint32_t wave) {
  const WaveState& here = state(wave);
  if (here.rounds <= rounds_) return;
  rounds_ = here.rounds;
  order_.barrier(arrived_, std::exchange(arrived_fenced_, 0));
}

void Group::fence(std::uint32_t wave, const spirv::MemoryOrder& order, std::uint32_t first, base::LaneMask lanes) {
  if (covers_workgroup(order.memory) && order.releases()) state(wave).fenced |= Order::memories_of(order.bits);
  order_.fence(order, first, lanes);
}

}  // namespace vitrine::glass::race
