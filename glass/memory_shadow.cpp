// The shadow of device memory: changed under a lock, found through a copy of the list that each thread keeps until the
// list changes.
#include "glass/memory_shadow.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "base/lasting.h"

namespace vitrine::glass {
namespace {

constexpr std::uint32_t kFourWritten = 0x01010101;

struct Table {
  std::mutex mutex;
  std::map<std::uintptr_t, std::unique_ptr<ShadowRegion>> regions;  ///< by first address
  std::atomic<std::uint64_t> version{1};
};

Table& table() {
  static Table& instance = base::lasting([] { return Table(); });
  return instance;
}

/// A thread's copy, ascending.
struct Snapshot {
  std::uint64_t version = 0;
  std::vector<ShadowRegion*> regions;
};

const std::vector<ShadowRegion*>& current_regions() {
  auto& snapshot = base::per_thread<Snapshot>();
  Table& t = table();
  if (snapshot.version != t.version.load(std::memory_order_acquire)) {
    const std::lock_guard lock(t.mutex);
    snapshot.regions.clear();
    for (const auto& [first, region] : t.regions) snapshot.regions.push_back(region.get());
    snapshot.version = t.version.load(std::memory_order_relaxed);
  }
  return snapshot.regions;
}

/// Shaders of many threads read and write states at the same time.
std::uint8_t load(const std::uint8_t& state) {
  return std::atomic_ref(const_cast<std::uint8_t&>(state)).load(std::memory_order_relaxed);
}

bool is_word(std::uintptr_t address, std::uint64_t bytes) { return bytes == 4 && address % 4 == 0; }

std::uint32_t load_word(const std::uint8_t* states) {
  return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(const_cast<std::uint8_t*>(states)))
      .load(std::memory_order_relaxed);
}

/// More changes than a region sees lie between two regions.
std::uint64_t first_generation() {
  static std::atomic<std::uint64_t> regions{0};
  return ++regions << 32;
}

}  // namespace

ShadowRegion::ShadowRegion(const std::byte* data, std::uint64_t size)
    : first_(reinterpret_cast<std::uintptr_t>(data)), size_(size), generation_(first_generation()) {
  void* states = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (states != MAP_FAILED) states_ = static_cast<std::uint8_t*>(states);
}

ShadowRegion::~ShadowRegion() {
  if (states_ != nullptr) munmap(states_, size_);
}

void ShadowRegion::map(std::uintptr_t first, std::uint64_t bytes) {
  mapped_first_.store(std::min(mapped_first_.load(), first));
  mapped_end_.store(std::max(mapped_end_.load(), first + bytes));
}

bool ShadowRegion::byte_written(std::uintptr_t address, Contents contents) const {
  switch (static_cast<ByteState>(load(states_[address - first_]))) {
    case ByteState::kWritten:
      return true;
    case ByteState::kFresh:
      return is_mapped(address, 1);
    case ByteState::kDiscarded:
    case ByteState::kDerived:
      return contents == Contents::kBytes && is_mapped(address, 1);
  }
  return true;
}

std::uint64_t ShadowRegion::first_unwritten(std::uintptr_t address, std::uint64_t bytes, Contents contents) const {
  if (!contains(address, bytes)) return bytes;
  if (contents == Contents::kBytes && is_mapped(address, bytes)) return bytes;
  const std::uint8_t* const states = states_ + (address - first_);
  if (is_word(address, bytes) && load_word(states) == kFourWritten) return bytes;
  for (std::uint64_t i = 0; i < bytes; ++i) {
    if ((address + i) % 4 == 0)
      while (bytes - i >= 4 && load_word(states + i) == kFourWritten) i += 4;
    if (i < bytes && !byte_written(address + i, contents)) return i;
  }
  return bytes;
}

void ShadowRegion::mark(std::uintptr_t address, std::uint32_t bytes, ByteState state) const {
  if (!contains(address, bytes)) return;
  std::uint8_t* const states = states_ + (address - first_);
  const bool word = is_word(address, bytes);
  if (word && load_word(states) == kFourWritten) return;
  if (word && state == ByteState::kWritten) {
    std::atomic_ref(*reinterpret_cast<std::uint32_t*>(states)).store(kFourWritten, std::memory_order_relaxed);
    return;
  }
  for (std::uint32_t i = 0; i < bytes; ++i) {
    // What another invocation has written stays so.
    std::atomic_ref byte(states[i]);
    std::uint8_t old = byte.load(std::memory_order_relaxed);
    const auto written = static_cast<std::uint8_t>(ByteState::kWritten);
    while (old != written &&
           !byte.compare_exchange_weak(old, static_cast<std::uint8_t>(state), std::memory_order_relaxed)) {
    }
  }
}

void ShadowRegion::fill(std::uintptr_t address, std::uint64_t bytes, ByteState state) const {
  const std::uintptr_t begin = std::max(address, first()), stop = std::min(address + bytes, end());
  if (begin >= stop) return;
  if (state != ByteState::kWritten) generation_.fetch_add(1, std::memory_order_relaxed);
  std::memset(states_ + (begin - first_), static_cast<int>(state), stop - begin);
}

void ShadowRegion::settle(std::uintptr_t address, std::uint64_t bytes, Contents contents) const {
  const std::uintptr_t begin = std::max({address, first(), mapped_first_.load(std::memory_order_relaxed)});
  const std::uintptr_t stop = std::min({address + bytes, end(), mapped_end_.load(std::memory_order_relaxed)});
  for (std::uintptr_t at = begin; at < stop; ++at) {
    while (at % 4 == 0 && stop - at >= 4 && load_word(states_ + (at - first_)) == kFourWritten) at += 4;
    if (at < stop && byte_written(at, contents)) states_[at - first_] = static_cast<std::uint8_t>(ByteState::kWritten);
  }
}

void add_shadow(const std::byte* data, std::uint64_t size) noexcept {
  try {
    auto region = std::make_unique<ShadowRegion>(data, size);
    if (!region->has_states()) return;
    Table& t = table();
    const std::lock_guard lock(t.mutex);
    t.regions[region->first()] = std::move(region);
    t.version.fetch_add(1, std::memory_order_release);
  } catch (const std::bad_alloc&) {
    // Memory that is not known counts as written.
  }
}

void remove_shadow(const std::byte* data) noexcept try {
  Table& t = table();
  const std::lock_guard lock(t.mutex);
  if (t.regions.erase(reinterpret_cast<std::uintptr_t>(data)) != 0) t.version.fetch_add(1, std::memory_order_release);
} catch (const std::bad_alloc&) {
  // There is no table yet: nothing was added.
}

ShadowRegion* find_shadow(const void* address) {
  const std::vector<ShadowRegion*>& regions = current_regions();
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  const auto after =
      std::upper_bound(regions.begin(), regions.end(), wanted,
                       [](std::uintptr_t address, const ShadowRegion* region) { return address < region->first(); });
  if (after == regions.begin() || wanted >= (*(after - 1))->end()) return nullptr;
  return *(after - 1);
}

}  // namespace vitrine::glass
