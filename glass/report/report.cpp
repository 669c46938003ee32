// Which format a report has, and its documents as a whole.
#include "glass/report/report.h"

namespace vitrine::glass {

ReportFormat format_of(std::string_view file_name) {
  if (file_name.ends_with(".sarif") || file_name.ends_with(".sarif.json")) return ReportFormat::kSarif;
  return file_name.ends_with(".json") ? ReportFormat::kJson : ReportFormat::kText;
}

ReportFrame report_frame(ReportFormat format) {
  switch (format) {
    case ReportFormat::kText:
      return {};
    case ReportFormat::kJson:
      return json_frame();
    case ReportFormat::kSarif:
      return sarif_frame();
  }
  return {};
}

std::string report_entry(ReportFormat format, const Finding& finding) {
  switch (format) {
    case ReportFormat::kText:
      return text_entry(finding);
    case ReportFormat::kJson:
      return json_entry(finding);
    case ReportFormat::kSarif:
      return sarif_entry(finding);
  }
  return {};
}

std::string to_report(ReportFormat format, std::span<const Finding> findings) {
  const ReportFrame frame = report_frame(format);
  std::string text = frame.opening;
  for (const Finding& finding : findings) {
    if (&finding != findings.data()) text += frame.separator;
    text += report_entry(format, finding);
  }
  return text + frame.closing;
}

}  // namespace vitrine::glass
