// Loads of what an earlier load brought already: the reference knows a push constant, uniform or storage vector by its
// components, so that p.y and the second component of p are one value (lavapipe-optimizer.md 3.2).
#include <array>
#include <unordered_map>
#include <utility>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/effects.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// One 32-bit word of a resource.
struct Word {
  Op op = Op::kLoadPush;
  std::uint32_t set = 0, slot = 0;
  ValueId element = ir::kNoValue;  ///< array element of the descriptor, if not constant
  std::uint32_t element_number = 0;
  ValueId dynamic = ir::kNoValue;  ///< byte offset, if not constant
  std::uint8_t component = 0;      ///< of `dynamic`
  std::uint32_t offset = 0;        ///< constant part of the byte offset
  bool operator==(const Word&) const = default;
};

struct WordHash {
  std::size_t operator()(const Word& w) const {
    std::uint32_t h = static_cast<std::uint32_t>(w.op);
    for (const std::uint32_t part : {w.set, w.slot, w.element, w.element_number, w.dynamic, w.offset})
      h = (h ^ part) * 0x9E3779B1u + (h >> 15);
    return h;
  }
};

/// A load of words that may be any earlier one; those of bytes and halves stay as they are.
bool is_word_load(const Graph& graph, const Inst& inst) {
  return inst.kind == Kind::kIntrinsic &&
         (inst.op == Op::kLoadPush || inst.op == Op::kLoadUniform || inst.op == Op::kLoadStorage) &&
         ir::element_bytes(graph.nodes[inst.node]->instr.imm) == 4 && graph.nodes[inst.node]->instr.imm[2] == 0;
}

/// What other invocations or this one may do to storage buffers.
bool writes_storage(const Inst& inst) {
  if (inst.kind != Kind::kIntrinsic) return false;
  switch (inst.op) {
    case Op::kStoreStorage:
    case Op::kAtomicStorage:
    case Op::kStoreGlobal:
    case Op::kAtomicGlobal:
    case Op::kBarrier:
    case Op::kMemoryBarrier:
      return true;
    default:
      return false;
  }
}

class Forwarder {
 public:
  explicit Forwarder(Graph& graph) : graph_(graph) {}

  bool run() {
    visit(graph_.root);
    return changed_;
  }

 private:
  Word word_of(const Inst& inst) const {
    const ir::Instr& instr = graph_.nodes[inst.node]->instr;
    Word word;
    word.op = inst.op;
    const bool push = inst.op == Op::kLoadPush;
    word.offset = push ? instr.data[0] : instr.data[3];
    if (!push) {
      word.set = instr.data[0];
      word.slot = instr.data[1];
      const Src element = graph_.source(inst, 0);
      const Inst* number = graph_.constant(element.value);
      word.element = number ? ir::kNoValue : element.value;
      word.element_number = number ? number->imm[element.swizzle[0]] : element.swizzle[0];
    }
    const Src offset = graph_.source(inst, push ? 0 : 1);
    if (const Inst* constant = graph_.constant(offset.value)) {
      word.offset += constant->imm[offset.swizzle[0]];
    } else {
      word.dynamic = offset.value;
      word.component = offset.swizzle[0];
    }
    return word;
  }

  void enter(const Word& word, Src src) {
    const auto entry = known_.find(word);
    overwritten_.push_back({word, entry == known_.end() ? Src{} : entry->second});
    known_[word] = src;
  }

  /// Puts back what was known when `overwritten_` had `count` entries.
  void restore(std::size_t count) {
    for (; overwritten_.size() > count; overwritten_.pop_back()) {
      const auto& [word, before] = overwritten_.back();
      if (before.value == ir::kNoValue) {
        known_.erase(word);
      } else {
        known_[word] = before;
      }
    }
  }

  /// The value that the parts are as a whole, or kNoValue.
  ValueId one_value(const std::array<Src, 4>& parts, unsigned count) const {
    for (unsigned c = 0; c < count; ++c)
      if (parts[c].value != parts[0].value || parts[c].swizzle[0] != c) return ir::kNoValue;
    return graph_.values[parts[0].value].components == count ? parts[0].value : ir::kNoValue;
  }

  ValueId compose(InstId id, const std::array<Src, 4>& parts) {
    const Inst inst = graph_.insts[id];
    const InstId made = graph_.create(Kind::kVec, Op::kVec, inst.components, inst.boolean, inst.components);
    graph_.replace_uses(inst.result, graph_.insts[made].result);  // before the vector may use it
    for (unsigned c = 0; c < inst.components; ++c) graph_.set_source(made, c, parts[c]);
    return Builder::behind(graph_, id).place(made).value;
  }

  /// True when a user of the value reads one of its components that `parts` has from elsewhere.
  bool reads_elsewhere(ValueId value, const std::array<Src, 4>& parts) const {
    for (Slot slot = graph_.values[value].first_use; slot != kNone; slot = graph_.sources[slot].next) {
      const Operand& operand = graph_.sources[slot];
      const Inst& user = graph_.insts[operand.user];
      unsigned read = components_read(graph_, user, slot - user.first);
      if (read == 0) read = graph_.values[value].components;
      for (unsigned c = 0; c < read; ++c)
        if (parts[operand.src.swizzle[c]].value != value) return true;
    }
    return false;
  }

  /// The words of a load from loads before, the rest from itself; all from itself where those are not read.
  void forward(InstId id) {
    const Inst inst = graph_.insts[id];
    const Word first = word_of(inst);
    std::array<Src, 4> parts;
    unsigned found = 0;
    for (std::uint8_t c = 0; c < inst.components; ++c) {
      Word word = first;
      word.offset += 4u * c;
      const auto entry = known_.find(word);
      const bool knows = entry != known_.end();
      found += knows ? 1 : 0;
      parts[c] = knows ? entry->second : Src{inst.result, {c, c, c, c}};
    }
    ValueId value = inst.result;
    if (found == inst.components || (found != 0 && reads_elsewhere(value, parts))) {
      changed_ = true;
      value = one_value(parts, inst.components);
      if (value == ir::kNoValue) {
        value = compose(id, parts);
      } else {
        graph_.replace_uses(inst.result, value);
      }
      if (found == inst.components) graph_.remove(id);
    }
    for (std::uint8_t c = 0; c < inst.components; ++c) {
      Word word = first;
      word.offset += 4u * c;
      enter(word, {value, {c, c, c, c}});
    }
  }

  void forget_storage() {
    std::erase_if(known_, [](const auto& entry) { return entry.first.op == Op::kLoadStorage; });
  }

  bool writes(BlockId block) const {
    for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) {
      if (writes_storage(graph_.insts[id])) return true;
      for (const BlockId child : graph_.insts[id].child)
        if (child != kNone && writes(child)) return true;
    }
    return false;
  }

  void visit_children(InstId id) {
    const BlockId child[2] = {graph_.insts[id].child[0], graph_.insts[id].child[1]};
    const bool written = writes(child[0]) || writes(child[1]);
    const bool loop = graph_.insts[id].kind == Kind::kLoop;
    if (loop) forget_storage();  // it may wait for others to write
    for (const BlockId block : child) {
      const auto saved = written ? known_ : decltype(known_){};
      const std::size_t count = overwritten_.size();
      visit(block);
      restore(count);
      if (written) known_ = saved;
    }
    if (written) forget_storage();
  }

  void visit(BlockId block) {
    for (InstId id = graph_.blocks[block].head; id != kNone;) {
      const InstId next = graph_.insts[id].next;
      if (is_word_load(graph_, graph_.insts[id])) {
        forward(id);
      } else if (graph_.insts[id].child[0] != kNone) {
        visit_children(id);
      } else if (writes_storage(graph_.insts[id])) {
        forget_storage();
      }
      id = next;
    }
  }

  Graph& graph_;
  std::unordered_map<Word, Src, WordHash> known_;
  std::vector<std::pair<Word, Src>> overwritten_;  ///< and what was known before
  bool changed_ = false;
};

}  // namespace

bool opt_copy_prop_vars(Graph& graph) { return Forwarder(graph).run(); }

}  // namespace vitrine::spirv::rewriting
