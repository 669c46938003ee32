// Row codecs by SIMD; bits equal texel_decoder's and texel_encoder's.
#include "texel/codec/rows.h"

#include <algorithm>
#include <cstring>

#include "texel/codec/field_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/codec/rows.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "texel/codec/four_bytes-inl.h"
#include "texel/codec/half-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vitrine::base::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using DU = hn::RebindToUnsigned<D>;

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
  return whole_vectors(
      floats, [&](std::size_t i) { hn::StoreU(hn::BitCast(DU(), unorm_values(load_codes(from + i))), DU(), to + i); });
}

std::size_t encode_bytes(const std::uint32_t* from, std::size_t floats, bool store, std::byte* to) {
  const auto zero = hn::Zero(D()), one = hn::Set(D(), 1.0f);
  return whole_vectors(floats, [&](std::size_t i) {
    const auto x = hn::BitCast(D(), hn::LoadU(DU(), from + i));
    const auto clamped =
        store ? lanes_max_second(lanes_min_second(x, one), zero) : lanes_min_second(lanes_max_second(x, zero), one);
    store_codes(unorm_codes(clamped), to + i);
  });
}

std::size_t encode_attachment_bytes(const std::uint32_t* from, std::size_t floats, std::byte* to) {
  return encode_bytes(from, floats, false, to);
}
std::size_t encode_stored_bytes(const std::uint32_t* from, std::size_t floats, std::byte* to) {
  return encode_bytes(from, floats, true, to);
}

/// Three sRGB bytes and a UNORM one.
std::size_t decode_srgb_bytes(const std::byte* from, std::size_t floats, std::uint32_t* to) {
  const auto alpha = alpha_lanes();
  return whole_vectors(floats, [&](std::size_t i) {
    hn::StoreU(hn::BitCast(DU(), srgb_texel_values(alpha, load_codes(from + i))), DU(), to + i);
  });
}

/// encode_srgb_attachment of three components, UNORM of the fourth.
template <class Rsqrt>
std::size_t encode_srgb(const std::uint32_t* from, std::size_t floats, std::byte* to) {
  const auto alpha = alpha_lanes();
  return whole_vectors(floats, [&](std::size_t i) {
    store_codes(srgb_texel_codes<Rsqrt>(alpha, hn::BitCast(D(), hn::LoadU(DU(), from + i))), to + i);
  });
}

/// Only where cpu_has_rsqrt().
std::size_t encode_srgb_bytes(const std::uint32_t* from, std::size_t floats, std::byte* to) {
  return encode_srgb<RsqrtOfCpu>(from, floats, to);
}
std::size_t encode_srgb_bytes_by_table(const std::uint32_t* from, std::size_t floats, std::byte* to) {
  return encode_srgb<RsqrtByTable>(from, floats, to);
}

std::size_t decode_halves(const std::byte* from, std::size_t floats, std::uint32_t* to) {
  const hn::Rebind<std::uint16_t, D> d16;
  return whole_vectors(floats, [&](std::size_t i) {
    const auto halves = hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(from) + i);
    hn::StoreU(hn::BitCast(DU(), floats_of_halves(halves)), DU(), to + i);
  });
}

std::size_t encode_halves(const std::uint32_t* from, std::size_t floats, std::byte* to) {
  const hn::Rebind<std::uint16_t, D> d16;
  return whole_vectors(floats, [&](std::size_t i) {
    const auto halves = halves_of_floats(hn::BitCast(D(), hn::LoadU(DU(), from + i)));
    hn::StoreU(halves, d16, reinterpret_cast<std::uint16_t*>(to) + i);
  });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

using DecodeRow = std::size_t (*)(const std::byte*, std::size_t, std::uint32_t*);
using EncodeRow = std::size_t (*)(const std::uint32_t*, std::size_t, std::byte*);

HWY_EXPORT(decode_bytes);
HWY_EXPORT(encode_attachment_bytes);
HWY_EXPORT(encode_stored_bytes);
HWY_EXPORT(decode_srgb_bytes);
HWY_EXPORT(encode_srgb_bytes);
HWY_EXPORT(encode_srgb_bytes_by_table);
HWY_EXPORT(decode_halves);
HWY_EXPORT(encode_halves);

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

/// Four bytes in any order, of one numeric format.
bool has_four_bytes(const FormatDesc& format, Numeric numeric) {
  if (!format.plain || format.block_bytes != 4 || format.channel_count != 4) return false;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Channel& channel = format.channel[i];
    if (channel.bits != 8 || channel.offset != 8 * i || channel.numeric != numeric) return false;
    if (format.rgba[i] < 0) return false;
  }
  return true;
}

/// One to three UNORM bytes.
bool has_bytes(const FormatDesc& format) {
  if (!format.plain || format.channel_count > 3 || format.block_bytes != format.channel_count) return false;
  return std::all_of(format.channel.begin(), format.channel.begin() + format.channel_count,
                     [](const Channel& c) { return c.bits == 8 && c.numeric == Numeric::kUnorm; });
}

/// Null: no code of this file decodes the format.
DecodeRow row_decoder(const FormatDesc& format) {
  base::select_simd_target();
  if (is_four_halves(format)) return HWY_DYNAMIC_DISPATCH(decode_halves);
  if (is_srgb_bytes(format)) return HWY_DYNAMIC_DISPATCH(decode_srgb_bytes);
  if (is_four_bytes(format) && has_simple_order(format)) return HWY_DYNAMIC_DISPATCH(decode_bytes);
  return nullptr;
}

EncodeRow row_encoder(const FormatDesc& format, Encoding encoding) {
  base::select_simd_target();
  if (is_four_halves(format)) return HWY_DYNAMIC_DISPATCH(encode_halves);
  if (encoding == Encoding::kAttachment && is_srgb_bytes(format)) {
    return cpu_has_rsqrt() ? HWY_DYNAMIC_DISPATCH(encode_srgb_bytes) : HWY_DYNAMIC_DISPATCH(encode_srgb_bytes_by_table);
  }
  if (encoding == Encoding::kClear || !is_four_bytes(format) || !has_simple_order(format)) return nullptr;
  return encoding == Encoding::kStore ? HWY_DYNAMIC_DISPATCH(encode_stored_bytes)
                                      : HWY_DYNAMIC_DISPATCH(encode_attachment_bytes);
}

}  // namespace

bool is_four_bytes(const FormatDesc& format) { return has_four_bytes(format, Numeric::kUnorm); }

bool is_srgb_bytes(const FormatDesc& format) {
  return has_four_bytes(format, Numeric::kSrgb) && has_simple_order(format);
}

bool is_four_halves(const FormatDesc& format) {
  return format.plain && format.block_bytes == 8 && format.channel_count == 4 && format.channel[0].bits == 16 &&
         format.channel[0].numeric == Numeric::kSfloat && format.component == std::array<std::uint8_t, 4>{0, 1, 2, 3};
}

bool decode_row_simd(const FormatDesc& format, const std::byte* blocks, std::size_t count, Texel* out) {
  const DecodeRow row = count < 4 ? nullptr : row_decoder(format);
  std::size_t done = 0;
  if (row != nullptr) {
    done = row(blocks, 4 * count, out->data()) / 4;
    exchange_red_and_blue(format, out, done);
  } else {
    done = decode_field_row(format, blocks, count, out);
  }
  if (done == 0) return false;
  const TexelDecoder decode = texel_decoder(format);
  for (std::size_t i = done; i < count; ++i) decode(format, blocks + i * format.block_bytes, out[i]);
  return true;
}

bool encode_row_simd(const FormatDesc& format, Encoding encoding, const Texel* texels, std::size_t count,
                     std::byte* blocks) {
  const EncodeRow row = count < 4 ? nullptr : row_encoder(format, encoding);
  std::size_t done = 0;
  if (row != nullptr) {
    done = row(texels->data(), 4 * count, blocks) / 4;
    for (std::size_t i = 0; format.component[0] != 0 && i < done; ++i) std::swap(blocks[4 * i], blocks[4 * i + 2]);
  } else if (encoding == Encoding::kAttachment) {
    done = encode_field_row(format, texels, count, blocks);
  }
  if (done == 0) return false;
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
  if (has_bytes(to)) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < to.channel_count; ++c) {
        blocks[i * to.channel_count + c] = static_cast<std::byte>(texels[i] >> shift[to.component[c]] & 255);
      }
    }
    return;
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
