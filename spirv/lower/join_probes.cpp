// Blocks that the same lanes come by: one probe tells of them all, so that counting costs less, and does not stand
// between operations that belong together.
#include <algorithm>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

/// Whether the lanes behind it are those in front of it.
bool keeps_lanes(const ScalarOp& op) {
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

/// A probe that tells of a block and of all active lanes.
bool tells_of_block(const ScalarFunction& f, const ScalarOp& op) {
  return op.kind == Kind::kIntrinsic && op.op == ir::Op::kProbe && op.instr->data[1] == 0 &&
         f.ir->probes[op.instr->data[0]].kind == Probe::Kind::kBlock;
}

}  // namespace

void join_probes(ScalarFunction& function) {
  std::vector<ScalarOp>& body = function.body;
  std::size_t first = body.size(), end = 0;  // the probe that tells of the others, and where those end that it tells of
  for (std::size_t i = 0; i < body.size(); ++i) {
    if (body[i].dead) continue;
    if (!keeps_lanes(body[i])) {
      first = body.size();
    } else if (tells_of_block(function, body[i])) {
      if (first == body.size()) {
        first = i;
        end = i + 1;
        continue;
      }
      std::uint32_t& joined = body[first].joined;
      if (joined == kNoIndex) {
        joined = static_cast<std::uint32_t>(function.joined_probes.size());
        function.joined_probes.emplace_back();
      }
      function.joined_probes[joined].push_back(body[i].instr->data[0]);
      body[i].dead = true;
      // Out of the way of what lies between: no construct begins or ends there, so that nobody names those places.
      const auto at = body.begin() + static_cast<std::ptrdiff_t>(i);
      std::rotate(body.begin() + static_cast<std::ptrdiff_t>(end++), at, at + 1);
    }
  }
}

}  // namespace vitrine::spirv::lowering
