// Reads what the environment asks for, once; numbers that follow from a seed.
#include "base/shake.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include "base/lasting.h"
#include "base/words.h"

namespace vitrine::base {
namespace {

enum class Usual : std::uint8_t { kUsual, kAsked };

struct Row {
  std::string_view kind;
  Usual usual;
};

constexpr Row kRows[] = {
#define VITRINE_SHAKE_KIND(name, kind, usual, effect) {kind, Usual::usual},
#include "base/shake.def"
#undef VITRINE_SHAKE_KIND
};

std::uint32_t usual_kinds() {
  std::uint32_t kinds = 0;
  for (std::size_t i = 0; i < std::size(kRows); ++i) kinds |= kRows[i].usual == Usual::kUsual ? 1u << i : 0;
  return kinds;
}

void read_word(std::string_view word, ShakeSettings& settings) {
  const auto* const row =
      std::find_if(std::begin(kRows), std::end(kRows), [&](const Row& r) { return r.kind == word; });
  if (row != std::end(kRows))
    settings.kinds |= 1u << (row - kRows);
  else
    settings.unknown.emplace_back(word);
}

thread_local std::uint64_t choices_key = 0, choices = 0;

}  // namespace

ShakeSettings parse_shake(std::string_view list) {
  ShakeSettings settings;
  if (list.empty()) return settings;
  const std::string_view first = list.substr(0, list.find(','));
  const auto [end, error] = std::from_chars(first.data(), first.data() + first.size(), settings.seed);
  if (error != std::errc() || end != first.data() + first.size()) settings.unknown.emplace_back(first);
  for_each_word(list.substr(first.size()), [&](std::string_view word) { read_word(word, settings); });
  if (settings.kinds == 0 && settings.unknown.empty()) settings.kinds = usual_kinds();
  return settings;
}

const ShakeSettings& shake_settings() {
  static const ShakeSettings& settings = lasting([] {
    const char* value = std::getenv("VITRINE_SHAKE");
    return parse_shake(value != nullptr ? value : "");
  });
  return settings;
}

std::string names_of_shakes() {
  std::string names;
  for (const Row& row : kRows) names.append(names.empty() ? "" : ", ").append(row.kind);
  return names;
}

// The finalizer of MurmurHash3 (public domain): every bit of the input reaches every bit of the result.
std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t x = a * 0x9e3779b97f4a7c15u + b;
  x = (x ^ x >> 33) * 0xff51afd7ed558ccdu;
  x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53u;
  return x ^ x >> 33;
}

std::uint64_t next_choice() { return mix(mix(shake_settings().seed, choices_key), ++choices); }

bool fails_now() { return shakes(ShakeKind::kErrors) && next_choice() % 16 == 0; }

void restart_choices(std::uint64_t number) {
  choices_key = number;
  choices = 0;
}

void poison(std::byte* bytes, std::size_t count) {
  const std::uint64_t key = mix(shake_settings().seed, 1);
  for (std::size_t at = 0; at < count; at += sizeof(std::uint64_t)) {
    const std::uint64_t noise = mix(key, at);
    std::memcpy(bytes + at, &noise, std::min(sizeof(noise), count - at));
  }
}

Shuffle::Shuffle(std::uint64_t count, std::uint64_t key)
    : count_(count), key_(key), half_bits_((static_cast<unsigned>(std::bit_width(count | 1)) + 1) / 2) {}

// A Feistel network over the next power of four, walked until it is inside of the range again.
std::uint64_t Shuffle::operator()(std::uint64_t position) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  do {
    std::uint64_t left = position >> half_bits_, right = position & mask;
    for (unsigned round = 0; round < 4; ++round) {
      const std::uint64_t next = left ^ (mix(key_ + round, right) & mask);
      left = right;
      right = next;
    }
    position = left << half_bits_ | right;
  } while (position >= count_);
  return position;
}

}  // namespace vitrine::base
