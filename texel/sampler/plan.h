// What a view, a sampler and an operation come to when they meet: every decision that does not depend on a lane
// (lavapipe-texture-blend.md A1, A4).
#pragma once

#include "texel/codec.h"
#include "texel/sampler.h"

namespace vitrine::texel {

enum class Address : std::uint8_t { kRepeat, kMirror, kClamp, kBorder, kMirrorClamp };
enum class MipFilter : std::uint8_t { kNone, kNearest, kLinear };

struct Plan {
  const ImageView* view = nullptr;
  const Sampler* sampler = nullptr;
  TexelDecoder decode = nullptr;  ///< null for compressed formats
  std::uint32_t dims = 2;         ///< addressed dimensions: cubes have 2
  bool cube = false;
  bool seamless = false;  ///< filters cross the edges of a cube
  bool arrayed = false;
  bool aos = false;   ///< 8-bit fixed-point path, bytes in and out
  bool zero = false;  ///< integers with a linear filter, or a format that cannot be sampled: all components 0
  bool gather = false;
  bool anisotropic = false;
  bool min_linear = false;  ///< several texels, cubic or not
  bool mag_linear = false;
  bool min_cubic = false;  ///< sixteen texels of flat images (model/cubic.h)
  bool mag_cubic = false;
  bool two_filters = false;  ///< one for minified, another for magnified texels
  MipFilter mip = MipFilter::kNone;
  std::array<Address, 3> address{};
  std::array<bool, 3> pot{};  ///< by the image's level 0
  bool lod_needed = false;
  bool lod_fixed = false;  ///< minLod == maxLod
  bool apply_max_lod = false;
  bool apply_min_lod = false;
  bool shortcut_lod = false;  ///< level and minification straight from the exponent of rho
  bool face_query = false;    ///< a query of a cube of one level, whose slopes are differences on the face
  bool squared_rho = true;    ///< 1D works with rho, others with its square
  Texel border{};             ///< clamped to the format; missing channels as the format has them
};

Plan make_plan(const ImageView& view, const Sampler& sampler, SampleOp op, LodMode lod_mode);

/// Level of detail of one lane, levels relative to the view's first.
struct Lod {
  float value = 0;  ///< before clamps (queryLod)
  float clamped = 0;
  bool minify = false;
  std::uint32_t level0 = 0;
  std::uint32_t level1 = 0;
  float fraction = 0;  ///< weight of level1
};

/// One texel as values, or as the reference's bytes (AoS path). Coordinates are inside the level.
void fetch_texel(const Plan& plan, std::uint32_t level, std::uint32_t layer, std::uint32_t x, std::uint32_t y,
                 std::uint32_t z, Texel& out);
using ByteTexel = std::array<std::uint8_t, 4>;
void fetch_bytes(const ImageView& view, std::uint32_t level, std::uint32_t layer, std::uint32_t x, std::uint32_t y,
                 std::uint32_t z, ByteTexel& out);

/// Whether all channels are unsigned-normalised, at most 8 bits and not sRGB: formats of the AoS path.
bool fits_bytes(const FormatDesc& format);

/// Whether texels are one word, or less, of one kind of channels that can be averaged.
bool averages_words(const FormatDesc& format);

/// Applies the view's component mapping in place; `one` is 1 of the format's kind.
void apply_swizzle(const ImageView& view, Texel& texel);

/// Whole waves, lane by lane: the scalar twin of every vector path and the path of everything that has none.
void sample_scalar(const Plan& plan, const SampleRequest& request, base::WaveRegister result[4]);

}  // namespace vitrine::texel
