// Walks of a vector of lanes through their footprints (lavapipe-texture-blend.md A8, steps 5 and 6): sums of texels
// times weights. Formats whose texels are words, halves or floats go four texels of a row at a time, others one by one.

#include <algorithm>

#include "texel/sampler/wave/ewa-inl.h"
#include "texel/sampler/wave/four-inl.h"
#include "texel/sampler/wave/s3tc-inl.h"
#include "texel/sampler/wave/texels-inl.h"

#if defined(VITRINE_TEXEL_WAVE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_WALK_INL_H_
#undef VITRINE_TEXEL_WAVE_WALK_INL_H_
#else
#define VITRINE_TEXEL_WAVE_WALK_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Sums of a vector of lanes.
struct Sums {
  VF color[4];
  VF total;
};

/// What a vector of lanes walks through.
struct Footprint {
  LevelLanes level;  ///< from the slice on
  EllipseLanes ellipse;
  hn::Mask<DI> outside;  ///< no slice
  base::LaneMask active;
  VF reference;
};

/// One axis of the level, as the walk needs it: the texel nearest to u / size, for whole u.
struct WalkAxis {
  AxisLanes lanes;
  VF inverse;  ///< of sizes that are powers of two
  VI last;
  bool exact;  ///< u / size * size is u, whose texel follows without floats

  WalkAxis(const AxisLanes& axis, VI first_u, VI last_u, hn::Mask<DI> live) : lanes(axis) {
    lanes.normalized = true;
    inverse = hn::Div(splat(1.0f), axis.size_float);
    last = hn::Sub(axis.size, splat(1));
    const VI limit = splat(1 << 23);
    const auto far = hn::Or(hn::Lt(first_u, hn::Neg(limit)), hn::Gt(last_u, limit));
    exact = lanes.pot && (lanes.address == Address::kRepeat || lanes.address == Address::kClamp) &&
            hn::AllFalse(DI(), hn::And(live, far));
  }

  /// The texel nearest to u, inside the level; `outside`: that of the border colour.
  HWY_INLINE VI nearest(VI u, hn::Mask<DI>& outside) const {
    outside = hn::FirstN(DI(), 0);
    if (exact) {
      const VI at = lanes_offset(lanes, u);
      return lanes.address == Address::kRepeat ? hn::And(at, last) : lanes_clamp(at, last);
    }
    const VF texel = lanes_int_to_float(u);
    const VF s = lanes.pot ? hn::Mul(texel, inverse) : hn::Div(texel, lanes.size_float);
    const VI at = lanes_nearest(lanes, s);
    if (lanes.address != Address::kBorder) return at;
    outside = hn::Or(hn::Lt(at, splat(0)), hn::Gt(at, last));
    return lanes_clamp(at, last);
  }

  /// As nearest, where there is no border.
  HWY_INLINE VI nearest(VI u) const {
    hn::Mask<DI> outside;
    return nearest(u, outside);
  }

  /// The texel nearest to u; whether, for the lanes of `wanted`, the next three follow in memory. Other lanes get a
  /// texel of which this is true as well, if it is of any.
  HWY_INLINE bool first_of_four(VI u, hn::Mask<DI> wanted, VI& at) const {
    const VI third_last = hn::Sub(last, splat(3));
    hn::Mask<DI> follow;
    if (exact) {
      at = lanes_offset(lanes, u);
      if (lanes.address == Address::kRepeat) at = hn::And(at, last);
      follow = hn::And(hn::Not(hn::Lt(at, splat(0))), hn::Not(hn::Gt(at, third_last)));
    } else {
      at = nearest(u);
      follow = hn::Not(hn::Gt(at, third_last));
      for (std::int32_t i = 1; i < 4; ++i) {
        const VI next = nearest(hn::Add(u, splat(i)));
        follow = hn::And(follow, hn::Eq(next, hn::Add(at, splat(i))));
      }
    }
    at = hn::Min(hn::Max(at, splat(0)), third_last);
    return hn::AllFalse(DI(), hn::And(wanted, hn::Not(follow)));
  }
};

/// Where the texels of one row lie.
class PlainRow {
 public:
  explicit PlainRow(const FormatDesc& format) : bytes_(splat(static_cast<std::int32_t>(format.block_bytes))) {}

  HWY_INLINE void set_row(const LevelLanes& level, VI y) {
    origin_ = hn::Add(level.origin, hn::Mul(y, level.row_pitch));
  }
  HWY_INLINE VI offset(VI x) const { return hn::Add(origin_, hn::Mul(x, bytes_)); }

 private:
  VI bytes_, origin_;
};

/// Sums of texels of one word, component by component.
template <Numeric kNumeric>
class WordSums : public PlainRow {
 public:
  explicit WordSums(const FormatDesc& format) : PlainRow(format) {
    for (std::size_t c = 0; c < 4; ++c) {
      const std::int8_t index = format.rgba[c];
      present_[c] = index >= 0;
      channel_[c] = format.channel[static_cast<std::size_t>(index < 0 ? 0 : index)];
    }
  }

  HWY_INLINE void add_one(const std::byte* base, VI x, const RowWalk::Weight& w) {
    add(load_words(base, offset(x)), w);
  }
  HWY_INLINE void add_four(const std::byte* base, VI x, const RowWalk::Weight w[4]) {
    VU words[4];
    load_word_quads(base, offset(x), words);
    for (std::size_t i = 0; i < 4; ++i) add(words[i], w[i]);
  }
  HWY_INLINE bool store(Sums& sums) const {
    for (std::size_t c = 0; c < 4; ++c) sums.color[c] = sum_[c];
    // Components that are missing are 0 or 1.
    if (!present_[3]) sums.color[3] = sums.total;
    return true;
  }

 private:
  HWY_INLINE void add(VU word, const RowWalk::Weight& w) {
    constexpr bool kFloat = kNumeric == Numeric::kSfloat || kNumeric == Numeric::kUfloat;
    for (std::size_t c = 0; c < 4; ++c) {
      if (!present_[c]) continue;
      const VF sum = hn::Add(sum_[c], hn::Mul(convert_field<kNumeric>(word, channel_[c]), w.value));
      sum_[c] = kFloat ? hn::IfThenElse(hn::RebindMask(DF(), w.inside), sum, sum_[c]) : sum;
    }
  }

  bool present_[4];
  Channel channel_[4];
  VF sum_[4] = {splat(0.0f), splat(0.0f), splat(0.0f), splat(0.0f)};
};

/// Of words of four bytes that are unsigned-normalised.
class ByteValues {
 public:
  ByteValues() : sum_{splat(0.0f), splat(0.0f), splat(0.0f), splat(0.0f)} {}

  HWY_INLINE void add(VU word, VF weight) {
    const auto put = [&](std::size_t i, VU byte) HWY_ATTR {
      const VF value = hn::Mul(lanes_int_to_float(hn::BitCast(DI(), byte)), splat(1.0f / 255.0f));
      sum_[i] = hn::Add(sum_[i], hn::Mul(value, weight));
    };
    const VU low = hn::Set(DU(), 255u);
    put(0, hn::And(word, low));
    put(1, hn::And(hn::ShiftRight<8>(word), low));
    put(2, hn::And(hn::ShiftRight<16>(word), low));
    put(3, hn::ShiftRight<24>(word));
  }
  HWY_INLINE VF sum(std::size_t byte) const { return sum_[byte]; }

 private:
  VF sum_[4];
};

/// Of plain formats with four such channels.
class ByteSums : public PlainRow {
 public:
  explicit ByteSums(const FormatDesc& format) : PlainRow(format), format_(format) {}

  HWY_INLINE void add_one(const std::byte* base, VI x, const RowWalk::Weight& w) {
    values_.add(load_words(base, offset(x)), w.value);
  }
  HWY_INLINE void add_four(const std::byte* base, VI x, const RowWalk::Weight w[4]) {
    VU words[4];
    load_word_quads(base, offset(x), words);
    for (std::size_t i = 0; i < 4; ++i) values_.add(words[i], w[i].value);
  }
  HWY_INLINE bool store(Sums& sums) const {
    for (std::size_t c = 0; c < 4; ++c) {
      const auto index = static_cast<std::size_t>(format_.rgba[c]);
      sums.color[c] = values_.sum(format_.channel[index].offset / 8u);
    }
    return true;
  }

 private:
  const FormatDesc& format_;
  ByteValues values_;
};

/// Of BC1 to BC5 that are neither signed nor sRGB.
class S3tcSums {
 public:
  explicit S3tcSums(const FormatDesc& format)
      : kind_(s3tc_kind(format)), block_bytes_(splat(static_cast<std::int32_t>(format.block_bytes))) {}

  HWY_INLINE void set_row(const LevelLanes& level, VI y) {
    origin_ = hn::Add(level.origin, hn::Mul(hn::ShiftRight<2>(y), level.row_pitch));
    inner_ = hn::ShiftLeft<2>(hn::And(y, splat(3)));
    last_block_ = hn::ShiftRight<2>(hn::Sub(level.axis[0].size, splat(1)));
  }
  HWY_INLINE void add_one(const std::byte* base, VI x, const RowWalk::Weight& w) {
    values_.add(gather_s3tc(kind_, base, offset(hn::ShiftRight<2>(x)), inner(x)), w.value);
  }
  HWY_INLINE void add_four(const std::byte* base, VI x, const RowWalk::Weight w[4]) {
    if (has_two_parts(kind_) || kind_ == S3tcKind::kRed) {
      for (std::int32_t i = 0; i < 4; ++i) add_one(base, hn::Add(x, splat(i)), w[i]);
      return;
    }
    const VI block = hn::ShiftRight<2>(x);
    const WordPair near = load_word_pairs(base, offset(block));
    const WordPair next = load_word_pairs(base, offset(hn::Min(hn::Add(block, splat(1)), last_block_)));
    const auto kind = kind_ == S3tcKind::kRgb ? ColorBlock::kRgb : ColorBlock::kRgba;
    for (std::int32_t i = 0; i < 4; ++i) {
      const VI at = hn::Add(x, splat(i));
      const auto here = hn::RebindMask(DU(), hn::Eq(hn::ShiftRight<2>(at), block));
      const VU ends = hn::IfThenElse(here, near.first, next.first);
      const VU codes = hn::IfThenElse(here, near.second, next.second);
      values_.add(decode_color_lanes(ends, codes, hn::BitCast(DU(), inner(at)), kind), w[i].value);
    }
  }
  HWY_INLINE bool store(Sums& sums) const {
    for (std::size_t c = 0; c < 4; ++c) sums.color[c] = values_.sum(c);
    return true;
  }

 private:
  HWY_INLINE VI offset(VI block) const { return hn::Add(origin_, hn::Mul(block, block_bytes_)); }
  HWY_INLINE VI inner(VI x) const { return hn::Or(inner_, hn::And(x, splat(3))); }

  S3tcKind kind_;
  VI block_bytes_, origin_, inner_, last_block_;
  ByteValues values_;
};

/// Of four halves or floats: the components of every fourth lane's texel lie in a 128-bit block.
template <std::size_t kBytes, bool kMasked>
class FourSums : public PlainRow {
 public:
  explicit FourSums(const FormatDesc& format) : PlainRow(format) {}

  HWY_INLINE void add_one(const std::byte* base, VI x, const RowWalk::Weight& w) {
    const OffsetLanes<hn::MaxLanes(DI())> offsets(offset(x));
    const auto texel = [&](std::size_t lane) HWY_ATTR { return load_texels<kBytes>(base, offsets.at + lane); };
    add<0>(texel(0), w);
    add<1>(texel(1), w);
    add<2>(texel(2), w);
    add<3>(texel(3), w);
  }
  HWY_INLINE void add_four(const std::byte* base, VI x, const RowWalk::Weight w[4]) {
    const OffsetLanes<hn::MaxLanes(DI())> offsets(offset(x));
    add_row<0>(base, offsets.at, w);
    add_row<1>(base, offsets.at, w);
    add_row<2>(base, offsets.at, w);
    add_row<3>(base, offsets.at, w);
  }
  /// False: a texel without weight may have been an infinity or NaN.
  HWY_INLINE bool store(Sums& sums) const {
    split_blocks(sum_, sums.color);
    if constexpr (kMasked) return true;
    auto good = hn::Eq(sums.color[0], sums.color[0]);
    for (std::size_t c = 1; c < 4; ++c) good = hn::And(good, hn::Eq(sums.color[c], sums.color[c]));
    return hn::AllTrue(DF(), good);
  }

 private:
  template <int kLane>
  HWY_INLINE void add(VF texel, const RowWalk::Weight& w) {
    const VF weight = hn::Broadcast<kLane>(w.value);
    const VF sum = hn::Add(sum_[kLane], hn::Mul(texel, weight));
    sum_[kLane] = kMasked ? hn::IfThenElse(hn::Gt(weight, splat(0.0f)), sum, sum_[kLane]) : sum;
  }
  /// Four texels that follow one another, of every fourth lane from kLane on.
  template <int kLane>
  HWY_INLINE void add_row(const std::byte* base, const std::int32_t* offset, const RowWalk::Weight w[4]) {
    VF texel[4];
    load_four_neighbours<kBytes>(base, offset + kLane, texel);
    for (std::size_t i = 0; i < 4; ++i) add<kLane>(texel[i], w[i]);
  }

  VF sum_[4] = {splat(0.0f), splat(0.0f), splat(0.0f), splat(0.0f)};
};

/// Without comparison or border. False as TexelSums::store.
template <class TexelSums>
HWY_NOINLINE bool walk_rows(const Plan& plan, const Footprint& in, Sums& sums) {
  const LevelLanes& level = in.level;
  const EllipseLanes& e = in.ellipse;
  const std::byte* const base = plan.view->base;
  const auto live = lanes_mask_from_bits(DI(), in.active);
  // Four texels from the last of the row on.
  const WalkAxis x_axis(level.axis[0], e.u0, hn::Add(e.u1, splat(4)), live);
  const WalkAxis y_axis(level.axis[1], e.v0, e.v1, live);
  const bool wide = hn::AllFalse(DI(), hn::Lt(level.axis[0].size, splat(4)));
  const EllipseWalk walk(e);
  TexelSums texels(*plan.view->format);
  VF total = splat(0.0f);
  VI v = e.v0;
  for (auto lanes = live; !hn::AllFalse(DI(), lanes);
       v = hn::Add(v, splat(1)), lanes = hn::And(live, hn::Not(hn::Gt(v, e.v1)))) {
    texels.set_row(level, y_axis.nearest(v));
    RowWalk row = walk.row(lanes_int_to_float(v), lanes);
    for (RowWalk::Weight w[4]; row.next_weighed(w[0]);) {
      const VI u = hn::Sub(row.u, splat(1));
      for (std::size_t i = 1; i < 4; ++i) w[i] = row.next();
      for (std::size_t i = 0; i < 4; ++i) total = hn::Add(total, w[i].value);
      const auto wanted = hn::Or(hn::Or(w[0].inside, w[1].inside), hn::Or(w[2].inside, w[3].inside));
      VI at;
      if (wide && x_axis.first_of_four(u, wanted, at)) {
        texels.add_four(base, at, w);
        continue;
      }
      for (std::size_t i = 0; i < 4; ++i) {
        if (hn::AllFalse(DI(), w[i].inside)) continue;
        texels.add_one(base, x_axis.nearest(hn::Add(u, splat(static_cast<std::int32_t>(i)))), w[i]);
      }
    }
  }
  sums.total = total;
  return texels.store(sums);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
