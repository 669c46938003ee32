// Image instructions (SPIR-V 3.42.10; Vulkan, Image Operations): gathers descriptors and operands into one Image
// instruction. Projection is applied here, as multiplication by the reciprocal like the reference does.
#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using ir::ImageAccess;
using ir::ImageDim;
using ir::ImageOperand;
using spv::Op;

const ImageHandle& handle_of(Translator& t, const Inst& inst, std::uint32_t id) {
  const auto found = t.images.find(id);
  if (found == t.images.end()) fail(inst, "operand is not an image that is supported");
  return found->second;
}

ImageDim dimension(const Type& image) {
  switch (image.dim) {
    case spv::Dim::Dim1D:
      return ImageDim::k1D;
    case spv::Dim::Dim2D:
      return ImageDim::k2D;
    case spv::Dim::Dim3D:
      return ImageDim::k3D;
    case spv::Dim::Cube:
      return ImageDim::kCube;
    case spv::Dim::Buffer:
      return ImageDim::kBuffer;
    case spv::Dim::SubpassData:
      return ImageDim::kSubpass;
    default:
      throw Failure("image dimension is not supported");
  }
}

/// Components of the coordinate of one texel: the faces of a cube are the layers of its array.
std::uint32_t texel_components(const ir::ImageInfo& info) {
  return coordinate_components(info.dim) + (info.arrayed && info.dim != ImageDim::kCube ? 1 : 0);
}

ir::ValueId first_components(Translator& t, ir::ValueId vector, std::uint32_t count) {
  if (is_boolean(t, vector)) throw Failure("image coordinate is not a number");
  if (components(t, vector) == count) return vector;
  if (components(t, vector) < count) throw Failure("image coordinate has too few components");
  std::vector<ir::Src> parts;
  for (std::uint8_t i = 0; i < count; i++) parts.push_back(splat(vector, i));
  return vec(t, std::move(parts), false);
}

/// The texel of a store as four components, missing ones 0: of numbers of 64 bits the words of the first.
ir::ValueId padded_texel(Translator& t, std::uint32_t id, bool wide) {
  std::vector<ir::Src> parts;
  if (wide) {
    const Expr number = number_of(t, id);
    if (number.width != 64) throw Failure("the texel is not as wide as those of the image");
    parts = {splat(number.id, 0), splat(number.high, 0)};
    for (int i = 0; i < 2; i++) parts.push_back(whole(constant_u32(t, 0)));
    return vec(t, std::move(parts), false);
  }
  const ir::ValueId texel = scalar_or_vector(t, id);
  for (std::uint8_t i = 0; i < 4; i++)
    parts.push_back(i < components(t, texel) ? splat(texel, i) : whole(constant_u32(t, 0)));
  return vec(t, std::move(parts), false);
}

/// Gather offsets: a constant array of four ivec2.
void set_gather_offsets(Translator& t, const Inst& inst, std::uint32_t id, ir::ImageInfo& info) {
  const Constant* offsets = t.module.constant(id);
  if (offsets == nullptr || offsets->words.size() != 8) fail(inst, "gather offsets are not constant");
  info.has_gather_offsets = true;
  for (std::size_t i = 0; i < 8; i++) info.gather_offsets[i / 2][i % 2] = static_cast<std::int32_t>(offsets->words[i]);
}

struct Request {
  ir::ImageInfo& info;
  ImageSources& sources;
};

/// The optional Image Operands from operand `at` on, in the order of their bits (SPIR-V 3.14).
void add_image_operands(Translator& t, const Inst& inst, std::uint32_t at, Request request) {
  if (!inst.has(at)) return;
  const std::uint32_t mask = inst.operand(at++);
  const std::uint32_t dimensions = coordinate_components(request.info.dim);
  auto next = [&](std::uint32_t count = 1) { return number(t, inst.operand(at++), count); };
  auto has = [&](spv::ImageOperandsMask bit) { return (mask & static_cast<std::uint32_t>(bit)) != 0; };
  using Mask = spv::ImageOperandsMask;
  if (has(Mask::Bias)) request.sources.add(ImageOperand::kBias, next());
  if (has(Mask::Lod)) request.sources.add(ImageOperand::kLod, next());
  if (has(Mask::Grad)) {
    request.sources.add(ImageOperand::kGradX, next(dimensions));
    request.sources.add(ImageOperand::kGradY, next(dimensions));
  }
  if (has(Mask::ConstOffset)) request.sources.add(ImageOperand::kOffset, next(dimensions));
  if (has(Mask::Offset)) request.sources.add(ImageOperand::kOffset, next(dimensions));
  if (has(Mask::ConstOffsets)) set_gather_offsets(t, inst, inst.operand(at++), request.info);
  if (has(Mask::Sample)) request.sources.add(ImageOperand::kSample, next());
  if (has(Mask::MinLod)) request.sources.add(ImageOperand::kMinLod, next());
  const auto supported = Mask::Bias | Mask::Lod | Mask::Grad | Mask::ConstOffset | Mask::Offset | Mask::ConstOffsets |
                         Mask::Sample | Mask::MinLod | Mask::MakeTexelAvailable | Mask::MakeTexelVisible |
                         Mask::NonPrivateTexel | Mask::VolatileTexel | Mask::SignExtend | Mask::ZeroExtend |
                         Mask::Nontemporal;
  if ((mask & ~static_cast<std::uint32_t>(supported)) != 0) fail(inst, "image operand is not supported");
}

/// Emits the Image instruction with `count` result components (0: none).
ir::ValueId finish(Translator& t, std::shared_ptr<ir::ImageInfo> info, ImageSources& sources, std::uint32_t count) {
  check_image(*t.inst, *info, count);
  std::vector<ir::Src> src = sources.take();
  ir::ValueId result = ir::kNoValue;
  if (count == 0)
    emit_effect(t, ir::Op::kImage, std::move(src));
  else
    result = emit(t, ir::Op::kImage, count, false, std::move(src));
  last_instr(t).image = std::move(info);
  return result;
}

/// The components of a texel of 64 bits that was read as it lies: its words, the other components, and the alpha that
/// it has not (Vulkan 1.3.239, Conversion to RGBA).
void set_wide_texel(Translator& t, const Inst& inst, ir::ValueId texel, std::uint32_t count) {
  const ir::ValueId zero = constant_u32(t, 0);
  const auto parts = [&](ir::Src first, ir::Src last) {
    std::vector<ir::Src> all{first, whole(zero), whole(zero), last};
    all.resize(count);
    return count == 1 ? extract(t, first.value, first.swizzle[0]) : vec(t, std::move(all), false);
  };
  set_value(t, inst, std::vector{parts(splat(texel, 0), splat(texel, 3)), parts(splat(texel, 1), whole(zero))});
}

/// What a fetch or a lookup of an image gives. Texels of 64 bits are looked up once for their low words and once for
/// their high ones.
void set_texels(Translator& t, const Inst& inst, std::shared_ptr<ir::ImageInfo> info, ImageSources& sources) {
  const std::uint32_t count = leaf_info(t, inst.result_type).components;
  if (!info->wide) return set_value(t, inst, finish(t, std::move(info), sources, count));
  std::vector<ir::ValueId> words;
  for (const ir::TexelWord word : {ir::TexelWord::kLow, ir::TexelWord::kHigh}) {
    auto of_word = std::make_shared<ir::ImageInfo>(*info);
    of_word->word = word;
    words.push_back(finish(t, std::move(of_word), sources, count));
  }
  set_value(t, inst, std::move(words));
}

struct SampleShape {
  bool dref = false, projective = false, explicit_lod = false, gather = false;
};

SampleShape shape_of(Op op) {
  switch (op) {
    case Op::OpImageSampleExplicitLod:
      return {false, false, true, false};
    case Op::OpImageSampleDrefImplicitLod:
      return {true, false, false, false};
    case Op::OpImageSampleDrefExplicitLod:
      return {true, false, true, false};
    case Op::OpImageSampleProjImplicitLod:
      return {false, true, false, false};
    case Op::OpImageSampleProjExplicitLod:
      return {false, true, true, false};
    case Op::OpImageSampleProjDrefImplicitLod:
      return {true, true, false, false};
    case Op::OpImageSampleProjDrefExplicitLod:
      return {true, true, true, false};
    case Op::OpImageGather:
      return {false, false, true, true};
    case Op::OpImageDrefGather:
      return {true, false, true, true};
    default:
      return {};
  }
}

/// Coordinates and reference divided by the component behind the coordinates.
void project(Translator& t, ir::ValueId full, ir::ValueId& coord, ir::ValueId& dref) {
  const auto last = static_cast<std::uint8_t>(components(t, coord));
  if (components(t, full) <= last) throw Failure("projective coordinate has too few components");
  const ir::ValueId inverse = emit(t, ir::Op::kFRcp, 1, false, {splat(full, last)});
  coord = emit(t, ir::Op::kFMul, last, false, {whole(coord), splat(inverse)});
  if (dref != ir::kNoValue) dref = emit(t, ir::Op::kFMul, 1, false, {whole(dref), whole(inverse)});
}

/// "The coordinates are relative to the fragment's own (x, y, layer)" (Vulkan, Image Operations: Texel Input). The
/// layer is that of the view; a view of an image without layers ignores it.
ir::ValueId own_texel(Translator& t, ir::ValueId offset) {
  const ir::ValueId own = fragment_position(t);
  std::vector<ir::Src> parts;
  for (std::uint8_t c = 0; c < 2; c++)
    parts.push_back(whole(emit(t, ir::Op::kIAdd, 1, false, {splat(own, c), splat(offset, c)})));
  parts.push_back(splat(own, 2));
  return vec(t, std::move(parts), false);
}

}  // namespace

void ImageSources::add(ImageOperand operand, ir::ValueId value) {
  if (value != ir::kNoValue) add(operand, whole(value));
}

void ImageSources::add(ImageOperand operand, ir::Src src) {
  info_.operands |= 1u << static_cast<unsigned>(operand);
  src_[static_cast<std::size_t>(operand)] = src;
}

std::vector<ir::Src> ImageSources::take() {
  std::vector<ir::Src> present;
  for (std::size_t i = 0; i < src_.size(); i++)
    if ((info_.operands >> i & 1) != 0) present.push_back(src_[i]);
  return present;
}

namespace {

/// Whether the Sampled Type is a number of 64 bits, an integer as it has to be.
bool has_wide_texels(Translator& t, const Type& image) {
  const Type& sampled = t.module.type(image.element);
  if (sampled.width != 64) return false;
  if (sampled.kind != Type::Kind::kInt) throw Failure("texels are not floats of 64 bits");
  return true;
}

}  // namespace

ir::ImageInfo image_info(Translator& t, const ImageHandle& handle) {
  ir::ImageInfo info;
  if (handle.image_type == 0) throw Failure("operand is a sampler, not an image");
  const Type& type = t.module.type(handle.image_type);
  if (type.kind != Type::Kind::kImage) throw Failure("operand is not an image");
  info.dim = dimension(type);
  if (type.dim == spv::Dim::SubpassData) t.function.interface.reads_attachment = true;
  info.arrayed = type.arrayed;
  info.multisampled = type.multisampled;
  info.wide = has_wide_texels(t, type);
  info.set = handle.image.set;
  info.slot = handle.image.slot;
  info.count = handle.image.count;
  info.sampler_set = handle.sampler.set;
  info.sampler_slot = handle.sampler.slot;
  info.sampler_count = handle.sampler.count;
  info.combined = handle.combined;
  info.in_quads = t.options.stage == VK_SHADER_STAGE_FRAGMENT_BIT ||
                  t.function.interface.derivative_group != DerivativeGroup::kNone;
  return info;
}

/// Components of texels of a declared format; 4 also where it is not told. "The image format ... must match" that of
/// the view (Vulkan 1.3.239, Image Operations Overview), so that a store has no others.
std::uint32_t components_of(spv::ImageFormat format) {
  using F = spv::ImageFormat;
  switch (format) {
    case F::R32f:
    case F::R16f:
    case F::R16:
    case F::R8:
    case F::R16Snorm:
    case F::R8Snorm:
    case F::R32i:
    case F::R16i:
    case F::R8i:
    case F::R32ui:
    case F::R16ui:
    case F::R8ui:
    case F::R64i:
    case F::R64ui:
      return 1;
    case F::Rg32f:
    case F::Rg16f:
    case F::Rg16:
    case F::Rg8:
    case F::Rg16Snorm:
    case F::Rg8Snorm:
    case F::Rg32i:
    case F::Rg16i:
    case F::Rg8i:
    case F::Rg32ui:
    case F::Rg16ui:
    case F::Rg8ui:
      return 2;
    case F::R11fG11fB10f:
      return 3;
    default:
      return 4;
  }
}

void add_elements(Translator& t, const ImageHandle& handle, ir::ImageInfo& info, ImageSources& sources) {
  auto choose = [&](ir::ValueId element, std::uint32_t& slot, std::uint32_t& count, ImageOperand operand) {
    if (element == ir::kNoValue) return 0u;
    const auto* words = constant_of(t, element);
    if (words == nullptr) {
      sources.add(operand, element);
      return 0u;
    }
    slot += (*words)[0];
    count -= (*words)[0];
    return (*words)[0];
  };
  choose(handle.image_element, info.slot, info.count, ImageOperand::kImageIndex);
  const std::uint32_t sampler =
      choose(handle.sampler_element, info.sampler_slot, info.sampler_count, ImageOperand::kSamplerIndex);
  const bool dynamic_sampler =
      handle.sampler_element != ir::kNoValue && constant_of(t, handle.sampler_element) == nullptr;
  if (handle.sampler.immutable_samplers != nullptr) {
    // A dynamic index may only pick among equal samplers; others are read from the descriptor, where they are too.
    if (!dynamic_sampler || handle.sampler.count == 1)
      info.immutable_sampler = handle.sampler.immutable_samplers[sampler];
  }
}

void sampled_image(Translator& t, const Inst& inst, ir::Op) {
  ImageHandle handle = handle_of(t, inst, inst.operand(0));
  const ImageHandle& sampler = handle_of(t, inst, inst.operand(1));
  handle.sampler = sampler.sampler;
  handle.sampler_element = sampler.sampler_element;
  handle.combined = false;
  t.images[inst.result] = handle;
}

void image_of_sampled(Translator& t, const Inst& inst, ir::Op) {
  t.images[inst.result] = handle_of(t, inst, inst.operand(0));
}

void image_sample(Translator& t, const Inst& inst, ir::Op) {
  const ImageHandle handle = handle_of(t, inst, inst.operand(0));
  const SampleShape shape = shape_of(inst.op);
  auto info = std::make_shared<ir::ImageInfo>(image_info(t, handle));
  ImageSources sources(*info);
  add_elements(t, handle, *info, sources);
  const ir::ValueId full = scalar_or_vector(t, inst.operand(1));
  ir::ValueId coord = first_components(t, full, coordinate_components(info->dim) + (info->arrayed ? 1 : 0));
  std::uint32_t next = 2;
  ir::ValueId dref = shape.dref ? number(t, inst.operand(next++)) : ir::kNoValue;
  if (shape.gather && !shape.dref) info->gather_component = t.module.constant_u32(inst.operand(next++), inst);
  if (shape.projective) project(t, full, coord, dref);
  info->access = shape.gather ? ImageAccess::kGather : ImageAccess::kSample;
  info->projective = shape.projective;
  info->explicit_lod_zero = !shape.explicit_lod && !info->in_quads;
  sources.add(ImageOperand::kCoord, coord);
  sources.add(ImageOperand::kDref, dref);
  add_image_operands(t, inst, next, {*info, sources});
  // An anisotropic sampler takes the derivatives of coordinates also where the level is explicit.
  const bool given = (info->operands >> static_cast<std::uint32_t>(ImageOperand::kGradX) & 1) != 0;
  if (info->in_quads && !given && !shape.gather) t.function.interface.needs_helpers = true;
  set_texels(t, inst, std::move(info), sources);
}

void image_access(Translator& t, const Inst& inst, ir::Op) {
  const ImageHandle handle = handle_of(t, inst, inst.operand(0));
  auto info = std::make_shared<ir::ImageInfo>(image_info(t, handle));
  ImageSources sources(*info);
  add_elements(t, handle, *info, sources);
  const bool write = inst.op == Op::OpImageWrite;
  const bool subpass = info->dim == ImageDim::kSubpass;
  info->access = write                         ? ImageAccess::kWrite
                 : subpass                     ? ImageAccess::kSubpass
                 : inst.op == Op::OpImageFetch ? ImageAccess::kFetch
                                               : ImageAccess::kRead;
  const ir::ValueId coord = scalar_or_vector(t, inst.operand(1));
  const ir::ValueId texel = first_components(t, coord, texel_components(*info));
  info->arrayed |= subpass;  // the view is the layer
  sources.add(ImageOperand::kCoord, subpass ? own_texel(t, texel) : texel);
  if (write) sources.add(ImageOperand::kValue, padded_texel(t, inst.operand(2), info->wide));
  add_image_operands(t, inst, write ? 3 : 2, {*info, sources});
  if (write) {
    t.function.interface.writes_memory = true;
    const bool wide = info->wide;
    finish(t, std::move(info), sources, 0);
    last_instr(t).data[0] = wide ? 2 : components_of(t.module.type(handle.image_type).format);
    return;
  }
  if (!info->wide || (info->access == ImageAccess::kFetch && info->dim != ImageDim::kBuffer))
    return set_texels(t, inst, std::move(info), sources);
  set_wide_texel(t, inst, finish(t, std::move(info), sources, 4), leaf_info(t, inst.result_type).components);
}

void image_query(Translator& t, const Inst& inst, ir::Op) {
  const ImageHandle handle = handle_of(t, inst, inst.operand(0));
  auto info = std::make_shared<ir::ImageInfo>(image_info(t, handle));
  ImageSources sources(*info);
  add_elements(t, handle, *info, sources);
  info->access = inst.op == Op::OpImageQueryLevels    ? ImageAccess::kQueryLevels
                 : inst.op == Op::OpImageQuerySamples ? ImageAccess::kQuerySamples
                                                      : ImageAccess::kQuerySize;
  if (inst.op == Op::OpImageQuerySizeLod) sources.add(ImageOperand::kLod, number(t, inst.operand(1)));
  const std::uint32_t count = leaf_info(t, inst.result_type).components;
  set_value(t, inst, finish(t, std::move(info), sources, count));
}

void image_query_lod(Translator& t, const Inst& inst, ir::Op) {
  const ImageHandle handle = handle_of(t, inst, inst.operand(0));
  auto info = std::make_shared<ir::ImageInfo>(image_info(t, handle));
  ImageSources sources(*info);
  add_elements(t, handle, *info, sources);
  info->access = ImageAccess::kQueryLod;
  t.function.interface.needs_helpers = true;
  const ir::ValueId coord = scalar_or_vector(t, inst.operand(1));
  sources.add(ImageOperand::kCoord, first_components(t, coord, coordinate_components(info->dim)));
  set_value(t, inst, finish(t, std::move(info), sources, 2));
}

void image_texel_pointer(Translator& t, const Inst& inst, ir::Op) {
  const Pointer& image = pointer_of(t, inst.operand(0));
  if (image.kind != Pointer::Kind::kDescriptor || image.descriptor_array)
    fail(inst, "operand is not a pointer to an image");
  Pointer pointer;
  pointer.kind = Pointer::Kind::kTexel;
  pointer.type = t.module.type(inst.result_type).element;
  const Type& type = t.module.type(image.type);
  if (type.kind != Type::Kind::kImage) fail(inst, "operand is not a pointer to an image");
  pointer.image.image_type = type.id;
  pointer.image.image = image.binding;
  pointer.image.image_element = image.element;
  const ir::ImageInfo info = image_info(t, pointer.image);
  pointer.coord = first_components(t, scalar_or_vector(t, inst.operand(1)), texel_components(info));
  if (type.multisampled) pointer.sample = number(t, inst.operand(2));
  t.pointers[inst.result] = std::move(pointer);
}

}  // namespace vitrine::spirv::front
