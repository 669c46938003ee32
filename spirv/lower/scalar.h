// What the passes of the lowering share: a function as scalar values and two linear lists of operations. The preamble
// is straight-line code on draw-uniform values. The body keeps the structure of control flow as markers, so that a
// position in it is also a position in time for live ranges.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "spirv/exec/chain.h"
#include "spirv/ir.h"

namespace vitrine::spirv::lowering {

using ScalarId = std::uint32_t;
inline constexpr ScalarId kNoScalar = ~ScalarId{0};
inline constexpr std::uint32_t kNoIndex = ~std::uint32_t{0};

/// How widely a value is shared, narrowest last.
enum class Level : std::uint8_t {
  kConstant,
  kUniform,  ///< the same for the whole draw or dispatch, computed in the preamble
  kWave,     ///< the same for all active lanes whenever it is computed: a word of the wave's uniform file
  kVarying,
};

struct Scalar {
  bool boolean = false;
  Level level = Level::kVarying;
  bool join = false;               ///< parameter or result of control flow: written by moves
  std::uint32_t bits = 0;          ///< kConstant: the value (booleans 0 / 1)
  std::uint32_t input = kNoIndex;  ///< index in interface.inputs
};

enum class Kind : std::uint8_t {
  kAlu,
  kIntrinsic,
  kMove,        ///< dst (varying or mask) = src of any level
  kMaskedMove,  ///< the same for active lanes only
  kIf,          ///< cond
  kElse,        ///< src = values of the then-branch, dst = results
  kEndIf,       ///< src = values of the else-branch, dst = results
  kLoop,        ///< src = initial values, dst = parameters
  kContinuing,  ///< src = values of the body that falls through, dst = continue parameters
  kEndLoop,     ///< src = next values, dst = parameters
  kTurn,        ///< between parts of a loop that has several turns written out: nothing happens
  kBreak,       ///< src = values, dst = results of the loop; cond or kNoScalar
  kContinue,    ///< src = values, dst = continue parameters; cond or kNoScalar
  kReturn,      ///< cond or kNoScalar
  kKill,        ///< cond or kNoScalar
};

/// Part of ScalarFunction::operands.
struct Range {
  std::uint32_t begin = 0, count = 0;
};

struct ScalarOp {
  Kind kind = Kind::kAlu;
  ir::Op op = ir::Op::kMov;
  bool masked = false;  ///< kIf: divergent; kLoop: lanes leave it or continue separately
  bool falls = true;    ///< kElse, kEndIf, kContinuing, kEndLoop: control reaches this marker from the list before it
  bool dead = false;
  ScalarId cond = kNoScalar;
  /// A condition that all lanes share may be an integer comparison of its own (kCount: it is the word `cond`); negated:
  /// holds when it does not.
  ir::Op test = ir::Op::kCount;
  bool negated = false;
  Range test_sources;
  /// kIf -> kElse -> kEndIf -> kIf; kLoop -> kContinuing -> kEndLoop -> kLoop; kBreak, kContinue -> kLoop.
  std::uint32_t partner = kNoIndex;
  Range dst, src;
  /// Arithmetic in a chain (spirv/exec/chain.h): which source is the accumulator, what happens to the result.
  bool in_chain = false;
  int accumulator = exec::kNoAccumulator;
  exec::Link link = exec::Link::kLast;
  std::uint32_t offset = 0;                      ///< memory: constant byte offset besides the instruction's own
  std::array<std::uint32_t, 4> at{0, 4, 8, 12};  ///< loads: byte offset of each result behind the first
  const ir::Instr* instr = nullptr;              ///< parameters of intrinsics, origin
  std::uint32_t joined = kNoIndex;               ///< a probe of a block: row of ScalarFunction::joined_probes

  /// Whether `cond` itself is read.
  bool reads_condition() const { return cond != kNoScalar && test == ir::Op::kCount; }
  /// Whether source `k` comes in SIMD registers from the operation before.
  bool takes_accumulator(std::uint32_t k) const {
    return accumulator == static_cast<int>(k) || (accumulator == exec::kAllSources && k < 2);
  }
};

struct ScalarFunction {
  const ir::Function* ir = nullptr;
  std::vector<Scalar> scalars;
  std::vector<ScalarId> operands;
  std::vector<ScalarOp> preamble, body;
  /// For each join: the values it may take.
  std::vector<std::vector<ScalarId>> join_sources;
  bool writes_memory = false;
  bool accesses_stay = false;   ///< somebody observes loads: each stays where and what it was
  bool uses_subgroups = false;  ///< an invocation may notice which others share its wave
  std::uint32_t groups_per_wave = 1;
  std::vector<ScalarId> outputs;  ///< per interface.outputs: the value that leaves (kNoScalar: never stored)
  std::vector<ScalarId> preset;   ///< constants and uniforms that bind() keeps broadcast in registers
  /// By ScalarOp::joined: further blocks that the same lanes come by, rows of ir::Function::probes.
  std::vector<std::vector<std::uint32_t>> joined_probes;
  std::vector<ScalarId> observed;  ///< inputs that are there when the program starts, though no operation reads them

  ScalarId add(bool boolean, Level level) {
    scalars.push_back({boolean, level, false, 0, kNoIndex});
    join_sources.emplace_back();
    return static_cast<ScalarId>(scalars.size() - 1);
  }
  Range add_operands(std::span<const ScalarId> ids) {
    const Range range{static_cast<std::uint32_t>(operands.size()), static_cast<std::uint32_t>(ids.size())};
    operands.insert(operands.end(), ids.begin(), ids.end());
    return range;
  }
  std::span<ScalarId> of(Range range) { return std::span(operands).subspan(range.begin, range.count); }
  std::span<const ScalarId> of(Range range) const { return std::span(operands).subspan(range.begin, range.count); }
};

/// Number of components of operand `operand` of an image instruction. Of what is written only those that the image has
/// as the shader declares it, as many as Instr::data[0] says (0: all four): what the others would have needed is dead.
std::uint32_t image_operand_components(const ir::Instr& instr, ir::ImageOperand operand);

/// Splits values into scalars, folds constants, merges equal expressions, moves draw-uniform work to the preamble and
/// turns small branches into selects. `function` must outlive the result. `error` says what is not covered.
ScalarFunction scalarize(const ir::Function& function, std::string& error, bool accesses_stay = false);

/// Marks operations and joins that nothing needs as dead / removes them from the operand lists.
void remove_dead(ScalarFunction& function);

/// Sets Level::kWave where it holds, and ScalarOp::masked.
void find_wave_uniform(ScalarFunction& function);

/// Moves operations that give the same value in every iteration in front of the loop.
void hoist_invariants(ScalarFunction& function);

/// Lets jumps on conditions that all lanes share evaluate negations and comparisons themselves.
void fuse_tests(ScalarFunction& function);

/// Moves constants into addresses and merges loads that share one.
void combine_loads(ScalarFunction& function);

/// Whether guard number `guard` of a probe must hold for lanes to come by, or must not.
inline bool guard_holds(const ir::Instr& probe, std::uint32_t guard) {
  return (probe.data[2 + guard / 32] >> guard % 32 & 1) != 0;
}

/// Whether the lanes that come by a probe fulfil its guard number `guard`, where that is known when the program is
/// made.
std::optional<bool> guard_outcome(const ScalarFunction& function, const ScalarOp& probe, std::uint32_t guard);

/// Lets one probe tell of all blocks that the same lanes come by, and none of blocks that no lane comes by.
void join_probes(ScalarFunction& function);

/// Replaces `a * b` used once by an addition or subtraction by one operation (still two roundings).
void fuse_multiply_add(ScalarFunction& function);

/// How often each scalar is read.
std::vector<std::uint32_t> count_uses(const ScalarFunction& function);

/// Replaces integer operations that are used once by superinstructions that do several.
void fuse_integers(ScalarFunction& function);

/// Replaces operand combinations that have no handler by moves; decides how outputs leave. Drops dead operations.
void select_operations(ScalarFunction& function);

/// Orders straight-line arithmetic into chains. `apart`: the same order, but every operation stores its result.
void schedule_chains(ScalarFunction& function, bool apart);

/// Inputs that tell invocations apart, at the start of the program only, where the shader does not read them anyway
/// (spirv/exec/observe.h). Adds them to `interface`.
void keep_identity(ScalarFunction& function, ShaderInterface& interface);

/// The same of all inputs of `other`, another program for the same shader.
void keep_inputs(ScalarFunction& function, ShaderInterface& interface, const ShaderInterface& other);

}  // namespace vitrine::spirv::lowering
