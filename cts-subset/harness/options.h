// What the command line and the environment ask of one run of the suite.
#pragma once

#include <cstdint>
#include <string>

namespace vitrine::cts {

struct Options {
  std::string icd;                  ///< manifest of the device under test
  std::string reference_icd;        ///< manifest of the reference
  bool reference_is_given = false;  ///< by the command line: it is loaded, whatever its version
  std::string recorded;  ///< file of the recorded reference, which is taken instead; empty: the reference itself
  std::string record;    ///< file that receives the reference's results
  bool which_reference = false;  ///< only tell which one would be taken
  std::string known;             ///< list of known differences: these fail no run
  std::string findings;          ///< list of what tools may find, where they are on; empty: anything
  std::string results = "cts-results";
  std::string fingerprints;  ///< file that receives the name and a hash of every case instead of a comparison
  uint64_t seed = 1;
  uint32_t count = 0;             ///< cases per random generator; 0 = each generator's default
  uint32_t at_most = UINT32_MAX;  ///< cases per random generator, if count is 0
  bool validation = true;         ///< VK_LAYER_KHRONOS_validation on both devices
  bool pictures = false;          ///< of every case, not only of those that differ
  bool mutate = false;            ///< shaders of the cases are changed at random
  bool isolate = false;           ///< run cases in child processes and survive crashes
  bool self_test = false;         ///< only the cases that must fail
  uint32_t jobs = 1;              ///< child processes at a time (with isolate)
  uint32_t timeout_s = 120;       ///< a case running longer counts as crashed (with isolate)
  uint32_t first = 0;             ///< child: index of the first case to run
  uint32_t stride = 1;            ///< child: distance between its cases
  std::string progress;           ///< child: file that receives one line per case begun and ended
};

/// Parses what GoogleTest left of argv. Prints usage and exits for an unknown argument.
Options parse_options(int argc, char** argv);

/// The options of this process.
const Options& options();
void set_options(Options value);

/// Where the recorded reference stands in the tree.
const char* default_record();
/// How the reference is run. Call before it is loaded for the first time.
void prepare_reference();
/// Points the loader at the drivers and lets this device follow the reference's CPU. Call before gpus().
void prepare_environment(const Options& options);

}  // namespace vitrine::cts
