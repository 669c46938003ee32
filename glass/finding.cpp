// Rules by their ids, and addresses as text (glass.md 2 step 4).
#include "glass/finding.h"

#include "base/check.h"

namespace vitrine::glass {
namespace {

constexpr Rule kRules[] = {
#define VITRINE_RULE(id, severity, title, help) {id, Severity::k##severity, title, help},
#include "glass/rules.def"
#undef VITRINE_RULE
};

/// Appends a part of a list.
void add(std::string& text, const std::string& part) { (text.empty() ? text : text += ", ") += part; }

std::string command_text(const Address& address) {
  std::string text = address.command ? "command " + std::to_string(address.command) : "";
  if (!address.command_name.empty()) {
    text += text.empty() ? address.command_name : " (" + address.command_name + ")";
  }
  std::string_view separator = text.empty() ? "in " : " in ";
  for (const std::string& label : address.labels) {
    (text += separator) += "'" + label + "'";
    separator = " > ";
  }
  return text;
}

std::string shader_text(const Address& address) {
  std::string text(address.stage ? stage_name(address.stage) : "");
  if (!address.shader.empty())
    (text.empty() ? text : text += " ") += "shader " + address.shader;
  else if (!text.empty())
    text += " shader";
  return text;
}

std::string of_instance(const Invocation& invocation) {
  return invocation.id[2] != 0 ? " of instance " + std::to_string(invocation.id[2]) : "";
}

}  // namespace

std::string to_text(const Address& address) {
  std::string text;
  if (address.submission) add(text, "submission " + std::to_string(address.submission));
  if (const std::string command = command_text(address); !command.empty()) add(text, command);
  if (!address.pipeline.empty()) add(text, "pipeline '" + address.pipeline + "'");
  if (const std::string shader = shader_text(address); !shader.empty()) add(text, shader);
  if (const std::string who = to_text(address.invocation); !who.empty()) add(text, who);
  return text;
}

std::string to_text(const Invocation& invocation) {
  const auto number = [&](std::size_t i) { return std::to_string(invocation.id[i]); };
  switch (invocation.kind) {
    case Invocation::Kind::kNone:
      return "";
    case Invocation::Kind::kVertex:
      return "vertex " + number(0) + " of instance " + number(1);
    case Invocation::Kind::kFragment:
      return "pixel (" + number(0) + ", " + number(1) + ")";
    case Invocation::Kind::kCompute:
      return "invocation (" + number(0) + ", " + number(1) + ", " + number(2) + ")";
    case Invocation::Kind::kControl:
      return "vertex " + number(0) + " of patch " + number(1) + of_instance(invocation);
    case Invocation::Kind::kEvaluation:
      return "domain point " + number(0) + " of patch " + number(1) + of_instance(invocation);
    case Invocation::Kind::kGeometry:
      return "invocation " + number(0) + " of primitive " + number(1) + of_instance(invocation);
  }
  return "";
}

std::string to_text(const Frame& frame) {
  std::string text = frame.file;
  if (frame.line) text += ":" + std::to_string(frame.line);
  if (frame.line && frame.column) text += ":" + std::to_string(frame.column);
  return text;
}

std::string_view stage_name(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return "vertex";
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return "tessellation control";
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return "tessellation evaluation";
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return "geometry";
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return "fragment";
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return "compute";
    default:
      return "";
  }
}

std::string_view severity_name(Severity severity) {
  return severity == Severity::kError ? "error" : severity == Severity::kWarning ? "warning" : "note";
}

std::span<const Rule> rules() { return kRules; }

const Rule& rule(std::string_view id) {
  for (const Rule& row : kRules) {
    if (id == row.id) return row;
  }
  VITRINE_UNREACHABLE("a rule that rules.def does not have");
  return kRules[0];
}

}  // namespace vitrine::glass
