// Handlers of operations on booleans: a wave's boolean is one 64-bit lane mask, so no vector is needed. Bits of
// inactive lanes mean nothing.
#include "spirv/alu/family.h"

namespace vitrine::spirv::alu {
namespace {

using ir::Op;

/// One operation on all bits of its operands. For words of the uniform file, bit 0 is the boolean.
template <class Bits>
constexpr Bits apply(Op op, Bits a, Bits b, Bits c) {
  switch (op) {
    case Op::kMovB:
      return a;
    case Op::kAndB:
      return a & b;
    case Op::kOrB:
      return a | b;
    case Op::kXorB:
      return a ^ b;
    case Op::kEqB:
      return ~(a ^ b);
    case Op::kNotB:
      return ~a;
    default:
      return (a & b) | (~a & c);  // kSelectB
  }
}

template <Op op, unsigned sources>
const Instruction* wave_handler(Wave& wave, const Instruction* instruction) {
  const auto source = [&](unsigned index) {
    return index < sources ? wave.masks[instruction->src[index] / 8] : base::LaneMask{0};
  };
  wave.masks[instruction->dst / 8] = apply(op, source(0), source(1), source(2));
  return instruction + 1;
}

template <Op op, unsigned sources>
const Instruction* scalar_handler(Wave& wave, const Instruction* instruction) {
  const auto source = [&](unsigned index) {
    return index < sources ? wave.uniforms[instruction->src[index] / 4] : std::uint32_t{0};
  };
  wave.uniforms[instruction->dst / 4] = apply(op, source(0), source(1), source(2)) & 1u;
  return instruction + 1;
}

template <Op op, unsigned sources>
constexpr OpHandlers handlers_of() {
  OpHandlers handlers;
  for (Handler& handler : handlers.wave) handler = wave_handler<op, sources>;
  handlers.scalar = scalar_handler<op, sources>;
  return handlers;
}

struct Table {
  OpHandlers op[static_cast<std::size_t>(Op::kExecutedCount)];
  constexpr OpHandlers& operator[](Op which) { return op[static_cast<std::size_t>(which)]; }
};

constexpr Table make_table() {
  Table table;
  table[Op::kMovB] = handlers_of<Op::kMovB, 1>();
  table[Op::kAndB] = handlers_of<Op::kAndB, 2>();
  table[Op::kOrB] = handlers_of<Op::kOrB, 2>();
  table[Op::kXorB] = handlers_of<Op::kXorB, 2>();
  table[Op::kEqB] = handlers_of<Op::kEqB, 2>();
  table[Op::kNotB] = handlers_of<Op::kNotB, 1>();
  table[Op::kSelectB] = handlers_of<Op::kSelectB, 3>();
  return table;
}

constexpr Table kTable = make_table();

}  // namespace

Family boolean_family() { return kTable.op; }

}  // namespace vitrine::spirv::alu
