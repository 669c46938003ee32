// Files of counters: JSON objects in which numbers are counters and objects are groups of them, to any depth. A
// counter's name is the path that leads to it: "pipelines/gauss/instructions".
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vitrine::glass::cli {

using Counters = std::map<std::string, double>;

/// The sum of two files: counters of the same name are added (of those named "most..." the larger counts), what is no
/// counter is as in the first that has it.
/// Nothing: one of them is no JSON object.
std::optional<std::string> sum_of_counters(std::string_view a, std::string_view b);

/// All counters of a file but "version".
std::optional<Counters> read_counters(std::string_view text);

/// Shaders with the instructions that they ran, the dearest first.
std::vector<std::pair<std::string, double>> dearest_shaders(const Counters& counters);
/// The groups of a group: "gauss" for "pipelines/gauss/instructions" in "pipelines".
std::vector<std::string> names_in_group(const Counters& counters, const std::string& group);
/// The sources in a file of counters, each line behind the instructions that it ran; empty: it has none.
std::string annotated_sources(std::string_view text);

struct CounterChange {
  std::string name;
  double before = 0, after = 0;
  /// In percent of what it was; from nothing to something: infinite.
  double growth() const;
};
/// Counters that differ (one that a file does not have is 0 there) and whose names match the pattern of fnmatch(3);
/// "*": all but those of lines.
std::vector<CounterChange> changes(const Counters& before, const Counters& after, const std::string& pattern);

}  // namespace vitrine::glass::cli
