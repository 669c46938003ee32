// What the suite must know of a format: its size, its channels and how to show it.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::cts {

enum class Numeric { kUnorm, kSnorm, kUint, kSint, kFloat, kSrgb, kPackedFloat, kDepth, kBlock };

struct FormatInfo {
  VkFormat format;
  const char* name;
  uint32_t bytes;   ///< per texel, or per block
  uint8_t bits[4];  ///< per channel in the order of memory, low bits first; 0 = absent
  Numeric numeric;
  uint32_t block = 1;         ///< texels along a row of a block
  uint32_t block_height = 1;  ///< and along a column
};

/// The row of a format; throws for formats that the suite does not use.
const FormatInfo& format_info(VkFormat format);
/// All colour formats of the table (not depth, not blocks).
const std::vector<FormatInfo>& color_formats();
const std::vector<FormatInfo>& all_formats();

inline bool is_integer(const FormatInfo& info) {
  return info.numeric == Numeric::kUint || info.numeric == Numeric::kSint;
}
VkImageAspectFlags aspects_of(VkFormat format);

/// One texel as text: its bytes, and its channels where the format has plain ones.
std::string describe_texel(const FormatInfo& info, const unsigned char* texel);
/// One texel as 8-bit RGBA for a picture (floats and integers are folded into range).
uint32_t preview_rgba(const FormatInfo& info, const unsigned char* texel);

}  // namespace vitrine::cts
