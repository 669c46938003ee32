// Looks format descriptions up in the table made from the registry (Vulkan 1.3.239, Formats).
#include "texel/format.h"

#include <algorithm>
#include <iterator>

namespace vitrine::texel {
namespace {

#include "texel/format_table.inc"

constexpr std::size_t kFormatCount = std::size(kFormatRows);
constexpr FormatDesc kUndefined{};

/// Rows by ascending enum value, so that a lookup is an index for core 1.0 formats and a binary search for others.
constexpr auto kSortedRows = [] {
  std::array<FormatDesc, kFormatCount> rows{};
  std::copy(std::begin(kFormatRows), std::end(kFormatRows), rows.begin());
  std::sort(rows.begin(), rows.end(), [](const FormatDesc& a, const FormatDesc& b) { return a.format < b.format; });
  return rows;
}();

}  // namespace

const FormatDesc& format_desc(VkFormat format) {
  const auto index = static_cast<std::size_t>(format) - 1;
  if (index < kFormatCount && kSortedRows[index].format == format) return kSortedRows[index];
  const auto* found = std::lower_bound(kSortedRows.begin(), kSortedRows.end(), format,
                                       [](const FormatDesc& desc, VkFormat value) { return desc.format < value; });
  return found != kSortedRows.end() && found->format == format ? *found : kUndefined;
}

}  // namespace vitrine::texel
