// The memory behind a wave, the instruction budget and how a fault is reported.
#pragma once

#include <string>

#include "spirv/program.h"
#include "spirv/shader.h"

namespace vitrine::spirv::exec {

/// Registers, masks, local arrays and a private uniform file for one wave at a time. Grows, never shrinks.
class WaveMemory {
 public:
  WaveMemory() = default;
  ~WaveMemory();
  WaveMemory(const WaveMemory&) = delete;
  WaveMemory& operator=(const WaveMemory&) = delete;

  /// Makes `wave` ready to run `shader`: files, resources, presets. Throws std::bad_alloc.
  void bind(const BoundShader& shader, Wave& wave);

 private:
  void reserve(std::size_t bytes);

  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Zeros in what Program::cleared names, and in all masks without a preset.
void clear_undefined(const Program& program, Wave& wave);

/// Instructions in loops that a wave may run: kShaderBudget, or VITRINE_SHADER_BUDGET.
std::int64_t shader_budget();

/// " near a.comp:7:3 in f, called at a.comp:12 in main (SPIR-V id 12)": where a wave stands (Wave::resume); empty if
/// unknown.
std::string place_of(const Wave& wave);

/// Records that `wave` has spent its budget. Of several faults that of the lowest order counts; of those the first.
void raise_fault(Fault& fault, const Wave& wave, std::uint64_t order);

}  // namespace vitrine::spirv::exec
