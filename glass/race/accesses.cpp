// See accesses.h.
#include "glass/race/accesses.h"

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

/// What one instruction does, lane by lane.
class Recorder {
 public:
  Recorder(Group& group, std::uint32_t site, const Wave& wave, const Instruction* i, const InstructionNote& note,
           std::uint32_t first, const std::uint32_t* names)
      : group_(group),
        site_(site),
        wave_(wave),
        i_(i),
        note_(note),
        first_(first),
        names_(names),
        lanes_(wave.active & wave.live) {}

  void memory(const Site& site);
  void image();

 private:
  std::uint32_t who(std::size_t lane) const {
    return names_ != nullptr ? names_[lane] : first_ + static_cast<std::uint32_t>(lane);
  }
  void shared(const MemoryOp& row);
  void buffer(const MemoryOp& row);
  void global(const MemoryOp& row);
  bool row_of_words(const MemoryOp& row, const Words& offsets, std::uint64_t base, std::uint64_t size);
  void range(const MemoryOp& row, const Words& offsets, base::LaneMask lanes, std::uint64_t base, std::uint64_t size);
  void bytes(std::size_t lane, std::uint64_t address, std::uint32_t count, std::uint32_t value);
  const std::uint32_t* values_of(const MemoryOp& row, std::uint32_t component) const;

  Group& group_;
  const std::uint32_t site_;
  const Wave& wave_;
  const Instruction* const i_;
  const InstructionNote& note_;
  const std::uint32_t first_;
  const std::uint32_t* const names_;
  const base::LaneMask lanes_;
};

/// Null: it is no store.
const std::uint32_t* Recorder::values_of(const MemoryOp& row, std::uint32_t component) const {
  if (note_.access != Access::kStore || row.data[component] == spirv::kNoOperand) return nullptr;
  return reinterpret_cast<const base::WaveRegister*>(wave_.registers + row.data[component])->lane;
}

void Recorder::bytes(std::size_t lane, std::uint64_t address, std::uint32_t count, std::uint32_t value) {
  while (count != 0) {
    const auto in_word = static_cast<std::uint32_t>(address & 3), part = std::min(count, 4 - in_word);
    group_.touch(site_, who(lane), {address / 4, ((1u << part) - 1) << in_word, value});
    address += part;
    count -= part;
  }
}

void Recorder::range(const MemoryOp& row, const Words& offsets, base::LaneMask lanes, std::uint64_t base,
                     std::uint64_t size) {
  const sanitize::Touched touched = sanitize::touched_by(row, note_.access);
  const std::uint32_t component_bytes = row.element_bytes;
  std::uint64_t words[base::kWaveWidth];
  for (std::uint32_t c = 0; c < touched.count; ++c) {
    const std::uint32_t component = (touched.at[c] - row.added) / component_bytes;
    const std::uint32_t* const values = component < 4 ? values_of(row, component) : nullptr;
    base::LaneMask whole = 0;
    base::for_each_lane(lanes, [&](std::size_t lane) {
      const std::uint32_t at = offsets[lane] + touched.at[c];
      if (std::uint64_t{at} + component_bytes > size) return;  // another tool's
      words[lane] = (base + at) / 4;
      if (component_bytes == 4 && ((base + at) & 3) == 0)
        whole |= base::LaneMask{1} << lane;
      else
        bytes(lane, base + at, component_bytes, values != nullptr ? values[lane] : 0);
    });
    group_.touch_words(site_, whole, words, first_, names_, values);
  }
}

/// All lanes, one word each, one behind the other. False: it is not so.
bool Recorder::row_of_words(const MemoryOp& row, const Words& offsets, std::uint64_t base, std::uint64_t size) {
  const std::uint32_t* const at = offsets.in_register();
  if (lanes_ != base::kAllLanes || at == nullptr || row.element_bytes != 4 || names_ != nullptr) return false;
  if (note_.access == Access::kAtomic) return false;
  const sanitize::Touched touched = sanitize::touched_by(row, note_.access);
  if (touched.count != 1) return false;
  const std::uint32_t start = at[0];
  std::uint32_t wrong = start & 3;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) wrong |= at[lane] - start - lane * 4;
  const std::uint64_t first = std::uint64_t{start} + touched.at[0];
  if (wrong != 0 || ((base + first) & 3) != 0 || first + base::kWaveWidth * 4 > size) return false;
  const std::uint32_t component = (touched.at[0] - row.added) / 4;
  group_.touch_row(site_, first_, (base + first) / 4, component < 4 ? values_of(row, component) : nullptr);
  return true;
}

void Recorder::shared(const MemoryOp& row) {
  const Words offsets(wave_, {note_.files[1], i_->src[0]});
  if (row_of_words(row, offsets, 0, wave_.shared_size)) return;
  range(row, offsets, lanes_, 0, wave_.shared_size);
}

void Recorder::buffer(const MemoryOp& row) {
  const Words offsets(wave_, {note_.files[1], i_->src[0]});
  spirv::exec::for_each_buffer(const_cast<Wave&>(wave_), row, lanes_,
                               [&](const spirv::exec::Bytes& bytes, base::LaneMask same) {
                                 if (bytes.data == nullptr) return;
                                 const auto base = reinterpret_cast<std::uintptr_t>(bytes.data);
                                 if (same == lanes_ && row_of_words(row, offsets, base, bytes.size)) return;
                                 range(row, offsets, same, base, bytes.size);
                               });
}

void Recorder::global(const MemoryOp& row) {
  const sanitize::Addresses addresses(wave_, *i_, note_);
  const sanitize::Touched touched = sanitize::touched_by(row, note_.access);
  base::for_each_lane(lanes_, [&](std::size_t l) {
    for (std::uint32_t c = 0; c < touched.count; ++c) {
      const std::uint32_t component = (touched.at[c] - row.added) / row.element_bytes;
      const std::uint32_t* const values = component < 4 ? values_of(row, component) : nullptr;
      bytes(l, addresses(l, touched.at[c]), row.element_bytes, values != nullptr ? values[l] : 0);
    }
  });
}

void Recorder::memory(const Site& site) {
  const MemoryOp& row = wave_.program->memory_ops[i_->extra[0]];
  if (lanes_ == 0) return;
  if (site.memory == Memory::kShared) return shared(row);
  note_.space == MemorySpace::kGlobal ? global(row) : buffer(row);
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
      if (texel.bytes != 0) bytes(l, texel.address, texel.bytes, value);
    });
  });
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

void record_access(Group& group, const Tracked& tracked, std::uint32_t site, const Wave& wave, const Instruction* i,
                   const InstructionNote& note, std::uint32_t first, const std::uint32_t* names) {
  if (!tracked[site]) return;
  Recorder recorder(group, site, wave, i, note, first, names);
  const Site& what = group.program().sites.all[site];
  what.memory == Memory::kImage ? recorder.image() : recorder.memory(what);
}

}  // namespace vitrine::glass::race
