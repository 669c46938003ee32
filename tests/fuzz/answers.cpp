// What the front end and SPIRV-Tools' validator say to the same modules. usage: vitrine_answers FILE.spv...
// Counts the answers, and per message where they differ: what the front end runs although the validator calls it
// invalid, and what it refuses although that calls it valid. The latter must be claims that the device does not make.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <spirv/unified1/spirv.hpp11>

#include "spirv/compile.h"
#include "spirv/diagnosis.h"
#include "tests/fuzz/mutate.h"

namespace vitrine::fuzz {
namespace {

Words read_words(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  Words words(bytes.size() / 4);
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 4);
  return words;
}

/// Calls f(opcode, words of the instruction).
template <class F>
void each_instruction(const Words& words, const F& f) {
  for (std::size_t at = 5; at < words.size();) {
    const std::uint32_t length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) return;
    f(static_cast<spv::Op>(words[at] & spv::OpCodeMask), std::span(words).subspan(at, length));
    at += length;
  }
}

/// A pipeline layout with everything that the module names.
std::vector<spirv::SetLayoutInfo> layout_of(const Words& words) {
  constexpr std::uint32_t kSets = 8, kElements = 64;
  std::map<std::uint32_t, std::uint32_t> sets, bindings;  // by id
  each_instruction(words, [&](spv::Op op, std::span<const std::uint32_t> inst) {
    if (op != spv::Op::OpDecorate || inst.size() != 4) return;
    if (inst[2] == static_cast<std::uint32_t>(spv::Decoration::DescriptorSet)) sets[inst[1]] = inst[3];
    if (inst[2] == static_cast<std::uint32_t>(spv::Decoration::Binding)) bindings[inst[1]] = inst[3];
  });
  std::vector<spirv::SetLayoutInfo> layout(kSets);
  for (const auto& [id, binding] : bindings) {
    const std::uint32_t set = sets.contains(id) ? sets[id] : 0;
    if (set >= kSets) continue;
    auto& rows = layout[set].bindings;
    const auto same = [number = binding](const spirv::BindingInfo& row) { return row.binding == number; };
    if (std::any_of(rows.begin(), rows.end(), same)) continue;
    const auto slot = kElements * static_cast<std::uint32_t>(rows.size());
    rows.push_back({binding, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, set, slot, kElements, nullptr});
  }
  return layout;
}

VkShaderStageFlagBits stage_of(std::uint32_t model) {
  constexpr VkShaderStageFlagBits kStages[] = {VK_SHADER_STAGE_VERTEX_BIT,
                                               VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                                               VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
                                               VK_SHADER_STAGE_GEOMETRY_BIT,
                                               VK_SHADER_STAGE_FRAGMENT_BIT,
                                               VK_SHADER_STAGE_COMPUTE_BIT};
  return model < std::size(kStages) ? kStages[model] : VK_SHADER_STAGE_FLAG_BITS_MAX_ENUM;
}

/// Why the front end refuses an entry point of the module; empty: none is refused.
std::string refusal(const Words& words) {
  if (std::string error = spirv::check_module(words); !error.empty()) return error;
  spirv::CompileOptions options;
  options.sets = layout_of(words);
  std::string why;
  each_instruction(words, [&](spv::Op op, std::span<const std::uint32_t> inst) {
    if (op != spv::Op::OpEntryPoint || inst.size() < 4) return;
    options.stage = stage_of(inst[1]);
    const char* name = reinterpret_cast<const char*>(inst.data() + 3);
    options.entry_point.assign(name, strnlen(name, (inst.size() - 3) * 4));
    const auto shader = spirv::compile(words, options);
    if (!shader && why.empty()) why = shader.message();
  });
  return why.substr(0, why.find(" (SPIRV-Tools: "));
}

/// Messages that differ in numbers alone are one.
std::string without_numbers(const std::string& message) {
  std::string result;
  for (const char c : message) {
    const bool digit = c >= '0' && c <= '9';
    if (digit && !result.empty() && result.back() == '#') continue;
    result += digit ? '#' : c;
  }
  return result;
}

struct Answers {
  std::map<std::string, std::pair<std::size_t, std::string>> messages;  ///< how often, a file
  std::size_t count = 0;

  void add(const std::string& message, const char* file) {
    count++;
    auto& [times, example] = messages[without_numbers(message)];
    if (times++ == 0) example = file;
  }
  void print(const char* title) const {
    std::printf("%zu %s\n", count, title);
    for (const auto& [message, row] : messages)
      std::printf("  %zu  %s  [%s]\n", row.first, message.c_str(), row.second.c_str());
  }
};

int main(int count, char** arguments) {
  std::size_t accepted = 0, refused = 0;
  Answers runs, refuses;
  for (int i = 1; i < count; i++) {
    const Words words = read_words(arguments[i]);
    const std::string ours = refusal(words), theirs = spirv::validator_message(words);
    if (!ours.empty() && theirs.empty())
      refuses.add(ours, arguments[i]);
    else if (ours.empty() && !theirs.empty())
      runs.add(theirs, arguments[i]);
    else
      (ours.empty() ? accepted : refused)++;
  }
  std::printf("%zu modules run and are valid, %zu are refused and invalid\n", accepted, refused);
  runs.print("run that the validator calls invalid:");
  refuses.print("are refused that the validator calls valid (or that it was not asked about):");
  return 0;
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) { return vitrine::fuzz::main(count, arguments); }
