// Superinstructions: multiplications fused into the additions that use them, and the order of straight-line arithmetic
// chosen so that a value is used right after it is computed and can stay in SIMD registers (spirv/exec/chain.h).
#include <algorithm>

#include "spirv/exec/chain.h"
#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

using exec::Link;
using ir::Op;

/// Links of one chain: bounds the stack in builds without tail calls.
constexpr std::uint32_t kMaxChain = 48;

void count_sources(const ScalarFunction& f, const ScalarOp& op, std::vector<std::uint32_t>& uses) {
  if (op.reads_condition()) ++uses[op.cond];
  for (const ScalarId id : f.of(op.test_sources)) ++uses[id];
  for (const ScalarId id : f.of(op.src)) ++uses[id];
}

/// Uses in the program that nobody observes: without probes and the arithmetic that only they need.
std::vector<std::uint32_t> count_plain_uses(const ScalarFunction& f) {
  std::vector<std::uint32_t> uses(f.scalars.size(), 0);
  for (const ScalarId id : f.outputs)
    if (id != kNoScalar) ++uses[id];
  // Backwards, as arithmetic is used behind where it is.
  for (auto op = f.body.rbegin(); op != f.body.rend(); ++op) {
    const bool probe = op->kind == Kind::kIntrinsic && op->op == Op::kProbe;
    const bool needed = op->kind != Kind::kAlu || uses[f.operands[op->dst.begin]] != 0;
    if (!op->dead && !probe && needed) count_sources(f, *op, uses);
  }
  return uses;
}

bool varying(const ScalarFunction& f, ScalarId id) { return f.scalars[id].level == Level::kVarying; }

/// Replaces `a * b` used once, by an addition or subtraction of the same stretch, by one two-rounding operation. Of two
/// NaNs a product's survives then; so it does where a probe, too, reads the product, which has to stay.
class MultiplyAdd {
 public:
  explicit MultiplyAdd(ScalarFunction& function)
      : f_(function),
        uses_(count_plain_uses(function)),
        all_uses_(count_uses(function)),
        product_(function.scalars.size(), kNoIndex) {}

  void run() {
    std::uint32_t stretch_start = 0;
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
      const ScalarOp& op = f_.body[i];
      if (op.dead) continue;
      if (op.kind != Kind::kAlu && op.kind != Kind::kIntrinsic) stretch_start = i;
      if (op.kind != Kind::kAlu || !varying(f_, f_.operands[op.dst.begin])) continue;
      if (op.op == Op::kFMul) product_[f_.operands[op.dst.begin]] = i;
      if (op.op == Op::kFAdd || op.op == Op::kFSub) fuse(i, stretch_start);
    }
  }

 private:
  void fuse(std::uint32_t i, std::uint32_t stretch_start) {
    const ScalarId a = f_.operands[f_.body[i].src.begin], b = f_.operands[f_.body[i].src.begin + 1];
    const auto fusible = [&](ScalarId id) {
      return product_[id] != kNoIndex && product_[id] >= stretch_start && uses_[id] == 1;
    };
    if (a == b) return;
    const bool add = f_.body[i].op == Op::kFAdd;
    if (fusible(b)) {
      replace(i, b, a, add ? Op::kFMulAdd : Op::kFNMulAdd);
    } else if (fusible(a)) {
      replace(i, a, b, add ? Op::kFMulAdd : Op::kFMulSub);
    }
  }

  void replace(std::uint32_t i, ScalarId product, ScalarId addend, Op op) {
    if (all_uses_[product] != 1) {
      const ScalarId sources[2] = {product, addend};
      if (f_.body[i].op == Op::kFAdd) f_.body[i].src = f_.add_operands(sources);
      return;
    }
    ScalarOp& multiply = f_.body[product_[product]];
    const ScalarId sources[3] = {f_.operands[multiply.src.begin], f_.operands[multiply.src.begin + 1], addend};
    multiply.dead = true;
    f_.body[i].op = op;
    f_.body[i].src = f_.add_operands(sources);
  }

  ScalarFunction& f_;
  std::vector<std::uint32_t> uses_, all_uses_;  ///< by the plain program; by probes, too
  std::vector<std::uint32_t> product_;          ///< per scalar: the multiplication in the body that gives it
};

/// Whether any two of three sources may be exchanged.
bool is_symmetric(Op op) { return op == Op::kIAdd3 || op == Op::kXor3 || op == Op::kMajority; }

/// Whether the first two sources may be exchanged. Those of sums and products of floats are not: of two NaNs the first
/// operand's survives, in a program that somebody observes, where chains are others, as in the plain one.
bool swappable(Op op) {
  switch (op) {
    case Op::kIAdd:
    case Op::kIMul:
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
    case Op::kRotRXor:
    case Op::kIMulAdd:
      return true;
    default:
      return is_symmetric(op);
  }
}

class ChainScheduler {
 public:
  /// `apart`: the order of chains, of which every operation stores its result, as in targets without them.
  ChainScheduler(ScalarFunction& function, bool apart)
      : f_(function),
        connects_(!apart && exec::chain_handler(Op::kOr, exec::kNoAccumulator, 0, Link::kKeep) != nullptr),
        uses_(count_uses(function)),
        definition_(function.scalars.size(), kNoIndex) {}

  void run() {
    for (std::uint32_t i = 0; i < f_.body.size();) {
      std::uint32_t end = i;
      while (end < f_.body.size() && f_.body[end].kind == Kind::kAlu) ++end;
      if (end - i > 1) schedule(i, end);
      i = std::max(end, i + 1);
    }
  }

 private:
  ScalarId result(std::uint32_t i) const { return f_.operands[f_.body[i].dst.begin]; }

  void schedule(std::uint32_t begin, std::uint32_t end) {
    begin_ = begin;
    const std::uint32_t count = end - begin;
    users_.assign(count, {});
    missing_.assign(count, 0);
    emitted_.assign(count, 0);
    order_.clear();
    for (std::uint32_t i = begin; i < end; ++i) definition_[result(i)] = i - begin;
    for (std::uint32_t i = begin; i < end; ++i)
      for (const ScalarId id : f_.of(f_.body[i].src)) {
        if (definition_[id] == kNoIndex) continue;
        users_[definition_[id]].push_back(i - begin);
        ++missing_[i - begin];
      }
    for (std::uint32_t i = 0; i < count; ++i)  // scalars first: they would break chains
      if (!varying(f_, result(begin + i))) emit(i);
    for (std::uint32_t i = 0; i < count; ++i)
      if (!emitted_[i]) emit_chain(i);
    std::vector<ScalarOp> ordered;
    for (const std::uint32_t i : order_) ordered.push_back(f_.body[begin + i]);
    std::copy(ordered.begin(), ordered.end(), f_.body.begin() + begin);
    for (std::uint32_t i = begin; i < end; ++i) definition_[result(i)] = kNoIndex;
  }

  void emit(std::uint32_t i) {
    emitted_[i] = 1;
    order_.push_back(i);
    for (const std::uint32_t user : users_[i]) --missing_[user];
  }

  void emit_chain(std::uint32_t first) {
    emit(first);
    if (!exec::is_chain_link(f_.body[begin_ + first].op, exec::kNoAccumulator, uniform_sources(first, 0), Link::kKeep))
      return;
    std::uint32_t current = first;
    for (std::uint32_t length = 1; length < kMaxChain; ++length) {
      if (f_.scalars[result(begin_ + current)].boolean) break;
      const std::uint32_t next = pick_user(current);
      if (next == kNoIndex) break;
      if (connects_) connect(current, next);
      emit(next);
      current = next;
    }
  }

  /// `next` takes the result of `current` as its accumulator.
  void connect(std::uint32_t current, std::uint32_t next) {
    ScalarOp& from = f_.body[begin_ + current];
    ScalarOp& to = f_.body[begin_ + next];
    const std::uint32_t taken = to.accumulator == exec::kAllSources ? 2 : 1;
    from.link = uses_[result(begin_ + current)] == taken ? Link::kKeep : Link::kStore;
    from.in_chain = true;
    to.in_chain = true;
    to.link = Link::kLast;
  }

  /// Bit i: source i is a word; `skip`: sources that are the accumulator.
  UniformSources uniform_sources(std::uint32_t i, unsigned skip) const {
    UniformSources uniform = 0;
    const auto sources = f_.of(f_.body[begin_ + i].src);
    for (std::uint32_t k = 0; k < sources.size(); ++k)
      if (!(skip >> k & 1) && !f_.scalars[sources[k]].boolean && !varying(f_, sources[k]))
        uniform = static_cast<UniformSources>(uniform | 1u << k);
    return uniform;
  }

  /// A user of `current` that can run now and take it as its accumulator.
  std::uint32_t pick_user(std::uint32_t current) {
    for (const std::uint32_t user : users_[current])
      if (!emitted_[user] && missing_[user] == 0 && set_accumulator(user, result(begin_ + current))) return user;
    return kNoIndex;
  }

  bool set_accumulator(std::uint32_t user, ScalarId value) {
    ScalarOp& op = f_.body[begin_ + user];
    const auto sources = f_.of(op.src);
    if (sources.size() >= 2 && sources[0] == value && sources[1] == value &&
        try_accumulator(user, exec::kAllSources, 3))
      return true;
    if (is_symmetric(op.op) && sources[2] == value && sources[0] != value) std::swap(sources[0], sources[2]);
    if (swappable(op.op) && sources[1] == value && sources[0] != value) std::swap(sources[0], sources[1]);
    for (int k = 0; k < static_cast<int>(sources.size()); ++k)
      if (sources[static_cast<std::size_t>(k)] == value && try_accumulator(user, k, 1u << k)) return true;
    return false;
  }

  bool try_accumulator(std::uint32_t user, int accumulator, unsigned skip) {
    ScalarOp& op = f_.body[begin_ + user];
    if (!exec::is_chain_link(op.op, accumulator, uniform_sources(user, skip), Link::kLast)) return false;
    if (connects_) op.accumulator = accumulator;
    return true;
  }

  ScalarFunction& f_;
  const bool connects_;
  std::vector<std::uint32_t> uses_;
  std::vector<std::uint32_t> definition_;  ///< per scalar: operation of the current stretch that gives it
  std::uint32_t begin_ = 0;
  std::vector<std::vector<std::uint32_t>> users_;
  std::vector<std::uint32_t> missing_;
  std::vector<std::uint8_t> emitted_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

std::vector<std::uint32_t> count_uses(const ScalarFunction& f) {
  std::vector<std::uint32_t> uses(f.scalars.size(), 0);
  for (const ScalarOp& op : f.body)
    if (!op.dead) count_sources(f, op, uses);
  for (const ScalarId id : f.outputs)
    if (id != kNoScalar) ++uses[id];
  return uses;
}

void fuse_multiply_add(ScalarFunction& function) { MultiplyAdd(function).run(); }
void schedule_chains(ScalarFunction& function, bool apart) { ChainScheduler(function, apart).run(); }

}  // namespace vitrine::spirv::lowering
