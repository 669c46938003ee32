// Turns every LaneOp that the including file has seen into handlers: one per combination of uniform sources, looping
// over the lanes of a wave, and one for words of the uniform file. Last Highway include of a family's .cpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/simd.h"

#include <hwy/highway.h>

#include "spirv/alu/family.h"
#include "spirv/alu/lane_op-inl.h"
#include "spirv/program.h"

#if defined(VITRINE_SPIRV_ALU_WAVE_HANDLERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_WAVE_HANDLERS_INL_H_
#undef VITRINE_SPIRV_ALU_WAVE_HANDLERS_INL_H_
#else
#define VITRINE_SPIRV_ALU_WAVE_HANDLERS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {
namespace {  // the set of visible LaneOps differs between files

/// Columns of ops.def.
struct Shape {
  unsigned sources;
  char result;
  std::array<char, 4> operand;
  unsigned chain;
};

constexpr std::array<char, 4> letters(const char* operands) {
  std::array<char, 4> result{};
  for (std::size_t i = 0; i < result.size() && operands[i] != 0; ++i) result[i] = operands[i];
  return result;
}

constexpr char kF = 'F', kI = 'I', kU = 'U', kB = 'B';
#define VITRINE_STRING(x) #x
constexpr Shape kShapes[] = {
#define VITRINE_ALU(name, sources, result, operands, swap, chain, effect) \
  {sources, k##result, letters(VITRINE_STRING(operands)), chain},
#include "spirv/ops.def"
};
#undef VITRINE_STRING

constexpr const Shape& shape(Op op) { return kShapes[static_cast<std::size_t>(op)]; }

/// Bit i: source i is a boolean.
constexpr unsigned boolean_sources(Op op) {
  unsigned mask = 0;
  for (unsigned i = 0; i < shape(op).sources; ++i)
    if (shape(op).operand[i] == kB) mask |= 1u << i;
  return mask;
}

template <Op op>
concept HasLaneOp = requires {
  sizeof(LaneOp<op>);
};

/// Lane type of an operand letter.
template <char letter>
struct LaneTypeOf {
  using Type = std::uint32_t;
};
template <>
struct LaneTypeOf<'F'> {
  using Type = float;
};
template <>
struct LaneTypeOf<'I'> {
  using Type = std::int32_t;
};
template <char letter>
using LaneType = typename LaneTypeOf<letter>::Type;

/// The word of the uniform file at a byte offset.
HWY_INLINE std::uint32_t uniform_word(const Wave& wave, std::uint32_t offset) {
  std::uint32_t word;
  std::memcpy(&word, reinterpret_cast<const std::byte*>(wave.uniforms) + offset, sizeof(word));
  return word;
}

/// One source of a running handler: `at(lane)` is the vector that starts at `lane`.
template <char letter, bool uniform>
struct Source {
  using D = hn::ScalableTag<LaneType<letter>>;
  const LaneType<letter>* lanes;
  HWY_INLINE Source(const Wave& wave, std::uint32_t offset)
      : lanes(reinterpret_cast<const LaneType<letter>*>(wave.registers + offset)) {}
  HWY_INLINE hn::Vec<D> at(std::size_t lane) const { return hn::Load(D(), lanes + lane); }
};

template <char letter>
struct Source<letter, true> {
  using D = hn::ScalableTag<LaneType<letter>>;
  hn::Vec<D> value;
  HWY_INLINE Source(const Wave& wave, std::uint32_t offset)
      : value(hn::BitCast(D(), hn::Set(hn::RebindToUnsigned<D>(), uniform_word(wave, offset)))) {}
  HWY_INLINE hn::Vec<D> at(std::size_t) const { return value; }
};

template <>
struct Source<'B', false> {
  using D = hn::ScalableTag<std::uint32_t>;
  base::LaneMask mask;
  HWY_INLINE Source(const Wave& wave, std::uint32_t offset) : mask(wave.masks[offset / 8]) {}
  HWY_INLINE Bools<D> at(std::size_t lane) const { return {D(), lanes_mask_from_bits(D(), mask >> lane)}; }
};

template <Op op, unsigned uniform, unsigned index>
using SourceOf = Source<shape(op).operand[index], (uniform >> index & 1) != 0>;

/// The wave's loop over vectors: registers in, register or mask out.
template <Op op, unsigned uniform, unsigned... index>
HWY_INLINE void run_wave(Wave& wave, const Instruction& instruction, std::integer_sequence<unsigned, index...>) {
  const auto run = [&](const auto&... source) HWY_ATTR {
    using DU = hn::ScalableTag<std::uint32_t>;
    if constexpr (shape(op).result == kB) {
      using D = hn::ScalableTag<LaneType<shape(op).operand[0]>>;
      base::LaneMask bits = 0;
      for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(DU()))
        bits |= lanes_mask_bits(D(), LaneOp<op>::of(source.at(lane)...)) << lane;
      wave.masks[instruction.dst / 8] = bits;
    } else {
      auto* out = reinterpret_cast<std::uint32_t*>(wave.registers + instruction.dst);
      for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(DU()))
        hn::Store(hn::BitCast(DU(), LaneOp<op>::of(source.at(lane)...)), DU(), out + lane);
    }
  };
  run(SourceOf<op, uniform, index>(wave, instruction.src[index])...);
}

template <Op op, unsigned uniform>
const Instruction* wave_handler(Wave& wave, const Instruction* instruction) {
  run_wave<op, uniform>(wave, *instruction, std::make_integer_sequence<unsigned, shape(op).sources>());
  return instruction + 1;
}

/// A word of the uniform file as an operand of a four-lane vector.
template <char letter>
HWY_INLINE auto scalar_source(const Wave& wave, std::uint32_t offset) {
  const hn::CappedTag<std::uint32_t, 4> d;
  const auto word = hn::Set(d, uniform_word(wave, offset));
  if constexpr (letter == kB) {
    return Bools<decltype(d)>{d, hn::Not(hn::Eq(word, hn::Zero(d)))};
  } else {
    return lanes_cast<LaneType<letter>>(word);
  }
}

template <Op op, unsigned... index>
HWY_INLINE std::uint32_t run_scalar(const Wave& wave, const Instruction& instruction,
                                    std::integer_sequence<unsigned, index...>) {
  const auto result = LaneOp<op>::of(scalar_source<shape(op).operand[index]>(wave, instruction.src[index])...);
  if constexpr (shape(op).result == kB) {
    const hn::CappedTag<LaneType<shape(op).operand[0]>, 4> d;
    return static_cast<std::uint32_t>(lanes_mask_bits(d, result) & 1);
  } else {
    return hn::GetLane(lanes_cast<std::uint32_t>(result));
  }
}

template <Op op>
const Instruction* scalar_handler(Wave& wave, const Instruction* instruction) {
  wave.uniforms[instruction->dst / 4] =
      run_scalar<op>(wave, *instruction, std::make_integer_sequence<unsigned, shape(op).sources>());
  return instruction + 1;
}

template <Op op, unsigned... uniform>
constexpr OpHandlers handlers_of(std::integer_sequence<unsigned, uniform...>) {
  if constexpr (HasLaneOp<op>) {
    return {{wave_handler<op, uniform & ~boolean_sources(op)>...}, scalar_handler<op>};
  } else {
    return {};
  }
}

template <std::size_t... op>
constexpr std::array<OpHandlers, sizeof...(op)> all_handlers(std::index_sequence<op...>) {
  return {handlers_of<static_cast<Op>(op)>(
      std::make_integer_sequence<unsigned, 1u << shape(static_cast<Op>(op)).sources>())...};
}

/// The handlers of every LaneOp included so far.
constexpr auto kHandlers = all_handlers(std::make_index_sequence<static_cast<std::size_t>(Op::kExecutedCount)>());

}  // namespace
}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
