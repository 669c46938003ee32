// Loads whose address the whole wave shares, into the uniform file: preamble and wave-uniform scalars; array lengths.
#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"

namespace vitrine::spirv::exec {
namespace {

void load(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes) {
  const std::uint32_t offset = uniform_word(wave, i->src[0]) + row.added;
  for (std::uint32_t c = 0; c < row.components; ++c)
    if (row.data[c] != kNoOperand) uniform_word(wave, row.data[c]) = load_word(bytes, offset + row.at[c]);
}

/// Elements of the run-time array at the end of a buffer: those that lie completely in the bound range.
std::uint32_t length(const MemoryOp& row, const Bytes& bytes) {
  if (bytes.size < row.length_offset || row.length_stride == 0) return 0;
  return static_cast<std::uint32_t>((bytes.size - row.length_offset) / row.length_stride);
}

std::uint32_t uniform_element(Wave& wave, const MemoryOp& row) {
  return row.index.file == IndexOperand::File::kUniform ? uniform_word(wave, row.index.value) : 0;
}

}  // namespace

const Instruction* load_buffer_uniform(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  load(wave, i, row, buffer_bytes(wave, row, uniform_element(wave, row)));
  return i + 1;
}

const Instruction* load_push_uniform(Wave& wave, const Instruction* i) {
  load(wave, i, memory_op(wave, i), push_bytes(wave));
  return i + 1;
}

const Instruction* load_shared_uniform(Wave& wave, const Instruction* i) {
  load(wave, i, memory_op(wave, i), shared_bytes(wave));
  return i + 1;
}

const Instruction* array_length_uniform(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  uniform_word(wave, i->dst) = length(row, buffer_bytes(wave, row, uniform_element(wave, row)));
  return i + 1;
}

const Instruction* array_length(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* to = reg(wave, i->dst).lane;
  for_each_buffer(wave, row, wave.active, [&](const Bytes& bytes, base::LaneMask active) {
    base::for_each_lane(active, [&](std::size_t lane) { to[lane] = length(row, bytes); });
  });
  return i + 1;
}

}  // namespace vitrine::spirv::exec
