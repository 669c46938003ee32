// Texels that an image view or texel buffer does not have, and images that are not there.
#include <algorithm>
#include <optional>
#include <string>

#include "glass/sanitize/checks.h"
#include "glass/sanitize/descriptors.h"
#include "glass/sanitize/image_lanes.h"
#include "glass/sanitize/lane_tests.h"
#include "texel/sampler.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::Descriptor;
using spirv::ImageOp;
using spirv::Instruction;
using spirv::InstructionNote;
using spirv::Wave;
using spirv::ir::ImageAccess;
using spirv::ir::ImageDim;
using spirv::ir::ImageOperand;

/// Queries of sizes are left out: a view always has one.
bool names_texels(ImageAccess access) {
  return access == ImageAccess::kFetch || access == ImageAccess::kRead || access == ImageAccess::kWrite ||
         access == ImageAccess::kAtomic;
}

bool has_sampler(const spirv::ir::ImageInfo& info) {
  const bool samples = info.access == ImageAccess::kSample || info.access == ImageAccess::kGather ||
                       info.access == ImageAccess::kQueryLod;
  return samples && !info.combined && info.immutable_sampler == nullptr;
}

const char* verb_of(ImageAccess access) {
  return access == ImageAccess::kWrite    ? "store to "
         : access == ImageAccess::kAtomic ? "atomic operation on "
                                          : "load of ";
}

/// Checks one instruction.
class ImageCheck {
 public:
  ImageCheck(Reporter& reporter, const Wave& wave, const Instruction* i, const InstructionNote& note)
      : reporter_(reporter),
        wave_(wave),
        i_(i),
        note_(note),
        op_(wave.program->image_ops[i->extra[0]]),
        lanes_(wave, op_) {}

  void run();

 private:
  std::optional<std::int32_t> operand(ImageOperand which, std::uint32_t component, std::size_t lane) const {
    return lanes_.operand(which, component, lane);
  }
  std::uint32_t dimensions() const { return lanes_.dimensions(); }
  std::int64_t coordinate(std::uint32_t component, std::size_t lane) const {
    return lanes_.coordinate(component, lane);
  }
  /// Texels, and layers behind them, of the level that a lane names.
  std::array<std::uint32_t, 3> size_of(const texel::ImageView& view, std::size_t lane) const {
    auto size = texel::query_size(view, operand(ImageOperand::kLod, 0, lane).value_or(0));
    if (op_.info.dim == ImageDim::kCube) size[2] = view.layer_count;
    return size;
  }
  bool is_outside(const texel::ImageView& view, std::size_t lane) const;
  bool is_outside(const texel::BufferTexelView& view, std::size_t lane) const {
    const std::int64_t at = coordinate(0, lane);
    return at < 0 || static_cast<std::uint64_t>(at) >= view.count;
  }
  bool all_inside(const Descriptor& image, std::size_t first_lane) const;
  std::string texel_text(std::size_t lane) const;
  std::string size_text(const texel::ImageView& view, std::size_t lane) const;
  static std::string size_text(const texel::BufferTexelView& view) {
    return "a texel buffer of " + std::to_string(view.count) + " texels";
  }
  void check_texels(const Descriptor& image, std::uint32_t element, base::LaneMask lanes);
  void check_sampler();

  Reporter& reporter_;
  const Wave& wave_;
  const Instruction* const i_;
  const InstructionNote& note_;
  const ImageOp& op_;
  const ImageLanes lanes_;
};

bool ImageCheck::is_outside(const texel::ImageView& view, std::size_t lane) const {
  const std::int32_t level = operand(ImageOperand::kLod, 0, lane).value_or(0);
  if (level < 0 || static_cast<std::uint32_t>(level) >= view.level_count) return true;
  const std::int32_t sample = operand(ImageOperand::kSample, 0, lane).value_or(0);
  if (sample < 0 || static_cast<std::uint32_t>(sample) >= view.samples) return true;
  const auto size = size_of(view, lane);
  for (std::uint32_t c = 0; c < std::min(dimensions(), 3u); ++c) {
    const std::int64_t at = coordinate(c, lane);
    if (at < 0 || at >= size[c]) return true;
  }
  return false;
}

/// Whether all lanes, active or not, are inside, as far as that can be told of all of them together.
bool ImageCheck::all_inside(const Descriptor& image, std::size_t first_lane) const {
  if (lanes_.column(ImageOperand::kSample, 0) != nullptr || lanes_.column(ImageOperand::kOffset, 0) != nullptr)
    return false;
  std::array<std::uint32_t, 3> size{};
  if (op_.info.dim == ImageDim::kBuffer) {
    size[0] = static_cast<std::uint32_t>(std::min<std::uint64_t>(image.texels->count, 1u << 31));
  } else {
    if (const std::uint32_t* const level = lanes_.column(ImageOperand::kLod, 0)) {
      const std::uint32_t first = level[first_lane];
      const bool several = any_lane([=](std::uint32_t other) { return other != first; }, level);
      if (several || first >= image.image->level_count) return false;
    }
    size = size_of(*image.image, first_lane);
  }
  for (std::uint32_t c = 0; c < std::min(dimensions(), 3u); ++c) {
    const std::uint32_t* const at = lanes_.column(ImageOperand::kCoord, c);
    if (at == nullptr || any_lane([end = size[c]](std::uint32_t x) { return x >= end; }, at)) return false;
  }
  return true;
}

std::string ImageCheck::texel_text(std::size_t lane) const {
  std::string text = std::string(verb_of(op_.info.access)) + "texel (";
  const std::uint32_t count = std::min(dimensions(), 3u);
  for (std::uint32_t c = 0; c < count; ++c) text += (c == 0 ? "" : ", ") + std::to_string(coordinate(c, lane));
  text += ")";
  if (const auto level = operand(ImageOperand::kLod, 0, lane); level.value_or(0) != 0)
    text += " of level " + std::to_string(*level);
  if (const auto sample = operand(ImageOperand::kSample, 0, lane); sample.value_or(0) != 0)
    text += ", sample " + std::to_string(*sample);
  return text;
}

std::string ImageCheck::size_text(const texel::ImageView& view, std::size_t lane) const {
  const std::int32_t level = operand(ImageOperand::kLod, 0, lane).value_or(0);
  if (level < 0 || static_cast<std::uint32_t>(level) >= view.level_count)
    return "an image of " + std::to_string(view.level_count) + " levels";
  const auto texels = size_of(view, lane);
  std::string size = "an image of ";
  for (std::uint32_t c = 0; c < std::min(dimensions(), 3u); ++c)
    size += (c == 0 ? "" : " x ") + std::to_string(texels[c]);
  return size;
}

void ImageCheck::check_texels(const Descriptor& image, std::uint32_t element, base::LaneMask lanes) {
  const bool buffer = op_.info.dim == ImageDim::kBuffer;
  if (all_inside(image, static_cast<std::size_t>(std::countr_zero(lanes)))) return;
  base::LaneMask wrong = 0;
  base::for_each_lane(lanes & wave_.live, [&](std::size_t lane) {
    if (buffer ? is_outside(*image.texels, lane) : is_outside(*image.image, lane)) wrong |= base::LaneMask{1} << lane;
  });
  if (wrong == 0) return;
  reporter_.report(
      wave_, i_, note_, buffer ? "out-of-bounds-texel-buffer" : "out-of-bounds-image", wrong, [&](std::size_t lane) {
        const std::string size = buffer ? size_text(*image.texels) : size_text(*image.image, lane);
        return texel_text(lane) + ", outside of " + resource_text(wave_, op_.info.set, op_.info.slot + element, size);
      });
}

/// A sampler apart from the image that is gone.
void ImageCheck::check_sampler() {
  const spirv::ir::ImageInfo& info = op_.info;
  const spirv::ObservedCommand* command = wave_.resources->command;
  if (!has_sampler(info) || command == nullptr) return;
  for_each_element(wave_, op_.sampler_index, [&](std::uint32_t element, base::LaneMask lanes) {
    if (element != 0 && element >= info.sampler_count) return;
    const Descriptor* const found = spirv::exec::find_descriptor(wave_, info.sampler_set, info.sampler_slot + element);
    if (found == nullptr || found->sampler != nullptr || (lanes & wave_.live) == 0) return;
    if (command->departed(info.sampler_set, info.sampler_slot + element).empty()) return;
    report_descriptor(reporter_, wave_, i_, note_, info.sampler_set, info.sampler_slot, element, info.sampler_count,
                      lanes & wave_.live);
  });
}

void ImageCheck::run() {
  const spirv::ir::ImageInfo& info = op_.info;
  if (info.set == spirv::ir::kAnySet || info.access == ImageAccess::kSubpass) return;
  for_each_image(wave_, op_, [&](const Descriptor* image, std::uint32_t element, base::LaneMask lanes) {
    if (image == nullptr) {
      if (const base::LaneMask real = lanes & wave_.live)
        report_descriptor(reporter_, wave_, i_, note_, info.set, info.slot, element, info.count, real);
    } else if (names_texels(info.access)) {
      check_texels(*image, element, lanes);
    }
  });
  check_sampler();
}

}  // namespace

void check_image(Reporter& reporter, const Wave& wave, const Instruction* i, const InstructionNote& note) {
  ImageCheck(reporter, wave, i, note).run();
}

}  // namespace vitrine::glass::sanitize
