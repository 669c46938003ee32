// State of one translation: what every id of the module stands for, the list that instructions go to, and the small
// emitters that all translator functions share. Internal to front/.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "spirv/exec/observe.h"
#include "spirv/front/convergence.h"
#include "spirv/front/module.h"

namespace vitrine::spirv::front {

/// A SPIR-V value taken apart: its scalars and vectors (a matrix: its columns) in order; those of 64-bit numbers are
/// two leaves, low and high words.
struct Value {
  std::uint32_t type = 0;
  std::vector<ir::ValueId> leaves;
};

/// One step of an access chain.
struct Step {
  bool dynamic = false;
  std::uint32_t index = 0;           ///< when constant
  ir::ValueId value = ir::kNoValue;  ///< when dynamic
};

/// Descriptors of one binding (ResourceTable).
struct Binding {
  std::uint32_t set = 0, slot = 0, count = 0;
  const texel::Sampler* const* immutable_samplers = nullptr;
};

/// What OpLoad of an image, sampler or sampled image gives.
struct ImageHandle {
  std::uint32_t image_type = 0;  ///< OpTypeImage, 0: only a sampler
  Binding image, sampler;
  ir::ValueId image_element = ir::kNoValue, sampler_element = ir::kNoValue;  ///< kNoValue: element 0
  bool combined = false;
};

struct Pointer {
  enum class Kind : std::uint8_t {
    kLocal,
    kUniform,
    kStorage,
    kPush,
    kShared,
    kGlobal,  ///< PhysicalStorageBuffer
    kDescriptor,
    kTexel
  } kind = Kind::kLocal;
  std::uint32_t type = 0;      ///< pointee
  std::uint32_t variable = 0;  ///< OpVariable it leads back to
  // kLocal
  std::uint32_t local = 0;
  std::vector<Step> path;
  std::optional<Step> component;  ///< points to one component of the vector at `path`
  // memory
  Binding binding;
  bool descriptor_array = false;  ///< the next index selects an array element of the binding
  ir::ValueId element = ir::kNoValue;
  ir::ValueId offset = ir::kNoValue;  ///< dynamic bytes
  std::uint32_t constant_offset = 0;  ///< plus these
  std::uint32_t matrix_stride = 0;
  bool row_major = false;
  std::uint32_t component_stride = 0;                   ///< bytes between components of a vector; 0: adjacent
  ir::ValueId low = ir::kNoValue, high = ir::kNoValue;  ///< kGlobal: the address
  // kShared
  bool explicit_layout = false;  ///< of blocks (SPV_KHR_workgroup_memory_explicit_layout); else a word per scalar
  // kShared: stage memory
  bool stage = false;         ///< laid out by locations (spirv/stage_memory.h)
  bool vertex_array = false;  ///< the next index selects a vertex
  bool patch = false;         ///< belongs to the patch
  bool built_in = false;      ///< scalars without gaps
  // kDescriptor, kTexel
  ImageHandle image;
  ir::ValueId coord = ir::kNoValue, sample = ir::kNoValue;
  bool is_volatile = false;  ///< every load is made

  /// Whether every scalar takes words of its own, without gaps.
  bool word_layout() const { return kind == Kind::kShared && !explicit_layout; }
};

/// A variable of storage class Function, Private, Input or Output, or a phi: becomes SSA or an ir::Array.
struct Local {
  std::uint32_t type = 0;
  spv::StorageClass storage = spv::StorageClass::Function;
  std::uint32_t variable = 0;  ///< OpVariable, 0: made by the front end
  ir::ValueInfo info{};        ///< when type is 0: a scalar or vector of this kind
};

/// Path of one LoadVar / StoreVar to a scalar or vector; dynamic steps are the instruction's sources in order.
struct Access {
  std::uint32_t local = 0;
  std::vector<Step> path;
};

struct Assigned;  // initialization.h
struct Initialization;
struct Debugging;  // debugging.h

inline constexpr std::uint32_t kNoLocal = ~std::uint32_t{0};

/// A construct of the control flow that is being built and can be left.
struct Scope {
  enum class Kind : std::uint8_t { kSelection, kCase, kLoop, kFunction } kind = Kind::kSelection;
  std::uint32_t merge = 0, continue_target = 0;
  std::uint32_t exit = 0;  ///< number in Exit instructions (not kLoop)
  bool exit_used = false;
  const std::unordered_map<std::uint32_t, std::uint32_t>* falls = nullptr;  ///< kCase: case label -> fall-through flag
  std::uint32_t own_case = 0;  ///< kCase: its label, to which nothing falls
  std::shared_ptr<Assigned>
      left;  ///< what holds on all jumps to its end so far; null: there are none (initialization.h)
};

/// A function instance that is being inlined.
struct Frame {
  const Function* function = nullptr;
  std::uint32_t result_local = 0;  ///< kNoLocal: it returns nothing
  std::size_t scope = 0;           ///< index of its kFunction scope
};

struct Translator {
  Translator(const Module& m, const CompileOptions& o, const exec::Interest& i, SourceInfo s)
      : module(m), options(o), interest(i), sources(std::move(s)) {}

  const Module& module;
  const CompileOptions& options;
  exec::Interest interest;  ///< of whoever observes the shader
  SourceInfo sources;       ///< the module's, then a place for each call that leads to one
  std::uint32_t call = 0;   ///< place of the call that the running function instance stands for; 0: the entry point
  using InCall = std::pair<std::uint32_t, std::uint32_t>;  ///< a number, the call
  std::map<InCall, std::uint32_t> inlined_places, inlined_scopes;
  std::uint32_t near = 0;  ///< place of what was made last
  ir::Origin fallback;     ///< of what is made while no instruction with a place is being translated
  ir::Function function;
  ir::NodeList* list = nullptr;  ///< where instructions go
  ir::NodeList constants;        ///< goes in front of everything
  ir::NodeList prologue;         ///< initial values of variables, inputs
  std::map<std::vector<std::uint32_t>, ir::ValueId> constant_ids;
  using InputKey = std::tuple<BuiltIn, std::uint16_t, std::uint8_t, Interpolation, InputPart, SampleLocation>;
  std::map<InputKey, ir::ValueId> loaded_inputs;  ///< slots loaded by the prologue
  std::unordered_map<ir::ValueId, std::array<std::uint32_t, 4>> constant_words;
  std::unordered_set<ir::ValueId> undefined_ids;
  std::map<std::uint32_t, ir::ValueId> vertex_offsets;       ///< input vertex -> its byte offset in stage memory
  std::set<std::pair<std::uint32_t, std::uint32_t>> stored;  ///< (local, first step or kWholeVariable)
  std::uint32_t emitted_locals = 0;                          ///< geometry: locals below may be outputs
  std::uint32_t emitted_local = 0;                           ///< geometry: vertices emitted so far
  std::array<std::uint32_t, 4> starts_local{};               ///< geometry: per stream, the next vertex starts a strip

  std::unordered_map<std::uint32_t, Value> values;
  std::unordered_map<std::uint32_t, Pointer> pointers;
  /// Pointers among `values` (chosen, loaded, joined) as Pointer, and those of `pointers` as values; made when asked
  /// for.
  std::unordered_map<std::uint32_t, Pointer> value_pointers;
  std::unordered_map<std::uint32_t, Value> pointer_values;
  std::unordered_map<std::uint32_t, ImageHandle> images;
  std::unordered_map<std::uint32_t, std::uint32_t> phi_locals;  ///< OpPhi -> local of the running function instance
  std::vector<Local> locals;
  std::vector<Access> accesses;

  std::vector<Scope> scopes;
  std::vector<Frame> frames;
  std::unordered_set<std::uint32_t> built_blocks;                   ///< in the running function instance
  std::unordered_map<std::uint32_t, MeetingPoints> meeting_points;  ///< entry block of a function -> those in it
  std::uint32_t exits = 0;
  std::uint32_t depth = 0;    ///< of the recursion over what nests
  std::size_t nodes = 0;      ///< emitted so far
  std::size_t steps = 0;      ///< instructions of the module translated so far, in every function instance
  std::size_t leaves = 0;     ///< of all values so far
  std::size_t arguments = 0;  ///< that values cross joins as, so far

  std::shared_ptr<Initialization> initialization;  ///< null: nobody asks which variables have been written
  std::shared_ptr<Debugging> debugging;            ///< null: nobody asks for lines and variables

  /// FPFastMathDefault by bits of the numbers; nothing: the module leaves that to Vulkan.
  std::optional<std::map<std::uint32_t, std::uint32_t>> fast_math_defaults;
  const Inst* inst = nullptr;  ///< being translated
  bool exact = false;          ///< is_exact() of the instruction
};

/// A path of an interface variable (first step) that is stored to somewhere; kWholeVariable: at a dynamic index.
inline constexpr std::uint32_t kWholeVariable = ~std::uint32_t{0};

/// Bounds the size of what a module may expand to, so that a small module cannot ask for endless memory or time.
inline constexpr std::size_t kMaxNodes = 1u << 20;
inline constexpr std::size_t kMaxSteps = 1u << 24;
inline constexpr std::size_t kMaxLeaves = 1u << 25;
inline constexpr std::size_t kMaxArguments = 1u << 24;
/// Scalars of all variables that stay in memory.
inline constexpr std::size_t kMaxArrayScalars = 1u << 18;
/// Bounds the recursion over nested control flow, and over variables that begin as pointers to variables.
inline constexpr std::uint32_t kMaxDepth = 200;

/// Counts the depth of such a recursion.
struct Deeper {
  Deeper(Translator& t, const char* what) : translator(t) {
    if (++t.depth > kMaxDepth) throw Failure(std::string(what) + " too deeply nested");
  }
  ~Deeper() { translator.depth--; }
  Translator& translator;
};

// ---- call_stack.cpp
/// Where the entry point begins: the place of its interface.
std::uint32_t entry_place(const Module& module);
/// A place of the module, in the running function instance.
std::uint32_t inlined_place(Translator& t, std::uint32_t place);
/// Of the instruction being translated.
ir::Origin origin_here(Translator& t);

// ---- memory_order.cpp
/// MemoryOrder::word() (spirv/memory_order.h) of an access or a barrier; 0: it is neither.
std::uint32_t order_of(const Translator& t, const Inst& inst);

// ---- emit.cpp
/// Appends an instruction with a result of `components`; returns the result.
ir::ValueId emit(Translator& t, ir::Op op, std::uint32_t components, bool boolean, std::vector<ir::Src> src,
                 std::uint8_t width = 32);
/// Appends an instruction without result and returns it.
ir::Instr& emit_effect(Translator& t, ir::Op op, std::vector<ir::Src> src = {});
/// The instruction that was appended last.
ir::Instr& last_instr(Translator& t);
/// Appends an empty If / Loop.
ir::Node& emit_node(Translator& t, ir::Node::Kind kind);

ir::ValueId constant(Translator& t, std::span<const std::uint32_t> words, bool boolean = false);
/// A Const of its own.
ir::ValueId literal(Translator& t, std::span<const std::uint32_t> words, bool boolean);
ir::ValueId constant_u32(Translator& t, std::uint32_t word);
ir::ValueId constant_float(Translator& t, float value);
ir::ValueId constant_bool(Translator& t, bool value);
ir::ValueId undefined(Translator& t, std::uint32_t components, bool boolean);
/// The words of a constant value, null otherwise.
const std::array<std::uint32_t, 4>* constant_of(const Translator& t, ir::ValueId value);

inline ir::Src whole(ir::ValueId value) { return {value, {0, 1, 2, 3}}; }
inline ir::Src splat(ir::ValueId value, std::uint8_t component = 0) {
  return {value, {component, component, component, component}};
}
/// Fails where an operand is none: a number that lacks its high word.
inline const ir::ValueInfo& info_of(const Translator& t, ir::ValueId value) {
  if (value >= t.function.values.size()) throw Failure("operand does not fit its type");
  return t.function.values[value];
}
inline std::uint32_t components(const Translator& t, ir::ValueId value) { return info_of(t, value).components; }
inline bool is_boolean(const Translator& t, ir::ValueId value) { return info_of(t, value).boolean; }

/// Component of a vector as a scalar value.
ir::ValueId extract(Translator& t, ir::ValueId vector, std::uint32_t component);
/// Vector of scalars (each Src: swizzle[0]); constants fold.
ir::ValueId vec(Translator& t, std::vector<ir::Src> scalars, bool boolean);
/// Component chosen at run time: selects over all components, out of range gives the last.
ir::ValueId extract_dynamic(Translator& t, ir::ValueId vector, ir::ValueId index);
/// Copy of `vector` with one component replaced; an index out of range replaces none.
ir::ValueId insert(Translator& t, ir::ValueId vector, ir::ValueId scalar, std::uint32_t component);
ir::ValueId insert_dynamic(Translator& t, ir::ValueId vector, ir::ValueId scalar, ir::ValueId index);

/// Fails unless the value is what a leaf of this type holds.
void check_leaf(const Translator& t, std::uint32_t type, ir::ValueId value);

// ---- values.cpp
/// Components and boolean-ness of each leaf of a scalar or vector type (numbers of 64 bits have two leaves).
ir::ValueInfo leaf_info(const Translator& t, std::uint32_t type);
/// The type of a scalar, or of a vector's components.
const Type& number_type(const Translator& t, std::uint32_t type);
/// Appends the scalar or vector type of every leaf of a type in order.
void leaf_types(const Translator& t, std::uint32_t type, std::vector<std::uint32_t>& leaves);
/// Value of an id: constants and results.
const Value& value_of(Translator& t, std::uint32_t id);
/// Value of an id that is one scalar or vector.
ir::ValueId scalar_or_vector(Translator& t, std::uint32_t id);
/// Value of an id that is `count` numbers; fails on anything else.
ir::ValueId number(Translator& t, std::uint32_t id, std::uint32_t count = 1);
/// Value of an id that is an integer scalar of any width, as a 32-bit word: an index or a selector.
ir::ValueId index_word(Translator& t, std::uint32_t id);
/// Value of an id that is one boolean.
ir::ValueId condition(Translator& t, std::uint32_t id);
void set_value(Translator& t, const Inst& inst, std::vector<ir::ValueId> leaves);
void set_value(Translator& t, const Inst& inst, ir::ValueId leaf);
/// Value of `type` whose scalars are `words`.
Value constant_value(Translator& t, std::uint32_t type, std::span<const std::uint32_t> words, bool is_undefined);
/// Literal access chain: index of the first leaf, and the type it leads to.
struct Part {
  std::uint32_t first = 0;
  std::uint32_t type = 0;
  std::optional<std::uint32_t> component;  ///< of the leaf
};
Part find_part(const Translator& t, const Inst& inst, std::uint32_t type, std::uint32_t first_operand);

// ---- memory.cpp
std::uint32_t new_local(Translator& t, std::uint32_t type, spv::StorageClass storage, std::uint32_t variable);
/// A variable of the front end that holds one scalar or vector.
std::uint32_t new_local(Translator& t, ir::ValueInfo info);
/// A boolean flag of the control-flow lowering.
std::uint32_t new_flag(Translator& t);
Pointer local_pointer(const Translator& t, std::uint32_t local);
const Pointer& pointer_of(Translator& t, std::uint32_t id);
/// pointer_values.cpp: a pointer as two words (its leaves), and back. `type`: OpTypePointer.
Value pointer_value(Translator& t, std::uint32_t type, const Pointer& pointer);
Pointer pointer_from(Translator& t, const Value& value);
/// Whether an id is a pointer that has no value of its own yet: a variable or a part of one.
bool is_static_pointer(const Translator& t, std::uint32_t id);
Value load(Translator& t, const Pointer& pointer);
void store(Translator& t, const Pointer& pointer, const Value& value);
/// Whole of a variable of new_local(info).
ir::ValueId load_raw(Translator& t, std::uint32_t local);
void store_raw(Translator& t, std::uint32_t local, ir::ValueId value);
void store_flag(Translator& t, std::uint32_t flag, bool value);
ir::ValueId load_flag(Translator& t, std::uint32_t flag);
/// a + b * scale in bytes; either may be kNoValue (zero).
ir::ValueId add_scaled(Translator& t, ir::ValueId base, ir::ValueId index, std::uint32_t scale);
/// Byte offset of a pointer into a buffer as a value (without its constant part).
ir::ValueId dynamic_offset(Translator& t, const Pointer& pointer);
ir::ValueId descriptor_element(Translator& t, const Pointer& pointer);
/// Whether the module lays out Workgroup memory itself: its variables there are blocks, all or none.
bool has_workgroup_blocks(const Translator& t);
/// Fills data[] of a buffer instruction.
void set_buffer(ir::Instr& instr, const Pointer& pointer);

// ---- control.cpp
/// Translates the entry function into function.body.
void translate_entry(Translator& t);
/// opcode_table.cpp: translates one instruction that is not control flow.
void translate_instruction(Translator& t, const Inst& inst);

// ---- fast_math.cpp
/// What the module says of all floating-point numbers, into t.function and t.fast_math_defaults.
void read_fast_math(Translator& t);
/// Whether the instruction gives what it says, and may be no part of another computation: NoContraction, or no leave by
/// FPFastMathMode or FPFastMathDefault.
bool is_exact(const Translator& t, const Inst& inst);

// ---- interface.cpp
/// Execution modes into function.interface.
void read_modes(Translator& t);
/// Initial values of Input variables (into t.prologue) and StoreOutput of Output variables (at the end of the body);
/// joins prologue and body.
void connect_interface(Translator& t);

// ---- stage_memory.cpp
/// Whether an Input or Output variable of this stage lies in stage memory; then what it stands for.
bool in_stage_memory(const Translator& t, const Inst& variable);
Pointer stage_pointer(Translator& t, const Inst& variable);
/// Follows one step into stage memory.
void step_stage(Translator& t, const Inst& inst, const Type& type, Pointer& pointer, const Step& step);
/// Sizes of what the stage writes to stage memory; geometry: variables that count what is emitted.
void prepare_stage(Translator& t);
/// Geometry: what emitted vertices hold, and the number of vertices as an output.
void finish_emission(Translator& t);

// ---- passes of the front end, in this order
/// Exit(id) inside `list` becomes structure: what follows moves into the branch that does not exit, or behind a flag.
void lower_exits(Translator& t, ir::NodeList& list, std::uint32_t exit);
/// scopes.cpp: values used outside the list that defines them go through variables.
void repair_scopes(Translator& t);
/// variables.cpp, ssa.cpp: LoadVar / StoreVar become SSA values, If / Loop arguments and ir::Array accesses.
void resolve_arrays(Translator& t);
void build_ssa(Translator& t);
/// invariant.cpp: everything that feeds a StoreOutput marked exact becomes exact (lavapipe-shader-math.md 3.3).
void propagate_invariant(ir::Function& function);

}  // namespace vitrine::spirv::front
