// Resolves multisampled texels (lavapipe-rasterization.md 8.8): colours that are floats are averaged in sample order,
// integers take sample 0, depth and stencil do what their resolve mode says (Vulkan 1.3.239, VkResolveModeFlagBits).
#include <algorithm>
#include <cstring>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "texel/capabilities.h"
#include "texel/transfer/box.h"

namespace vitrine::texel {
namespace {

constexpr std::size_t kChunk = 256;  ///< texels decoded at a time

void average_chunk(const FormatDesc& from, const FormatDesc& to, const std::byte* source, std::uint64_t sample_stride,
                   std::uint32_t samples, std::size_t count, std::byte* destination) {
  std::array<Texel, kChunk> decoded;
  std::array<std::array<float, 4>, kChunk> sum{};
  for (std::uint32_t s = 0; s < samples; ++s) {
    decode_row(from, source + s * sample_stride, count, decoded.data());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 4; ++c) sum[i][c] += base::float_of(decoded[i][c]);
    }
  }
  const float scale = 1.0f / static_cast<float>(samples);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 4; ++c) decoded[i][c] = base::bits_of(sum[i][c] * scale);
  }
  encode_row(to, Encoding::kAttachment, decoded.data(), count, destination);
}

/// Whether texels are 8-bit UNORM channels without gaps, which may be averaged byte by byte.
bool is_unorm_bytes(const FormatDesc& format) {
  return format.plain && format.channel_count == format.block_bytes &&
         std::all_of(format.channel.begin(), format.channel.begin() + format.channel_count,
                     [](const Channel& c) { return c.bits == 8 && c.numeric == Numeric::kUnorm; });
}

/// The same arithmetic as average_chunk on bytes, in loops that compilers vectorise.
void average_bytes(const std::byte* source, std::uint64_t sample_stride, std::uint32_t samples, std::size_t count,
                   std::byte* destination) {
  constexpr std::size_t kBytes = 1024;
  alignas(64) float sum[kBytes];
  const float scale = 1.0f / static_cast<float>(samples);
  for (std::size_t first = 0; first < count; first += kBytes) {
    const std::size_t length = std::min(kBytes, count - first);
    std::fill_n(sum, length, 0.0f);
    for (std::uint32_t s = 0; s < samples; ++s) {
      const std::byte* bytes = source + s * sample_stride + first;
      for (std::size_t i = 0; i < length; ++i)
        sum[i] += static_cast<float>(std::to_integer<std::int32_t>(bytes[i])) * (1.0f / 255.0f);
    }
    for (std::size_t i = 0; i < length; ++i) {
      const float x = base::min_second(sum[i] * scale, 1.0f);
      destination[first + i] = static_cast<std::byte>(base::bits_of(x * (255.0f / 256.0f) + 32768.0f));
    }
  }
}

// Planes of depth and stencil: how a texel is read, written and averaged.

template <class Word, Word kMask>
struct UnormPlane {
  static constexpr std::size_t kBytes = sizeof(Word);
  using Value = std::uint32_t;
  static Value load(const std::byte* texel) {
    Word word;
    std::memcpy(&word, texel, sizeof(Word));
    return word & kMask;
  }
  static void store(Value value, std::byte* texel) {
    const auto word = static_cast<Word>(value);
    std::memcpy(texel, &word, sizeof(Word));
  }
  static Value average(Value sum, std::uint32_t samples) { return (sum + samples / 2) / samples; }
};

struct FloatPlane {
  static constexpr std::size_t kBytes = 4;
  using Value = float;
  static Value load(const std::byte* texel) {
    Value value;
    std::memcpy(&value, texel, 4);
    return value;
  }
  static void store(Value value, std::byte* texel) { std::memcpy(texel, &value, 4); }
  static Value average(Value sum, std::uint32_t samples) { return sum * (1.0f / static_cast<float>(samples)); }
};

/// One row of a plane of which `source` is sample 0.
template <class Plane>
void reduce_row(VkResolveModeFlagBits mode, const std::byte* source, std::uint64_t sample_stride, std::uint32_t samples,
                std::size_t count, std::byte* destination) {
  using Value = typename Plane::Value;
  const auto fold = [&](auto combine, auto finish) {
    for (std::size_t x = 0; x < count; ++x, source += Plane::kBytes, destination += Plane::kBytes) {
      Value value = Plane::load(source);
      for (std::uint32_t s = 1; s < samples; ++s) value = combine(value, Plane::load(source + s * sample_stride));
      Plane::store(finish(value), destination);
    }
  };
  const auto same = [](Value v) { return v; };
  if (mode == VK_RESOLVE_MODE_MIN_BIT)
    fold([](Value a, Value b) { return b < a ? b : a; }, same);
  else if (mode == VK_RESOLVE_MODE_MAX_BIT)
    fold([](Value a, Value b) { return a < b ? b : a; }, same);
  else
    fold([](Value a, Value b) { return a + b; }, [&](Value sum) { return Plane::average(sum, samples); });
}

using RowReduction = void (*)(VkResolveModeFlagBits, const std::byte*, std::uint64_t, std::uint32_t, std::size_t,
                              std::byte*);
RowReduction row_reduction(const FormatDesc& plane) {
  if (plane.channel[0].numeric == Numeric::kSfloat) return reduce_row<FloatPlane>;
  if (plane.channel[0].bits == 24) return reduce_row<UnormPlane<std::uint32_t, 0xffffff>>;
  return plane.block_bytes == 2 ? reduce_row<UnormPlane<std::uint16_t, 0xffff>>
                                : reduce_row<UnormPlane<std::uint8_t, 0xff>>;
}

Box common_box(const Box& source, Box destination) {
  destination.columns = std::min(destination.columns, source.columns);
  destination.rows = std::min(destination.rows, source.rows);
  destination.slices = std::min(destination.slices, source.slices);
  destination.samples = 1;
  return destination;
}

void reduce_box(VkResolveModeFlagBits mode, const Box& source, const Box& all) {
  const Box destination = common_box(source, all);
  if (destination.empty() || source.format->block_bytes != destination.format->block_bytes) return;
  const RowReduction reduce = row_reduction(*source.format);
  const std::size_t cost = destination.row_bytes() * source.samples * 2;
  for_each_band(destination, cost, [&](std::uint32_t first, std::uint32_t count, std::uint32_t slice, std::uint32_t) {
    const base::ScopedFloatMode mode_of_floats(base::Denormals::kFlush);
    for (std::uint32_t y = first; y < first + count; ++y)
      reduce(mode, source.row(slice, 0, y), source.sample_stride, source.samples, destination.columns,
             destination.row(slice, 0, y));
  });
}

void resolve_box(const Box& source, const Box& all) {
  const Box destination = common_box(source, all);
  if (destination.empty()) return;
  const FormatDesc& from = *source.format;
  const FormatDesc& to = *destination.format;
  const bool average = !from.is_integer() && !from.is_depth_stencil() && source.samples > 1;
  if ((average && (!can_decode(from) || !can_encode(to))) || (!average && from.block_bytes != to.block_bytes)) return;
  const bool bytes = average && from.format == to.format && is_unorm_bytes(from);
  const std::size_t cost = destination.row_bytes() * source.samples * 8;  // conversions cost more than bytes
  for_each_band(destination, cost, [&](std::uint32_t first, std::uint32_t count, std::uint32_t slice, std::uint32_t) {
    const base::ScopedFloatMode mode(base::Denormals::kFlush);  // the reference resolves in a fragment shader
    for (std::uint32_t y = first; y < first + count; ++y) {
      std::byte* row = destination.row(slice, 0, y);
      const std::byte* samples = source.row(slice, 0, y);
      if (!average) {
        std::memcpy(row, samples, destination.row_bytes());
        continue;
      }
      if (bytes) {
        average_bytes(samples, source.sample_stride, source.samples, destination.row_bytes(), row);
        continue;
      }
      for (std::size_t x = 0; x < destination.columns; x += kChunk) {
        average_chunk(from, to, samples + x * from.block_bytes, source.sample_stride, source.samples,
                      std::min(kChunk, destination.columns - x), row + x * to.block_bytes);
      }
    }
  });
}

/// Level 0 of a view, `area` cut to it, one slice per layer.
Box view_box(const ImageView& view, const VkRect2D& area, std::uint32_t base_layer, std::uint32_t layer_count) {
  Box box;
  const LevelLayout& level = view.level[0];
  if (base_layer >= view.layer_count || area.offset.x < 0 || area.offset.y < 0) return box;
  const auto x = static_cast<std::uint32_t>(area.offset.x);
  const auto y = static_cast<std::uint32_t>(area.offset.y);
  if (x >= level.extent.width || y >= level.extent.height) return box;
  box.format = view.format;
  box.columns = std::min(area.extent.width, level.extent.width - x);
  box.rows = std::min(area.extent.height, level.extent.height - y);
  box.slices = std::min(layer_count, view.layer_count - base_layer);
  box.samples = view.samples;
  box.row_pitch = level.row_pitch;
  box.slice_pitch = view.layer_stride;
  box.sample_stride = level.sample_stride;
  box.origin = view.block(0, base_layer, 0, x, y, 0);
  return box;
}

}  // namespace

void resolve_image(const ImageMemory& source, const ImageMemory& destination, const VkImageResolve& region) {
  const Box from = make_box(source, VK_IMAGE_ASPECT_COLOR_BIT, region.srcSubresource, region.srcOffset, region.extent);
  const Box to =
      make_box(destination, VK_IMAGE_ASPECT_COLOR_BIT, region.dstSubresource, region.dstOffset, region.extent);
  if (!from.empty() && !to.empty()) resolve_box(from, to);
}

void resolve_view(const ImageView& source, const ImageView& destination, VkResolveModeFlagBits mode,
                  const VkRect2D& area, std::uint32_t base_layer, std::uint32_t layer_count) {
  const Box from = view_box(source, area, base_layer, layer_count);
  const Box to = view_box(destination, area, base_layer, layer_count);
  if (from.empty() || to.empty()) return;
  if (from.format->is_depth_stencil() && mode != VK_RESOLVE_MODE_SAMPLE_ZERO_BIT)
    reduce_box(mode, from, to);
  else
    resolve_box(from, to);
}

}  // namespace vitrine::texel
