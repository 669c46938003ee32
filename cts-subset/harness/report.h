// Counts of a run of the suite, per group, and the lines that children write for their parent.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/execute.h"

namespace vitrine::cts {

struct GroupCounts {
  uint32_t cases = 0, identical = 0, deviation = 0, unsupported = 0, known = 0, differing = 0, crashed = 0,
           nan_bits = 0, blank = 0, unrecorded = 0, changed = 0;
};

/// Group name -> counts.
using Counts = std::map<std::string, GroupCounts>;

void count(Counts& counts, const std::string& group, const Judgement& judgement);
/// One line per group and a total. Returns whether nothing differed or crashed.
bool print_counts(const Counts& counts);

/// The command that runs a case again as this process did: with its seed, its number of cases, its mutants.
std::string command_of(const std::string& name);

/// The pipe to the parent of this child.
void set_parent(int pipe);
bool has_parent();
/// Writes a line to the parent, if there is one: "B index name" when a case begins, "D" when the reference is done with
/// it and the device is next, "R" when the reference runs it again with another seed, "E verdict nan blank message"
/// when it has ended, "L line" for keep_recorded_line().
void tell_parent(std::string line);

/// Runs the (filtered) cases in child processes, so that a crash costs one case. `command`: their words. Returns the
/// exit status.
int run_isolated(const std::vector<std::string>& command);

}  // namespace vitrine::cts
