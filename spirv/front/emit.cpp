// Emitters shared by all translator functions: instructions, constants, vector assembly.
#include "base/numeric.h"
#include "spirv/front/context.h"

namespace vitrine::spirv::front {
namespace {

ir::Instr& append(Translator& t, ir::Op op, std::vector<ir::Src> src) {
  ir::Node& node = emit_node(t, ir::Node::Kind::kInstr);
  node.instr.op = op;
  node.instr.src = std::move(src);
  node.instr.exact = t.exact;
  return node.instr;
}

/// Keeps ill-typed operands of a module that nobody validated out of the IR.
void check_sources(const Translator& t, ir::Op op, std::uint32_t count, std::uint8_t width,
                   const std::vector<ir::Src>& sources) {
  const ir::AluInfo& info = ir::alu_info(op);
  bool fits = sources.size() == info.sources;
  for (std::size_t i = 0; i < sources.size() && fits; i++) {
    fits = is_boolean(t, sources[i].value) == (info.operands[i] == 'B');
    const std::uint32_t read = ir::is_selection(op) ? count : ir::components_read(op, width, count, i);
    for (std::uint32_t c = 0; c < read; c++) fits &= sources[i].swizzle[c] < components(t, sources[i].value);
  }
  if (!fits) throw Failure("operand does not fit its type");
}

struct IntrinsicRow {
  int sources, components;
};
constexpr IntrinsicRow kIntrinsics[] = {
#define VITRINE_INTRINSIC(name, sources, components, effect) {sources, components},
#include "spirv/intrinsics.def"
#undef VITRINE_INTRINSIC
};

/// Whether the instruction passes values on whatever they are.
bool takes_all(ir::Op op) {
  return op == ir::Op::kVec || op == ir::Op::kConst || op == ir::Op::kUndef || op == ir::Op::kLoadVar ||
         op == ir::Op::kStoreVar || op == ir::Op::kProbe;
}

/// Of all others each reads and gives numbers, but for Ballot, Elect and HelperInvocation.
void check_intrinsic(const Translator& t, ir::Op op, std::uint32_t count, bool boolean,
                     const std::vector<ir::Src>& sources) {
  bool fits = count <= 4;
  for (const ir::Src& src : sources) {
    fits &= src.swizzle[0] < components(t, src.value);
    fits &= takes_all(op) || is_boolean(t, src.value) == (op == ir::Op::kBallot);
  }
  if (op > ir::Op::kAluCount && op < ir::Op::kIntrinsicEnd) {
    const IntrinsicRow& row = kIntrinsics[static_cast<int>(op) - static_cast<int>(ir::Op::kAluCount) - 1];
    fits &= row.sources < 0 || sources.size() == static_cast<std::size_t>(row.sources);
    fits &= row.components < 0 || count == static_cast<std::uint32_t>(row.components);
    fits &= takes_all(op) || boolean == (op == ir::Op::kElect || op == ir::Op::kHelperInvocation);
  }
  if (!fits) throw Failure("operand does not fit its type");
}

/// Const instructions go to the front of the function.
ir::ValueId add_constant(Translator& t, std::span<const std::uint32_t> words, bool boolean, bool is_undefined) {
  auto node = std::make_unique<ir::Node>();
  node->instr.op = is_undefined ? ir::Op::kUndef : ir::Op::kConst;
  node->instr.components = static_cast<std::uint8_t>(words.size());
  node->instr.boolean = boolean;
  std::array<std::uint32_t, 4> imm{};
  std::copy(words.begin(), words.end(), imm.begin());
  if (!is_undefined) node->instr.imm = imm;
  const ir::ValueId result = node->instr.result = t.function.new_value(node->instr.components, boolean);
  if (is_undefined)
    t.undefined_ids.insert(result);
  else
    t.constant_words[result] = imm;
  t.constants.push_back(std::move(node));
  return result;
}

/// One instruction for all that ask for the same.
ir::ValueId make_constant(Translator& t, std::span<const std::uint32_t> words, bool boolean, bool is_undefined) {
  std::vector<std::uint32_t> key(words.begin(), words.end());
  key.push_back(boolean ? 1 : 0);
  key.push_back(is_undefined ? 1 : 0);
  const auto [at, added] = t.constant_ids.try_emplace(key, ir::kNoValue);
  if (added) at->second = add_constant(t, words, boolean, is_undefined);
  return at->second;
}

}  // namespace

ir::Node& emit_node(Translator& t, ir::Node::Kind kind) {
  if (++t.nodes > kMaxNodes) throw Failure("the shader expands to too many instructions");
  ir::Origin origin = origin_here(t);
  // Compilers leave the ends of blocks without a line: control flow has that of what was made before it.
  if (kind != ir::Node::Kind::kInstr && origin.place == 0) origin.place = t.near;
  if (origin.place != 0) t.near = origin.place;
  t.list->push_back(std::make_unique<ir::Node>());
  t.list->back()->kind = kind;
  t.list->back()->instr.origin = origin;
  return *t.list->back();
}

ir::ValueId emit(Translator& t, ir::Op op, std::uint32_t components, bool boolean, std::vector<ir::Src> src,
                 std::uint8_t width) {
  if (op < ir::Op::kAluCount)
    check_sources(t, op, components, width, src);
  else
    check_intrinsic(t, op, components, boolean, src);
  ir::Instr& instr = append(t, op, std::move(src));
  instr.components = static_cast<std::uint8_t>(components);
  instr.boolean = boolean;
  instr.width = width;
  return instr.result = t.function.new_value(instr.components, boolean);
}

ir::Instr& emit_effect(Translator& t, ir::Op op, std::vector<ir::Src> src) {
  check_intrinsic(t, op, 0, false, src);
  ir::Instr& instr = append(t, op, std::move(src));
  instr.components = 0;
  return instr;
}

ir::Instr& last_instr(Translator& t) { return t.list->back()->instr; }

ir::ValueId constant(Translator& t, std::span<const std::uint32_t> words, bool boolean) {
  return make_constant(t, words, boolean, false);
}

ir::ValueId literal(Translator& t, std::span<const std::uint32_t> words, bool boolean) {
  return add_constant(t, words, boolean, false);
}

ir::ValueId constant_u32(Translator& t, std::uint32_t word) { return constant(t, {&word, 1}); }

ir::ValueId constant_float(Translator& t, float value) {
  const std::uint32_t word = base::bits_of(value);
  return literal(t, {&word, 1}, false);
}

ir::ValueId constant_bool(Translator& t, bool value) {
  const std::uint32_t word = value;
  return constant(t, {&word, 1}, true);
}

void check_leaf(const Translator& t, std::uint32_t type, ir::ValueId value) {
  const ir::ValueInfo info = leaf_info(t, type);
  if (info.components != components(t, value) || info.boolean != is_boolean(t, value))
    throw Failure("value does not fit its type");
}

ir::ValueId undefined(Translator& t, std::uint32_t components, bool boolean) {
  const std::uint32_t zero[4] = {};
  return make_constant(t, {zero, components}, boolean, true);
}

const std::array<std::uint32_t, 4>* constant_of(const Translator& t, ir::ValueId value) {
  const auto found = t.constant_words.find(value);
  return found == t.constant_words.end() ? nullptr : &found->second;
}

ir::ValueId extract(Translator& t, ir::ValueId vector, std::uint32_t component) {
  if (component >= components(t, vector)) throw Failure("component out of range");
  if (components(t, vector) == 1) return vector;
  const bool boolean = is_boolean(t, vector);
  return emit(t, boolean ? ir::Op::kMovB : ir::Op::kMov, 1, boolean,
              {splat(vector, static_cast<std::uint8_t>(component))});
}

ir::ValueId vec(Translator& t, std::vector<ir::Src> scalars, bool boolean) {
  if (scalars.empty()) throw Failure("operand does not fit its type");
  for (const ir::Src& part : scalars)
    if (scalars.size() > 4 || part.swizzle[0] >= components(t, part.value) || is_boolean(t, part.value) != boolean)
      throw Failure("operand does not fit its type");
  if (scalars.size() == 1 && components(t, scalars[0].value) == 1) return scalars[0].value;
  bool same = components(t, scalars[0].value) == scalars.size();
  for (std::size_t i = 0; i < scalars.size(); i++)
    same &= scalars[i].value == scalars[0].value && scalars[i].swizzle[0] == i;
  if (same) return scalars[0].value;
  const auto count = static_cast<std::uint32_t>(scalars.size());
  return emit(t, ir::Op::kVec, count, boolean, std::move(scalars));
}

ir::ValueId extract_dynamic(Translator& t, ir::ValueId vector, ir::ValueId index) {
  const std::uint32_t count = components(t, vector);
  if (const auto* words = constant_of(t, index)) return extract(t, vector, std::min((*words)[0], count - 1));
  const bool boolean = is_boolean(t, vector);
  ir::ValueId result = extract(t, vector, count - 1);
  for (std::uint32_t i = count - 1; i-- > 0;) {
    const ir::ValueId here = emit(t, ir::Op::kIEq, 1, true, {whole(index), whole(constant_u32(t, i))});
    result = emit(t, boolean ? ir::Op::kSelectB : ir::Op::kSelect, 1, boolean,
                  {whole(here), splat(vector, static_cast<std::uint8_t>(i)), whole(result)});
  }
  return result;
}

ir::ValueId insert(Translator& t, ir::ValueId vector, ir::ValueId scalar, std::uint32_t component) {
  const std::uint32_t count = components(t, vector);
  if (count == 1) return scalar;
  std::vector<ir::Src> parts;
  for (std::uint32_t i = 0; i < count; i++)
    parts.push_back(i == component ? splat(scalar) : splat(vector, static_cast<std::uint8_t>(i)));
  return vec(t, std::move(parts), is_boolean(t, vector));
}

ir::ValueId insert_dynamic(Translator& t, ir::ValueId vector, ir::ValueId scalar, ir::ValueId index) {
  if (const auto* words = constant_of(t, index)) return insert(t, vector, scalar, (*words)[0]);
  const bool boolean = is_boolean(t, vector);
  std::vector<ir::Src> parts;
  for (std::uint32_t i = 0; i < components(t, vector); i++) {
    const ir::ValueId here = emit(t, ir::Op::kIEq, 1, true, {whole(index), whole(constant_u32(t, i))});
    parts.push_back(whole(emit(t, boolean ? ir::Op::kSelectB : ir::Op::kSelect, 1, boolean,
                               {whole(here), whole(scalar), splat(vector, static_cast<std::uint8_t>(i))})));
  }
  return vec(t, std::move(parts), boolean);
}

}  // namespace vitrine::spirv::front
