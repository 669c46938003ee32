// Bytes read as choices, so that whoever makes the bytes (a generator, libFuzzer) chooses what is done.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>

namespace vitrine::fuzz {

/// Where the bytes end every choice is the first.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// In [0, count); count > 0.
  std::uint32_t below(std::uint32_t count) { return take(count <= 256 ? 1 : count <= 65536 ? 2 : 4) % count; }
  /// In [low, high].
  std::uint32_t between(std::uint32_t low, std::uint32_t high) { return low + below(high - low + 1); }
  bool one_in(std::uint32_t count) { return below(count) == 1 % count; }
  template <class T, std::size_t N>
  const T& of(const T (&list)[N]) {
    return list[below(N)];
  }

  /// 32 bits that programs do not expect: ends of ranges, not numbers, small numbers; or any.
  std::uint32_t hostile() {
    static constexpr std::uint32_t kWords[] = {0,          1,          2,          3,          0x7f,       0xff,
                                               0xffff,     0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 0x10000,
                                               0x3f800000, 0xbf800000, 0x7f800000, 0xff800000, 0x7fc00000, 0x00000001,
                                               0x7f7fffff, 0x4b000000, 0x4f000000, 0x3f000000, 0x80000001, 0x40400000};
    const std::uint32_t kind = below(4);
    if (kind == 0) return of(kWords);
    if (kind == 1) return below(64);
    if (kind == 2) {  // a number between -2 and 2
      const float value = static_cast<float>(take(2)) / 16384 - 2;
      std::uint32_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      return bits;
    }
    return take(4);
  }
  void fill(void* data, std::size_t bytes) {
    auto* words = static_cast<std::uint32_t*>(data);
    // A few words, over and over: whole buffers would use up the choices.
    std::uint32_t few[24];
    for (std::uint32_t& word : few) word = hostile();
    const std::uint32_t step = between(1, 23);
    for (std::size_t i = 0; i < bytes / 4; ++i) words[i] = few[(i * step + i / 24) % std::size(few)];
  }

 private:
  std::uint32_t take(std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count && at_ < bytes_.size(); ++i) value = value << 8 | bytes_[at_++];
    return value;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace vitrine::fuzz
