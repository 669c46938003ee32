// Handlers of chain links (spirv/exec/chain.h), made from the arithmetic of spirv/alu that the including file has
// seen. Last Highway include of its .cpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/simd.h"

#include <hwy/highway.h>

#include "spirv/alu/wave_handlers-inl.h"
#include "spirv/exec/chain.h"
#include "spirv/exec/chain_families.h"

#if defined(VITRINE_SPIRV_EXEC_CHAIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_EXEC_CHAIN_INL_H_
#undef VITRINE_SPIRV_EXEC_CHAIN_INL_H_
#else
#define VITRINE_SPIRV_EXEC_CHAIN_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {
namespace {

using exec::Link;

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3
using ChainTag = hn::ScalableTag<std::uint32_t>;
using Accumulator = hn::Vec<ChainTag>;
constexpr std::size_t kVectorLanes = HWY_TARGET == HWY_AVX3 ? 16 : 8;
constexpr std::size_t kVectors = base::kWaveWidth / kVectorLanes;

template <std::size_t>
using Repeat = Accumulator;

/// Sources of one link: memory for all but the accumulator.
template <Op op, int accumulator, unsigned uniform, unsigned index>
struct LinkSource {
  using D = hn::ScalableTag<LaneType<shape(op).operand[index]>>;
  static constexpr bool kAccumulator = static_cast<int>(index) == accumulator ||
                                       (accumulator == exec::kAllSources && index < 2) || index >= shape(op).sources;
  struct Nothing {
    HWY_INLINE Nothing(const Wave&, std::uint32_t) {}
  };
  using Memory = Source<shape(op).operand[index], (uniform >> index & 1) != 0>;
  std::conditional_t<kAccumulator, Nothing, Memory> memory;
  HWY_INLINE LinkSource(const Wave& wave, std::uint32_t offset) : memory(wave, offset) {}
  HWY_INLINE auto at(std::size_t lane, Accumulator in) const {
    if constexpr (kAccumulator) {
      return hn::BitCast(D(), in);
    } else {
      return memory.at(lane);
    }
  }
};

template <Op op, int accumulator, unsigned uniform>
struct LinkSources {
  LinkSource<op, accumulator, uniform, 0> a;
  LinkSource<op, accumulator, uniform, 1> b;
  LinkSource<op, accumulator, uniform, 2> c;
  HWY_INLINE LinkSources(const Wave& wave, const Instruction* i)
      : a(wave, i->src[0]), b(wave, i->src[1]), c(wave, i->src[2]) {}

  HWY_INLINE auto compute(std::size_t lane, Accumulator in) const {
    if constexpr (shape(op).sources == 1) {
      return LaneOp<op>::of(a.at(lane, in));
    } else if constexpr (shape(op).sources == 2) {
      return LaneOp<op>::of(a.at(lane, in), b.at(lane, in));
    } else {
      return LaneOp<op>::of(a.at(lane, in), b.at(lane, in), c.at(lane, in));
    }
  }
};

/// The compiler adds no VZEROUPPER to functions that take vectors; SSE code of the caller would pay for the transition.
HWY_INLINE void leave_vectors() { _mm256_zeroupper(); }

template <Op op, int accumulator, unsigned uniform, Link link, class Indices>
struct ChainLink;

template <Op op, int accumulator, unsigned uniform, Link link, std::size_t... k>
struct ChainLink<op, accumulator, uniform, link, std::index_sequence<k...>> {
  using Function = const Instruction* (*)(Wave&, const Instruction*, Repeat<k>...);

  static HWY_INLINE const Instruction* pass(Wave& wave, const Instruction* i, Repeat<k>... result) {
    if constexpr (link != Link::kKeep) {
      auto* out = reinterpret_cast<std::uint32_t*>(wave.registers + i->dst);
      (hn::Store(result, ChainTag(), out + k * kVectorLanes), ...);
    }
    const Instruction* next = i + 1;
    if constexpr (link == Link::kLast) {
      leave_vectors();
      return next;
    } else {
      return reinterpret_cast<Function>(next->handler)(wave, next, result...);
    }
  }

  static const Instruction* run(Wave& wave, const Instruction* i, Repeat<k>... in) {
    const LinkSources<op, accumulator, uniform> sources(wave, i);
    if constexpr (shape(op).result == kB) {
      using D = hn::ScalableTag<LaneType<shape(op).operand[0]>>;
      wave.masks[i->dst / 8] =
          ((lanes_mask_bits(D(), sources.compute(k * kVectorLanes, in)) << (k * kVectorLanes)) | ...);
      leave_vectors();
      return i + 1;
    } else {
      return pass(wave, i, hn::BitCast(ChainTag(), sources.compute(k * kVectorLanes, in))...);
    }
  }

  static const Instruction* start(Wave& wave, const Instruction* i) {
    const LinkSources<op, accumulator, uniform> sources(wave, i);
    return pass(wave, i, hn::BitCast(ChainTag(), sources.compute(k * kVectorLanes, hn::Zero(ChainTag())))...);
  }
};

template <Op op, int accumulator, unsigned uniform, Link link>
Handler link_handler() {
  using Indices = std::make_index_sequence<kVectors>;
  if constexpr (accumulator == exec::kNoAccumulator) {
    return ChainLink<op, accumulator, uniform, link, Indices>::start;
  } else {
    return reinterpret_cast<Handler>(ChainLink<op, accumulator, uniform, link, Indices>::run);
  }
}
#else
template <Op, int accumulator, unsigned uniform, Link>
Handler link_handler() {
  return exec::no_chain;
}
#endif

/// Sources that a link takes from the uniform file only: how far to shift, of the operations that do so among others.
constexpr unsigned counts_of_bits(Op op) {
  switch (op) {
    case Op::kRotR:
      return 2;
    case Op::kRotRXor:
    case Op::kXorRotR:
    case Op::kXorShr:
    case Op::kXorShl:
    case Op::kIAddShl:
      return 4;
    case Op::kBfeU:
    case Op::kBfeI:
      return 6;
    default:
      return 0;
  }
}

/// Handlers of one op by uniform sources and link.
template <Op op, int accumulator, unsigned... uniform>
Handler find_link(UniformSources wanted, Link link, std::integer_sequence<unsigned, uniform...>) {
  Handler found = nullptr;
  constexpr bool kMask = shape(op).result == kB;
  constexpr bool kStart = accumulator == exec::kNoAccumulator;
  const auto check = [&]<unsigned u>(std::integral_constant<unsigned, u>) HWY_ATTR {
    constexpr unsigned kOwn = accumulator == exec::kAllSources ? 3 : accumulator >= 0 ? 1u << accumulator : 0;
    if constexpr ((u & (boolean_sources(op) | kOwn)) == 0 && (u & counts_of_bits(op)) == counts_of_bits(op)) {
      if (u != wanted) return;
      if constexpr (!kMask) {
        if (link == Link::kKeep) found = link_handler<op, accumulator, u, Link::kKeep>();
        if (link == Link::kStore) found = link_handler<op, accumulator, u, Link::kStore>();
      }
      if constexpr (!kStart) {
        if (link == Link::kLast) found = link_handler<op, accumulator, u, Link::kLast>();
      }
    }
  };
  (check(std::integral_constant<unsigned, uniform>()), ...);
  return found;
}

/// `accumulators`: bit a set = the op may take the accumulator as source a (bit 3: as both).
template <Op op, unsigned accumulators>
Handler find_chain(int accumulator, UniformSources uniform, Link link) {
  constexpr std::make_integer_sequence<unsigned, 1u << shape(op).sources> kUniform;
  if (accumulator == exec::kNoAccumulator)
    return shape(op).result == kB ? nullptr : find_link<op, exec::kNoAccumulator>(uniform, link, kUniform);
  if constexpr ((accumulators & 1) != 0)
    if (accumulator == 0) return find_link<op, 0>(uniform, link, kUniform);
  if constexpr ((accumulators & 2) != 0)
    if (accumulator == 1) return find_link<op, 1>(uniform, link, kUniform);
  if constexpr ((accumulators & 4) != 0)
    if (accumulator == 2) return find_link<op, 2>(uniform, link, kUniform);
  if constexpr ((accumulators & 8) != 0)
    if (accumulator == exec::kAllSources) return find_link<op, exec::kAllSources>(uniform, link, kUniform);
  return nullptr;
}

template <Op op>
Handler find_chain_of(int accumulator, UniformSources uniform, Link link) {
  if constexpr (shape(op).chain != 0 && HasLaneOp<op>)
    return find_chain<op, shape(op).chain>(accumulator, uniform, link);
  return nullptr;
}

/// A link of an operation that is in chains (column `chain` of ops.def) and whose arithmetic the including file has.
inline Handler find_family_chain(Op op, int accumulator, UniformSources uniform, Link link) {
  switch (op) {
#define VITRINE_ALU(name, sources, result, operands, swap, chain, effect) \
  case Op::k##name:                                                       \
    return find_chain_of<Op::k##name>(accumulator, uniform, link);
#include "spirv/ops.def"
    default:
      return nullptr;
  }
}

}  // namespace
}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
