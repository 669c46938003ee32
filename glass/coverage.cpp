// Which lines, functions and branches of shaders ran, in invocations (helpers do not count). Written to
// VITRINE_COVERAGE ("%p" is the process; default vitrine.info).
#include <cstdlib>
#include <map>
#include <mutex>
#include <set>

#include "glass/block_counts.h"
#include "glass/lcov.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace {

using spirv::Probe;

/// How often the blocks of one program ran.
class CoverageProgram : public ProgramTool {
 public:
  CoverageProgram(const ShaderIdentity& shader, const spirv::Program& program)
      : entry_point_(shader.entry_point),
        sources_(program.sources),
        probes_(program.probes),
        names_(program.sources ? program.sources->files.size() : 0),
        counts_(program) {
    for (std::size_t i = 0; i < names_.size(); ++i) names_[i] = name_of_source(sources_->files[i]);
  }

  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave&, const spirv::Instruction*) override {
    return counts_.watch();
  }
  spirv::exec::Watch* lasting_watch() override { return &counts_.lasting_watch(); }

  void add_to(Coverage& coverage) const;

 private:
  struct Block {
    const Probe* probe = nullptr;
    std::uint64_t count = 0;
  };
  /// By label: a function that was inlined several times counts once for each.
  using Blocks = std::map<std::uint32_t, Block>;

  Blocks blocks() const;
  FileCoverage& file_of(Coverage& coverage, const spirv::SourcePlace& place) const {
    return coverage[names_[place.file]];
  }
  std::string name_of(const Probe& probe, const spirv::SourceFunction& function, std::uint32_t scope) const;
  void add_functions(const Blocks& blocks, Coverage& coverage) const;
  void add_lines(const Blocks& blocks, Coverage& coverage) const;
  void add_branches(const Blocks& blocks, Coverage& coverage) const;

  std::string entry_point_;
  std::shared_ptr<const spirv::SourceInfo> sources_;
  std::vector<Probe> probes_;
  std::vector<std::string> names_;  ///< of files, in reports
  BlockCounts counts_;
};

CoverageProgram::Blocks CoverageProgram::blocks() const {
  Blocks blocks;
  const std::vector<BlockCounts::Count> counts = counts_.sum();
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    if (probes_[i].kind != Probe::Kind::kBlock) continue;
    Block& block = blocks[probes_[i].id];
    block.probe = &probes_[i];
    block.count += counts[i].invocations;
  }
  return blocks;
}

std::string CoverageProgram::name_of(const Probe& probe, const spirv::SourceFunction& function,
                                     std::uint32_t scope) const {
  if (!function.name.empty()) return function.name;
  if (scope == 0) return entry_point_;
  std::string name = "%";
  return name += std::to_string(probe.function);
}

void CoverageProgram::add_functions(const Blocks& blocks, Coverage& coverage) const {
  for (const auto& [label, block] : blocks) {
    if (!block.probe->enters || block.probe->places.empty()) continue;
    const spirv::SourcePlace& first = sources_->place(block.probe->places.front());
    const std::uint32_t scope = sources_->place(block.probe->place).scope;
    const spirv::SourceFunction& function = sources_->functions[sources_->scopes[scope].function];
    const std::string name = name_of(*block.probe, function, scope);
    FileCoverage::Function& entry = file_of(coverage, first).functions[name];
    entry.line = function.line != 0 ? function.line : first.line;
    entry.count += block.count;
  }
}

/// A line ran as often as the block of it that ran most.
void CoverageProgram::add_lines(const Blocks& blocks, Coverage& coverage) const {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> lines;  // of this program: (file, line)
  for (const auto& [label, block] : blocks)
    for (const std::uint32_t number : block.probe->places) {
      const spirv::SourcePlace& place = sources_->place(number);
      std::uint64_t& count = lines[{place.file, place.line}];
      count = std::max(count, block.count);
    }
  for (const auto& [place, count] : lines)
    file_of(coverage, {place.first, place.second, 0, 0}).lines[place.second] += count;
}

/// How often a way was taken: as often as the block ran to which no other way leads; the last one, what is left.
void CoverageProgram::add_branches(const Blocks& blocks, Coverage& coverage) const {
  std::map<std::uint32_t, unsigned> ways_in;
  for (const auto& [label, block] : blocks) {
    const auto& next = block.probe->successors;
    for (const std::uint32_t to : std::set<std::uint32_t>(next.begin(), next.end())) ++ways_in[to];
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> on_line;
  for (const auto& [label, block] : blocks) {
    const auto& next = block.probe->successors;
    const spirv::SourcePlace& place = sources_->place(block.probe->end_place);
    if (next.size() < 2 || place.line == 0) continue;
    std::vector<std::optional<std::uint64_t>> taken(next.size());
    std::uint64_t rest = block.count;
    std::size_t unknown = next.size(), unknowns = 0;
    for (std::size_t i = 0; i < next.size(); ++i) {
      const auto to = blocks.find(next[i]);
      if (ways_in[next[i]] == 1 && to != blocks.end()) {
        taken[i] = to->second.count;
        rest -= std::min(rest, to->second.count);
      } else {
        unknown = i;
        ++unknowns;
      }
    }
    if (unknowns == 1) taken[unknown] = rest;
    if (unknowns > 1) continue;
    if (block.count == 0) std::fill(taken.begin(), taken.end(), std::nullopt);
    auto& ways = file_of(coverage, place).branches[{place.line, on_line[{place.file, place.line}]++}];
    ways.resize(std::max(ways.size(), taken.size()));
    for (std::size_t i = 0; i < taken.size(); ++i)
      if (taken[i]) ways[i] = ways[i].value_or(0) + *taken[i];
  }
}

void CoverageProgram::add_to(Coverage& coverage) const {
  if (!sources_) return;
  const Blocks all = blocks();
  add_functions(all, coverage);
  add_lines(all, coverage);
  add_branches(all, coverage);
}

class CoverageTool : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {.blocks = true}; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    auto made = std::make_shared<CoverageProgram>(shader, program);
    const std::lock_guard lock(mutex_);
    programs_.push_back(made);
    return made;
  }

  void write() override {
    const std::lock_guard lock(mutex_);
    Coverage coverage;
    for (const auto& program : programs_) program->add_to(coverage);
    coverage.erase("");
    write_output("VITRINE_COVERAGE", "vitrine.info", to_lcov(coverage));
  }

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<CoverageProgram>> programs_;
};

}  // namespace

std::unique_ptr<Tool> make_coverage() { return std::make_unique<CoverageTool>(); }

}  // namespace vitrine::glass
