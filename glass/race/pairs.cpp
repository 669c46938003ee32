// See pairs.h.
#include "glass/race/pairs.h"

#include <algorithm>

#include "glass/race/remedy.h"
#include "glass/sanitize/descriptors.h"

namespace vitrine::glass::race {
namespace {

const char* rule_of(const Conflict& conflict) {
  if (conflict.kind == Conflict::Kind::kScope) return "race-scope";
  if (conflict.kind == Conflict::Kind::kVisibility) return "race-visibility";
  switch (conflict.later.what().memory) {
    case Memory::kShared:
      return "race-shared";
    case Memory::kBuffer:
      return "race-buffer";
    default:
      return "race-image";
  }
}

/// As ShaderContext::address() has it.
std::array<std::uint32_t, 3> id_of(const Access& access) {
  if (!access.program->compute()) return {access.who.local & 0xffff, access.who.local >> 16, 0};
  const std::uint32_t* size = access.program->size;
  const std::uint32_t local = access.who.local;
  return {access.who.group[0] * size[0] + local % size[0], access.who.group[1] * size[1] + local / size[0] % size[1],
          access.who.group[2] * size[2] + local / size[0] / size[1]};
}

Address address_of(const Access& access, const spirv::ObservedCommand* command) {
  const Site& site = access.what();
  return access.program->context.address(command, id_of(access), site.origin.spirv_id, site.origin.place);
}

std::string place_text(const Address& address) {
  if (address.frames.empty())
    return address.spirv_id != 0 ? " (SPIR-V id " + std::to_string(address.spirv_id) + ")" : std::string();
  return " at " + to_text(address.frames[0]);
}

std::string memory_text(const Conflict& conflict, const spirv::ObservedCommand* command) {
  const Site& site = conflict.later.what();
  if (site.memory == Memory::kShared) return " at offset " + std::to_string(conflict.address) + " of shared memory";
  if (site.set == spirv::ir::kAnySet) return {};
  const std::string name = sanitize::resource_text(command, site.set, site.slot, {});
  return name.empty() ? std::string() : " of " + name;
}

Finding finding_of(const Conflict& conflict, const spirv::ObservedCommand* command) {
  Finding finding;
  finding.rule = &rule(rule_of(conflict));
  finding.address = address_of(conflict.later, command);
  const Address other = address_of(conflict.earlier, command);
  const std::string what = what_text(conflict.earlier.what());
  finding.message = what_text(conflict.later.what()) + memory_text(conflict, command);
  finding.message += conflict.kind == Conflict::Kind::kVisibility ? " comes behind the " : " races with the ";
  finding.message += what + place_text(other) + " by " + to_text(other.invocation);
  finding.message += reason_of(conflict);
  finding.remedy = remedy_of(conflict);
  finding.related.push_back({what, other});
  return finding;
}

}  // namespace

void Pairs::add(const Conflict& conflict, const spirv::ObservedCommand* command) {
  const auto side = [](const Access& access) { return std::pair(access.program, access.what().place); };
  auto [a, b] = std::pair(side(conflict.earlier), side(conflict.later));
  if (b < a) std::swap(a, b);
  const Key key{static_cast<int>(conflict.kind), a.first, a.second, b.first, b.second};
  const First first{command ? command->submission : 0, command ? command->command : 0, conflict.later.who,
                    conflict.earlier.who, conflict.address};
  const std::lock_guard lock(mutex_);
  const auto [at, added] = entries_.try_emplace(key);
  Entry& entry = at->second;
  ++entry.count;
  entry.all_equal &= conflict.equal;
  if (!added && (entry.delivered || entry.first <= first)) return;
  entry.first = first;
  entry.finding = finding_of(conflict, command);
}

std::vector<Finding> Pairs::take() {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<First, Finding>> found;
  for (auto& [key, entry] : entries_) {
    if (std::exchange(entry.delivered, true)) continue;
    entry.finding.count = entry.count;
    if (entry.all_equal) entry.finding.message += "; both write the same value, which is a race all the same";
    found.emplace_back(entry.first, std::move(entry.finding));
  }
  const auto key = [](const std::pair<First, Finding>& one) {
    const Address& address = one.second.address;
    return std::tuple(one.first, address.stage, address.spirv_id, one.second.message);
  };
  std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<Finding> findings;
  for (auto& [first, finding] : found) findings.push_back(std::move(finding));
  return findings;
}

bool Pairs::empty() {
  const std::lock_guard lock(mutex_);
  return entries_.empty();
}

}  // namespace vitrine::glass::race
