// What this room can do with a format, derived from its description.
#include "texel/capabilities.h"

namespace vitrine::texel {
namespace {

bool any_numeric(const FormatDesc& format, Numeric a, Numeric b) {
  const Numeric numeric = format.channel[0].numeric;
  return numeric == a || numeric == b;
}

bool is_scaled(const FormatDesc& format) { return any_numeric(format, Numeric::kUscaled, Numeric::kSscaled); }

}  // namespace

bool can_decode(const FormatDesc& format) { return format.plain; }

bool can_encode(const FormatDesc& format) { return format.plain && !is_scaled(format); }

bool can_sample(const FormatDesc& format) {
  if (format.requires_conversion()) return true;
  switch (format.compression) {
    case Compression::kNone:
      return format.plain && !is_scaled(format);
    case Compression::kBc:
    case Compression::kEtc2:
    case Compression::kEac:
    case Compression::kAstcLdr:
      return true;
    default:
      return false;
  }
}

bool can_store(const FormatDesc& format) {
  return can_encode(format) && !format.is_depth_stencil() && format.format != VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
}

}  // namespace vitrine::texel
