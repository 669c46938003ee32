// Work items: numbers 0, 1, … given to invocations of some stage.
#pragma once

#include <string>

#include "harness/run.h"

namespace vitrine::cts {

/// A stage that may write memory.
enum class WorkStage { kCompute, kVertex, kFragment };
WorkStage random_work_stage(Run& run);
const char* name_of(WorkStage stage);

/// Calls `void work(int i)` of `code`, which also declares what `resources` has, for i = 0 .. count-1, each once; count
/// at most 4096. Waits.
void run_work_items(Run& run, WorkStage stage, const Resources& resources, const std::string& code, uint32_t count);

}  // namespace vitrine::cts
