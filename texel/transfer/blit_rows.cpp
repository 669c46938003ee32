// Scales two-dimensional regions with taps of columns and rows found once (lavapipe-rasterization.md 11.3,
// lavapipe-texture-blend.md A3). The texture coordinates of the quad's two triangles follow one axis each, so that a
// row of the destination is a blend of two rows of the source that were filtered along x; rows are kept for the next
// one.
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "texel/block/block.h"
#include "texel/block/cache.h"
#include "texel/capabilities.h"
#include "texel/codec/field_rows.h"
#include "texel/codec/rows.h"
#include "texel/sampler/model/address.h"
#include "texel/transfer/blend_rows.h"
#include "texel/transfer/blit.h"
#include "texel/transfer/halve_rows.h"

namespace vitrine::texel {
namespace {

/// Taps of every destination texel along one axis, by one triangle's plane. Weights are of the second texel, in 256ths
/// or as floats.
struct TapList {
  std::vector<std::int32_t> first, second, byte_weight;
  std::vector<float> weight;

  bool same(const TapList& other, std::size_t i) const {
    return first[i] == other.first[i] && second[i] == other.second[i] && byte_weight[i] == other.byte_weight[i] &&
           weight[i] == other.weight[i];
  }
};

struct Scaler {
  Scaler(const Blit& b, const Plan& p) : blit(b), plan(p) {}

  const Blit& blit;
  Plan plan;
  TapList column[2], row[2];           ///< of the upper right and the lower left triangle
  std::vector<std::uint32_t> patches;  ///< columns whose taps differ between the triangles
  std::uint32_t low = 0, count = 0;    ///< columns of the source that are read
  bool raw = false;                    ///< nearest texels keep their bytes
  RowHalver halve = nullptr;           ///< columns are averages of two, each read once
  bool halve_decoded = false;          ///< of words of four bytes, or of Texels
  bool clamp_depth = false;            ///< raw texels are depths to be put into [0, 1]
};

void add_taps(const Plan& plan, std::uint32_t axis_index, float coordinate, TapList& taps) {
  const Extent& extent = plan.view->level[0].extent;
  Axis axis;
  axis.address = plan.address[axis_index];
  axis.pot = plan.pot[axis_index];
  axis.size = static_cast<std::int32_t>(axis_index == 0 ? extent.width : extent.height);
  ByteTaps bytes;
  Taps floats;
  if (plan.mag_linear) {
    if (plan.aos) bytes = linear_bytes(axis, coordinate);
    if (!plan.aos) floats = linear_texels(axis, coordinate);
  } else {
    bytes.first = bytes.second = floats.first = floats.second =
        plan.aos ? nearest_bytes(axis, coordinate) : nearest_texel(axis, coordinate);
  }
  taps.first.push_back(plan.aos ? bytes.first : floats.first);
  taps.second.push_back(plan.aos ? bytes.second : floats.second);
  taps.byte_weight.push_back(bytes.weight);
  taps.weight.push_back(floats.weight);
}

/// Whether texels that are only moved keep their bytes through decoding and encoding.
bool keeps_bytes(const FormatDesc& from, const FormatDesc& to) {
  const Numeric numeric = from.channel[0].numeric;
  const std::uint32_t bits = from.channel[0].bits;
  if (from.format != to.format || from.packed_bits != 0 || !can_decode(from)) return false;
  return numeric == Numeric::kUint || numeric == Numeric::kSint || (numeric == Numeric::kUnorm && bits == 8) ||
         (numeric == Numeric::kSfloat && bits == 32 && !from.is_depth_stencil());
}

/// False if a coordinate depends on the other axis.
bool find_taps(const Quad& quad, const Start& start, Scaler& scaler) {
  for (std::size_t t = 0; t < 2; ++t) {
    if (quad.u[t].dady != 0.0f || quad.v[t].dadx != 0.0f) return false;
    for (std::uint32_t x = 0; x < scaler.blit.to.columns; ++x) {
      const auto px = static_cast<float>(start.x + static_cast<std::int32_t>(x));
      add_taps(scaler.plan, 0, quad.u[t].at(px, static_cast<float>(start.y)), scaler.column[t]);
    }
    for (std::uint32_t y = 0; y < scaler.blit.to.rows; ++y) {
      const auto py = static_cast<float>(start.y + static_cast<std::int32_t>(y));
      add_taps(scaler.plan, 1, quad.v[t].at(static_cast<float>(start.x), py), scaler.row[t]);
    }
  }
  std::int32_t low = scaler.column[0].first[0], high = low;
  for (std::uint32_t x = 0; x < scaler.blit.to.columns; ++x) {
    if (!scaler.column[0].same(scaler.column[1], x)) scaler.patches.push_back(x);
    for (const TapList& taps : scaler.column) {
      low = std::min({low, taps.first[x], taps.second[x]});
      high = std::max({high, taps.first[x], taps.second[x]});
    }
  }
  for (TapList& taps : scaler.column) {
    for (std::int32_t& x : taps.first) x -= low;
    for (std::int32_t& x : taps.second) x -= low;
  }
  scaler.low = static_cast<std::uint32_t>(low);
  scaler.count = static_cast<std::uint32_t>(high - low + 1);
  return true;
}

/// Whether column x is between the source's columns 2 x and 2 x + 1.
bool halves_columns(const Scaler& scaler) {
  const TapList& taps = scaler.column[0];
  if (!scaler.plan.mag_linear || !scaler.patches.empty()) return false;
  for (std::size_t x = 0; x < taps.first.size(); ++x) {
    const auto first = static_cast<std::int32_t>(2 * x);
    if (taps.first[x] != first || taps.second[x] != first + 1) return false;
  }
  return true;
}

/// Where rows of the source are read once, too; else they had better be kept.
void choose_halver(Scaler& scaler) {
  const FormatDesc& format = *scaler.plan.view->format;
  const bool suits = halves_columns(scaler) && scaler.blit.y.from_size() == 2 * scaler.blit.y.to_size();
  if (!suits || !can_decode(format)) return;
  if (format.format == scaler.blit.to.format->format) scaler.halve = row_halver(format, scaler.plan.aos);
  if (scaler.halve != nullptr) return;
  scaler.halve = scaler.plan.aos ? word_halver() : texel_halver();
  scaler.halve_decoded = true;
}

/// Texels of a row as bytes R, G, B, A.
void decode_bytes(const FormatDesc& format, const std::byte* from, std::size_t count, std::uint32_t* to) {
  if (is_four_bytes(format)) {
    std::memcpy(to, from, 4 * count);  // in the format's own order
    return;
  }
  ImageView view;
  view.format = &format;
  for (std::size_t i = decode_byte_row(format, from, count, to); i < count; ++i) {
    view.base = const_cast<std::byte*>(from + i * format.block_bytes);
    ByteTexel bytes;
    fetch_bytes(view, 0, 0, 0, 0, 0, bytes);
    std::memcpy(to + i, bytes.data(), sizeof(*to));
  }
}

void decode(const FormatDesc& format, const std::byte* from, std::size_t count, Texel* to) {
  decode_row(format, from, count, to);
}
void decode(const FormatDesc& format, const std::byte* from, std::size_t count, std::uint32_t* to) {
  decode_bytes(format, from, count, to);
}
void encode(const FormatDesc&, const Texel* from, std::size_t count, const FormatDesc& format, std::byte* to) {
  encode_row(format, Encoding::kAttachment, from, count, to);
}
void encode(const FormatDesc& order, const std::uint32_t* from, std::size_t count, const FormatDesc& format,
            std::byte* to) {
  put_bytes(order, from, count, format, to);
}

/// Decoded, halved and encoded some texels at a time, so that they stay in the nearest cache.
template <class T>
void halve_decoded_row(const Scaler& scaler, const FormatDesc& format, const HalvedRow& row) {
  constexpr std::size_t kChunk = 128;
  const FormatDesc& to = *scaler.blit.to.format;
  alignas(64) T upper[2 * kChunk], lower[2 * kChunk], out[kChunk];
  for (std::size_t first = 0; first < row.count; first += kChunk) {
    HalvedRow part = row;
    part.count = std::min(kChunk, row.count - first);
    decode(format, row.upper + 2 * first * format.block_bytes, 2 * part.count, upper);
    decode(format, row.lower + 2 * first * format.block_bytes, 2 * part.count, lower);
    part.upper = reinterpret_cast<const std::byte*>(upper);
    part.lower = reinterpret_cast<const std::byte*>(lower);
    part.weight_x += first;
    part.byte_weight_x += first;
    part.out = reinterpret_cast<std::byte*>(out);
    scaler.halve(part);
    encode(format, out, part.count, to, row.out + first * to.block_bytes);
  }
}

void halve_row(const Scaler& scaler, const ImageView& view, std::uint32_t row, std::byte* to) {
  const TapList &columns = scaler.column[0], &rows = scaler.row[0];
  HalvedRow halved;
  halved.upper = view.block(0, 0, 0, scaler.low, static_cast<std::uint32_t>(rows.first[row]), 0);
  halved.lower = view.block(0, 0, 0, scaler.low, static_cast<std::uint32_t>(rows.second[row]), 0);
  halved.count = columns.first.size();
  halved.weight_x = columns.weight.data();
  halved.byte_weight_x = columns.byte_weight.data();
  halved.weight_y = rows.weight[row];
  halved.byte_weight_y = rows.byte_weight[row];
  halved.out = to;
  if (!scaler.halve_decoded) return scaler.halve(halved);
  scaler.plan.aos ? halve_decoded_row<std::uint32_t>(scaler, *view.format, halved)
                  : halve_decoded_row<Texel>(scaler, *view.format, halved);
}

/// What one band of rows needs, for texels of type T: bytes in a word, or four components.
template <class T>
struct Band {
  const Scaler& scaler;
  const ImageView view;
  std::vector<T> source;            ///< a decoded row; of compressed formats the rows of a row of blocks
  std::int32_t row_of_blocks = -1;  ///< which
  std::vector<T> result;
  struct Kept {
    std::int32_t y = -1;
    std::vector<T> row;
  };
  std::array<Kept, 2> kept;  ///< rows filtered along x
  std::size_t oldest = 0;

  Band(const Scaler& s, const ImageView& v) : scaler(s), view(v) {
    source.resize(scaler.count);
    result.resize(scaler.blit.to.columns);
  }
};

/// A row of texels from rows of whole blocks.
const std::uint32_t* load_blocks(Band<std::uint32_t>& band, std::uint32_t row) {
  const FormatDesc& format = *band.view.format;
  const std::uint32_t width = format.block_width, height = format.block_height, low = band.scaler.low;
  const std::uint32_t first = low / width, last = (low + band.scaler.count - 1) / width;
  const std::size_t pitch = std::size_t{last - first + 1} * width;
  if (const auto y = static_cast<std::int32_t>(row / height); y != band.row_of_blocks) {
    band.row_of_blocks = y;
    band.source.resize(pitch * height);
    std::uint32_t texels[kMaxBlockTexels];
    for (std::uint32_t x = first; x <= last; ++x) {
      decode_block_bytes(format, band.view.block(0, 0, 0, x, row / height, 0), texels);
      for (std::uint32_t i = 0; i < height; ++i) {
        std::copy_n(texels + i * width, width, band.source.data() + i * pitch + std::size_t{x - first} * width);
      }
    }
  }
  return band.source.data() + (row % height) * pitch + (low - first * width);
}

const std::uint32_t* load_row(Band<std::uint32_t>& band, std::int32_t y) {
  const FormatDesc& format = *band.view.format;
  const auto row = static_cast<std::uint32_t>(y);
  if (is_four_bytes(format)) {
    return reinterpret_cast<const std::uint32_t*>(band.view.block(0, 0, 0, band.scaler.low, row, 0));
  }
  if (format.is_compressed()) return load_blocks(band, row);
  decode_bytes(format, band.view.block(0, 0, 0, band.scaler.low, row, 0), band.scaler.count, band.source.data());
  return band.source.data();
}

const Texel* load_row(Band<Texel>& band, std::int32_t y) {
  const FormatDesc& format = *band.view.format;
  const auto row = static_cast<std::uint32_t>(y);
  if (can_decode(format)) {
    decode_row(format, band.view.block(0, 0, 0, band.scaler.low, row, 0), band.scaler.count, band.source.data());
  } else {
    Plan plan = band.scaler.plan;
    plan.view = &band.view;
    for (std::uint32_t x = 0; x < band.scaler.count; ++x) {
      fetch_texel(plan, 0, 0, band.scaler.low + x, row, 0, band.source[x]);
    }
  }
  return band.source.data();
}

/// Weights of a tap list in the type that T is blended with.
const std::int32_t* weights_of(const TapList& taps, const std::uint32_t*) { return taps.byte_weight.data(); }
const float* weights_of(const TapList& taps, const Texel*) { return taps.weight.data(); }

template <class T>
const T* filtered_row(Band<T>& band, std::int32_t y) {
  for (std::size_t i = 0; i < band.kept.size(); ++i) {
    if (band.kept[i].y != y) continue;
    band.oldest = i ^ 1;  // the caller may want this row beside the next one that it asks for
    return band.kept[i].row.data();
  }
  auto& kept = band.kept[band.oldest];
  band.oldest ^= 1;
  const TapList& taps = band.scaler.column[0];
  const std::size_t count = taps.first.size();
  kept.y = y;
  kept.row.resize(count);
  const T* source = load_row(band, y);
  if (band.scaler.plan.mag_linear) {
    blend_columns(source, taps.first.data(), taps.second.data(), weights_of(taps, source), count, kept.row.data());
  } else {
    for (std::size_t i = 0; i < count; ++i) kept.row[i] = source[taps.first[i]];
  }
  return kept.row.data();
}

/// Texels first..end of the result, from the row taps of triangle `t`.
template <class T>
void blend_part(Band<T>& band, std::size_t t, std::uint32_t row, std::size_t first, std::size_t end) {
  if (first >= end) return;
  const TapList& taps = band.scaler.row[t];
  const T* upper = filtered_row(band, taps.first[row]);
  if (!band.scaler.plan.mag_linear) {
    std::copy(upper + first, upper + end, band.result.data() + first);
    return;
  }
  const T* lower = filtered_row(band, taps.second[row]);
  blend_rows(upper + first, lower + first, weights_of(taps, upper)[row], end - first, band.result.data() + first);
}

/// One texel by the lower left triangle.
template <class T>
void patch_texel(Band<T>& band, std::uint32_t row, std::uint32_t x) {
  const TapList &columns = band.scaler.column[1], &rows = band.scaler.row[1];
  T part[2];
  const std::int32_t y[2] = {rows.first[row], rows.second[row]};
  for (std::size_t i = 0; i < 2; ++i) {
    const T* source = load_row(band, y[i]);
    if (band.scaler.plan.mag_linear) {
      blend_columns(source, &columns.first[x], &columns.second[x], weights_of(columns, source) + x, 1, &part[i]);
    } else {
      part[i] = source[columns.first[x]];
    }
  }
  if (band.scaler.plan.mag_linear) {
    blend_rows(&part[0], &part[1], weights_of(rows, part)[row], 1, &band.result[x]);
  } else {
    band.result[x] = part[0];
  }
}

void put_row(const Scaler& scaler, const Band<std::uint32_t>& band, std::byte* to) {
  put_bytes(*band.view.format, band.result.data(), band.result.size(), *scaler.blit.to.format, to);
}
void put_row(const Scaler& scaler, const Band<Texel>& band, std::byte* to) {
  encode_row(*scaler.blit.to.format, Encoding::kAttachment, band.result.data(), band.result.size(), to);
}

/// Whether two rows of the destination are the same.
bool repeats(const Scaler& scaler, std::uint32_t row) {
  if (!scaler.patches.empty()) return false;
  for (const TapList& taps : scaler.row) {
    if (taps.first[row] != taps.first[row - 1] || taps.second[row] != taps.second[row - 1] ||
        taps.byte_weight[row] != taps.byte_weight[row - 1] || taps.weight[row] != taps.weight[row - 1]) {
      return false;
    }
  }
  return scaler.row[0].same(scaler.row[1], row);
}

template <class T>
void scale_band(const Scaler& scaler, const ImageView& view, std::uint32_t first, std::uint32_t count,
                std::uint32_t slice) {
  Band<T> band(scaler, view);
  const auto columns = static_cast<std::int32_t>(scaler.blit.to.columns);
  for (std::uint32_t row = first; row < first + count; ++row) {
    std::byte* to = scaler.blit.to.row(slice, 0, row);
    if (row != first && repeats(scaler, row)) {
      std::memcpy(to, scaler.blit.to.row(slice, 0, row - 1), scaler.blit.to.row_bytes());
      continue;
    }
    const std::int32_t split = std::clamp(first_upper_texel(scaler.blit, static_cast<std::int32_t>(row)), 0, columns);
    const bool one_part = scaler.row[0].same(scaler.row[1], row);
    if (one_part && scaler.halve != nullptr) {
      halve_row(scaler, view, row, to);
      continue;
    }
    const auto upper = static_cast<std::size_t>(one_part ? 0 : split);
    blend_part(band, 1, row, 0, upper);
    blend_part(band, 0, row, upper, static_cast<std::size_t>(columns));
    for (const std::uint32_t x : scaler.patches) {
      if (static_cast<std::int32_t>(x) < split) patch_texel(band, row, x);
    }
    put_row(scaler, band, to);
  }
}

/// Four texels at a time: a loop of one is a sixth slower where it happens to lie across two lines of the code.
template <std::size_t kBytes>
void pick_texels(const std::byte* from, const TapList& taps, std::size_t first, std::size_t end, std::byte* to) {
  const std::int32_t* columns = taps.first.data();
  const auto texel = [&](std::size_t i) { return from + static_cast<std::size_t>(columns[i]) * kBytes; };
  std::size_t i = first;
  for (; i + 4 <= end; i += 4) {
    std::byte four[4 * kBytes];
    for (std::size_t k = 0; k < 4; ++k) std::memcpy(four + k * kBytes, texel(i + k), kBytes);
    std::memcpy(to + i * kBytes, four, sizeof four);
  }
  for (; i < end; ++i) std::memcpy(to + i * kBytes, texel(i), kBytes);
}

void pick_texels(std::size_t bytes, const std::byte* from, const TapList& taps, std::size_t first, std::size_t end,
                 std::byte* to) {
  switch (bytes) {
    case 1:
      return pick_texels<1>(from, taps, first, end, to);
    case 2:
      return pick_texels<2>(from, taps, first, end, to);
    case 4:
      return pick_texels<4>(from, taps, first, end, to);
    case 8:
      return pick_texels<8>(from, taps, first, end, to);
    case 16:
      return pick_texels<16>(from, taps, first, end, to);
    default:
      for (std::size_t i = first; i < end; ++i) {
        std::memcpy(to + i * bytes, from + static_cast<std::size_t>(taps.first[i]) * bytes, bytes);
      }
  }
}

/// As depth is written.
void clamp_depths(std::byte* row, std::size_t count) {
  auto* depth = reinterpret_cast<float*>(row);
  for (std::size_t i = 0; i < count; ++i) depth[i] = base::max_second(base::min_second(depth[i], 1.0f), 0.0f);
}

/// Nearest texels as they are.
void move_band(const Scaler& scaler, const ImageView& view, std::uint32_t first, std::uint32_t count,
               std::uint32_t slice) {
  const std::size_t bytes = view.format->block_bytes;
  const auto columns = static_cast<std::int32_t>(scaler.blit.to.columns);
  for (std::uint32_t row = first; row < first + count; ++row) {
    std::byte* to = scaler.blit.to.row(slice, 0, row);
    if (row != first && repeats(scaler, row)) {
      std::memcpy(to, scaler.blit.to.row(slice, 0, row - 1), scaler.blit.to.row_bytes());
      continue;
    }
    const bool one = scaler.patches.empty() && scaler.row[0].same(scaler.row[1], row);
    const auto split = static_cast<std::size_t>(
        one ? 0 : std::clamp(first_upper_texel(scaler.blit, static_cast<std::int32_t>(row)), 0, columns));
    for (std::size_t t = 0; t < 2; ++t) {
      const auto y = static_cast<std::uint32_t>(scaler.row[t].first[row]);
      pick_texels(bytes, view.block(0, 0, 0, scaler.low, y, 0), scaler.column[t], t == 0 ? split : 0,
                  t == 0 ? static_cast<std::size_t>(columns) : split, to);
    }
    if (scaler.clamp_depth) clamp_depths(to, scaler.blit.to.columns);
  }
}

}  // namespace

std::int32_t first_upper_texel(const Blit& blit, std::int32_t row) {
  // (2 x + 1) * height >= (2 row + 1) * width
  const std::int64_t height = blit.y.to_size(), edge = (2 * std::int64_t{row} + 1) * blit.x.to_size();
  if (edge <= height) return 0;
  return static_cast<std::int32_t>((edge - height + 2 * height - 1) / (2 * height));
}

bool scale_rows(const Blit& blit, const Quad& quad, const Start& start, const Sampler& sampler,
                base::FunctionRef<ImageView(std::uint32_t)> view_of) {
  const ImageView view = view_of(0);
  if (view.type != VK_IMAGE_VIEW_TYPE_2D || start.x != blit.x.to0 || start.y != blit.y.to0) return false;
  Scaler scaler(blit, make_plan(view, sampler, SampleOp::kSample, LodMode::kZero));
  if (scaler.plan.zero || !find_taps(quad, start, scaler)) return false;
  choose_halver(scaler);
  scaler.clamp_depth = view.format->format == VK_FORMAT_D32_SFLOAT && blit.to.format->format == VK_FORMAT_D32_SFLOAT;
  scaler.raw = !scaler.plan.mag_linear && (scaler.clamp_depth || keeps_bytes(*view.format, *blit.to.format));
  for_each_band(blit.to, blit.to.row_bytes() * 4,
                [&](std::uint32_t first, std::uint32_t count, std::uint32_t slice, std::uint32_t) {
                  const base::ScopedFloatMode mode(base::Denormals::kFlush);
                  const ImageView source = view_of(slice);
                  if (scaler.raw) return move_band(scaler, source, first, count, slice);
                  scaler.plan.aos ? scale_band<std::uint32_t>(scaler, source, first, count, slice)
                                  : scale_band<Texel>(scaler, source, first, count, slice);
                });
  return true;
}

}  // namespace vitrine::texel
