// The intermediate representation between the SPIR-V front end and the lowering to Program: SSA values over a tree of
// structured control flow. Front end: words -> Function. Rewrites: Function -> Function. Lowering: Function -> Program.
// Sections cited are of lavapipe-shader-math.md.
// Control flow is a tree, so there are no phi instructions: values cross joins as arguments.
//   If    cond; each branch ends in Yield(values) or in a jump; results[i] is the i-th yielded value.
//   Loop  params: initial values `init`, and per iteration the Yield of `continuing`. `body` ends in Yield (= falls
//   into
//         `continuing`, values for continue_params), or in a jump. Continue(values) jumps to `continuing` of the
//         innermost loop; Break(values) leaves it, giving results. `continuing` ends in Yield(next params), in Break,
//         or in If that may Break (the SPIR-V back-edge block with a conditional exit).
//   Return / Kill end the invocation (functions are inlined). Demote is an ordinary instruction.
// After lowering to scalars every ALU instruction has one component; loads, image instructions and constants may keep
// up to 4.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/lanes.h"
#include "spirv/probe.h"
#include "spirv/shader.h"
#include "spirv/source_info.h"

namespace vitrine::spirv::ir {

enum class Op : std::uint16_t {
#define VITRINE_ALU(name, sources, result, operands, swap, chain, effect) k##name,
#include "spirv/ops.def"
  kExecutedCount,  ///< the operations before this have handlers; the lowering sees no others
  kLastExecuted = kExecutedCount - 1,
#define VITRINE_NIR(name, sources, result, operands, swap, reads, effect) k##name,
#include "spirv/ops.def"
  kAluCount,
#define VITRINE_INTRINSIC(name, sources, result, effect) k##name,
#include "spirv/intrinsics.def"
#undef VITRINE_INTRINSIC
  kIntrinsicEnd,
#define VITRINE_WIDE(name, result, operands, effect) k##name,
#include "spirv/wide_ops.def"
#undef VITRINE_WIDE
  kCount,
};

struct AluInfo {
  const char* name;
  std::uint8_t sources;
  char result;  ///< F I U B
  const char* operands;
  char swap;           ///< S R _
  std::uint8_t reads;  ///< components of every operand that are read; 0: as many as the result has
};
/// Row of ops.def; `op` < kAluCount.
const AluInfo& alu_info(Op op);
struct Instr;
/// The ops that choose a value whatever it is.
inline bool is_selection(Op op) { return op == Op::kSelect || op == Op::kSelectB; }
/// Components that an operation on numbers of `width` bits with `components` components of its result reads of operand
/// `index`.
std::uint32_t components_read(Op op, std::uint32_t width, std::uint32_t components, std::size_t index);
std::uint32_t components_read(const Instr& instr, std::size_t index);
/// Row of wide_ops.def.
struct WideInfo {
  const char* name;
  char result;  ///< D L Q F I U B
  const char* operands;
};
inline bool is_wide(Op op) { return op > Op::kIntrinsicEnd && op < Op::kCount; }
const WideInfo& wide_info(Op op);
/// Words of a number of this letter.
constexpr std::uint32_t wide_words(char letter) { return letter == 'D' || letter == 'L' || letter == 'Q' ? 2 : 1; }
/// Name of any op.
const char* op_name(Op op);

/// Set of a buffer instruction whose array element is a BufferHandle, made by pointers that may lead to several
/// bindings.
inline constexpr std::uint32_t kAnySet = ~std::uint32_t{0};

/// A descriptor in one word: its slot in the low bits, above it the set plus one, so that 0 leads nowhere.
struct BufferHandle {
  static constexpr std::uint32_t kSlotBits = 24;
  static constexpr std::uint32_t kSlotMask = (1u << kSlotBits) - 1;
  static constexpr std::uint32_t make(std::uint32_t set, std::uint32_t slot) { return (set + 1) << kSlotBits | slot; }
  /// UINT32_MAX of a handle that leads nowhere.
  static constexpr std::uint32_t set(std::uint32_t handle) { return (handle >> kSlotBits) - 1; }
  static constexpr std::uint32_t slot(std::uint32_t handle) { return handle & kSlotMask; }
};

using ValueId = std::uint32_t;
inline constexpr ValueId kNoValue = ~ValueId{0};

/// One operand: a value and which of its components feed component i of the consumer.
struct Src {
  ValueId value = kNoValue;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};
};

/// Bytes of a component in memory (loads and stores of intrinsics.def): imm[1], 0: a word.
inline std::uint32_t element_bytes(const std::array<std::uint32_t, 4>& imm) { return imm[1] == 0 ? 4 : imm[1]; }

/// Where an instruction came from.
struct Origin {
  std::uint32_t spirv_id = 0;  ///< result id, 0: none
  std::uint32_t place = 0;     ///< SourceInfo::places, 0: unknown
  std::uint32_t order = 0;     ///< MemoryOrder::word() (spirv/memory_order.h); 0: no access, or nobody asks
};

/// One instruction. `imm` and `data` mean what the op's row says.
struct Instr {
  Op op = Op::kMov;
  std::uint8_t components = 1;  ///< of the result; 0: no result
  bool boolean = false;         ///< result is a lane mask per component
  /// ALU: bits of the numbers that it computes. 16: binary16 in the low half of a word. 64: one double, the two words
  /// of which are components 0 and 1 of every operand and of the result. Neither is left behind the rewrites.
  std::uint8_t width = 32;
  bool exact = false;  ///< precise / NoContraction / feeds an invariant output: inexact rewrites do not apply
  ValueId result = kNoValue;
  std::vector<Src> src;
  std::array<std::uint32_t, 4> imm{};             ///< constants: component bits (booleans: 0 / 1)
  std::uint32_t data[4] = {};                     ///< intrinsic parameters
  std::shared_ptr<const struct ImageInfo> image;  ///< image instructions
  Origin origin;
};

/// Which image, how, with which operands present. Sources of an image instruction are in the order of ImageOperand,
/// those that are present; each a vector of as many components as the operand has.
enum class ImageOperand : std::uint8_t {
  kImageIndex,
  kSamplerIndex,  ///< array element of the descriptor (dynamic); absent: element 0 or constant in ImageInfo
  kCoord,
  kDref,
  kLod,
  kBias,
  kGradX,
  kGradY,
  kMinLod,
  kOffset,
  kSample,
  kValue,
  kCompare,
  kCount,
};
enum class ImageAccess : std::uint8_t {
  kSample,
  kGather,
  kQueryLod,
  kFetch,
  kRead,
  kWrite,
  kAtomic,
  kQuerySize,
  kQueryLevels,
  kQuerySamples,
  kSubpass,
};
enum class AtomicOp : std::uint8_t {
  kAdd,
  kSub,
  kIMin,
  kIMax,
  kUMin,
  kUMax,
  kAnd,
  kOr,
  kXor,
  kExchange,
  kCompareExchange,
  kFAdd,
  kFMin,
  kFMax,
  kLoad,
  kStore,
};
/// How Reduce combines: the value of a lane with that of the lanes below it, in the order of lanes.
enum class GroupOp : std::uint8_t {
  kIAdd,
  kFAdd,
  kHAdd,  ///< of binary32 values, rounded to binary16 at every step
  kIMul,
  kFMul,
  kHMul,
  kIMin,
  kUMin,
  kFMin,
  kIMax,
  kUMax,
  kFMax,
  kAnd,
  kOr,
  kXor,
};
enum class ImageDim : std::uint8_t { k1D, k2D, k3D, kCube, kBuffer, kSubpass };
/// Components of a coordinate, the array layer not counted.
constexpr std::uint32_t coordinate_components(ImageDim dim) {
  constexpr std::uint8_t kComponents[] = {1, 2, 3, 3, 1, 2};
  return kComponents[static_cast<std::uint8_t>(dim)];
}
enum class GroupMode : std::uint8_t { kReduce, kInclusive, kExclusive };

/// Which words of texels of 64 bits a fetch or a lookup gives.
enum class TexelWord : std::uint8_t { kAll, kLow, kHigh };

struct ImageInfo {
  ImageAccess access = ImageAccess::kSample;
  std::uint32_t operands = 0;                  ///< bit i: ImageOperand i is present
  std::uint32_t set = 0, slot = 0, count = 1;  ///< of the image (ResourceTable; slot of array element 0)
  std::uint32_t sampler_set = 0, sampler_slot = 0, sampler_count = 1;
  bool combined = false;  ///< image and sampler come from one descriptor
  const texel::Sampler* immutable_sampler = nullptr;
  ImageDim dim = ImageDim::k2D;
  bool arrayed = false, multisampled = false;
  bool projective = false;         ///< divide already applied by the front end; kept for information
  bool explicit_lod_zero = false;  ///< implicit LOD outside fragment shaders
  bool in_quads = false;           ///< invocations are the pixels of quads: fragment shaders
  std::uint32_t gather_component = 0;
  bool has_gather_offsets = false;
  std::array<std::array<std::int32_t, 2>, 4> gather_offsets{};
  AtomicOp atomic = AtomicOp::kAdd;
  /// Texels are numbers of 64 bits. Components 0 and 1 of what is read, written and exchanged are the words of the only
  /// component, low first; fetches and lookups of images give the components' words that `word` says.
  bool wide = false;
  TexelWord word = TexelWord::kAll;
};

struct Node;
using NodeList = std::vector<std::unique_ptr<Node>>;

struct Node {
  enum class Kind : std::uint8_t { kInstr, kIf, kLoop } kind = Kind::kInstr;
  Instr instr;                           ///< kInstr (Yield, Break, Continue, Return, Kill are instructions too)
  Src condition;                         ///< kIf
  NodeList then_list, else_list;         ///< kIf
  NodeList body, continuing;             ///< kLoop
  std::vector<ValueId> params;           ///< kLoop
  std::vector<Src> init;                 ///< kLoop: one per param
  std::vector<ValueId> continue_params;  ///< kLoop
  std::vector<ValueId> results;          ///< kIf, kLoop
};

/// Type of a value: what lowering needs to know.
struct ValueInfo {
  std::uint8_t components = 1;
  bool boolean = false;
};

/// A local (Function / Private) variable that did not become SSA: an array of 32-bit elements per invocation, indexed
/// dynamically.
struct Array {
  std::uint32_t elements = 0;
  /// Its elements where all invocations have the same from the first load on, and nothing stores them; or empty.
  std::vector<std::uint32_t> table{};
};

struct Function {
  ShaderInterface interface;  ///< registers are assigned by the lowering
  NodeList body;
  std::vector<ValueInfo> values;  ///< indexed by ValueId
  std::vector<Array> arrays;
  std::shared_ptr<const SourceInfo> sources;  ///< what Origin::place stands for; null: nothing is known
  std::vector<Probe> probes;                  ///< of kProbe
  bool signed_zero_inf_nan_preserve = false;  ///< execution mode: inexact rewrites are off (section 4.1)
  bool denorm_flush_to_zero = false;
  std::uint8_t inexact_off = 0;  ///< sum of the widths, of 16 and 64, for which one of the two is declared
  /// Sum of the widths for which no shortcut may lose a NaN, an infinity or the sign of zero, either
  /// (lavapipe-optimizer.md 6.1).
  std::uint8_t strict_specials = 0;
  bool helpers_take_part = false;  ///< in group operations: MaximallyReconvergesKHR

  /// The inexact rewrites do not apply to numbers of `width` bits.
  bool forbids_inexact(std::uint32_t width) const {
    return width == 32 ? signed_zero_inf_nan_preserve || denorm_flush_to_zero : (inexact_off & width) != 0;
  }

  ValueId new_value(std::uint8_t components, bool boolean) {
    values.push_back({components, boolean});
    return static_cast<ValueId>(values.size() - 1);
  }
};

}  // namespace vitrine::spirv::ir
