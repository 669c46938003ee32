// See color_locations.h.
#include "icd/object/color_locations.h"

#include <algorithm>

#include "icd/edge/util.h"

namespace vitrine::icd {

ColorLocations color_locations(const void* chain) {
  ColorLocations out;
#ifdef VK_KHR_dynamic_rendering_local_read
  const auto* info = find_in_chain<VkRenderingAttachmentLocationInfoKHR>(chain);
  // "If pColorAttachmentLocations is NULL, it is equivalent to setting each element to its index".
  if (!info || !info->pColorAttachmentLocations) return out;
  const std::uint32_t* const given = info->pColorAttachmentLocations;
  const std::uint32_t count = std::min(info->colorAttachmentCount, raster::kMaxColorAttachments);
  if (std::equal(out.of.begin(), out.of.begin() + count, given)) return out;
  out.of.fill(ColorLocations::kNone);
  for (std::uint32_t i = 0; i < count; ++i)
    if (given[i] < raster::kMaxColorAttachments) out.of[i] = static_cast<std::uint8_t>(given[i]);
#else
  static_cast<void>(chain);
#endif
  return out;
}

std::uint32_t located(const ColorLocations& locations, std::uint32_t attachments) {
  std::uint32_t out = 0;
  for (std::uint32_t i = 0; i < raster::kMaxColorAttachments; ++i)
    if ((attachments >> i & 1) != 0 && locations.of[i] != ColorLocations::kNone) out |= 1u << locations.of[i];
  return out;
}

void locate_blending(const ColorLocations& locations, raster::State& state) {
  const auto by_attachment = state.blend;
  for (std::uint32_t i = 0; i < raster::kMaxColorAttachments; ++i)
    if (locations.of[i] != ColorLocations::kNone) state.blend[locations.of[i]] = by_attachment[i];
}

}  // namespace vitrine::icd
