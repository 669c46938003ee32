// Scaled, flipped and converting copies (lavapipe-rasterization.md 11.3): the reference draws a textured quad, so
// texture coordinates come from the planes of its two triangles, samples from the sampler, and bits from colour output.
#include <algorithm>
#include <vector>

#include "base/float_mode.h"
#include "base/lanes.h"
#include "base/numeric.h"
#include "texel/capabilities.h"
#include "texel/sampler.h"
#include "texel/transfer/blit.h"

namespace vitrine::texel {
namespace {

Span make_span(std::int32_t from0, std::int32_t from1, std::int32_t to0, std::int32_t to1) {
  return to0 < to1 ? Span{to0, to1, from0, from1} : Span{to1, to0, from1, from0};
}

/// The reference draws rectangles as one primitive where the only attachment is a two-dimensional B8G8R8A8_UNORM image
/// (lavapipe-rasterization.md 9.1, 9.2).
bool drawn_as_rectangle(const ImageDesc& to) {
  return to.format == VK_FORMAT_B8G8R8A8_UNORM && to.type == VK_IMAGE_TYPE_2D && to.layers == 1;
}

/// A corner of the quad in window coordinates, with its texture coordinates.
struct Corner {
  float x = 0, y = 0, u = 0, v = 0;
};

/// lavapipe-rasterization.md 4.1, single-sampled.
PlaneEquation make_plane(const Corner c[3], float Corner::*value) {
  const float dx01 = c[0].x - c[1].x, dy01 = c[0].y - c[1].y;
  const float dx20 = c[2].x - c[0].x, dy20 = c[2].y - c[0].y;
  const float scale = 1.0f / (dx01 * dy20 - dy01 * dx20);
  const float d01 = c[0].*value - c[1].*value, d20 = c[2].*value - c[0].*value;
  PlaneEquation plane;
  plane.dadx = d01 * (dy20 * scale) - d20 * (dy01 * scale);
  plane.dady = d20 * (dx01 * scale) - d01 * (dx20 * scale);
  plane.a0 = c[0].*value - (plane.dadx * (c[0].x - 0.5f) + plane.dady * (c[0].y - 0.5f));
  return plane;
}

/// Texel coordinate through clip space and the viewport transform (section 1.2 form A, w = 1).
float window_coordinate(std::int32_t texel, std::uint32_t size) {
  const float extent = static_cast<float>(size);
  const float clip = static_cast<float>(texel) / extent * 2.0f - 1.0f;
  return base::fma_exact(clip, 0.5f * extent, 0.5f * extent);
}

Quad make_quad(const Blit& blit) {
  const float x[2] = {window_coordinate(blit.x.to0, blit.to_extent.width),
                      window_coordinate(blit.x.to1, blit.to_extent.width)};
  const float y[2] = {window_coordinate(blit.y.to0, blit.to_extent.height),
                      window_coordinate(blit.y.to1, blit.to_extent.height)};
  const float width = static_cast<float>(blit.from_extent.width);
  const float height = static_cast<float>(blit.from_extent.height);
  const float u[2] = {static_cast<float>(blit.x.from0) / width, static_cast<float>(blit.x.from1) / width};
  const float v[2] = {static_cast<float>(blit.y.from0) / height, static_cast<float>(blit.y.from1) / height};
  const Corner c[4] = {
      {x[0], y[0], u[0], v[0]}, {x[1], y[0], u[1], v[0]}, {x[1], y[1], u[1], v[1]}, {x[0], y[1], u[0], v[1]}};
  if (blit.rectangle) {
    const Corner whole[3] = {c[2], c[0], c[1]};
    const PlaneEquation u_plane = make_plane(whole, &Corner::u), v_plane = make_plane(whole, &Corner::v);
    return {{u_plane, u_plane}, {v_plane, v_plane}};
  }
  const Corner upper[3] = {c[1], c[0], c[2]};
  const Corner lower[3] = {c[2], c[0], c[3]};
  return {{make_plane(upper, &Corner::u), make_plane(lower, &Corner::u)},
          {make_plane(upper, &Corner::v), make_plane(lower, &Corner::v)}};
}

/// The source level as a view: 3D images whole, others the one layer that destination slice `slice` reads.
ImageView source_view(const Blit& blit, std::uint32_t slice) {
  const ImageLayout& layout = *blit.source->layout;
  ImageViewDesc desc;
  desc.type = layout.desc.type == VK_IMAGE_TYPE_1D   ? VK_IMAGE_VIEW_TYPE_1D
              : layout.desc.type == VK_IMAGE_TYPE_2D ? VK_IMAGE_VIEW_TYPE_2D
                                                     : VK_IMAGE_VIEW_TYPE_3D;
  desc.format = layout.desc.format;
  desc.aspect = blit.aspect;
  desc.base_level = blit.source_layers.mipLevel;
  const std::uint32_t layer = layout.desc.type == VK_IMAGE_TYPE_3D ? 0 : blit.source_layers.baseArrayLayer + slice;
  desc.base_layer = std::min(layer, layout.desc.layers - 1);
  return make_image_view(layout, blit.source->memory, desc);
}

/// Depth of the source, in texels, that slice `index` of the destination's span reads.
float source_depth(const Span& z, std::int32_t index) {
  const float step = static_cast<float>(z.from_size()) / static_cast<float>(z.to_size());
  auto center = static_cast<float>(0.5 / z.to_size() * z.from_size());
  const float sign = z.flipped() ? -1.0f : 1.0f;
  center *= sign;
  const float offset = static_cast<float>(index) * (step * sign) + center;
  return static_cast<float>(z.from0) + offset;
}

Sampler make_sampler(VkFilter filter) {
  Sampler sampler;
  sampler.mag_filter = sampler.min_filter = filter;
  sampler.address.fill(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  return sampler;
}

void encode_wave(const Blit& blit, const base::WaveRegister value[4], std::size_t count, std::byte* to) {
  std::array<Texel, base::kWaveWidth> texels;
  for (std::size_t i = 0; i < count; ++i) {
    texels[i] = {value[0].lane[i], value[1].lane[i], value[2].lane[i], value[3].lane[i]};
  }
  encode_row(*blit.to.format, Encoding::kAttachment, texels.data(), count, to);
}

/// Scaled: coordinates from the quad's planes, filtered by the sampler.
void sample_row(const Blit& blit, const ImageView& view, const Quad& quad, const Start& start, std::uint32_t row,
                std::uint32_t slice, std::byte* to) {
  const Sampler sampler = make_sampler(blit.filter);
  const std::int32_t py = start.y + static_cast<std::int32_t>(row);
  base::WaveRegister u{}, v{}, w{}, value[4];
  SampleRequest request;
  request.lod_mode = LodMode::kZero;
  request.coord = {&u, &v, &w, nullptr};
  const float depth = source_depth(blit.z, start.z + static_cast<std::int32_t>(slice) - blit.z.to0) /
                      static_cast<float>(blit.from_extent.depth);
  const std::int64_t edge_y = (2 * std::int64_t{py - blit.y.to0} + 1) * blit.x.to_size();
  for (std::uint32_t x = 0; x < blit.to.columns; x += base::kWaveWidth) {
    const std::size_t count = std::min<std::size_t>(base::kWaveWidth, blit.to.columns - x);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t px = start.x + static_cast<std::int32_t>(x + i);
      // The diagonal belongs to the upper right triangle, whose left edge it is.
      const bool upper = (2 * std::int64_t{px - blit.x.to0} + 1) * blit.y.to_size() >= edge_y;
      const auto fx = static_cast<float>(px), fy = static_cast<float>(py);
      u.lane[i] = base::bits_of(quad.u[upper ? 0 : 1].at(fx, fy));
      v.lane[i] = base::bits_of(quad.v[upper ? 0 : 1].at(fx, fy));
      w.lane[i] = base::bits_of(depth);
    }
    request.active = base::first_lanes(count);
    sample(view, sampler, request, value);
    encode_wave(blit, value, count, to + std::size_t{x} * blit.to.format->block_bytes);
  }
}

/// Unscaled: whole texels, converted.
void fetch_row(const Blit& blit, const ImageView& view, const Start& start, std::uint32_t row, std::uint32_t slice,
               std::byte* to) {
  base::WaveRegister x{}, y{}, z{}, value[4];
  FetchRequest request;
  request.coord = {&x, &y, &z};
  const std::int32_t from_y = blit.y.source(start.y + static_cast<std::int32_t>(row));
  const std::int32_t from_z = blit.z.source(start.z + static_cast<std::int32_t>(slice));
  for (std::uint32_t first = 0; first < blit.to.columns; first += base::kWaveWidth) {
    const std::size_t count = std::min<std::size_t>(base::kWaveWidth, blit.to.columns - first);
    for (std::size_t i = 0; i < count; ++i) {
      x.lane[i] = static_cast<std::uint32_t>(blit.x.source(start.x + static_cast<std::int32_t>(first + i)));
      y.lane[i] = static_cast<std::uint32_t>(from_y);
      z.lane[i] = static_cast<std::uint32_t>(from_z);
    }
    request.active = base::first_lanes(count);
    fetch(view, request, {&value[0], &value[1], &value[2], &value[3]});
    encode_wave(blit, value, count, to + std::size_t{first} * blit.to.format->block_bytes);
  }
}

/// Whether all texels of an unscaled region exist, so that whole rows can be decoded.
bool inside_source(const Blit& blit) {
  const auto within = [](const Span& span, std::uint32_t size) {
    const std::int32_t low = std::min(span.from0, span.from1), high = std::max(span.from0, span.from1);
    return low >= 0 && static_cast<std::uint32_t>(high) <= size;
  };
  return within(blit.x, blit.from_extent.width) && within(blit.y, blit.from_extent.height);
}

/// Unscaled rows of plain formats: decoded, turned round, encoded.
void convert_row(const Blit& blit, const ImageView& view, const Start& start, std::uint32_t row,
                 std::vector<Texel>& texels, std::byte* to) {
  const std::int32_t columns = static_cast<std::int32_t>(blit.to.columns);
  const std::int32_t left = blit.x.source(start.x), right = blit.x.source(start.x + columns - 1);
  const std::int32_t from_y = blit.y.source(start.y + static_cast<std::int32_t>(row));
  texels.resize(blit.to.columns);
  decode_row(
      *view.format,
      view.block(0, 0, 0, static_cast<std::uint32_t>(std::min(left, right)), static_cast<std::uint32_t>(from_y), 0),
      blit.to.columns, texels.data());
  if (blit.x.flipped()) std::reverse(texels.begin(), texels.end());
  encode_row(*blit.to.format, Encoding::kAttachment, texels.data(), blit.to.columns, to);
}

void run(const Blit& blit, const Start& start, bool by_texels) {
  const Quad quad = make_quad(blit);
  if (blit.scaled && !by_texels && blit.filter != VK_FILTER_CUBIC_EXT) {
    const auto view_of = [&](std::uint32_t slice) { return source_view(blit, slice); };
    if (scale_rows(blit, quad, start, make_sampler(blit.filter), view_of)) return;
  }
  const std::size_t cost = blit.to.row_bytes() * 16;  // filtering costs more than bytes
  for_each_band(blit.to, cost, [&](std::uint32_t first, std::uint32_t count, std::uint32_t slice, std::uint32_t) {
    const base::ScopedFloatMode mode(base::Denormals::kFlush);
    const ImageView view = source_view(blit, slice);
    const bool rows =
        !blit.scaled && view.type == VK_IMAGE_VIEW_TYPE_2D && can_decode(*view.format) && inside_source(blit);
    std::vector<Texel> texels;
    for (std::uint32_t row = first; row < first + count; ++row) {
      std::byte* to = blit.to.row(slice, 0, row);
      if (rows) {
        convert_row(blit, view, start, row, texels, to);
        continue;
      }
      blit.scaled ? sample_row(blit, view, quad, start, row, slice, to) : fetch_row(blit, view, start, row, slice, to);
    }
  });
}

/// Bytes may be copied when nothing is scaled, flipped, filtered or converted.
bool is_plain_copy(const Blit& blit, const ImageMemory& destination, VkFilter filter) {
  return !blit.scaled && filter == VK_FILTER_NEAREST && !blit.x.flipped() && !blit.y.flipped() && !blit.z.flipped() &&
         blit.source->layout->desc.format == destination.layout->desc.format;
}

void copy_plain(const ImageMemory& source, const ImageMemory& destination, const VkImageBlit& region,
                const Blit& blit) {
  VkImageCopy copy{};
  copy.srcSubresource = region.srcSubresource;
  copy.dstSubresource = region.dstSubresource;
  copy.srcSubresource.aspectMask = copy.dstSubresource.aspectMask = static_cast<VkImageAspectFlags>(blit.aspect);
  copy.srcOffset = {blit.x.from0, blit.y.from0, blit.z.from0};
  copy.dstOffset = {blit.x.to0, blit.y.to0, blit.z.to0};
  copy.extent = {static_cast<std::uint32_t>(blit.x.to_size()), static_cast<std::uint32_t>(blit.y.to_size()),
                 static_cast<std::uint32_t>(blit.z.to_size())};
  copy_image(source, destination, copy);
}

bool convertible(const FormatDesc& from, const FormatDesc& to) {
  return can_sample(from) && !from.requires_conversion() && can_encode(to) && from.kind == to.kind;
}

void blit_by(const ImageMemory& source, const ImageMemory& destination, const VkImageBlit& region, VkFilter filter,
             bool by_texels) {
  const VkOffset3D *from = region.srcOffsets, *to = region.dstOffsets;
  Blit blit;
  blit.source = &source;
  blit.source_layers = region.srcSubresource;
  blit.x = make_span(from[0].x, from[1].x, to[0].x, to[1].x);
  blit.y = make_span(from[0].y, from[1].y, to[0].y, to[1].y);
  blit.z = make_span(from[0].z, from[1].z, to[0].z, to[1].z);
  blit.rectangle = drawn_as_rectangle(destination.layout->desc);
  blit.scaled = blit.x.scaled() || blit.y.scaled() || blit.z.scaled();
  const VkOffset3D offset{blit.x.to0, blit.y.to0, blit.z.to0};
  if (blit.x.to_size() <= 0 || blit.y.to_size() <= 0 || blit.z.to_size() <= 0) return;
  if (region.srcSubresource.mipLevel >= source.layout->desc.levels ||
      region.dstSubresource.mipLevel >= destination.layout->desc.levels) {
    return;
  }
  const VkExtent3D extent{static_cast<std::uint32_t>(blit.x.to_size()), static_cast<std::uint32_t>(blit.y.to_size()),
                          static_cast<std::uint32_t>(blit.z.to_size())};
  for (const auto aspect : {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
    if ((region.srcSubresource.aspectMask & aspect) == 0) continue;
    blit.aspect = aspect;
    const PlaneLayout& plane = source.layout->plane[plane_of_aspect(*source.layout, aspect)];
    blit.from_extent = plane.level[region.srcSubresource.mipLevel].extent;
    blit.to = make_box(destination, aspect, region.dstSubresource, offset, extent);
    if (blit.to.empty() || !convertible(format_desc(plane.format), *blit.to.format)) continue;
    blit.to.samples = 1;
    blit.to_extent = destination.layout->plane[plane_of_aspect(*destination.layout, aspect)]
                         .level[region.dstSubresource.mipLevel]
                         .extent;
    // Depth with stencil, and whatever is not scaled, is never filtered.
    blit.filter = blit.scaled && source.layout->plane_count == 1 ? filter : VK_FILTER_NEAREST;
    if (is_plain_copy(blit, destination, filter)) {
      copy_plain(source, destination, region, blit);
    } else {
      const bool is_3d = destination.layout->desc.type == VK_IMAGE_TYPE_3D;
      run(blit, {offset.x, offset.y, is_3d ? offset.z : blit.z.to0}, by_texels);
    }
  }
}

}  // namespace

void blit_image(const ImageMemory& source, const ImageMemory& destination, const VkImageBlit& region, VkFilter filter) {
  blit_by(source, destination, region, filter, false);
}

void blit_image_by_texels(const ImageMemory& source, const ImageMemory& destination, const VkImageBlit& region,
                          VkFilter filter) {
  blit_by(source, destination, region, filter, true);
}

}  // namespace vitrine::texel
