// Findings of several processes: read from their reports, the same ones made one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "glass/finding.h"

namespace vitrine::glass::cli {

/// Of the shape that to_json(Address) has (glass/report/json.h). Throws for what is none.
Address address_of(const nlohmann::json& json);

/// The findings of a JSON report, in its order. False, and why: it is none, or one of another version.
bool read_findings(std::string_view report, std::vector<Finding>& findings, std::string& error);

/// Findings that say the same of the same place become the first of them, with the sum of their counts. What shaders
/// say (Severity::kNote) stays as it is.
std::vector<Finding> folded(std::vector<Finding> findings);

/// Lines that the modules do not have, from the source files that they name, as far as they are there.
void quote_files(std::vector<Finding>& findings);

/// Files for reports; empty: none.
struct ReportFiles {
  std::string sarif, json, code_quality;
};

/// Writes them to the files that are named, or says why not (and gives false). What code hosts read (SARIF, code
/// quality) has paths of the repository.
bool write_reports(const ReportFiles& files, const std::vector<Finding>& findings);

}  // namespace vitrine::glass::cli
