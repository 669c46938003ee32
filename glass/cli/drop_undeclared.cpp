// Descriptors that no stage declares: taken out of a bug for those who name every one. What is declared is read off the
// decorations of SPIR-V (SPIR-V 3.20), without a look at who uses it.
#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "glass/cli/reduce_steps.h"

namespace vitrine::glass::cli {
namespace {

constexpr std::uint32_t kOpDecorate = 71, kBinding = 33, kDescriptorSet = 34;
constexpr std::size_t kHeaderWords = 5;

using Places = std::set<std::pair<std::uint32_t, std::uint32_t>>;  ///< set, binding

void add_declared(const bug::Stage& stage, Places& places) {
  std::vector<std::uint32_t> words(bug::size_of(stage.words) / 4);
  if (words.empty()) return;
  std::memcpy(words.data(), stage.words->data(), words.size() * 4);
  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> of_ids;
  for (std::size_t at = kHeaderWords; at < words.size();) {
    const std::size_t length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) break;
    const std::span instruction(&words[at], length);
    if ((instruction[0] & 0xffff) == kOpDecorate && length == 4) {
      if (instruction[2] == kDescriptorSet) of_ids[instruction[1]].first = instruction[3];
      if (instruction[2] == kBinding) of_ids[instruction[1]].second = instruction[3];
    }
    at += length;
  }
  for (const auto& [id, place] : of_ids) places.insert(place);
}

}  // namespace

void drop_undeclared(bug::Bug& bug) {
  Places declared;
  for (const bug::Stage& stage : bug.stages) add_declared(stage, declared);
  std::erase_if(bug.descriptors, [&](const bug::Descriptor& d) { return !declared.contains({d.set, d.binding}); });
  drop_unused(bug);
}

}  // namespace vitrine::glass::cli
