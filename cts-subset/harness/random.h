// A small deterministic generator, so that a seed gives the same numbers on every C++ library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace vitrine::cts {

/// splitmix64. Every draw is defined here; the standard library's distributions differ between vendors.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  /// Tells what has been drawn so far.
  uint64_t state() const { return state_; }

  uint64_t bits64() {
    uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  uint32_t bits() { return static_cast<uint32_t>(bits64() >> 32); }
  /// 0 .. n-1; n > 0.
  uint32_t below(uint32_t n) { return static_cast<uint32_t>((static_cast<uint64_t>(bits()) * n) >> 32); }
  /// low .. high, both possible.
  int32_t between(int32_t low, int32_t high) {
    return low + static_cast<int32_t>(below(static_cast<uint32_t>(high - low) + 1));
  }
  /// [0, 1) in steps of 2^-24.
  float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
  float real(float low, float high) { return low + unit() * (high - low); }
  bool chance(float probability) { return unit() < probability; }

  template <typename T>
  T pick(std::initializer_list<T> values) {
    return values.begin()[below(static_cast<uint32_t>(values.size()))];
  }
  template <typename T>
  const T& pick(const std::vector<T>& values) {
    return values[below(static_cast<uint32_t>(values.size()))];
  }

  /// A float for arithmetic tests: mostly ordinary magnitudes, and with `specials` also zeros, infinities, NaN,
  /// denormals, powers of two and arbitrary bit patterns.
  float operand(bool specials) {
    if (specials && chance(0.3f)) {
      constexpr uint32_t kPatterns[] = {0,          0x80000000, 0x3f800000, 0xbf800000, 0x7f800000, 0xff800000,
                                        0x7fc00000, 0x00000001, 0x807fffff, 0x00800000, 0x7f7fffff, 0x3f000000,
                                        0x4b000000, 0xcf000000, 0x4f800000, 0x40000000};
      const uint32_t pattern = chance(0.25f) ? bits() : kPatterns[below(std::size(kPatterns))];
      return from_bits(pattern);
    }
    switch (below(4)) {
      case 0:
        return unit();
      case 1:
        return real(-10.0f, 10.0f);
      case 2:
        return static_cast<float>(between(-8, 8)) * 0.5f;
      default:
        return real(-1000.0f, 1000.0f);
    }
  }

  static float from_bits(uint32_t pattern) {
    float value;
    std::memcpy(&value, &pattern, sizeof value);
    return value;
  }

 private:
  uint64_t state_;
};

/// FNV-1a, to derive a case's seed from its name.
inline uint64_t hash_name(std::string_view text, uint64_t seed) {
  uint64_t hash = 0xcbf29ce484222325u ^ seed;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

}  // namespace vitrine::cts
