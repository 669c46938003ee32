// Reads of shared memory that no invocation of the workgroup has written.
#include "glass/sanitize/shared.h"

#include <algorithm>
#include <cstring>

#include "glass/sanitize/accesses.h"
#include "glass/sanitize/checks.h"
#include "glass/sanitize/operands.h"

namespace vitrine::glass::sanitize {
namespace {

/// States of a word.
constexpr std::uint32_t kFourWritten = 0x01010101;

}  // namespace

void SharedShadow::begin(const spirv::Wave& wave) {
  written_.assign(wave.shared_size, 0);
  for (const auto& [first, end] : wave.program->observation->interface.zeroed_shared) write(first, end - first);
}

void SharedShadow::write(std::uint32_t offset, std::uint32_t bytes) {
  if (std::uint64_t{offset} + bytes > written_.size()) return;
  if (bytes == sizeof kFourWritten) {
    std::memcpy(&written_[offset], &kFourWritten, sizeof kFourWritten);
    return;
  }
  std::fill_n(written_.begin() + offset, bytes, std::uint8_t{1});
}

bool SharedShadow::written(std::uint32_t offset, std::uint32_t bytes) const {
  if (std::uint64_t{offset} + bytes > written_.size()) return true;  // another rule's
  if (bytes == sizeof kFourWritten) return std::memcmp(&written_[offset], &kFourWritten, sizeof kFourWritten) == 0;
  const auto first = written_.begin() + offset;
  return std::find(first, first + bytes, 0) == first + bytes;
}

SharedShadow* SharedShadows::of(const spirv::Wave& wave, const spirv::Instruction* start) {
  if (wave.shared == nullptr || wave.program->observation->interface.stage != VK_SHADER_STAGE_COMPUTE_BIT ||
      wave.shared_size == 0)
    return nullptr;
  SharedShadow* shadow = nullptr;
  {
    const std::lock_guard lock(mutex_);
    shadow = &shadows_[wave.shared];
  }
  if (start == wave.program->code.data() && wave.first_invocation == 0) shadow->begin(wave);
  return shadow;
}

void check_shared(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                  const spirv::InstructionNote& note, SharedShadow& shadow) {
  const base::LaneMask lanes = wave.active & wave.live;
  const MemoryOp& row = wave.program->memory_ops[i->extra[0]];
  const Touched touched = touched_by(row, note.access);
  const Words address(wave, {note.files[1], i->src[0]});
  const bool read = reads(row, note.access), write = writes(row, note.access);
  base::LaneMask wrong = 0;
  base::for_each_lane(lanes, [&](std::size_t lane) {
    bool known = true;
    for (std::uint32_t c = 0; c < touched.count; ++c) {
      const std::uint32_t offset = address[lane] + touched.at[c];
      if (read) known &= shadow.written(offset, row.element_bytes);
      if (write) shadow.write(offset, row.element_bytes);
    }
    if (!known) wrong |= base::LaneMask{1} << lane;
  });
  if (wrong == 0) return;
  reporter.report(wave, i, note, "uninitialized-shared", wrong, [&](std::size_t lane) {
    const Extent extent = extent_of(row, note.access);
    std::string text = verb_of(note.access);
    text += bytes_text(extent.end - extent.first, address[lane] + row.added + extent.first);
    return text += " of shared memory that no invocation has written";
  });
}

}  // namespace vitrine::glass::sanitize
