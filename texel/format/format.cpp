// Looks format descriptions up in the table made from the registry (Vulkan 1.3.239, Formats).
#include "texel/format.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace vitrine::texel {
namespace {

#include "texel/format_table.inc"

constexpr std::size_t kFormatCount = std::size(kFormatRows);
constexpr FormatDesc kUndefined{};

constexpr bool is_plain(const FormatDesc& format) {
  if (format.is_compressed() || format.channel_count == 0 || format.block_bytes > 16) return false;
  if (format.has_depth() && format.has_stencil()) return false;
  const bool unsigned_float = format.channel[0].numeric == Numeric::kUfloat;
  const bool known_float =
      format.format == VK_FORMAT_B10G11R11_UFLOAT_PACK32 || format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
  return (!unsigned_float || known_float) &&
         std::all_of(format.channel.begin(), format.channel.begin() + format.channel_count,
                     [](const Channel& c) { return c.bits <= 32; });
}

/// Fills the fields that follow from others.
constexpr void complete(FormatDesc& format) {
  format.plain = is_plain(format);
  for (std::uint8_t c = 0; c < 4; ++c) {
    if (format.rgba[c] >= 0) format.component[static_cast<std::size_t>(format.rgba[c])] = c;
  }
}

/// Rows by ascending enum value, so that a lookup is an index for core 1.0 formats and a binary search for others.
constexpr auto kSortedRows = [] {
  std::array<FormatDesc, kFormatCount> rows{};
  std::copy(std::begin(kFormatRows), std::end(kFormatRows), rows.begin());
  for (FormatDesc& row : rows) complete(row);
  std::sort(rows.begin(), rows.end(), [](const FormatDesc& a, const FormatDesc& b) { return a.format < b.format; });
  return rows;
}();

}  // namespace

const FormatDesc& format_desc(VkFormat format) {
  // Applications may pass any bits: look at them as an integer, not as an enumerator.
  std::uint32_t value = 0;
  std::memcpy(&value, &format, sizeof(value));
  const auto value_of = [](const FormatDesc& desc) { return static_cast<std::uint32_t>(desc.format); };
  const std::size_t index = std::size_t{value} - 1;
  if (index < kFormatCount && value_of(kSortedRows[index]) == value) return kSortedRows[index];
  const auto* found = std::lower_bound(kSortedRows.begin(), kSortedRows.end(), value,
                                       [&](const FormatDesc& desc, std::uint32_t v) { return value_of(desc) < v; });
  return found != kSortedRows.end() && value_of(*found) == value ? *found : kUndefined;
}

const FormatDesc& view_format_desc(VkFormat format) {
  const auto in_words = [](VkFormat wide, VkFormat words) {
    FormatDesc desc = format_desc(words);
    desc.format = wide;
    desc.name = format_desc(wide).name;
    return desc;
  };
  static const FormatDesc unsigned_words = in_words(VK_FORMAT_R64_UINT, VK_FORMAT_R32G32_UINT);
  static const FormatDesc signed_words = in_words(VK_FORMAT_R64_SINT, VK_FORMAT_R32G32_SINT);
  if (format == VK_FORMAT_R64_UINT) return unsigned_words;
  return format == VK_FORMAT_R64_SINT ? signed_words : format_desc(format);
}

}  // namespace vitrine::texel
