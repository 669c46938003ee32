// How the command finds its driver, and what becomes of the applications that it runs.
#include "glass/cli/application.h"

#include <gtest/gtest.h>

#include <fstream>

#include "glass/cli/files.h"
#include "glass/cli/install.h"

namespace vitrine::glass::cli {
namespace {

TEST(CliApplication, FindsTheDriverBesideIt) {
  const TemporaryFolder folder;
  for (const std::string& place : {std::string("icd"), std::string("bin"), std::string("bin/") + kDriverFolder}) {
    EXPECT_EQ(driver_manifest(folder.path() / "bin/vitrine"), "");
    const auto manifest = (folder.path() / place / "vitrine_icd.x86_64.json").lexically_normal();
    std::filesystem::create_directories(folder.path() / "bin");
    std::filesystem::create_directories(manifest.parent_path());
    std::ofstream(manifest) << "{}";
    EXPECT_EQ(driver_manifest(folder.path() / "bin/vitrine"), manifest);
    std::filesystem::remove(manifest);
  }
}

TEST(CliApplication, KeepsExitCodes) {
  EXPECT_EQ(run_to_end({"true"}, {}).code, 0);
  EXPECT_EQ(run_to_end({"sh", "-c", "exit 7"}, {}).code, 7);
  const Ending killed = run_to_end({"sh", "-c", "kill -9 $$"}, {});
  EXPECT_EQ(killed.signal, 9);
  EXPECT_EQ(killed.code, 137);
  EXPECT_EQ(run_to_end({"/no/such/program"}, {}).error, "No such file or directory");
}

TEST(CliApplication, AddsToTheEnvironment) {
  setenv("VITRINE_TEST_KEPT", "1", 1);
  setenv("VITRINE_TEST_REPLACED", "1", 1);
  const Environment environment{{"VITRINE_TEST_REPLACED", "2"}, {"VITRINE_TEST_ADDED", "3"}};
  EXPECT_EQ(
      run_to_end({"sh", "-c", "exit $VITRINE_TEST_KEPT$VITRINE_TEST_REPLACED$VITRINE_TEST_ADDED"}, environment).code,
      123);
}

/// The application does what it does at a signal; the command waits for that.
TEST(CliApplication, SignalsGoToIt) {
  EXPECT_EQ(run_to_end({"sh", "-c", "trap 'exit 5' TERM; kill -TERM $PPID; while :; do sleep 0.01; done"}, {}).code, 5);
}

TEST(CliApplication, FilesComeInTheOrderOfProcesses) {
  const TemporaryFolder folder;
  for (const char* const name : {"10.json", "9.json", "100.json", "9.info"})
    std::ofstream(folder.path() / name) << name;
  std::string names;
  for (const auto& path : folder.files(".json")) names += path.stem().string() + " ";
  EXPECT_EQ(names, "9 10 100 ");
}

}  // namespace
}  // namespace vitrine::glass::cli
