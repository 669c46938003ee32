// See word_log.h.
#include "glass/debug/word_log.h"

#include <algorithm>
#include <utility>

namespace vitrine::glass::debug {
namespace {

constexpr std::uint32_t kOneWord = std::uint32_t{1} << 31;
constexpr std::size_t kMostWords = kOneWord - 1;
/// A shorter stretch of equal words does not pay for two headers.
constexpr std::size_t kLeastEqual = 4;

/// Words in front of `words` that equal the first one.
std::size_t count_equal(std::span<const std::uint32_t> words) {
  const auto other = std::ranges::find_if(words, [&](std::uint32_t word) { return word != words[0]; });
  return std::min(static_cast<std::size_t>(other - words.begin()), kMostWords);
}

}  // namespace

void WordLog::clear() {
  words_.clear();
  packed_ = false;
}

void WordLog::pack() {
  if (!std::exchange(packed_, true)) words_ = pack_words(words_);
}

void WordLog::unpack() const {
  words_ = unpack_words(words_);
  packed_ = false;
}

std::vector<std::uint32_t> pack_words(std::span<const std::uint32_t> words) {
  std::vector<std::uint32_t> packed;
  std::size_t header = 0;  // of words as they are
  bool open = false;
  while (!words.empty()) {
    const std::size_t equal = count_equal(words);
    if (equal >= kLeastEqual) {
      packed.insert(packed.end(), {static_cast<std::uint32_t>(equal) | kOneWord, words[0]});
      open = false;
    } else {
      if (!open || packed[header] + equal > kMostWords) {
        header = packed.size();
        packed.push_back(0);
        open = true;
      }
      packed[header] += static_cast<std::uint32_t>(equal);
      packed.insert(packed.end(), equal, words[0]);
    }
    words = words.subspan(equal);
  }
  packed.shrink_to_fit();
  return packed;
}

std::vector<std::uint32_t> unpack_words(std::span<const std::uint32_t> packed) {
  std::vector<std::uint32_t> words;
  while (!packed.empty()) {
    const std::size_t count = packed[0] & kMostWords;
    const bool equal = (packed[0] & kOneWord) != 0;
    if (equal)
      words.insert(words.end(), count, packed[1]);
    else
      words.insert(words.end(), packed.begin() + 1, packed.begin() + 1 + static_cast<std::ptrdiff_t>(count));
    packed = packed.subspan(equal ? 2 : 1 + count);
  }
  return words;
}

}  // namespace vitrine::glass::debug
