// What is ordered in one workgroup: barriers, fences and atomic operations, in times that only grow (Vulkan 1.3.239,
// Memory Model). Of dispatches whose workgroups order each other by atomic operations, one after the other, all of
// them.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/lanes.h"
#include "glass/race/clock.h"

namespace vitrine::glass::race {

inline bool covers_subgroup(spirv::MemoryScope scope) {
  return spirv::covers_workgroup(scope) || scope == spirv::MemoryScope::kSubgroup;
}

/// What the invocations of a wave are called, by lane.
struct WaveNames {
  std::uint32_t first = 0;               ///< of lane 0, the others behind it; or
  const std::uint32_t* names = nullptr;  ///< those of all lanes

  std::uint32_t operator[](std::size_t lane) const {
    return names != nullptr ? names[lane] : first + static_cast<std::uint32_t>(lane);
  }
};

/// An access that has been recorded.
struct Record {
  std::uint32_t who = 0, time = 0, site = 0;
};

class Order {
 public:
  /// A dispatch, or a workgroup that nothing orders with others. `size`: invocations of a workgroup.
  /// `narrow`: some atomic operations' scope does not hold the device.
  void begin(std::uint32_t size, bool vulkan_model, bool narrow);
  /// The next workgroup of a dispatch.
  void begin_group(std::uint32_t group);

  std::uint32_t time() const { return time_; }
  std::uint32_t group() const { return group_; }
  /// Barriers have ordered what the workgroup did before this.
  std::uint32_t from(Memory memory) const { return from_[static_cast<std::size_t>(memory)]; }

  /// Lanes `lanes` of a wave come by OpMemoryBarrier.
  void fence(const spirv::MemoryOrder& order, const WaveNames& wave, base::LaneMask lanes);
  /// All of the workgroup have come by OpControlBarrier; `fenced`: kinds of memory (a bit each) for which they have
  /// come by OpMemoryBarrier before.
  void barrier(const spirv::MemoryOrder& order, std::uint32_t fenced);
  /// The same of a subgroup.
  void subgroup_barrier(const spirv::MemoryOrder& order, std::uint32_t first);
  /// An invocation does an atomic operation on what `location` tells apart.
  void atomic(const Site& site, std::uint64_t location, std::uint32_t who);

  /// Whether an atomic operation without semantics orders nothing: nobody has released or fenced anything.
  bool is_plain() const { return locations_.empty() && invocations_.empty() && group_fenced_ == Times{}; }

  /// Whether an access that was recorded happened before what `who` does now.
  bool before(const Record& record, std::uint32_t who, Memory memory) const;
  /// Whether barriers have ordered what was recorded, but nothing has made it available and visible (Vulkan memory
  /// model). `available`, `visible`: the write or the read does so by itself.
  bool hidden(const Record& record, Memory memory, bool available, bool visible) const;
  /// Whether there are such barriers.
  bool hides(Memory memory) const {
    return visible_[static_cast<std::size_t>(memory)] != from_[static_cast<std::size_t>(memory)];
  }
  bool same_group(std::uint32_t a, std::uint32_t b) const { return a / size_ == b / size_; }
  bool same_subgroup(std::uint32_t a, std::uint32_t b) const {
    return same_group(a, b) && subgroup_of(a) == subgroup_of(b);
  }

  /// Kinds of memory that a barrier orders.
  static std::uint32_t memories_of(std::uint32_t semantics);

 private:
  struct Invocation {
    Clock known, pending;  ///< pending: read by atomic operations, not acquired
    Times fenced{};        ///< accesses before it are released by atomic writes that follow
    bool device = false;   ///< the fence's scope
  };
  struct Location {
    Clock device, group, subgroup;
    std::uint32_t of_group = 0, of_subgroup = 0;  ///< whose `group` and `subgroup` are
  };

  /// Its number in the workgroup. Of draws one wave is looked at.
  std::uint32_t subgroup_of(std::uint32_t who) const {
    return size_ == ~0u ? 0 : who % size_ / static_cast<std::uint32_t>(base::kWaveWidth);
  }

  void acquire(Invocation& invocation, const Clock& from);
  void release(Clock& to, std::uint32_t who, const Invocation& invocation, std::uint32_t memories, bool fence_only);

  std::uint32_t size_ = 1, time_ = 1, group_ = 0;
  bool vulkan_model_ = false, narrow_ = false;
  Times from_{}, visible_{};                 ///< visible: and have made it available and visible
  Times available_from_{}, visible_from_{};  ///< each of the two alone
  std::vector<Times> subgroups_;             ///< by number in the workgroup
  std::unordered_map<std::uint32_t, Invocation> invocations_;
  // Through barriers:
  Clock group_known_, group_pending_;
  Times group_fenced_{};
  bool group_device_ = false;
  std::unordered_map<std::uint64_t, Location> locations_;
};

}  // namespace vitrine::glass::race
