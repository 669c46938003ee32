// What each turn of a loop takes from the budget of a wave (Wave::budget): the instructions between its top and its
// end, whatever of them runs. Decided here, so that a turn costs one subtraction.
#include <algorithm>
#include <string_view>
#include <vector>

#include "spirv/exec/handlers.h"
#include "spirv/lower/emit.h"

namespace vitrine::spirv::lowering {
namespace {

// Instructions of a wave that lanes do one after the other take about as long as so many others.
constexpr std::uint32_t kSlowCost = 16, kMemoryCost = 32, kImageCost = 256;

/// Numbers of two words, and combinations over a subgroup.
bool is_slow(const InstructionNote& note) {
  return note.high == 'r' || std::string_view(note.name).starts_with("reduce");
}

std::uint32_t cost_of(const InstructionNote& note) {
  if (std::string_view(note.name) == "probe") return 0;  // who looks changes nothing
  if (note.extra == InstructionNote::Extra::kImage) return kImageCost;
  if (note.extra == InstructionNote::Extra::kMemory && note.data != 'u') return kMemoryCost;
  return is_slow(note) ? kSlowCost : 1;
}

constexpr std::uint64_t kTurns = 32;  ///< of a loop
constexpr int kMaxDepth = 3;          ///< of loops in each other that are told apart

/// `begun`: by instruction, how many loops begin there, less those that have ended in front of it.
std::uint64_t cost_of_wave(const std::vector<int>& begun, std::size_t instructions) {
  std::uint64_t cost = 0;
  int loops = 0;
  for (std::size_t i = 0; i < instructions; ++i) {
    loops += begun[i];
    std::uint64_t times = 1;
    for (int loop = 0; loop < std::min(loops, kMaxDepth); ++loop) times *= kTurns;
    cost += times;
  }
  return cost;
}

}  // namespace

void charge_loops(Program& program) {
  std::vector<std::uint32_t> before(program.code.size() + 1);  ///< cost of all instructions before each
  for (std::size_t i = 0; i < program.code.size(); ++i) before[i + 1] = before[i] + cost_of(program.notes[i]);
  std::vector<int> begun(program.code.size() + 1);
  for (std::size_t i = 0; i < program.code.size(); ++i) {
    Instruction& end = program.code[i];
    if (end.handler != exec::loop_back && end.handler != exec::loop_back_mask) continue;
    const auto top = static_cast<std::size_t>(static_cast<std::int64_t>(i) + static_cast<std::int32_t>(end.extra[0]));
    end.extra[1] = before[i + 1] - before[top];
    ++begun[top];
    --begun[i + 1];
  }
  program.cost = cost_of_wave(begun, program.code.size());
}

}  // namespace vitrine::spirv::lowering
