// What one device does in one case.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/case.h"
#include "harness/gpu.h"
#include "harness/output.h"

namespace vitrine::cts {

struct SideResult {
  std::vector<Output> outputs;
  std::string error, unsupported;
  bool lost = false;  ///< VK_ERROR_DEVICE_LOST
  std::vector<std::string> validation;
  std::vector<std::pair<std::string, std::string>> notes;
  uint32_t inputs = 0, modules = 0;  ///< what it was given (inputs.h)
};

/// `attempt`: how many seeds of the case have been tried before.
SideResult run_side(Gpu& gpu, const Case& c, uint32_t attempt);
bool all_blank(const std::vector<Output>& outputs);
/// Whether the device refused a pipeline and named the instruction that it does not cover yet: no wrong picture, and
/// counted as unsupported.
bool refused(const SideResult& device);

/// Path below the results folder for a part of a case's results.
std::string result_path(const Case& c, const std::string& part);
void write_notes(const Case& c, const SideResult& side);

}  // namespace vitrine::cts
