// Tessellation and geometry shaders among the modules of others, with random resources and inputs; what they give is
// captured.
#pragma once

#include "cases/modules/reflect.h"
#include "harness/run.h"

namespace vitrine::cts {

void run_geometry(Run& run, const Reflection& r, const std::vector<uint32_t>& words);
/// Behind it an evaluation shader that captures what it reads.
void run_control(Run& run, const Reflection& r, const std::vector<uint32_t>& words);
/// Behind a control shader of random outputs.
void run_evaluation(Run& run, const Reflection& r, const std::vector<uint32_t>& words);

}  // namespace vitrine::cts
