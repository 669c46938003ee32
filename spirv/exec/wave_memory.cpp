// Memory of a wave: one block, cut into the register files.
#include "spirv/exec/wave_memory.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <string>

namespace vitrine::spirv::exec {
namespace {

constexpr std::size_t kAlignment = 64;

/// About a second of one wave on a slow machine.
constexpr std::int64_t kShaderBudget = std::int64_t{1} << 28;

std::size_t aligned(std::size_t bytes) { return (bytes + kAlignment - 1) & ~(kAlignment - 1); }

void apply_mask_presets(const Program& program, Wave& wave) {
  for (const Preset& preset : program.mask_presets)
    wave.masks[preset.to / sizeof(base::LaneMask)] = wave.uniforms[preset.uniform / 4] != 0 ? base::kAllLanes : 0;
}

void apply_presets(const Program& program, Wave& wave) {
  apply_mask_presets(program, wave);
  for (const Preset& preset : program.register_presets) {
    auto* lanes = reinterpret_cast<std::uint32_t*>(wave.registers + preset.to);
    std::fill_n(lanes, base::kWaveWidth, wave.uniforms[preset.uniform / 4]);
  }
}

/// Of the instruction at which a wave stands; markers of control flow have none of their own: the nearest before them.
ir::Origin origin_of(const Wave& wave) {
  if (wave.resume == nullptr) return {};
  auto index = static_cast<std::size_t>(wave.resume - wave.program->code.data());
  while (index > 0 && wave.program->notes[index].origin.place == 0 && wave.program->notes[index].origin.spirv_id == 0)
    --index;
  return wave.program->notes[index].origin;
}

}  // namespace

WaveMemory::~WaveMemory() {
  if (data_) ::operator delete (data_, std::align_val_t{kAlignment});
}

void WaveMemory::reserve(std::size_t bytes) {
  if (bytes <= size_) return;
  auto* grown = static_cast<std::byte*>(::operator new (bytes, std::align_val_t{kAlignment}));
  if (data_) ::operator delete (data_, std::align_val_t{kAlignment});
  data_ = grown;
  size_ = bytes;
  std::memset(data_, 0, bytes);
}

void WaveMemory::bind(const BoundShader& shader, Wave& wave) {
  const Program& program = shader.shader().program();
  const bool scratch = program.uniform_words > program.draw_words;
  const std::size_t registers = aligned(std::size_t{program.register_count} * kRegisterStride);
  const std::size_t masks = aligned(program.mask_count * sizeof(base::LaneMask));
  const std::size_t uniforms = scratch ? aligned(program.uniform_words * sizeof(std::uint32_t)) : 0;
  reserve(registers + masks + uniforms + program.array_bytes + kAlignment);
  wave.registers = data_;
  wave.masks = reinterpret_cast<base::LaneMask*>(data_ + registers);
  wave.arrays = data_ + registers + masks + uniforms;
  wave.uniforms = const_cast<std::uint32_t*>(shader.uniforms());
  if (scratch) {
    wave.uniforms = reinterpret_cast<std::uint32_t*>(data_ + registers + masks);
    std::copy_n(shader.uniforms(), program.draw_words, wave.uniforms);
  }
  wave.resources = &shader.resources();
  wave.program = &program;
  apply_presets(program, wave);
}

void clear_undefined(const Program& program, Wave& wave) {
  for (const RegisterRange& range : program.cleared)
    std::memset(wave.registers + range.begin, 0, range.end - range.begin);
  std::fill_n(wave.masks, program.mask_count, base::LaneMask{0});
  apply_mask_presets(program, wave);
}

std::int64_t shader_budget() {
  static const std::int64_t budget = [] {
    const char* value = std::getenv("VITRINE_SHADER_BUDGET");
    const long long wanted = value ? std::strtoll(value, nullptr, 10) : 0;
    return wanted > 0 ? std::int64_t{wanted} : kShaderBudget;
  }();
  return budget;
}

std::string place_of(const Wave& wave) {
  const ir::Origin origin = origin_of(wave);
  std::string where;
  if (origin.place != 0 && wave.program->sources) where = " near " + wave.program->sources->stack(origin.place);
  if (origin.spirv_id != 0) where += " (SPIR-V id " + std::to_string(origin.spirv_id) + ")";
  return where;
}

void raise_fault(Fault& fault, const Wave& wave, std::uint64_t order) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (fault.raised.load(std::memory_order_relaxed) && fault.order.load(std::memory_order_relaxed) <= order) return;
  const ir::Origin origin = origin_of(wave);
  fault.message = "the shader did not end within its budget of " + std::to_string(shader_budget()) +
                  " instructions: " + std::to_string(std::popcount(wave.active)) + " of " +
                  std::to_string(std::popcount(wave.launched)) + " invocations of a wave are in a loop" +
                  place_of(wave);
  fault.sources = wave.program->sources;
  fault.place = origin.place;
  fault.spirv_id = origin.spirv_id;
  fault.order.store(order, std::memory_order_relaxed);
  fault.raised.store(true, std::memory_order_release);
}

}  // namespace vitrine::spirv::exec
