// Which fields and which grid an access has.
#include "texel/load_store/prepared_access.h"

#include "texel/capabilities.h"
#include "texel/load_store/shape.h"
#include "texel/load_store/wave_access.h"

namespace vitrine::texel {
namespace {

constexpr std::array<std::uint8_t, 4> kIdentity{0, 1, 2, 3};
constexpr std::uint64_t kSpanLimit = (std::uint64_t{1} << 31) - 64;

/// Plain single texels whose places fit 31 bits.
bool offsets_fit(const ImageView& view) {
  const LevelLayout& last = view.level[view.level_count - 1];
  const std::uint64_t span =
      (view.layer_count - 1) * view.layer_stride + last.offset + view.samples * view.level[0].sample_stride;
  return view.format->plain && span < kSpanLimit;
}

bool offsets_fit(const BufferTexelView& view) {
  return view.format->plain && view.count * view.format->block_bytes < kSpanLimit;
}

void add_axis(const base::WaveRegister* coord, std::uint64_t size, std::uint64_t stride, TexelGrid& grid) {
  grid.axis[grid.axis_count++] = {coord, static_cast<std::int32_t>(size), static_cast<std::int32_t>(stride)};
}

/// Whether the coordinates of all dimensions are registers as they are, and there is but one level.
bool is_in_grid(const ImageView& view, const FetchRequest& request) {
  const Shape shape = shape_of(view.type);
  if (!offsets_fit(view) || view.min_level != 0 || request.lod != nullptr) return false;
  for (std::uint32_t i = 0; i < shape.dims + (shape.layered ? 1 : 0); ++i) {
    if (request.coord[i] == nullptr || request.offset[i] != nullptr) return false;
  }
  return true;
}

TexelGrid grid_of(const ImageView& view, const FetchRequest& request) {
  const Shape shape = shape_of(view.type);
  const LevelLayout& level = view.level[0];
  TexelGrid grid;
  grid.base = view.base + level.offset;
  add_axis(request.coord[0], level.extent.width, view.format->block_bytes, grid);
  if (shape.dims > 1) add_axis(request.coord[1], level.extent.height, level.row_pitch, grid);
  if (shape.dims > 2) add_axis(request.coord[2], level.extent.depth, level.slice_pitch, grid);
  if (shape.layered) add_axis(request.coord[shape.dims], view.layer_count, view.layer_stride, grid);
  if (request.sample != nullptr) add_axis(request.sample, view.samples, level.sample_stride, grid);
  return grid;
}

TexelGrid grid_of(const BufferTexelView& view, const base::WaveRegister& index) {
  TexelGrid grid;
  grid.base = view.data;
  add_axis(&index, view.count, view.format->block_bytes, grid);
  return grid;
}

template <class Register>
TexelField<Register> field_of(const Channel& channel, Register* values) {
  TexelField<Register> field{values, channel, static_cast<std::uint8_t>(channel.offset / 32)};
  field.channel.offset %= 32;
  return field;
}

void add_result(const FormatDesc& format, std::uint8_t source, base::WaveRegister* to, PreparedFetch& prepared) {
  const std::int8_t index = source < 4 ? format.rgba[source] : std::int8_t{-1};
  if (index >= 0) {
    prepared.field[prepared.field_count++] = field_of(format.channel[static_cast<std::size_t>(index)], to);
    return;
  }
  const std::uint32_t one = format.is_integer() ? 1u : 0x3f800000u;
  prepared.constant[prepared.constant_count] = source == 3 || source == 5 ? one : 0;
  prepared.constant_to[prepared.constant_count++] = to;
}

PreparedFetch prepare_fields(const FormatDesc& format, const std::array<std::uint8_t, 4>& swizzle,
                             const SampleResult& result) {
  PreparedFetch prepared;
  prepared.convert = field_conversion(format);
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] != nullptr) add_result(format, swizzle[c], result[c], prepared);
  }
  return prepared;
}

PreparedStore prepare_fields(const FormatDesc& format, const StoredValue& value) {
  PreparedStore prepared;
  if (!can_store(format)) return prepared;
  prepared.encode = field_encoder(format);
  prepared.word_count = (format.block_bytes + 3u) / 4;
  for (std::size_t i = 0; i < format.channel_count; ++i) {
    const base::WaveRegister* const values = value[format.component[i]];
    if (values != nullptr) prepared.field[prepared.field_count++] = field_of(format.channel[i], values);
  }
  return prepared;
}

PreparedFetch on_grid(PreparedFetch prepared, const FormatDesc& format, const TexelGrid& grid) {
  if (prepared.convert != nullptr) prepared.load = texel_load(format);
  prepared.grid = grid;
  return prepared;
}

PreparedStore on_grid(PreparedStore prepared, const FormatDesc& format, const TexelGrid& grid) {
  if (prepared.is_ready()) prepared.store = texel_store(format);
  prepared.grid = grid;
  return prepared;
}

}  // namespace

PreparedFetch prepare_conversion(const ImageView& view, const SampleResult& result) {
  return offsets_fit(view) ? prepare_fields(*view.format, view.swizzle, result) : PreparedFetch{};
}

PreparedFetch prepare_fetch(const ImageView& view, const FetchRequest& request, const SampleResult& result) {
  if (!is_in_grid(view, request)) return {};
  return on_grid(prepare_fields(*view.format, view.swizzle, result), *view.format, grid_of(view, request));
}

PreparedFetch prepare_fetch(const BufferTexelView& view, const base::WaveRegister& index, const SampleResult& result) {
  if (!offsets_fit(view)) return {};
  return on_grid(prepare_fields(*view.format, kIdentity, result), *view.format, grid_of(view, index));
}

PreparedStore prepare_store(const ImageView& view, const FetchRequest& request, const StoredValue& value) {
  if (!is_in_grid(view, request)) return {};
  return on_grid(prepare_fields(*view.format, value), *view.format, grid_of(view, request));
}

PreparedStore prepare_store(const BufferTexelView& view, const base::WaveRegister& index, const StoredValue& value) {
  if (!offsets_fit(view)) return {};
  return on_grid(prepare_fields(*view.format, value), *view.format, grid_of(view, index));
}

}  // namespace vitrine::texel
