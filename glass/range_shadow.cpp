// Filling and copying states of ranges and texels.
#include "glass/range_shadow.h"

#include <algorithm>
#include <cstring>

namespace vitrine::glass {
namespace {

/// [offset, offset + extent) cut to [0, size), in blocks: first and end.
struct Blocks {
  std::uint64_t first = 0, end = 0;
};

Blocks cut(std::int32_t offset, std::uint32_t extent, std::uint32_t size, std::uint32_t block) {
  const auto at = [&](std::int64_t texel) {
    return static_cast<std::uint64_t>(std::clamp<std::int64_t>(texel, 0, size));
  };
  return {at(offset) / block, (at(std::int64_t{offset} + extent) + block - 1) / block};
}

std::uintptr_t number_of(const std::byte* address) { return reinterpret_cast<std::uintptr_t>(address); }

}  // namespace

void fill_shadow(const std::byte* first, std::uint64_t bytes, ByteState state) {
  if (const ShadowRegion* region = find_shadow(first)) region->fill(number_of(first), bytes, state);
}

void copy_shadow(const std::byte* source, std::byte* target, std::uint64_t bytes) {
  const ShadowRegion* to = find_shadow(target);
  if (to == nullptr || !to->contains(number_of(target), bytes)) return;
  const ShadowRegion* from = find_shadow(source);
  if (from == nullptr || !from->contains(number_of(source), bytes) || from->is_mapped(number_of(source), bytes))
    return to->fill(number_of(target), bytes, ByteState::kWritten);
  from->settle(number_of(source), bytes, Contents::kBytes);
  std::memmove(to->states(number_of(target)), from->states(number_of(source)), bytes);
}

void for_each_row(const texel::ImageView& view, const TexelBox& box,
                  base::FunctionRef<void(const std::byte*, std::uint64_t)> f) {
  if (view.format == nullptr || box.level >= view.level_count) return;
  const texel::Extent& extent = view.level[box.level].extent;
  const Blocks x = cut(box.area.offset.x, box.area.extent.width, extent.width, view.format->block_width);
  const Blocks y = cut(box.area.offset.y, box.area.extent.height, extent.height, view.format->block_height);
  if (x.first >= x.end) return;
  const auto end_of = [](std::uint32_t first, std::uint32_t count, std::uint32_t size) {
    return first < size ? first + std::min(count, size - first) : first;
  };
  const std::uint32_t layers_end = end_of(box.first_layer, box.layers, view.layer_count);
  const std::uint32_t slices_end = end_of(box.first_slice, box.slices, extent.depth);
  for (std::uint32_t layer = box.first_layer; layer < layers_end; ++layer)
    for (std::uint32_t sample = 0; sample < view.samples; ++sample)
      for (std::uint32_t slice = box.first_slice; slice < slices_end; ++slice)
        for (std::uint64_t row = y.first; row < y.end; ++row)
          f(view.block(box.level, layer, sample, static_cast<std::uint32_t>(x.first), static_cast<std::uint32_t>(row),
                       slice),
            (x.end - x.first) * view.format->block_bytes);
}

void fill_shadow(const texel::ImageView& view, const TexelBox& box, ByteState state) {
  if (view.format == nullptr) return;
  const ShadowRegion* region = find_shadow(view.base);
  if (region == nullptr) return;
  for_each_row(view, box,
               [&](const std::byte* first, std::uint64_t bytes) { region->fill(number_of(first), bytes, state); });
}

}  // namespace vitrine::glass
