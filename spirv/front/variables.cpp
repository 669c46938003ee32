// Decides per variable (or part of one) whether it becomes SSA or stays in memory: parts under a dynamic array index
// become an ir::Array of scalars, everything else a numbered slot per scalar or vector for ssa.cpp.
#include <set>

#include "spirv/front/context.h"
#include "spirv/homes.h"

namespace vitrine::spirv::front {
namespace {

using Kind = ir::Node::Kind;
/// Local followed by constant steps.
using Key = std::vector<std::uint32_t>;

struct Arrays {
  Translator& t;
  std::set<Key> in_memory;             ///< paths whose next step is dynamic somewhere
  std::map<Key, std::uint32_t> slots;  ///< SSA slot of a leaf
  std::map<Key, std::uint32_t> arrays;
  std::size_t scalars = 0;  ///< of all arrays
};

/// What an access means: a slot, or scalars of an array at constant + dynamic.
struct Target {
  bool array = false;
  std::uint32_t number = 0;
  std::uint32_t constant = 0;
  ir::ValueId dynamic = ir::kNoValue;
};

/// A scalar or vector whose last step chooses between the low and the high words.
bool is_pair(const Type& type) {
  return type.leaves == 2 && (type.kind == Type::Kind::kVector || type.kind == Type::Kind::kInt ||
                              type.kind == Type::Kind::kFloat || type.kind == Type::Kind::kPointer);
}

std::uint32_t step_type(const Translator& t, std::uint32_t type_id, const Step& step) {
  const Type& type = t.module.type(type_id);
  if (is_pair(type)) return type_id;
  return type.kind == Type::Kind::kStruct ? type.members[step.index] : type.element;
}

void find_memory(Arrays& a) {
  for (const Access& access : a.t.accesses) {
    Key key{access.local};
    for (const Step& step : access.path) {
      if (step.dynamic) {
        a.in_memory.insert(key);
        break;
      }
      key.push_back(step.index);
    }
  }
}

/// Variables that are to have homes stay in memory as a whole, but not where a dynamic index leads into a part of them:
/// that one is clamped to the elements of the part.
void find_homes(Arrays& a) {
  for (const Probe& probe : a.t.function.probes) {
    if (!is_home(probe)) continue;
    const std::uint32_t local = probe.number - 1;
    const auto part = a.in_memory.lower_bound({local});
    if (part == a.in_memory.end() || part->front() != local) a.in_memory.insert({local});
  }
}

/// Their rows name the arrays; those of variables that nothing accesses, or that have none, are no rows any more.
void place_homes(Arrays& a) {
  for (Probe& probe : a.t.function.probes) {
    if (!is_home(probe)) continue;
    const auto array = a.arrays.find({probe.number - 1});
    probe.number = array == a.arrays.end() ? 0 : array->second + 1;
  }
}

/// Scalars in front of what `step` selects from `type`; dynamic steps add to target.dynamic.
void add_step(Translator& t, Target& target, std::uint32_t type_id, const Step& step) {
  const Type& type = t.module.type(type_id);
  if (type.kind == Type::Kind::kStruct) {
    for (std::uint32_t i = 0; i < step.index; i++) target.constant += t.module.type(type.members[i]).scalars;
    return;
  }
  if (is_pair(type)) {
    target.constant += step.index * type.scalars / 2;
    return;
  }
  const std::uint32_t size = t.module.type(type.element).scalars;
  if (step.dynamic)
    target.dynamic = add_scaled(t, target.dynamic, step.value, size);
  else
    target.constant += step.index * size;
}

Target resolve(Arrays& a, const Access& access, std::span<const ir::Src> dynamic) {
  Target target;
  Key key{access.local};
  std::uint32_t type = a.t.locals[access.local].type;
  std::size_t i = 0, next_dynamic = 0;
  auto step_at = [&](std::size_t at) {
    Step step = access.path[at];
    if (step.dynamic) step.value = dynamic[next_dynamic++].value;
    return step;
  };
  for (; i < access.path.size() && a.in_memory.count(key) == 0; i++) {
    key.push_back(access.path[i].index);
    type = step_type(a.t, type, access.path[i]);
  }
  target.array = a.in_memory.count(key) != 0;
  if (!target.array) {
    target.number = a.slots.try_emplace(key, static_cast<std::uint32_t>(a.slots.size())).first->second;
    return target;
  }
  const auto [at, added] = a.arrays.try_emplace(key, static_cast<std::uint32_t>(a.t.function.arrays.size()));
  if (added) {
    const std::uint32_t scalars = a.t.module.type(type).scalars;
    a.scalars += scalars;
    if (scalars == 0 || scalars > kMaxScalars || a.scalars > kMaxArrayScalars)
      throw Failure("a dynamically indexed variable is too large");
    a.t.function.arrays.push_back({scalars});
  }
  target.number = at->second;
  for (; i < access.path.size(); i++) {
    const Step step = step_at(i);
    add_step(a.t, target, type, step);
    type = step_type(a.t, type, step);
  }
  return target;
}

ir::Src element_index(Translator& t, const Target& target) {
  return whole(target.dynamic == ir::kNoValue ? constant_u32(t, 0) : target.dynamic);
}

/// LoadArray of every component, then a Vec that takes over the result of the LoadVar.
void load_array(Translator& t, const ir::Instr& load, const Target& target) {
  std::vector<ir::Src> parts;
  for (std::uint32_t c = 0; c < load.components; c++) {
    ir::ValueId value = emit(t, ir::Op::kLoadArray, 1, false, {element_index(t, target)});
    last_instr(t).data[0] = target.number;
    last_instr(t).data[1] = target.constant + c;
    if (load.boolean) value = emit(t, ir::Op::kINe, 1, true, {whole(value), whole(constant_u32(t, 0))});
    parts.push_back(whole(value));
  }
  emit(t, ir::Op::kVec, load.components, load.boolean, std::move(parts));
  last_instr(t).result = load.result;
}

void store_array(Translator& t, const ir::Instr& store, const Target& target) {
  ir::ValueId value = store.src[0].value;
  const std::uint32_t count = components(t, value);
  if (is_boolean(t, value)) value = emit(t, ir::Op::kB2I, count, false, {whole(value)});
  for (std::uint8_t c = 0; c < count; c++) {
    ir::Instr& instr = emit_effect(t, ir::Op::kStoreArray, {element_index(t, target), splat(value, c)});
    instr.data[0] = target.number;
    instr.data[1] = target.constant + c;
  }
}

void rewrite(Arrays& a, ir::NodeList& list) {
  ir::NodeList old = std::move(list);
  list.clear();
  for (auto& node : old) {
    a.t.list = &list;
    rewrite(a, node->then_list);
    rewrite(a, node->else_list);
    rewrite(a, node->body);
    rewrite(a, node->continuing);
    a.t.list = &list;
    ir::Instr& instr = node->instr;
    const bool is_load = node->kind == Kind::kInstr && instr.op == ir::Op::kLoadVar;
    const bool is_store = node->kind == Kind::kInstr && instr.op == ir::Op::kStoreVar;
    if (is_load || is_store) {
      a.t.fallback = instr.origin;
      const std::span<const ir::Src> sources(instr.src);
      const Target target = resolve(a, a.t.accesses[instr.data[0]], sources.subspan(is_store ? 1 : 0));
      if (target.array) {
        is_load ? load_array(a.t, instr, target) : store_array(a.t, instr, target);
        continue;
      }
      instr.data[1] = target.number;
    }
    list.push_back(std::move(node));
  }
}

}  // namespace

void resolve_arrays(Translator& t) {
  Arrays arrays{t, {}, {}, {}, 0};
  t.inst = nullptr;
  t.exact = false;
  find_memory(arrays);
  find_homes(arrays);
  rewrite(arrays, t.function.body);
  place_homes(arrays);
  t.fallback = {};
}

}  // namespace vitrine::spirv::front
