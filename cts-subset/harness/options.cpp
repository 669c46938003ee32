// Command line of the suite.
#include "harness/options.h"

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "harness/execute.h"

namespace vitrine::cts {
namespace {

Options g_options;

constexpr char kUsage[] =
    "cts_subset [GoogleTest flags] [options]\n"
    "  --icd=FILE        manifest of the device under test (or CTS_ICD)\n"
    "  --reference=FILE  manifest of the reference, which is loaded whatever its version (CTS_REFERENCE_ICD: if it "
    "has\n"
    "                    the recorded version)\n"
    "  --recorded[=FILE] take the recorded reference instead, as without --reference where another version is there\n"
    "  --record[=FILE]   write the reference's results; with a filter, those of these cases into the file\n"
    "  --which-reference print which one is taken\n"
    "  --known=FILE      known differences (a name and its reason per line): told, but no failure of the run\n"
    "  --findings=FILE   what the tools that VITRINE_TOOLS names may find (cases, a rule and the reason per line): any "
    "other\n"
    "                    fault that they find fails the case\n"
    "  --results=DIR     where pictures of differing cases go\n"
    "  --pictures        write pictures of every case\n"
    "  --fingerprints=FILE  compare nothing: append each case's name and a hash of the device's bytes\n"
    "  --seed=N          seed of every random case (default 1)\n"
    "  --count=N         cases per random generator; those that draw nothing go on with other seeds\n"
    "  --at-most=N       no more than N cases per random generator, each as in the default run\n"
    "  --validation=0|1  validation layer (default 1)\n"
    "  --mutate          fuzz: every shader of a case is changed at random, into one that is still valid\n"
    "  --isolate         run cases in child processes; a crash is counted and the rest goes on\n"
    "  --jobs=N          child processes at a time\n"
    "  CTS_MODULES=DIR   (environment) group modules: every .spv file below the folder, run on random resources\n"
    "  --self-test       cases that must fail, to test the suite itself\n"
    "  --timeout=S       a case running longer than this counts as crashed\n";

std::string from_environment(const char* name, const char* fallback) {
  const char* value = std::getenv(name);
  return value && *value ? value : fallback;
}

}  // namespace

const Options& options() { return g_options; }
void set_options(Options value) { g_options = std::move(value); }

Options parse_options(int argc, char** argv) {
  Options result;
  result.icd = from_environment("CTS_ICD", CTS_DEFAULT_ICD);
  result.reference_icd = from_environment("CTS_REFERENCE_ICD", CTS_LAVAPIPE_ICD);
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const size_t equals = argument.find('=');
    const std::string_view name = argument.substr(0, equals);
    const std::string value(equals == std::string_view::npos ? "" : argument.substr(equals + 1));
    const auto number = [&] { return std::strtoull(value.c_str(), nullptr, 0); };
    const auto small = [&] { return static_cast<uint32_t>(number()); };
    if (name == "--known")
      result.known = value;
    else if (name == "--icd")
      result.icd = value;
    else if (name == "--reference")
      result.reference_icd = value, result.reference_is_given = true;
    else if (name == "--recorded")
      result.recorded = value.empty() ? default_record() : value;
    else if (name == "--record")
      result.record = value.empty() ? default_record() : value;
    else if (name == "--which-reference")
      result.which_reference = true;
    else if (name == "--findings")
      result.findings = value;
    else if (name == "--results")
      result.results = value;
    else if (name == "--pictures")
      result.pictures = true;
    else if (name == "--fingerprints")
      result.fingerprints = value;
    else if (name == "--seed")
      result.seed = number();
    else if (name == "--count")
      result.count = small();
    else if (name == "--at-most")
      result.at_most = small();
    else if (name == "--validation")
      result.validation = number() != 0;
    else if (name == "--mutate")
      result.mutate = true;
    else if (name == "--isolate")
      result.isolate = true;
    else if (name == "--self-test")
      result.self_test = true;
    else if (name == "--jobs")
      result.jobs = small() ? small() : 1;
    else if (name == "--timeout")
      result.timeout_s = small();
    else if (name == "--child-first")
      result.first = small();
    else if (name == "--child-stride")
      result.stride = small() ? small() : 1;
    else if (name == "--child-progress")
      result.progress = value;
    else {
      std::fputs(kUsage, stderr);
      std::exit(2);
    }
  }
  return result;
}

const char* default_record() { return CTS_DEFAULT_RECORD; }

void prepare_reference() {
  unsetenv("VK_ICD_FILENAMES");
  unsetenv("VK_INSTANCE_LAYERS");
  setenv("VK_LOADER_LAYERS_DISABLE", "~implicit~", 1);
  // The reference's 8-bit shortcut for BGRA8 targets makes pixels depend on their neighbours (deviations.md).
  setenv("LP_PERF", "no_rast_linear", 1);
  // Its rasterizer threads keep denormals on for good after a store to a half-float target skips a masked-out block, so
  // later shaders depend on earlier work. Without threads of its own it sets the mode anew for every render pass.
  setenv("LP_NUM_THREADS", "0", 1);
}

void prepare_environment(const Options& options) {
  std::string files = options.icd;
  if (options.recorded.empty() && options.reference_icd != options.icd) files += ":" + options.reference_icd;
  setenv("VK_DRIVER_FILES", files.c_str(), 1);
  // Mutation makes loops without an end; the reference leaves them after 65,535 rounds.
  if (options.mutate) setenv("VITRINE_SHADER_BUDGET", "1000000", 0);
  const CpuSettings settings = cpu_settings();
  // It encodes sRGB with RSQRTPS, whose bits are the CPU vendor's; this device has one vendor's in a table.
  if (settings.own_rsqrt) setenv("VITRINE_RSQRT", "cpu", 0);
  // Without AVX-512 it converts floats to unsigned integers and selects operands otherwise.
  if (settings.avx2) setenv("VITRINE_REFERENCE_CPU", "avx2", 0);
}

}  // namespace vitrine::cts
