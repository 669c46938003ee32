// From an instruction that is about to run to the bytes that its lanes touch.
#include "glass/sanitize/accesses.h"
#include "glass/sanitize/lookups.h"
#include "glass/sanitize/operands.h"
#include "glass/sanitize/texel_address.h"
#include "glass/sync/shader_accesses.h"

namespace vitrine::glass::sync {
namespace {

using sanitize::Words;
using spirv::Instruction;
using spirv::InstructionNote;
using spirv::MemoryOp;
using spirv::MemorySpace;
using spirv::Wave;

/// One instruction.
class Recorder {
 public:
  Recorder(Touches& touches, std::uint32_t site, const Wave& wave, const Instruction* i, const InstructionNote& note)
      : touches_(touches),
        site_(site),
        bytes_(touches.bytes[site]),
        wave_(wave),
        i_(i),
        note_(note),
        lanes_(wave.active & wave.live) {}

  void memory() {
    const MemoryOp& row = wave_.program->memory_ops[i_->extra[0]];
    note_.space == MemorySpace::kGlobal ? global(row) : buffer(row);
  }
  void image();

 private:
  void buffer(const MemoryOp& row);
  void global(const MemoryOp& row);
  void texels(const spirv::Descriptor& image, base::LaneMask lanes);
  void lookups(const spirv::Descriptor& image, base::LaneMask lanes);

  void nearest(const texel::ImageView& view, const texel::Sampler& sampler, const sanitize::Lookup& lookup,
               ByteSet& bytes);

  Touches& touches_;
  const std::uint32_t site_;
  ByteSet& bytes_;
  const Wave& wave_;
  const Instruction* const i_;
  const InstructionNote& note_;
  const base::LaneMask lanes_;
};

/// All lanes one element each, one behind the other.
bool is_row(const std::uint32_t* offsets, std::uint32_t bytes) {
  if (offsets == nullptr) return false;
  std::uint32_t wrong = 0;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) wrong |= offsets[lane] - offsets[0] - lane * bytes;
  return wrong == 0;
}

void Recorder::buffer(const MemoryOp& row) {
  const sanitize::Touched touched = sanitize::touched_by(row, note_.access);
  const Words offsets(wave_, {note_.files[1], i_->src[0]});
  const std::uint32_t size = row.element_bytes;
  spirv::exec::for_each_buffer(
      const_cast<Wave&>(wave_), row, lanes_, [&](const spirv::exec::Bytes& bytes, base::LaneMask same) {
        if (bytes.data == nullptr) return;
        const auto base = reinterpret_cast<std::uintptr_t>(bytes.data);
        const auto add = [&](std::uint64_t at, std::uint64_t count) {
          if (at + count <= bytes.size) bytes_.add(base + at, count);  // what lies outside is another tool's
        };
        const bool whole = same == base::kAllLanes && is_row(offsets.in_register(), size);
        for (std::uint32_t c = 0; c < touched.count; ++c) {
          if (whole || (offsets.is_uniform() && same != 0)) {
            add(std::uint64_t{offsets[0]} + touched.at[c], whole ? base::kWaveWidth * size : size);
            continue;
          }
          base::for_each_lane(same, [&](std::size_t lane) { add(offsets[lane] + touched.at[c], size); });
        }
      });
}

void Recorder::global(const MemoryOp& row) {
  const sanitize::Addresses addresses(wave_, *i_, note_);
  const sanitize::Touched touched = sanitize::touched_by(row, note_.access);
  base::for_each_lane(lanes_, [&](std::size_t l) {
    for (std::uint32_t c = 0; c < touched.count; ++c) {
      bytes_.add(addresses(l, touched.at[c]), row.element_bytes);
    }
  });
}

void Recorder::texels(const spirv::Descriptor& image, base::LaneMask lanes) {
  const spirv::ImageOp& op = wave_.program->image_ops[i_->extra[0]];
  const sanitize::ImageLanes operands(wave_, op);
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const sanitize::TexelBytes texel = sanitize::texel_bytes(image, op, operands, lane);
    bytes_.add(texel.address, texel.bytes);
  });
}

/// The nearest texel of a lookup, where it is known: the one that it certainly depends on.
void Recorder::nearest(const texel::ImageView& view, const texel::Sampler& sampler, const sanitize::Lookup& lookup,
                       ByteSet& bytes) {
  sanitize::all_of_footprint(view, sampler, lookup, [&](const std::byte* block) {
    bytes.add(reinterpret_cast<std::uintptr_t>(block), view.format->block_bytes);
    return false;
  });
}

void Recorder::lookups(const spirv::Descriptor& image, base::LaneMask lanes) {
  const spirv::ImageOp& op = wave_.program->image_ops[i_->extra[0]];
  const texel::ImageView& view = *image.image;
  if (!sanitize::has_dimension(op.info.dim, view.type) || op.info.has_gather_offsets) return;
  const sanitize::ImageLanes operands(wave_, op);
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const texel::Sampler* sampler = sanitize::sampler_of(wave_, op, image, lane);
    if (sampler == nullptr) return;
    sanitize::Lookup lookup = sanitize::lookup_of(op, operands, lane);
    if (lookup.lod || lookup.gather || view.level_count <= 1) return nearest(view, *sampler, lookup, bytes_);
    std::vector<ByteSet>& levels = touches_.levels[site_];
    if (levels.empty()) levels = std::vector<ByteSet>(texel::kMaxLevels);
    for (std::uint32_t level = 0; level < view.level_count; ++level) {
      lookup.lod = static_cast<float>(level) - sampler->mip_lod_bias;
      nearest(view, *sampler, lookup, levels[level]);
    }
  });
}

void Recorder::image() {
  const spirv::ImageOp& op = wave_.program->image_ops[i_->extra[0]];
  using spirv::ir::ImageAccess;
  const bool samples = op.info.access == ImageAccess::kSample || op.info.access == ImageAccess::kGather;
  sanitize::for_each_image(wave_, op, [&](const spirv::Descriptor* image, std::uint32_t, base::LaneMask lanes) {
    if (image == nullptr || (lanes & wave_.live) == 0) return;
    samples ? lookups(*image, lanes & wave_.live) : texels(*image, lanes & wave_.live);
  });
}

}  // namespace

void record_access(Touches& touches, const Sites& program, const Wave& wave, const Instruction* i,
                   const InstructionNote& note) {
  const std::uint32_t site = program.by_instruction[static_cast<std::size_t>(i - wave.program->code.data())];
  if (site == Sites::kNone || (wave.active & wave.live) == 0) return;
  Recorder recorder(touches, site, wave, i, note);
  note.access == spirv::Access::kImage ? recorder.image() : recorder.memory();
}

}  // namespace vitrine::glass::sync
