// The shadow of what commands write: ranges of buffers, and texels of images.
#pragma once

#include "base/function_ref.h"
#include "glass/memory_shadow.h"
#include "texel/view.h"

namespace vitrine::glass {

/// All bytes of a range of a buffer become `state`.
void fill_shadow(const std::byte* first, std::uint64_t bytes, ByteState state);

/// The bytes of `target` become what those of `source` are; memory that is not known counts as written.
void copy_shadow(const std::byte* source, std::byte* target, std::uint64_t bytes);

/// Texels of one level of a view, all samples: `area` (cut to the level), slices [first_slice, first_slice + slices) of
/// each of `layers` layers from `first_layer`.
struct TexelBox {
  std::uint32_t level = 0;
  VkRect2D area{};
  std::uint32_t first_layer = 0, layers = UINT32_MAX;
  std::uint32_t first_slice = 0, slices = UINT32_MAX;
};
void fill_shadow(const texel::ImageView& view, const TexelBox& box, ByteState state);

/// Calls f(first byte, bytes) for the rows of blocks of a box, which may be larger than the view.
void for_each_row(const texel::ImageView& view, const TexelBox& box,
                  base::FunctionRef<void(const std::byte*, std::uint64_t)> f);

/// An area that every level lies in.
inline constexpr VkRect2D kWholeArea{{0, 0}, {INT32_MAX, INT32_MAX}};

}  // namespace vitrine::glass
