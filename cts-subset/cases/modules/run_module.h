// Runs a module of others on random resources: for the suite's group of modules, and for the benchmark of a corpus.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "harness/run.h"

namespace vitrine::cts {

struct ModuleRun {
  using Record = std::function<void(VkCommandBuffer)>;

  /// Called once all is prepared, with the dispatch or draw.
  std::function<void(Run&, const Record&)> submit = [](Run& run, const Record& record) { run.once(record); };
  uint32_t scale = 1;               ///< its square times as many workgroups, pixels or instances
  bool scaled_stages_only = false;  ///< nothing but compute, fragment and vertex shaders, which know `scale`
};

/// Adds what the shader wrote to the run's outputs. Throws Unsupported for modules that need more than this can give.
void run_module(Run& run, const std::filesystem::path& path, const ModuleRun& how = {});

}  // namespace vitrine::cts
