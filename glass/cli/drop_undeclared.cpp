// Descriptors that no stage declares: taken out of a bug for those who name every one.
#include "glass/bug/declared.h"
#include "glass/cli/reduce_steps.h"

namespace vitrine::glass::cli {

void drop_undeclared(bug::Bug& bug) {
  const bug::Declared declared = bug::declared_in(bug);
  std::erase_if(bug.descriptors, [&](const bug::Descriptor& d) { return !declared.contains({d.set, d.binding}); });
  drop_unused(bug);
}

}  // namespace vitrine::glass::cli
