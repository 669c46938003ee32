// Names of formats in shaders.
#include "cases/common/storage_format.h"

#include <string_view>

#include "cases/api/random_transfer.h"

namespace vitrine::cts {

std::string image_layout(VkFormat format) {
  if (format == VK_FORMAT_A2B10G10R10_UNORM_PACK32) return "rgb10_a2";
  if (format == VK_FORMAT_A2B10G10R10_UINT_PACK32) return "rgb10_a2ui";
  if (format == VK_FORMAT_B10G11R11_UFLOAT_PACK32) return "r11f_g11f_b10f";
  const FormatInfo& info = format_info(format);
  int channels = 0;
  while (channels < 4 && info.bits[channels]) ++channels;
  const bool array = info.name[0] == 'R' && info.bits[0] >= 8 && info.bytes * 8 == channels * uint32_t{info.bits[0]};
  if (!array || channels == 3) return "";
  const std::string text = std::string("rgba").substr(0, static_cast<size_t>(channels)) + std::to_string(info.bits[0]);
  switch (info.numeric) {
    case Numeric::kUnorm:
      return text;
    case Numeric::kSnorm:
      return text + "_snorm";
    case Numeric::kUint:
      return text + "ui";
    case Numeric::kSint:
      return text + "i";
    case Numeric::kFloat:
      return text + "f";
    default:
      return "";
  }
}

std::string glsl_prefix(const FormatInfo& info) {
  return info.numeric == Numeric::kUint ? "u" : info.numeric == Numeric::kSint ? "i" : "";
}

std::vector<VkFormat> storage_formats(VkFormatFeatureFlags image_features) {
  std::vector<VkFormat> result;
  for (const VkFormat format : formats_with(image_features))
    if (!image_layout(format).empty()) result.push_back(format);
  return result;
}

}  // namespace vitrine::cts
