// Reads of bytes that nothing had written when they were read. What another invocation of the same command writes
// counts as written, before or after: so they become findings only when the command's work is done, and what is found
// does not depend on which invocation came first.
#pragma once

#include <atomic>
#include <compare>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "glass/memory_shadow.h"
#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {

/// Adjacent bytes of one region.
struct Piece {
  const ShadowRegion* region = nullptr;
  std::uintptr_t address = 0;
  std::uint32_t bytes = 0;
  Contents contents = Contents::kBytes;

  bool written() const { return region->written(address, bytes, contents); }
};

/// What one invocation has read.
struct UnwrittenRead {
  std::vector<Piece> pieces;
  /// A fault while any piece is unwritten, or only while all are: of a filter's texels it is not known which count.
  bool needs_all = false;
  std::function<std::string()> message;  ///< asked, if ever, before the command's resources are gone

  bool holds() const;
};

/// Where a read is: what tells findings apart.
struct ReadPlace {
  ProgramPlaces* program = nullptr;
  std::uint64_t number = 0;  ///< of the instruction
  const char* rule = "";
  spirv::ir::Origin origin;
};

/// Those of all programs, until their commands are done.
class UnwrittenReads {
 public:
  /// Keeps the first reads of a place, in order, and the number of the others.
  void add(const ReadPlace& place, const spirv::ObservedCommand* command, const Id& id, const Order& order,
           UnwrittenRead read);
  /// The work of an owner's commands is done (Tool::commands_done()): what still holds goes to the programs' places,
  /// and counts as written from now on, so that it is told once.
  void settle(const void* owner);

 private:
  struct Read {
    Order order;
    Id id;
    const spirv::ObservedCommand* command = nullptr;
    UnwrittenRead read;
    bool operator<(const Read& other) const { return order < other.order; }
  };
  struct Reads {
    spirv::ir::Origin origin;
    std::vector<Read> kept;  ///< a heap, last in order on top, once there are kMostReads
    std::uint64_t others = 0;
  };
  struct Key {
    const void* owner;
    ProgramPlaces* program;
    std::uint64_t number;
    std::string_view rule;
    auto operator<=>(const Key&) const = default;
  };
  using All = std::map<Key, Reads>;

  static void tell(const Key& key, const Reads& reads);

  std::mutex mutex_;
  std::atomic<bool> any_{false};
  All reads_;
};

}  // namespace vitrine::glass::sanitize
