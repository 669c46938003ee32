// Formats of four bytes.
#include "raster/output/byte_texels.h"

namespace vitrine::raster {
namespace {

bool four_bytes(const texel::FormatDesc& format, texel::Numeric numeric) {
  if (format.channel_count != 4 || format.block_bytes != 4) return false;
  for (std::size_t c = 0; c < 4; ++c) {
    const texel::Channel& channel = format.channel[c];
    if (channel.bits != 8 || channel.numeric != numeric || format.rgba[c] < 0) return false;
  }
  return true;
}

}  // namespace

bool is_four_bytes(const texel::FormatDesc& format) { return four_bytes(format, texel::Numeric::kUnorm); }
bool is_four_srgb_bytes(const texel::FormatDesc& format) { return four_bytes(format, texel::Numeric::kSrgb); }

void set_byte_places(ColorWriter& writer) {
  constexpr std::size_t kPlace[4] = {0, 4, 8, 12};  // of the first pixel's components in what BytePacker shuffles
  const std::size_t alpha = static_cast<std::size_t>(shift_of(writer, 3)) / 8;
  for (std::size_t p = 0; p < 4; ++p)
    for (std::size_t c = 0; c < 4; ++c) {
      writer.pack_places[4 * p + static_cast<std::size_t>(shift_of(writer, c)) / 8] =
          static_cast<std::uint8_t>(kPlace[c] + p);
      writer.alpha_places[4 * p + c] = static_cast<std::uint8_t>(4 * p + alpha);
    }
}

}  // namespace vitrine::raster
