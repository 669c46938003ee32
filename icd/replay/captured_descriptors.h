// The sets that a command sees and what is bound in them, for a bug file.
#pragma once

#include "icd/replay/captured_objects.h"

namespace vitrine::icd {

/// As the pipeline's layout has them: pushed sets become sets as others, a variable number of descriptors what it is.
/// The bug has its stages already.
void add_descriptors(const BindPoint& point, CapturedObjects& objects, glass::bug::Bug& bug);

}  // namespace vitrine::icd
