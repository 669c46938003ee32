// Which output of the fragment shader goes to which colour attachment of dynamic rendering (Vulkan 1.4.309, Fragment
// Output Interface: vkCmdSetRenderingAttachmentLocations). A pass of the rasterizer has its attachments by location.
#pragma once

#include <array>
#include <cstdint>

#include "icd/edge/vulkan_api.h"
#include "raster/draw.h"

namespace vitrine::icd {

struct ColorLocations {
  static constexpr std::uint8_t kNone = 0xff;

  /// Of each colour attachment; kNone: no output goes to it.
  std::array<std::uint8_t, raster::kMaxColorAttachments> of{0, 1, 2, 3, 4, 5, 6, 7};

  bool operator==(const ColorLocations&) const = default;

  /// kNone beyond what there can be, too.
  std::uint32_t location(std::uint32_t attachment) const { return attachment < of.size() ? of[attachment] : kNone; }
};

/// What the chain of a create info says; each attachment has its number where it says nothing.
ColorLocations color_locations(const void* chain);

/// Bits of attachments as bits of locations.
std::uint32_t located(const ColorLocations& locations, std::uint32_t attachments);

/// State that is kept by attachment, by location.
void locate_blending(const ColorLocations& locations, raster::State& state);

}  // namespace vitrine::icd
