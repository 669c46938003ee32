// Names of files that compilers of shaders have noted, as code hosts know them.
#include "glass/cli/places.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

#include "tests/glass/report/findings.h"

namespace vitrine::glass::cli {
namespace {

namespace fs = std::filesystem;

/// A repository with shaders/a.comp, part/b.comp and build/.
class Places : public testing::Test {
 protected:
  Places() {
    std::string name = (fs::temp_directory_path() / "places-XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    for (const char* const folder : {".git", "shaders", "part", "build"}) fs::create_directory(root_ / folder);
    std::ofstream(root_ / "shaders/a.comp") << "void main() {}\n";
    std::ofstream(root_ / "part/b.comp") << "void main() {}\n";
  }
  ~Places() override { fs::remove_all(root_); }

  std::string from(const char* folder, const std::string& file) const {
    return path_in_repository(file, root_, root_ / folder);
  }

  fs::path root_;
};

TEST_F(Places, TheRootIsTheNearestRepository) {
  EXPECT_EQ(repository_root(root_ / "part"), root_);
  EXPECT_EQ(repository_root(root_), root_);
  fs::create_directory(root_ / "part/.git");
  EXPECT_EQ(repository_root(root_ / "part"), root_ / "part");
}

TEST_F(Places, FilesHaveTheirPathFromTheRoot) {
  EXPECT_EQ(from("", "shaders/a.comp"), "shaders/a.comp");
  EXPECT_EQ(from("", (root_ / "shaders/a.comp").string()), "shaders/a.comp");
  EXPECT_EQ(from("build", (root_ / "build/../shaders/a.comp").string()), "shaders/a.comp");
  EXPECT_EQ(from("part", "b.comp"), "part/b.comp");
  EXPECT_EQ(from("build", "../shaders/a.comp"), "shaders/a.comp");
}

TEST_F(Places, StepsUpwardsOfABuildAreNotThoseOfTheJob) {
  EXPECT_EQ(from("", "../shaders/a.comp"), "shaders/a.comp");
  EXPECT_EQ(from("", "../../shaders/a.comp"), "shaders/a.comp");
  EXPECT_EQ(from("part", "../../b.comp"), "part/b.comp");
}

TEST_F(Places, WhatIsNoFileThereStays) {
  for (const char* const name : {"", "main.spvasm", "../other/a.comp", "/other/a.comp", "C:\\a.comp", ".."})
    EXPECT_EQ(from("", name), name);
}

TEST(DisassembledFindings, AreThoseOfNoFile) {
  EXPECT_FALSE(any_in_disassembly({whole_finding(), bare_finding()}));
  Finding finding = whole_finding();
  finding.address.frames[0].file = "main.spvasm";
  EXPECT_TRUE(any_in_disassembly({bare_finding(), finding}));
}

}  // namespace
}  // namespace vitrine::glass::cli
