// SPIR-V lets a value be used wherever its definition dominates; the tree of ir.h only inside the list that defines it
// (and lists nested in that). Values used elsewhere are sent through a variable.
#include "spirv/front/context.h"

namespace vitrine::spirv::front {
namespace {

using Kind = ir::Node::Kind;

/// Walks the tree and tracks which values the current list may use.
struct Visibility {
  std::vector<bool> visible;

  template <class F>
  void walk(ir::NodeList& list, const F& each_node) {
    std::vector<ir::ValueId> defined;
    for (std::size_t i = 0; i < list.size(); i++) {
      i = each_node(list, i);
      ir::Node& node = *list[i];
      if (node.kind == Kind::kInstr) {
        if (node.instr.result == ir::kNoValue) continue;
        visible[node.instr.result] = true;
        defined.push_back(node.instr.result);
      } else {
        walk(node.then_list, each_node);
        walk(node.else_list, each_node);
        walk(node.body, each_node);
        walk(node.continuing, each_node);
      }
    }
    for (ir::ValueId value : defined) visible[value] = false;
  }
};

template <class F>
void each_source(ir::Node& node, const F& f) {
  if (node.kind == Kind::kIf) f(node.condition);
  for (ir::Src& src : node.instr.src) f(src);
}

using Variables = std::unordered_map<ir::ValueId, std::uint32_t>;

Variables find_broken(Translator& t) {
  Variables broken;
  Visibility scope{std::vector<bool>(t.function.values.size(), false)};
  for (const auto& node : t.constants) scope.visible[node->instr.result] = true;
  scope.walk(t.function.body, [&](ir::NodeList& list, std::size_t i) {
    each_source(*list[i], [&](ir::Src& src) {
      if (!scope.visible[src.value]) broken.try_emplace(src.value, 0);
    });
    return i;
  });
  return broken;
}

/// Emits into a list of its own and inserts that before list[i]; returns the new index of what was list[i].
template <class F>
std::size_t insert_before(Translator& t, ir::NodeList& list, std::size_t i, const F& emit_nodes) {
  ir::NodeList added;
  ir::NodeList* const saved = std::exchange(t.list, &added);
  emit_nodes();
  t.list = saved;
  const std::size_t count = added.size();
  list.insert(list.begin() + static_cast<std::ptrdiff_t>(i), std::make_move_iterator(added.begin()),
              std::make_move_iterator(added.end()));
  return i + count;
}

void store_definitions(Translator& t, ir::NodeList& list, const Variables& broken) {
  for (std::size_t i = 0; i < list.size(); i++) {
    store_definitions(t, list[i]->then_list, broken);
    store_definitions(t, list[i]->else_list, broken);
    store_definitions(t, list[i]->body, broken);
    store_definitions(t, list[i]->continuing, broken);
    const ir::ValueId result = list[i]->kind == Kind::kInstr ? list[i]->instr.result : ir::kNoValue;
    if (const auto found = broken.find(result); result != ir::kNoValue && found != broken.end())
      i = insert_before(t, list, i + 1, [&] { store_raw(t, found->second, result); }) - 1;
  }
}

}  // namespace

void repair_scopes(Translator& t) {
  Variables broken = find_broken(t);
  if (broken.empty()) return;
  for (auto& [value, local] : broken) local = new_local(t, t.function.values[value]);
  store_definitions(t, t.function.body, broken);
  Visibility scope{std::vector<bool>(t.function.values.size(), false)};
  for (const auto& node : t.constants) scope.visible[node->instr.result] = true;
  scope.walk(t.function.body, [&](ir::NodeList& list, std::size_t i) {
    ir::Node& node = *list[i];
    return insert_before(t, list, i, [&] {
      each_source(node, [&](ir::Src& src) {
        if (src.value >= scope.visible.size() || scope.visible[src.value]) return;
        src.value = load_raw(t, broken.at(src.value));
      });
      scope.visible.resize(t.function.values.size(), false);
    });
  });
}

}  // namespace vitrine::spirv::front
