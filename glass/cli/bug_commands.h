// The subcommands that work on bug files (docs/glass/bugfile.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::glass::cli {

struct ReplayOptions {
  std::string file;
  std::string driver;              ///< manifest of another driver; empty: this one
  std::vector<std::string> words;  ///< subcommand and its options: under which tool; empty: none
};
/// The command line that replays under a subcommand: for the command's own main().
std::vector<std::string> replay_words(const ReplayOptions& options);
/// Replays on another driver.
int replay_elsewhere(const ReplayOptions& options);

struct ReduceOptions {
  std::string file, output;
  std::string tools = "sanitize,race";  ///< that find what is to stay
  std::string rule;                     ///< what is to stay; empty: the first that the file has
  bool any_place = false;               ///< the rule alone is to stay
  std::uint64_t runs = 500;             ///< at most
  bool shaders = true;                  ///< by spirv-reduce, too
  std::string stage, words;             ///< for spirv-reduce itself: tries this file as that stage
};
int reduce(const ReduceOptions& options);

struct ExportOptions {
  std::string file;
  std::string amber;   ///< AmberScript to write; empty: none
  std::string files;   ///< folder for the parts as files; empty: none
  std::string output;  ///< bug file to write; empty: none
  bool names = true;   ///< false: without the application's names
};
int export_bug(const ExportOptions& options);

}  // namespace vitrine::glass::cli
