// Judges by the recorded reference, and records it: the two uses of a Record.
#pragma once

#include <string>

#include "harness/execute.h"
#include "harness/record.h"
#include "harness/side.h"

namespace vitrine::cts {

/// Runs a case on the device and compares it with its record.
Judgement judge_by_record(const Case& c);

/// Keeps the result of the reference for the file, unless it failed.
void record_case(const Case& c, const SideResult& device, const SideResult& reference);
/// A line "FILE NAME RECORD" of a child or of this process.
void keep_recorded_line(const std::string& line);
/// Writes what was kept to the file that the options name: all of it anew, or, where a filter chose cases, into it.
void write_recorded_reference();

}  // namespace vitrine::cts
