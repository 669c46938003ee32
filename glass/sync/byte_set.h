// Bytes that one instruction of a command has touched, a bit each.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "glass/sync/range.h"

namespace vitrine::glass::sync {

class ByteSet {
 public:
  ByteSet() = default;
  ByteSet(const ByteSet&) = delete;
  ByteSet(ByteSet&&) = default;
  ByteSet& operator=(ByteSet&&) = default;

  void add(std::uintptr_t address, std::uint64_t bytes) {
    while (bytes != 0) {
      Words& words = page(address / kPageBytes);
      const auto in_page = static_cast<std::uint32_t>(address % kPageBytes);
      const std::uint32_t bit = in_page % 64;
      const std::uint64_t part = bytes < 64 - bit ? bytes : 64 - bit;
      words[in_page / 64] |= (part == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << part) - 1) << bit;
      address += part;
      bytes -= part;
    }
  }
  bool empty() const { return pages_.empty(); }
  bool contains(std::uintptr_t address) const {
    const auto page = pages_.find(address / kPageBytes);
    return page != pages_.end() && (page->second[address % kPageBytes / 64] >> address % 64 & 1) != 0;
  }
  void add(const ByteSet& other);
  /// In ascending order.
  std::vector<Range> ranges() const;

 private:
  static constexpr std::uint32_t kPageBytes = 1024;
  using Words = std::array<std::uint64_t, kPageBytes / 64>;
  Words& page(std::uint64_t number) {
    if (recent_ != nullptr && recent_number_ == number) return *recent_;
    recent_number_ = number;
    return *(recent_ = &pages_[number]);
  }

  std::unordered_map<std::uint64_t, Words> pages_;  ///< by address / kPageBytes
  Words* recent_ = nullptr;
  std::uint64_t recent_number_ = 0;
};

}  // namespace vitrine::glass::sync
