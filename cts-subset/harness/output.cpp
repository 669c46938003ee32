// Compares outputs and writes pictures of those that differ.
#include "harness/output.h"

#include <png.h>

#include <cstdio>
#include <cstring>

namespace vitrine::cts {
namespace {

bool same_but_for_nans(const FormatInfo& format, const unsigned char* a, const unsigned char* b) {
  if (format.bits[0] != 32) return false;
  for (uint32_t i = 0; i < format.bytes; i += 4) {
    uint32_t x, y;
    std::memcpy(&x, a + i, 4);
    std::memcpy(&y, b + i, 4);
    const bool both_nan = (x & 0x7fffffff) > 0x7f800000 && (y & 0x7fffffff) > 0x7f800000;
    if (x != y && !both_nan) return false;
  }
  return true;
}

std::string place(const Output& output, uint64_t index) {
  const uint64_t x = index % output.width, y = index / output.width % output.height;
  const uint64_t layer = index / output.width / output.height;
  std::string text = output.height == 1 && output.layers == 1
                         ? "element " + std::to_string(x)
                         : "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")";
  if (output.layers > 1) text += " of layer " + std::to_string(layer);
  return text;
}

void write_rows(const std::string& path, uint32_t width, uint32_t height, const std::vector<uint32_t>& rgba) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGBA;
  png_image_write_to_file(&image, path.c_str(), 0, rgba.data(), 0, nullptr);
}

/// Long one-dimensional outputs are folded into lines of 64.
void picture_extent(const Output& output, uint32_t& width, uint32_t& height) {
  width = output.width;
  height = output.height * output.layers;
  if (output.height == 1 && output.width > 64) {
    width = 64;
    height = (output.width * output.layers + 63) / 64;
  }
}

}  // namespace

Comparison compare(const Output& device, const Output& reference) {
  Comparison result;
  if (device.bytes.size() != reference.bytes.size()) {
    result.differing_texels = 1;
    result.first = reference.name + ": " + std::to_string(device.bytes.size()) + " bytes, reference " +
                   std::to_string(reference.bytes.size());
    return result;
  }
  const uint32_t size = reference.format.bytes;
  const uint64_t texels = reference.bytes.size() / size;
  if (device.bytes == reference.bytes) return result;
  for (uint64_t i = 0; i < texels; ++i) {
    const unsigned char* a = device.bytes.data() + i * size;
    const unsigned char* b = reference.bytes.data() + i * size;
    if (std::memcmp(a, b, size) == 0) continue;
    if (reference.nan_bits_free && same_but_for_nans(reference.format, a, b)) {
      ++result.nan_bits;
      continue;
    }
    if (result.differing_texels++ == 0)
      result.first = reference.name + " (" + reference.format.name + " " + std::to_string(reference.width) + "x" +
                     std::to_string(reference.height) + "), " + place(reference, i) + ": device " +
                     describe_texel(reference.format, a) + ", reference " + describe_texel(reference.format, b);
  }
  if (result.differing_texels && !reference.remark.empty()) result.first += "; " + reference.remark;
  if (result.differing_texels)
    result.first += "; " + std::to_string(result.differing_texels) + " of " + std::to_string(texels) + " differ";
  return result;
}

bool is_blank(const Output& output) {
  const uint32_t size = output.format.bytes;
  for (size_t i = size; i < output.bytes.size(); i += size)
    if (std::memcmp(output.bytes.data(), output.bytes.data() + i, size) != 0) return false;
  return true;
}

void write_png(const std::string& path, const Output& output) {
  uint32_t width, height;
  picture_extent(output, width, height);
  std::vector<uint32_t> rgba(size_t{width} * height);
  const size_t texels = output.bytes.size() / output.format.bytes;
  for (size_t i = 0; i < texels && i < rgba.size(); ++i)
    rgba[i] = preview_rgba(output.format, output.bytes.data() + i * output.format.bytes);
  write_rows(path, width, height, rgba);
}

void write_difference_png(const std::string& path, const Output& device, const Output& reference) {
  uint32_t width, height;
  picture_extent(reference, width, height);
  std::vector<uint32_t> rgba(size_t{width} * height, 0xff000000u);
  const uint32_t size = reference.format.bytes;
  const size_t texels = std::min(device.bytes.size(), reference.bytes.size()) / size;
  for (size_t i = 0; i < texels && i < rgba.size(); ++i) {
    const unsigned char* a = device.bytes.data() + i * size;
    const unsigned char* b = reference.bytes.data() + i * size;
    if (std::memcmp(a, b, size) == 0) continue;
    const uint32_t pa = preview_rgba(reference.format, a), pb = preview_rgba(reference.format, b);
    rgba[i] = 0xff0000ffu | ((pa ^ pb) & 0x00ffff00u);
  }
  write_rows(path, width, height, rgba);
}

}  // namespace vitrine::cts
