// Blocks that the same lanes come by: one probe tells of them all, so that counting costs less, and does not stand
// between operations that belong together.
#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

/// Whether the lanes behind it are those in front of it.
bool keeps_lanes(const ScalarOp& op) {
  if (op.kind == Kind::kTurn) return true;
  if (op.kind != Kind::kIntrinsic)
    return op.kind == Kind::kAlu || op.kind == Kind::kMove || op.kind == Kind::kMaskedMove;
  switch (op.op) {
    case ir::Op::kProbe:
    case ir::Op::kLoadInput:
    case ir::Op::kStoreOutput:
    case ir::Op::kLoadPush:
    case ir::Op::kLoadUniform:
    case ir::Op::kLoadStorage:
    case ir::Op::kStoreStorage:
    case ir::Op::kLoadGlobal:
    case ir::Op::kStoreGlobal:
    case ir::Op::kLoadShared:
    case ir::Op::kStoreShared:
    case ir::Op::kLoadArray:
    case ir::Op::kStoreArray:
    case ir::Op::kImage:
      return true;
    default:
      return false;
  }
}

bool is_probe(const ScalarOp& op) { return op.kind == Kind::kIntrinsic && op.op == ir::Op::kProbe; }

/// A probe that tells of a block and of all active lanes.
bool tells_of_block(const ScalarFunction& f, const ScalarOp& op) {
  if (!is_probe(op) || f.ir->probes[op.instr->data[0]].kind != Probe::Kind::kBlock) return false;
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

}  // namespace

std::optional<bool> guard_outcome(const ScalarFunction& function, const ScalarOp& probe, std::uint32_t guard) {
  const Scalar& condition = function.scalars[function.of(probe.src)[guard]];
  if (condition.level != Level::kConstant) return std::nullopt;
  return (condition.bits != 0) == guard_holds(*probe.instr, guard);
}

void join_probes(ScalarFunction& function) {
  std::vector<ScalarOp>& body = function.body;
  std::size_t first = body.size();  // the probe that tells of the others
  for (std::size_t i = 0; i < body.size(); ++i) {
    if (body[i].dead || (body[i].dead = is_never_reached(function, body[i]))) continue;
    if (!keeps_lanes(body[i])) {
      first = body.size();
    } else if (tells_of_block(function, body[i])) {
      if (first == body.size()) {
        first = i;
        continue;
      }
      std::uint32_t& joined = body[first].joined;
      if (joined == kNoIndex) {
        joined = static_cast<std::uint32_t>(function.joined_probes.size());
        function.joined_probes.emplace_back();
      }
      function.joined_probes[joined].push_back(body[i].instr->data[0]);
      body[i].dead = true;
    }
  }
}

}  // namespace vitrine::spirv::lowering
