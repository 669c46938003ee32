// Costs of programs from how often their blocks ran.
#include "glass/costs.h"

#include <cstdio>
#include <functional>
#include <utility>

namespace vitrine::glass {
namespace {

using spirv::Cost;
using spirv::Probe;

template <Cost kind>
std::uint64_t of(const Costs& costs) {
  return costs.by_kind[static_cast<std::size_t>(kind)];
}

constexpr CostCounter kCounters[] = {
    {"invocations", "invocations of shaders, without helpers", false, false,
     [](const Costs& c) { return c.invocations; }},
    {"instructions", "instructions of SPIR-V that invocations ran", false, false,
     [](const Costs& c) { return c.instructions; }},
    {"helperInstructions", "instructions that helper invocations ran", false, false,
     [](const Costs& c) { return c.helper_instructions; }},
    {"idleInstructions", "instructions that the other lanes of waves, 64 wide, could have run meanwhile", false, false,
     [](const Costs& c) { return c.idle_instructions; }},
    {"arithmetic", "instructions on numbers, booleans and bits", true, false, of<Cost::kArithmetic>},
    {"conversions", "instructions that convert between types of numbers", true, false, of<Cost::kConversions>},
    {"moves", "composites, selections, phis, pointers and variables", true, false, of<Cost::kMoves>},
    {"loads", "loads from buffers, push constants and shared memory", true, false, of<Cost::kLoads>},
    {"stores", "stores to buffers and shared memory", true, false, of<Cost::kStores>},
    {"atomics", "atomic operations on memory and images", true, false, of<Cost::kAtomics>},
    {"lookups", "lookups and queries of images", true, false, of<Cost::kLookups>},
    {"texels", "texels that are fetched, read or written one by one", true, false, of<Cost::kTexels>},
    {"derivatives", "derivatives", true, false, of<Cost::kDerivatives>},
    {"subgroup", "operations of subgroups", true, false, of<Cost::kSubgroup>},
    {"barriers", "barriers", true, false, of<Cost::kBarriers>},
    {"branches", "conditional branches and switches", true, false, of<Cost::kBranches>},
    {"calls", "calls of functions", true, false, of<Cost::kCalls>},
    {"bytesLoaded", "bytes of loaded values, without padding", true, true, of<Cost::kBytesLoaded>},
    {"bytesStored", "bytes of stored values, without padding", true, true, of<Cost::kBytesStored>},
};
static_assert(std::size(kCounters) == 4 + spirv::kCosts);

bool is_instruction(std::size_t cost) { return cost < static_cast<std::size_t>(Cost::kBytesLoaded); }

}  // namespace

std::span<const CostCounter> cost_counters() { return kCounters; }

void Costs::add(const Probe& probe, const BlockCounts::Count& count, bool starts) {
  if (starts) invocations += count.invocations;
  std::uint64_t length = 0;
  for (std::size_t k = 0; k < spirv::kCosts; ++k) {
    by_kind[k] += probe.costs[k] * count.invocations;
    if (is_instruction(k)) length += probe.costs[k];
  }
  instructions += length * count.invocations;
  helper_instructions += length * count.helpers;
  idle_instructions += length * (count.waves * base::kWaveWidth - count.invocations - count.helpers);
}

void Costs::add(const Costs& other) {
  invocations += other.invocations;
  instructions += other.instructions;
  helper_instructions += other.helper_instructions;
  idle_instructions += other.idle_instructions;
  for (std::size_t k = 0; k < spirv::kCosts; ++k) by_kind[k] += other.by_kind[k];
}

std::string name_of(const ShaderIdentity& shader) {
  std::uint32_t hash = 2166136261u;
  for (const std::uint32_t word : shader.words)
    for (unsigned byte = 0; byte < 4; ++byte) hash = (hash ^ (word >> 8 * byte & 255)) * 16777619u;
  char number[12];
  std::snprintf(number, sizeof number, "%08x", hash);
  return std::string(stage_name(shader.stage)) + " " + std::string(shader.entry_point) + " " + number;
}

CountedProgram::CountedProgram(const ShaderIdentity& shader, const spirv::Program& program)
    : stage(stage_name(shader.stage)),
      name(name_of(shader)),
      sources_(program.sources),
      probes_(program.probes),
      counts_(program) {}

Costs CountedProgram::costs() const {
  Costs costs;
  const std::vector<BlockCounts::Count> counts = counts_.sum();
  bool first = true;
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    if (probes_[i].kind != Probe::Kind::kBlock) continue;
    costs.add(probes_[i], counts[i], std::exchange(first, false));
  }
  return costs;
}

void CountedProgram::for_each_line(
    const std::function<void(const spirv::SourceFile&, std::uint32_t, std::uint64_t)>& f) const {
  if (!sources_) return;
  const std::vector<BlockCounts::Count> counts = counts_.sum();
  for (std::size_t i = 0; i < probes_.size(); ++i)
    for (const auto& [number, instructions] : probes_[i].instructions) {
      const spirv::SourcePlace& place = sources_->place(number);
      const spirv::SourceFile& file = sources_->files[place.file];
      if (place.line != 0 && !file.name.empty()) f(file, place.line, instructions * counts[i].invocations);
    }
}

}  // namespace vitrine::glass
