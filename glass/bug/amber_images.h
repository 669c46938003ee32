// Images, samplers and data in AmberScript.
#pragma once

#include <ostream>
#include <string>

#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

/// What the language has no words for: thrown.
struct Unspeakable {
  std::string what;
};

/// BUFFER with its data, of numbers of `step` bytes (1, 2 or 4).
void write_numbers(std::ostream& out, const std::string& name, const Bytes& bytes, std::size_t step);
/// IMAGE with the texels of the one level and layer that views show of image `number`, by `name`.
void write_image(std::ostream& out, const std::string& name, const Bug& bug, std::uint32_t number, bool after);
/// The extent of that level.
texel::Extent extent_shown(const Image& image);
/// The format in which all views show an image.
VkFormat format_shown(const Bug& bug, std::uint32_t number);
/// BUFFER with its data as texels of a format.
void write_texel_buffer(std::ostream& out, const std::string& name, const Bytes& bytes, VkFormat format);
/// A comparison as the language calls it; `what` is thrown if there is no such one.
const char* compare_name(VkCompareOp op, const char* what);
/// SAMPLER.
void write_sampler(std::ostream& out, const std::string& name, const texel::Sampler& sampler);
/// Throws unless the view shows texels as they are, not as an array's or a cube's.
void demand_plain(const View& view, const Image& image);

}  // namespace vitrine::glass::bug
