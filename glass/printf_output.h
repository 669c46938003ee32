// Which messages of shaders are wanted, and where they go besides the application's messengers.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "glass/finding.h"
#include "spirv/exec/trace.h"

namespace vitrine::glass {

/// Which invocations may speak: "compute:5,0,0;fragment:3,7;vertex:2", as VITRINE_TRACE names one.
class PrintfFilter {
 public:
  /// Empty: all of them. Complains of what it does not understand, which names nobody.
  explicit PrintfFilter(std::string_view text);
  bool wants(VkShaderStageFlagBits stage, const std::array<std::uint32_t, 3>& id) const;

 private:
  bool all_ = true;
  std::vector<spirv::exec::TraceTarget> targets_;
};

/// Appends messages, a line each, to "stdout", "stderr" or a file (%p: number of the process); empty: nowhere.
/// Complains once where they cannot be written.
class PrintfOutput {
 public:
  explicit PrintfOutput(std::string_view name) : name_(name) {}
  void write(std::span<const Finding> messages);

 private:
  const std::string name_;
  bool failed_ = false;
};

}  // namespace vitrine::glass
