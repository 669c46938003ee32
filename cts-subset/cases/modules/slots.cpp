// What a module reads and writes, spelled in GLSL.
#include "cases/modules/slots.h"

#include "harness/gpu.h"

namespace vitrine::cts {

using spv::Op;
using Type = Reflection::Type;

Slot slot_of(const Reflection& r, uint32_t id) {
  const Type& t = r.type(id);
  Slot slot;
  switch (t.op) {
    case Op::OpTypeFloat:
    case Op::OpTypeInt:
      if (t.operands[0] != 32) throw Unsupported("width of an input or output");
      slot.scalar = t.op == Op::OpTypeFloat ? "float" : t.operands[1] ? "int" : "uint";
      return slot;
    case Op::OpTypeVector:
      slot = slot_of(r, t.operands[0]);
      slot.components = t.operands[1];
      return slot;
    case Op::OpTypeMatrix:
      slot = slot_of(r, t.operands[0]);
      slot.columns = t.operands[1];
      return slot;
    case Op::OpTypeArray:
      slot = slot_of(r, t.operands[0]);
      slot.lengths.insert(slot.lengths.begin(), r.length(t, 0));
      return slot;
    default:
      throw Unsupported("input or output of a block");
  }
}

std::string glsl_type(const Slot& slot) {
  if (slot.columns > 1) return "mat" + std::to_string(slot.columns) + "x" + std::to_string(slot.components);
  if (slot.components == 1) return slot.scalar;
  return (slot.scalar == "float" ? "" : slot.scalar.substr(0, 1)) + "vec" + std::to_string(slot.components);
}

/// An expression of random numbers, `seed` + the vertex index apart.
std::string random_value(const Slot& slot, uint32_t seed) {
  std::string parts;
  for (uint32_t i = 0; i < slot.components * slot.columns; i++)
    parts += (i ? ", " : "") + std::string(slot.scalar == "float" ? "number(" : slot.scalar + "(0.8 * number(") +
             std::to_string(seed + i) + "u)" + (slot.scalar == "float" ? "" : ")");
  return glsl_type(slot) + "(" + parts + ")";
}

std::string numbers_of(const std::string& index) {
  return R"(
float number(uint k) {
  k = (k + uint()" +
         index + R"() * 977u) * 747796405u + 2891336453u;
  k = ((k >> ((k >> 28) + 4u)) ^ k) * 277803737u;
  return float((k >> 22 ^ k) & 0xffffu) / 32768.0 * 1.25 - 0.25;
}
)";
}

}  // namespace vitrine::cts
