// A SPIR-V module taken apart: instructions, types, decorations, functions as lists of blocks. No meaning beyond that;
// ids and operands are checked when they are asked for, so a damaged module is an error and never an access out of
// range.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp11>

#include "spirv/compile.h"
#include "spirv/ir.h"

namespace vitrine::spirv::front {

/// Why a module is refused. Thrown inside the front end only; translate() turns it into a base::Error.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One instruction: a view of the module's words. word(0) is the opcode word.
struct Inst {
  std::span<const std::uint32_t> words;
  spv::Op op = spv::Op::OpNop;
  std::uint32_t result = 0;       ///< result id, 0: none
  std::uint32_t result_type = 0;  ///< result type id, 0: none
  std::uint32_t first = 1;        ///< index of the first operand after result type and result
  ir::Origin origin;              ///< its place: a number of Module::sources
  std::uint32_t line = 0;         ///< of the source; 0: unknown

  std::uint32_t count() const { return static_cast<std::uint32_t>(words.size()) - first; }
  bool has(std::uint32_t i) const { return first + i < words.size(); }
  /// i-th operand after result type and result id.
  std::uint32_t operand(std::uint32_t i) const;
};

/// Whether it ends a block.
bool is_block_end(spv::Op op);

/// The string literal that begins at an operand.
std::string string_at(const Inst& inst, std::uint32_t operand);

/// "OpFoo %12 (line 7): why".
[[noreturn]] void fail(const Inst& inst, const std::string& why);

struct Type {
  enum class Kind : std::uint8_t {
    kVoid,
    kBool,
    kInt,
    kFloat,
    kVector,
    kMatrix,
    kArray,
    kRuntimeArray,
    kStruct,
    kPointer,
    kImage,
    kSampler,
    kSampledImage,
    kFunction,
    kOther,
  } kind = Kind::kOther;
  std::uint32_t id = 0;
  std::uint32_t width = 0;    ///< bits of a number
  bool is_signed = false;     ///< kInt
  std::uint32_t element = 0;  ///< component, column, element, pointee, image of a sampled image, return type
  std::uint32_t count = 0;    ///< components, columns, length
  std::vector<std::uint32_t> members;
  spv::StorageClass storage = spv::StorageClass::Function;
  spv::Dim dim = spv::Dim::Dim2D;
  bool depth = false, arrayed = false, multisampled = false;
  spv::ImageFormat format = spv::ImageFormat::Unknown;
  std::uint32_t array_stride = 0;      ///< bytes, 0: undecorated
  std::uint32_t leaves = 0;            ///< IR values that a value of this type consists of
  std::uint32_t depth_of_nesting = 0;  ///< of aggregates
  std::uint32_t scalars = 0;           ///< 32-bit components that a value of this type consists of
  std::uint32_t parts = 1;             ///< it and all that it consists of, elements and members
};

/// Deepest nesting of aggregate types (bounds the recursion over a type).
inline constexpr std::uint32_t kMaxTypeDepth = 64;
/// Largest number of scalars of one value that the front end takes apart.
inline constexpr std::uint32_t kMaxScalars = 1u << 16;
/// Whether a value of the type is beyond what the front end takes apart: too many scalars, or structures without any.
inline bool is_too_large(const Type& type) { return type.scalars > kMaxScalars || type.parts > 16 * kMaxScalars; }

/// Number of the constituents of a composite.
inline std::uint32_t constituents(const Type& type) {
  return type.kind == Type::Kind::kStruct ? static_cast<std::uint32_t>(type.members.size()) : type.count;
}

struct DecorationRow {
  std::uint32_t id = 0;
  std::uint32_t member = 0;  ///< member number + 1, 0: the id itself
  spv::Decoration kind = spv::Decoration::RelaxedPrecision;
  std::uint32_t value = 0;
};

struct Block {
  std::uint32_t label = 0;
  std::uint32_t first = 0, last = 0;  ///< indices in Module::code; `last` is the terminator
  spv::Op merge_op = spv::Op::OpNop;  ///< OpSelectionMerge, OpLoopMerge or OpNop
  std::uint32_t merge = 0, continue_target = 0;
};

struct Function {
  std::uint32_t id = 0;
  std::vector<std::uint32_t> params;
  std::uint32_t entry = 0;  ///< label
};

/// A folded constant: components in order, booleans 0 / 1, 64-bit numbers as two words (low first), narrow ones
/// zero-extended.
struct Constant {
  std::uint32_t type = 0;
  std::vector<std::uint32_t> words;
  bool undefined = false;  ///< OpUndef
};

struct Module {
  std::vector<Inst> code;                                       ///< all instructions in order
  std::unordered_map<std::uint32_t, std::uint32_t> definition;  ///< result id -> index in code
  std::unordered_map<std::uint32_t, Type> types;
  std::unordered_map<std::uint32_t, Constant> constants;
  std::unordered_map<std::uint32_t, Function> functions;
  std::unordered_map<std::uint32_t, Block> blocks;
  std::vector<DecorationRow> decorations;                        ///< sorted by id, then member
  std::vector<std::uint32_t> globals;                            ///< indices in code of module-scope OpVariable
  std::unordered_map<std::uint32_t, std::uint32_t> ext_imports;  ///< id -> ExtSet
  std::uint32_t entry_function = 0;
  SourceInfo sources;                    ///< without the calls that the translation inlines
  std::vector<std::uint32_t> interface;  ///< ids named by OpEntryPoint
  std::vector<Inst> modes;               ///< execution modes of the entry point
  bool has_workgroup_blocks = false;     ///< variables of Workgroup memory are blocks
  bool votes_in_quads = false;           ///< OpGroupNonUniformQuadAnyKHR, OpGroupNonUniformQuadAllKHR
  std::size_t constant_words = 0;        ///< of all constants

  const Type& type(std::uint32_t id) const;
  const Inst& def(std::uint32_t id) const;
  const Block& block(std::uint32_t label) const;
  /// Null when the id is no constant.
  const Constant* constant(std::uint32_t id) const;
  /// Value of a 32-bit integer constant.
  std::uint32_t constant_u32(std::uint32_t id, const Inst& user) const;
  /// The entry point asks for results of `width` bits that are rounded once, to nearest even (RoundingModeRTE).
  bool rounds_to_nearest(std::uint32_t width) const;
  /// The decoration on `id` (member = 0) or on its member number `member` - 1; null when absent.
  const DecorationRow* decoration(std::uint32_t id, spv::Decoration kind, std::uint32_t member = 0) const;
  /// All decorations on an id and its members.
  std::span<const DecorationRow> decorations_of(std::uint32_t id) const;
};

enum ExtSet : std::uint32_t { kExtUnknown, kExtGlsl450, kExtNonSemantic, kExtDebugInfo, kExtDebugPrintf };

/// constants.cpp: folds one OpConstant* / OpSpecConstant* / OpUndef into module.constants.
void fold_constant(Module& module, const Inst& inst, const CompileOptions& options);

}  // namespace vitrine::spirv::front
