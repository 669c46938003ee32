// A picture as a PNG file (ISO/IEC 15948), in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vitrine::icd::wsi {

/// `rgb` holds width * height pixels of three bytes. Runs of equal pixels are packed, nothing else.
std::vector<std::byte> encode_png(std::span<const std::byte> rgb, std::uint32_t width, std::uint32_t height);

}  // namespace vitrine::icd::wsi
