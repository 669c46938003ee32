// See inputs.h.
#include "glass/pixel/inputs.h"

#include <algorithm>
#include <bit>
#include <cstdio>

#include "glass/pixel/history.h"
#include "spirv/source_info.h"
#include "spirv/source_variables.h"

namespace vitrine::glass::pixel {
namespace {

using spirv::BuiltIn;
using spirv::InputPart;
using spirv::InterfaceSlot;
using spirv::SourceInput;
using Kind = spirv::SourceType::Kind;
using ReadWord = std::function<std::optional<std::uint32_t>(std::uint32_t)>;

/// As SPIR-V calls those of fragment shaders.
constexpr std::pair<BuiltIn, const char*> kBuiltIns[] = {
    {BuiltIn::kFragCoord, "FragCoord"},
    {BuiltIn::kFrontFacing, "FrontFacing"},
    {BuiltIn::kPointCoord, "PointCoord"},
    {BuiltIn::kBaryCoord, "BaryCoordKHR"},
    {BuiltIn::kBaryCoordNoPersp, "BaryCoordNoPerspKHR"},
    {BuiltIn::kSampleId, "SampleId"},
    {BuiltIn::kSamplePosition, "SamplePosition"},
    {BuiltIn::kSampleMask, "SampleMask"},
    {BuiltIn::kPrimitiveId, "PrimitiveId"},
    {BuiltIn::kLayer, "Layer"},
    {BuiltIn::kViewportIndex, "ViewportIndex"},
    {BuiltIn::kViewIndex, "ViewIndex"},
    {BuiltIn::kClipDistance, "ClipDistance"},
    {BuiltIn::kCullDistance, "CullDistance"},
};

std::string name_of(const SourceInput& input) {
  if (!input.name.empty()) return input.name;
  for (const auto& [built_in, name] : kBuiltIns)
    if (built_in == input.built_in) return name;
  std::string name = "location=" + std::to_string(input.location);
  if (input.component != 0) name += " component=" + std::to_string(input.component);
  if (spirv::is_of_vertex(input.part))
    name += " vertex=" + std::to_string(static_cast<unsigned>(input.part) - static_cast<unsigned>(InputPart::kVertex0));
  return name;
}

/// Of a shader whose module says nothing: each location is an input.
std::vector<SourceInput> inputs_of(const spirv::ShaderInterface& interface) {
  std::vector<SourceInput> inputs;
  for (const InterfaceSlot& slot : interface.inputs) {
    if (slot.built_in != BuiltIn::kNone || slot.part != InputPart::kValue || slot.implied) continue;
    if (std::ranges::find(inputs, slot.location, &SourceInput::location) != inputs.end()) continue;
    SourceInput input;
    input.location = slot.location;
    input.words = 4;
    input.kind = slot.type == spirv::BaseType::kFloat ? Kind::kFloat
                 : slot.type == spirv::BaseType::kInt ? Kind::kInt
                                                      : Kind::kUint;
    inputs.push_back(std::move(input));
  }
  return inputs;
}

/// The register that holds a word of an input. Null: the shader does not read it.
const InterfaceSlot* slot_of(const spirv::ShaderInterface& interface, const SourceInput& input, std::uint32_t word) {
  const std::uint32_t component = input.component + word;
  const bool numbered = input.built_in == BuiltIn::kNone;
  for (const InterfaceSlot& slot : interface.inputs) {
    if (slot.built_in != input.built_in || slot.part != input.part || slot.implied) continue;
    if (slot.component != (numbered ? component % 4 : component)) continue;
    if (!numbered || slot.location == input.location + component / 4) return &slot;
  }
  return nullptr;
}

std::string wide_number(std::uint64_t bits, Kind kind) {
  if (kind == Kind::kInt) return std::to_string(static_cast<std::int64_t>(bits));
  if (kind == Kind::kUint) return std::to_string(bits);
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", std::bit_cast<double>(bits));
  return text;
}

std::string number(std::uint32_t bits, Kind kind) {
  if (kind == Kind::kBool) return bits != 0 ? "true" : "false";
  return component_text(bits, kind == Kind::kFloat ? texel::Kind::kFloat
                              : kind == Kind::kInt ? texel::Kind::kSint
                                                   : texel::Kind::kUint);
}

/// The components that the shader reads and that are known, and which these are. Empty: none.
std::pair<std::string, std::string> numbers_of(const spirv::ShaderInterface& interface, const SourceInput& input,
                                               const ReadWord& word) {
  std::string numbers, letters;
  const std::uint32_t words = input.wide ? 2 : 1;
  for (std::uint32_t i = 0; i < input.words / words; ++i) {
    std::optional<std::uint32_t> parts[2];
    for (std::uint32_t part = 0; part < words; ++part)
      if (const InterfaceSlot* slot = slot_of(interface, input, i * words + part)) parts[part] = word(slot->reg);
    if (!parts[0] && !parts[words - 1]) continue;
    numbers += numbers.empty() ? "" : ", ";
    numbers += input.wide ? wide_number(parts[0].value_or(0) | std::uint64_t{parts[1].value_or(0)} << 32, input.kind)
                          : number(*parts[0], input.kind);
    letters += "xyzw"[i % 4];
  }
  return {numbers, std::string_view("xyzw").starts_with(letters) ? "" : "." + letters};
}

}  // namespace

std::vector<std::pair<std::string, std::string>> inputs_text(const spirv::ShaderInterface& interface,
                                                             const spirv::Program& program, const ReadWord& word) {
  const bool named = program.sources && program.sources->variables && !program.sources->variables->inputs.empty();
  std::vector<SourceInput> inputs = named ? program.sources->variables->inputs : inputs_of(interface);
  std::ranges::stable_sort(inputs, {}, [](const SourceInput& input) {
    return std::tuple(input.built_in != BuiltIn::kNone, input.location, input.part, input.component);
  });
  std::vector<std::pair<std::string, std::string>> texts;
  for (const SourceInput& input : inputs) {
    const auto [numbers, letters] = numbers_of(interface, input, word);
    if (!numbers.empty()) texts.emplace_back("input " + name_of(input) + letters, "(" + numbers + ")");
  }
  return texts;
}

}  // namespace vitrine::glass::pixel
