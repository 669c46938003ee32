// Who has touched which words of memory last: records of one workgroup, or of one dispatch whose workgroups run in
// order. Flat arrays, 64 words a page, so that what a wave does to adjacent words is looked at in one go.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vitrine::glass::race {

inline constexpr std::uint32_t kPageWords = 64;
inline constexpr std::uint32_t kPageBytes = kPageWords * 4;

/// The last accesses of a kind, by word.
struct alignas(64) Slots {
  std::uint32_t who[kPageWords];   ///< the invocation (Group::who)
  std::uint32_t time[kPageWords];  ///< Group::time; 0: there is none
  std::uint32_t site[kPageWords];  ///< Sites::all << 4 | bytes of the word, a bit each
  std::uint64_t used;              ///< words to which something has been done
};

/// 64 words. Of reads the first one since the last barrier and the last one of another invocation.
struct Page {
  std::uint64_t number = 0;      ///< address / kPageBytes
  std::uint32_t generation = 0;  ///< shared memory: of the workgroup
  Slots write, read, other, atomic;
  alignas(64) std::uint32_t value[kPageWords];  ///< that `write` wrote
  void clear();
};

/// Pages by address.
class Shadow {
 public:
  Page& page(std::uint64_t number) {
    Page* const page = recent_[number % kRecent];
    return page != nullptr && page->number == number ? *page : find(number);
  }
  /// Forgets all; keeps the memory of a few pages.
  void reset();
  std::size_t size() const { return used_; }
  Page& at(std::size_t i) { return *pages_[i]; }

 private:
  /// Where a page is, in a table of a power of two of them, half of it free at least: at its hash or behind.
  struct Entry {
    std::uint64_t number = 0;
    std::uint32_t index = 0;
    std::uint32_t round = 0;  ///< free, unless this is round_
  };
  Page& find(std::uint64_t number);
  Entry& entry_of(std::uint64_t number);
  void grow();
  static constexpr std::size_t kRecent = 64;
  std::array<Page*, kRecent> recent_{};  ///< by number
  std::vector<std::unique_ptr<Page>> pages_;
  std::size_t used_ = 0;
  std::vector<Entry> entries_;
  std::uint32_t round_ = 1;  ///< of reset()
};

}  // namespace vitrine::glass::race
