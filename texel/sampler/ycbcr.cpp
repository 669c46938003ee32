// Sampling through a Y'CbCr conversion: planes are sampled like plain images, chroma is reconstructed, then range and
// model are converted (Vulkan 1.3.239, Image Operations: Chroma Reconstruction, Sampler Y'CbCr Conversion). Chroma is
// reconstructed implicitly, by the filter of its own plane.
#include <array>
#include <cmath>

#include "base/numeric.h"
#include "texel/sampler/prepared.h"

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
  sample_planes(planes, sampler, request, texels);
  convert(planes, sampler.conversion, texels, request.active, result);
}

}  // namespace vitrine::texel
