// The sampler: whole waves of coordinates in, whole waves of texels out. Bits: lavapipe-texture-blend.md parts A to C.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>

#include "base/lanes.h"
#include "texel/view.h"

namespace vitrine::texel {

/// Sampler Y'CbCr conversion, named after VkSamplerYcbcrConversionCreateInfo.
struct YcbcrConversion {
  bool enabled = false;
  VkSamplerYcbcrModelConversion model = VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY;
  VkSamplerYcbcrRange range = VK_SAMPLER_YCBCR_RANGE_ITU_FULL;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};  ///< as ImageView::swizzle
  bool x_cosited = false;                           ///< chroma samples lie on the even luma samples, else between
  bool y_cosited = false;
  VkFilter chroma_filter = VK_FILTER_NEAREST;
};

/// Sampler state, named after VkSamplerCreateInfo. Immutable.
struct Sampler {
  VkFilter mag_filter = VK_FILTER_NEAREST;
  VkFilter min_filter = VK_FILTER_NEAREST;
  VkSamplerMipmapMode mip_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  std::array<VkSamplerAddressMode, 3> address{VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                              VK_SAMPLER_ADDRESS_MODE_REPEAT};
  float mip_lod_bias = 0;
  float min_lod = 0;
  float max_lod = 0;
  float max_anisotropy = 1;  ///< 1 when anisotropy is disabled; fractions do not count
  bool compare = false;
  VkCompareOp compare_op = VK_COMPARE_OP_NEVER;
  std::array<std::uint32_t, 4> border{};  ///< raw bits: floats or integers by the border colour's type
  bool custom_border = false;             ///< the first two are one number where components have 64 bits
  bool unnormalized = false;
  bool seams = false;  ///< faces of cubes are images of two dimensions by themselves; else filters cross their edges
  VkSamplerReductionMode reduction = VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
  YcbcrConversion conversion;
};

enum class SampleOp : std::uint8_t { kSample, kGather, kQueryLod };
enum class LodMode : std::uint8_t {
  kImplicit,  ///< from quad derivatives of the coordinates (fragment); stages without derivatives use kZero
  kBias,      ///< implicit plus `lod` per lane
  kExplicit,  ///< `lod` per lane, before the sampler's bias and clamps
  kGrad,      ///< `ddx`, `ddy` per lane
  kZero,      ///< 0, before the same
};

/// One image instruction for a wave. Pointers are to 64-lane registers holding float bits (integers where noted); null
/// where the operand is absent. Lanes outside `active` may hold anything and must not fault.
struct SampleRequest {
  SampleOp op = SampleOp::kSample;
  LodMode lod_mode = LodMode::kImplicit;
  base::LaneMask active = base::kAllLanes;
  bool quads = true;  ///< lanes are the pixels of quads; else coordinates have no derivatives but given ones
  std::array<const base::WaveRegister*, 4>
      coord{};                               ///< s, t, r (as the dimension needs), then array layer, in this order
  const base::WaveRegister* dref = nullptr;  ///< depth comparison reference
  const base::WaveRegister* lod = nullptr;   ///< bias or explicit LOD
  std::array<const base::WaveRegister*, 3> ddx{};
  std::array<const base::WaveRegister*, 3> ddy{};
  const base::WaveRegister* min_lod = nullptr;
  std::array<const base::WaveRegister*, 3> offset{};  ///< int32 texel offsets (constant or per lane)
  const std::array<std::array<std::int32_t, 2>, 4>* gather_offsets = nullptr;  ///< ConstOffsets
  std::uint32_t gather_component = 0;
};

/// Results of a wave by component, raw bits; null: not wanted. They may be the registers of the request.
using SampleResult = std::array<base::WaveRegister*, 4>;

/// Samples, gathers or queries for every active lane; writes four components (raw bits), kQueryLod two. Other lanes of
/// `result` keep what they hold; so they do for the fetches below.
void sample(const ImageView& view, const Sampler& sampler, const SampleRequest& request, base::WaveRegister result[4]);

/// texelFetch / OpImageRead / imageLoad: integer coordinates (x, y, z-or-layer...), level and sample index (null: 0).
/// Out of range reads 0 in every channel present, missing alpha 1 (A10).
struct FetchRequest {
  base::LaneMask active = base::kAllLanes;
  std::array<const base::WaveRegister*, 3> coord{};  ///< int32: x, y, z, with the array layer after the last dimension
  const base::WaveRegister* lod = nullptr;
  const base::WaveRegister* sample = nullptr;
  std::array<const base::WaveRegister*, 3> offset{};
};
void fetch(const ImageView& view, const FetchRequest& request, const SampleResult& result);
void fetch_buffer(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                  const SampleResult& result);

/// What is stored, by component; null: 0.
using StoredValue = std::array<const base::WaveRegister*, 4>;

/// imageStore (part B conversions): out of range is dropped. Lanes are stored in increasing order.
void store(const ImageView& view, const FetchRequest& request, const StoredValue& value);
void store_buffer(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                  const StoredValue& value);

/// Address of a texel for image atomics, null where out of range or of another size than `bytes`; lane by lane, by the
/// caller.
std::byte* texel_address(const ImageView& view, std::uint32_t bytes, const std::array<std::int32_t, 3>& coord,
                         std::uint32_t sample);

/// OpImageQuerySize(Lod): components as the instruction returns them (layers last).
std::array<std::uint32_t, 3> query_size(const ImageView& view, std::int32_t lod);

}  // namespace vitrine::texel
