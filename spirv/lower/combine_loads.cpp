// Addresses: constants added to an address move into the instruction, and loads that differ only by that constant
// become one instruction, which looks at the pattern of the addresses once.
#include <algorithm>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Op;

constexpr std::uint32_t kMaxWords = 4;

/// Source that is the byte offset, or kNoIndex.
std::uint32_t address_source(const ScalarOp& op) {
  if (op.kind != Kind::kIntrinsic) return kNoIndex;
  switch (op.op) {
    case Op::kLoadUniform:
    case Op::kLoadStorage:
    case Op::kStoreStorage:
      return 1;
    case Op::kLoadPush:
    case Op::kLoadShared:
    case Op::kStoreShared:
      return 0;
    default:
      return kNoIndex;
  }
}

bool is_load(const ScalarOp& op) {
  return address_source(op) != kNoIndex && op.op != Op::kStoreStorage && op.op != Op::kStoreShared &&
         op.instr->imm[2] == 0;
}

class LoadCombiner {
 public:
  explicit LoadCombiner(ScalarFunction& function) : f_(function), definition_(function.scalars.size(), kNoIndex) {}

  void run() {
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
      ScalarOp& op = f_.body[i];
      if (op.dead) continue;
      if (op.kind == Kind::kAlu) {
        definition_[f_.operands[op.dst.begin]] = i;
      } else if (op.kind != Kind::kIntrinsic && op.kind != Kind::kMove) {
        recent_.clear();
      } else if (address_source(op) != kNoIndex) {
        fold_constants(op);
      }
      forget(op);
      if (op.kind == Kind::kIntrinsic && is_load(op) && varying(f_.operands[op.dst.begin])) combine(i);
    }
  }

 private:
  bool varying(ScalarId id) const { return f_.scalars[id].level == Level::kVarying; }

  void fold_constants(ScalarOp& op) {
    ScalarId& address = f_.operands[op.src.begin + address_source(op)];
    while (varying(address) && definition_[address] != kNoIndex) {
      const ScalarOp& add = f_.body[definition_[address]];
      if (add.op != Op::kIAdd) return;
      const ScalarId a = f_.operands[add.src.begin], b = f_.operands[add.src.begin + 1];
      if (f_.scalars[a].level == Level::kConstant) {
        op.offset += f_.scalars[a].bits;
        address = b;
      } else if (f_.scalars[b].level == Level::kConstant) {
        op.offset += f_.scalars[b].bits;
        address = a;
      } else {
        return;
      }
    }
  }

  /// Loads must not move over an operation that may change what they read.
  void forget(const ScalarOp& op) {
    if (op.kind != Kind::kIntrinsic) return;
    const bool barrier = op.op == Op::kBarrier || op.op == Op::kMemoryBarrier;
    const bool image = op.op == Op::kImage && (op.instr->image->access == ir::ImageAccess::kWrite ||
                                               op.instr->image->access == ir::ImageAccess::kAtomic);
    const bool storage = barrier || image || op.op == Op::kStoreStorage || op.op == Op::kAtomicStorage;
    const bool shared = barrier || op.op == Op::kStoreShared || op.op == Op::kAtomicShared;
    if (!storage && !shared) return;
    std::erase_if(recent_, [&](std::uint32_t i) {
      const Op load = f_.body[i].op;
      return (storage && load == Op::kLoadStorage) || (shared && load == Op::kLoadShared);
    });
  }

  bool same_place(const ScalarOp& a, const ScalarOp& b) const {
    if (a.op != b.op || a.instr->imm[1] != b.instr->imm[1]) return false;
    const bool buffer = a.op == Op::kLoadUniform || a.op == Op::kLoadStorage;
    if (buffer && !std::equal(a.instr->data, a.instr->data + 3, b.instr->data)) return false;
    const auto x = f_.of(a.src), y = f_.of(b.src);
    return std::equal(x.begin(), x.end(), y.begin(), y.end());
  }

  static std::uint32_t first_byte(const ScalarOp& op) {
    return (op.op == Op::kLoadPush ? op.instr->data[0] : op.instr->data[3]) + op.offset;
  }

  void combine(std::uint32_t i) {
    ScalarOp& op = f_.body[i];
    for (const std::uint32_t earlier : recent_) {
      ScalarOp& first = f_.body[earlier];
      const std::uint32_t distance = first_byte(op) - first_byte(first);
      if (first.dst.count + op.dst.count > kMaxWords || !same_place(first, op) || distance >= 0x80000000u) continue;
      std::vector<ScalarId> results(f_.of(first.dst).begin(), f_.of(first.dst).end());
      for (std::uint32_t c = 0; c < op.dst.count; ++c) {
        first.at[first.dst.count + c] = distance + op.at[c];
        results.push_back(f_.operands[op.dst.begin + c]);
      }
      first.dst = f_.add_operands(results);
      op.dead = true;
      return;
    }
    recent_.push_back(i);
  }

  ScalarFunction& f_;
  std::vector<std::uint32_t> definition_;  ///< per scalar: the ALU operation that gives it
  std::vector<std::uint32_t> recent_;      ///< loads of the current stretch that others may join
};

}  // namespace

void combine_loads(ScalarFunction& function) {
  if (!function.accesses_stay) LoadCombiner(function).run();
}

}  // namespace vitrine::spirv::lowering
