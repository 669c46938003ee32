// Texels around a lookup. Where rounding could choose the neighbour, the neighbour belongs to them: nobody is accused
// of reading a texel that the sampler did not.
#include "glass/sanitize/footprint.h"

#include <algorithm>
#include <cmath>

namespace vitrine::glass::sanitize {
namespace {

/// Coordinates are exact enough for this part of a texel below kGreatest texels.
constexpr float kDoubt = 0.02f;
constexpr float kGreatest = 16384;

/// Texels along one axis, the nearest first.
struct Taps {
  std::array<std::int32_t, 5> at{};
  std::uint32_t count = 1;
};

std::int32_t positive_modulo(std::int32_t i, std::int32_t size) { return (i % size + size) % size; }

std::int32_t wrap(std::int32_t i, std::int32_t size, VkSamplerAddressMode mode) {
  switch (mode) {
    case VK_SAMPLER_ADDRESS_MODE_REPEAT:
      return positive_modulo(i, size);
    case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT: {
      const std::int32_t folded = positive_modulo(i, 2 * size);
      return folded < size ? folded : 2 * size - 1 - folded;
    }
    case VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE:
      return std::min(i < 0 ? -1 - i : i, size - 1);
    default:
      return std::clamp(i, 0, size - 1);
  }
}

/// How far a lookup may look on each side of its point.
enum class Reach { kNearest, kNeighbour, kCubic };

/// `u` counts texels. False: it is not known, or the border is read.
bool make_taps(float u, std::uint32_t texels, VkSamplerAddressMode mode, Reach reach, Taps& taps) {
  if (!(std::fabs(u) < kGreatest)) return false;
  const auto size = static_cast<std::int32_t>(texels);
  const bool filters = reach != Reach::kNearest, cubic = reach == Reach::kCubic;
  const float margin = cubic ? 2 : 1;
  const bool inside = u >= margin && u <= static_cast<float>(size) - margin;
  if (mode == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER && !inside) return false;
  const float floor = std::floor(u), fraction = u - floor;
  const auto nearest = static_cast<std::int32_t>(floor);
  const auto add = [&](std::int32_t i) { taps.at[taps.count++] = wrap(i, size, mode); };
  taps.at[0] = wrap(nearest, size, mode);
  taps.count = 1;
  // A filter reads the neighbour on the side of which the point lies; a cubic one both, and one more there.
  const std::int32_t far = cubic ? 2 : 1;
  if (fraction < (filters ? 0.5f + kDoubt : kDoubt)) add(nearest - far);
  if (fraction > (filters ? 0.5f - kDoubt : 1 - kDoubt)) add(nearest + far);
  if (cubic) {
    add(nearest - 1);
    add(nearest + 1);
  }
  return true;
}

/// The face that a direction points to, and where; false: too near to an edge.
bool to_face(std::array<float, 3>& at, std::uint32_t& face) {
  const float x = at[0], y = at[1], z = at[2], ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
  float s = 0, t = 0, major = 0;
  if (az >= ax && az >= ay) {
    face = z < 0 ? 5 : 4, s = z < 0 ? -x : x, t = -y, major = az;
  } else if (ay >= ax) {
    face = y < 0 ? 3 : 2, s = x, t = y < 0 ? -z : z, major = ay;
  } else {
    face = x < 0 ? 1 : 0, s = x < 0 ? z : -z, t = -y, major = ax;
  }
  at = {0.5f * (s / major + 1), 0.5f * (t / major + 1), 0};
  return at[0] > 0 && at[0] < 1 && at[1] > 0 && at[1] < 1;
}

/// The levels that may be read.
struct Levels {
  std::uint32_t first = 0, last = 0;
};

Levels levels_of(const texel::ImageView& view, const texel::Sampler& sampler, const Lookup& lookup) {
  if (lookup.gather) return {};
  const std::uint32_t last = view.level_count - 1;
  if (!lookup.lod || !std::isfinite(*lookup.lod)) return {0, last};
  const float biased = *lookup.lod + sampler.mip_lod_bias;
  const float level =
      std::clamp(std::min(std::max(biased, sampler.min_lod), sampler.max_lod), 0.0f, static_cast<float>(last));
  return {static_cast<std::uint32_t>(std::floor(level)), static_cast<std::uint32_t>(std::ceil(level))};
}

bool is_cube(const texel::ImageView& view) {
  return view.type == VK_IMAGE_VIEW_TYPE_CUBE || view.type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
}

std::uint32_t dimensions_of(VkImageViewType type) {
  if (type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY) return 1;
  return type == VK_IMAGE_VIEW_TYPE_3D ? 3 : 2;
}

/// One lookup, its direction turned into a face.
class Footprint {
 public:
  Footprint(const texel::ImageView& view, const texel::Sampler& sampler, const Lookup& lookup, std::uint32_t layer)
      : view_(view), sampler_(sampler), lookup_(lookup), layer_(layer), dims_(dimensions_of(view.type)) {}

  bool all_of_level(std::uint32_t level, base::FunctionRef<bool(const std::byte*)> f) const {
    std::array<Taps, 3> taps;
    const texel::Extent& extent = view_.level[level].extent;
    const std::array<std::uint32_t, 3> sizes{extent.width, extent.height, extent.depth};
    for (std::uint32_t axis = 0; axis < dims_; ++axis) {
      const float size = sampler_.unnormalized ? 1 : static_cast<float>(sizes[axis]);
      const float u = lookup_.at[axis] * size + static_cast<float>(lookup_.offset[axis]);
      const VkSamplerAddressMode mode =
          is_cube(view_) ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER : sampler_.address[axis];
      if (!make_taps(u, sizes[axis], mode, reach(), taps[axis])) return false;
    }
    for (std::uint32_t z = 0; z < taps[2].count; ++z)
      for (std::uint32_t y = 0; y < taps[1].count; ++y)
        for (std::uint32_t x = 0; x < taps[0].count; ++x)
          if (!f(block(level, taps[0].at[x], taps[1].at[y], taps[2].at[z]))) return false;
    return true;
  }

 private:
  Reach reach() const {
    const VkFilter farther = std::max(sampler_.mag_filter, sampler_.min_filter);  // in this order
    const bool flat = dims_ == 2 && !is_cube(view_);
    if (farther == VK_FILTER_CUBIC_EXT && flat && !lookup_.gather) return Reach::kCubic;
    return lookup_.gather || farther != VK_FILTER_NEAREST ? Reach::kNeighbour : Reach::kNearest;
  }
  const std::byte* block(std::uint32_t level, std::int32_t x, std::int32_t y, std::int32_t z) const {
    const texel::FormatDesc& format = *view_.format;
    return view_.block(level, layer_, 0, static_cast<std::uint32_t>(x) / format.block_width,
                       static_cast<std::uint32_t>(y) / format.block_height, static_cast<std::uint32_t>(z));
  }

  const texel::ImageView& view_;
  const texel::Sampler& sampler_;
  const Lookup& lookup_;
  const std::uint32_t layer_;
  const std::uint32_t dims_;
};

}  // namespace

bool all_of_footprint(const texel::ImageView& view, const texel::Sampler& sampler, const Lookup& lookup,
                      base::FunctionRef<bool(const std::byte*)> f) {
  const bool known = view.planes == nullptr && view.samples == 1 && view.level_count != 0 &&
                     !sampler.conversion.enabled && sampler.max_anisotropy <= 1;
  if (!known) return false;
  Lookup turned = lookup;
  std::uint32_t face = 0;
  if (is_cube(view) && !to_face(turned.at, face)) return false;
  const std::uint32_t faces = is_cube(view) ? 6 : 1;
  const float last_layer = static_cast<float>(view.layer_count / faces) - 1;
  const float layer = std::clamp(std::nearbyintf(lookup.layer), 0.0f, std::max(last_layer, 0.0f));
  if (!std::isfinite(layer)) return false;
  const Footprint footprint(view, sampler, turned, static_cast<std::uint32_t>(layer) * faces + face);
  const Levels levels = levels_of(view, sampler, lookup);
  for (std::uint32_t level = levels.first; level <= levels.last; ++level)
    if (!footprint.all_of_level(level, f)) return false;
  return true;
}

}  // namespace vitrine::glass::sanitize
