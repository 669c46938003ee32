// The suite's entry: registers every case with GoogleTest, runs them, prints the totals per group.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "harness/execute.h"
#include "harness/gpu.h"
#include "harness/options.h"
#include "harness/recorded.h"
#include "harness/reference.h"
#include "harness/report.h"
#include "harness/self_test.h"

namespace vitrine::cts {
namespace {

Counts g_counts;

class CaseTest : public testing::Test {
 public:
  CaseTest(const Case& c, uint32_t index) : case_(c), index_(index) {}

  void TestBody() override {
    tell_parent("B " + std::to_string(index_) + " " + full_name(case_));
    const Judgement judgement = execute(case_);
    count(g_counts, case_.group, judgement);
    tell_parent("E " + std::to_string(static_cast<int>(judgement.verdict)) + " " + (judgement.nan_bits ? "1" : "0") +
                " " + (judgement.blank ? "1" : "0") + " " + judgement.message);
    if (judgement.verdict == Verdict::kUnsupported) GTEST_SKIP() << judgement.message;
    if (is_failure(judgement.verdict))
      ADD_FAILURE() << judgement.message << "  reproduce: " << command_of(full_name(case_));
  }

 private:
  const Case& case_;
  uint32_t index_;
};

/// Expands the generators and registers all cases that this process is responsible for.
void register_cases() {
  static std::vector<Case> all = cases();
  // Mutants differ from the reference in other ways than a deviation's row says.
  if (options().mutate) std::erase_if(all, [](const Case& c) { return !c.deviation.empty(); });
  for (const Generator& generator : generators()) {
    const uint32_t count = options().count ? options().count : std::min(generator.count, options().at_most);
    for (uint32_t i = 0; i < count; ++i)
      all.push_back(
          {generator.group, generator.name + "/" + std::to_string(i), generator.body, {}, {}, i, generator.file});
  }
  // GoogleTest runs group by group: numbers must rise in that order, for a child goes on after the number that crashed.
  std::stable_sort(all.begin(), all.end(), [](const Case& a, const Case& b) { return a.group < b.group; });
  for (uint32_t i = 0; i < all.size(); ++i) {
    if (i < options().first || (i - options().first) % options().stride != 0) continue;
    const Case& c = all[i];
    testing::RegisterTest(c.group.c_str(), c.name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                          [&c, i]() -> CaseTest* { return new CaseTest(c, i); });
  }
}

/// What runs in children compares with the same reference as their parent.
int run_children(std::vector<std::string> command) {
  const Options& chosen = options();
  command.push_back(chosen.recorded.empty() ? "--reference=" + chosen.reference_icd : "--recorded=" + chosen.recorded);
  const int status = run_isolated(command);
  write_recorded_reference();
  return status;
}

int run_here(bool child) {
  std::printf("device: %s\n", gpus().device.name.c_str());
  if (options().validation && !validation_is_on()) std::printf("the validation layer is not installed\n");
  if (!child) print_reference_cpu();
  const int status = RUN_ALL_TESTS();
  if (!child) {
    print_counts(g_counts);
    write_recorded_reference();
  }
  destroy_gpus();
  return status;
}

int run(int argc, char** argv) {
  const std::vector<std::string> command(argv, argv + argc);
  testing::InitGoogleTest(&argc, argv);
  Options parsed = parse_options(argc, argv);
  const bool child = !parsed.progress.empty(), lists = GTEST_FLAG_GET(list_tests);
  const std::string reference = lists ? "" : choose_reference(parsed);
  if (parsed.which_reference) {
    std::printf("%s\n", reference.c_str());
    return 0;
  }
  set_options(parsed);
  if (parsed.self_test) register_self_test();
  if (lists) {
    register_cases();
    return RUN_ALL_TESTS();
  }
  load_recorded_reference();
  prepare_environment(parsed);
  if (child) set_parent(std::atoi(parsed.progress.c_str()));
  std::printf("reference: %s\n", reference.c_str());
  std::fflush(stdout);
  if (parsed.isolate && !child) return run_children(command);
  load_lists();
  register_cases();
  return run_here(child);
}

}  // namespace
}  // namespace vitrine::cts

int main(int argc, char** argv) {
  try {
    return vitrine::cts::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cts_subset: %s\n", error.what());
    return 2;
  }
}
