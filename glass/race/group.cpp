// See group.h.
#include "glass/race/group.h"

#include <bit>
#include <utility>

namespace vitrine::glass::race {
namespace {

std::uint32_t site_of(std::uint32_t slot) { return (slot & ~kInterlocked) >> 4; }

Record record_of(const Slots& slots, std::uint32_t k) { return {slots.who[k], slots.time[k], slots.site[k]}; }

/// Whether a write, or a read, does by itself what a barrier may do (Vulkan memory model).
bool makes_available(const Site& site) { return (site.order.bits & spirv::MemoryOrder::kPointerAvailable) != 0; }
bool makes_visible(const Site& site) { return (site.order.bits & spirv::MemoryOrder::kPointerVisible) != 0; }

void put(Slots& slots, std::uint32_t k, const Record& record) {
  slots.who[k] = record.who;
  slots.time[k] = record.time;
  slots.site[k] = record.site;
  slots.used |= std::uint64_t{1} << k;
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
  shared_bytes_ = shared_bytes;
  shared_is_quiet_ = true;
  log_.clear();
  if (!goes_on) {
    device_.reset();
    groups_.clear();
    order_.begin(size_, program.sites.vulkan_model, program.sites.has_narrow_scope);
  }
  groups_.push_back(who);
  if (goes_on) order_.begin_group(static_cast<std::uint32_t>(groups_.size() - 1));
  base_ = static_cast<std::uint32_t>(groups_.size() - 1) * size_;
  logs_loads_ = program.compute() && !order_.hides(Memory::kShared);
  const bool alone = by_word_ || whole || !program.compute() || program.sites.vulkan_model ||
                     program.sites.orders_shared || shared_bytes == 0;
  alone ? follower_.skip() : follower_.begin(program, shared_bytes);
}

void Group::end(CommandLog& log) {
  if (follower_.is_on()) follower_.end(shared_is_quiet_);
  // Which waves of a draw atomic operations order is not followed.
  if (!whole_ && !program_->sites.orders_waves && device_.size() != 0) log.add(*program_, groups_[0], device_);
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
  if (program_->sites.all[site].memory == Memory::kShared) shared_is_quiet_ = false;
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
    const auto covers = order_.same_subgroup(who, earlier.who) ? covers_subgroup
                        : order_.same_group(who, earlier.who)  ? spirv::covers_workgroup
                                                               : spirv::covers_device;
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
             (now.is_private || then.is_private ||
              order_.hidden(earlier, now.memory, makes_available(then), makes_visible(now)))) {
    tell(earlier, site, who, touch, Conflict::Kind::kVisibility, false);
  }
}

void Group::touch(const Doing& by, std::uint32_t who, const Touch& touch) {
  const std::uint32_t site = by.site;
  const Site& now = program_->sites.all[site];
  Page& page = page_of(now, touch.word);
  const auto k = static_cast<std::uint32_t>(touch.word % kPageWords);
  check(page.write, k, site, who, touch, page);
  check(page.atomic, k, site, who, touch, page);
  if (now.writes()) {
    check(page.read, k, site, who, touch, page);
    check(page.other, k, site, who, touch, page);
  }
  // Each lane of an atomic operation is a moment of its own.
  const std::uint32_t time = now.is_atomic() ? order_.time() : by.time;
  const Record record{who, time, site << 4 | touch.bytes | (interlocked_ ? kInterlocked : 0)};
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

void Group::touch_bytes(const Doing& by, std::uint32_t who, std::uint64_t address, std::uint32_t count,
                        std::uint32_t value) {
  while (count != 0) {
    const auto in_word = static_cast<std::uint32_t>(address & 3), part = std::min(count, 4 - in_word);
    touch(by, who, {address / 4, ((1u << part) - 1) << in_word, value});
    address += part;
    count -= part;
  }
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
  if (alone) pass_barrier(here.rounds);
}

void Group::resume(std::uint32_t wave) {
  const WaveState& here = state(wave);
  if (here.rounds > rounds_) pass_barrier(here.rounds);
}

void Group::pass_barrier(std::uint32_t rounds) {
  rounds_ = rounds;
  if (arrived_.memory == spirv::MemoryScope::kSubgroup) {
    stop_following();
    settle_shared();
  }
  const std::uint32_t from = order_.from(Memory::kShared);
  order_.barrier(arrived_, std::exchange(arrived_fenced_, 0));
  if (order_.from(Memory::kShared) != from) {
    log_.clear();
    if (follower_.is_on()) follower_.barrier();
  }
  logs_loads_ = program_->compute() && !order_.hides(Memory::kShared);
}

void Group::fence(std::uint32_t wave, const spirv::MemoryOrder& order, const WaveNames& names, base::LaneMask lanes) {
  if (program_->sites.has_atomics) stop_following();
  if (log_.has_atomics()) settle_shared();
  if (covers_workgroup(order.memory) && order.releases()) state(wave).fenced |= Order::memories_of(order.bits);
  order_.fence(order, names, lanes);
}

void Group::subgroup_barrier(const spirv::MemoryOrder& order, std::uint32_t first) {
  stop_following();
  settle_shared();
  order_.subgroup_barrier(order, first);
}

}  // namespace vitrine::glass::race
