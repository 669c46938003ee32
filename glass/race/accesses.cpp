// See accesses.h.
#include "glass/race/accesses.h"

#include <algorithm>

#include "glass/sanitize/accesses.h"
#include "glass/sanitize/image_lanes.h"
#include "glass/sanitize/operands.h"
#include "glass/sanitize/texel_address.h"

namespace vitrine::glass::race {
namespace {

using sanitize::Words;
using spirv::Access;
using spirv::Instruction;
using spirv::InstructionNote;
using spirv::MemoryOp;
using spirv::MemorySpace;
using spirv::Wave;

/// What a store writes; null: the component is not written.
const std::uint32_t* values_of(const Wave& wave, const MemoryOp& row, std::uint32_t component) {
  if (row.data[component] == spirv::kNoOperand) return nullptr;
  return reinterpret_cast<const base::WaveRegister*>(wave.registers + row.data[component])->lane;
}

/// What one instruction does, lane by lane.
class Recorder {
 public:
  Recorder(Group& group, const Doing& by, const Wave& wave, const Instruction* i, const InstructionNote& note)
      : group_(group), by_(by), wave_(wave), i_(i), note_(note), lanes_(wave.active & wave.live) {}

  void memory(const Site& site);
  void image();

 private:
  /// Of the memory at `base`. `copied`: room for offsets that are nowhere.
  Span span_of(const MemoryOp& row, std::uint32_t (&copied)[base::kWaveWidth]) const;
  void buffer(const Span& span, const MemoryOp& row);
  void global(const Site& site, const MemoryOp& row);

  Group& group_;
  const Doing by_;
  const Wave& wave_;
  const Instruction* const i_;
  const InstructionNote& note_;
  const base::LaneMask lanes_;
};

Span Recorder::span_of(const MemoryOp& row, std::uint32_t (&copied)[base::kWaveWidth]) const {
  const Words offsets(wave_, {note_.files[1], i_->src[0]});
  Span span{by_, lanes_, {offsets.in_register(), 0}, 0, wave_.shared_size};
  if (offsets.is_uniform()) {
    span.offsets.lane_0 = offsets[0];
  } else if (span.offsets.words == nullptr) {
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) copied[lane] = offsets[lane];
    span.offsets.words = copied;
  }
  if (note_.access == Access::kStore)
    for (std::uint32_t c = 0; c < 4; ++c) span.values[c] = values_of(wave_, row, c);
  return span;
}

void Recorder::buffer(const Span& span, const MemoryOp& row) {
  spirv::exec::for_each_buffer(const_cast<Wave&>(wave_), row, lanes_,
                               [&](const spirv::exec::Bytes& bytes, base::LaneMask same) {
                                 if (bytes.data == nullptr) return;
                                 Span part = span;
                                 part.lanes = same;
                                 part.base = reinterpret_cast<std::uintptr_t>(bytes.data);
                                 part.size = bytes.size;
                                 group_.touch_span(part);
                               });
}

void Recorder::global(const Site& site, const MemoryOp& row) {
  const sanitize::Addresses addresses(wave_, *i_, note_);
  base::for_each_lane(lanes_, [&](std::size_t l) {
    for (std::uint32_t c = 0; c < site.touched.count; ++c) {
      const std::uint32_t* const values =
          note_.access == Access::kStore ? values_of(wave_, row, site.component[c]) : nullptr;
      group_.touch_bytes(by_, by_.wave[l], addresses(l, site.touched.at[c]), row.element_bytes,
                         values != nullptr ? values[l] : 0);
    }
  });
}

void Recorder::memory(const Site& site) {
  const MemoryOp& row = wave_.program->memory_ops[i_->extra[0]];
  if (lanes_ == 0) return;
  if (note_.space == MemorySpace::kGlobal) return global(site, row);
  std::uint32_t copied[base::kWaveWidth];
  const Span span = span_of(row, copied);
  site.memory == Memory::kShared ? group_.touch_shared(span) : buffer(span, row);
}

void Recorder::image() {
  const spirv::ImageOp& op = wave_.program->image_ops[i_->extra[0]];
  sanitize::for_each_image(wave_, op, [&](const spirv::Descriptor* image, std::uint32_t, base::LaneMask lanes) {
    if (image == nullptr) return;
    const sanitize::ImageLanes operands(wave_, op);
    base::for_each_lane(lanes & wave_.live, [&](std::size_t l) {
      const sanitize::TexelBytes texel = sanitize::texel_bytes(*image, op, operands, l);
      std::uint32_t value = 0;
      for (std::uint32_t c = 0; c < 4; ++c)
        if (op.operand[static_cast<std::size_t>(spirv::ir::ImageOperand::kValue)][c] != spirv::kNoOperand)
          value = value * 31 +
                  static_cast<std::uint32_t>(operands.operand(spirv::ir::ImageOperand::kValue, c, l).value_or(0));
      if (texel.bytes != 0) group_.touch_bytes(by_, by_.wave[l], texel.address, texel.bytes, value);
    });
  });
}

/// The offsets of an access to memory. False: they are booleans.
bool offsets_of(const Wave& wave, const spirv::OperandPlace& place, Offsets& offsets) {
  if (place.file == 'r') {
    offsets.words = reinterpret_cast<const base::WaveRegister*>(wave.registers + place.offset)->lane;
  } else if (place.file == 'm') {
    return false;
  } else {
    offsets.lane_0 = spirv::exec::word_of(wave, place, 0);
  }
  return true;
}

struct Range {
  std::uint64_t first = 0, end = 0;
};

/// What the descriptor of a site leads to, if it is known before the shader runs.
bool range_of(const Wave& wave, const MemoryOp& row, Range& range) {
  if (row.set == spirv::ir::kAnySet || row.index.file != spirv::IndexOperand::File::kConstant) return false;
  const spirv::exec::Bytes bytes = spirv::exec::buffer_bytes(wave, row, 0);
  range.first = reinterpret_cast<std::uintptr_t>(bytes.data);
  range.end = range.first + bytes.size;
  return true;
}

}  // namespace

void Tracked::update(const Sites& sites, const Wave& wave) {
  find(sites, wave);
  sites_.assign(sites.by_instruction.size(), Sites::kNone);
  device_sites_ = shared_sites_ = sites_;
  has_device_sites_ = false;
  alike_ = sites.alike;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const std::uint32_t site = sites.by_instruction[i];
    if (site == Sites::kNone || tracked_[site] == 0) continue;
    sites_[i] = site;
    const bool shared = sites.all[site].memory == Memory::kShared;
    (shared ? shared_sites_ : device_sites_)[i] = site;
    if (shared) continue;
    has_device_sites_ = true;
    if (sites.all[site].order.given) alike_ = false;
  }
}

void Tracked::find(const Sites& sites, const Wave& wave) {
  const spirv::Program& program = *wave.program;
  tracked_.assign(sites.all.size(), 1);
  bool anything = sites.writes_global || sites.writes_images;
  std::vector<Range> written;
  const auto each_buffer = [&](auto&& f) {
    for (std::size_t index = 0; index < sites.by_instruction.size(); ++index) {
      const std::uint32_t site = sites.by_instruction[index];
      if (site == Sites::kNone || sites.all[site].memory != Memory::kBuffer) continue;
      const bool global = program.notes[index].space == MemorySpace::kGlobal;
      f(site, global ? nullptr : &program.memory_ops[program.code[index].extra[0]]);
    }
  };
  each_buffer([&](std::uint32_t site, const MemoryOp* row) {
    Range range;
    if (!sites.all[site].writes() || row == nullptr) return;
    if (!range_of(wave, *row, range)) anything = true;
    written.push_back(range);
  });
  for (std::size_t site = 0; site < sites.all.size(); ++site)
    if (sites.all[site].memory == Memory::kImage) tracked_[site] = sites.writes_images;
  if (anything) return;
  each_buffer([&](std::uint32_t site, const MemoryOp* row) {
    Range range;
    if (sites.all[site].writes() || (row != nullptr && !range_of(wave, *row, range))) return;
    tracked_[site] =
        row == nullptr ? !written.empty() : std::any_of(written.begin(), written.end(), [&](const Range& other) {
          return range.first < other.end && other.first < range.end;
        });
  });
}

bool skip_shared(Group& group, std::uint32_t site, const Wave& wave, const Instruction* i, const InstructionNote& note,
                 std::uint32_t first) {
  const base::LaneMask lanes = wave.active & wave.live;
  if (lanes == 0) return true;
  const bool stores = note.access == spirv::Access::kStore;
  Offsets offsets;
  if (!offsets_of(wave, {note.files[1], i->src[0]}, offsets)) {
    group.stop_following();
    return false;
  }
  if (group.may_follow()) {
    static constexpr Follower::Values kNothing = {};
    const std::uint32_t* values[4];
    const MemoryOp& row = wave.program->memory_ops[i->extra[0]];
    for (std::uint32_t c = 0; c < 4 && stores; ++c) values[c] = values_of(wave, row, c);
    if (group.follows(site, first, lanes, offsets, stores ? values : kNothing)) return true;
  }
  return !stores && group.log_shared({site, {first}, group.order().time()}, lanes, offsets);
}

void record_access(Group& group, std::uint32_t site, const Wave& wave, const Instruction* i,
                   const InstructionNote& note, const WaveNames& names) {
  const Site& what = group.program().sites.all[site];
  const Doing by{site, names, group.order().time()};
  Recorder recorder(group, by, wave, i, note);
  what.memory == Memory::kImage ? recorder.image() : recorder.memory(what);
}

}  // namespace vitrine::glass::race
