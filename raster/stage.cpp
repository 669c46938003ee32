// Binding of a stage to the wave memory of a thread.
#include "raster/stage.h"

#include <algorithm>

namespace vitrine::raster {
namespace {

void grow(std::vector<base::WaveRegister>& registers, const std::vector<spirv::InterfaceSlot>& slots) {
  std::size_t count = 0;
  for (const spirv::InterfaceSlot& slot : slots) count = std::max<std::size_t>(count, slot.reg + std::size_t{1});
  if (registers.size() < count) registers.resize(count);
}

}  // namespace

void StageRunner::bind(const Stage& stage) {
  stage_ = stage;
  if (stage.native) {
    grow(native_inputs_, stage.native->interface.inputs);
    grow(native_outputs_, stage.native->interface.outputs);
    if (const std::uint32_t* values = stage.native->constants)
      for (const spirv::InterfaceSlot& slot : stage.native->interface.outputs)
        std::fill_n(native_outputs_[slot.reg].lane, base::kWaveWidth, values[slot.reg]);
  } else if (stage.bound) {
    runner_.bind(*stage.bound);
  }
}

}  // namespace vitrine::raster
