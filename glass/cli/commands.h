// The subcommands of `vitrine`: each takes its options and gives the exit code.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vitrine::glass::cli {

/// What the command answers besides what the application does.
inline constexpr int kFound = 1;  ///< findings; counters that grew; too little coverage
inline constexpr int kCouldNotRun = 2;

/// The application and its arguments.
using CommandLine = std::vector<std::string>;

/// The application on this driver, nothing else.
int run(const CommandLine& application);

struct CheckOptions {
  std::vector<std::string> tools;
  std::string sarif, json, code_quality;  ///< files; empty: none
  std::string bugs;                       ///< folder for bug files; empty: none
  bool annotations = false;               ///< for the runners of a code host
  bool quiet = false;                     ///< no text
  std::string invocations;                ///< whose messages are wanted, separated by semicolons; empty: all
  CommandLine application;
};
int check(const CheckOptions& options);

struct CoverageOptions {
  std::string output = "shaders.info";
  std::string sources;                ///< folder for sources that are in the modules alone; empty: the tool's default
  bool append = false;                ///< add to what the file has
  std::optional<double> least_lines;  ///< percent
  CommandLine application;
};
int coverage(const CoverageOptions& options);

struct CountOptions {
  std::string output;  ///< file for the counters; empty: none
  bool lines = false;  ///< prints sources with what each line costs
  bool draws = false;  ///< the file has every draw
  CommandLine application;
};
int count(const CountOptions& options);

struct TimelineOptions {
  std::string output = "timeline.json";
  CommandLine application;
};
int timeline(const TimelineOptions& options);

struct ShakeOptions {
  std::optional<std::uint64_t> seed;  ///< one run with it; none: runs are compared
  std::uint64_t runs = 20;            ///< how many seeds are tried then
  std::string kinds;                  ///< what is shaken (base/shake.def), comma-separated; empty: the usual
  std::string sarif, json;            ///< files; empty: none
  CommandLine application;
};
int shake(const ShakeOptions& options);

struct PixelOptions {
  std::string position;             ///< "X,Y"
  std::string image = "swapchain";  ///< "swapchain", a name, "#3": the third that the application made
  std::string aspect;               ///< empty: colour, or depth
  std::uint32_t level = 0, layer = 0, slice = 0;
  std::optional<std::uint32_t> sample;             ///< none: all
  std::optional<std::uint64_t> frame, submission;  ///< the history ends there; none: with the application
  std::string primitive;                           ///< "7" or "7@3": why it did not reach the pixel; empty: none
  unsigned depth = 4;                              ///< how often sources of sources are followed
  std::string json, html;                          ///< files; empty: none
  std::string bug;                                 ///< file for what made the pixel's value; empty: none
  CommandLine application;
};
int pixel(const PixelOptions& options);

struct DebugOptions {
  std::string script;  ///< file with commands; empty: none
  bool json = false;   ///< stops and answers as lines of JSON
  bool exact = false;  ///< the shader as it always runs is shown
  std::string port;    ///< of the Debug Adapter Protocol; empty: a prompt
  CommandLine application;
};
int debug(const DebugOptions& options);

struct DiffOptions {
  std::string before, after;
  std::string pattern = "*";          ///< which counters, as the shell matches names
  std::optional<double> most_growth;  ///< percent
};
int diff(const DiffOptions& options);

}  // namespace vitrine::glass::cli
