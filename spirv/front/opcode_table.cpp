// Dispatch from opcodes.def: one row per SPIR-V opcode, found by number.
#include <algorithm>
#include <array>

#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

struct Row {
  std::uint16_t opcode;
  ir::Op op;
  void (*translate)(Translator&, const Inst&, ir::Op);
};

constexpr Row kRows[] = {
#define VITRINE_OPCODE(name, function, op, effect) \
  {static_cast<std::uint16_t>(spv::Op::Op##name), ir::Op::k##op, function},
#define VITRINE_NUMBERED_OPCODE(name, number, function, op, effect) {number, ir::Op::k##op, function},
#include "spirv/opcodes.def"
#undef VITRINE_OPCODE
#undef VITRINE_NUMBERED_OPCODE
};

/// kRows sorted by opcode.
const auto& sorted_rows() {
  static const auto rows = [] {
    std::array<Row, std::size(kRows)> sorted;
    std::copy(std::begin(kRows), std::end(kRows), sorted.begin());
    std::sort(sorted.begin(), sorted.end(), [](const Row& a, const Row& b) { return a.opcode < b.opcode; });
    return sorted;
  }();
  return rows;
}

}  // namespace

void translate_instruction(Translator& t, const Inst& inst) {
  const auto& rows = sorted_rows();
  const auto opcode = static_cast<std::uint16_t>(inst.op);
  const auto row = std::lower_bound(rows.begin(), rows.end(), opcode,
                                    [](const Row& a, std::uint16_t wanted) { return a.opcode < wanted; });
  if (row == rows.end() || row->opcode != opcode) fail(inst, "is not supported");
  t.exact = is_exact(t, inst);
  row->translate(t, inst, row->op);
  t.exact = false;
}

}  // namespace vitrine::spirv::front
