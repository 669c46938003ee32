// Shader, its binding to resources, and the memory of one wave.
#include "spirv/shader.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

#include "base/float_mode.h"
#include "base/log.h"
#include "spirv/exec/profile.h"
#include "spirv/exec/wave_memory.h"
#include "spirv/program.h"

namespace vitrine::spirv {

Shader::Shader(ShaderInterface interface, std::unique_ptr<const Program> program)
    : interface_(std::move(interface)), program_(std::move(program)) {}

Shader::~Shader() {
  if (!exec::profile_enabled()) return;
  const std::string profile = exec::take_profile(*program_);
  if (!profile.empty()) base::log("shader-profile", "stage " + std::to_string(interface_.stage) + "\n" + profile);
}

BoundShader::BoundShader(const Shader& shader, const ResourceTable& resources, Fault& fault)
    : shader_(&shader), resources_(resources), fault_(&fault) {
  static std::atomic<std::uint64_t> last_serial{0};
  resources_.serial = last_serial.fetch_add(1, std::memory_order_relaxed) + 1;
  const Program& program = shader.program();
  constexpr std::size_t kAlignment = 64;
  const std::size_t bytes = (program.draw_words + 1) * sizeof(std::uint32_t);
  std::size_t room = bytes + kAlignment;
  storage_ = std::make_unique_for_overwrite<std::byte[]>(room);
  void* aligned = storage_.get();
  uniforms_ = static_cast<std::uint32_t*>(std::align(kAlignment, bytes, aligned, room));
  std::copy(program.constants.begin(), program.constants.end(), uniforms_);
  if (program.preamble.size() <= 1) return;
  const base::ScopedFloatMode mode(program.flush_denormals ? base::Denormals::kFlush : base::Denormals::kHonour);
  Wave wave;
  wave.uniforms = uniforms_;
  wave.resources = &resources_;
  wave.program = &program;
  wave.active = wave.live = wave.launched = 1;
  (exec::profile_enabled() ? exec::execute_profiled : execute)(wave, program.preamble.data());
}

BoundShader::~BoundShader() = default;
BoundShader::BoundShader(BoundShader&&) noexcept = default;

struct WaveRunner::State {
  exec::WaveMemory memory;
  Wave wave;
  const BoundShader* shader = nullptr;
  Loop loop = execute;
};

WaveRunner::WaveRunner() : state_(std::make_unique<State>()) {}
WaveRunner::~WaveRunner() = default;

void WaveRunner::bind(const BoundShader& shader) {
  state_->shader = &shader;
  state_->loop = loop_of(shader.shader().program());
  state_->memory.bind(shader, state_->wave);
}

void WaveRunner::set_stage_memory(std::uint32_t* words, std::size_t count) {
  state_->wave.shared = reinterpret_cast<std::byte*>(words);
  state_->wave.shared_size = static_cast<std::uint32_t>(std::min<std::size_t>(count * 4, INT32_MAX));
}

base::WaveRegister& WaveRunner::input(std::uint32_t reg) {
  return *reinterpret_cast<base::WaveRegister*>(state_->wave.registers + std::size_t{reg} * kRegisterStride);
}

const base::WaveRegister& WaveRunner::output(std::uint32_t reg) const {
  return *reinterpret_cast<const base::WaveRegister*>(state_->wave.registers + std::size_t{reg} * kRegisterStride);
}

bool WaveRunner::is_constant(std::uint32_t reg) const {
  const Program& program = state_->shader->shader().program();
  if (program.code.size() > 1 || program.observation) return false;
  return std::any_of(program.register_presets.begin(), program.register_presets.end(),
                     [&](const Preset& p) { return p.to == reg * kRegisterStride; });
}

base::LaneMask WaveRunner::run(base::LaneMask active, base::LaneMask helpers) {
  Wave& wave = state_->wave;
  if (state_->shader->fault().raised.load(std::memory_order_relaxed)) return 0;  // the device is lost: be quick
  wave.active = wave.launched = active;
  wave.live = active & ~helpers;
  wave.budget = exec::shader_budget();
  if (!wave.program->cleared.empty()) exec::clear_undefined(*wave.program, wave);
  state_->loop(wave, wave.program->code.data());
  if (wave.status == Wave::Status::kFault) exec::raise_fault(state_->shader->fault(), wave, 0);
  return wave.live;
}

}  // namespace vitrine::spirv
