// vitrine replay: the draw or dispatch of a bug file, on this driver under any other subcommand, or on another driver.
#include <filesystem>

#include "glass/cli/application.h"
#include "glass/cli/bug_commands.h"
#include "glass/cli/bug_files.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {

std::vector<std::string> replay_words(const ReplayOptions& options) {
  std::vector<std::string> words = options.words;
  if (words.empty()) words.emplace_back("run");
  // Options alone are those of the tools that find faults.
  if (words[0].starts_with('-')) words.insert(words.begin(), "check");
  words.insert(words.end(), {"--", replayer(), options.file});
  return words;
}

int replay_elsewhere(const ReplayOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(options.driver, error)) {
    say("there is no driver manifest " + options.driver);
    return kCouldNotRun;
  }
  if (!options.words.empty()) {
    say("another driver has no tools: --driver goes without a subcommand");
    return kCouldNotRun;
  }
  const Ending ending = run_to_end({replayer(), options.file},
                                   {{"VK_DRIVER_FILES", options.driver}, {"VK_ICD_FILENAMES", options.driver}});
  if (!ending.error.empty()) say(replayer().string() + " cannot be started: " + ending.error);
  return ending.error.empty() ? ending.code : kCouldNotRun;
}

}  // namespace vitrine::glass::cli
