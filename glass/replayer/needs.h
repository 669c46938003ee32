// What a bug needs that a driver may lack.
#pragma once

#include "glass/bug/bug.h"

namespace vitrine::glass::replayer {

/// The name of a feature of the core that the bug's state or stages need and `has` lacks, as Vulkan has it; null: none.
/// What shaders declare is the driver's to refuse.
const char* missing_feature(const bug::Bug& bug, const VkPhysicalDeviceFeatures& has);

/// The same of extensions that state and descriptors need: `has(name)` says whether one is there.
template <class F>
const char* missing_extension(const bug::Bug& bug, const F& has);

/// Rows of missing_extension().
struct Need {
  const char* extension;
  bool (*is_there)(const bug::Bug& bug);
  bool of_draws = true;  ///< of dispatches it is not asked
};
extern const Need kNeeds[13];

template <class F>
const char* missing_extension(const bug::Bug& bug, const F& has) {
  for (const Need& need : kNeeds)
    if (!(need.of_draws && bug.dispatches()) && need.is_there(bug) && !has(need.extension)) return need.extension;
  return nullptr;
}

}  // namespace vitrine::glass::replayer
