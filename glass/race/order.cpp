// See order.h. Where the memory model asks for a fence on both sides of a control barrier, one in front of it is taken
// for both, as the languages do.
#include "glass/race/order.h"

namespace vitrine::glass::race {
namespace {

using spirv::MemoryOrder;
using spirv::MemoryScope;

Times times_of(std::uint32_t memories, std::uint32_t time) {
  Times times{};
  for (std::size_t m = 0; m < kMemories; ++m) times[m] = (memories >> m & 1) != 0 ? time : 0;
  return times;
}

}  // namespace

std::uint32_t Order::memories_of(std::uint32_t semantics) {
  return ((semantics & MemoryOrder::kWorkgroupMemory) != 0 ? 1u << static_cast<unsigned>(Memory::kShared) : 0) |
         ((semantics & MemoryOrder::kUniformMemory) != 0 ? 1u << static_cast<unsigned>(Memory::kBuffer) : 0) |
         ((semantics & MemoryOrder::kImageMemory) != 0 ? 1u << static_cast<unsigned>(Memory::kImage) : 0);
}

void Order::begin(std::uint32_t size, bool vulkan_model, bool narrow) {
  size_ = std::max(size, 1u);
  vulkan_model_ = vulkan_model;
  narrow_ = narrow;
  time_ = 1;
  locations_.clear();
  begin_group(0);
}

void Order::begin_group(std::uint32_t group) {
  group_ = group;
  ++time_;
  from_ = visible_ = available_from_ = visible_from_ = times_of(7, time_);
  subgroups_.clear();
  invocations_.clear();
  group_known_.clear();
  group_pending_.clear();
  group_fenced_ = {};
  group_device_ = false;
}

void Order::fence(const MemoryOrder& order, const WaveNames& wave, base::LaneMask lanes) {
  const std::uint32_t memories = memories_of(order.bits);
  if (memories == 0 || (!order.acquires() && !order.releases())) return;
  ++time_;
  base::for_each_lane(lanes, [&](std::size_t lane) {
    Invocation& invocation = invocations_[wave[lane]];
    if (order.releases()) {
      raise(invocation.fenced, times_of(memories, time_));
      invocation.device = covers_device(order.memory);
    }
    if (!order.acquires()) return;
    invocation.known.join(invocation.pending);
    invocation.known.join(group_pending_);
  });
}

void Order::barrier(const MemoryOrder& order, std::uint32_t fenced) {
  ++time_;
  std::uint32_t memories = fenced;
  if (covers_workgroup(order.memory) && order.acquires() && order.releases()) memories |= memories_of(order.bits);
  if (order.memory == MemoryScope::kSubgroup)
    for (std::uint32_t first = 0; first < size_; first += base::kWaveWidth) subgroup_barrier(order, first);
  raise(from_, times_of(memories, time_));
  raise(group_fenced_, times_of(fenced, time_));
  const bool available = !vulkan_model_ || (order.bits & MemoryOrder::kMakeAvailable) != 0;
  const bool visible = !vulkan_model_ || (order.bits & MemoryOrder::kMakeVisible) != 0;
  if (available) raise(available_from_, times_of(memories, time_));
  if (visible) raise(visible_from_, times_of(memories, time_));
  if (available && visible) raise(visible_, times_of(memories, time_));
  for (const auto& [who, invocation] : invocations_) {
    group_known_.join(invocation.known);
    group_pending_.join(invocation.pending);
    group_device_ |= invocation.device;
  }
  invocations_.clear();
}

void Order::subgroup_barrier(const MemoryOrder& order, std::uint32_t first) {
  if (!covers_subgroup(order.memory) || !order.acquires() || !order.releases()) return;
  ++time_;
  const std::size_t number = first % size_ / base::kWaveWidth;
  if (subgroups_.size() <= number) subgroups_.resize(number + 1);
  raise(subgroups_[number], times_of(memories_of(order.bits), time_));
}

void Order::release(Clock& to, std::uint32_t who, const Invocation& invocation, std::uint32_t memories,
                    bool fence_only) {
  Times own = invocation.fenced;
  raise(own, group_fenced_);
  if (!fence_only) raise(own, times_of(memories, time_));
  std::uint32_t released = memories;
  for (std::size_t m = 0; m < kMemories; ++m) released |= own[m] != 0 ? 1u << m : 0;
  to.add_invocation(who, own);
  Times group{};
  for (std::size_t m = 0; m < kMemories; ++m) group[m] = (released >> m & 1) != 0 ? from_[m] : 0;
  to.add_group(group_, group);
  const std::size_t subgroup = who % size_ / base::kWaveWidth;
  if (subgroup < subgroups_.size())
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
      to.add_invocation(who - who % size_ % base::kWaveWidth + lane, subgroups_[subgroup]);
  to.join(invocation.known);
  to.join(group_known_);
}

void Order::atomic(const Site& site, std::uint64_t location, std::uint32_t who) {
  const MemoryOrder& order = site.order;
  const auto own = invocations_.find(who);
  const bool releases = site.atomic_writes && order.releases();
  const bool fenced = group_fenced_ != Times{} || (own != invocations_.end() && own->second.fenced != Times{});
  const auto at = locations_.find(location);
  if (!releases && !fenced && at == locations_.end()) return;
  Location& there = locations_[location];
  Invocation& invocation = invocations_[who];
  const bool subgroup_valid = there.of_group == group_ && there.of_subgroup == subgroup_of(who);
  const bool group_valid = there.of_group == group_ && !there.group.empty();
  if (site.atomic_reads) {
    Clock seen;
    if (covers_device(order.memory)) seen.join(there.device);
    if (group_valid && covers_workgroup(order.memory)) seen.join(there.group);
    if (subgroup_valid && covers_subgroup(order.memory)) seen.join(there.subgroup);
    invocation.pending.join(seen);
    if (order.acquires()) invocation.known.join(seen);
  } else {
    there.device.clear();
    there.group.clear();
    there.subgroup.clear();
  }
  if (!site.atomic_writes || (!releases && !fenced)) return;
  if (!subgroup_valid) there.subgroup.clear();
  if (there.of_group != group_) there.group.clear();
  there.of_group = group_;
  there.of_subgroup = subgroup_of(who);
  ++time_;
  const std::uint32_t memories = releases ? memories_of(order.bits) : 0;
  if (narrow_ && covers_subgroup(order.memory)) release(there.subgroup, who, invocation, memories, !releases);
  if (covers_workgroup(order.memory)) release(there.group, who, invocation, memories, !releases);
  if (covers_device(order.memory) && (releases || invocation.device || group_device_))
    release(there.device, who, invocation, memories, !releases);
}

bool Order::before(const Record& record, std::uint32_t who, Memory memory) const {
  const auto m = static_cast<std::size_t>(memory);
  if (record.who == who) return true;
  const std::uint32_t group = record.who / size_;
  if (group == group_) {
    if (record.time < from_[m]) return true;
    const std::size_t subgroup = who % size_ / base::kWaveWidth;
    if (subgroup < subgroups_.size() && record.who % size_ / base::kWaveWidth == subgroup &&
        record.time < subgroups_[subgroup][m])
      return true;
  }
  if (group_known_.knows(record.who, group, record.time, m)) return true;
  const auto own = invocations_.find(who);
  return own != invocations_.end() && own->second.known.knows(record.who, group, record.time, m);
}

bool Order::hidden(const Record& record, Memory memory, bool available, bool visible) const {
  const auto m = static_cast<std::size_t>(memory);
  if (record.who / size_ != group_ || record.time >= from_[m]) return false;
  return (!available && record.time >= available_from_[m]) || (!visible && record.time >= visible_from_[m]);
}

}  // namespace vitrine::glass::race
