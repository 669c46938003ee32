// One format a file: what report.h chooses from.
#pragma once

#include <string>

#include "glass/finding.h"

namespace vitrine::glass {

/// What all documents of a format have in common.
struct ReportFrame {
  std::string opening, separator, closing;
};

std::string text_entry(const Finding& finding);

ReportFrame json_frame();
std::string json_entry(const Finding& finding);

ReportFrame sarif_frame();
std::string sarif_entry(const Finding& finding);

}  // namespace vitrine::glass
