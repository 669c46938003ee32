// Row codecs by SIMD; bits equal texel_decoder's and texel_encoder's.
#include "texel/codec/rows.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/codec/rows.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vitrine::base::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using DU = hn::RebindToUnsigned<D>;
using DI = hn::RebindToSigned<D>;

/// Calls body(first, n) for whole vectors, n floats from float `first` on; the rest of fewer floats goes through
/// `padded`.
template <class Body>
HWY_INLINE std::size_t whole_vectors(std::size_t floats, Body&& body) {
  std::size_t i = 0;
  for (; i + hn::Lanes(D()) <= floats; i += hn::Lanes(D())) body(i);
  return i;
}

/// Four UNORM bytes in memory order.
std::size_t decode_bytes(const std::byte* from, std::size_t floats, std::uint32_t* to) {
  const hn::Rebind<std::uint8_t, D> d8;
  return whole_vectors(floats, [&](std::size_t i) {
    const auto bytes = hn::LoadU(d8, reinterpret_cast<const std::uint8_t*>(from) + i);
    const auto value = hn::Mul(lanes_int_to_float(hn::PromoteTo(DI(), bytes)), hn::Set(D(), 1.0f / 255.0f));
    hn::StoreU(hn::BitCast(DU(), value), DU(), to + i);
  });
}

std::size_t encode_bytes(const std::uint32_t* from, std::size_t floats, bool store, std::byte* to) {
  const hn::Rebind<std::uint8_t, D> d8;
  const auto zero = hn::Zero(D()), one = hn::Set(D(), 1.0f);
  return whole_vectors(floats, [&](std::size_t i) {
    const auto x = hn::BitCast(D(), hn::LoadU(DU(), from + i));
    const auto clamped =
        store ? lanes_max_second(lanes_min_second(x, one), zero) : lanes_min_second(lanes_max_second(x, zero), one);
    const auto sum = hn::Add(hn::Mul(clamped, hn::Set(D(), 255.0f / 256.0f)), hn::Set(D(), 32768.0f));
    const auto byte = hn::And(hn::BitCast(DI(), sum), hn::Set(DI(), 255));
    hn::StoreU(hn::DemoteTo(d8, byte), d8, reinterpret_cast<std::uint8_t*>(to) + i);
  });
}

std::size_t decode_halves(const std::byte* from, std::size_t floats, std::uint32_t* to) {
  const hn::Rebind<std::uint16_t, D> d16;
  return whole_vectors(floats, [&](std::size_t i) {
    const auto half = hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(from) + i);
    hn::StoreU(hn::BitCast(DU(), lanes_half_to_float(hn::PromoteTo(DU(), half))), DU(), to + i);
  });
}

/// Toward zero, as float_to_half_truncate.
std::size_t encode_halves(const std::uint32_t* from, std::size_t floats, std::byte* to) {
  const hn::Rebind<std::uint16_t, D> d16;
  return whole_vectors(floats, [&](std::size_t i) {
    const auto bits = hn::LoadU(DU(), from + i);
    const auto sign = hn::And(hn::ShiftRight<16>(bits), hn::Set(DU(), 0x8000u));
    const auto magnitude = hn::And(bits, hn::Set(DU(), 0x7fffffffu));
    const auto order = hn::BitCast(DI(), magnitude);
    const auto select = [](auto condition, auto yes, auto no) {
      return hn::IfThenElse(hn::RebindMask(DU(), condition), yes, no);
    };
    const auto shifted = hn::ShiftRight<13>(magnitude);
    // Below 2^-14: multiples of 2^-24.
    const auto tiny = lanes_truncate_to_int(hn::Mul(hn::BitCast(D(), magnitude), hn::Set(D(), 16777216.0f)));
    auto half = hn::Sub(shifted, hn::Set(DU(), 112u << 10));
    half = select(hn::Lt(order, hn::Set(DI(), 113 << 23)), hn::BitCast(DU(), tiny), half);
    half = select(hn::Gt(order, hn::Set(DI(), 0x477fffff)), hn::Set(DU(), 0x7bffu), half);
    half = select(hn::Eq(order, hn::Set(DI(), 0x7f800000)), hn::Set(DU(), 0x7c00u), half);
    const auto nan = hn::Or(hn::Set(DU(), 0x7e00u), hn::And(shifted, hn::Set(DU(), 0x3ffu)));
    half = select(hn::Gt(order, hn::Set(DI(), 0x7f800000)), nan, half);
    const auto result = hn::BitCast(DI(), hn::Or(half, sign));
    hn::StoreU(hn::DemoteTo(d16, result), d16, reinterpret_cast<std::uint16_t*>(to) + i);
  });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(decode_bytes);
HWY_EXPORT(encode_bytes);
HWY_EXPORT(decode_halves);
HWY_EXPORT(encode_halves);

bool is_four_halves(const FormatDesc& format) {
  return format.plain && format.block_bytes == 8 && format.channel_count == 4 && format.channel[0].bits == 16 &&
         format.channel[0].numeric == Numeric::kSfloat && format.component == std::array<std::uint8_t, 4>{0, 1, 2, 3};
}

/// Components of texels in memory order to R, G, B, A, or back.
void exchange_red_and_blue(const FormatDesc& format, Texel* texels, std::size_t count) {
  if (format.component[0] == 0) return;
  for (std::size_t i = 0; i < count; ++i) std::swap(texels[i][0], texels[i][2]);
}

/// R, G, B, A or B, G, R, A.
bool has_simple_order(const FormatDesc& format) {
  const std::array<std::uint8_t, 4> rgba{0, 1, 2, 3}, bgra{2, 1, 0, 3};
  return format.component == rgba || format.component == bgra;
}

}  // namespace

bool is_four_bytes(const FormatDesc& format) {
  if (!format.plain || format.block_bytes != 4 || format.channel_count != 4) return false;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Channel& channel = format.channel[i];
    if (channel.bits != 8 || channel.offset != 8 * i || channel.numeric != Numeric::kUnorm) return false;
    if (format.rgba[i] < 0) return false;
  }
  return true;
}

bool decode_row_simd(const FormatDesc& format, const std::byte* blocks, std::size_t count, Texel* out) {
  const bool bytes = is_four_bytes(format) && has_simple_order(format);
  if (count < 4 || (!bytes && !is_four_halves(format))) return false;
  base::select_simd_target();
  std::uint32_t* to = out->data();
  const std::size_t done = (bytes ? HWY_DYNAMIC_DISPATCH(decode_bytes)(blocks, 4 * count, to)
                                  : HWY_DYNAMIC_DISPATCH(decode_halves)(blocks, 4 * count, to)) /
                           4;
  if (bytes) exchange_red_and_blue(format, out, done);
  const TexelDecoder decode = texel_decoder(format);
  for (std::size_t i = done; i < count; ++i) decode(format, blocks + i * format.block_bytes, out[i]);
  return true;
}

bool encode_row_simd(const FormatDesc& format, Encoding encoding, const Texel* texels, std::size_t count,
                     std::byte* blocks) {
  const bool bytes = is_four_bytes(format) && has_simple_order(format) && encoding != Encoding::kClear;
  if (count < 4 || (!bytes && !is_four_halves(format))) return false;
  base::select_simd_target();
  const std::uint32_t* from = texels->data();
  const bool store = encoding == Encoding::kStore;
  const std::size_t done = (bytes ? HWY_DYNAMIC_DISPATCH(encode_bytes)(from, 4 * count, store, blocks)
                                  : HWY_DYNAMIC_DISPATCH(encode_halves)(from, 4 * count, blocks)) /
                           4;
  if (bytes && format.component[0] != 0) {
    for (std::size_t i = 0; i < done; ++i) std::swap(blocks[4 * i], blocks[4 * i + 2]);
  }
  const TexelEncoder encode = texel_encoder(format, encoding);
  for (std::size_t i = done; i < count; ++i) encode(format, texels[i], blocks + i * format.block_bytes);
  return true;
}

void put_bytes(const FormatDesc& from, const std::uint32_t* texels, std::size_t count, const FormatDesc& to,
               std::byte* blocks) {
  std::array<std::uint32_t, 4> shift{0, 8, 16, 24};  // of R, G, B, A
  if (is_four_bytes(from)) {
    for (std::size_t c = 0; c < 4; ++c) shift[c] = 8u * static_cast<std::uint32_t>(from.rgba[c]);
  }
  if (!is_four_bytes(to)) {
    std::array<Texel, 64> row;
    for (std::size_t first = 0; first < count; first += row.size()) {
      const std::size_t n = std::min(row.size(), count - first);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t c = 0; c < 4; ++c) {
          const float value = static_cast<float>(texels[first + i] >> shift[c] & 255) * (1.0f / 255.0f);
          std::memcpy(&row[i][c], &value, sizeof(value));
        }
      }
      encode_row(to, Encoding::kAttachment, row.data(), n, blocks + first * to.block_bytes);
    }
    return;
  }
  std::uint32_t source[4];
  bool same = true;
  for (std::size_t i = 0; i < 4; ++i) {
    source[i] = shift[to.component[i]];
    same = same && source[i] == 8 * i;
  }
  if (same) {
    std::memcpy(blocks, texels, count * 4);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t word = texels[i];
    const std::uint32_t out = (word >> source[0] & 255) | (word >> source[1] & 255) << 8 |
                              (word >> source[2] & 255) << 16 | (word >> source[3] & 255) << 24;
    std::memcpy(blocks + 4 * i, &out, sizeof(out));
  }
}

}  // namespace vitrine::texel

#endif
