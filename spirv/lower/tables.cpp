// Which elements are set when an array is loaded: a walk along the tree, in which what a list sets holds to its end,
// for the lists below it, too. (What both branches of an If set does not count behind it.)
#include "spirv/lower/tables.h"

#include <algorithm>
#include <optional>

#include "spirv/homes.h"
#include "spirv/ir_walk.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Instr;
using ir::Node;
using ir::Op;

class Tables {
 public:
  explicit Tables(ir::Function& function) : f_(function), arrays_(function.arrays.size()) {
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      arrays_[i].value.resize(f_.arrays[i].elements);
      arrays_[i].set.resize(f_.arrays[i].elements);
      arrays_[i].unset = f_.arrays[i].elements;
    }
    for (const Probe& probe : f_.probes)
      if (is_home(probe)) arrays_[probe.number - 1].constant = false;
    constants_.resize(f_.values.size());
    ir::each_node(f_.body, [&](const Node& node) {
      if (node.kind == Node::Kind::kInstr && node.instr.op == Op::kConst) constants_[node.instr.result] = &node.instr;
    });
  }

  void run() {
    visit(f_.body);
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      if (!is_table(i)) continue;
      std::vector<std::uint32_t>& table = f_.arrays[i].table;
      for (const std::optional<std::uint32_t>& value : arrays_[i].value) table.push_back(*value);
    }
    drop_stores(f_.body);
  }

 private:
  struct Array {
    std::vector<std::optional<std::uint32_t>> value;  ///< what is stored to an element, wherever
    std::vector<bool> set;                            ///< where the walk is
    std::uint32_t unset = 0;                          ///< how many are not
    bool constant = true, loaded = false;
  };
  struct Element {
    std::uint32_t array, index;
  };

  bool is_table(std::size_t i) const {
    return arrays_[i].constant && arrays_[i].loaded &&
           std::all_of(arrays_[i].value.begin(), arrays_[i].value.end(), [](const auto& v) { return v.has_value(); });
  }

  std::optional<std::uint32_t> constant(const ir::Src& src) const {
    const Instr* instr = constants_[src.value];
    if (!instr || instr->boolean) return std::nullopt;
    return instr->imm[src.swizzle[0]];
  }

  void visit(const ir::NodeList& list) {
    const std::size_t before = stored_.size();
    for (const auto& node : list) {
      if (node->kind == Node::Kind::kInstr) {
        visit(node->instr);
        continue;
      }
      for (const ir::NodeList* below : {&node->then_list, &node->else_list, &node->body, &node->continuing})
        visit(*below);
    }
    for (; stored_.size() > before; stored_.pop_back()) {
      Array& array = arrays_[stored_.back().array];
      array.set[stored_.back().index] = false;
      ++array.unset;
    }
  }

  void visit(const Instr& instr) {
    if (instr.op != Op::kLoadArray && instr.op != Op::kStoreArray) return;
    Array& array = arrays_[instr.data[0]];
    if (instr.op == Op::kLoadArray) {
      array.loaded = true;
      array.constant = array.constant && array.unset == 0;
    } else if (array.constant) {
      array.constant = store(instr, array);
    }
  }

  /// False: it is not one of a table.
  bool store(const Instr& instr, Array& array) {
    const std::optional<std::uint32_t> element = constant(instr.src[0]), value = constant(instr.src[1]);
    if (!element || !value || array.value.empty()) return false;
    const std::uint32_t last = static_cast<std::uint32_t>(array.value.size()) - 1;
    const std::uint32_t index = std::min(*element + instr.data[1], last);
    if (array.value[index] && *array.value[index] != *value) return false;
    array.value[index] = value;
    if (array.set[index]) return true;
    stored_.push_back({instr.data[0], index});
    array.set[index] = true;
    --array.unset;
    return true;
  }

  void drop_stores(ir::NodeList& list) {
    std::erase_if(list, [&](const auto& node) {
      return node->kind == Node::Kind::kInstr && node->instr.op == Op::kStoreArray && is_table(node->instr.data[0]);
    });
    for (auto& node : list)
      for (ir::NodeList* below : {&node->then_list, &node->else_list, &node->body, &node->continuing})
        drop_stores(*below);
  }

  ir::Function& f_;
  std::vector<Array> arrays_;
  std::vector<const Instr*> constants_;  ///< by value
  std::vector<Element> stored_;          ///< set by the lists that the walk is in
};

}  // namespace

void make_tables(ir::Function& function) {
  if (!function.arrays.empty()) Tables(function).run();
}

}  // namespace vitrine::spirv::lowering
