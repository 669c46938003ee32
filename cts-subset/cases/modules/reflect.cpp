// Reads declarations of a SPIR-V module (SPIR-V 2.4, logical layout of a module).
#include "cases/modules/reflect.h"

#include <cstring>

#include "harness/gpu.h"

namespace vitrine::cts {
namespace {

using spv::Op;

template <class F>
void for_each_instruction(std::span<const uint32_t> words, const F& f) {
  for (size_t at = 5; at < words.size();) {
    const uint32_t count = words[at] >> 16;
    if (count == 0 || at + count > words.size()) throw Unsupported("damaged module");
    f(static_cast<Op>(words[at] & spv::OpCodeMask), words.subspan(at, count), at);
    at += count;
  }
}

/// Index of the first word behind a literal string.
size_t behind_string(std::span<const uint32_t> inst, size_t first) {
  while (first < inst.size() && (inst[first] >> 24) != 0) first++;
  return first + 1;
}

bool is_type(Op op) { return op >= Op::OpTypeVoid && op <= Op::OpTypeForwardPointer; }

void read_decoration(Reflection& r, std::span<const uint32_t> inst, bool member) {
  const size_t kind = member ? 3 : 2;
  if (inst.size() <= kind) return;
  r.decorations[{inst[1], member ? static_cast<int>(inst[2]) : -1}][static_cast<spv::Decoration>(inst[kind])] =
      inst.size() > kind + 1 ? inst[kind + 1] : 1;
}

void read_mode(Reflection& r, std::span<const uint32_t> inst) {
  if (inst[1] != r.entry) return;
  const auto mode = static_cast<spv::ExecutionMode>(inst[2]);
  r.modes[mode] = inst.size() > 3 ? inst[3] : 0;
  for (size_t i = 0; mode == spv::ExecutionMode::LocalSize && i < 3; i++) r.local_size[i] = inst[3 + i];
}

}  // namespace

Reflection::Reflection(std::span<const uint32_t> words) {
  bool in_function = false;
  std::map<uint32_t, std::vector<uint32_t>> composites;
  std::vector<uint32_t> size_ids;
  for_each_instruction(words, [&](Op op, std::span<const uint32_t> inst, size_t) {
    if (op == Op::OpFunction) in_function = true;
    if (in_function) {
      for (size_t i = 1; i < inst.size(); i++) used.insert(inst[i]);
      compares_depth |= op == Op::OpImageSampleDrefImplicitLod || op == Op::OpImageSampleDrefExplicitLod ||
                        op == Op::OpImageSampleProjDrefImplicitLod || op == Op::OpImageSampleProjDrefExplicitLod ||
                        op == Op::OpImageDrefGather;
      return;
    }
    if (is_type(op) && op != Op::OpTypeForwardPointer)
      types[inst[1]] = {op, std::vector<uint32_t>(inst.begin() + 2, inst.end())};
    else if (op == Op::OpCapability)
      capabilities.insert(static_cast<spv::Capability>(inst[1]));
    else if (op == Op::OpEntryPoint && entry == 0) {
      model = static_cast<spv::ExecutionModel>(inst[1]);
      entry = inst[2];
      entry_name = reinterpret_cast<const char*>(&inst[3]);
      for (size_t i = behind_string(inst, 3); i < inst.size(); i++) interface.insert(inst[i]);
    } else if (op == Op::OpExecutionMode)
      read_mode(*this, inst);
    else if (op == Op::OpExecutionModeId && inst[1] == entry &&
             static_cast<spv::ExecutionMode>(inst[2]) == spv::ExecutionMode::LocalSizeId)
      size_ids.assign(inst.begin() + 3, inst.end());
    else if (op == Op::OpDecorate || op == Op::OpMemberDecorate)
      read_decoration(*this, inst, op == Op::OpMemberDecorate);
    else if (op == Op::OpConstant || op == Op::OpSpecConstant)
      constants[inst[2]] = inst[3];
    else if (op == Op::OpConstantComposite || op == Op::OpSpecConstantComposite)
      composites[inst[2]] = std::vector<uint32_t>(inst.begin() + 3, inst.end());
    else if (op == Op::OpVariable)
      variables.push_back({inst[2], types.at(inst[1]).operands.at(1), static_cast<spv::StorageClass>(inst[3])});
  });
  for (size_t i = 0; i < size_ids.size(); i++) local_size[i] = constants.at(size_ids[i]);
  for (const auto& [id, parts] : composites)
    if (decoration(id, spv::Decoration::BuiltIn) == static_cast<uint32_t>(spv::BuiltIn::WorkgroupSize))
      for (size_t i = 0; i < 3; i++) local_size[i] = constants.at(parts.at(i));
}

std::optional<uint32_t> Reflection::decoration(uint32_t id, spv::Decoration kind, int member) const {
  const auto found = decorations.find({id, member});
  if (found == decorations.end()) return {};
  const auto row = found->second.find(kind);
  return row == found->second.end() ? std::nullopt : std::optional(row->second);
}

uint32_t Reflection::length(const Type& array, uint32_t runtime) const {
  if (array.op == Op::OpTypeRuntimeArray) return runtime;
  const auto constant = constants.find(array.operands[1]);
  if (constant == constants.end()) throw Unsupported("array of a computed length");
  return constant->second;
}

uint32_t Reflection::size(uint32_t id, uint32_t runtime, uint32_t matrix_stride) const {
  const Type& t = type(id);
  switch (t.op) {
    case Op::OpTypeInt:
    case Op::OpTypeFloat:
      return t.operands[0] / 8;
    case Op::OpTypeVector:
      return t.operands[1] * size(t.operands[0], runtime);
    case Op::OpTypeMatrix:
      return t.operands[1] * (matrix_stride ? matrix_stride : 16);
    case Op::OpTypeArray:
    case Op::OpTypeRuntimeArray:
      return length(t, runtime) *
             decoration(id, spv::Decoration::ArrayStride).value_or(size(t.operands[0], runtime, matrix_stride));
    case Op::OpTypeStruct: {
      uint32_t end = 0;
      for (size_t m = 0; m < t.operands.size(); m++) {
        const int member = static_cast<int>(m);
        end = std::max(
            end, decoration(id, spv::Decoration::Offset, member).value_or(end) +
                     size(t.operands[m], runtime, decoration(id, spv::Decoration::MatrixStride, member).value_or(0)));
      }
      return end;
    }
    default:
      throw Unsupported("type without a layout");
  }
}

void Reflection::fill(Random& random, uint32_t id, std::span<unsigned char> bytes, uint32_t runtime,
                      uint32_t matrix_stride) const {
  const Type& t = type(id);
  const auto part = [&](uint32_t element, uint32_t offset, uint32_t stride) {
    if (offset < bytes.size()) fill(random, element, bytes.subspan(offset), runtime, stride);
  };
  switch (t.op) {
    case Op::OpTypeInt: {
      const uint64_t value = random.below(3);
      std::memcpy(bytes.data(), &value, std::min<size_t>(t.operands[0] / 8, bytes.size()));
      break;
    }
    case Op::OpTypeFloat: {
      const float value = random.chance(0.2f) ? static_cast<float>(random.between(-2, 4)) : random.real(-1.5f, 2.5f);
      const double wide = value;
      if (t.operands[0] == 32 && bytes.size() >= 4) std::memcpy(bytes.data(), &value, 4);
      if (t.operands[0] == 64 && bytes.size() >= 8) std::memcpy(bytes.data(), &wide, 8);
      const auto half = static_cast<uint16_t>(0x3000 + random.below(0x1400));
      if (t.operands[0] == 16 && bytes.size() >= 2) std::memcpy(bytes.data(), &half, 2);
      break;
    }
    case Op::OpTypeVector:
      for (uint32_t i = 0; i < t.operands[1]; i++) part(t.operands[0], i * size(t.operands[0], runtime), 0);
      break;
    case Op::OpTypeMatrix:
      for (uint32_t i = 0; i < t.operands[1]; i++) part(t.operands[0], i * (matrix_stride ? matrix_stride : 16), 0);
      break;
    case Op::OpTypeArray:
    case Op::OpTypeRuntimeArray: {
      const uint32_t stride =
          decoration(id, spv::Decoration::ArrayStride).value_or(size(t.operands[0], runtime, matrix_stride));
      for (uint32_t i = 0; i < length(t, runtime); i++) part(t.operands[0], i * stride, matrix_stride);
      break;
    }
    case Op::OpTypeStruct:
      for (size_t m = 0; m < t.operands.size(); m++) {
        const int member = static_cast<int>(m);
        part(t.operands[m], decoration(id, spv::Decoration::Offset, member).value_or(0),
             decoration(id, spv::Decoration::MatrixStride, member).value_or(0));
      }
      break;
    default:
      break;
  }
}

namespace {

/// 32-bit words of a captured value; 0: cannot be captured.
uint32_t captured_words(const Reflection& r, uint32_t id) {
  const Reflection::Type& t = r.type(id);
  switch (t.op) {
    case Op::OpTypeInt:
    case Op::OpTypeFloat:
      return t.operands[0] == 32 ? 1 : 0;
    case Op::OpTypeVector:
    case Op::OpTypeMatrix:
      return t.operands[1] * captured_words(r, t.operands[0]);
    case Op::OpTypeArray:
      return r.length(t, 0) * captured_words(r, t.operands[0]);
    default:
      return 0;
  }
}

void append(std::vector<uint32_t>& words, Op op, std::initializer_list<uint32_t> operands) {
  words.push_back(static_cast<uint32_t>(op) | static_cast<uint32_t>(operands.size() + 1) << 16);
  words.insert(words.end(), operands);
}

void capture(std::vector<uint32_t>& words, uint32_t id, int member, uint32_t offset) {
  const auto value = [](spv::Decoration kind) { return static_cast<uint32_t>(kind); };
  if (member < 0)
    append(words, Op::OpDecorate, {id, value(spv::Decoration::Offset), offset});
  else
    append(words, Op::OpMemberDecorate, {id, static_cast<uint32_t>(member), value(spv::Decoration::Offset), offset});
}

}  // namespace

std::vector<uint32_t> with_feedback(const Reflection& r, std::span<const uint32_t> words, uint32_t& stride) {
  std::vector<uint32_t> added, variables;
  stride = 0;
  for (const Reflection::Variable& v : r.variables) {
    if (v.storage != spv::StorageClass::Output || !r.used.contains(v.id)) continue;
    const Reflection::Type& t = r.type(v.pointee);
    const auto built_in = r.decoration(v.id, spv::Decoration::BuiltIn);
    const uint32_t position = static_cast<uint32_t>(spv::BuiltIn::Position);
    const uint32_t before = stride;
    if (t.op == Op::OpTypeStruct) {
      for (size_t m = 0; m < t.operands.size(); m++) {
        const int member = static_cast<int>(m);
        const auto what = r.decoration(v.pointee, spv::Decoration::BuiltIn, member);
        const uint32_t count = captured_words(r, t.operands[m]);
        if (count == 0 || (what && *what != position)) continue;
        capture(added, v.pointee, member, stride);
        stride += count * 4;
      }
    } else if (const uint32_t count = captured_words(r, v.pointee); count != 0 && (!built_in || built_in == position)) {
      capture(added, v.id, -1, stride);
      stride += count * 4;
    }
    if (stride != before) variables.push_back(v.id);
  }
  for (const uint32_t id : variables) {
    append(added, Op::OpDecorate, {id, static_cast<uint32_t>(spv::Decoration::XfbBuffer), 0});
    append(added, Op::OpDecorate, {id, static_cast<uint32_t>(spv::Decoration::XfbStride), stride});
  }
  std::vector<uint32_t> result(words.begin(), words.begin() + 5);
  append(result, Op::OpCapability, {static_cast<uint32_t>(spv::Capability::TransformFeedback)});
  bool decorated = false;
  for_each_instruction(words, [&](Op op, std::span<const uint32_t> inst, size_t) {
    if (!decorated && (is_type(op) || op == Op::OpConstant)) {
      result.insert(result.end(), added.begin(), added.end());
      decorated = true;
    }
    result.insert(result.end(), inst.begin(), inst.end());
    if (op == Op::OpEntryPoint && inst[2] == r.entry)
      append(result, Op::OpExecutionMode, {r.entry, static_cast<uint32_t>(spv::ExecutionMode::Xfb)});
  });
  return result;
}

}  // namespace vitrine::cts
