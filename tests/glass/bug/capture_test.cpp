// What VITRINE_CAPTURE asks for, and which commands become files.
#include "glass/bug/capture.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "glass/bug/file.h"
#include "tests/glass/bug/bugs.h"

namespace vitrine::glass::bug {
namespace {

TEST(Capture, Requests) {
  const Request request = parse_request("finding,2:7,lost,3:1");
  EXPECT_TRUE(request.findings && request.losses && request.unknown.empty());
  EXPECT_EQ(request.commands.size(), 2u);
  EXPECT_TRUE(request.commands.contains({2, 7}));
  for (const char* const wrong : {"2", "2:", ":7", "2:7x", "a:b", "-1:2", "findings"})
    EXPECT_EQ(parse_request(wrong).unknown, std::vector<std::string>{wrong});
}

class CaptureFiles : public testing::Test {
 protected:
  CaptureFiles() : folder_(std::filesystem::temp_directory_path() / ("capture-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    setenv("VITRINE_CAPTURE_FILE", (folder_ / "%s-%c.vitrine").c_str(), 1);
  }
  ~CaptureFiles() override {
    unsetenv("VITRINE_CAPTURE_FILE");
    std::filesystem::remove_all(folder_);
  }

  static std::unique_ptr<Bug> command(std::uint32_t number) {
    auto bug = std::make_unique<Bug>(small_bug());
    bug->submission = 1;
    bug->command_number = number;
    bug->findings.clear();
    return bug;
  }
  static Finding found_in(std::uint32_t number, const char* id) {
    Finding finding;
    finding.rule = &rule(id);
    finding.message = "it was seen";
    finding.address.submission = 1;
    finding.address.command = number;
    return finding;
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }
  Bug read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return from_file(std::string{std::istreambuf_iterator<char>(file), {}}).value();
  }

  std::filesystem::path folder_;
  int device_ = 0;
};

TEST_F(CaptureFiles, OfCommandsThatWereNamed) {
  Captures captures(parse_request("1:2"));
  EXPECT_TRUE(captures.wants(1, 2));
  EXPECT_FALSE(captures.wants(1, 1));
  captures.begin(&device_, command(2));
  captures.done(&device_);
  EXPECT_TRUE(files().empty());
  captures.end_submission(&device_);
  EXPECT_EQ(files(), std::set<std::string>{"1-2.vitrine"});
}

TEST_F(CaptureFiles, OfCommandsInWhichSomethingIsFound) {
  Captures captures(parse_request("finding"));
  for (const std::uint32_t number : {1u, 2u, 3u}) {
    captures.begin(&device_, command(number));
    captures.done(&device_);
  }
  captures.found(&device_, found_in(2, "out-of-bounds-store"));
  captures.found(&device_, found_in(3, "printf"));  // what shaders say is no fault
  captures.end_submission(&device_);
  ASSERT_EQ(files(), std::set<std::string>{"1-2.vitrine"});
  ASSERT_EQ(read("1-2.vitrine").findings.size(), 1u);
  EXPECT_EQ(read("1-2.vitrine").findings[0].rule, "out-of-bounds-store");
}

TEST_F(CaptureFiles, OfTheCommandThatLosesTheDevice) {
  Captures captures(parse_request("lost"));
  captures.begin(&device_, command(1));
  captures.done(&device_);
  captures.begin(&device_, command(2));
  captures.lost(&device_, "it did not end");
  EXPECT_FALSE(captures.file_of_loss(&device_).empty());
  captures.end_submission(&device_);
  ASSERT_EQ(files(), std::set<std::string>{"1-2.vitrine"});
  EXPECT_TRUE(read("1-2.vitrine").lost);
}

}  // namespace
}  // namespace vitrine::glass::bug
