// The one command of a bug file.
#pragma once

#include "glass/replayer/pipeline.h"

namespace vitrine::glass::replayer {

/// Runs it, and waits until it is done.
void run(const Device& device, const bug::Bug& bug, const Resources& resources, const Bound& bound);

}  // namespace vitrine::glass::replayer
