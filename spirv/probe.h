// Probes: places in a shader at which observers are told which lanes come by, with values. Only shaders that somebody
// observes have any (spirv/exec/observe.h); they change no result.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace vitrine::spirv {

/// One argument of a printf: a scalar or vector.
struct ProbeValue {
  char type = 'U';               ///< of a component: F I U of `width` bits, B boolean, S id of a string
  std::uint8_t width = 32;       ///< 8, 16 (in the low bits of a word), 32, 64 (two words, low first)
  std::uint8_t components = 1;   ///< of a vector
  std::uint32_t first_word = 0;  ///< number of its first word among the probe's words
};

/// What instructions of SPIR-V do, for those who count them.
enum class Cost : std::uint8_t {
  kArithmetic,   ///< numbers, booleans, bits, functions of GLSL.std.450
  kConversions,  ///< between types of numbers
  kMoves,        ///< composites, copies, phis, selections, pointers, variables
  kLoads,        ///< from buffers, push constants, shared memory
  kStores,       ///< to buffers, shared memory
  kAtomics,      ///< of memory and images
  kLookups,      ///< of sampled images, and queries of them
  kTexels,       ///< texels read or written one by one
  kDerivatives,
  kSubgroup,  ///< operations over a subgroup
  kBarriers,
  kBranches,  ///< conditional ones and switches
  kCalls,
  kBytesLoaded,  ///< by kLoads
  kBytesStored,  ///< by kStores
  kCount
};
inline constexpr std::size_t kCosts = static_cast<std::size_t>(Cost::kCount);

/// Why a step is told of.
enum class StepKind : std::uint32_t {
  kLine,    ///< a line begins
  kReturn,  ///< a line goes on behind a call
  kBreak,   ///< NonSemantic.DebugBreak
};

struct Probe {
  enum class Kind : std::uint8_t {
    kBlock,        ///< a block of the module begins: SPIR-V label `id`
    kPrintf,       ///< NonSemantic.DebugPrintf
    kOperation,    ///< an operation that is undefined for some operands, or whose result somebody wants to see
    kQuad,         ///< a derivative, or a lookup that takes some, comes next
    kBarrier,      ///< a barrier of the workgroup, or of the patch, comes next
    kAligned,      ///< an access to PhysicalStorageBuffer memory comes next: low and high word of an address, two
                   ///< distances from it; `number`: bytes of which it must be a multiple
    kDescriptor,   ///< an access comes next to descriptors whose index is not NonUniform: an index each
    kUnreachable,  ///< OpUnreachable
    kOrder,        ///< a barrier or an end of a critical section comes next: `opcode`; `number`: MemoryOrder::word()
    kWrite,        ///< cells of variables get a value
    kRead,         ///< slots say which lanes read cells that have not been written
    kChoose,       ///< slots are those of one value or of another
    kUse,          ///< something depends on slots
    kStep,         ///< what another line stands for comes next; `number`: a StepKind
    kAssign,       ///< cells of variables (spirv/source_variables.h) get values
  } kind = Kind::kBlock;
  std::uint32_t id = 0;     ///< SPIR-V id of the block or instruction
  std::uint32_t place = 0;  ///< SourceInfo::places
  std::string format;       ///< kPrintf; kUse: what depends on what
  std::vector<ProbeValue> values;
  // kOperation: `values` are its operands, then its result if somebody wants to see it; kQuad, kAligned, kDescriptor
  std::uint16_t opcode = 0;  ///< in the SPIR-V specification
  std::uint32_t number = 0;  ///< OpExtInst: the GLSL.std.450 instruction; others: bits of the result's components
  bool has_result = false;   ///< the last of `values` is the result
  // kWrite, kRead, kUse: scalars of variables and phis are numbered cells, values that may be undefined numbered slots.
  // Operands: indices of elements, as unsigned words; ~0: not known any more. kChoose: by slot of the result a
  // condition, and in `slots` two entries, where it holds and where it does not
  // kAssign: the operands are indices, one a step, then `cells` words
  std::uint32_t first_cell = 0, cells = 0;
  std::vector<std::array<std::uint32_t, 2>> steps;  ///< by operand: cells of an element, number of elements
  std::uint32_t first_slot = 0;                     ///< kRead, kChoose: of `cells` slots
  std::vector<std::vector<std::uint32_t>> slots;    ///< kWrite: by cell, those that it depends on (none at all: all are
                                                    ///< defined); kUse: in [0], those that matter
  // kBlock
  std::uint32_t function = 0;         ///< id of the function that the block is in
  bool enters = false;                ///< the block is its function's first; kStep: the line is
  std::vector<std::uint32_t> places;  ///< of the block's instructions, in their order, without repetitions in a row
  std::array<std::uint32_t, kCosts> costs{};  ///< of one pass through the block, by Cost
  /// Instructions by place, in the order in which places first come.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> instructions;
  std::uint32_t end_place = 0;            ///< of the instruction that ends it
  std::vector<std::uint32_t> successors;  ///< labels of the blocks that may come next, in the order of the operands
};

}  // namespace vitrine::spirv
