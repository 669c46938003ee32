// A hash of what cases put in and out. Every step is one to one, so that outputs that differ in one word never agree.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace vitrine::cts {

class Hash {
 public:
  void bytes(const void* data, size_t size) {
    const auto* at = static_cast<const unsigned char*>(data);
    word(size);
    for (; size >= 8; at += 8, size -= 8) {
      uint64_t value;
      std::memcpy(&value, at, 8);
      word(value);
    }
    uint64_t rest = 0;
    std::memcpy(&rest, at, size);
    word(rest);
  }
  void text(std::string_view value) { bytes(value.data(), value.size()); }
  /// Numbers and enumerants one by one: structures have padding.
  template <typename... T>
  void numbers(T... values) {
    (number(values), ...);
  }
  uint64_t value() const { return state_; }
  /// Half of it, for what is told apart from one other value only.
  uint32_t half() const { return static_cast<uint32_t>(state_ ^ state_ >> 32); }

 private:
  template <typename T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    bytes(&value, sizeof value);
  }
  void word(uint64_t value) {
    state_ = (state_ ^ value) * 0x9e3779b97f4a7c15u;
    state_ ^= state_ >> 29;
  }
  uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace vitrine::cts
