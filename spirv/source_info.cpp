// Places as text.
#include "spirv/source_info.h"

namespace vitrine::spirv {

std::string SourceInfo::text(std::uint32_t number) const {
  const SourcePlace& at = place(number);
  if (at.line == 0) return {};
  std::string text = at.file < files.size() ? files[at.file].name : std::string();
  text += text.empty() ? "line " : ":";
  text += std::to_string(at.line);
  if (at.column != 0) text.append(":").append(std::to_string(at.column));
  return text;
}

std::string SourceInfo::stack(std::uint32_t number) const {
  std::string result;
  while (number != 0) {
    if (!result.empty()) result += ", called at ";
    const std::string at = text(number);
    result += at.empty() ? "an unknown line" : at;
    const SourceScope& scope = scopes[place(number).scope];
    if (const std::string& name = functions[scope.function].name; !name.empty()) result += " in " + name;
    number = scope.call;
  }
  return result;
}

}  // namespace vitrine::spirv
