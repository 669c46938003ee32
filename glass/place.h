// Where in the source something happened.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "glass/tool.h"
#include "spirv/observed_command.h"
#include "spirv/source_info.h"

namespace vitrine::glass {

/// What is the same for all that happens in one program.
struct ShaderContext {
  VkShaderStageFlagBits stage{};
  std::string entry_point;
  std::shared_ptr<const spirv::SourceInfo> sources;

  ShaderContext(const ShaderIdentity& shader, const spirv::Program& program)
      : stage(shader.stage), entry_point(shader.entry_point), sources(program.sources) {}

  /// Of something that an invocation does; `id` as spirv::exec::invocation_of(). No command: nothing is known of it.
  Address address(const spirv::ObservedCommand* command, const std::array<std::uint32_t, 3>& id, std::uint32_t spirv_id,
                  std::uint32_t place) const;
  Address address(const spirv::Wave& wave, const std::array<std::uint32_t, 3>& id, std::uint32_t spirv_id,
                  std::uint32_t place) const {
    return address(wave.resources->command, id, spirv_id, place);
  }
};

/// The place and the calls that lead there, innermost first; empty: nothing is known.
std::vector<Frame> frames_of(const spirv::SourceInfo* sources, std::uint32_t place);

}  // namespace vitrine::glass
