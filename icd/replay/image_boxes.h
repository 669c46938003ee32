// Parts of images as boxes of texels in the planes that have them.
#pragma once

#include "base/function_ref.h"
#include "glass/range_shadow.h"
#include "icd/object/image.h"

namespace vitrine::icd {

using BoxFunction = base::FunctionRef<void(const texel::ImageView&, const glass::TexelBox&)>;

/// The planes that the aspects of a range name, level by level. Nothing of an image without memory.
void for_each_box(const Image& image, const VkImageSubresourceRange& range, BoxFunction f);
/// The texels between two corners, in any order.
void for_each_box(const Image& image, const VkImageSubresourceLayers& layers, const VkOffset3D& a, const VkOffset3D& b,
                  BoxFunction f);

inline VkOffset3D end_of(const VkOffset3D& offset, const VkExtent3D& extent) {
  return {offset.x + static_cast<std::int32_t>(extent.width), offset.y + static_cast<std::int32_t>(extent.height),
          offset.z + static_cast<std::int32_t>(extent.depth)};
}

}  // namespace vitrine::icd
