// Which reference a run compares with: lavapipe as it is installed, or its recorded results.
#pragma once

#include <string>

namespace vitrine::cts {

struct Options;
struct Record;

/// Decides where the command line does not: lavapipe if it is installed in the recorded version, else the record. Sets
/// `recorded` of the options. Returns what the run says at its start.
std::string choose_reference(Options& options);

/// The record that judges in this process; null where the reference itself runs.
const Record* recorded_reference();
/// Reads the file that the options name. Throws where it cannot judge what they ask for.
void load_recorded_reference();

}  // namespace vitrine::cts
