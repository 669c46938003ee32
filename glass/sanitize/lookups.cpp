// See lookups.h.
#include "glass/sanitize/lookups.h"

#include <bit>

namespace vitrine::glass::sanitize {

using spirv::Descriptor;
using spirv::ir::ImageAccess;
using spirv::ir::ImageDim;
using spirv::ir::ImageOperand;

bool has_dimension(ImageDim dim, VkImageViewType type) {
  using enum ImageDim;
  static constexpr ImageDim kDimensions[] = {k1D, k2D, k3D, kCube, k1D, k2D, kCube};  // by VkImageViewType
  return dim == kDimensions[type];
}

Lookup lookup_of(const spirv::ImageOp& op, const ImageLanes& operands, std::size_t lane) {
  const auto number = [&](ImageOperand which, std::uint32_t c) {
    return std::bit_cast<float>(operands.operand(which, c, lane).value_or(0));
  };
  Lookup lookup;
  const std::uint32_t dims = spirv::ir::coordinate_components(op.info.dim);
  for (std::uint32_t c = 0; c < dims; ++c) {
    lookup.at[c] = number(ImageOperand::kCoord, c);
    lookup.offset[c] = operands.operand(ImageOperand::kOffset, c, lane).value_or(0);
  }
  if (op.info.arrayed) lookup.layer = number(ImageOperand::kCoord, dims);
  lookup.gather = op.info.access == ImageAccess::kGather;
  if (operands.operand(ImageOperand::kLod, 0, lane)) {
    lookup.lod = number(ImageOperand::kLod, 0);
  } else if (op.info.explicit_lod_zero) {
    lookup.lod = 0.0f;
  }
  return lookup;
}

const texel::Sampler* sampler_of(const spirv::Wave& wave, const spirv::ImageOp& op, const Descriptor& image,
                                 std::size_t lane) {
  if (op.info.immutable_sampler != nullptr) return op.info.immutable_sampler;
  if (op.info.combined) return image.sampler;
  const std::uint32_t element = element_of(wave, op.sampler_index, lane);
  if (element != 0 && element >= op.info.sampler_count) return nullptr;
  const Descriptor* sampler = spirv::exec::find_descriptor(wave, op.info.sampler_set, op.info.sampler_slot + element);
  return sampler ? sampler->sampler : nullptr;
}

}  // namespace vitrine::glass::sanitize
