// See reporter.h.
#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {
namespace {

/// A number for what an access goes to.
std::uint32_t target_of(const spirv::Program& program, const spirv::Instruction& i,
                        const spirv::InstructionNote& note) {
  if (note.access == spirv::Access::kImage) {
    const spirv::ir::ImageInfo& image = program.image_ops[i.extra[0]].info;
    return image.set << 16 ^ image.slot;
  }
  const spirv::MemoryOp& row = program.memory_ops[i.extra[0]];
  return static_cast<std::uint32_t>(note.space) << 28 ^ row.set << 16 ^ row.slot ^ row.array_base;
}

}  // namespace

std::uint64_t place_of_access(const spirv::Wave& wave, const spirv::Instruction* i,
                              const spirv::InstructionNote& note) {
  constexpr std::uint64_t kInstruction = std::uint64_t{1} << 63, kTarget = std::uint64_t{1} << 62;
  const spirv::Program& program = *wave.program;
  if (note.origin.place == 0 && note.origin.spirv_id == 0) return static_cast<std::uint64_t>(i - program.code.data());
  const std::uint64_t place = std::uint64_t{note.origin.place} << 32;
  if (note.origin.spirv_id != 0) return kInstruction | place | note.origin.spirv_id;
  return kInstruction | kTarget | place | target_of(program, *i, note);
}

}  // namespace vitrine::glass::sanitize
