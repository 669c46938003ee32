// ir::Function -> ScalarFunction: one scalar per component, constants folded, common expressions merged, draw-uniform
// work in the preamble, small side-effect free branches as selects. Here: values and arithmetic.
#include <algorithm>

#include "base/float_mode.h"
#include "base/shake.h"
#include "spirv/lower/scalarizer.h"
#include "spirv/program.h"

namespace vitrine::spirv::lowering {
namespace {

/// Not of floats: their order decides which NaN survives.
bool commutes(Op op) { return ir::alu_info(op).swap == 'S'; }

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
          case Op::kStoreGlobal:
          case Op::kAtomicGlobal:
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

/// Whether an instruction lets an invocation notice which others share its wave.
bool is_of_subgroups(Op op) {
  switch (op) {
    case Op::kElect:
    case Op::kReadFirst:
    case Op::kSubgroupId:
    case Op::kSubgroupInvocation:
    case Op::kBallot:
    case Op::kShuffle:
    case Op::kReduce:
      return true;
    default:
      return false;
  }
}

/// Or its workgroup.
bool is_cooperative(Op op) {
  return op == Op::kBarrier || op == Op::kLoadShared || op == Op::kStoreShared || op == Op::kAtomicShared ||
         is_of_subgroups(op);
}

bool has_any(const ir::NodeList& list, bool (*is)(Op)) {
  return std::ranges::any_of(list, [&](const auto& node) {
    return is(node->instr.op) || has_any(node->then_list, is) || has_any(node->else_list, is) ||
           has_any(node->body, is) || has_any(node->continuing, is);
  });
}

/// The bits of 1 / x where that is exact and no denormal, x being a power of two; else 0.
std::uint32_t exact_reciprocal(std::uint32_t x) {
  const std::uint32_t sign = x & 0x80000000u, exponent = x >> 23 & 255;
  return (x & 0x7fffffu) == 0 && exponent >= 1 && exponent <= 253 ? sign | (254 - exponent) << 23 : 0;
}

/// Small workgroups whose invocations work alone share a wave: how many.
std::uint32_t groups_per_wave(const ir::Function& function) {
  const auto& size = function.interface.local_size;
  const std::uint64_t invocations = std::uint64_t{size[0]} * size[1] * size[2];
  if (function.interface.stage != VK_SHADER_STAGE_COMPUTE_BIT || invocations == 0 ||
      2 * invocations > base::kWaveWidth || base::shakes(base::ShakeKind::kOrder) ||
      has_any(function.body, is_cooperative))
    return 1;
  return static_cast<std::uint32_t>(base::kWaveWidth / invocations);
}

}  // namespace

Scalarizer::Scalarizer(const ir::Function& function, std::string& error, bool accesses_stay)
    : ir_(function), error_(error) {
  out_.accesses_stay = accesses_stay;
  out_.ir = &function;
  out_.writes_memory = writes_memory(function.body);
  out_.groups_per_wave = groups_per_wave(function);
  out_.uses_subgroups = has_any(function.body, is_of_subgroups);
  first_.assign(function.values.size(), kNoIndex);
}

ScalarFunction Scalarizer::run() {
  if (const ListEnd end = build_list(ir_.body, {}); end.falls) emit_jump(Kind::kReturn, kNoScalar, nullptr);
  return std::move(out_);
}

ScalarId Scalarizer::constant(std::uint32_t bits, bool boolean) {
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

void Scalarizer::define(ir::ValueId value, std::span<const ScalarId> ids) {
  if (value == ir::kNoValue) return;
  if (value >= first_.size()) return fail("value id out of range");
  first_[value] = static_cast<std::uint32_t>(components_.size());
  components_.insert(components_.end(), ids.begin(), ids.end());
  for (std::size_t i = ids.size(); i < ir_.values[value].components; ++i) components_.push_back(ids.back());
}

ScalarId Scalarizer::component(const ir::Src& src, std::uint32_t i) {
  if (src.value >= first_.size() || first_[src.value] == kNoIndex) {
    fail("use of a value before its definition");
    return constant(0, false);
  }
  const std::uint32_t c = src.swizzle[i & 3];
  return components_[first_[src.value] + (c < ir_.values[src.value].components ? c : 0)];
}

void Scalarizer::append(std::vector<ScalarId>& ids, const ir::Src& src, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) ids.push_back(component(src, i));
}

std::vector<ScalarId> Scalarizer::arguments(const std::vector<ir::Src>& sources,
                                            const std::vector<ir::ValueId>& targets) {
  std::vector<ScalarId> ids;
  if (sources.size() != targets.size()) fail("join with the wrong number of values");
  for (std::size_t i = 0; i < sources.size() && i < targets.size(); ++i)
    append(ids, sources[i], ir_.values[targets[i]].components);
  return ids;
}

std::vector<ScalarId> Scalarizer::new_joins(const std::vector<ir::ValueId>& values) {
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

void Scalarizer::define_all(const std::vector<ir::ValueId>& values, const std::vector<ScalarId>& ids) {
  std::size_t next = 0;
  for (const ir::ValueId value : values) {
    const std::size_t count = ir_.values[value].components;
    if (next + count > ids.size()) return fail("too few values for a join");
    define(value, std::span(ids).subspan(next, count));
    next += count;
  }
}

void Scalarizer::fail(const char* what) {
  if (error_.empty()) error_ = what;
}

Key Scalarizer::key_of(Op op, std::span<const ScalarId> sources, const ir::Instr* instr) const {
  Key key;
  key.words[0] = 16 + static_cast<std::uint32_t>(op);
  for (std::size_t i = 0; i < sources.size() && i < 4; ++i) key.words[1 + i] = sources[i] + 1;
  if (instr)
    for (int i = 0; i < 4; ++i) key.words[5 + i] = instr->data[i];
  if (instr)
    key.words[9] =
        (instr->op == Op::kArrayLength ? instr->imm[0] * 65599u : 0) + instr->imm[1] + instr->components * 0x1000000u;
  return key;
}

std::uint32_t Scalarizer::fold(Op op, std::span<const ScalarId> sources) {
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

ScalarId Scalarizer::alu(Op op, std::span<const ScalarId> given, const ir::Instr* instr) {
  std::array<ScalarId, 3> copy{};
  std::copy(given.begin(), given.end(), copy.begin());
  if (commutes(op) && copy[1] < copy[0]) std::swap(copy[0], copy[1]);
  if (op == Op::kFDiv && level(copy[1]) == Level::kConstant) {
    // Both are the same number rounded once; LLVM multiplies, too (InstCombineMulDivRem.cpp: foldFDivConstantDivisor).
    if (const std::uint32_t reciprocal = exact_reciprocal(out_.scalars[copy[1]].bits)) {
      op = Op::kFMul;
      copy[1] = constant(reciprocal, false);
    }
  }
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
  out.instr = instr != nullptr ? instr : here_;
  return emit_pure(out, key_of(op, sources, nullptr), sources, 1, boolean, highest <= Level::kUniform)[0];
}

std::vector<ScalarId> Scalarizer::emit_pure(ScalarOp op, const Key& key, std::span<const ScalarId> sources,
                                            std::uint32_t count, bool boolean, bool uniform) {
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

std::vector<ScalarId> Scalarizer::emit(const ir::Instr& instr, std::span<const ScalarId> sources, std::uint32_t count,
                                       bool boolean) {
  ScalarOp op;
  op.kind = Kind::kIntrinsic;
  op.op = instr.op;
  op.instr = &instr;
  set_load_offsets(op);
  std::vector<ScalarId> ids;
  for (std::uint32_t i = 0; i < count; ++i) ids.push_back(out_.add(boolean, Level::kVarying));
  op.src = out_.add_operands(sources);
  op.dst = out_.add_operands(ids);
  out_.body.push_back(op);
  return ids;
}

void Scalarizer::build_alu(const ir::Instr& instr) {
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

ScalarFunction scalarize(const ir::Function& function, std::string& error, bool accesses_stay) {
  return Scalarizer(function, error, accesses_stay).run();
}

}  // namespace vitrine::spirv::lowering
