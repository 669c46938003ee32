// Reads lcov tracefiles: SF names a file, FN, FNDA, DA and BRDA are added to what is known of it, totals are counted
// anew.
#include "glass/cli/tracefiles.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace vitrine::glass::cli {
namespace {

/// The next part of a comma-separated list; the last one has the commas of its own.
class Fields {
 public:
  explicit Fields(std::string_view text) : rest_(text) {}

  std::string_view text(bool last = false) {
    const std::size_t end = last ? rest_.size() : std::min(rest_.find(','), rest_.size());
    const std::string_view field = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return field;
  }
  template <class Number>
  bool number(Number& value, bool last = false) {
    const std::string_view field = text(last);
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    return error == std::errc() && end == field.data() + field.size();
  }

 private:
  std::string_view rest_;
};

constexpr std::size_t kMostBranches = 100000;  // of one place: what lies must not exhaust memory

bool add_function(Fields fields, FileCoverage& file) {
  std::uint32_t line = 0;
  if (!fields.number(line)) return false;
  file.functions[std::string(fields.text(true))].line = line;
  return true;
}

bool add_function_count(Fields fields, FileCoverage& file) {
  std::uint64_t count = 0;
  if (!fields.number(count)) return false;
  file.functions[std::string(fields.text(true))].count += count;
  return true;
}

/// A checksum may follow the count.
bool add_line(Fields fields, FileCoverage& file) {
  std::uint32_t line = 0;
  std::uint64_t count = 0;
  if (!fields.number(line) || !fields.number(count)) return false;
  file.lines[line] += count;
  return true;
}

bool add_branch(Fields fields, FileCoverage& file) {
  std::uint32_t line = 0, block = 0;
  std::size_t way = 0;
  if (!fields.number(line) || !fields.number(block) || !fields.number(way) || way >= kMostBranches) return false;
  auto& ways = file.branches[{line, block}];
  ways.resize(std::max(ways.size(), way + 1));
  const std::string_view taken = fields.text(true);
  if (taken == "-") return true;
  std::uint64_t count = 0;
  if (!Fields(taken).number(count, true)) return false;
  ways[way] = ways[way].value_or(0) + count;
  return true;
}

struct Record {
  std::string_view name;
  bool (*add)(Fields, FileCoverage&);
};
constexpr std::array kRecords = {Record{"FN", add_function}, Record{"FNDA", add_function_count}, Record{"DA", add_line},
                                 Record{"BRDA", add_branch}};
constexpr std::array<std::string_view, 8> kSkipped = {"TN", "FNF", "FNH", "LF", "LH", "BRF", "BRH", "VER"};

bool add_record(std::string_view line, Coverage& coverage, FileCoverage*& file) {
  if (line.empty()) return true;
  if (line == "end_of_record") {
    file = nullptr;
    return true;
  }
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return false;
  const std::string_view name = line.substr(0, colon), value = line.substr(colon + 1);
  if (name == "SF") {
    file = &coverage[std::string(value)];
    return true;
  }
  const auto record =
      std::find_if(kRecords.begin(), kRecords.end(), [&](const Record& row) { return row.name == name; });
  if (record != kRecords.end()) return file && record->add(Fields(value), *file);
  return std::find(kSkipped.begin(), kSkipped.end(), name) != kSkipped.end();
}

void count(CoverageSummary::Part& part, bool hit) {
  ++part.found;
  part.hit += hit;
}

}  // namespace

bool add_tracefile(std::string_view text, Coverage& coverage, std::string& error) {
  FileCoverage* file = nullptr;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (!add_record(text.substr(0, end), coverage, file)) {
      error = "line " + std::to_string(number) + " is none of a tracefile";
      return false;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return true;
}

CoverageSummary summary_of(const Coverage& coverage) {
  CoverageSummary summary;
  for (const auto& [name, file] : coverage) {
    for (const auto& [line, times] : file.lines) count(summary.lines, times != 0);
    for (const auto& [function, data] : file.functions) count(summary.functions, data.count != 0);
    for (const auto& [place, ways] : file.branches) {
      for (const auto& way : ways) count(summary.branches, way.value_or(0) != 0);
    }
  }
  return summary;
}

}  // namespace vitrine::glass::cli
