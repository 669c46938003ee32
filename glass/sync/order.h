// What happens before what, and which writes are available and visible to whom, as vector clocks over pipeline stages
// (Vulkan 1.3.239, Synchronization and Cache Control: Execution and Memory Dependencies).
#pragma once

#include <array>
#include <span>

#include "glass/sync/stages.h"

namespace vitrine::glass::sync {

/// A moment: submission << 32 | number of the command << 2 | part of the command. Parts: the dependencies in front of
/// what it does, what it does, those behind it.
using Tag = std::uint64_t;
enum class Part : std::uint8_t { kBefore, kWork, kBehind };
constexpr Tag make_tag(std::uint64_t submission, std::uint32_t command, Part part) {
  return submission << 32 | std::uint64_t{command} << 2 | static_cast<std::uint64_t>(part);
}
/// Behind all commands of a submission.
constexpr Tag end_of_submission(std::uint64_t submission) { return submission << 32 | 0xffffffff; }

/// A stage has one kind of writes but for transform feedback, which has two.
inline constexpr std::size_t kWrites = kStages + 1;
constexpr std::size_t write_class(Use use) {
  return use.access == Access::kCounterWrite ? kStages : static_cast<std::size_t>(use.stage);
}

/// All that happened until then. `done`: what stages did up to a tag; `available`: writes up to a tag. What a
/// dependency for a range made available is `done` with the stages behind that dependency.
struct Clock {
  std::array<Tag, kStages> done{};
  std::array<Tag, kWrites> available{};
  void join(const Clock& other);
};

/// A dependency for a range of memory that a write came by: in the stages of its second scope it is available, and to
/// some of their accesses visible.
struct Passage {
  Scope second;
  Tag tag = 0;
  bool operator==(const Passage& other) const {
    return tag == other.tag && second.executed == other.second.executed && second.accessed == other.second.accessed &&
           second.accesses == other.second.accesses;
  }
};

/// How an access stands to a write that comes before it.
enum class Standing : std::uint8_t {
  kVisible,
  kNotVisible,    ///< ordered, and available
  kNotAvailable,  ///< ordered
  kUnordered,
};

/// A write as the clocks see it.
struct PastWrite {
  Use use;
  Tag tag = 0;
  std::span<const Passage> passages;
};

class Order {
 public:
  /// What happens before a dependency with this first scope that is recorded at `tag`.
  Clock before(const Scope& first, Tag tag) const;
  /// What `clock` holds happens before the second scope. `memory`: is made visible to it.
  void after(const Scope& second, const Clock& clock, bool memory);

  Standing standing(const PastWrite& write, Use use) const;
  /// To a dependency whose first scope holds `before`: kVisible if the write is available.
  static Standing standing(const PastWrite& write, const Clock& before);
  /// Whether what a stage did at a tag happens before a use.
  bool is_before(Stage stage, Tag tag, Use use) const { return ahead(use.stage).done[index(stage)] >= tag; }

 private:
  static constexpr std::size_t index(Stage stage) { return static_cast<std::size_t>(stage); }
  const Clock& ahead(Stage stage) const { return ahead_[index(stage)]; }

  std::array<Clock, kStages> ahead_{};                           ///< of what a stage does next
  std::array<std::array<Clock, kAccesses>, kStages> visible_{};  ///< to its accesses
};

}  // namespace vitrine::glass::sync
