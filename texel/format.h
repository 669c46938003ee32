// What a VkFormat means: one description per format, made from the registry's <formats> at build time. Consumers ask
// the description, never the enum.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>

namespace vitrine::texel {

enum class Numeric : std::uint8_t { kNone, kUnorm, kSnorm, kUscaled, kSscaled, kUint, kSint, kUfloat, kSfloat, kSrgb };

/// What decoded components of a format are: floats or 32-bit integers (as raw bits in a register).
enum class Kind : std::uint8_t { kFloat, kUint, kSint };

enum class Compression : std::uint8_t { kNone, kBc, kEtc2, kEac, kAstcLdr, kAstcHdr, kPvrtc };

struct Channel {
  char name = 0;                     ///< 'R' 'G' 'B' 'A' 'D' 'S'; 0: padding ('X')
  Numeric numeric = Numeric::kNone;  ///< per channel: depth and stencil of one format differ
  std::uint8_t bits = 0;
  std::uint8_t offset = 0;  ///< bit offset in the little-endian block
};

/// A single-plane view of texels of a Y'CbCr format, as the sampler reads them: a plane of a multi-planar format, or
/// the luma (first) or the chroma of a packed 4:2:2 format, whose views lie on the same bytes.
struct Plane {
  VkFormat format = VK_FORMAT_UNDEFINED;  ///< a plain one; of planes in memory the compatible format
  std::uint8_t width_divisor = 1;         ///< of the image's extent
  std::uint8_t height_divisor = 1;
};

/// Where a component of a Y'CbCr format is found.
struct PlaneComponent {
  std::int8_t plane = -1;    ///< index in FormatDesc::plane; -1: the format lacks the component
  std::uint8_t channel = 0;  ///< R, G, B or A of the plane's format
};

struct FormatDesc {
  VkFormat format = VK_FORMAT_UNDEFINED;
  const char* name = "";
  std::uint8_t block_bytes = 0;  ///< bytes of a texel block
  std::uint8_t block_width = 1;  ///< texels
  std::uint8_t block_height = 1;
  std::uint8_t block_depth = 1;
  Compression compression = Compression::kNone;
  std::uint8_t packed_bits = 0;  ///< 8, 16, 32: channels packed into words of this size; 0: one element each
  std::uint8_t channel_count = 0;
  std::array<Channel, 4> channel{};                 ///< in memory order, least significant first
  std::array<std::int8_t, 4> rgba{-1, -1, -1, -1};  ///< index in `channel` of R, G, B, A; -1: missing
  Kind kind = Kind::kFloat;                         ///< of the colour (or depth) aspect
  VkImageAspectFlags aspects = 0;                   ///< COLOR, or DEPTH and/or STENCIL (or PLANE_0.. for multi-planar)
  std::uint8_t plane_count = 1;                     ///< in memory
  std::uint8_t sampled_planes = 0;  ///< entries of `plane`; 0: the format is sampled without a conversion
  std::array<Plane, 3> plane{};
  std::array<PlaneComponent, 4> plane_component{};  ///< of R, G, B, A
  bool plain = false;                       ///< one plane, one aspect, uncompressed, channels that the codecs know
  std::array<std::uint8_t, 4> component{};  ///< per channel: which of R, G, B, A it is (inverse of `rgba`)

  constexpr bool is_depth_stencil() const {
    return (aspects & (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT)) != 0;
  }
  constexpr bool has_depth() const { return (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0; }
  constexpr bool has_stencil() const { return (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0; }
  constexpr bool is_compressed() const { return compression != Compression::kNone; }
  constexpr bool is_srgb() const { return channel_count != 0 && channel[0].numeric == Numeric::kSrgb; }
  /// "Formats requiring sampler Y'CbCr conversion": two-dimensional images of one level and one sample.
  constexpr bool requires_conversion() const { return sampled_planes != 0; }
  constexpr bool is_integer() const { return kind != Kind::kFloat; }
};

/// The description; for unknown values the one of VK_FORMAT_UNDEFINED (block_bytes 0). Never fails.
const FormatDesc& format_desc(VkFormat format);

/// The description that views of texels have. Those of R64_UINT and R64_SINT are plain: two channels, the low and the
/// high word of the number, so that loads, stores and lookups move words. For other formats that of format_desc().
const FormatDesc& view_format_desc(VkFormat format);

}  // namespace vitrine::texel
