// Values of texels.
#include "glass/pixel/history.h"

#include <bit>
#include <cstdio>
#include <cstring>

#include "texel/capabilities.h"
#include "texel/codec.h"

namespace vitrine::glass::pixel {
namespace {

std::string hex(const Value& value) {
  std::string text = "0x";
  char digits[3];
  for (std::size_t i = value.size; i-- > 0;) {
    std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned>(value.bytes[i]));
    text += digits;
  }
  return text;
}

}  // namespace

Value Texel::read() const {
  Value value;
  if (address == nullptr || format == nullptr) return value;
  value.size = format->block_bytes;
  std::memcpy(value.bytes.data(), address, value.size);
  return value;
}

std::string component_text(std::uint32_t bits, texel::Kind kind) {
  if (kind == texel::Kind::kUint) return std::to_string(bits);
  if (kind == texel::Kind::kSint) return std::to_string(static_cast<std::int32_t>(bits));
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(std::bit_cast<float>(bits)));
  return text;
}

std::size_t components_of(const texel::FormatDesc& format) {
  if (format.is_depth_stencil()) return 1;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i)
    if (format.rgba[i] >= 0) count = i + 1;
  return count;
}

std::string to_text(const std::array<std::uint32_t, 4>& components, std::size_t count, texel::Kind kind) {
  std::string text = "(";
  for (std::size_t i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + component_text(components[i], kind);
  return text + ")";
}

std::string wide_text(std::uint64_t number, texel::Kind kind) {
  return "(" +
         (kind == texel::Kind::kSint ? std::to_string(static_cast<std::int64_t>(number)) : std::to_string(number)) +
         ")";
}

std::string to_text(const Value& value, const texel::FormatDesc& format) {
  if (value.size == 0) return "unknown";
  if (format.format == VK_FORMAT_R64_UINT || format.format == VK_FORMAT_R64_SINT) {
    std::uint64_t number = 0;
    std::memcpy(&number, value.bytes.data(), sizeof number);
    return wide_text(number, format.kind) + " = " + hex(value);
  }
  if (!texel::can_decode(format)) return hex(value);
  texel::Texel decoded;
  texel::texel_decoder(format)(format, value.bytes.data(), decoded);
  return to_text(decoded, components_of(format), format.kind) + " = " + hex(value);
}

}  // namespace vitrine::glass::pixel
