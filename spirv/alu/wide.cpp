// Handlers of wide_ops.def: words of either file in, words out.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/alu/wide.cpp"
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/wide_ops-inl.h"
#include "spirv/program.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {
namespace {

/// Where word `k` of an instruction's sources is: src[0..2], then extra[0].
HWY_INLINE std::uint32_t source_place(const Instruction& i, unsigned k) { return k < 3 ? i.src[k] : i.extra[0]; }

/// Words of one source operand for the first `count` lanes.
HWY_INLINE void read_words(const Wave& wave, std::uint32_t place, std::uint32_t* to, std::size_t count) {
  if (place & kUniformPlace) {
    std::uint32_t word;
    std::memcpy(&word, reinterpret_cast<const std::byte*>(wave.uniforms) + (place & ~kUniformPlace), sizeof(word));
    for (std::size_t lane = 0; lane < count; ++lane) to[lane] = word;
  } else {
    std::memcpy(to, wave.registers + place, count * sizeof(*to));
  }
}

/// One operand of all lanes.
template <class T>
struct Operand {
  static constexpr unsigned kWords = sizeof(T) / 4;
  alignas(64) T lane[base::kWaveWidth];

  HWY_INLINE void read(const Wave& wave, const Instruction& i, unsigned word, std::size_t count) {
    if constexpr (kWords == 1) {
      alignas(64) std::uint32_t words[base::kWaveWidth];
      read_words(wave, source_place(i, word), words, count);
      for (std::size_t k = 0; k < count; ++k) lane[k] = std::bit_cast<T>(words[k]);
    } else {
      alignas(64) std::uint32_t low[base::kWaveWidth], high[base::kWaveWidth];
      read_words(wave, source_place(i, word), low, count);
      read_words(wave, source_place(i, word + 1), high, count);
      for (std::size_t k = 0; k < count; ++k) lane[k] = std::bit_cast<T>(low[k] | std::uint64_t{high[k]} << 32);
    }
  }
};

HWY_INLINE void write_words(Wave& wave, std::uint32_t place, const std::uint32_t* from, std::size_t count) {
  if (place == kNoOperand) return;
  if (place & kUniformPlace)
    wave.uniforms[(place & ~kUniformPlace) / 4] = from[0];
  else
    std::memcpy(wave.registers + place, from, count * sizeof(*from));
}

template <class T>
HWY_INLINE void write(Wave& wave, const Instruction& i, const T* result, std::size_t count) {
  if constexpr (std::is_same_v<T, bool>) {
    if (i.dst != kNoOperand && (i.dst & kUniformPlace) != 0) {
      wave.uniforms[(i.dst & ~kUniformPlace) / 4] = result[0];
      return;
    }
    base::LaneMask mask = 0;
    for (std::size_t k = 0; k < count; ++k) mask |= base::LaneMask{result[k]} << k;
    if (i.dst != kNoOperand) wave.masks[i.dst / sizeof(base::LaneMask)] = mask;
  } else if constexpr (sizeof(T) == 4) {
    alignas(64) std::uint32_t words[base::kWaveWidth];
    for (std::size_t k = 0; k < count; ++k) words[k] = std::bit_cast<std::uint32_t>(result[k]);
    write_words(wave, i.dst, words, count);
  } else {
    alignas(64) std::uint32_t low[base::kWaveWidth], high[base::kWaveWidth];
    for (std::size_t k = 0; k < count; ++k) {
      const auto bits = std::bit_cast<std::uint64_t>(result[k]);
      low[k] = static_cast<std::uint32_t>(bits);
      high[k] = static_cast<std::uint32_t>(bits >> 32);
    }
    write_words(wave, i.dst, low, count);
    write_words(wave, i.extra[1], high, count);
  }
}

template <class Op, class R, class A>
HWY_INLINE void compute(Wave& wave, const Instruction& i, std::size_t count, R (*)(A)) {
  Operand<A> a;
  a.read(wave, i, 0, count);
  alignas(64) R result[base::kWaveWidth];
  for (std::size_t k = 0; k < count; ++k) result[k] = Op::of(a.lane[k]);
  write(wave, i, result, count);
}

template <class Op, class R, class A, class B>
HWY_INLINE void compute(Wave& wave, const Instruction& i, std::size_t count, R (*)(A, B)) {
  Operand<A> a;
  Operand<B> b;
  a.read(wave, i, 0, count);
  b.read(wave, i, Operand<A>::kWords, count);
  alignas(64) R result[base::kWaveWidth];
  for (std::size_t k = 0; k < count; ++k) result[k] = Op::of(a.lane[k], b.lane[k]);
  write(wave, i, result, count);
}

template <ir::Op op>
const Instruction* wave_wide(Wave& wave, const Instruction* i) {
  compute<WideOp<op>>(wave, *i, base::kWaveWidth, &WideOp<op>::of);
  return i + 1;
}

/// For results in the uniform file.
template <ir::Op op>
const Instruction* scalar_wide(Wave& wave, const Instruction* i) {
  compute<WideOp<op>>(wave, *i, 1, &WideOp<op>::of);
  return i + 1;
}

struct WideRow {
  Handler wave, scalar;
};
constexpr WideRow kRows[] = {
#define VITRINE_WIDE(name, result, operands, effect) {wave_wide<ir::Op::k##name>, scalar_wide<ir::Op::k##name>},
#include "spirv/wide_ops.def"
#undef VITRINE_WIDE
};

}  // namespace

Handler wide_row(std::size_t row, bool scalar) { return scalar ? kRows[row].scalar : kRows[row].wave; }

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::alu {
namespace {

HWY_EXPORT(wide_row);

Handler dispatched(std::size_t row, bool scalar) { return HWY_DYNAMIC_DISPATCH(wide_row)(row, scalar); }

}  // namespace
}  // namespace vitrine::spirv::alu

namespace vitrine::spirv {

Handler wide_handler(ir::Op op, bool scalar) {
  base::select_simd_target();
  return alu::dispatched(static_cast<std::size_t>(op) - static_cast<std::size_t>(ir::Op::kIntrinsicEnd) - 1, scalar);
}

}  // namespace vitrine::spirv
#endif
