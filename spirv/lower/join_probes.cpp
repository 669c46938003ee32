// Blocks that the same lanes come by: one probe tells of them all, so that counting costs less, and does not stand
// between operations that belong together.
#include <algorithm>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};

bool is_probe(const ScalarOp& op) { return op.kind == Kind::kIntrinsic && op.op == ir::Op::kProbe; }

bool is_block_probe(const ScalarFunction& f, const ScalarOp& op) {
  return is_probe(op) && f.ir->probes[op.instr->data[0]].kind == Probe::Kind::kBlock;
}

/// A probe that tells of a block and of all active lanes.
bool tells_of_block(const ScalarFunction& f, const ScalarOp& op) {
  if (!is_block_probe(f, op)) return false;
  for (std::uint32_t k = 0; k < op.instr->data[1]; ++k)
    if (!guard_outcome(f, op, k)) return false;
  return true;
}

/// Whether no lane can come by a probe.
bool is_never_reached(const ScalarFunction& f, const ScalarOp& op) {
  for (std::uint32_t k = 0; is_probe(op) && k < op.instr->data[1]; ++k)
    if (guard_outcome(f, op, k) == false) return true;
  return false;
}

/// In which turns of a loop lanes come by a probe at its top: all of them or none.
struct Turns {
  bool first = true, later = true;
};

class Joiner {
 public:
  explicit Joiner(ScalarFunction& function) : f_(function), body_(function.body) {}

  void run() {
    for (std::size_t i = 0; i < body_.size(); ++i) {
      if (body_[i].dead || (body_[i].dead = is_never_reached(f_, body_[i]))) continue;
      see(i);
    }
  }

 private:
  /// What is open: a branch or a loop.
  struct Scope {
    std::size_t before = kNone;  ///< the probe that tells of the lanes that came to it
    bool leaves = false;         ///< some may not come to its end
    bool is_loop = false;
    bool continues = false;           ///< of a loop: some may end a turn early
    std::size_t top = kNone;          ///< of a loop: the probe that tells of all lanes that begin a turn
    std::vector<std::size_t> tops{};  ///< further probes at its top, of some turns only
  };

  void see(std::size_t i) {
    switch (body_[i].kind) {
      case Kind::kIf:
        return open(false);
      case Kind::kElse:
        return part();
      case Kind::kEndIf:
        return end_if();
      case Kind::kLoop:
        return open(true);
      case Kind::kContinuing:
        if (scopes_.back().continues) part();  // they join
        return;
      case Kind::kContinue:
        std::ranges::find_if(scopes_.rbegin(), scopes_.rend(), &Scope::is_loop)->continues = true;
        return leave();
      case Kind::kEndLoop:
        end_loop(i);
        return leave();
      case Kind::kTurn:
      case Kind::kAlu:
      case Kind::kMove:
      case Kind::kMaskedMove:
        return;
      case Kind::kIntrinsic:
        if (is_block_probe(f_, body_[i])) return probe(i);
        if (body_[i].op == ir::Op::kDemote) leave();
        return;
      default:
        return leave();
    }
  }

  void open(bool loop) {
    scopes_.push_back({.before = told_, .is_loop = loop});
    part();
    at_top_ = loop;
  }

  /// Other lanes than before may be active.
  void part() {
    told_ = kNone;
    at_top_ = false;
  }

  /// Lanes that were active may not come any further.
  void leave() {
    part();
    for (Scope& scope : scopes_) scope.leaves = true;
  }

  void end_if() {
    part();
    if (!scopes_.back().leaves) told_ = scopes_.back().before;
    scopes_.pop_back();
  }

  void probe(std::size_t i) {
    if (!tells_of_block(f_, body_[i])) {
      if (at_top_) scopes_.back().tops.push_back(i);
    } else if (told_ != kNone) {
      join(told_, i);
      body_[i].dead = true;
    } else {
      told_ = i;
      if (at_top_) scopes_.back().top = i;
    }
  }

  /// The lanes that begin a turn are those that came to the loop, then those that ended a turn.
  void end_loop(std::size_t end) {
    const Scope& scope = scopes_.back();
    const std::size_t first = scope.before, later = told_;
    if (body_[end].falls && later != kNone && later != scope.top) {
      if (scope.top != kNone && first != kNone) move_top(scope.top, Turns{}, first, later);
      for (const std::size_t i : scope.tops)
        if (const auto turns = turns_of(body_[i], body_[body_[end].partner]);
            turns && (first != kNone || !turns->first))
          move_top(i, *turns, first, later);
    }
    scopes_.pop_back();
  }

  void move_top(std::size_t i, Turns turns, std::size_t first, std::size_t later) {
    if (turns.first) join(first, i);
    if (turns.later) join(later, i);
    body_[i].dead = true;
  }

  /// Of a probe at the top of a loop whose conditions are variables of the loop that tell the first turn from others.
  std::optional<Turns> turns_of(const ScalarOp& probe, const ScalarOp& loop) const {
    Turns turns;
    const auto params = f_.of(loop.dst);
    for (std::uint32_t k = 0; k < probe.instr->data[1]; ++k) {
      if (guard_outcome(f_, probe, k)) continue;  // it holds
      const ScalarId flag = f_.of(probe.src)[k];
      const std::vector<ScalarId>& values = f_.join_sources[flag];
      if (std::ranges::find(params, flag) == params.end() || values.size() != 2) return std::nullopt;
      for (const ScalarId value : values)
        if (f_.scalars[value].level != Level::kConstant) return std::nullopt;
      const bool holds = guard_holds(*probe.instr, k);
      turns.first &= (f_.scalars[values[0]].bits != 0) == holds;
      turns.later &= (f_.scalars[values[1]].bits != 0) == holds;
    }
    return turns;
  }

  std::vector<std::uint32_t>& joined_by(std::size_t i) {
    std::uint32_t& joined = body_[i].joined;
    if (joined == kNoIndex) {
      joined = static_cast<std::uint32_t>(f_.joined_probes.size());
      f_.joined_probes.emplace_back();
    }
    return f_.joined_probes[joined];
  }

  /// Lets probe `to` tell of what probe `from` tells of, too.
  void join(std::size_t to, std::size_t from) {
    joined_by(to).push_back(body_[from].instr->data[0]);
    if (body_[from].joined == kNoIndex) return;
    const std::vector<std::uint32_t> rows = f_.joined_probes[body_[from].joined];
    joined_by(to).insert(joined_by(to).end(), rows.begin(), rows.end());
  }

  ScalarFunction& f_;
  std::vector<ScalarOp>& body_;
  std::vector<Scope> scopes_;
  std::size_t told_ = kNone;  ///< the probe that tells of all lanes that are active
  bool at_top_ = false;       ///< of the innermost loop: in front of all that may end a lane's turn
};

}  // namespace

std::optional<bool> guard_outcome(const ScalarFunction& function, const ScalarOp& probe, std::uint32_t guard) {
  const Scalar& condition = function.scalars[function.of(probe.src)[guard]];
  if (condition.level != Level::kConstant) return std::nullopt;
  return (condition.bits != 0) == guard_holds(*probe.instr, guard);
}

void join_probes(ScalarFunction& function) { Joiner(function).run(); }

}  // namespace vitrine::spirv::lowering
