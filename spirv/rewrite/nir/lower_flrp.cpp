// What mixes consist of: x * (1 + -a) + y * a, unless x and y are literals for which the reference has a shorter form
// (nir_lower_flrp.c; lavapipe-shader-math.md 5.3; lavapipe-optimizer.md 3.8).
#include <bit>
#include <cmath>
#include <optional>

#include "base/float_mode.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/literals.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

class Mixer {
 public:
  Mixer(Graph& graph, InstId id)
      : graph_(graph), id_(id), width_(graph.insts[id].width), components_(graph.insts[id].components) {}

  void run() {
    const Inst& mix = graph_.insts[id_];
    const Src x = graph_.source(mix, 0), y = graph_.source(mix, 1), weight = graph_.source(mix, 2);
    const Src mixed = mix.exact ? strict(x, y, weight) : shortest(x, y, weight);
    replace_inst(graph_, id_, mixed.value);
  }

 private:
  using Numbers = std::array<double, 4>;

  // ---- what it becomes; instructions are made in the order of the reference

  Src shortest(Src x, Src y, Src weight) {
    if (are_similar(x, y)) return by_difference(x, y, weight);
    if (is_all(x, 1.0)) return from_one(x, y, weight);
    if (is_all(x, -1.0)) return from_minus_one(x, y, weight);
    return strict(x, y, weight);
  }

  Src strict(Src x, Src y, Src weight) {
    const Src rest = add(one(), negate(weight));
    const Src left = multiply(x, rest);
    return add(left, multiply(y, weight));
  }

  Src by_difference(Src x, Src y, Src weight) {
    const Src difference = add(y, negate(x));
    return add(x, multiply(weight, difference));
  }

  Src from_one(Src x, Src y, Src weight) {
    const Src right = multiply(y, weight);
    return add(add(x, negate(weight)), right);
  }

  Src from_minus_one(Src x, Src y, Src weight) {
    const Src right = multiply(y, weight);
    return add(add(x, weight), right);
  }

  // ---- literals

  /// The components of a literal as the reference reads them: it takes halves for the low bits of doubles, to which all
  /// but 0 are of similar size, and none is 1 or -1.
  std::optional<Numbers> literals(Src src) const {
    const Inst* constant = graph_.constant(src.value);
    if (!constant) return {};
    Numbers numbers{};
    for (unsigned c = 0; c < lanes(); ++c)
      numbers[c] = width_ == 16 ? std::bit_cast<double>(std::uint64_t{constant->imm[src.swizzle[c]]})
                                : literal_number(*constant, {src.swizzle[c], src.swizzle[1]}, width_);
    return numbers;
  }

  /// Vectors of doubles are scalars here.
  unsigned lanes() const { return width_ == 64 ? 1 : components_; }

  /// Literals whose difference loses nothing that matters, component by component.
  bool are_similar(Src x, Src y) const {
    const std::optional<Numbers> left = literals(x), right = literals(y);
    if (!left || !right) return false;
    const int limit = width_ == 32 ? 11 : 26;
    for (unsigned c = 0; c < lanes(); ++c) {
      int one = 0, other = 0;
      std::frexp((*left)[c], &one);
      std::frexp((*right)[c], &other);
      if (std::abs(one - other) > limit) return false;
    }
    return true;
  }

  bool is_all(Src src, double number) const {
    const std::optional<Numbers> numbers = literals(src);
    for (unsigned c = 0; numbers && c < lanes(); ++c)
      if ((*numbers)[c] != number) return false;
    return numbers.has_value();
  }

  // ---- building

  Builder build() { return {graph_, id_}; }
  Src one() {
    std::uint32_t words[2] = {};
    literal_words(1.0, width_, words);
    return build().literal(width_ == 64 ? 2 : 1, false, words);
  }
  Src apply(Op op, std::initializer_list<Src> operands) {
    return build().like(graph_.insts[id_], op, operands, components_);
  }
  Src negate(Src a) { return apply(Op::kFNeg, {a}); }
  Src add(Src a, Src b) { return apply(Op::kFAdd, {a, b}); }
  Src multiply(Src a, Src b) { return apply(Op::kFMul, {a, b}); }

  Graph& graph_;
  const InstId id_;
  const unsigned width_, components_;
};

template <class Chosen>
bool lower(Graph& graph, Chosen chosen) {
  const base::ScopedFloatMode mode(base::Denormals::kHonour);
  bool changed = false;
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (!computes(inst) || inst.op != Op::kFLrp || !chosen(inst)) return;
    Mixer(graph, id).run();
    changed = true;
  };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace

bool lower_flrp_but_half(Graph& graph) {
  return lower(graph, [](const Inst& mix) { return mix.width != 16; });
}

bool lower_flrp(Graph& graph) {
  return lower(graph, [](const Inst&) { return true; });
}

}  // namespace vitrine::spirv::rewriting
