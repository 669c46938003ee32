// A module's instructions, types and decorations, found by id (SPIR-V 1.6, section 2.4: logical layout).
#include "spirv/front/module.h"

#include <algorithm>

#include <spirv-tools/libspirv.h>

namespace vitrine::spirv::front {

using spv::Op;

bool is_block_end(Op op) {
  switch (op) {
    case Op::OpBranch:
    case Op::OpBranchConditional:
    case Op::OpSwitch:
    case Op::OpReturn:
    case Op::OpReturnValue:
    case Op::OpKill:
    case Op::OpTerminateInvocation:
    case Op::OpUnreachable:
      return true;
    default:
      return false;
  }
}

std::string string_at(const Inst& inst, std::uint32_t operand) {
  std::string text;
  for (std::uint32_t i = operand; inst.has(i); i++)
    for (std::uint32_t shift = 0; shift < 32; shift += 8) {
      const char c = static_cast<char>(inst.operand(i) >> shift & 0xff);
      if (c == 0) return text;
      text += c;
    }
  return text;
}

std::uint32_t Inst::operand(std::uint32_t i) const {
  if (!has(i)) fail(*this, "operand is missing");
  return words[first + i];
}

void fail(const Inst& inst, const std::string& why) {
  std::string text = std::string("Op") + spvOpcodeString(static_cast<std::uint32_t>(inst.op));
  if (inst.result != 0) text += " %" + std::to_string(inst.result);
  if (inst.line != 0) text += " (line " + std::to_string(inst.line) + ")";
  throw Failure(text + ": " + why);
}

const Type& Module::type(std::uint32_t id) const {
  const auto found = types.find(id);
  if (found == types.end()) throw Failure("%" + std::to_string(id) + " is not a type");
  return found->second;
}

const Inst& Module::def(std::uint32_t id) const {
  const auto found = definition.find(id);
  if (found == definition.end()) throw Failure("%" + std::to_string(id) + " is not defined");
  return code[found->second];
}

const Block& Module::block(std::uint32_t label) const {
  const auto found = blocks.find(label);
  if (found == blocks.end()) throw Failure("%" + std::to_string(label) + " is not a block");
  return found->second;
}

const Constant* Module::constant(std::uint32_t id) const {
  const auto found = constants.find(id);
  return found == constants.end() ? nullptr : &found->second;
}

std::uint32_t Module::constant_u32(std::uint32_t id, const Inst& user) const {
  const Constant* value = constant(id);
  const bool wide = value != nullptr && type(value->type).width == 64 && value->words.size() == 2;
  if (value == nullptr || value->words.size() != (wide ? 2 : 1)) fail(user, "operand is not an integer constant");
  return wide && value->words[1] != 0 ? UINT32_MAX : value->words[0];
}

bool Module::rounds_to_nearest(std::uint32_t width) const {
  return std::any_of(modes.begin(), modes.end(), [&](const Inst& mode) {
    return static_cast<spv::ExecutionMode>(mode.operand(1)) == spv::ExecutionMode::RoundingModeRTE &&
           mode.operand(2) == width;
  });
}

const DecorationRow* Module::decoration(std::uint32_t id, spv::Decoration kind, std::uint32_t member) const {
  auto at = std::lower_bound(decorations.begin(), decorations.end(), std::pair(id, member),
                             [](const DecorationRow& row, const auto& key) {
                               return row.id != key.first ? row.id < key.first : row.member < key.second;
                             });
  for (; at != decorations.end() && at->id == id && at->member == member; ++at)
    if (at->kind == kind) return &*at;
  return nullptr;
}

std::span<const DecorationRow> Module::decorations_of(std::uint32_t id) const {
  const auto [first, end] = std::equal_range(decorations.begin(), decorations.end(), DecorationRow{id},
                                             [](const auto& a, const auto& b) { return a.id < b.id; });
  return {first, end};
}

}  // namespace vitrine::spirv::front
