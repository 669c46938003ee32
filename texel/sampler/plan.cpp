// Derives the state of a sampling operation, once per draw and image instruction (lavapipe-texture-blend.md A1, A3
// border colours, A4).
#include "texel/sampler/plan.h"

#include <algorithm>
#include <bit>

#include "base/numeric.h"
#include "texel/capabilities.h"

namespace vitrine::texel {
namespace {

/// The reference ignores maxLod from here on, the last of the 16 levels that its images may have.
constexpr float kNoMaxLod = 15.0f;

Address convert(VkSamplerAddressMode mode) {
  switch (mode) {
    case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT:
      return Address::kMirror;
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE:
      return Address::kClamp;
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER:
      return Address::kBorder;
    case VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE:
      return Address::kMirrorClamp;
    default:
      return Address::kRepeat;
  }
}

void set_dimensions(Plan& plan) {
  switch (plan.view->type) {
    case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
      plan.arrayed = true;
      [[fallthrough]];
    case VK_IMAGE_VIEW_TYPE_1D:
      plan.dims = 1;
      break;
    case VK_IMAGE_VIEW_TYPE_3D:
      plan.dims = 3;
      break;
    case VK_IMAGE_VIEW_TYPE_CUBE_ARRAY:
      plan.arrayed = true;
      [[fallthrough]];
    case VK_IMAGE_VIEW_TYPE_CUBE:
      plan.cube = true;
      break;
    case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
      plan.arrayed = true;
      break;
    default:
      break;
  }
}

/// Clamps one float component of a border colour to what the format can hold.
float clamp_border(const FormatDesc& format, float value) {
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
    case Numeric::kSrgb:
      return base::min_second(base::max_second(value, 0.0f), 1.0f);
    case Numeric::kSnorm:
      return base::min_second(base::max_second(value, -1.0f), 1.0f);
    case Numeric::kUfloat:
      value = base::max_second(value, 0.0f);
      return format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32 ? base::min_second(value, 65408.0f) : value;
    default:
      return value;
  }
}

std::uint32_t clamp_border(const FormatDesc& format, std::uint32_t value, std::uint32_t bits) {
  if (format.kind == Kind::kFloat) return base::bits_of(clamp_border(format, base::float_of(value)));
  if (bits >= 32) return value;
  if (format.kind == Kind::kUint) return std::min(value, (1u << bits) - 1);
  const std::int32_t limit = (1 << (bits - 1)) - 1;
  return static_cast<std::uint32_t>(std::clamp(static_cast<std::int32_t>(value), -limit - 1, limit));
}

Texel border_texel(const FormatDesc& format, const Sampler& sampler) {
  const std::uint32_t one = format.kind == Kind::kFloat ? 0x3f800000u : 1u;
  Texel border{0, 0, 0, one};
  for (std::size_t c = 0; c < 4; ++c) {
    const std::int8_t channel = format.rgba[c];
    if (channel >= 0) border[c] = clamp_border(format, sampler.border[c], format.channel[channel].bits);
  }
  return border;
}

void set_lod_state(Plan& plan, SampleOp op, LodMode lod_mode) {
  const Sampler& sampler = *plan.sampler;
  // The reference's static sampler state never has a "none" mip filter, so bounds are looked at in every case.
  plan.lod_fixed = sampler.min_lod == sampler.max_lod && op != SampleOp::kQueryLod;
  plan.face_query = plan.cube && op == SampleOp::kQueryLod && sampler.min_lod == sampler.max_lod;
  if (sampler.min_lod != sampler.max_lod) {
    plan.apply_min_lod = sampler.min_lod > 0.0f;
    plan.apply_max_lod = sampler.max_lod < kNoMaxLod;
  }
  plan.lod_needed = plan.two_filters || plan.mip != MipFilter::kNone || op == SampleOp::kQueryLod;
  plan.squared_rho = plan.dims > 1;
  const bool derived = lod_mode == LodMode::kImplicit || lod_mode == LodMode::kGrad;
  plan.shortcut_lod = derived && op != SampleOp::kQueryLod && !plan.anisotropic && sampler.mip_lod_bias == 0.0f &&
                      !plan.apply_min_lod && !plan.apply_max_lod && plan.mip != MipFilter::kLinear &&
                      plan.view->min_lod == 0.0f;
}

/// Cubic filters are those of flat images; views that they are not offered for are filtered linearly.
void set_filters(Plan& plan) {
  const Sampler& sampler = *plan.sampler;
  const bool flat = plan.dims == 2 && !plan.cube && !plan.gather;
  plan.min_linear = plan.gather || sampler.min_filter != VK_FILTER_NEAREST;
  plan.mag_linear = plan.gather || sampler.mag_filter != VK_FILTER_NEAREST;
  plan.min_cubic = flat && sampler.min_filter == VK_FILTER_CUBIC_EXT;
  plan.mag_cubic = flat && sampler.mag_filter == VK_FILTER_CUBIC_EXT;
  plan.two_filters = plan.min_linear != plan.mag_linear || plan.min_cubic != plan.mag_cubic;
}

bool simple_addresses(const Plan& plan) {
  return std::all_of(plan.address.begin(), plan.address.begin() + plan.dims,
                     [](Address a) { return a == Address::kRepeat || a == Address::kClamp; });
}

}  // namespace

bool fits_bytes(const FormatDesc& format) {
  if (format.is_depth_stencil() || format.channel_count == 0) return false;
  if (format.format == VK_FORMAT_BC6H_UFLOAT_BLOCK || format.format == VK_FORMAT_BC6H_SFLOAT_BLOCK) return false;
  if (format.compression == Compression::kEac || format.compression == Compression::kAstcLdr) return false;
  return std::all_of(format.channel.begin(), format.channel.begin() + format.channel_count,
                     [](const Channel& c) { return c.numeric == Numeric::kUnorm && c.bits <= 8; });
}

bool averages_words(const FormatDesc& format) {
  if (!format.plain || format.block_bytes > 4 || format.block_bytes == 3 || format.is_integer()) return false;
  if (format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) return false;
  const Numeric numeric = format.channel[0].numeric;
  return numeric == Numeric::kUnorm || numeric == Numeric::kSnorm || numeric == Numeric::kSrgb ||
         numeric == Numeric::kUfloat || numeric == Numeric::kSfloat;
}

Plan make_plan(const ImageView& view, const Sampler& sampler, SampleOp op, LodMode lod_mode) {
  Plan plan;
  plan.view = &view;
  plan.sampler = &sampler;
  plan.decode = texel_decoder(*view.format);
  set_dimensions(plan);
  plan.seamless = plan.cube && !sampler.seams;
  plan.gather = op == SampleOp::kGather;
  set_filters(plan);
  plan.anisotropic = sampler.max_anisotropy >= 2.0f && !plan.gather && plan.dims > 1 && !sampler.unnormalized &&
                     !view.format->is_integer() && !plan.min_cubic && !plan.mag_cubic;
  plan.mip = sampler.mip_mode == VK_SAMPLER_MIPMAP_MODE_LINEAR ? MipFilter::kLinear : MipFilter::kNearest;
  // "level zero only" is the view's last level counted in the image.
  const bool level_zero_only = view.base_level + view.level_count == 1;
  if (level_zero_only && sampler.max_lod > 0.0f && op != SampleOp::kQueryLod) plan.mip = MipFilter::kNone;
  const bool any_linear = plan.min_linear || plan.mag_linear || sampler.mip_mode == VK_SAMPLER_MIPMAP_MODE_LINEAR;
  plan.zero = !can_sample(*view.format) || (op == SampleOp::kSample && view.format->is_integer() && any_linear);
  plan.zero |= plan.gather && view.min_level != 0;
  if (plan.gather) plan.mip = MipFilter::kNone;
  const std::uint32_t size[3] = {view.level0_extent.width, view.level0_extent.height, view.level0_extent.depth};
  for (std::size_t i = 0; i < 3; ++i) {
    plan.address[i] = plan.seamless ? Address::kClamp : convert(sampler.address[i]);
    plan.pot[i] = std::has_single_bit(size[i]);
  }
  set_lod_state(plan, op, lod_mode);
  const bool lod_per_lane = lod_mode != LodMode::kImplicit || (plan.cube && plan.mip != MipFilter::kNone);
  plan.aos = op == SampleOp::kSample && !sampler.compare && !plan.anisotropic && fits_bytes(*view.format) &&
             simple_addresses(plan) && (plan.min_linear == plan.mag_linear || !lod_per_lane) &&
             !(plan.seamless && (plan.min_linear || plan.mag_linear)) && !plan.min_cubic && !plan.mag_cubic;
  plan.border = border_texel(*view.format, sampler);
  return plan;
}

void apply_swizzle(const ImageView& view, Texel& texel) {
  const std::uint32_t one = view.format->kind == Kind::kFloat ? 0x3f800000u : 1u;
  const std::uint32_t source[6] = {texel[0], texel[1], texel[2], texel[3], 0, one};
  for (std::size_t c = 0; c < 4; ++c) texel[c] = source[view.swizzle[c]];
}

}  // namespace vitrine::texel
