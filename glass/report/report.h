// Findings as a document: for people (text), for code hosts (SARIF 2.1.0), for scripts (JSON; docs/glass/report.md
// tells of all three). A document is an opening, entries with separators between them and a closing, so that it can
// grow at its end and be complete at every moment. Nothing here opens a file: report_file.h does.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "glass/report/formats.h"

namespace vitrine::glass {

enum class ReportFormat : std::uint8_t { kText, kJson, kSarif };

/// By the end of the name: ".sarif", ".json" (but ".sarif.json" is SARIF), else text.
ReportFormat format_of(std::string_view file_name);

ReportFrame report_frame(ReportFormat format);
/// One finding, without what surrounds it.
std::string report_entry(ReportFormat format, const Finding& finding);

/// A whole document.
std::string to_report(ReportFormat format, std::span<const Finding> findings);

}  // namespace vitrine::glass
