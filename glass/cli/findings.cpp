// Reads JSON reports (docs/glass/report.md section 2) and folds what several processes have found.
#include "glass/cli/findings.h"
#include "glass/report/report.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "glass/cli/code_quality.h"
#include "glass/cli/files.h"
#include "glass/cli/places.h"
#include "glass/report/json.h"

namespace vitrine::glass::cli {
namespace {

using Json = nlohmann::json;

Frame frame_of(const Json& json) {
  return {json.value("function", ""), json.value("file", ""), json.value("line", 0u), json.value("column", 0u),
          json.value("text", "")};
}

Invocation invocation_of(const Json& json) {
  Invocation invocation;
  for (int kind = 0; kind <= static_cast<int>(Invocation::Kind::kGeometry); ++kind) {
    invocation.kind = static_cast<Invocation::Kind>(kind);
    if (json.at("kind") == invocation_name(invocation.kind).name) break;
  }
  const Json& id = json.at("id");
  for (std::size_t i = 0; i < std::min(id.size(), invocation.id.size()); ++i) invocation.id[i] = id[i];
  return invocation;
}

VkShaderStageFlagBits stage_of(std::string_view name) {
  for (int bit = VK_SHADER_STAGE_VERTEX_BIT; bit <= VK_SHADER_STAGE_COMPUTE_BIT; bit <<= 1) {
    if (stage_name(static_cast<VkShaderStageFlagBits>(bit)) == name) return static_cast<VkShaderStageFlagBits>(bit);
  }
  return {};
}

}  // namespace

Address address_of(const Json& json) {
  Address address;
  address.submission = json.value("submission", std::uint64_t{0});
  address.command = json.value("command", 0u);
  address.command_name = json.value("commandName", "");
  address.labels = json.value("labels", std::vector<std::string>());
  address.pipeline = json.value("pipeline", "");
  address.shader = json.value("shader", "");
  address.stage = stage_of(json.value("stage", ""));
  if (json.contains("invocation")) address.invocation = invocation_of(json["invocation"]);
  address.spirv_id = json.value("spirvId", 0u);
  for (const Json& frame : json.value("frames", Json::array())) address.frames.push_back(frame_of(frame));
  return address;
}

namespace {

const Rule* known_rule(const std::string& id) {
  const auto row = std::find_if(rules().begin(), rules().end(), [&](const Rule& rule) { return id == rule.id; });
  return row == rules().end() ? nullptr : &*row;
}

std::string key_of(const Finding& finding) {
  Address place = finding.address;
  place.submission = 0;
  place.command = 0;
  place.invocation = {};
  place.labels.clear();
  return to_line({finding.rule->id, finding.message, to_json(place)});
}

std::vector<std::string> lines_of(const std::string& file) {
  std::vector<std::string> lines;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return lines;
  std::string_view rest;
  const std::optional<std::string> text = read_file(file);
  if (text) rest = *text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    lines.emplace_back(line.substr(0, line.find_last_not_of('\r') + 1));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return lines;
}

}  // namespace

bool read_findings(std::string_view report, std::vector<Finding>& findings, std::string& error) {
  const Json json = Json::parse(report, nullptr, false);
  if (!json.is_object() || json.value("format", Json()) != "vitrine-findings" || json.value("version", Json()) != 1) {
    error = "it is no report of this version";
    return false;
  }
  try {
    for (const Json& row : json.at("findings")) {
      Finding finding;
      finding.rule = known_rule(row.at("rule"));
      if (!finding.rule) {
        error = "it names a rule that this version does not have";
        return false;
      }
      finding.message = row.at("message");
      finding.count = row.value("count", std::uint64_t{1});
      finding.address = address_of(row.at("address"));
      for (const Json& other : row.value("related", Json::array()))
        finding.related.push_back({other.at("message"), address_of(other.at("address"))});
      finding.remedy = row.value("remedy", "");
      findings.push_back(std::move(finding));
    }
  } catch (const Json::exception& fault) {
    error = fault.what();
    return false;
  }
  return true;
}

std::vector<Finding> folded(std::vector<Finding> findings) {
  std::vector<Finding> result;
  std::map<std::string, std::size_t> first;
  for (Finding& finding : findings) {
    if (finding.rule->severity != Severity::kNote) {
      const auto [entry, is_new] = first.try_emplace(key_of(finding), result.size());
      if (!is_new) {
        result[entry->second].count += finding.count;
        continue;
      }
    }
    result.push_back(std::move(finding));
  }
  return result;
}

void quote_files(std::vector<Finding>& findings) {
  std::map<std::string, std::vector<std::string>> files;
  const auto quote = [&](Address& address) {
    for (Frame& frame : address.frames) {
      if (!frame.text.empty() || frame.file.empty() || frame.line == 0) continue;
      const auto [entry, is_new] = files.try_emplace(frame.file);
      if (is_new) entry->second = lines_of(frame.file);
      if (frame.line <= entry->second.size()) frame.text = entry->second[frame.line - 1];
    }
  };
  for (Finding& finding : findings) {
    quote(finding.address);
    for (RelatedAccess& other : finding.related) quote(other.address);
  }
}

bool write_reports(const ReportFiles& files, const std::vector<Finding>& findings) {
  bool good = true;
  const std::vector<Finding> placed = in_repository(findings);
  if (!files.sarif.empty()) good &= write_file(files.sarif, to_report(ReportFormat::kSarif, placed));
  if (!files.code_quality.empty()) good &= write_file(files.code_quality, code_quality(placed));
  if (!files.json.empty()) good &= write_file(files.json, to_report(ReportFormat::kJson, findings));
  return good;
}

}  // namespace vitrine::glass::cli
