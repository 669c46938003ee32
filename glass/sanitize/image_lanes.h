// Operands of image instructions by lane, and the descriptors that the lanes use.
#pragma once

#include <algorithm>
#include <bit>
#include <optional>

#include "spirv/exec/buffers.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::sanitize {

/// The array element that a lane names.
inline std::uint32_t element_of(const spirv::Wave& wave, const spirv::IndexOperand& index, std::size_t lane) {
  using File = spirv::IndexOperand::File;
  if (index.file == File::kConstant) return 0;
  return spirv::exec::word_of(wave, {index.file == File::kUniform ? 'u' : 'r', index.value}, lane);
}

/// Calls f(element, lanes) for each array element that active lanes name.
template <class F>
void for_each_element(const spirv::Wave& wave, const spirv::IndexOperand& index, F&& f) {
  for (base::LaneMask remaining = wave.active; remaining != 0;) {
    const std::uint32_t element = element_of(wave, index, static_cast<std::size_t>(std::countr_zero(remaining)));
    base::LaneMask lanes = remaining;
    if (index.file == spirv::IndexOperand::File::kVarying)
      base::for_each_lane(remaining, [&](std::size_t lane) {
        if (element_of(wave, index, lane) != element) lanes &= ~(base::LaneMask{1} << lane);
      });
    remaining &= ~lanes;
    f(element, lanes);
  }
}

/// Calls f(descriptor, element, lanes) for each image among the active lanes; null: there is none.
template <class F>
void for_each_image(const spirv::Wave& wave, const spirv::ImageOp& op, F&& f) {
  for_each_element(wave, op.image_index, [&](std::uint32_t element, base::LaneMask lanes) {
    const bool in_range = element == 0 || element < op.info.count;
    const spirv::Descriptor* image =
        in_range ? spirv::exec::find_descriptor(wave, op.info.set, op.info.slot + element) : nullptr;
    const bool buffer = op.info.dim == spirv::ir::ImageDim::kBuffer;
    const bool missing = image == nullptr || (buffer ? image->texels == nullptr : image->image == nullptr);
    f(missing ? nullptr : image, element, lanes);
  });
}

/// The operands of one instruction.
class ImageLanes {
 public:
  ImageLanes(const spirv::Wave& wave, const spirv::ImageOp& op) : wave_(wave), op_(op) {}

  std::optional<std::int32_t> operand(spirv::ir::ImageOperand which, std::uint32_t component, std::size_t lane) const {
    const std::uint32_t offset = op_.operand[static_cast<std::size_t>(which)][component];
    if (offset == spirv::kNoOperand) return std::nullopt;
    return static_cast<std::int32_t>(spirv::exec::word_of(wave_, {'r', offset}, lane));
  }
  /// An operand in all lanes; null: there is none.
  const std::uint32_t* column(spirv::ir::ImageOperand which, std::uint32_t component) const {
    const std::uint32_t offset = op_.operand[static_cast<std::size_t>(which)][component];
    if (offset == spirv::kNoOperand) return nullptr;
    return reinterpret_cast<const base::WaveRegister*>(wave_.registers + offset)->lane;
  }
  /// Coordinates, the array layer or face included.
  std::uint32_t dimensions() const {
    const spirv::ir::ImageInfo& info = op_.info;
    return spirv::ir::coordinate_components(info.dim) + (info.arrayed && info.dim != spirv::ir::ImageDim::kCube);
  }
  /// The texel of a lane: a coordinate with its offset.
  std::int64_t coordinate(std::uint32_t component, std::size_t lane) const {
    using spirv::ir::ImageOperand;
    return std::int64_t{operand(ImageOperand::kCoord, component, lane).value_or(0)} +
           operand(ImageOperand::kOffset, std::min(component, 2u), lane).value_or(0);
  }

 private:
  const spirv::Wave& wave_;
  const spirv::ImageOp& op_;
};

}  // namespace vitrine::glass::sanitize
