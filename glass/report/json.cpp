// Findings as JSON of our own shape: one finding a line (docs/glass/report.md).
#include "glass/report/json.h"

#include <nlohmann/json.hpp>

#include "glass/report/formats.h"

namespace vitrine::glass {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Frame& frame) {
  Json json = Json::object();
  if (!frame.function.empty()) json["function"] = frame.function;
  if (!frame.file.empty()) json["file"] = frame.file;
  if (frame.line) json["line"] = frame.line;
  if (frame.column) json["column"] = frame.column;
  if (!frame.text.empty()) json["text"] = frame.text;
  return json;
}

Json to_json(const Invocation& invocation) {
  const auto [name, numbers] = invocation_name(invocation.kind);
  Json id = Json::array();
  for (std::size_t i = 0; i < numbers; ++i) id.push_back(invocation.id[i]);
  return {{"kind", name}, {"id", std::move(id)}};
}

}  // namespace

InvocationName invocation_name(Invocation::Kind kind) {
  switch (kind) {
    case Invocation::Kind::kNone:
      return {"none", 0};
    case Invocation::Kind::kVertex:
      return {"vertex", 2};
    case Invocation::Kind::kFragment:
      return {"fragment", 2};
    case Invocation::Kind::kCompute:
      return {"compute", 3};
    case Invocation::Kind::kControl:
      return {"control", 3};
    case Invocation::Kind::kEvaluation:
      return {"evaluation", 3};
    case Invocation::Kind::kGeometry:
      return {"geometry", 3};
  }
  return {"none", 0};
}

Json to_json(const Address& address) {
  Json json = Json::object();
  if (address.submission) json["submission"] = address.submission;
  if (address.command) json["command"] = address.command;
  if (!address.command_name.empty()) json["commandName"] = address.command_name;
  if (!address.labels.empty()) json["labels"] = address.labels;
  if (!address.pipeline.empty()) json["pipeline"] = address.pipeline;
  if (!address.shader.empty()) json["shader"] = address.shader;
  if (const auto stage = stage_name(address.stage); !stage.empty()) json["stage"] = stage;
  if (address.invocation.kind != Invocation::Kind::kNone) json["invocation"] = to_json(address.invocation);
  if (address.spirv_id) json["spirvId"] = address.spirv_id;
  for (const Frame& frame : address.frames) json["frames"].push_back(to_json(frame));
  return json;
}

std::string to_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

ReportFrame json_frame() {
  return {"{\"format\":\"vitrine-findings\",\"version\":1,\"findings\":[\n", ",\n", "\n]}\n"};
}

std::string json_entry(const Finding& finding) {
  Json json{{"rule", finding.rule->id},
            {"severity", severity_name(finding.rule->severity)},
            {"message", finding.message},
            {"count", finding.count},
            {"address", to_json(finding.address)}};
  for (const RelatedAccess& other : finding.related)
    json["related"].push_back({{"message", other.message}, {"address", to_json(other.address)}});
  if (!finding.remedy.empty()) json["remedy"] = finding.remedy;
  return to_line(json);
}

}  // namespace vitrine::glass
