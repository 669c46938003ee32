// See stores.h. Which bytes an access touches: spirv/exec/buffers.h, glass/sanitize/accesses.h.
#include "glass/debug/stores.h"

#include <algorithm>
#include <cstring>

#include "glass/sanitize/accesses.h"
#include "glass/sanitize/image_lanes.h"
#include "glass/sanitize/operands.h"
#include "glass/sanitize/texel_address.h"
#include "spirv/exec/buffers.h"

namespace vitrine::glass::debug {
namespace {

using spirv::Access;
using spirv::Instruction;
using spirv::InstructionNote;
using spirv::MemoryOp;
using spirv::MemorySpace;
using spirv::Wave;
using Take = base::FunctionRef<void(const Written&)>;

/// Joins what lies side by side.
class Joiner {
 public:
  explicit Joiner(Take take) : take_(take) {}
  ~Joiner() { flush(); }
  Joiner(const Joiner&) = delete;
  Joiner& operator=(const Joiner&) = delete;

  void add(std::byte* at, std::uint32_t bytes, std::size_t lane) {
    const bool beside = now_.at != nullptr && now_.at + now_.bytes == at;
    const bool only = lane_ == now_.lane;
    const bool same = beside && lane == lane_ && (only || of_lane_ + bytes <= now_.lane_bytes);
    const bool next = beside && lane == lane_ + 1 && of_lane_ == now_.lane_bytes && bytes <= now_.lane_bytes;
    if (!same && !next) {
      flush();
      now_ = {at, 0, static_cast<std::uint32_t>(lane), bytes};
      of_lane_ = 0;
    }
    if (next) of_lane_ = 0;
    lane_ = lane;
    of_lane_ += bytes;
    now_.bytes += bytes;
    if (lane == now_.lane) now_.lane_bytes = of_lane_;
  }

 private:
  void flush() {
    if (now_.at != nullptr) take_(now_);
  }
  Take take_;
  Written now_;
  std::size_t lane_ = 0;       ///< the last one
  std::uint32_t of_lane_ = 0;  ///< bytes of it
};

/// `offsets`: by lane, in front of MemoryOp::added.
template <class Offsets>
void buffer_lanes(const MemoryOp& row, Access access, const spirv::exec::Bytes& memory, base::LaneMask lanes,
                  const Offsets& offsets, Joiner& joiner) {
  if (memory.data == nullptr) return;
  const sanitize::Touched touched = sanitize::touched_by(row, access);
  base::for_each_lane(lanes, [&](std::size_t lane) {
    for (std::uint32_t c = 0; c < touched.count; ++c) {
      const std::uint64_t at = std::uint64_t{offsets[lane]} + touched.at[c];
      if (at >= memory.size) continue;
      const std::uint64_t bytes = row.element_bytes;
      joiner.add(memory.data + at, static_cast<std::uint32_t>(std::min(bytes, memory.size - at)), lane);
    }
  });
}

void memory_written(const Wave& wave, const Instruction* i, const InstructionNote& note, Joiner& joiner) {
  const MemoryOp& row = wave.program->memory_ops[i->extra[0]];
  if (!sanitize::writes(row, note.access)) return;
  const base::LaneMask lanes = wave.active & wave.live;
  if (lanes == 0) return;
  auto& running = const_cast<Wave&>(wave);
  if (note.space == MemorySpace::kGlobal) {
    return spirv::exec::for_each_stretch(
        running, i, row, lanes,
        [&](const spirv::exec::Bytes& memory, base::LaneMask same, const base::WaveRegister& relative) {
          buffer_lanes(row, note.access, memory, same, relative.lane, joiner);
        });
  }
  const sanitize::Words offsets(wave, {note.files[1], i->src[0]});
  if (note.space == MemorySpace::kShared)
    return buffer_lanes(row, note.access, spirv::exec::shared_bytes(wave), lanes, offsets, joiner);
  if (note.space != MemorySpace::kStorageBuffer) return;
  spirv::exec::for_each_buffer(running, row, lanes, [&](const spirv::exec::Bytes& memory, base::LaneMask same) {
    buffer_lanes(row, note.access, memory, same, offsets, joiner);
  });
}

void image_written(const Wave& wave, const Instruction* i, Joiner& joiner) {
  const spirv::ImageOp& op = wave.program->image_ops[i->extra[0]];
  using spirv::ir::ImageAccess;
  if (op.info.access != ImageAccess::kWrite && op.info.access != ImageAccess::kAtomic) return;
  sanitize::for_each_image(wave, op, [&](const spirv::Descriptor* image, std::uint32_t, base::LaneMask lanes) {
    if (image == nullptr) return;
    const sanitize::ImageLanes operands(wave, op);
    base::for_each_lane(lanes & wave.live, [&](std::size_t lane) {
      const sanitize::TexelBytes texel = sanitize::texel_bytes(*image, op, operands, lane);
      if (texel.bytes != 0) joiner.add(reinterpret_cast<std::byte*>(texel.address), texel.bytes, lane);
    });
  });
}

}  // namespace

void for_each_written(const Wave& wave, const Instruction* i, const InstructionNote& note, Take f) {
  Joiner joiner(f);
  if (note.access == Access::kImage) return image_written(wave, i, joiner);
  if (note.access == Access::kStore || note.access == Access::kAtomic) memory_written(wave, i, note, joiner);
}

void StoreLog::keep(std::byte* at, std::uint32_t bytes) {
  pieces_.push_back({at, bytes, before_.size()});
  before_.insert(before_.end(), at, at + bytes);
}

void StoreLog::take_back() {
  after_.resize(before_.size());
  for (const Piece& piece : pieces_) std::memcpy(after_.data() + piece.first, piece.at, piece.bytes);
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece)
    std::memcpy(piece->at, before_.data() + piece->first, piece->bytes);
}

std::optional<StoreLog::Difference> StoreLog::compare() const {
  Difference difference;
  for (const Piece& piece : pieces_) {
    if (std::memcmp(piece.at, after_.data() + piece.first, piece.bytes) == 0) continue;
    for (std::uint32_t at = 0; at < piece.bytes; at += 4) {
      const std::size_t bytes = std::min(piece.bytes - at, 4u);
      if (std::memcmp(piece.at + at, after_.data() + piece.first + at, bytes) == 0) continue;
      if (difference.words++ != 0) continue;
      std::memcpy(&difference.there, piece.at + at, bytes);
      std::memcpy(&difference.kept, after_.data() + piece.first + at, bytes);
    }
  }
  return difference.words == 0 ? std::nullopt : std::optional(difference);
}

void StoreLog::clear() {
  pieces_.clear();
  before_.clear();
  after_.clear();
}

}  // namespace vitrine::glass::debug
