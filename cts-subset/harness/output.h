// What a case puts out: named arrays of texels, compared byte by byte.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/format.h"

namespace vitrine::cts {

struct Output {
  std::string name;
  FormatInfo format;
  uint32_t width = 1, height = 1, layers = 1;  ///< in texels, or blocks; layers also counts slices and samples
  std::vector<unsigned char> bytes;
  bool nan_bits_free = false;  ///< two NaNs are equal: SPIR-V leaves a NaN's sign and payload open
  std::string remark;          ///< shown with a difference: where the values come from
  bool may_be_blank = false;   ///< one value everywhere is what the case is about
  std::string deviation;       ///< rows of deviations.md: a difference is listed. Empty: the output must be identical
};

/// How the outputs of two devices compare.
struct Comparison {
  uint64_t differing_texels = 0;
  uint64_t nan_bits = 0;  ///< texels that differ in the bits of a NaN only, where that is free
  std::string first;      ///< first difference with coordinates and both values; empty when equal
};

Comparison compare(const Output& device, const Output& reference);
/// Whether every texel has the same bytes.
bool is_blank(const Output& output);
/// Writes NAME.png for the output itself.
void write_png(const std::string& path, const Output& output);
/// Writes a picture of where two outputs differ: black = equal, else red with the difference.
void write_difference_png(const std::string& path, const Output& device, const Output& reference);

}  // namespace vitrine::cts
