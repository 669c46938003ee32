// See lcov.h.
#include "glass/lcov.h"

namespace vitrine::glass {
namespace {

template <class... Parts>
void add_line(std::string& text, const Parts&... parts) {
  const auto add = [&](const auto& part) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(part)>>) {
      text += std::to_string(part);
    } else {
      text += part;
    }
  };
  (add(parts), ...);
  text += '\n';
}

/// Names come from modules, which may say anything; lines end records.
std::string on_one_line(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20) c = '?';
  return name;
}

/// genhtml of lcov 2 refuses functions that begin on a line without code.
std::uint32_t first_line_with_code(const FileCoverage& file, std::uint32_t line) {
  const auto found = file.lines.lower_bound(line);
  return found == file.lines.end() ? line : found->first;
}

void add_functions(std::string& text, const FileCoverage& file) {
  std::size_t hit = 0;
  for (const auto& [name, function] : file.functions)
    add_line(text, "FN:", first_line_with_code(file, function.line), ",", on_one_line(name));
  for (const auto& [name, function] : file.functions) {
    add_line(text, "FNDA:", function.count, ",", on_one_line(name));
    hit += function.count != 0;
  }
  add_line(text, "FNF:", file.functions.size());
  add_line(text, "FNH:", hit);
}

void add_branches(std::string& text, const FileCoverage& file) {
  std::size_t found = 0, hit = 0;
  for (const auto& [place, ways] : file.branches)
    for (std::size_t i = 0; i < ways.size(); ++i) {
      add_line(text, "BRDA:", place.first, ",", place.second, ",", i, ",", ways[i] ? std::to_string(*ways[i]) : "-");
      ++found;
      hit += ways[i].value_or(0) != 0;
    }
  add_line(text, "BRF:", found);
  add_line(text, "BRH:", hit);
}

void add_lines(std::string& text, const FileCoverage& file) {
  std::size_t hit = 0;
  for (const auto& [line, count] : file.lines) {
    add_line(text, "DA:", line, ",", count);
    hit += count != 0;
  }
  add_line(text, "LF:", file.lines.size());
  add_line(text, "LH:", hit);
}

}  // namespace

std::string to_lcov(const Coverage& coverage) {
  std::string text;
  for (const auto& [name, file] : coverage) {
    add_line(text, "TN:");
    add_line(text, "SF:", on_one_line(name));
    add_functions(text, file);
    add_branches(text, file);
    add_lines(text, file);
    add_line(text, "end_of_record");
  }
  return text;
}

}  // namespace vitrine::glass
