// The report that VITRINE_REPORT names, in the format of its name's end. The file is a whole document after every
// append(), also when the process dies before the next one, and also when several processes write into it: each
// append is one write under a lock of the file. A report of the same version that is there grows; anything else is
// replaced (text files grow).
#pragma once

#include <mutex>
#include <span>
#include <string>
#include <string_view>

#include "glass/report/report.h"

namespace vitrine::glass {

/// The name with %p as the number of this process and %% as %; absolute.
std::string report_path(std::string_view name);

class ReportFile {
 public:
  /// Makes the file. One that cannot be written is said once (complain()); append() then does nothing.
  explicit ReportFile(std::string_view name);

  /// Threads may call it at the same time.
  void append(std::span<const Finding> findings);

  bool good() const { return error_.empty(); }
  const std::string& error() const { return error_; }

 private:
  void write(std::span<const Finding> findings);
  void fail(std::string_view what);

  std::string path_;
  ReportFormat format_;
  ReportFrame frame_;
  std::string error_;
  std::mutex mutex_;
};

}  // namespace vitrine::glass
