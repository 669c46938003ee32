// See code_quality.h.
#include "glass/cli/code_quality.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "glass/report/json.h"
#include "glass/report/sarif_parts.h"

namespace vitrine::glass::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* severity_of(const Finding& finding) {
  switch (finding.rule->severity) {
    case Severity::kError:
      return "critical";
    case Severity::kWarning:
      return "major";
    case Severity::kNote:
      return "info";
  }
  return "info";
}

/// The message and whom it is about.
std::string description_of(const Finding& finding) {
  std::string text = finding.message;
  if (const std::string address = to_text(finding.address); !address.empty()) text += "; at " + address;
  if (finding.count > 1) text += "; " + std::to_string(finding.count) + " times";
  if (!finding.remedy.empty()) text += "; missing: " + finding.remedy;
  return text;
}

}  // namespace

std::string code_quality(const std::vector<Finding>& findings) {
  Json list = Json::array();
  std::map<std::string, int> seen;
  for (const Finding& finding : findings) {
    if (finding.address.frames.empty() || finding.address.frames[0].file.empty()) continue;
    const Frame& frame = finding.address.frames[0];
    std::string fingerprint = sarif_fingerprint(finding);
    if (const int before = seen[fingerprint]++) fingerprint += '-' + std::to_string(before);
    list.push_back({{"description", description_of(finding)},
                    {"check_name", sarif_rule_id(*finding.rule)},
                    {"fingerprint", fingerprint},
                    {"severity", severity_of(finding)},
                    {"location", {{"path", frame.file}, {"lines", {{"begin", std::max(frame.line, 1u)}}}}}});
  }
  return to_line(list) + '\n';
}

}  // namespace vitrine::glass::cli
