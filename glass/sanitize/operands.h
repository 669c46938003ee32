// Values that a probe reads, by lane.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "glass/sanitize/reporter.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::sanitize {

/// One word of an operand in all lanes.
class Words {
 public:
  Words(const spirv::Wave& wave, spirv::OperandPlace place) {
    if (place.file == 'r') {
      words_ = reinterpret_cast<const base::WaveRegister*>(wave.registers + place.offset)->lane;
    } else if (place.file == 'm') {
      mask_ = wave.masks[place.offset / sizeof(base::LaneMask)];
      is_mask_ = true;
    } else {
      word_ = spirv::exec::word_of(wave, place, 0);
    }
  }
  std::uint32_t operator[](std::size_t lane) const {
    if (words_ != nullptr) return words_[lane];
    return is_mask_ ? static_cast<std::uint32_t>(mask_ >> lane & 1) : word_;
  }
  /// The words of all lanes; null: they are not there.
  const std::uint32_t* in_register() const { return words_; }
  bool is_uniform() const { return words_ == nullptr && !is_mask_; }

 private:
  const std::uint32_t* words_ = nullptr;
  std::uint32_t word_ = 0;
  base::LaneMask mask_ = 0;
  bool is_mask_ = false;
};

/// One component of a value.
class Number {
 public:
  Number(const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::ProbeValue& value, std::uint32_t component)
      : type_(value.type),
        width_(value.width),
        low_(wave, op.operands[word_number(value, component)]),
        high_(wave, op.operands[word_number(value, component) + (value.width == 64)]) {}

  std::uint32_t width() const { return width_; }
  char type() const { return type_; }
  std::uint64_t bits(std::size_t lane) const;
  std::int64_t as_signed(std::size_t lane) const;
  double as_float(std::size_t lane) const;  ///< of a floating-point number
  std::string text(std::size_t lane) const;
  /// The word of 32-bit numbers.
  const Words& word() const { return low_; }

 private:
  static std::uint32_t word_number(const spirv::ProbeValue& value, std::uint32_t component) {
    return value.first_word + component * (value.width == 64 ? 2 : 1);
  }
  char type_;
  std::uint32_t width_;
  Words low_, high_;
};

/// The addresses of an access through a pointer: two words, and a signed distance.
struct Addresses {
  Words low, high, distance;
  Addresses(const spirv::Wave& wave, const spirv::Instruction& i, const spirv::InstructionNote& note)
      : low(wave, {note.files[1], i.src[0]}),
        high(wave, {note.files[2], i.src[1]}),
        distance(wave, {note.files[3], i.src[2]}) {}
  /// Of what lies `added` bytes behind it.
  std::uint64_t operator()(std::size_t lane, std::uint32_t added) const {
    const auto offset = static_cast<std::int32_t>(distance[lane] + added);
    return (std::uint64_t{high[lane]} << 32 | low[lane]) + static_cast<std::uint64_t>(std::int64_t{offset});
  }
};

/// The lanes of `lanes` for which `holds(lane)`.
template <class F>
base::LaneMask lanes_where(base::LaneMask lanes, F&& holds) {
  base::LaneMask result = 0;
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
    result |= static_cast<base::LaneMask>(holds(lane)) << lane;
  return result & lanes;
}

/// What tells a probe's place apart among those of its program.
inline std::uint64_t place_of(const spirv::ProbeOp& op) { return std::uint64_t{1} << 32 | op.probe; }

/// Where a probe is.
inline spirv::ir::Origin origin_of(const spirv::Probe& probe) { return {probe.id, probe.place}; }

/// The lanes that come by a probe and are no helpers.
inline base::LaneMask real_lanes_at(const spirv::Wave& wave, const spirv::ProbeOp& op) {
  return spirv::exec::lanes_at(wave, op) & wave.live;
}

}  // namespace vitrine::glass::sanitize
