// Types and values of shaders made at random (random_shader.h): a value is a list of numbers, a word of 64 bits each.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "glass/debug/value.h"

namespace vitrine::glass::debug::test {

struct RandomType {
  enum class Kind : std::uint8_t { kNumber, kVector, kArray, kStruct } kind = Kind::kNumber;
  std::string name;
  char letter = 'I';  ///< of a number, as Scalar::type
  std::uint32_t width = 32;
  const RandomType* element = nullptr;
  std::uint32_t count = 0;
  std::vector<std::pair<std::string, const RandomType*>> members;

  std::uint32_t numbers() const {
    if (kind == Kind::kNumber) return 1;
    if (kind != Kind::kStruct) return count * element->numbers();
    std::uint32_t sum = 0;
    for (const auto& [name, type] : members) sum += type->numbers();
    return sum;
  }
};

inline std::uint64_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }
inline float float_of(std::uint64_t bits) { return std::bit_cast<float>(static_cast<std::uint32_t>(bits)); }

/// As the debugger says it; the sign of a zero is left out: the compiler may choose it (Vulkan 1.3.239, Precision and
/// Operation of SPIR-V Instructions: without SignedZeroInfNanPreserve).
inline std::string text_of(const RandomType& type, const std::uint64_t* words) {
  if (type.kind == RandomType::Kind::kNumber) {
    const std::uint64_t zero = type.letter == 'F' && float_of(*words) == 0.0f ? 0 : *words;
    return to_text(Scalar{type.letter, type.width, zero});
  }
  const bool vector = type.kind == RandomType::Kind::kVector;
  std::string text = vector ? "(" : "{";
  const auto add = [&](const std::string& name, const RandomType& part) {
    text.append(text.size() == 1 ? "" : ", ").append(name).append(text_of(part, words));
    words += part.numbers();
  };
  for (const auto& [name, part] : type.members) add(name + " = ", *part);
  for (std::uint32_t i = 0; i < type.count; ++i) add("", *type.element);
  return text += vector ? ")" : "}";
}

/// What the debugger says, with zeros as text_of() has them.
inline std::string without_signs_of_zeros(std::string text) {
  for (std::size_t at = text.find("-0.0"); at != std::string::npos; at = text.find("-0.0", at + 1))
    if (at + 4 == text.size() || text[at + 4] < '0' || text[at + 4] > '9') text.erase(at, 1);
  return text;
}

}  // namespace vitrine::glass::debug::test
