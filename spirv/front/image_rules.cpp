// What image instructions need of their image and operands (SPIR-V 3.42.10, Image Instructions; 3.14, Image Operands):
// what texel has no answer to is refused.
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using ir::ImageAccess;
using ir::ImageDim;
using ir::ImageOperand;

bool has(const ir::ImageInfo& info, ImageOperand operand) {
  return (info.operands >> static_cast<unsigned>(operand) & 1) != 0;
}

bool is_sampled(ImageAccess access) {
  return access == ImageAccess::kSample || access == ImageAccess::kGather || access == ImageAccess::kQueryLod;
}

void check_sampling(const Inst& inst, const ir::ImageInfo& info) {
  if (!info.combined && info.sampler_count == 0) fail(inst, "the image comes without a sampler");
  if (info.dim == ImageDim::kBuffer || info.dim == ImageDim::kSubpass || info.multisampled)
    fail(inst, "the image cannot be sampled");
  if (has(info, ImageOperand::kDref) && info.dim == ImageDim::k3D)
    fail(inst, "images of three dimensions have no depth comparison");
  if (info.access != ImageAccess::kGather) return;
  if (info.dim != ImageDim::k2D && info.dim != ImageDim::kCube) fail(inst, "images of this dimension are not gathered");
  if (info.gather_component > 3) fail(inst, "component to gather is out of range");
}

void check_query(const Inst& inst, const ir::ImageInfo& info, std::uint32_t components) {
  const bool buffer = info.dim == ImageDim::kBuffer;
  if (buffer && (info.access != ImageAccess::kQuerySize || has(info, ImageOperand::kLod)))
    fail(inst, "texel buffers have neither levels nor samples");
  if (components > 3) fail(inst, "an image does not have as many dimensions");
}

void check_operands(const Inst& inst, const ir::ImageInfo& info) {
  const bool sample = info.access == ImageAccess::kSample, gather = info.access == ImageAccess::kGather;
  const bool level = sample || info.access == ImageAccess::kFetch || info.access == ImageAccess::kQuerySize;
  if (has(info, ImageOperand::kLod) && !level) fail(inst, "Lod is not an operand of this instruction");
  for (const ImageOperand operand : {ImageOperand::kBias, ImageOperand::kGradX, ImageOperand::kMinLod})
    if (has(info, operand) && !sample) fail(inst, "image operand does not belong to this instruction");
  const bool offset = has(info, ImageOperand::kOffset) || info.has_gather_offsets;
  if (offset && (info.dim == ImageDim::kCube || info.dim == ImageDim::kBuffer))
    fail(inst, "images of this dimension have no offsets");
  if (info.has_gather_offsets && !gather) fail(inst, "ConstOffsets is an operand of gathers only");
}

}  // namespace

void check_image(const Inst& inst, const ir::ImageInfo& info, std::uint32_t components) {
  switch (info.access) {
    case ImageAccess::kQuerySize:
    case ImageAccess::kQueryLevels:
    case ImageAccess::kQuerySamples:
      check_query(inst, info, components);
      break;
    case ImageAccess::kFetch:
      if (info.dim == ImageDim::kCube) fail(inst, "texels of cubes are not fetched");
      break;
    case ImageAccess::kWrite:
    case ImageAccess::kAtomic:
      if (info.dim == ImageDim::kSubpass) fail(inst, "input attachments are not written");
      break;
    default:
      if (is_sampled(info.access)) check_sampling(inst, info);
      break;
  }
  check_operands(inst, info);
}

}  // namespace vitrine::spirv::front
