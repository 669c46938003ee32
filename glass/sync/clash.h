// Two accesses that clash, as findings tell of them.
#pragma once

#include "glass/sync/records.h"

namespace vitrine::glass::sync {

struct Told {
  const Past& earlier;
  const Past& later;
  Standing standing{};
  Range bytes;  ///< that both touch
};

/// The same for all clashes of two places in the same way.
std::string key_of(const Told& told);
Finding finding_of(const Told& told);

}  // namespace vitrine::glass::sync
