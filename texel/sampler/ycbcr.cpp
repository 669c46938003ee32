// Sampling through a Y'CbCr conversion: planes are sampled like plain images, chroma is reconstructed, then range and
// model are converted (Vulkan 1.3.239, Image Operations: Chroma Reconstruction, Sampler Y'CbCr Conversion). Chroma is
// reconstructed implicitly, by the filter of its own plane, unless the conversion forces explicit reconstruction.
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/numeric.h"
#include "texel/sampler/address.h"
#include "texel/sampler/lod.h"
#include "texel/sampler/prepared.h"
#include "texel/sampler/scalar.h"

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;
using base::WaveRegister;

/// What a wave samples: the planes of a format that requires a conversion, or the one of any other.
struct Planes {
  explicit Planes(const ImageView& view) : format(*view.format), first(view.planes ? view.planes : &view) {
    if (view.planes) count = format.sampled_planes;
  }

  bool halves_x(std::uint32_t plane) const { return count > 1 && format.plane[plane].width_divisor > 1; }
  bool halves_y(std::uint32_t plane) const { return count > 1 && format.plane[plane].height_divisor > 1; }
  bool subsampled(std::uint32_t plane) const { return halves_x(plane) || halves_y(plane); }

  const FormatDesc& format;
  const ImageView* first;
  std::uint32_t count = 1;
};

using PlaneTexels = std::array<std::array<WaveRegister, 4>, 3>;

/// Moves coordinates so that a chroma plane may be sampled like any image: "u' = 0.5 (u + 0.5)" where chroma lies on
/// the even luma samples, in texels of both planes, is half a luma texel more in normalised coordinates.
const WaveRegister* shift_coordinate(const WaveRegister* coord, std::uint32_t luma_size, base::LaneMask active,
                                     WaveRegister& shifted) {
  const float half = 0.5f / static_cast<float>(luma_size);
  base::for_each_lane(active, [&](std::size_t i) { shifted.lane[i] = bits_of(float_of(coord->lane[i]) + half); });
  return &shifted;
}

/// Each plane with its filter.
void sample_planes(const Planes& planes, const Sampler& sampler, const SampleRequest& request, PlaneTexels& texels) {
  const YcbcrConversion& conversion = sampler.conversion;
  const Extent& luma = planes.first->level[0].extent;
  for (std::uint32_t p = 0; p < planes.count; ++p) {
    Sampler own = sampler;
    SampleRequest moved = request;
    WaveRegister shifted[2];
    if (planes.subsampled(p)) own.min_filter = own.mag_filter = conversion.chroma_filter;
    // "If chromaFilter is VK_FILTER_NEAREST, an implementation may behave as if ... VK_CHROMA_LOCATION_MIDPOINT".
    if (planes.subsampled(p) && conversion.chroma_filter == VK_FILTER_LINEAR) {
      const bool x = planes.halves_x(p) && conversion.x_cosited, y = planes.halves_y(p) && conversion.y_cosited;
      if (x) moved.coord[0] = shift_coordinate(request.coord[0], luma.width, request.active, shifted[0]);
      if (y) moved.coord[1] = shift_coordinate(request.coord[1], luma.height, request.active, shifted[1]);
    }
    PreparedSampler prepared;
    prepare_floats(planes.first[p], own, request.op, request.lod_mode, prepared);
    std::array<WaveRegister, 4>& to = texels[p];
    sample(prepared, moved, {&to[0], &to[1], &to[2], &to[3]});
  }
}

/// Two texels along an axis and the weight of the second.
struct Pair {
  std::int32_t first = 0, second = 0;
  float weight = 0;
};

/// Chroma samples that make the one at luma texel `i` of an axis with half as many: at even texels themselves or a
/// quarter off.
Pair chroma_pair(std::int32_t i, bool halved, bool linear, bool cosited, std::uint32_t size) {
  if (!halved) return {i, i, 0.0f};
  const std::int32_t half = i >> 1, last = static_cast<std::int32_t>(size) - 1;
  const bool odd = (i & 1) != 0;
  if (!linear) return {half, half, 0.0f};
  const std::int32_t first = cosited || odd ? half : half - 1;
  const float weight = cosited ? (odd ? 0.5f : 0.0f) : (odd ? 0.25f : 0.75f);
  return {std::clamp(first, 0, last), std::clamp(first + 1, 0, last), weight};
}

void interpolate(float weight, Texel& a, const Texel& b) {
  for (std::size_t c = 0; c < 4; ++c) {
    a[c] = bits_of(base::fma_exact(weight, float_of(b[c]) - float_of(a[c]), float_of(a[c])));
  }
}

/// Reads single texels of one plane.
class PlaneReader {
 public:
  PlaneReader(const ImageView& view, std::uint32_t layer)
      : view_(view), layer_(layer), decode_(texel_decoder(*view.format)) {}

  Texel at(std::int32_t x, std::int32_t y) const {
    Texel out;
    decode_(*view_.format, view_.block(0, layer_, 0, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0),
            out);
    return out;
  }

  Texel blend(const Pair& x, const Pair& y) const {
    Texel upper = at(x.first, y.first);
    interpolate(x.weight, upper, at(x.second, y.first));
    Texel lower = at(x.first, y.second);
    interpolate(x.weight, lower, at(x.second, y.second));
    interpolate(y.weight, upper, lower);
    return upper;
  }

 private:
  const ImageView& view_;
  std::uint32_t layer_;
  TexelDecoder decode_;
};

/// One lane of one plane, reconstructed at the luma texels that the sampler's filter reads, then filtered.
Texel reconstruct(const Planes& planes, std::uint32_t p, const YcbcrConversion& conversion, const Pair& x,
                  const Pair& y, std::uint32_t layer) {
  const ImageView& view = planes.first[p];
  const PlaneReader reader(view, layer);
  if (!planes.subsampled(p)) return reader.blend(x, y);
  const Extent& extent = view.level[0].extent;
  const bool linear = conversion.chroma_filter == VK_FILTER_LINEAR;
  const auto at = [&](std::int32_t i, std::int32_t j) {
    return reader.blend(chroma_pair(i, planes.halves_x(p), linear, conversion.x_cosited, extent.width),
                        chroma_pair(j, planes.halves_y(p), linear, conversion.y_cosited, extent.height));
  };
  Texel upper = at(x.first, y.first);
  interpolate(x.weight, upper, at(x.second, y.first));
  Texel lower = at(x.first, y.second);
  interpolate(x.weight, lower, at(x.second, y.second));
  interpolate(y.weight, upper, lower);
  return upper;
}

/// Luma texels around a coordinate; samplers with a conversion clamp to the edge.
Pair luma_pair(float s, std::uint32_t size, bool linear) {
  Axis axis;
  axis.address = Address::kClamp;
  axis.pot = std::has_single_bit(size);
  axis.normalized = true;
  axis.size = static_cast<std::int32_t>(size);
  if (!linear) {
    const std::int32_t i = nearest_texel(axis, s);
    return {i, i, 0.0f};
  }
  const Taps taps = linear_texels(axis, s);
  return {taps.first, taps.second, taps.weight};
}

void reconstruct_planes(const Planes& planes, const Sampler& sampler, const SampleRequest& request,
                        PlaneTexels& texels) {
  const Plan plan = make_plan(*planes.first, sampler, request.op, request.lod_mode);
  const Extent& luma = planes.first->level[0].extent;
  base::for_each_lane(request.active, [&](std::size_t lane) {
    const LanePoint point = locate(plan, request, lane);
    const bool minify = plan.lod_needed && level_of_detail(plan, request, point, lane).minify;
    const bool linear = minify ? plan.min_linear : plan.mag_linear;
    const Pair x = luma_pair(point.coord[0], luma.width, linear), y = luma_pair(point.coord[1], luma.height, linear);
    const std::uint32_t layer = select_layer(plan, request, lane);
    for (std::uint32_t p = 0; p < planes.count; ++p) {
      const Texel texel = reconstruct(planes, p, sampler.conversion, x, y, layer);
      for (std::size_t c = 0; c < 4; ++c) texels[p][c].lane[lane] = texel[c];
    }
  });
}

/// A component of the sampled colour, or a constant.
struct Source {
  const WaveRegister* lanes = nullptr;
  float constant = 0;

  float at(std::size_t lane) const { return lanes ? float_of(lanes->lane[lane]) : constant; }
};

Source find_source(const Planes& planes, const PlaneTexels& texels, std::uint8_t swizzle) {
  if (swizzle > 3) return {nullptr, swizzle == 5 ? 1.0f : 0.0f};
  if (!planes.format.requires_conversion()) return {&texels[0][swizzle], 0};
  const PlaneComponent& component = planes.format.plane_component[swizzle];
  if (component.plane < 0) return {nullptr, swizzle == 3 ? 1.0f : 0.0f};
  return {&texels[static_cast<std::size_t>(component.plane)][component.channel], 0};
}

/// value * scale + offset.
struct Linear {
  float scale = 1, offset = 0;
  float operator()(float value) const { return value * scale + offset; }
};

/// "Sampler Y'CbCr Range Expansion" for components of `bits` bits.
struct Expansion {
  Linear luma, chroma;
};
Expansion expansion(VkSamplerYcbcrRange range, std::uint32_t bits) {
  const double largest = std::ldexp(1.0, static_cast<int>(bits)) - 1,
               unit = std::ldexp(1.0, static_cast<int>(bits) - 8);
  const auto linear = [](double scale, double offset) {
    return Linear{static_cast<float>(scale), static_cast<float>(offset)};
  };
  if (range == VK_SAMPLER_YCBCR_RANGE_ITU_FULL) return {{}, linear(1.0, -128 * unit / largest)};
  return {linear(largest / (219 * unit), -16.0 / 219), linear(largest / (224 * unit), -128.0 / 224)};
}

/// "Sampler Y'CbCr Model Conversion": weights of red and blue in luma give all factors.
struct Model {
  float red_cr, green_cb, green_cr, blue_cb;
};
Model model_of(VkSamplerYcbcrModelConversion conversion) {
  double red = 0.299, blue = 0.114;  // BT.601
  if (conversion == VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_709) red = 0.2126, blue = 0.0722;
  if (conversion == VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_2020) red = 0.2627, blue = 0.0593;
  const double green = 1 - red - blue;
  return {static_cast<float>(2 * (1 - red)), static_cast<float>(-2 * (1 - blue) * blue / green),
          static_cast<float>(-2 * (1 - red) * red / green), static_cast<float>(2 * (1 - blue))};
}

void convert(const Planes& planes, const YcbcrConversion& conversion, const PlaneTexels& texels, base::LaneMask active,
             const SampleResult& result) {
  Source source[4];
  for (std::size_t c = 0; c < 4; ++c) source[c] = find_source(planes, texels, conversion.swizzle[c]);
  const bool converted = conversion.model != VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY;
  const bool matrix = converted && conversion.model != VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_IDENTITY;
  const Expansion expand = expansion(conversion.range, planes.first->format->channel[0].bits);
  const Model model = model_of(conversion.model);
  base::for_each_lane(active, [&](std::size_t lane) {
    float rgba[4];
    for (std::size_t c = 0; c < 4; ++c) rgba[c] = source[c].at(lane);
    if (converted) {
      rgba[0] = expand.chroma(rgba[0]);
      rgba[1] = expand.luma(rgba[1]);
      rgba[2] = expand.chroma(rgba[2]);
    }
    if (matrix) {
      const float cr = rgba[0], y = rgba[1], cb = rgba[2];
      rgba[0] = y + model.red_cr * cr;
      rgba[1] = y + model.green_cb * cb + model.green_cr * cr;
      rgba[2] = y + model.blue_cb * cb;
    }
    for (std::size_t c = 0; c < 4; ++c) {
      if (result[c] != nullptr) result[c]->lane[lane] = bits_of(rgba[c]);
    }
  });
}

}  // namespace

void sample_converted(const PreparedSampler& prepared, const SampleRequest& request, const SampleResult& result) {
  const Planes planes(*prepared.plan.view);
  const Sampler& sampler = *prepared.plan.sampler;
  PlaneTexels texels;
  if (sampler.conversion.explicit_reconstruction && planes.count > 1) {
    reconstruct_planes(planes, sampler, request, texels);
  } else {
    sample_planes(planes, sampler, request, texels);
  }
  convert(planes, sampler.conversion, texels, request.active, result);
}

}  // namespace vitrine::texel
