// See place.h.
#include "glass/place.h"

#include <algorithm>
#include <string_view>

namespace vitrine::glass {
namespace {

/// Calls of calls that are followed: debug information may lie.
constexpr std::size_t kMaxFrames = 64;

template <class T>
const T& at(const std::vector<T>& table, std::uint32_t number) {
  return table[number < table.size() ? number : 0];
}

std::string line_of(std::string_view text, std::uint32_t number) {
  for (std::uint32_t line = 1; number != 0 && !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    // Sources written on Windows end their lines with two characters.
    if (line == number) return std::string(text.substr(0, end - (end != 0 && text[end - 1] == '\r')));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

Invocation::Kind kind_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return Invocation::Kind::kVertex;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return Invocation::Kind::kFragment;
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return Invocation::Kind::kCompute;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return Invocation::Kind::kControl;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return Invocation::Kind::kEvaluation;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return Invocation::Kind::kGeometry;
    default:
      return Invocation::Kind::kNone;
  }
}

}  // namespace

Address ShaderContext::address(const spirv::ObservedCommand* command, const std::array<std::uint32_t, 3>& id,
                               std::uint32_t spirv_id, std::uint32_t place) const {
  Address address;
  if (command != nullptr) {
    address.submission = command->submission;
    address.command = command->command;
    address.command_name = command->name;
    address.labels = command->labels;
    address.pipeline = command->pipeline;
  }
  address.shader = entry_point;
  address.stage = stage;
  address.invocation = {kind_of(stage), id};
  address.spirv_id = spirv_id;
  address.frames = frames_of(sources.get(), place);
  return address;
}

std::vector<Frame> frames_of(const spirv::SourceInfo* sources, std::uint32_t place) {
  std::vector<Frame> frames;
  while (sources != nullptr && place != 0 && frames.size() < kMaxFrames) {
    const spirv::SourcePlace& here = sources->place(place);
    const spirv::SourceScope& scope = at(sources->scopes, here.scope);
    const spirv::SourceFile& file = at(sources->files, here.file);
    frames.push_back({at(sources->functions, scope.function).name, file.name, here.line, here.column,
                      line_of(file.text, here.line)});
    place = scope.call;
  }
  return frames;
}

}  // namespace vitrine::glass
