// What shaders cost: instructions of SPIR-V that invocations ran, by kind.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>

#include "glass/block_counts.h"
#include "glass/tool.h"
#include "spirv/program.h"

namespace vitrine::glass {

struct Costs {
  std::uint64_t invocations = 0;   ///< that were started, without helpers
  std::uint64_t instructions = 0;  ///< that invocations ran, without helpers
  std::uint64_t helper_instructions = 0;
  std::uint64_t idle_instructions = 0;  ///< that the other lanes of the waves (64 wide) could have run
  std::array<std::uint64_t, spirv::kCosts> by_kind{};

  /// A block of a program; `starts`: the first.
  void add(const spirv::Probe& probe, const BlockCounts::Count& count, bool starts);
  void add(const Costs& other);
};

/// A number of Costs, for people and files.
struct CostCounter {
  const char* name;
  const char* description;
  bool is_kind;  ///< files have it only where it is not 0
  bool is_bytes;
  std::uint64_t (*value)(const Costs& costs);
};
std::span<const CostCounter> cost_counters();

/// "compute main 1b5e0f3a": the number is made of the module's words.
std::string name_of(const ShaderIdentity& shader);

/// A program whose blocks are counted.
class CountedProgram : public ProgramTool {
 public:
  CountedProgram(const ShaderIdentity& shader, const spirv::Program& program);

  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave&, const spirv::Instruction*) override {
    return counts_.watch();
  }
  spirv::exec::Watch* lasting_watch() override { return &counts_.lasting_watch(); }
  Costs costs() const;
  /// Calls f(file, line, instructions) for all places of its source; a place may come several times.
  void for_each_line(const std::function<void(const spirv::SourceFile&, std::uint32_t, std::uint64_t)>& f) const;

  const std::string stage, name;

 private:
  std::shared_ptr<const spirv::SourceInfo> sources_;
  std::vector<spirv::Probe> probes_;
  BlockCounts counts_;
};

}  // namespace vitrine::glass
