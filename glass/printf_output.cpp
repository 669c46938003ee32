// See printf_output.h.
#include "glass/printf_output.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "glass/output.h"
#include "glass/report/report_file.h"

namespace vitrine::glass {

PrintfFilter::PrintfFilter(std::string_view text) : all_(text.empty()) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("; "), text.size());
    const std::string_view one = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (one.empty()) continue;
    if (const auto target = spirv::exec::parse_trace_target(one)) {
      targets_.push_back(*target);
    } else {
      complain("VITRINE_PRINTF_FILTER: '" + std::string(one) +
               "' names no invocation; compute:5,0,0, fragment:3,7 and vertex:2 do");
    }
  }
}

bool PrintfFilter::wants(VkShaderStageFlagBits stage, const std::array<std::uint32_t, 3>& id) const {
  return all_ || std::any_of(targets_.begin(), targets_.end(), [&](const spirv::exec::TraceTarget& target) {
           return target.stage == stage && std::equal(id.begin(), id.begin() + target.count, target.id.begin());
         });
}

void PrintfOutput::write(std::span<const Finding> messages) {
  if (name_.empty() || messages.empty() || failed_) return;
  std::string text;
  for (const Finding& message : messages) {
    text += message.message;
    if (!text.ends_with('\n')) text += '\n';
  }
  std::FILE* const given = name_ == "stdout" ? stdout : name_ == "stderr" ? stderr : nullptr;
  const std::string path = given ? name_ : report_path(name_);
  std::FILE* const file = given ? given : std::fopen(path.c_str(), "ae");
  const bool good = file && std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  const int reason = errno;
  if (file && !given) std::fclose(file);
  if (good) return;
  failed_ = true;
  complain("VITRINE_PRINTF: '" + path + "' cannot be written: " + std::strerror(reason));
}

}  // namespace vitrine::glass
