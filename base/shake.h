// Legal but unkind (docs/glass/shake.md): what the specification leaves to the device is chosen by a seed and not in
// the usual way, so that programs which rely on the usual way fail. VITRINE_SHAKE=SEED[,KIND...]; without kinds all
// that leave a right program its results. The same seed makes the same choices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::base {

/// The rows of shake.def.
enum class ShakeKind : std::uint8_t {
#define VITRINE_SHAKE_KIND(name, kind, usual, effect) k##name,
#include "base/shake.def"
#undef VITRINE_SHAKE_KIND
};

/// What a list asks for.
struct ShakeSettings {
  std::uint64_t seed = 0;
  std::uint32_t kinds = 0;           ///< a bit per ShakeKind; none: nothing is shaken
  std::vector<std::string> unknown;  ///< words of the list that mean nothing
  bool has(ShakeKind kind) const { return (kinds >> static_cast<unsigned>(kind) & 1) != 0; }
};

/// Reads "SEED[,KIND...]". Empty: nothing. A list that does not begin with a number has the seed 0 and that word
/// among the unknown ones.
ShakeSettings parse_shake(std::string_view list);

/// What VITRINE_SHAKE asks for, read once in the process. Asked once per loop, dispatch or object, never lane by lane.
const ShakeSettings& shake_settings();
inline bool shakes(ShakeKind kind) { return shake_settings().has(kind); }

/// "order, poison, ...": the kinds.
std::string names_of_shakes();

/// A number as good as random that follows from both.
std::uint64_t mix(std::uint64_t a, std::uint64_t b);

/// The next choice of the calling thread: follows from the seed, from where restart_choices() began, and from how many
/// have been asked since.
std::uint64_t next_choice();
/// Whether what the calling thread asks for fails this time, one time in sixteen: never, unless errors are shaken.
bool fails_now();
/// What the thread does now is number `number` of its kind: a submission. Its choices follow from that.
void restart_choices(std::uint64_t number);

/// Fills memory that holds nothing with what the seed and the place in it make of nothing: numbers of any size, NaNs.
void poison(std::byte* bytes, std::size_t count);

/// Numbers in [0, count) in another order: every one once. Needs no memory.
class Shuffle {
 public:
  Shuffle(std::uint64_t count, std::uint64_t key);
  std::uint64_t operator()(std::uint64_t position) const;

 private:
  std::uint64_t count_, key_;
  unsigned half_bits_;
};

}  // namespace vitrine::base
