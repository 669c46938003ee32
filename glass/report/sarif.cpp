// Findings as SARIF 2.1.0 (OASIS), which code hosts and editors show at the lines: one result a line of the file.
#include <nlohmann/json.hpp>

#include "glass/report/formats.h"
#include "glass/report/json.h"
#include "glass/report/sarif_parts.h"
#include "glass/version.h"

namespace vitrine::glass {
namespace {

using Json = nlohmann::ordered_json;

Json text_of(std::string_view text) { return {{"text", text}}; }

Json region_of(const Frame& frame) {
  Json region{{"startLine", frame.line}};
  if (const std::size_t column = sarif_column(frame)) region["startColumn"] = column;
  if (!frame.text.empty()) region["snippet"] = text_of(frame.text);
  return region;
}

/// A place in a file and its function.
Json location_of(const Frame& frame) {
  Json location = Json::object();
  if (!frame.file.empty()) {
    Json& physical = location["physicalLocation"];
    physical["artifactLocation"]["uri"] = sarif_uri(frame.file);
    if (frame.line) physical["region"] = region_of(frame);
  }
  if (!frame.function.empty()) location["logicalLocations"] = {{{"name", frame.function}, {"kind", "function"}}};
  return location;
}

/// The place, its function and the invocation.
Json result_location(const Address& address) {
  Json location = address.frames.empty() ? Json::object() : location_of(address.frames[0]);
  if (const std::string text = to_text(address); !text.empty()) {
    const std::string who = to_text(address.invocation);
    location["logicalLocations"].push_back(
        {{"name", who.empty() ? text : who}, {"fullyQualifiedName", text}, {"kind", "invocation"}});
  }
  return location;
}

/// The calls, innermost first.
Json stack_of(const std::vector<Frame>& frames) {
  Json list = Json::array();
  for (const Frame& frame : frames) list.push_back({{"location", location_of(frame)}});
  return {{"message", text_of("the calls that lead there")}, {"frames", std::move(list)}};
}

/// The same from the outside in: code hosts show these and no stacks.
Json flow_of(const std::vector<Frame>& frames) {
  Json steps = Json::array();
  for (std::size_t i = frames.size(); i-- > 0;) {
    Json location = location_of(frames[i]);
    location["message"] = text_of(i == 0 ? "here" : "calls " + frames[i - 1].function);
    steps.push_back({{"location", std::move(location)}});
  }
  Json thread = Json::object();
  thread["locations"] = std::move(steps);
  Json flow = Json::object();
  flow["threadFlows"] = Json::array({std::move(thread)});
  return flow;
}

/// The other access and the one that the result is about, in this order.
Json pair_flow_of(const RelatedAccess& other, const Finding& finding) {
  Json steps = Json::array();
  const auto add = [&](const Address& address, const std::string& text) {
    Json location = result_location(address);
    location["message"] = text_of(text);
    steps.push_back({{"location", std::move(location)}});
  };
  add(other.address, other.message + " by " + to_text(other.address.invocation));
  add(finding.address, finding.message);
  Json thread = Json::object();
  thread["locations"] = std::move(steps);
  Json flow = Json::object();
  flow["threadFlows"] = Json::array({std::move(thread)});
  return flow;
}

Json descriptor_of(const Rule& rule) {
  return {{"id", sarif_rule_id(rule)},
          {"name", sarif_rule_name(rule)},
          {"shortDescription", text_of(rule.title)},
          {"fullDescription", text_of(rule.help)},
          {"help", text_of(rule.help)},
          {"defaultConfiguration", {{"level", severity_name(rule.severity)}}}};
}

/// The message and where: hosts show nothing else of a result.
std::string message_of(const Finding& finding) {
  std::string text = finding.message;
  if (const std::string where = to_text(finding.address); !where.empty()) (text += "\nFirst at ") += where;
  if (finding.count > 1) (text += "; ") += std::to_string(finding.count) + " times";
  if (!finding.remedy.empty()) (text += "\nMissing: ") += finding.remedy;
  return text;
}

}  // namespace

ReportFrame sarif_frame() {
  Json rules_list = Json::array();
  for (const Rule& row : rules()) rules_list.push_back(descriptor_of(row));
  Json run = Json::object();
  run["tool"]["driver"] = {{"name", "Vitrine"}, {"version", kVersion}, {"rules", std::move(rules_list)}};
  run["columnKind"] = "unicodeCodePoints";
  run["results"] = Json::array();
  Json log{{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"}, {"version", "2.1.0"}};
  log["runs"] = Json::array({std::move(run)});
  std::string text = to_line(log);
  const std::string_view closing = "]}]}";
  text.resize(text.size() - closing.size());
  return {text + '\n', ",\n", "\n" + std::string(closing) + "\n"};
}

std::string sarif_entry(const Finding& finding) {
  Json result{{"ruleId", sarif_rule_id(*finding.rule)},
              {"ruleIndex", finding.rule - rules().data()},
              {"level", severity_name(finding.rule->severity)},
              {"message", text_of(message_of(finding))}};
  if (Json location = result_location(finding.address); !location.empty()) {
    result["locations"] = Json::array({std::move(location)});
  }
  if (finding.address.frames.size() > 1) {
    result["stacks"] = Json::array({stack_of(finding.address.frames)});
    result["codeFlows"] = Json::array({flow_of(finding.address.frames)});
  }
  for (const RelatedAccess& other : finding.related) {
    Json location = result_location(other.address);
    location["id"] = result["relatedLocations"].size();
    location["message"] = text_of(other.message + " by " + to_text(other.address.invocation));
    result["relatedLocations"].push_back(std::move(location));
    result["codeFlows"].push_back(pair_flow_of(other, finding));
  }
  result["occurrenceCount"] = finding.count;
  result["partialFingerprints"]["vitrinePlace/v1"] = sarif_fingerprint(finding);
  result["properties"]["address"] = to_json(finding.address);
  return to_line(result);
}

}  // namespace vitrine::glass
