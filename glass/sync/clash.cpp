// See clash.h.
#include "glass/sync/clash.h"

namespace vitrine::glass::sync {
namespace {

bool is_transition(const Past& past) { return past.use.stage == Stage::kTransition; }
bool is_host(const Past& past) { return past.use.stage == Stage::kHost; }
bool is_write(const Past& past) { return writes(past.use.access); }

const char* rule_of(const Told& told) {
  if (is_host(told.later)) return "sync-host";
  if (is_transition(told.earlier) || is_transition(told.later)) return "sync-layout";
  if (!is_write(told.earlier)) return "sync-write-after-read";
  return is_write(told.later) ? "sync-write-after-write" : "sync-read-after-write";
}

std::string place_text(const Address& address) {
  if (!address.frames.empty()) return " at " + to_text(address.frames[0]);
  return address.spirv_id != 0 ? " (SPIR-V id " + std::to_string(address.spirv_id) + ")" : std::string();
}

/// " by vkCmdCopyBuffer (submission 1, command 2)".
std::string command_text(const Address& address) {
  std::string text = " by ";
  text.append(address.command_name).append(" (submission ").append(std::to_string(address.submission));
  return text.append(", command ").append(std::to_string(address.command)).append(")");
}

std::string bytes_text(const Told& told) {
  const std::uintptr_t base = told.later.who_at(told.bytes.first).base;
  if (base == 0 || told.bytes.first < base) return {};
  const std::uint64_t size = told.bytes.end - told.bytes.first;
  return " (bytes " + std::to_string(told.bytes.first - base) + " to " +
         std::to_string(told.bytes.first - base + size - 1) + ")";
}

std::string reason_of(const Told& told) {
  if (is_host(told.later)) {
    if (told.standing == Standing::kUnordered) return ": the host has not waited for it";
    return ": the host has waited for it, but no barrier made it visible to VK_ACCESS_2_HOST_READ_BIT";
  }
  switch (told.standing) {
    case Standing::kUnordered:
      return ": nothing orders them";
    case Standing::kNotAvailable:
      return ", which is ordered before it but not made available: no barrier has " +
             access_text(told.earlier.use.access) + " in its first scope";
    default:
      return ", which is ordered before it and available but not made visible: no barrier has " +
             access_text(told.later.use.access) + " of " + stage_text(told.later.use.stage) + " in its second scope";
  }
}

/// A line of a structure.
std::string field(const char* side, const char* what, const std::string& value) {
  return std::string("        .").append(side).append(what).append(" = ").append(value).append(",\n");
}

/// What one side of the missing barrier says, as lines of a structure.
std::string side_text(const char* side, const Past& past, bool accesses) {
  return field(side, "StageMask", stage_text(past.use.stage)) +
         field(side, "AccessMask", accesses ? access_text(past.use.access) : "VK_ACCESS_2_NONE");
}

/// What the barrier or subpass dependency of a transition lacks.
std::string transition_text(const char* side, const Past& past, bool accesses) {
  return "in the barrier or subpass dependency that has the transition\n" + side_text(side, past, accesses);
}

bool reads_input(const Past& past) { return past.use.access == Access::kInputAttachmentRead; }

std::string remedy_of(const Told& told) {
  const bool memory = is_write(told.earlier);
  if (is_host(told.later) && told.standing == Standing::kUnordered)
    return "a wait of the host between them: vkWaitForFences, vkWaitSemaphores or vkQueueWaitIdle";
  if (is_transition(told.later)) return transition_text("src", told.earlier, memory);
  if (is_transition(told.earlier)) return transition_text("dst", told.later, true);
  return "a barrier between them\n"
         "    const VkMemoryBarrier2 barrier = {\n"
         "        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,\n" +
         side_text("src", told.earlier, memory) + side_text("dst", told.later, memory) +
         "    };\n"
         "    const VkDependencyInfo info = {\n"
         "        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,\n" +
         // "dependencyFlags must include VK_DEPENDENCY_BY_REGION_BIT" within a render pass instance.
         std::string(reads_input(told.later) ? "        .dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT,\n" : "") +
         "        .memoryBarrierCount = 1,\n"
         "        .pMemoryBarriers = &barrier,\n"
         "    };\n"
         "    vkCmdPipelineBarrier2(commands, &info);";
}

}  // namespace

std::string key_of(const Told& told) {
  const std::uintptr_t at = told.bytes.first;
  return std::string(rule_of(told)) + '\n' + told.later.who_at(at).place + '\n' + told.earlier.who_at(at).place + '\n' +
         std::to_string(static_cast<int>(told.standing)) + std::to_string(static_cast<int>(told.later.use.access)) +
         '\n' + std::to_string(static_cast<int>(told.earlier.use.access));
}

Finding finding_of(const Told& told) {
  Finding finding;
  const Who &earlier = told.earlier.who_at(told.bytes.first), &later = told.later.who_at(told.bytes.first);
  finding.rule = &rule(rule_of(told));
  finding.address = later.address;
  finding.message = later.what;
  if (!later.resource.empty()) finding.message += " of " + later.resource;
  finding.message += bytes_text(told);
  finding.message += " comes behind the " + earlier.what + place_text(earlier.address);
  finding.message += command_text(earlier.address) + reason_of(told);
  finding.remedy = remedy_of(told);
  if (finding.remedy.ends_with('\n')) finding.remedy.pop_back();
  finding.related.push_back({earlier.what + command_text(earlier.address), earlier.address});
  return finding;
}

}  // namespace vitrine::glass::sync
