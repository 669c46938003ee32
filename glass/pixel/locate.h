// Texels and addresses (texel/view.h: LevelLayout).
#pragma once

#include <optional>

#include "glass/pixel/history.h"

namespace vitrine::glass::pixel {

/// Where an image lies; what the pointers point to lives as long as the image.
struct ImagePlace {
  const texel::ImageLayout* layout = nullptr;
  std::byte* const* memory = nullptr;                       ///< null until memory is bound
  const std::array<std::byte*, 3>* plane_memory = nullptr;  ///< of a disjoint image; null: it is none
};

/// The address of a texel (or of its block) of an image that has memory.
const std::byte* address_of(const ImagePlace& image, const TexelId& id);

/// The texel (the first of its block) at an address, without the image's number; nothing: none is there.
std::optional<TexelId> id_at(const ImagePlace& image, const std::byte* address);

}  // namespace vitrine::glass::pixel
