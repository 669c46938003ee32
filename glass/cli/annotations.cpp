// See annotations.h.
#include "glass/cli/annotations.h"

#include <cstdio>

namespace vitrine::glass::cli {
namespace {

/// What ends a line, or looks like an escape, as hexadecimal numbers; so the characters of `more`.
std::string escaped(std::string_view text, std::string_view more) {
  std::string result;
  for (const char c : text) {
    if (c != '%' && c != '\r' && c != '\n' && more.find(c) == std::string_view::npos) {
      result += c;
      continue;
    }
    char number[4];
    std::snprintf(number, sizeof number, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    result += number;
  }
  return result;
}

std::string property(std::string_view name, std::string_view value) {
  std::string text{name};
  (text += '=') += escaped(value, ":,");
  return text;
}

std::string place(const Finding& finding) {
  if (finding.address.frames.empty() || finding.address.frames[0].file.empty()) return "";
  const Frame& frame = finding.address.frames[0];
  std::string text = property("file", frame.file) + ',';
  if (frame.line) text += property("line", std::to_string(frame.line)) + ',';
  if (frame.line && frame.column) text += property("col", std::to_string(frame.column)) + ',';
  return text;
}

/// The message and whom it is about; the place is told already.
std::string body(const Finding& finding) {
  std::string text = finding.message;
  if (const std::string address = to_text(finding.address); !address.empty()) text += "\nat " + address;
  if (finding.count > 1) text += "; " + std::to_string(finding.count) + " times";
  for (const RelatedAccess& other : finding.related) {
    text += '\n' + other.message;
    if (!other.address.frames.empty()) text += " at " + to_text(other.address.frames[0]);
  }
  if (!finding.remedy.empty()) text += "\nmissing: " + finding.remedy;
  return escaped(text, "");
}

}  // namespace

std::string annotations(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    const Severity severity = finding.rule->severity;
    (text += "::") += severity == Severity::kNote ? "notice" : severity_name(severity);
    (text += ' ') += place(finding);
    text += property("title", std::string("vitrine/") + finding.rule->id);
    ((text += "::") += body(finding)) += '\n';
  }
  return text;
}

}  // namespace vitrine::glass::cli
