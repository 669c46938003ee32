// See frame.h.
#include "glass/debug/frame.h"

#include <algorithm>

namespace vitrine::glass::debug {
namespace {

constexpr std::size_t kMostFrames = 1000;

/// A block without a name of its own: its members are visible as variables.
bool is_anonymous(const spirv::SourceVariable& variable) { return variable.name.starts_with('%'); }

}  // namespace

std::vector<CodeFrame> frames_at(const Run& run, std::size_t lane) {
  std::vector<CodeFrame> frames;
  if (run.at(lane) == kNoProbe) return frames;
  const spirv::SourceInfo& sources = *run.subject->context.sources;
  std::uint32_t place = run.subject->probes[run.at(lane)].place;
  while (place != 0 && frames.size() < kMostFrames) {
    CodeFrame frame;
    frame.place = sources.place(place);
    const spirv::SourceScope& scope = sources.scopes[frame.place.scope];
    frame.function = sources.functions[scope.function].name;
    if (frame.function.empty()) frame.function = run.subject->context.entry_point;
    frame.file = sources.files[frame.place.file].name;
    frames.push_back(std::move(frame));
    place = scope.call;
  }
  return frames;
}

std::string to_text(const CodeFrame& frame) {
  return frame.function + " at " + (frame.file.empty() ? "?" : frame.file) + ":" + std::to_string(frame.place.line);
}

std::string line_text(const spirv::SourceInfo& sources, std::uint32_t file, std::uint32_t line) {
  const std::string& text = sources.files[file].text;
  std::size_t begin = 0;
  for (std::uint32_t i = 1; i < line; ++i) {
    begin = text.find('\n', begin);
    if (begin == std::string::npos) return {};
    ++begin;
  }
  return line == 0 ? std::string() : text.substr(begin, text.find('\n', begin) - begin);
}

std::string invocation_text(const Run& run, std::size_t lane) {
  const auto& id = run.id[lane];
  const std::string x = std::to_string(id[0]), y = std::to_string(id[1]), z = std::to_string(id[2]);
  switch (run.subject->context.stage) {
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return "invocation (" + x + ", " + y + ", " + z + ")";
    case VK_SHADER_STAGE_VERTEX_BIT:
      return "vertex " + x + " of instance " + y;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return "pixel (" + x + ", " + y + ")";
    default:
      return "invocation " + std::to_string(lane) + " of a wave";
  }
}

bool FrameNames::is_local(const spirv::SourceVariable& variable) const {
  if (variable.scope == 0 || frame_ == nullptr) return false;
  const auto& scopes = run_.subject->context.sources->scopes;
  const spirv::SourceScope &a = scopes[variable.scope], &b = scopes[frame_->place.scope];
  return a.function == b.function && a.call == b.call;
}

/// Of several with one name the one that was declared last in front of the line.
std::optional<Place> FrameNames::find(std::string_view name) const {
  const spirv::SourceVariable* best = nullptr;
  const auto rank = [&](const spirv::SourceVariable& variable) {
    if (!is_local(variable)) return std::uint32_t{0};
    return variable.line > frame_->place.line ? 1 : variable.line + 2;
  };
  for (const spirv::SourceVariable& variable : run_.subject->variables->variables) {
    if (variable.name != name || (variable.scope != 0 && !is_local(variable))) continue;
    if (best == nullptr || rank(variable) > rank(*best)) best = &variable;
  }
  if (best != nullptr) return place_of(*best);
  const spirv::SourceVariables& tables = *run_.subject->variables;
  for (const spirv::SourceVariable& variable : tables.variables) {
    if (!is_anonymous(variable) || variable.descriptors != 0) continue;
    const auto& members = tables.types[variable.type].members;
    for (std::uint32_t i = 0; i < members.size(); ++i)
      if (members[i].name == name) return member_of(tables, place_of(variable), i);
  }
  return std::nullopt;
}

std::vector<const spirv::SourceVariable*> FrameNames::locals() const {
  std::vector<const spirv::SourceVariable*> result;
  for (const spirv::SourceVariable& variable : run_.subject->variables->variables) {
    if (!is_local(variable)) continue;
    const std::optional<Place> seen = find(variable.name);
    if (seen && seen->variable == &variable) result.push_back(&variable);
  }
  std::ranges::stable_sort(result, {}, [](const spirv::SourceVariable* variable) { return variable->line; });
  return result;
}

std::vector<const spirv::SourceVariable*> FrameNames::globals() const {
  std::vector<const spirv::SourceVariable*> result;
  for (const spirv::SourceVariable& variable : run_.subject->variables->variables)
    if (variable.scope == 0) result.push_back(&variable);
  return result;
}

}  // namespace vitrine::glass::debug
