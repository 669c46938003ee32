// See inputs.h.
#include "glass/pixel/inputs.h"

#include <algorithm>
#include <array>
#include <map>

#include "glass/pixel/history.h"

namespace vitrine::glass::pixel {

std::vector<std::pair<std::string, std::string>> inputs_text(const spirv::ShaderInterface& interface,
                                                             const std::function<std::uint32_t(std::uint32_t)>& word) {
  std::map<std::uint32_t, std::vector<spirv::InterfaceSlot>> locations;
  for (const spirv::InterfaceSlot& slot : interface.inputs)
    if (slot.built_in == spirv::BuiltIn::kNone && slot.part == spirv::InputPart::kValue && !slot.implied)
      locations[slot.location].push_back(slot);
  std::vector<std::pair<std::string, std::string>> inputs;
  for (auto& [location, slots] : locations) {
    std::ranges::sort(slots, {}, &spirv::InterfaceSlot::component);
    std::array<std::uint32_t, 4> words{};
    std::size_t count = 0;
    std::string letters;
    for (const spirv::InterfaceSlot& slot : slots) {
      if (count == words.size()) break;
      words[count++] = word(slot.reg);
      letters += "xyzw"[slot.component % 4u];
    }
    // Only components that the shader reads are there.
    const bool from_x = std::string_view("xyzw").starts_with(letters);
    const texel::Kind kind = slots[0].type == spirv::BaseType::kFloat ? texel::Kind::kFloat
                             : slots[0].type == spirv::BaseType::kInt ? texel::Kind::kSint
                                                                      : texel::Kind::kUint;
    std::string name = "input " + std::to_string(location);
    if (!from_x) name.append(".").append(letters);
    inputs.emplace_back(std::move(name), to_text(words, count, kind));
  }
  return inputs;
}

}  // namespace vitrine::glass::pixel
