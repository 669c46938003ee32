// Push constants that the pipeline layout does not have, or that nobody has set. Commands set whole words.
#include "glass/sanitize/accesses.h"
#include "glass/sanitize/checks.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::sanitize {

void check_push_constants(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                          const spirv::InstructionNote& note) {
  const spirv::ObservedCommand* command = wave.resources->command;
  const base::LaneMask lanes = wave.active & wave.live;
  const MemoryOp& row = wave.program->memory_ops[i->extra[0]];
  const Extent extent = extent_of(row, note.access);
  if (command == nullptr || lanes == 0 || extent.end == 0) return;
  const std::uint64_t in_layout = command->push_range(reporter.stage());
  const std::uint64_t set = command->pushed;
  if ((in_layout & set) == ~std::uint64_t{0}) return;
  const auto offset_of = [&](std::size_t lane) {
    return spirv::exec::word_of(wave, {note.files[1], i->src[0]}, lane) + row.added + extent.first;
  };
  const std::uint32_t size = extent.end - extent.first;
  base::LaneMask outside = 0, unset = 0;
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const std::uint32_t offset = offset_of(lane), last = (offset + size - 1) / 4;
    if (std::uint64_t{offset} + size > wave.program->observation->interface.push_bytes) return;  // said already
    const std::uint64_t words = (~std::uint64_t{0} >> (63 - (last - offset / 4))) << offset / 4;
    outside |= base::LaneMask{(words & ~in_layout) != 0} << lane;
    unset |= base::LaneMask{(words & in_layout & ~set) != 0} << lane;
  });
  const auto text_of = [&](std::size_t lane) { return "load of " + bytes_text(size, offset_of(lane)); };
  if (outside != 0)
    reporter.report(wave, i, note, "out-of-bounds-push-constant", outside, [&](std::size_t lane) {
      return text_of(lane) + ", which no range of push constants in the pipeline layout has";
    });
  unset &= ~outside;
  if (unset != 0)
    reporter.report(wave, i, note, "uninitialized-push-constant", unset,
                    [&](std::size_t lane) { return text_of(lane) + " of push constants that were not set"; });
}

}  // namespace vitrine::glass::sanitize
