// Runs an application: its signals are ours, its end is told.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace vitrine::glass::cli {

struct Ending {
  std::string error;  ///< why it could not be started; empty: it was
  int code = 0;       ///< exit code; ended by a signal: 128 + its number, as shells say
  int signal = 0;     ///< 0: none
};

/// Variables that the application gets besides ours.
using Environment = std::map<std::string, std::string>;

/// What Ctrl-C does instead of ending the command. False: nothing, it is to end.
using Interrupted = std::function<bool()>;

/// Runs `command` (a name is looked up as shells do) to its end. Signals that somebody sends to us go to it; those of
/// the terminal reach it anyway. With `interrupted` it ignores SIGINT, and gets SIGTERM where that says so.
Ending run_to_end(const std::vector<std::string>& command, const Environment& environment,
                  const Interrupted& interrupted = {});

}  // namespace vitrine::glass::cli
