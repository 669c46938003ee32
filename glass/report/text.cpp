// Findings as text for people, the first line as compilers write theirs, so that editors find the place. What a shader
// says (Severity::kNote) is a line; everything else a paragraph.
#include "glass/report/formats.h"

namespace vitrine::glass {
namespace {

constexpr std::size_t kLongestQuote = 200;  // bytes of a source line: minified sources have lines without end

/// Text from elsewhere, without what a terminal would obey.
std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    result += control && c != '\t' && c != '\n' ? '?' : c;
  }
  return result;
}

/// The message's lines, those after the first indented.
std::string message_text(const std::string& message) {
  std::string result;
  for (const char c : printable(message)) {
    result += c;
    if (c == '\n') result += "    ";
  }
  return result;
}

/// "   12 |   a[i] = 1;" and below it a mark at the column, which counts bytes.
std::string quote(const Frame& frame) {
  if (frame.text.empty() || frame.line == 0) return "";
  const std::string number = std::to_string(frame.line);
  const std::string margin(number.size() < 5 ? 5 - number.size() : 0, ' ');
  std::string line = printable(frame.text);
  if (line.size() > kLongestQuote) line.replace(line.find_last_of(" \t", kLongestQuote) + 1, std::string::npos, "...");
  std::string result = margin;
  ((result += number) += " | ") += line;
  result += '\n';
  if (frame.column == 0 || frame.column > line.size()) return result;
  ((result += margin) += std::string(number.size(), ' ')) += " | ";
  for (const char c : std::string_view(line).substr(0, frame.column - 1)) {
    if ((c & 0xc0) != 0x80) result += c == '\t' ? '\t' : ' ';
  }
  return result += "^\n";
}

std::string function_text(const Frame& frame) {
  return frame.function.empty() ? "a function" : "function " + printable(frame.function);
}

/// "  in function f, called from function main at a.comp:3:5".
std::string stack_text(const std::vector<Frame>& frames) {
  if (frames.empty() || (frames.size() == 1 && frames[0].function.empty())) return "";
  std::string result = "  in " + function_text(frames[0]) + '\n';
  for (std::size_t i = 1; i < frames.size(); ++i) {
    result += "  called from " + function_text(frames[i]);
    if (const std::string place = to_text(frames[i]); !place.empty()) (result += " at ") += printable(place);
    result += '\n';
  }
  return result;
}

/// The other access, as compilers write a note, and what repairs it.
std::string related_text(const Finding& finding) {
  std::string result;
  for (const RelatedAccess& other : finding.related) {
    const std::vector<Frame>& frames = other.address.frames;
    result += frames.empty() ? "vitrine" : printable(to_text(frames[0]));
    result += ": note: " + printable(other.message);
    if (const std::string who = to_text(other.address.invocation); !who.empty()) result += " by " + who;
    result += '\n';
    if (!frames.empty()) result += quote(frames[0]);
    result += stack_text(frames);
  }
  if (!finding.remedy.empty()) result += "  missing: " + printable(finding.remedy) + '\n';
  return result;
}

/// "  first at submission 1, ..., 128 times".
std::string address_text(const Finding& finding) {
  std::string result = to_text(finding.address);
  if (finding.count > 1) {
    (result.empty() ? result : result += "; ") += std::to_string(finding.count);
    result += " times";
  }
  return result.empty() ? result : "  at " + printable(result) + '\n';
}

}  // namespace

std::string text_entry(const Finding& finding) {
  const std::string place = finding.address.frames.empty() ? "" : printable(to_text(finding.address.frames[0]));
  std::string text = place.empty() ? "vitrine" : place;
  ((text += ": ") += severity_name(finding.rule->severity)) += ": ";
  text += message_text(finding.message);
  ((text += " [vitrine/") += finding.rule->id) += "]\n";
  if (finding.rule->severity == Severity::kNote) return text;
  if (!finding.address.frames.empty()) text += quote(finding.address.frames[0]);
  text += stack_text(finding.address.frames);
  text += address_text(finding);
  text += related_text(finding);
  return text += '\n';
}

}  // namespace vitrine::glass
