// One shader stage as the rasterizer runs it: the shader core, or a C++ function (internal draws and tests) behind the
// same whole-wave interface.
#pragma once

#include <cstddef>
#include <vector>

#include "base/lanes.h"
#include "spirv/shader.h"

namespace vitrine::raster {

/// A stage written in C++. Registers are numbered by the slots of `interface`, inputs and outputs separately.
struct NativeShader {
  spirv::ShaderInterface interface;
  /// Shades one wave; returns the lanes of active & ~helpers that were not discarded. Called by many threads.
  base::LaneMask (*run)(const void* user, const base::WaveRegister* inputs, base::WaveRegister* outputs,
                        base::LaneMask active, base::LaneMask helpers) = nullptr;
  const void* user = nullptr;
  /// Values of all outputs by register, if they are the same in every lane and the shader does nothing else; or null.
  const std::uint32_t* constants = nullptr;
};

/// What a draw runs in one stage; both null: no shader.
struct Stage {
  const spirv::BoundShader* bound = nullptr;
  const NativeShader* native = nullptr;
  bool operator==(const Stage&) const = default;
};

/// The memory of one wave of one thread. See spirv::WaveRunner.
class StageRunner {
 public:
  void bind(const Stage& stage);
  base::WaveRegister& input(std::uint32_t reg) { return stage_.native ? native_inputs_[reg] : runner_.input(reg); }
  /// See spirv::WaveRunner; stages written in C++ have none.
  void set_stage_memory(std::uint32_t* words, std::size_t count) { runner_.set_stage_memory(words, count); }
  const base::WaveRegister& output(std::uint32_t reg) const {
    return stage_.native ? native_outputs_[reg] : runner_.output(reg);
  }
  /// Whether the stage computes nothing and output `reg` is the same in all lanes: valid without a run().
  bool is_constant(std::uint32_t reg) const {
    return stage_.native ? stage_.native->constants != nullptr : runner_.is_constant(reg);
  }
  base::LaneMask run(base::LaneMask active, base::LaneMask helpers) {
    if (stage_.native)
      return stage_.native->run(stage_.native->user, native_inputs_.data(), native_outputs_.data(), active, helpers);
    return runner_.run(active, helpers);
  }

 private:
  Stage stage_;
  spirv::WaveRunner runner_;
  std::vector<base::WaveRegister> native_inputs_, native_outputs_;
};

}  // namespace vitrine::raster
