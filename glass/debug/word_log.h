// The words of a log, in less room while nobody looks at them: most equal the one before, since what lanes did not have
// yet is replaced, and all of them come from one place.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

namespace vitrine::glass::debug {

class WordLog {
 public:
  std::size_t size() const { return open().size(); }
  const std::uint32_t& operator[](std::size_t i) const { return open()[i]; }
  std::uint32_t& operator[](std::size_t i) { return open()[i]; }
  void push_back(std::uint32_t word) { open().push_back(word); }
  void append(std::initializer_list<std::uint32_t> words) { open().insert(words_.end(), words); }
  /// `count` times the same.
  void append(std::size_t count, std::uint32_t word) { open().insert(words_.end(), count, word); }
  void clear();
  /// Takes less room until a word is asked for.
  void pack();
  /// That it takes.
  std::size_t bytes() const { return words_.capacity() * sizeof(std::uint32_t); }

 private:
  std::vector<std::uint32_t>& open() const {
    if (packed_) unpack();
    return words_;
  }
  void unpack() const;

  mutable std::vector<std::uint32_t> words_;
  mutable bool packed_ = false;
};

/// Stretches of words, each behind a header: its number of words, and as its highest bit whether it is one word, given
/// once.
std::vector<std::uint32_t> pack_words(std::span<const std::uint32_t> words);
/// What was given to pack_words.
std::vector<std::uint32_t> unpack_words(std::span<const std::uint32_t> packed);

}  // namespace vitrine::glass::debug
