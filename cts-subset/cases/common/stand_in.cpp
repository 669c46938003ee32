// Formats without a peer in the reference, decoded by the texel room: its unit tests compare single texels with
// independent decoders, here the rest of a sampler's way is compared with the reference's.
#include "cases/common/stand_in.h"

#include <cmath>
#include <cstring>

#include "cases/api/random_transfer.h"
#include "texel/block/block.h"

namespace vitrine::cts {
namespace {

using texel::FormatDesc;

/// What the reference is given: bytes where it filters in bytes.
VkFormat peer_of(const FormatDesc& format) {
  const bool bytes = format.compression == texel::Compression::kEtc2 || format.compression == texel::Compression::kNone;
  return bytes && !format.is_srgb() && !format.is_depth_stencil() ? VK_FORMAT_R8G8B8A8_UNORM
                                                                  : VK_FORMAT_R32G32B32A32_SFLOAT;
}

bool can_stand_in(const FormatDesc& format) {
  return !format.is_integer() && (format.plain || format.is_compressed() || format.is_depth_stencil());
}

void put(VkFormat peer, const texel::Texel& texel, unsigned char* to) {
  if (peer == VK_FORMAT_R32G32B32A32_SFLOAT) {
    std::memcpy(to, texel.data(), sizeof(texel));
    return;
  }
  for (size_t c = 0; c < 4; ++c) {
    float value;
    std::memcpy(&value, &texel[c], sizeof(value));
    to[c] = static_cast<unsigned char>(std::lround(value * 255.0f));
  }
}

/// Texels of a level, slice by slice, in the peer's format.
std::vector<unsigned char> decoded(const FormatDesc& format, VkFormat peer, VkExtent3D extent, size_t slices,
                                   const std::vector<unsigned char>& texels) {
  const size_t bytes = format_info(peer).bytes;
  std::vector<unsigned char> result(bytes * extent.width * extent.height * slices);
  const uint32_t columns = (extent.width + format.block_width - 1) / format.block_width;
  const uint32_t rows = (extent.height + format.block_height - 1) / format.block_height;
  unsigned char* to = result.data();
  for (size_t slice = 0; slice < slices; ++slice)
    for (uint32_t y = 0; y < extent.height; ++y)
      for (uint32_t x = 0; x < extent.width; ++x, to += bytes) {
        const size_t block = (slice * rows + y / format.block_height) * columns + x / format.block_width;
        const auto* from = reinterpret_cast<const std::byte*>(texels.data() + block * format.block_bytes);
        texel::Texel texel{};
        if (format.is_compressed())
          texel::decode_block_texel(format, from, x % format.block_width, y % format.block_height, texel);
        else
          texel::decode_row(format, from, 1, &texel);
        put(peer, texel, to);
      }
  return result;
}

/// Most random blocks of ASTC are reserved ones, whose texels are all the error colour: one of them in eight stays.
void keep_few_errors(Random& random, const FormatDesc& format, std::vector<unsigned char>& texels) {
  if (format.compression != texel::Compression::kAstcLdr) return;
  const texel::Texel error{0x3f800000u, 0, 0x3f800000u, 0x3f800000u};
  for (size_t at = 0; at < texels.size(); at += format.block_bytes) {
    if (random.chance(0.125f)) continue;
    for (int attempt = 0; attempt < 200; ++attempt) {
      texel::Texel texel{};
      texel::decode_block_texel(format, reinterpret_cast<const std::byte*>(texels.data() + at), 0, 0, texel);
      if (texel != error) break;
      const uint64_t halves[2] = {random.bits64(), random.bits64()};
      std::memcpy(texels.data() + at, halves, sizeof(halves));
    }
  }
}

/// Components that a format lacks, constant in the view of its stand-in, so that borders lack them, too.
VkComponentSwizzle component(const FormatDesc& format, VkComponentSwizzle asked, uint32_t identity) {
  if (asked == VK_COMPONENT_SWIZZLE_ZERO || asked == VK_COMPONENT_SWIZZLE_ONE) return asked;
  const uint32_t c = asked == VK_COMPONENT_SWIZZLE_IDENTITY ? identity : uint32_t{asked} - VK_COMPONENT_SWIZZLE_R;
  if (format.rgba[c] < 0) return c == 3 ? VK_COMPONENT_SWIZZLE_ONE : VK_COMPONENT_SWIZZLE_ZERO;
  return static_cast<VkComponentSwizzle>(VK_COMPONENT_SWIZZLE_R + c);
}

VkImageAspectFlags stored_aspect(VkFormat format) {
  const VkImageAspectFlags aspects = aspects_of(format);
  return aspects & VK_IMAGE_ASPECT_DEPTH_BIT ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT} : aspects;
}

bool stands_in(const Run& run) { return &run.gpu == &gpus().reference; }

/// The image itself, or on the reference its stand-in.
Image make_image(Run& run, ImageSpec spec) {
  if (stands_in(run)) {
    const FormatDesc& desc = texel::format_desc(aspect_format(spec.format, stored_aspect(spec.format)));
    spec.format = peer_of(desc);
    spec.components = {component(desc, spec.components.r, 0), component(desc, spec.components.g, 1),
                       component(desc, spec.components.b, 2), component(desc, spec.components.a, 3)};
  }
  return run.image(spec);
}

void upload(Run& run, const Image& image, VkFormat format, uint32_t level, const std::vector<unsigned char>& texels) {
  const VkExtent3D extent = image.level_extent(level);
  const VkImageAspectFlags aspect = stored_aspect(format);
  if (!stands_in(run)) return run.upload(image, level, texels, aspect);
  run.upload(image, level,
             decoded(texel::format_desc(aspect_format(format, aspect)), image.spec.format, extent,
                     size_t{extent.depth} * image.spec.layers, texels));
}

}  // namespace

bool has_or_stands_in(VkFormat format, VkFormatFeatureFlags features) {
  return reference_has(format, features) || can_stand_in(texel::format_desc(format));
}

VkFormat reference_format(VkFormat format, VkFormatFeatureFlags features) {
  return reference_has(format, features) ? format : peer_of(texel::format_desc(format));
}

Image random_or_stand_in(Run& run, const ImageSpec& spec, VkFormatFeatureFlags features) {
  if (reference_has(spec.format, features)) {
    const Image image = run.image(spec);
    run.fill_random(image);
    return image;
  }
  const VkFormat stored = aspect_format(spec.format, stored_aspect(spec.format));
  const Image image = make_image(run, spec);
  Image described = image;
  described.spec.format = spec.format;
  for (uint32_t level = 0; level < spec.levels; ++level) {
    std::vector<unsigned char> texels =
        random_texels(run.random, stored, level_bytes(described, level, stored_aspect(spec.format)));
    keep_few_errors(run.random, texel::format_desc(stored), texels);
    upload(run, image, spec.format, level, texels);
  }
  return image;
}

Image image_or_stand_in(Run& run, const ImageSpec& spec, VkFormatFeatureFlags features,
                        const std::vector<unsigned char>& texels) {
  if (reference_has(spec.format, features)) {
    const Image image = run.image(spec);
    run.upload(image, 0, texels);
    return image;
  }
  const Image image = make_image(run, spec);
  upload(run, image, spec.format, 0, texels);
  return image;
}

}  // namespace vitrine::cts
