// Mutations, each of a kind that a careless compiler might make.
#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp11>

namespace vitrine::fuzz {
namespace {

struct Place {
  std::size_t at = 0;  ///< of the opcode word
  std::uint32_t length = 0;
  spv::Op op = spv::Op::OpNop;
  std::uint32_t type = 0, result = 0;
  std::uint32_t first = 1;  ///< operand behind type and result
};

std::vector<Place> instructions(const Words& words) {
  std::vector<Place> list;
  for (std::size_t at = 5; at < words.size();) {
    Place place{at, words[at] >> 16, static_cast<spv::Op>(words[at] & 0xffff), 0, 0, 1};
    if (place.length == 0 || place.length > words.size() - at) break;
    bool has_result = false, has_type = false;
    spv::HasResultAndType(place.op, &has_result, &has_type);
    if (has_type && place.length > place.first) place.type = words[at + place.first++];
    if (has_result && place.length > place.first) place.result = words[at + place.first++];
    list.push_back(place);
    at += place.length;
  }
  return list;
}

std::vector<Place> in_functions(const std::vector<Place>& list) {
  const auto is_function = [](const Place& place) { return place.op == spv::Op::OpFunction; };
  return {std::find_if(list.begin(), list.end(), is_function), list.end()};
}

/// Opcodes of one shape: any may stand for another.
constexpr spv::Op kFamilies[][8] = {
    {spv::Op::OpIAdd, spv::Op::OpISub, spv::Op::OpIMul, spv::Op::OpUDiv, spv::Op::OpUMod, spv::Op::OpBitwiseAnd,
     spv::Op::OpShiftLeftLogical, spv::Op::OpBitwiseXor},
    {spv::Op::OpSDiv, spv::Op::OpSRem, spv::Op::OpSMod, spv::Op::OpIMul, spv::Op::OpShiftRightArithmetic,
     spv::Op::OpBitwiseOr, spv::Op::OpISub, spv::Op::OpIAdd},
    {spv::Op::OpFAdd, spv::Op::OpFSub, spv::Op::OpFMul, spv::Op::OpFDiv, spv::Op::OpFRem, spv::Op::OpFMod,
     spv::Op::OpFAdd, spv::Op::OpFMul},
    {spv::Op::OpIEqual, spv::Op::OpINotEqual, spv::Op::OpULessThan, spv::Op::OpSLessThan, spv::Op::OpUGreaterThan,
     spv::Op::OpSGreaterThanEqual, spv::Op::OpULessThanEqual, spv::Op::OpSGreaterThan},
    {spv::Op::OpFOrdEqual, spv::Op::OpFUnordEqual, spv::Op::OpFOrdLessThan, spv::Op::OpFUnordLessThan,
     spv::Op::OpFOrdGreaterThan, spv::Op::OpFUnordNotEqual, spv::Op::OpFOrdGreaterThanEqual,
     spv::Op::OpFUnordLessThanEqual},
    {spv::Op::OpReturn, spv::Op::OpUnreachable, spv::Op::OpKill, spv::Op::OpReturn, spv::Op::OpReturn, spv::Op::OpKill,
     spv::Op::OpTerminateInvocation, spv::Op::OpUnreachable},
};

/// Instructions that say where memory is accessed, that act on more than their own invocation, or whose results are
/// undefined for some operands (remainders of negative numbers, far shifts).
bool is_fixed(spv::Op op) {
  return op == spv::Op::OpSRem || op == spv::Op::OpSMod || op == spv::Op::OpShiftLeftLogical ||
         op == spv::Op::OpShiftRightLogical || op == spv::Op::OpShiftRightArithmetic || op == spv::Op::OpAccessChain ||
         op == spv::Op::OpInBoundsAccessChain || op == spv::Op::OpPtrAccessChain || op == spv::Op::OpFunctionCall ||
         op == spv::Op::OpImageTexelPointer || (op >= spv::Op::OpAtomicLoad && op <= spv::Op::OpAtomicXor) ||
         op == spv::Op::OpAtomicFAddEXT || op == spv::Op::OpAtomicFMinEXT || op == spv::Op::OpAtomicFMaxEXT ||
         op == spv::Op::OpConvertUToPtr || (op >= spv::Op::OpSampledImage && op <= spv::Op::OpImageQuerySamples) ||
         (op >= spv::Op::OpGroupNonUniformElect && op <= spv::Op::OpGroupNonUniformQuadSwap);
}

/// `defined`: not into an opcode whose results are undefined for some operands.
void swap_opcode(Words& words, const std::vector<Place>& list, Random& random, bool defined = false) {
  for (int tries = 0; tries < 50; tries++) {
    const Place& place = list[below(random, list.size())];
    for (const auto& family : kFamilies)
      if (std::find(std::begin(family), std::end(family), place.op) != std::end(family)) {
        const spv::Op op = family[below(random, std::size(family))];
        if (defined && is_fixed(op)) continue;
        words[place.at] = place.length << 16 | static_cast<std::uint32_t>(op);
        return;
      }
  }
}

/// An operand of one of the instructions `open` becomes another id of the same type.
void swap_operand(Words& words, const std::vector<Place>& list, const std::vector<Place>& open, Random& random) {
  if (open.empty()) return;
  std::unordered_map<std::uint32_t, std::uint32_t> type_of;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> of_type;
  for (const Place& place : list) {
    if (place.result == 0) continue;
    type_of[place.result] = place.type;
    of_type[place.type].push_back(place.result);
  }
  for (int tries = 0; tries < 50; tries++) {
    const Place& place = open[below(random, open.size())];
    if (place.length <= place.first) continue;
    std::uint32_t& operand = words[place.at + place.first + below(random, place.length - place.first)];
    const auto known = type_of.find(operand);
    if (known == type_of.end()) continue;
    const auto& others = of_type[known->second];
    operand = others[below(random, others.size())];
    return;
  }
}

/// A literal or id becomes any number; constants become corner values.
void change_word(Words& words, const std::vector<Place>& list, Random& random) {
  const Place& place = list[below(random, list.size())];
  if (place.length <= place.first) return;
  constexpr std::uint32_t kCorners[] = {0,  1,  2,   3,     4,          7,          31,        32,
                                        63, 64, 255, 65535, 0x7fffffff, 0x80000000, 0xffffffff};
  std::uint32_t& word = words[place.at + place.first + below(random, place.length - place.first)];
  switch (below(random, 4)) {
    case 0:
      word = kCorners[below(random, std::size(kCorners))];
      break;
    case 1:
      word ^= 1u << below(random, 32);
      break;
    case 2:
      word += static_cast<std::uint32_t>(below(random, 7)) - 3;
      break;
    default:
      word = static_cast<std::uint32_t>(below(random, words[3] + std::size_t{1}));
      break;
  }
}

/// A word of an instruction becomes any id, of whatever it is: types where values are wanted, and the other way round.
void confuse(Words& words, const std::vector<Place>& list, Random& random) {
  const Place& place = list[below(random, list.size())];
  const Place& other = list[below(random, list.size())];
  if (place.length < 2 || other.result == 0) return;
  const bool retype = place.type != 0 && below(random, 3) == 0;
  if (retype && other.type == 0 && other.op != spv::Op::OpLabel)
    words[place.at + 1] = other.result;
  else
    words[place.at + 1 + below(random, place.length - 1u)] = other.result;
}

/// An instruction loses its last word, or has it twice.
void resize(Words& words, const std::vector<Place>& list, Random& random) {
  const Place& place = list[below(random, list.size())];
  if (place.length < 2 || place.length == UINT16_MAX) return;
  const auto last = words.begin() + static_cast<std::ptrdiff_t>(place.at + place.length - 1);
  const bool grow = below(random, 2) == 0;
  if (grow)
    words.insert(last, *last);
  else
    words.erase(last);
  words[place.at] = (place.length + (grow ? 1u : -1u)) << 16 | static_cast<std::uint32_t>(place.op);
}

/// A declaration moves to another place in front of the functions: what it names may come later then.
void move_declaration(Words& words, const std::vector<Place>& list, Random& random) {
  const std::size_t bodies = list.size() - in_functions(list).size();
  if (bodies < 2) return;
  const Place& from = list[below(random, bodies)];
  const Place& to = list[below(random, bodies)];
  const auto begin = words.begin() + static_cast<std::ptrdiff_t>(from.at), end = begin + from.length;
  const auto target = words.begin() + static_cast<std::ptrdiff_t>(to.at);
  if (to.at < from.at)
    std::rotate(target, begin, end);
  else if (to.at > from.at)
    std::rotate(begin, end, target);
}

void remove(Words& words, const std::vector<Place>& list, Random& random) {
  const Place& place = list[below(random, list.size())];
  const auto begin = words.begin() + static_cast<std::ptrdiff_t>(place.at);
  words.erase(begin, begin + place.length);
}

/// A copy of an instruction, with a result of its own, at another place.
void copy(Words& words, const std::vector<Place>& list, Random& random) {
  const Place& from = list[below(random, list.size())];
  const Place& to = list[below(random, list.size())];
  Words instruction(words.begin() + static_cast<std::ptrdiff_t>(from.at),
                    words.begin() + static_cast<std::ptrdiff_t>(from.at + from.length));
  if (from.result != 0) instruction[from.first - 1] = words[3]++;
  words.insert(words.begin() + static_cast<std::ptrdiff_t>(to.at), instruction.begin(), instruction.end());
}

void exchange(Words& words, const std::vector<Place>& list, Random& random) {
  const std::size_t index = below(random, list.size() - 1);
  const Place &a = list[index], &b = list[index + 1];
  const auto begin = words.begin() + static_cast<std::ptrdiff_t>(a.at);
  std::rotate(begin, begin + a.length, begin + a.length + b.length);
}

using Ids = std::unordered_set<std::uint32_t>;

/// Labels that leave a loop or a function, at once or at the end of their block.
Ids exit_labels(const Words& words, const std::vector<Place>& list) {
  Ids exits;
  for (const Place& place : list)
    if (place.op == spv::Op::OpLoopMerge) exits.insert({words[place.at + 1], words[place.at + 2]});
  Ids all = exits;
  std::uint32_t label = 0;
  for (const Place& place : list) {
    if (place.op == spv::Op::OpLabel) label = place.result;
    if (place.op == spv::Op::OpReturn || place.op == spv::Op::OpReturnValue ||
        (place.op == spv::Op::OpBranch && exits.contains(words[place.at + 1])))
      all.insert(label);
  }
  return all;
}

/// The conditions on which a loop or a function is left.
Ids exit_conditions(const Words& words, const std::vector<Place>& list) {
  const Ids exits = exit_labels(words, list);
  Ids conditions;
  for (const Place& place : list)
    if (place.op == spv::Op::OpBranchConditional &&
        (exits.contains(words[place.at + 2]) || exits.contains(words[place.at + 3])))
      conditions.insert(words[place.at + 1]);
  return conditions;
}

/// Conditions that may keep invocations from what is not theirs: all, where a workgroup shares memory.
Ids guards(const Words& words, const std::vector<Place>& list) {
  const auto is_shared = [&](const Place& place) {
    return place.op == spv::Op::OpVariable && place.length > place.first &&
           words[place.at + place.first] == static_cast<std::uint32_t>(spv::StorageClass::Workgroup);
  };
  Ids conditions;
  if (std::none_of(list.begin(), list.end(), is_shared)) return conditions;
  for (const Place& place : list)
    if (place.op == spv::Op::OpBranchConditional) conditions.insert(words[place.at + 1]);
  return conditions;
}

/// Every id that a fixed instruction, the end of a loop or a guard depends on, through values and through memory.
Ids fixed_ids(const Words& words, const std::vector<Place>& list) {
  Ids ids = exit_conditions(words, list);
  ids.merge(guards(words, list));
  const auto take = [&](const Place& place, std::uint32_t from) {
    bool grew = false;
    for (std::uint32_t i = from; i < place.length; i++) grew |= ids.insert(words[place.at + i]).second;
    return grew;
  };
  for (bool grew = true; grew;) {
    grew = false;
    for (auto at = list.rbegin(); at != list.rend(); ++at) {  // users first
      const Place& place = *at;
      if (place.op == spv::Op::OpStore && place.length > 2 && ids.contains(words[place.at + 1]))
        grew |= ids.insert(words[place.at + 2]).second;
      else if (is_fixed(place.op) || (place.result != 0 && place.type != 0 && ids.contains(place.result)))
        grew |= take(place, place.first);
      // A store into a part of a variable changes the variable.
      if (is_fixed(place.op) && place.length > place.first && ids.contains(words[place.at + place.first]))
        grew |= ids.insert(place.result).second;
    }
  }
  return ids;
}

/// Conditions that ask for a NaN. Behind them cases hide the bits of NaNs, which are not defined.
Ids nan_conditions(const Words& words, const std::vector<Place>& list) {
  Ids ids;
  for (const Place& place : list) {
    const bool logical = place.op == spv::Op::OpAny || place.op == spv::Op::OpAll || place.op == spv::Op::OpLogicalOr ||
                         place.op == spv::Op::OpLogicalAnd || place.op == spv::Op::OpLogicalNot;
    bool asks = place.op == spv::Op::OpIsNan;
    for (std::uint32_t i = place.first; logical && i < place.length; i++) asks |= ids.contains(words[place.at + i]);
    if (asks) ids.insert(place.result);
  }
  return ids;
}

bool to_integer(spv::Op op) { return op == spv::Op::OpConvertFToU || op == spv::Op::OpConvertFToS; }

/// Numbers that become integers: those that an integer cannot hold have no result, so that cases clamp them.
Ids converted(const Words& words, const std::vector<Place>& list) {
  Ids ids;
  for (const Place& place : list)
    if (to_integer(place.op) && place.length > place.first) ids.insert(words[place.at + place.first]);
  return ids;
}

}  // namespace

void mutate_values(Words& words, Random& random) {
  const std::vector<Place> list = instructions(words);
  const Ids fixed = fixed_ids(words, list);
  const Ids nans = nan_conditions(words, list);
  const Ids clamped = converted(words, list);
  std::vector<Place> open;
  for (Place place : in_functions(list)) {
    const bool branch = place.op == spv::Op::OpBranchConditional && !fixed.contains(words[place.at + 1]);
    const bool value = place.type != 0 && !fixed.contains(place.result);
    const bool effect = place.op == spv::Op::OpStore && !fixed.contains(words[place.at + 1]);
    const bool on_nan = nans.contains(place.result) ||
                        ((place.op == spv::Op::OpSelect || branch) && nans.contains(words[place.at + place.first]));
    if (on_nan || place.op == spv::Op::OpBitcast || to_integer(place.op) || clamped.contains(place.result)) continue;
    if (branch) place.length = 2;  // the labels stay
    if (effect) place.first = 2;   // and the variable
    if (is_fixed(place.op) || (!value && !effect && !branch)) continue;
    if (place.op != spv::Op::OpLoad && place.op != spv::Op::OpVariable) open.push_back(place);
  }
  if (open.empty()) return;
  for (std::size_t left = 1 + below(random, 6); left > 0; left--) {
    if (below(random, 2) == 0)
      swap_opcode(words, open, random, true);
    else
      swap_operand(words, list, open, random);
  }
}

void mutate(Words& words, Random& random) {
  for (std::size_t left = 1 + below(random, 4); left > 0; left--) {
    const std::vector<Place> list = instructions(words);
    if (list.size() < 2) return;
    switch (below(random, 17)) {
      case 0:
        remove(words, list, random);
        break;
      case 1:
        copy(words, list, random);
        break;
      case 2:
        exchange(words, list, random);
        break;
      case 3:
      case 4:
        change_word(words, list, random);
        break;
      case 5:
      case 6:
      case 7:
        swap_opcode(words, list, random);
        break;
      case 8:
      case 9:
      case 10:
        confuse(words, list, random);
        break;
      case 11:
        resize(words, list, random);
        break;
      case 12:
        move_declaration(words, list, random);
        break;
      default:
        swap_operand(words, list, in_functions(list), random);
        break;
    }
  }
}

}  // namespace vitrine::fuzz
