// ir::Function -> ScalarFunction: one scalar per component, constants folded, common expressions merged, draw-uniform
// work in the preamble, small side-effect free branches as selects.
#include <algorithm>
#include <bit>
#include <unordered_map>

#include "base/float_mode.h"
#include "spirv/lower/scalar.h"
#include "spirv/program.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Op;

/// Branches up to this weight run unconditionally: skipping them would cost more than they do.
constexpr std::uint32_t kFlattenWeight = 12;

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
  std::uint32_t op = kNoIndex;
  std::vector<ScalarId> results, continue_params;
  bool has_continue = false;
};

bool commutes(Op op) {
  switch (op) {
    case Op::kIAdd:
    case Op::kIMul:
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
    case Op::kIEq:
    case Op::kINe:
    case Op::kAndB:
    case Op::kOrB:
    case Op::kXorB:
      return true;
    default:
      return false;  // float operand order decides which NaN survives
  }
}

std::uint32_t weight_of(Op op) {
  switch (op) {
    case Op::kFPow:
    case Op::kFSin:
    case Op::kFCos:
    case Op::kFExp2:
    case Op::kFLog2:
    case Op::kIDiv:
    case Op::kUDiv:
    case Op::kIRem:
    case Op::kIMod:
    case Op::kUMod:
      return 8;
    case Op::kFDiv:
    case Op::kFRcp:
    case Op::kFSqrt:
    case Op::kFRsq:
      return 3;
    default:
      return 1;
  }
}

/// Weight of a list that may run unconditionally; above kFlattenWeight if it may not.
std::uint32_t flatten_weight(const ir::NodeList& list) {
  std::uint32_t weight = 0;
  for (const auto& node : list) {
    if (node->kind == ir::Node::Kind::kLoop) return kFlattenWeight + 1;
    if (node->kind == ir::Node::Kind::kIf) {
      weight += flatten_weight(node->then_list) + flatten_weight(node->else_list) +
                static_cast<std::uint32_t>(node->results.size());
    } else {
      const ir::Instr& instr = node->instr;
      if (instr.op < Op::kAluCount) {
        weight += weight_of(instr.op) * instr.components;
      } else if (instr.op == Op::kLoadUniform || instr.op == Op::kLoadPush) {
        weight += 2;
      } else if (instr.op != Op::kConst && instr.op != Op::kUndef && instr.op != Op::kVec && instr.op != Op::kYield &&
                 instr.op != Op::kLoadInput) {
        return kFlattenWeight + 1;
      }
    }
    if (weight > kFlattenWeight) return weight;
  }
  return weight;
}

bool writes_memory(const ir::NodeList& list) {
  for (const auto& node : list) {
    switch (node->kind) {
      case ir::Node::Kind::kIf:
        if (writes_memory(node->then_list) || writes_memory(node->else_list)) return true;
        break;
      case ir::Node::Kind::kLoop:
        if (writes_memory(node->body) || writes_memory(node->continuing)) return true;
        break;
      case ir::Node::Kind::kInstr:
        switch (node->instr.op) {
          case Op::kStoreStorage:
          case Op::kAtomicStorage:
            return true;
          case Op::kImage:
            if (node->instr.image->access == ir::ImageAccess::kWrite ||
                node->instr.image->access == ir::ImageAccess::kAtomic)
              return true;
            break;
          default:
            break;
        }
    }
  }
  return false;
}

/// Whether an instruction lets an invocation notice which others share its wave or workgroup.
bool is_cooperative(Op op) {
  switch (op) {
    case Op::kBarrier:
    case Op::kLoadShared:
    case Op::kStoreShared:
    case Op::kAtomicShared:
    case Op::kElect:
    case Op::kReadFirst:
    case Op::kSubgroupId:
    case Op::kSubgroupInvocation:
    case Op::kNumSubgroups:
      return true;
    default:
      return false;
  }
}

bool is_cooperative(const ir::NodeList& list) {
  for (const auto& node : list)
    if (is_cooperative(node->instr.op) || is_cooperative(node->then_list) || is_cooperative(node->else_list) ||
        is_cooperative(node->body) || is_cooperative(node->continuing))
      return true;
  return false;
}

/// Small workgroups whose invocations work alone share a wave: how many.
std::uint32_t groups_per_wave(const ir::Function& function) {
  const auto& size = function.interface.local_size;
  const std::uint64_t invocations = std::uint64_t{size[0]} * size[1] * size[2];
  if (function.interface.stage != VK_SHADER_STAGE_COMPUTE_BIT || invocations == 0 ||
      2 * invocations > base::kWaveWidth || is_cooperative(function.body))
    return 1;
  return static_cast<std::uint32_t>(base::kWaveWidth / invocations);
}

class Scalarizer {
 public:
  Scalarizer(const ir::Function& function, std::string& error) : ir_(function), error_(error) {
    out_.ir = &function;
    out_.writes_memory = writes_memory(function.body);
    out_.groups_per_wave = groups_per_wave(function);
    first_.assign(function.values.size(), kNoIndex);
  }

  ScalarFunction run() {
    if (const ListEnd end = build_list(ir_.body); end.falls) emit_jump(Kind::kReturn, kNoScalar, nullptr);
    return std::move(out_);
  }

 private:
  // ---- values

  ScalarId constant(std::uint32_t bits, bool boolean) {
    Key key;
    key.words[0] = boolean ? 2 : 1;
    key.words[1] = bits;
    const auto [it, added] = global_.try_emplace(key, 0);
    if (added) {
      it->second = out_.add(boolean, Level::kConstant);
      out_.scalars[it->second].bits = bits;
    }
    return it->second;
  }

  void define(ir::ValueId value, std::span<const ScalarId> ids) {
    if (value == ir::kNoValue) return;
    if (value >= first_.size()) return fail("value id out of range");
    first_[value] = static_cast<std::uint32_t>(components_.size());
    components_.insert(components_.end(), ids.begin(), ids.end());
    for (std::size_t i = ids.size(); i < ir_.values[value].components; ++i) components_.push_back(ids.back());
  }

  ScalarId component(const ir::Src& src, std::uint32_t i) {
    if (src.value >= first_.size() || first_[src.value] == kNoIndex) {
      fail("use of a value before its definition");
      return constant(0, false);
    }
    const std::uint32_t c = src.swizzle[i & 3];
    return components_[first_[src.value] + (c < ir_.values[src.value].components ? c : 0)];
  }

  void append(std::vector<ScalarId>& ids, const ir::Src& src, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) ids.push_back(component(src, i));
  }

  /// All components of sources that are whole values (control flow arguments).
  std::vector<ScalarId> whole(const std::vector<ir::Src>& sources) {
    std::vector<ScalarId> ids;
    for (const ir::Src& src : sources)
      append(ids, src, src.value < ir_.values.size() ? ir_.values[src.value].components : 0);
    return ids;
  }

  std::vector<ScalarId> new_joins(const std::vector<ir::ValueId>& values) {
    std::vector<ScalarId> ids;
    for (const ir::ValueId value : values) {
      std::vector<ScalarId> own;
      for (std::uint32_t i = 0; i < ir_.values[value].components; ++i) {
        own.push_back(out_.add(ir_.values[value].boolean, Level::kVarying));
        out_.scalars[own.back()].join = true;
      }
      define(value, own);
      ids.insert(ids.end(), own.begin(), own.end());
    }
    return ids;
  }

  void define_all(const std::vector<ir::ValueId>& values, const std::vector<ScalarId>& ids) {
    std::size_t next = 0;
    for (const ir::ValueId value : values) {
      const std::size_t count = ir_.values[value].components;
      if (next + count > ids.size()) return fail("too few values for a join");
      define(value, std::span(ids).subspan(next, count));
      next += count;
    }
  }

  Level level(ScalarId id) const { return out_.scalars[id].level; }
  void fail(const char* what) {
    if (error_.empty()) error_ = what;
  }

  // ---- operations

  Key key_of(Op op, std::span<const ScalarId> sources, const ir::Instr* instr) const {
    Key key;
    key.words[0] = 16 + static_cast<std::uint32_t>(op);
    for (std::size_t i = 0; i < sources.size() && i < 4; ++i) key.words[1 + i] = sources[i] + 1;
    if (instr)
      for (int i = 0; i < 4; ++i) key.words[5 + i] = instr->data[i];
    if (instr)
      key.words[9] =
          (instr->op == Op::kArrayLength ? instr->imm[0] * 65599u + instr->imm[1] : 0) + instr->components * 0x1000000u;
    return key;
  }

  /// Computes an ALU operation on constants. Folding honours denormals (lavapipe-shader-math.md section 1).
  std::uint32_t fold(Op op, std::span<const ScalarId> sources) {
    const base::ScopedFloatMode mode(base::Denormals::kHonour);
    std::uint32_t file[4] = {};
    Instruction instruction{};
    instruction.dst = 3 * 4;
    for (std::uint32_t i = 0; i < sources.size(); ++i) {
      file[i] = out_.scalars[sources[i]].bits;
      instruction.src[i] = i * 4;
    }
    Wave wave;
    wave.uniforms = file;
    alu_scalar_handler(op)(wave, &instruction);
    return file[3];
  }

  ScalarId alu(Op op, std::span<const ScalarId> given, const ir::Instr* instr) {
    std::array<ScalarId, 3> copy{};
    std::copy(given.begin(), given.end(), copy.begin());
    if (commutes(op) && copy[1] < copy[0]) std::swap(copy[0], copy[1]);
    const std::span<const ScalarId> sources(copy.data(), given.size());
    const bool boolean = ir::alu_info(op).result == 'B';
    if (op == Op::kMov || op == Op::kMovB) return sources[0];
    if (op == Op::kSelect || op == Op::kSelectB) {
      if (level(sources[0]) == Level::kConstant) return out_.scalars[sources[0]].bits ? sources[1] : sources[2];
      if (sources[1] == sources[2]) return sources[1];
    }
    Level highest = Level::kConstant;
    for (const ScalarId id : sources) highest = std::max(highest, level(id));
    if (highest == Level::kConstant) return constant(fold(op, sources), boolean);
    ScalarOp out;
    out.kind = Kind::kAlu;
    out.op = op;
    out.instr = instr;
    return emit_pure(out, key_of(op, sources, nullptr), sources, 1, boolean, highest <= Level::kUniform)[0];
  }

  /// Adds an operation without effects to the preamble or body, or finds the same one made earlier.
  std::vector<ScalarId> emit_pure(ScalarOp op, const Key& key, std::span<const ScalarId> sources, std::uint32_t count,
                                  bool boolean, bool uniform) {
    auto& known = uniform ? global_ : scoped_;
    std::uint32_t first;
    if (const auto it = known.find(key); it != known.end()) {
      first = it->second;
    } else {
      first = static_cast<std::uint32_t>(out_.scalars.size());
      std::vector<ScalarId> ids;
      for (std::uint32_t i = 0; i < count; ++i)
        ids.push_back(out_.add(boolean, uniform ? Level::kUniform : Level::kVarying));
      op.src = out_.add_operands(sources);
      op.dst = out_.add_operands(ids);
      (uniform ? out_.preamble : out_.body).push_back(op);
      known.emplace(key, first);
      if (!uniform) undo_.push_back(key);
    }
    std::vector<ScalarId> result;
    for (std::uint32_t i = 0; i < count; ++i) result.push_back(first + i);
    return result;
  }

  std::vector<ScalarId> emit(const ir::Instr& instr, std::span<const ScalarId> sources, std::uint32_t count,
                             bool boolean) {
    ScalarOp op;
    op.kind = Kind::kIntrinsic;
    op.op = instr.op;
    op.instr = &instr;
    std::vector<ScalarId> ids;
    for (std::uint32_t i = 0; i < count; ++i) ids.push_back(out_.add(boolean, Level::kVarying));
    op.src = out_.add_operands(sources);
    op.dst = out_.add_operands(ids);
    out_.body.push_back(op);
    return ids;
  }

  void build_alu(const ir::Instr& instr) {
    std::vector<ScalarId> result;
    const std::uint32_t arity = ir::alu_info(instr.op).sources;
    if (instr.src.size() != arity) return fail("ALU instruction with the wrong number of sources");
    for (std::uint32_t c = 0; c < instr.components; ++c) {
      std::array<ScalarId, 3> sources{};
      for (std::uint32_t i = 0; i < arity; ++i) sources[i] = component(instr.src[i], c);
      result.push_back(alu(instr.op, std::span(sources).first(arity), &instr));
    }
    define(instr.result, result);
  }

  // ---- intrinsics

  void build_instr(const ir::Instr& instr) {
    if (instr.op < Op::kAluCount) return build_alu(instr);
    switch (instr.op) {
      case Op::kConst: {
        std::vector<ScalarId> ids;
        for (std::uint32_t c = 0; c < instr.components; ++c) ids.push_back(constant(instr.imm[c], instr.boolean));
        return define(instr.result, ids);
      }
      case Op::kUndef:
        return define(instr.result, std::vector<ScalarId>(instr.components, constant(0, instr.boolean)));
      case Op::kVec: {
        std::vector<ScalarId> ids;
        for (const ir::Src& src : instr.src) ids.push_back(component(src, 0));
        return define(instr.result, ids);
      }
      case Op::kLoadInput:
        return build_input(instr);
      case Op::kLoadPush:
      case Op::kLoadUniform:
      case Op::kLoadStorage:
      case Op::kArrayLength:
        return build_load(instr);
      case Op::kImage:
        return build_image(instr);
      case Op::kStoreStorage:
      case Op::kStoreShared:
        return build_store(instr);
      case Op::kSubgroupSize:
        return define(instr.result, std::vector<ScalarId>{constant(base::kWaveWidth, false)});
      case Op::kNumSubgroups:
        return define(instr.result, std::vector<ScalarId>{constant(subgroups(), false)});
      case Op::kGlobalInvocationId:
        return build_global_id(instr);
      case Op::kReadFirst:
        if (level(component(instr.src[0], 0)) <= Level::kUniform)
          return define(instr.result, std::vector<ScalarId>{component(instr.src[0], 0)});
        [[fallthrough]];
      case Op::kStoreOutput:
      case Op::kAtomicStorage:
      case Op::kLoadShared:
      case Op::kAtomicShared:
      case Op::kLoadArray:
      case Op::kStoreArray:
      case Op::kBarrier:
      case Op::kDemote:
      case Op::kHelperInvocation:
      case Op::kElect: {
        std::vector<ScalarId> sources;
        for (const ir::Src& src : instr.src) append(sources, src, 1);
        return define(instr.result, emit(instr, sources, instr.components, instr.boolean));
      }
      case Op::kWorkgroupId:
      case Op::kNumWorkgroups:
      case Op::kLocalInvocationId:
      case Op::kLocalInvocationIndex:
      case Op::kSubgroupInvocation:
      case Op::kSubgroupId:
        return define(instr.result, environment(instr.op, instr.components, &instr));
      default:
        return fail("instruction that the lowering does not cover");
    }
  }

  std::uint32_t subgroups() const {
    const auto& size = ir_.interface.local_size;
    return (size[0] * size[1] * size[2] + static_cast<std::uint32_t>(base::kWaveWidth) - 1) /
           static_cast<std::uint32_t>(base::kWaveWidth);
  }

  /// Built-ins without operands: the same wherever they are read, so one read at the start of the scope serves all.
  std::vector<ScalarId> environment(Op op, std::uint32_t count, const ir::Instr* instr) {
    return out_.groups_per_wave > 1 ? packed_environment(op, count, instr) : read_environment(op, count, instr);
  }

  /// The same for waves that hold several workgroups, adjacent in x: WorkgroupId is that of the first.
  std::vector<ScalarId> packed_environment(Op op, std::uint32_t count, const ir::Instr* instr) {
    const auto& size = ir_.interface.local_size;
    const std::uint32_t invocations = size[0] * size[1] * size[2];
    const ScalarId lane = read_environment(Op::kSubgroupInvocation, 1, instr)[0];
    const ScalarId index = remainder(lane, invocations);
    std::vector<ScalarId> result;
    if (op == Op::kLocalInvocationIndex) {
      result = {index};
    } else if (op == Op::kLocalInvocationId) {
      result = {remainder(index, size[0]), remainder(divide(index, size[0]), size[1]),
                divide(index, size[0] * size[1])};
    } else {
      result = read_environment(op, count, instr);
      if (op == Op::kWorkgroupId) {
        const std::array<ScalarId, 2> sum{result[0], divide(lane, invocations)};
        result[0] = alu(Op::kIAdd, sum, instr);
      }
    }
    return result;
  }

  ScalarId divide(ScalarId value, std::uint32_t by) {
    const bool shift = std::has_single_bit(by);
    const std::array<ScalarId, 2> sources{
        value, constant(shift ? static_cast<std::uint32_t>(std::countr_zero(by)) : by, false)};
    return by == 1 ? value : alu(shift ? Op::kUShr : Op::kUDiv, sources, nullptr);
  }

  ScalarId remainder(ScalarId value, std::uint32_t by) {
    const bool mask = std::has_single_bit(by);
    const std::array<ScalarId, 2> sources{value, constant(mask ? by - 1 : by, false)};
    return by == 1 ? constant(0, false) : alu(mask ? Op::kAnd : Op::kUMod, sources, nullptr);
  }

  std::vector<ScalarId> read_environment(Op op, std::uint32_t count, const ir::Instr* instr) {
    ScalarOp out;
    out.kind = Kind::kIntrinsic;
    out.op = op;
    out.instr = instr;
    Key key = key_of(op, {}, nullptr);
    key.words[9] = count;
    return emit_pure(out, key, {}, count, false, false);
  }

  void build_global_id(const ir::Instr& instr) {
    const std::vector<ScalarId> group = environment(Op::kWorkgroupId, 3, &instr);
    const std::vector<ScalarId> local = environment(Op::kLocalInvocationId, 3, &instr);
    std::vector<ScalarId> result;
    for (std::uint32_t c = 0; c < instr.components; ++c) {
      const std::array<ScalarId, 2> product{group[c], constant(ir_.interface.local_size[c], false)};
      const std::array<ScalarId, 2> sum{alu(Op::kIMul, product, &instr), local[c]};
      result.push_back(alu(Op::kIAdd, sum, &instr));
    }
    define(instr.result, result);
  }

  void build_input(const ir::Instr& instr) {
    if (instr.data[0] >= ir_.interface.inputs.size()) return fail("input index out of range");
    Key key = key_of(Op::kLoadInput, {}, nullptr);
    key.words[5] = instr.data[0];
    const auto [it, added] = global_.try_emplace(key, 0);
    if (added) {
      it->second = out_.add(false, Level::kVarying);
      out_.scalars[it->second].input = instr.data[0];
    }
    define(instr.result, std::vector<ScalarId>{it->second});
  }

  void build_load(const ir::Instr& instr) {
    std::vector<ScalarId> sources;
    bool uniform = true;
    for (const ir::Src& src : instr.src) {
      sources.push_back(component(src, 0));
      uniform = uniform && level(sources.back()) <= Level::kUniform;
    }
    if (instr.op == Op::kLoadStorage && out_.writes_memory)
      return define(instr.result, emit(instr, sources, instr.components, false));
    ScalarOp op;
    op.kind = Kind::kIntrinsic;
    op.op = instr.op;
    op.instr = &instr;
    define(instr.result, emit_pure(op, key_of(instr.op, sources, &instr), sources, instr.components, false, uniform));
  }

  void build_store(const ir::Instr& instr) {
    std::vector<ScalarId> sources;
    const std::size_t addresses = instr.src.size() - 1;
    for (std::size_t i = 0; i < addresses; ++i) sources.push_back(component(instr.src[i], 0));
    for (std::uint32_t c = 0; c < 4; ++c)
      if (instr.imm[0] >> c & 1) sources.push_back(component(instr.src[addresses], c));
    emit(instr, sources, 0, false);
  }

  void build_image(const ir::Instr& instr) {
    std::vector<ScalarId> sources;
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(ir::ImageOperand::kCount); ++i) {
      if (!(instr.image->operands >> i & 1)) continue;
      if (next >= instr.src.size()) return fail("image instruction with too few sources");
      append(sources, instr.src[next++], image_operand_components(*instr.image, static_cast<ir::ImageOperand>(i)));
    }
    define(instr.result, emit(instr, sources, instr.components, false));
  }

  // ---- control flow

  void emit_jump(Kind kind, ScalarId cond, const ir::Instr* instr) {
    ScalarOp op;
    op.kind = kind;
    op.cond = cond;
    op.instr = instr;
    if (kind == Kind::kBreak || kind == Kind::kContinue) {
      if (loops_.empty()) return fail("break or continue outside a loop");
      LoopContext& loop = loops_.back();
      const std::vector<ScalarId> values = whole(instr->src);
      const std::vector<ScalarId>& joins = kind == Kind::kBreak ? loop.results : loop.continue_params;
      if (values.size() != joins.size()) return fail("jump with the wrong number of values");
      loop.has_continue |= kind == Kind::kContinue;
      op.partner = loop.op;
      set_join(op, values, joins);
    }
    out_.body.push_back(op);
  }

  void set_join(ScalarOp& op, const std::vector<ScalarId>& values, const std::vector<ScalarId>& joins) {
    if (values.size() != joins.size()) return fail("join with the wrong number of values");
    for (std::size_t i = 0; i < joins.size(); ++i) out_.join_sources[joins[i]].push_back(values[i]);
    op.src = out_.add_operands(values);
    op.dst = out_.add_operands(joins);
  }

  static bool is_jump(Op op) { return op == Op::kBreak || op == Op::kContinue || op == Op::kReturn || op == Op::kKill; }
  static Kind jump_kind(Op op) {
    switch (op) {
      case Op::kBreak:
        return Kind::kBreak;
      case Op::kContinue:
        return Kind::kContinue;
      case Op::kReturn:
        return Kind::kReturn;
      default:
        return Kind::kKill;
    }
  }

  ListEnd build_list(const ir::NodeList& list) {
    for (const auto& node : list) {
      if (!error_.empty()) return {};
      switch (node->kind) {
        case ir::Node::Kind::kInstr:
          if (node->instr.op == Op::kYield) return {true, whole(node->instr.src)};
          if (is_jump(node->instr.op)) {
            emit_jump(jump_kind(node->instr.op), kNoScalar, &node->instr);
            return {false, {}};
          }
          build_instr(node->instr);
          break;
        case ir::Node::Kind::kIf:
          if (!build_if(*node)) return {false, {}};
          break;
        case ir::Node::Kind::kLoop:
          build_loop(*node);
          break;
      }
    }
    return {};
  }

  /// Builds a list whose expressions are known only inside it.
  ListEnd build_scope(const ir::NodeList& list) {
    const std::size_t mark = undo_.size();
    ListEnd end = build_list(list);
    forget(mark);
    return end;
  }

  void forget(std::size_t mark) {
    for (; undo_.size() > mark; undo_.pop_back()) scoped_.erase(undo_.back());
  }

  static const ir::Instr* only_jump(const ir::NodeList& list) {
    if (list.size() != 1 || list[0]->kind != ir::Node::Kind::kInstr || !is_jump(list[0]->instr.op)) return nullptr;
    return &list[0]->instr;
  }
  static bool only_yield(const ir::NodeList& list) {
    return list.empty() ||
           (list.size() == 1 && list[0]->kind == ir::Node::Kind::kInstr && list[0]->instr.op == Op::kYield);
  }

  ScalarId negate(ScalarId cond) {
    const std::array<ScalarId, 1> source{cond};
    return alu(Op::kNotB, source, nullptr);
  }

  /// False when control does not go on after the If.
  bool build_if(const ir::Node& node) {
    const ScalarId cond = component(node.condition, 0);
    if (level(cond) == Level::kConstant) {
      const ListEnd end = build_list(out_.scalars[cond].bits ? node.then_list : node.else_list);
      if (end.falls) define_all(node.results, end.values);
      return end.falls;
    }
    const ir::Instr* then_jump = only_jump(node.then_list);
    const ir::Instr* else_jump = only_jump(node.else_list);
    if ((then_jump && only_yield(node.else_list)) || (else_jump && only_yield(node.then_list))) {
      const ir::Instr* jump = then_jump ? then_jump : else_jump;
      emit_jump(jump_kind(jump->op), then_jump ? cond : negate(cond), jump);
      define_all(node.results, build_list(then_jump ? node.else_list : node.then_list).values);
      return true;
    }
    if (level(cond) > Level::kUniform &&
        flatten_weight(node.then_list) + flatten_weight(node.else_list) <= kFlattenWeight) {
      const ListEnd then_end = build_list(node.then_list);
      const ListEnd else_end = build_list(node.else_list);
      define_all(node.results, select_all(cond, then_end.values, else_end.values));
      return true;
    }
    return build_branches(node, cond);
  }

  std::vector<ScalarId> select_all(ScalarId cond, const std::vector<ScalarId>& a, const std::vector<ScalarId>& b) {
    std::vector<ScalarId> result;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) result.push_back(select(cond, a[i], b[i]));
    return result;
  }
  ScalarId select(ScalarId cond, ScalarId a, ScalarId b) {
    const std::array<ScalarId, 3> sources{cond, a, b};
    return alu(out_.scalars[a].boolean ? Op::kSelectB : Op::kSelect, sources, nullptr);
  }

  bool build_branches(const ir::Node& node, ScalarId cond) {
    const std::uint32_t if_index = add_marker(Kind::kIf);
    out_.body[if_index].cond = cond;
    const ListEnd then_end = build_scope(node.then_list);
    const std::uint32_t else_index = add_marker(Kind::kElse);
    const ListEnd else_end = build_scope(node.else_list);
    const std::uint32_t end_index = add_marker(Kind::kEndIf);
    out_.body[if_index].partner = else_index;
    out_.body[else_index].partner = end_index;
    out_.body[end_index].partner = if_index;
    out_.body[else_index].falls = then_end.falls;
    out_.body[end_index].falls = else_end.falls;
    if (then_end.falls && else_end.falls) {
      join_branches(node, cond, else_index, end_index, then_end.values, else_end.values);
    } else if (then_end.falls || else_end.falls) {
      define_all(node.results, then_end.falls ? then_end.values : else_end.values);
    }
    return then_end.falls || else_end.falls;
  }

  void join_branches(const ir::Node& node, ScalarId cond, std::uint32_t else_index, std::uint32_t end_index,
                     const std::vector<ScalarId>& a, const std::vector<ScalarId>& b) {
    std::vector<ScalarId> values, joins, from_then, from_else;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
      const bool uniform = std::max({level(cond), level(a[i]), level(b[i])}) <= Level::kUniform;
      if (a[i] == b[i] || uniform) {
        values.push_back(a[i] == b[i] ? a[i] : select(cond, a[i], b[i]));
        continue;
      }
      values.push_back(out_.add(out_.scalars[a[i]].boolean, Level::kVarying));
      out_.scalars[values.back()].join = true;
      joins.push_back(values.back());
      from_then.push_back(a[i]);
      from_else.push_back(b[i]);
    }
    set_join(out_.body[else_index], from_then, joins);
    set_join(out_.body[end_index], from_else, joins);
    define_all(node.results, values);
  }

  std::uint32_t add_marker(Kind kind) {
    ScalarOp op;
    op.kind = kind;
    out_.body.push_back(op);
    return static_cast<std::uint32_t>(out_.body.size() - 1);
  }

  void build_loop(const ir::Node& node) {
    const std::vector<ScalarId> init = whole(node.init);
    const std::vector<ScalarId> params = new_joins(node.params);
    const std::uint32_t loop_index = add_marker(Kind::kLoop);
    set_join(out_.body[loop_index], init, params);
    LoopContext context;
    context.op = loop_index;
    for (const ir::ValueId value : node.results)
      for (std::uint32_t i = 0; i < ir_.values[value].components; ++i) {
        context.results.push_back(out_.add(ir_.values[value].boolean, Level::kVarying));
        out_.scalars[context.results.back()].join = true;
      }
    context.continue_params = new_joins(node.continue_params);
    loops_.push_back(std::move(context));
    const std::size_t mark = undo_.size();
    const ListEnd body_end = build_list(node.body);
    const bool has_continue = loops_.back().has_continue;
    if (has_continue) forget(mark);  // lanes that continued early have not computed the rest of the body
    const std::uint32_t continuing_index = add_marker(Kind::kContinuing);
    out_.body[continuing_index].falls = body_end.falls;
    if (body_end.falls && !has_continue) {
      define_all(node.continue_params, body_end.values);
    } else if (body_end.falls) {
      set_join(out_.body[continuing_index], body_end.values, loops_.back().continue_params);
    }
    ListEnd next{false, {}};
    if (body_end.falls || has_continue) next = build_list(node.continuing);
    const std::uint32_t end_index = add_marker(Kind::kEndLoop);
    out_.body[end_index].falls = next.falls;
    if (next.falls) set_join(out_.body[end_index], next.values, params);
    out_.body[loop_index].partner = continuing_index;
    out_.body[continuing_index].partner = end_index;
    out_.body[end_index].partner = loop_index;
    forget(mark);
    define_all(node.results, loops_.back().results);
    loops_.pop_back();
  }

  const ir::Function& ir_;
  std::string& error_;
  ScalarFunction out_;
  std::vector<std::uint32_t> first_;  ///< per ir value: index of component 0 in components_
  std::vector<ScalarId> components_;
  std::unordered_map<Key, ScalarId, KeyHash> global_, scoped_;
  std::vector<Key> undo_;
  std::vector<LoopContext> loops_;
};

}  // namespace

std::uint32_t image_operand_components(const ir::ImageInfo& info, ir::ImageOperand operand) {
  const std::uint32_t dimensions = info.dim == 4 ? 3 : info.dim == 5 ? 1 : info.dim == 6 ? 2 : info.dim;
  switch (operand) {
    case ir::ImageOperand::kCoord:
      return dimensions + (info.arrayed ? 1 : 0);
    case ir::ImageOperand::kGradX:
    case ir::ImageOperand::kGradY:
    case ir::ImageOperand::kOffset:
      return dimensions;
    case ir::ImageOperand::kValue:
      return info.access == ir::ImageAccess::kAtomic ? 1 : 4;
    default:
      return 1;
  }
}

ScalarFunction scalarize(const ir::Function& function, std::string& error) { return Scalarizer(function, error).run(); }

}  // namespace vitrine::spirv::lowering
