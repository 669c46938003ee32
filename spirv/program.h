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

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/lanes.h"
#include "spirv/ir.h"
#include "spirv/resources.h"

namespace vitrine::spirv {

struct Wave;
struct Instruction;
namespace exec {
struct Observation;  // spirv/exec/observe.h
class Watch;
}  // namespace exec

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

/// Set in an operand of a wide instruction (wide_ops.def) that lies in the uniform file.
inline constexpr std::uint32_t kUniformPlace = 1;

/// The handler of an op of wide_ops.def. Sources word by word in src[0..2] and extra[0], result in dst and, if it has
/// two words, extra[1]; `scalar`: the result is in the uniform file (booleans: 0 / 1), as are all sources.
Handler wide_handler(ir::Op op, bool scalar);

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
  std::byte* shared = nullptr;    ///< workgroup memory (compute), stage memory (tessellation, geometry)
  std::uint32_t shared_size = 0;  ///< bytes
  std::byte* arrays = nullptr;    ///< local arrays: element e of array a at a.offset + e*256
  std::uint32_t workgroup_id[3] = {}, num_workgroups[3] = {};
  std::uint32_t first_invocation = 0;  ///< compute: LocalInvocationIndex of lane 0
  std::int64_t budget = 0;             ///< instructions in loops that are left; below 0: fault
  exec::Watch* watch = nullptr;        ///< whom probes tell; null: nobody
  enum class Status : std::uint8_t { kRunning, kDone, kAtBarrier, kFault } status = Status::kRunning;
  const Instruction* resume = nullptr;  ///< after a barrier: where to go on; after a fault: the instruction at fault
};

/// Bytes from one register of the varying file to the next.
inline constexpr std::uint32_t kRegisterStride = sizeof(base::WaveRegister);
/// Operand offset that means "none".
inline constexpr std::uint32_t kNoOperand = ~std::uint32_t{0};

/// A file of the wave and a byte offset in it.
struct OperandPlace {
  char file = ' ';  ///< r varying, u uniform, m mask, ' ' none
  std::uint32_t offset = 0;
};

/// An operand whose file is known only to the instruction's side table. Index operands of descriptor arrays.
struct IndexOperand {
  enum class File : std::uint8_t { kConstant, kUniform, kVarying } file = File::kConstant;
  std::uint32_t value = 0;  ///< the element, or a byte offset into the file
};

/// Side table row of a buffer, push constant, shared memory or local array access (Instruction::extra[0] is its index).
struct MemoryOp {
  std::uint32_t set = 0, slot = 0, count = 1;    ///< buffers: descriptor of array element 0
  IndexOperand index;                            ///< buffers: array element
  std::uint32_t added = 0;                       ///< constant byte offset
  std::uint32_t components = 1;                  ///< loads: number of words
  std::array<std::uint32_t, 4> at{0, 4, 8, 12};  ///< loads: byte offset of each word behind `added`
  std::uint32_t element_bytes = 4;               ///< of a component in memory: 1, 2 or 4
  std::uint32_t write_mask = 0;                  ///< stores: bit i = component i
  std::array<std::uint32_t, 4> data{kNoOperand, kNoOperand, kNoOperand, kNoOperand};  ///< result / value operands
  std::uint32_t compare = kNoOperand;
  ir::AtomicOp atomic = ir::AtomicOp::kAdd;
  std::uint32_t array_base = 0, array_elements = 0;  ///< local arrays: byte offset of element 0 (in Program::tables, of
                                                     ///< tables), number of elements
  std::uint32_t length_offset = 0, length_stride = 1;  ///< ArrayLength
};

/// Side table row of an image instruction.
struct ImageOp {
  ir::ImageInfo info;
  IndexOperand image_index, sampler_index;
  /// Varying operands, by ImageOperand and component.
  std::array<std::array<std::uint32_t, 4>, static_cast<std::size_t>(ir::ImageOperand::kCount)> operand;
  std::array<std::uint32_t, 4> result{kNoOperand, kNoOperand, kNoOperand, kNoOperand};
};

/// Side table row of a probe.
struct ProbeOp {
  std::uint32_t probe = 0;             ///< Program::probes
  std::vector<OperandPlace> operands;  ///< a word each, in the order of Probe::values
  /// Conditions under which the lanes that are active come by: booleans, and whether they must hold.
  std::vector<std::pair<OperandPlace, bool>> guards;
  std::vector<std::uint32_t> also;  ///< of a block: further ones that the same lanes come by, rows of Program::probes
};

/// What an instruction does with memory.
enum class Access : std::uint8_t { kNone, kLoad, kStore, kAtomic, kImage };
/// Which memory: what MemoryOp says holds for it.
enum class MemorySpace : std::uint8_t { kUniformBuffer, kStorageBuffer, kPush, kShared, kGlobal, kArray };

/// What instruction i is, for the disassembler, faults, the trace and the debugger: kept beside the code, not in it.
struct InstructionNote {
  const char* name = "";
  char files[4] = {' ', ' ', ' ', ' '};  ///< of dst, src[0..2]: r varying, u uniform, m mask, ' ' none
  ir::Origin origin;
  /// What extra[0] is: a jump distance, a row of a side table.
  enum class Extra : std::uint8_t { kNone, kJump, kMemory, kImage } extra = Extra::kNone;
  char fourth = ' ';   ///< file of extra[0], a fourth source
  char high = ' ';     ///< file of extra[1], the high word of the result
  char data = 'r';     ///< file of MemoryOp::data
  bool loads = false;  ///< MemoryOp::data are results
  Access access = Access::kNone;
  MemorySpace space = MemorySpace::kStorageBuffer;
};

/// A word of the uniform file that bind() copies once into a mask (0 / ~0) or a whole register that no instruction
/// writes. Byte offsets.
struct Preset {
  std::uint32_t to = 0;
  std::uint32_t uniform = 0;
};

/// Bytes of the varying file.
struct RegisterRange {
  std::uint32_t begin = 0, end = 0;
};

struct Program {
  std::vector<Instruction> preamble;  ///< draw-uniform work on the uniform file alone
  std::vector<Instruction> code;
  std::vector<InstructionNote> preamble_notes, notes;
  std::shared_ptr<const SourceInfo> sources;  ///< what ir::Origin::place stands for; or null
  std::vector<std::uint32_t> constants;       ///< first words of the uniform file
  std::uint32_t draw_words = 0;               ///< words of constants and preamble results
  std::uint32_t uniform_words = 0;            ///< all, wave-uniform scratch included
  std::uint32_t register_count = 0;
  std::uint32_t mask_count = 0;
  std::uint32_t array_bytes = 0;
  std::vector<std::uint32_t> tables;  ///< of ir::Array, each filled up to a multiple of 16 words
  std::vector<Preset> mask_presets, register_presets;
  /// What every wave begins with as zeros: registers whose inactive lanes a neighbour in the quad may read (an
  /// undefined value, which must not be that of an earlier wave).
  std::vector<RegisterRange> cleared;
  std::vector<MemoryOp> memory_ops;
  std::vector<ImageOp> image_ops;
  std::vector<ProbeOp> probe_ops;
  std::vector<Probe> probes;
  /// About how many instructions a wave runs, with as many turns for every loop as most have at least.
  std::uint64_t cost = 0;
  bool has_barrier = false;
  bool flush_denormals = false;  ///< floating-point mode of the preamble
  std::uint32_t local_size[3] = {1, 1, 1};
  std::uint32_t shared_bytes = 0;
  std::vector<std::array<std::uint32_t, 2>> zeroed_shared;  ///< ShaderInterface::zeroed_shared
  bool uses_subgroups = false;                              ///< an invocation may notice which others share its wave
  bool helpers_take_part = false;                           ///< in group operations, beside other invocations
  std::uint32_t groups_per_wave = 1;  ///< compute: small workgroups, adjacent in x, that share a wave
  std::shared_ptr<const exec::Observation> observation;  ///< null: nobody looks
};

/// Runs from `start` until the wave ends, stops at a barrier or faults (Wave::status).
void execute(Wave& wave, const Instruction* start);

/// The loop that runs the waves of `program`: execute(), or one that watches. Asked once per draw or dispatch.
using Loop = void (*)(Wave& wave, const Instruction* start);
Loop loop_of(const Program& program);

/// Text form: one instruction per line with its registers, jump targets and source lines.
std::string disassemble(const Program& program);

}  // namespace vitrine::spirv
