// The executable form of one entry point: a dense array of instructions over three register files. Made by the lowering
// (spirv/lower/), run by the executor (spirv/exec/).
//
//   varying   one WaveRegister (64 x 32 bits, 256 bytes) each        operand = byte offset from Wave::registers
//   uniform   one 32-bit word each, shared by all waves of a draw     operand = byte offset from Wave::uniforms
//             [constants | preamble results | wave-uniform scratch]
//   masks     one LaneMask (8 bytes) each: booleans                   operand = byte offset from Wave::masks
//
// Handlers return the next instruction, so straight-line code costs one indirect call per wave-wide operation and
// control flow costs nothing extra. A handler is chosen when the program is built: per op, per operand kinds, per SIMD
// target.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/lanes.h"
#include "spirv/ir.h"
#include "spirv/resources.h"

namespace vitrine::spirv {

struct Wave;
struct Instruction;

/// Executes one instruction for a wave and returns the next one to run; null ends or suspends the wave (Wave::status).
using Handler = const Instruction* (*)(Wave& wave, const Instruction* instruction);

/// 32 bytes. dst and src are byte offsets into the files above; extra is what the handler's comment says (jump
/// distance, index of a side table entry...).
struct Instruction {
  Handler handler;
  std::uint32_t dst;
  std::uint32_t src[3];
  std::uint32_t extra[2];
};
static_assert(sizeof(Instruction) == 32);

/// Bit i set: source i is in the uniform file (a scalar, broadcast); boolean sources are always masks.
using UniformSources = std::uint8_t;

/// The handler of an ALU op for these operand kinds in the SIMD target in use. dst is varying (or a mask, for B
/// results).
Handler alu_handler(ir::Op op, UniformSources uniform);

/// Same for a result in the uniform file (all non-boolean sources uniform; boolean sources are uniform words 0 / 1; a B
/// result is written as word 0 / 1): preamble and wave-uniform scalars. Bits equal those of the wave handler.
Handler alu_scalar_handler(ir::Op op);

/// What a running wave is: plain data. Registers lie in memory of the WaveRunner or of the compute dispatcher.
struct Wave {
  std::byte* registers = nullptr;  ///< varying file, 64-byte aligned
  std::uint32_t* uniforms =
      nullptr;                      ///< uniform file (constants + preamble; private copy when the program has scratch)
  base::LaneMask* masks = nullptr;  ///< mask file
  base::LaneMask active = 0;        ///< lanes executing now
  base::LaneMask live = 0;          ///< lanes that are neither helpers nor discarded: stores and atomics act for these
  base::LaneMask launched = 0;      ///< lanes of the run
  const ResourceTable* resources = nullptr;
  const struct Program* program = nullptr;
  std::byte* shared = nullptr;  ///< workgroup memory (compute)
  std::byte* arrays = nullptr;  ///< local arrays: element e of array a at a.offset + e*256
  std::uint32_t workgroup_id[3] = {}, num_workgroups[3] = {};
  std::uint32_t first_invocation = 0;  ///< compute: LocalInvocationIndex of lane 0
  std::int64_t budget = 0;             ///< back edges left; below 0: fault
  enum class Status : std::uint8_t { kRunning, kDone, kAtBarrier, kFault } status = Status::kRunning;
  const Instruction* resume = nullptr;  ///< where to go on after a barrier
};

}  // namespace vitrine::spirv
