// What this room can do with a format, derived from its description.
#include "texel/capabilities.h"

#include <algorithm>

namespace vitrine::texel {
namespace {

bool any_numeric(const FormatDesc& format, Numeric a, Numeric b) {
  const Numeric numeric = format.channel[0].numeric;
  return numeric == a || numeric == b;
}

bool is_scaled(const FormatDesc& format) { return any_numeric(format, Numeric::kUscaled, Numeric::kSscaled); }

/// One plane, one aspect, uncompressed, channels of at most 32 bits that we have conversions for.
bool is_plain(const FormatDesc& format) {
  if (format.is_compressed() || format.channel_count == 0 || format.block_bytes > 16) return false;
  if (format.has_depth() && format.has_stencil()) return false;
  const bool unsigned_float = format.channel[0].numeric == Numeric::kUfloat;
  const bool known_float =
      format.format == VK_FORMAT_B10G11R11_UFLOAT_PACK32 || format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
  return (!unsigned_float || known_float) &&
         std::all_of(format.channel.begin(), format.channel.begin() + format.channel_count,
                     [](const Channel& c) { return c.bits <= 32; });
}

}  // namespace

bool can_decode(const FormatDesc& format) { return is_plain(format); }

bool can_encode(const FormatDesc& format) { return is_plain(format) && !is_scaled(format); }

bool can_sample(const FormatDesc& format) {
  const bool bc1_to_bc5 = format.format >= VK_FORMAT_BC1_RGB_UNORM_BLOCK && format.format <= VK_FORMAT_BC5_SNORM_BLOCK;
  return bc1_to_bc5 || (is_plain(format) && !is_scaled(format));
}

bool can_filter(const FormatDesc& format) { return can_sample(format) && !format.is_integer(); }

bool can_store(const FormatDesc& format) {
  return can_encode(format) && !format.is_depth_stencil() && !format.is_srgb() &&
         format.format != VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
}

bool can_atomic(const FormatDesc& format) {
  return format.format == VK_FORMAT_R32_UINT || format.format == VK_FORMAT_R32_SINT ||
         format.format == VK_FORMAT_R32_SFLOAT;
}

bool can_copy(const FormatDesc& format) { return format.block_bytes != 0 && format.plane_count == 1; }

}  // namespace vitrine::texel
