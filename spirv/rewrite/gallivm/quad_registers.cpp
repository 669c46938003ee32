// What lanes hold that do not run. Levels of detail and derivatives follow from whole quads; where some of a quad's
// lanes wait outside of a branch or have left a loop, the reference finds in them what its registers held, which only
// running lanes write, and the rest computed as if they ran. Here such a register is a local array beside the value
// itself, which lookups in divided code read (lavapipe-optimizer.md 6.6).
#include <map>
#include <set>
#include <utility>

#include "spirv/rewrite/gallivm/divergence.h"
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/gallivm/phi_webs.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;
using ir::ImageAccess;
using ir::ImageOperand;

bool is_derivative(const Inst& inst) { return computes(inst) && (inst.op == Op::kFDdx || inst.op == Op::kFDdy); }

/// Whether a lookup takes this operand of one lane for another one of its quad: coordinates that it takes differences
/// of, and all that chooses the level of detail, which is the quad's.
bool serves_quad(const ir::ImageInfo& info, ImageOperand operand) {
  switch (operand) {
    case ImageOperand::kCoord:
      return (info.operands &
              (1u << static_cast<int>(ImageOperand::kLod) | 1u << static_cast<int>(ImageOperand::kGradX))) == 0 &&
             !info.explicit_lod_zero;
    case ImageOperand::kLod:
    case ImageOperand::kBias:
    case ImageOperand::kGradX:
    case ImageOperand::kGradY:
    case ImageOperand::kMinLod:
      return true;
    default:
      return false;
  }
}

class QuadRegisters {
 public:
  explicit QuadRegisters(Graph& graph) : graph_(graph) {}

  void run() {
    find_readers();
    if (readers_.empty()) return;
    const Divergence divergence(graph_);
    divergence_ = &divergence;
    std::erase_if(readers_, [&](const Read& read) { return !divided(read.user); });
    if (readers_.empty()) return;
    webs_ = phi_webs(graph_);
    if (webs_.joins.empty()) return;
    for (const Read& read : readers_) trace(read);
    for (const auto& [web, array] : arrays_) store_members(web);
    for (const auto& [value, array] : behind_) store({value, kWhole}, array, kAll, Builder::behind(graph_, def(value)));
    for (const Read& read : reads_) load(read);
  }

 private:
  struct Read {
    InstId user;
    std::uint32_t operand;
    auto operator<=>(const Read&) const = default;
  };

  bool divided(InstId id) const { return divergence_->divides(graph_.insts[id].block); }

  // ---- what is read

  void find_readers() {
    bool returned = false;
    auto visit = [&](InstId id) {
      const Inst& inst = graph_.insts[id];
      returned = returned || is_jump(inst, Op::kReturn);
      if (graph_.blocks[inst.block].owner == kNone && !returned) return;
      if (is_derivative(inst)) readers_.push_back({id, 0});
      if (inst.kind == Kind::kIntrinsic && inst.op == Op::kImage) find_operands(id);
    };
    for_each_inst(graph_, graph_.root, visit);
  }

  void find_operands(InstId id) {
    const ir::ImageInfo& info = *graph_.nodes[graph_.insts[id].node]->instr.image;
    if (!info.in_quads || (info.access != ImageAccess::kSample && info.access != ImageAccess::kQueryLod)) return;
    std::uint32_t next = 0;
    for (int operand = 0; operand < static_cast<int>(ImageOperand::kCount); ++operand) {
      if (!(info.operands >> operand & 1)) continue;
      if (serves_quad(info, static_cast<ImageOperand>(operand))) readers_.push_back({id, next});
      ++next;
    }
  }

  /// Follows an operand through what all lanes compute, up to registers.
  void trace(const Read& start) {
    std::vector<Read> work{start};
    while (!work.empty()) {
      const Read read = work.back();
      work.pop_back();
      if (!divided(read.user) || !seen_.insert(read).second) continue;
      const ValueId value = graph_.source(graph_.insts[read.user], read.operand).value;
      if (const std::uint32_t web = webs_.web[value]; web != kNone) {
        reads_.push_back(read);
        if (!arrays_.contains(web)) arrays_[web] = new_array(value);
        continue;
      }
      if (def(value) == kNone) continue;
      if (leaves_loop(value, read.user)) {
        reads_.push_back(read);
        if (!behind_.contains(value)) behind_[value] = new_array(value);
      }
      for (std::uint32_t i = 0; i < graph_.insts[def(value)].count; ++i) work.push_back({def(value), i});
    }
  }

  InstId def(ValueId value) const { return graph_.values[value].def; }

  /// `value` is computed in a loop that `user` is behind.
  bool leaves_loop(ValueId value, InstId user) const {
    const InstId loop = loop_around(graph_, graph_.insts[def(value)].block);
    InstId at = loop_around(graph_, graph_.insts[user].block);
    while (at != loop && at != kNone) at = loop_around(graph_, graph_.insts[at].block);
    return at != loop;
  }

  std::uint32_t new_array(ValueId value) {
    graph_.function.arrays.push_back({graph_.values[value].components});
    return static_cast<std::uint32_t>(graph_.function.arrays.size() - 1);
  }

  // ---- the register beside the values

  void store_members(std::uint32_t web) {
    for (const Join& join : webs_.joins) {
      const bool own = webs_.web[join.value] == web;
      if (join.web == web)
        for (const Join::Way& way : join.ways) store_way(web, way);
      if (own && join.web != web) store_taken(web, join);
    }
    for (ValueId value = 0; value < webs_.web.size(); ++value)
      if (webs_.web[value] == web && is_computed(value))
        store({value, kWhole}, arrays_[web], kRunning, Builder::behind(graph_, def(value)));
  }

  bool is_computed(ValueId value) const {
    if (def(value) == kNone) return false;
    const Kind kind = graph_.insts[def(value)].kind;
    return kind != Kind::kIf && kind != Kind::kLoop;
  }

  void store_way(std::uint32_t web, const Join::Way& way) {
    const Src src = graph_.source(graph_.insts[way.end], way.operand);
    const Inst* def = graph_.def(src.value);
    if (def && def->kind == Kind::kIntrinsic && def->op == Op::kUndef) return;
    if (webs_.web[src.value] != web) store(src, arrays_[web], kRunning, Builder(graph_, way.end));
  }

  /// Where the join has another register than its value.
  void store_taken(std::uint32_t web, const Join& join) {
    const Src value{join.value, kWhole};
    if (!join.parameter) return store(value, arrays_[web], kRunning, Builder::behind(graph_, join.owner));
    store(value, arrays_[web], kRunning, Builder(graph_, graph_.blocks[graph_.insts[join.owner].child[0]].head));
  }

  enum Lanes : std::uint32_t { kRunning = 0, kAll = 1 };  ///< data[2] of StoreArray

  void store(Src src, std::uint32_t array, Lanes lanes, Builder at) {
    const bool boolean = graph_.values[src.value].boolean;
    const Src element = at.literal(0);
    for (unsigned c = 0; c < graph_.function.arrays[array].elements; ++c) {
      const Src word = boolean ? at.alu(Op::kB2I, {scalar(src, c)}) : scalar(src, c);
      at.access(Op::kStoreArray, 0, {element, word}, {array, c, lanes});
    }
  }

  void load(const Read& read) {
    const Src src = graph_.source(graph_.insts[read.user], read.operand);
    const std::uint32_t web = webs_.web[src.value], array = web != kNone ? arrays_[web] : behind_[src.value];
    const bool boolean = graph_.values[src.value].boolean;
    if (web == kNone) store({src.value, kWhole}, array, kRunning, Builder(graph_, read.user));
    Builder at(graph_, read.user);
    const Src element = at.literal(0);
    std::vector<Src> words;
    for (unsigned c = 0; c < graph_.function.arrays[array].elements; ++c) {
      words.push_back(at.access(Op::kLoadArray, 1, {element}, {array, c, 0}));
      if (boolean) words.back() = at.alu(Op::kINe, {words.back(), element});
    }
    const Src whole = words.size() == 1 ? words[0] : at.vec(words, boolean);
    graph_.set_source(read.user, read.operand, {whole.value, src.swizzle});
  }

  Graph& graph_;
  const Divergence* divergence_ = nullptr;
  PhiWebs webs_;
  std::vector<Read> readers_, reads_;
  std::set<Read> seen_;
  std::map<std::uint32_t, std::uint32_t> arrays_;  ///< by web
  std::map<ValueId, std::uint32_t> behind_;        ///< by value that is read behind the loop that computes it
};

}  // namespace

void quad_registers(Graph& graph) { QuadRegisters(graph).run(); }

}  // namespace vitrine::spirv::rewriting
