// The table of memory that pointers may reach: changed under a lock, read through a copy that each thread keeps until
// the table changes.
#include "spirv/addresses.h"

#include "base/lasting.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <vector>

namespace vitrine::spirv {
namespace {

struct Entry {
  std::uint64_t end = 0;
  std::uint32_t count = 0;  ///< times added: host memory may be imported more than once
};

struct Table {
  std::mutex mutex;
  std::map<std::uint64_t, Entry> entries;  ///< by first address
  std::atomic<std::uint64_t> version{1};
};

Table& table() {
  static Table& instance = base::lasting([] { return Table(); });
  return instance;
}

/// A thread's copy, sorted.
struct Snapshot {
  std::uint64_t version = 0;
  std::vector<AddressRange> ranges;
};

const std::vector<AddressRange>& current_ranges() {
  auto& snapshot = base::per_thread<Snapshot>();
  Table& t = table();
  if (snapshot.version != t.version.load(std::memory_order_acquire)) {
    const std::lock_guard lock(t.mutex);
    snapshot.ranges.clear();
    for (const auto& [begin, entry] : t.entries) snapshot.ranges.push_back({begin, entry.end});
    snapshot.version = t.version.load(std::memory_order_relaxed);
  }
  return snapshot.ranges;
}

}  // namespace

void add_addresses(const std::byte* data, std::uint64_t size) {
  const auto begin = reinterpret_cast<std::uintptr_t>(data);
  Table& t = table();
  const std::lock_guard lock(t.mutex);
  Entry& entry = t.entries[begin];
  entry.end = std::max(entry.end, begin + size);
  ++entry.count;
  t.version.fetch_add(1, std::memory_order_release);
}

void remove_addresses(const std::byte* data) noexcept try {
  Table& t = table();
  const std::lock_guard lock(t.mutex);
  const auto found = t.entries.find(reinterpret_cast<std::uintptr_t>(data));
  if (found == t.entries.end() || --found->second.count != 0) return;
  t.entries.erase(found);
  t.version.fetch_add(1, std::memory_order_release);
} catch (const std::bad_alloc&) {
  // There is no table yet: nothing was added.
}

AddressRange find_addresses(std::uint64_t address) {
  const std::vector<AddressRange>& ranges = current_ranges();
  const auto after =
      std::upper_bound(ranges.begin(), ranges.end(), address,
                       [](std::uint64_t wanted, const AddressRange& range) { return wanted < range.begin; });
  if (after == ranges.begin() || address >= (after - 1)->end) return {};
  return *(after - 1);
}

}  // namespace vitrine::spirv
