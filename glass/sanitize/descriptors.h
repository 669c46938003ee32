// Descriptors as findings tell of them.
#pragma once

#include <string>

#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {

/// What is bound: "storage image 'heights' (set 0, binding 2, 64 x 64)"; else `otherwise`.
inline std::string resource_text(const spirv::ObservedCommand* command, std::uint32_t set, std::uint32_t slot,
                                 std::string otherwise) {
  std::string text = command ? command->resource(set, slot) : std::string();
  return text.empty() ? otherwise : text;
}

inline std::string resource_text(const spirv::Wave& wave, std::uint32_t set, std::uint32_t slot,
                                 std::string otherwise) {
  return resource_text(wave.resources->command, set, slot, std::move(otherwise));
}

/// `lanes` use array element `element` of a binding with `count` descriptors, which leads nowhere.
inline void report_descriptor(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                              const spirv::InstructionNote& note, std::uint32_t set, std::uint32_t slot,
                              std::uint32_t element, std::uint32_t count, base::LaneMask lanes) {
  if (set == spirv::ir::kAnySet) return;
  if (element != 0 && element >= count)
    return reporter.report(wave, i, note, "out-of-range-descriptor", lanes, [&](std::size_t) {
      return "descriptor " + std::to_string(element) + " of an array of " + std::to_string(count);
    });
  const spirv::ObservedCommand* command = wave.resources->command;
  if (command != nullptr && !command->departed(set, slot + element).empty())
    return reporter.report(wave, i, note, "destroyed-descriptor", lanes, [&](std::size_t) {
      return "use of " + resource_text(wave, set, slot + element, "a descriptor");
    });
  if (command == nullptr || command->null_descriptors) return;
  reporter.report(wave, i, note, "unwritten-descriptor", lanes, [&](std::size_t) {
    return "use of " + resource_text(wave, set, slot + element, "a descriptor") + ", to which nothing has been written";
  });
}

}  // namespace vitrine::glass::sanitize
