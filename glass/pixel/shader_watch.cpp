// See shader_watch.h. Images are found by the addresses of their texels.
#include "glass/pixel/shader_watch.h"

#include <algorithm>
#include <bit>

#include "glass/pixel/inputs.h"
#include "glass/pixel/tile_watch.h"
#include "glass/sanitize/footprint.h"
#include "glass/sanitize/image_lanes.h"
#include "spirv/exec/invocation.h"

namespace vitrine::glass::pixel {
namespace {

using sanitize::ImageLanes;
using spirv::Descriptor;
using spirv::ImageOp;
using spirv::Instruction;
using spirv::InstructionNote;
using spirv::Wave;
using spirv::ir::ImageAccess;
using spirv::ir::ImageDim;
using spirv::ir::ImageOperand;

/// Texels that one fragment's history tells of.
constexpr std::size_t kMostSources = 32;

bool stores(ImageAccess access) { return access == ImageAccess::kWrite || access == ImageAccess::kAtomic; }

/// Coordinates in front of the array layer.
std::uint32_t dimensions_of(VkImageViewType type) {
  if (type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY) return 1;
  return type == VK_IMAGE_VIEW_TYPE_3D ? 3 : 2;
}

bool has_layers(VkImageViewType type) {
  return type != VK_IMAGE_VIEW_TYPE_1D && type != VK_IMAGE_VIEW_TYPE_2D && type != VK_IMAGE_VIEW_TYPE_3D;
}

/// A texel of a view; null: the view does not have it.
const std::byte* block_at(const texel::ImageView& view, std::int64_t level, std::int64_t layer, std::int64_t sample,
                          const std::array<std::int64_t, 3>& at) {
  const auto inside = [](std::int64_t number, std::uint32_t size) { return number >= 0 && number < size; };
  if (!inside(level, view.level_count) || !inside(layer, view.layer_count)) return nullptr;
  if (!inside(sample, std::max(view.samples, 1u))) return nullptr;
  const texel::Extent& extent = view.level[static_cast<std::size_t>(level)].extent;
  if (!inside(at[0], extent.width) || !inside(at[1], extent.height) || !inside(at[2], extent.depth)) return nullptr;
  const auto number = [](std::int64_t value) { return static_cast<std::uint32_t>(value); };
  return view.block(number(level), number(layer), number(sample), number(at[0]) / view.format->block_width,
                    number(at[1]) / view.format->block_height, number(at[2]));
}

/// The texel that an instruction names in a lane.
const std::byte* block_of(const texel::ImageView& view, const ImageLanes& operands, std::size_t lane) {
  const std::uint32_t dims = dimensions_of(view.type);
  std::array<std::int64_t, 3> at{};
  for (std::uint32_t c = 0; c < dims; ++c) at[c] = operands.coordinate(c, lane);
  const std::int64_t layer = has_layers(view.type) ? operands.operand(ImageOperand::kCoord, dims, lane).value_or(0) : 0;
  return block_at(view, operands.operand(ImageOperand::kLod, 0, lane).value_or(0), layer,
                  operands.operand(ImageOperand::kSample, 0, lane).value_or(0), at);
}

sanitize::Lookup lookup_of(const ImageOp& op, const ImageLanes& operands, std::size_t lane) {
  const auto number = [&](ImageOperand which, std::uint32_t c) {
    return std::bit_cast<float>(operands.operand(which, c, lane).value_or(0));
  };
  sanitize::Lookup lookup;
  const std::uint32_t dims = spirv::ir::coordinate_components(op.info.dim);
  for (std::uint32_t c = 0; c < dims; ++c) {
    lookup.at[c] = number(ImageOperand::kCoord, c);
    lookup.offset[c] = operands.operand(ImageOperand::kOffset, c, lane).value_or(0);
  }
  if (op.info.arrayed) lookup.layer = number(ImageOperand::kCoord, dims);
  lookup.gather = op.info.access == ImageAccess::kGather;
  if (operands.operand(ImageOperand::kLod, 0, lane))
    lookup.lod = number(ImageOperand::kLod, 0);
  else if (op.info.explicit_lod_zero)
    lookup.lod = 0.0f;
  return lookup;
}

const texel::Sampler* sampler_of(const Wave& wave, const ImageOp& op, const Descriptor& image, std::size_t lane) {
  if (op.info.immutable_sampler != nullptr) return op.info.immutable_sampler;
  if (op.info.combined) return image.sampler;
  const std::uint32_t element = sanitize::element_of(wave, op.sampler_index, lane);
  if (element != 0 && element >= op.info.sampler_count) return nullptr;
  const Descriptor* const found =
      spirv::exec::find_descriptor(wave, op.info.sampler_set, op.info.sampler_slot + element);
  return found != nullptr ? found->sampler : nullptr;
}

}  // namespace

class PixelProgram::Watch final : public spirv::exec::Watch {
 public:
  Watch(PixelProgram& program, const Wave& wave, TileWatch* tile)
      : program_(program), invocations_(wave), tile_(tile) {}
  ~Watch() override { program_.pixels_.add(std::move(pending_)); }

  void access(const Wave& wave, const Instruction* i, const InstructionNote& note) override {
    if (note.access != spirv::Access::kImage) return;
    const ImageOp& op = wave.program->image_ops[i->extra[0]];
    const bool store = stores(op.info.access);
    if (op.info.set == spirv::ir::kAnySet || op.info.dim == ImageDim::kBuffer || (!store && tile_ == nullptr)) return;
    sanitize::for_each_image(wave, op, [&](const Descriptor* image, std::uint32_t, base::LaneMask lanes) {
      lanes &= wave.live;
      if (image == nullptr || image->image->planes != nullptr) return;
      if (store)
        stores_to(wave, op, *image->image, lanes, note);
      else
        reads_from(wave, op, *image, lanes, note);
    });
  }

  void discard(const Wave& wave, const Instruction* i, const InstructionNote& note) override {
    if (tile_ == nullptr) return;
    base::for_each_lane(spirv::exec::discarded_lanes(wave, i), [&](std::size_t lane) {
      if (Fragment* const fragment = tile_->fragment_of(lane))
        fragment->discarded = program_.context_.address(wave, {}, note.origin.spirv_id, note.origin.place);
    });
  }

 private:
  void stores_to(const Wave& wave, const ImageOp& op, const texel::ImageView& view, base::LaneMask lanes,
                 const InstructionNote& note);
  void reads_from(const Wave& wave, const ImageOp& op, const Descriptor& image, base::LaneMask lanes,
                  const InstructionNote& note);
  void add_source(Fragment& fragment, const std::byte* block, const texel::FormatDesc& format) {
    if (block == nullptr || fragment.sources.size() >= kMostSources) return;
    Source source = program_.pixels_.source_at(block, format, 0);
    const bool known = std::ranges::any_of(fragment.sources, [&](const Source& s) { return s.texel == source.texel; });
    if (source.texel.image != 0 && !known) fragment.sources.push_back(source);
  }

  PixelProgram& program_;
  const spirv::exec::Invocations invocations_;
  TileWatch* const tile_;  ///< null: no fragment of the wave is on a watched pixel
  std::vector<Pending> pending_;
  std::uint32_t stored_ = 0;  ///< stores of the wave so far
};

void PixelProgram::Watch::stores_to(const Wave& wave, const ImageOp& op, const texel::ImageView& view,
                                    base::LaneMask lanes, const InstructionNote& note) {
  const ImageLanes operands(wave, op);
  ++stored_;
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const std::byte* const block = block_of(view, operands, lane);
    Texel* const texel = block != nullptr ? program_.pixels_.find(block) : nullptr;
    if (texel == nullptr || wave.resources->command == nullptr) return;
    const auto id = invocations_(wave, lane);
    Pending pending{wave.resources->command->owner, texel, {id[2], id[1], id[0], stored_}, true, {}};
    Event& event = pending.event;
    const bool atomic = op.info.access == ImageAccess::kAtomic;
    event.kind = atomic ? EventKind::kShaderAtomic : EventKind::kShaderStore;
    event.text = atomic ? "atomic operation of a shader" : "store of a shader";
    event.address = program_.context_.address(wave, id, note.origin.spirv_id, note.origin.place);
    std::array<std::uint32_t, 4> value{};
    std::size_t count = 0;
    for (; count < 4 && operands.column(ImageOperand::kValue, static_cast<std::uint32_t>(count)); ++count)
      value[count] = operands.column(ImageOperand::kValue, static_cast<std::uint32_t>(count))[lane];
    const texel::Kind kind = view.format->kind;
    if (count != 0)
      event.facts.emplace_back("value", op.info.wide ? wide_text(value[0] | std::uint64_t{value[1]} << 32, kind)
                                                     : to_text(value, count, kind));
    pending_.push_back(std::move(pending));
  });
}

void PixelProgram::Watch::reads_from(const Wave& wave, const ImageOp& op, const Descriptor& image, base::LaneMask lanes,
                                     const InstructionNote&) {
  const texel::ImageView& view = *image.image;
  const ImageLanes operands(wave, op);
  base::for_each_lane(lanes, [&](std::size_t lane) {
    Fragment* const fragment = tile_->fragment_of(lane);
    if (fragment == nullptr) return;
    switch (op.info.access) {
      case ImageAccess::kSample:
      case ImageAccess::kGather: {
        const texel::Sampler* const sampler = sampler_of(wave, op, image, lane);
        if (sampler == nullptr || op.info.has_gather_offsets) return;
        sanitize::all_of_footprint(view, *sampler, lookup_of(op, operands, lane), [&](const std::byte* block) {
          add_source(*fragment, block, *view.format);
          return true;
        });
        return;
      }
      case ImageAccess::kFetch:
      case ImageAccess::kRead:
        return add_source(*fragment, block_of(view, operands, lane), *view.format);
      case ImageAccess::kSubpass: {
        const std::array<std::int64_t, 3> at{fragment->pixel->x, fragment->pixel->y, 0};
        const std::int64_t sample = operands.operand(ImageOperand::kSample, 0, lane).value_or(0);
        return add_source(*fragment, block_at(view, 0, 0, sample, at), *view.format);
      }
      default:
        return;
    }
  });
}

PixelProgram::PixelProgram(Pixels& pixels, const ShaderIdentity& shader, const spirv::Program& program)
    : pixels_(pixels),
      context_(shader, program),
      stores_(std::ranges::any_of(program.image_ops, [](const ImageOp& op) { return stores(op.info.access); })) {}

std::unique_ptr<spirv::exec::Watch> PixelProgram::watch(const Wave& wave, const Instruction*) {
  TileWatch* tile = context_.stage == VK_SHADER_STAGE_FRAGMENT_BIT ? TileWatch::current() : nullptr;
  if (tile != nullptr && !tile->runs_watched()) tile = nullptr;
  if (pixels_.stopped() || (tile == nullptr && !stores_)) return nullptr;
  if (tile != nullptr)
    base::for_each_lane(wave.active, [&](std::size_t lane) {
      if (Fragment* const fragment = tile->fragment_of(lane))
        fragment->inputs = inputs_text(wave.program->observation->interface, *wave.program, [&](std::uint32_t reg) {
          return std::optional(spirv::exec::word_of(wave, {'r', reg * spirv::kRegisterStride}, lane));
        });
    });
  return std::make_unique<Watch>(*this, wave, tile);
}

}  // namespace vitrine::glass::pixel
