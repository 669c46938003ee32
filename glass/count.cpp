// What shaders cost, in numbers that are the same in every run, on every CPU and with any number of threads:
// instructions of SPIR-V that invocations ran, by kind. Written to VITRINE_COUNTS ("%p" is the process; default
// counts.json); VITRINE_COUNT_LINES: with instructions by line, and the sources.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <nlohmann/json.hpp>

#include "glass/block_counts.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace {

using Json = nlohmann::ordered_json;
using spirv::Cost;
using spirv::Probe;

constexpr std::array<const char*, spirv::kCosts> kNames = {
    "arithmetic",  "conversions", "moves",    "loads",    "stores", "atomics",     "lookups",    "texels",
    "derivatives", "subgroup",    "barriers", "branches", "calls",  "bytesLoaded", "bytesStored"};

bool is_instruction(std::size_t cost) { return cost < static_cast<std::size_t>(Cost::kBytesLoaded); }

/// Sums over blocks.
struct Costs {
  std::uint64_t invocations = 0;   ///< that were started, without helpers
  std::uint64_t instructions = 0;  ///< that invocations ran, without helpers
  std::uint64_t helper_instructions = 0;
  std::uint64_t idle_instructions = 0;  ///< that the other lanes of the waves (64 wide) could have run
  std::array<std::uint64_t, spirv::kCosts> by_kind{};

  void add(const Probe& probe, const BlockCounts::Count& count, bool starts);
  void add(const Costs& other);
  Json json() const;
};

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

Json Costs::json() const {
  Json json{{"invocations", invocations},
            {"instructions", instructions},
            {"helperInstructions", helper_instructions},
            {"idleInstructions", idle_instructions}};
  for (std::size_t k = 0; k < spirv::kCosts; ++k)
    if (by_kind[k] != 0) json[kNames[k]] = by_kind[k];
  return json;
}

/// "compute main 1b5e0f3a": the number is made of the module's words.
std::string name_of(const ShaderIdentity& shader) {
  std::uint32_t hash = 2166136261u;
  for (const std::uint32_t word : shader.words)
    for (unsigned byte = 0; byte < 4; ++byte) hash = (hash ^ (word >> 8 * byte & 255)) * 16777619u;
  char number[12];
  std::snprintf(number, sizeof number, "%08x", hash);
  return std::string(stage_name(shader.stage)) + " " + std::string(shader.entry_point) + " " + number;
}

class CountedProgram : public ProgramTool {
 public:
  CountedProgram(const ShaderIdentity& shader, const spirv::Program& program)
      : stage(stage_name(shader.stage)),
        name(name_of(shader)),
        sources_(program.sources),
        probes_(program.probes),
        counts_(program.probes.size()) {}

  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave&, const spirv::Instruction*) override {
    return counts_.watch();
  }

  Costs costs() const;
  /// Adds to "lines" and "sources".
  void add_lines(Json& lines, Json& sources) const;

  const std::string stage, name;

 private:
  std::shared_ptr<const spirv::SourceInfo> sources_;
  std::vector<Probe> probes_;
  BlockCounts counts_;
};

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

void CountedProgram::add_lines(Json& lines, Json& sources) const {
  if (!sources_) return;
  const std::vector<BlockCounts::Count> counts = counts_.sum();
  for (std::size_t i = 0; i < probes_.size(); ++i)
    for (const auto& [number, instructions] : probes_[i].instructions) {
      const spirv::SourcePlace& place = sources_->place(number);
      const spirv::SourceFile& file = sources_->files[place.file];
      if (place.line == 0 || file.name.empty()) continue;
      Json& line = lines[file.name][std::to_string(place.line)];
      line = (line.is_null() ? 0 : line.get<std::uint64_t>()) + instructions * counts[i].invocations;
      if (!file.text.empty()) sources[file.name] = file.text;
    }
}

class CountTool : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {.blocks = true}; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    auto made = std::make_shared<CountedProgram>(shader, program);
    const std::lock_guard lock(mutex_);
    programs_.push_back(made);
    return made;
  }

  void write() override;

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<CountedProgram>> programs_;
};

void CountTool::write() {
  const std::lock_guard lock(mutex_);
  Costs total;
  std::map<std::string, Costs> stages, shaders;
  for (const auto& program : programs_) {
    const Costs costs = program->costs();
    if (costs.invocations == 0) continue;
    total.add(costs);
    stages[program->stage].add(costs);
    shaders[program->name].add(costs);
  }
  Json json{{"format", "vitrine-counters"}, {"version", 1}, {"total", total.json()}};
  for (const auto& [name, costs] : stages) json["stages"][name] = costs.json();
  for (const auto& [name, costs] : shaders) json["shaders"][name] = costs.json();
  if (std::getenv("VITRINE_COUNT_LINES") != nullptr) {
    Json lines = Json::object(), sources = Json::object();
    for (const auto& program : programs_) program->add_lines(lines, sources);
    json["lines"] = std::move(lines);
    json["sources"] = std::move(sources);
  }
  write_output("VITRINE_COUNTS", "counts.json", json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

}  // namespace

std::unique_ptr<Tool> make_count() { return std::make_unique<CountTool>(); }

}  // namespace vitrine::glass
