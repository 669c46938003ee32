// The list of expected findings (findings.txt).
#include "harness/findings.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "harness/options.h"

namespace vitrine::cts {
namespace {

struct Expected {
  std::string cases, rule;
};

std::vector<Expected> g_expected;

bool covers(const std::string& cases, const std::string& name) {
  if (!cases.ends_with('*')) return cases == name;
  return name.starts_with(std::string_view(cases).substr(0, cases.size() - 1));
}

}  // namespace

void load_expected_findings() {
  if (options().findings.empty()) return;
  std::ifstream file(options().findings);
  if (!file) throw std::runtime_error("cannot read " + options().findings);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    Expected expected;
    std::string reason;
    if (!(std::istringstream(line) >> expected.cases >> expected.rule >> reason))
      throw std::runtime_error(options().findings + ": no reason in \"" + line + "\"");
    g_expected.push_back(std::move(expected));
  }
}

std::string unexpected_findings(const std::string& name, std::span<const Finding> findings) {
  std::string text;
  if (options().findings.empty()) return text;
  for (const Finding& finding : findings) {
    const bool expected = std::any_of(g_expected.begin(), g_expected.end(), [&](const Expected& row) {
      return row.rule == finding.rule && covers(row.cases, name);
    });
    if (!expected) text += "  found: " + finding.message + "\n";
  }
  return text;
}

}  // namespace vitrine::cts
