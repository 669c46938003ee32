// The builder behind scalarize(): one pass over the tree that resolves values to scalars and emits operations.
#pragma once

#include <unordered_map>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {

using ir::Op;

/// Identity of an expression: what it computes from which scalars.
struct Key {
  std::uint32_t words[10] = {};
  bool operator==(const Key&) const = default;
};
struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::uint32_t word : key.words) hash = (hash ^ word) * 0x100000001b3u;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

/// Result of building a list: what its last instruction did.
struct ListEnd {
  bool falls = true;
  std::vector<ScalarId> values;
};

struct LoopContext {
  const ir::Node* node = nullptr;
  std::uint32_t op = kNoIndex;
  std::vector<ScalarId> results, continue_params;
  bool has_continue = false;
};

class Scalarizer {
 public:
  Scalarizer(const ir::Function& function, std::string& error, bool accesses_stay);
  ScalarFunction run();

 private:
  // ---- values

  ScalarId constant(std::uint32_t bits, bool boolean);
  void define(ir::ValueId value, std::span<const ScalarId> ids);
  ScalarId component(const ir::Src& src, std::uint32_t i);
  void append(std::vector<ScalarId>& ids, const ir::Src& src, std::uint32_t count);
  /// Scalars that control flow hands to `targets` (which say how many components each source stands for).
  std::vector<ScalarId> arguments(const std::vector<ir::Src>& sources, const std::vector<ir::ValueId>& targets);
  std::vector<ScalarId> new_joins(const std::vector<ir::ValueId>& values);
  void define_all(const std::vector<ir::ValueId>& values, const std::vector<ScalarId>& ids);
  Level level(ScalarId id) const { return out_.scalars[id].level; }
  void fail(const char* what);

  // ---- operations

  Key key_of(Op op, std::span<const ScalarId> sources, const ir::Instr* instr) const;
  /// Computes an ALU operation on constants. Folding honours denormals (lavapipe-shader-math.md section 1).
  std::uint32_t fold(Op op, std::span<const ScalarId> sources);
  ScalarId alu(Op op, std::span<const ScalarId> given, const ir::Instr* instr);
  /// Adds an operation without effects to the preamble or body, or finds the same one made earlier.
  std::vector<ScalarId> emit_pure(ScalarOp op, const Key& key, std::span<const ScalarId> sources, std::uint32_t count,
                                  bool boolean, bool uniform);
  std::vector<ScalarId> emit(const ir::Instr& instr, std::span<const ScalarId> sources, std::uint32_t count,
                             bool boolean);
  void build_alu(const ir::Instr& instr);

  // ---- intrinsics

  void build_instr(const ir::Instr& instr);
  /// Wide operations (wide_ops.def): scalars in, up to two words out.
  void build_wide(const ir::Instr& instr);
  /// Built-ins without operands: the same wherever they are read, so one read at the start of the scope serves all.
  std::vector<ScalarId> environment(Op op, std::uint32_t count, const ir::Instr* instr);
  /// The same for waves that hold several workgroups, adjacent in x: WorkgroupId is that of the first.
  std::vector<ScalarId> packed_environment(Op op, std::uint32_t count, const ir::Instr* instr);
  ScalarId divide(ScalarId value, std::uint32_t by);
  ScalarId remainder(ScalarId value, std::uint32_t by);
  std::vector<ScalarId> quad_environment(Op op, const ir::Instr* instr);
  std::vector<ScalarId> read_environment(Op op, std::uint32_t count, const ir::Instr* instr);
  void build_global_id(const ir::Instr& instr);
  void build_input(const ir::Instr& instr);
  void build_load(const ir::Instr& instr);
  /// Where the components of a load lie in memory.
  static void set_load_offsets(ScalarOp& op);
  void build_store(const ir::Instr& instr);
  void build_image(const ir::Instr& instr);

  // ---- control flow

  void emit_jump(Kind kind, ScalarId cond, const ir::Instr* instr);
  void set_join(ScalarOp& op, const std::vector<ScalarId>& values, const std::vector<ScalarId>& joins);
  static bool is_jump(Op op) { return op == Op::kBreak || op == Op::kContinue || op == Op::kReturn || op == Op::kKill; }
  static Kind jump_kind(Op op);
  /// `targets`: what the values of the list's Yield are for.
  ListEnd build_list(const ir::NodeList& list, const std::vector<ir::ValueId>& targets);
  /// Builds a list whose expressions are known only inside it.
  ListEnd build_scope(const ir::NodeList& list, const std::vector<ir::ValueId>& targets);
  void forget(std::size_t mark);
  static const ir::Instr* only_jump(const ir::NodeList& list);
  static bool only_yield(const ir::NodeList& list);
  ScalarId negate(ScalarId cond);
  /// False when control does not go on after the If.
  bool build_if(const ir::Node& node);
  std::vector<ScalarId> select_all(ScalarId cond, const std::vector<ScalarId>& a, const std::vector<ScalarId>& b);
  ScalarId select(ScalarId cond, ScalarId a, ScalarId b);
  bool build_branches(const ir::Node& node, ScalarId cond);
  void join_branches(const ir::Node& node, ScalarId cond, std::uint32_t else_index, std::uint32_t end_index,
                     const std::vector<ScalarId>& a, const std::vector<ScalarId>& b);
  std::uint32_t add_marker(Kind kind);
  ListEnd build_turn(const ir::Node& node, std::size_t mark, std::uint32_t& continuing);
  std::size_t turns_to_write(const std::vector<ScalarId>& params, const ListEnd& next, std::uint32_t continuing) const;
  void build_loop(const ir::Node& node);
  const ir::Function& ir_;
  std::string& error_;
  ScalarFunction out_;
  std::vector<std::uint32_t> first_;  ///< per ir value: index of component 0 in components_
  std::vector<ScalarId> components_;
  std::unordered_map<Key, ScalarId, KeyHash> global_, scoped_;
  std::vector<Key> undo_;
  std::vector<LoopContext> loops_;
  const ir::Instr* here_ = nullptr;  ///< whose origin markers, selections and address arithmetic have
};

}  // namespace vitrine::spirv::lowering
