// The benchmark of a corpus: modules of others on random resources, on this device and on lavapipe side by side, each
// in a process of its own, so that a crash or a hang of a driver ends no run.
#pragma once

#include <string>

namespace vitrine::bench {

struct CorpusOptions {
  std::string folder;       ///< every .spv file below it
  std::string manifest;     ///< of this device
  unsigned every = 1;       ///< takes one module of so many
  int rounds = 3;           ///< per module, the devices alternately
  unsigned timeout_s = 60;  ///< per module
};

/// Prints the table; the exit status of the process: 1 where outputs differ.
int run_corpus(const CorpusOptions& options);

/// The child: prints what `parse_module_times` reads.
int run_corpus_module(const std::string& path, const std::string& manifest, int rounds);

}  // namespace vitrine::bench
