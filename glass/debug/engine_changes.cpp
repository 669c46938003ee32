// Other values, that a person gives what the stopped shader has: see engine.h.
#include <cstring>

#include "glass/debug/engine.h"

namespace vitrine::glass::debug {

std::string Engine::change(const Place& place, std::size_t lane, const std::vector<PlacedScalar>& numbers) {
  using Memory = spirv::SourceVariable::Memory;
  const Memory memory = place.variable->memory;
  if (!live_ || focus_.run != live_) return "only the wave that runs now can be changed";
  if (!history_.at_end())
    return "this has been done already: go forward to where the shader stands, or change it there";
  if (memory == Memory::kPush) return "push constants cannot be changed";
  const std::string error = place.texel                ? change_texel(place, lane, numbers)
                            : memory == Memory::kCells ? change_cells(lane, numbers)
                                                       : change_memory(lane, numbers);
  if (!error.empty()) return error;
  history_.grown();
  live_->changed = true;
  return {};
}

std::string Engine::change_cells(std::size_t lane, const std::vector<PlacedScalar>& numbers) {
  if (stores_ == nullptr) return "the shader is shown as it always runs: its variables cannot be changed";
  if (wave_ == nullptr) return "the invocation has ended";
  std::vector<Run::Change> changes;
  std::vector<std::uint32_t> homes;
  for (const auto& [at, number] : numbers) {
    const std::uint32_t words = number.width == 64 ? 2 : 1;
    for (std::uint32_t part = 0; part < words; ++part) {
      const std::uint32_t first = at.cell - words * at.component;
      const auto home = live_->subject->home_of(first + part * at.components + at.component);
      if (!home) return "it is no variable that keeps its value: parameters, inputs and names of results do not";
      homes.push_back(*home);
      changes.push_back({at.cell + part, static_cast<std::uint32_t>(number.bits >> 32 * part)});
    }
  }
  for (std::size_t i = 0; i < homes.size(); ++i)
    reinterpret_cast<base::WaveRegister*>(wave_->arrays + homes[i])->lane[lane] = changes[i].word;
  live_->change(lane, changes);
  return {};
}

std::string Engine::change_memory(std::size_t lane, const std::vector<PlacedScalar>& numbers) {
  const Viewer viewer = view(*live_, lane);
  std::vector<Patch> patches;
  for (const auto& [place, number] : numbers) {
    const std::vector<MemoryRange> memory = memory_of_place(viewer, place);
    if (memory.size() != 1) return "no memory is bound there";
    Patch& patch = patches.emplace_back();
    patch.at = memory[0];
    std::memcpy(patch.bytes.data(), &number.bits, memory[0].bytes);
  }
  change_bytes(lane, patches);
  return {};
}

std::string Engine::change_texel(const Place& place, std::size_t lane, const std::vector<PlacedScalar>& numbers) {
  const auto found = texel_at(view(*live_, lane), place);
  if (!found) return "the image has no such texel";
  texel::Texel texel{};
  for (std::size_t i = 0; i < numbers.size() && i < texel.size(); ++i)
    texel[i] = static_cast<std::uint32_t>(numbers[i].number.bits);
  Patch patch{{found->at, found->bytes}};
  if (!encode(*found, texel, patch.bytes)) return "texels of this format cannot be set";
  change_bytes(lane, {patch});
  return {};
}

void Engine::change_bytes(std::size_t lane, const std::vector<Patch>& patches) {
  live_->begin_stores(0);
  for (const Patch& patch : patches) {
    const auto bytes = static_cast<std::uint32_t>(patch.at.bytes);
    if (stores_ != nullptr) stores_->keep(patch.at.at, bytes);
    live_->add_store({patch.at.at, bytes, static_cast<std::uint32_t>(lane), bytes});
    std::memcpy(patch.at.at, patch.bytes.data(), bytes);
  }
}

}  // namespace vitrine::glass::debug
