// Formats of storage images and storage texel buffers, as shaders name them.
#pragma once

#include <string>
#include <vector>

#include "harness/format.h"

namespace vitrine::cts {

/// The layout qualifier of GLSL for a format, as "rgba8_snorm"; empty where GLSL has none.
std::string image_layout(VkFormat format);
/// What GLSL puts before vec4, image2D, samplerBuffer and so on: "", "u" or "i".
std::string glsl_prefix(const FormatInfo& info);
/// Formats with a qualifier that the reference stores to.
std::vector<VkFormat> storage_formats(VkFormatFeatureFlags image_features);

}  // namespace vitrine::cts
