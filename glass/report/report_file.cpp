// The file of a report: grows by one write for each group of findings.
#include "glass/report/report_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "glass/output.h"

namespace vitrine::glass {
namespace {

/// The application's own descriptor that a path names; -1: a file. Opened anew, a file behind it would have a position
/// of its own, and what others write to the descriptor would go over the report.
int standard_descriptor(std::string_view path) {
  return path == "/dev/stdout" ? STDOUT_FILENO : path == "/dev/stderr" ? STDERR_FILENO : -1;
}

/// A file that is open and locked.
class LockedFile {
 public:
  explicit LockedFile(const std::string& path) : standard_(standard_descriptor(path)) {
    file_ = standard_ >= 0 ? ::fcntl(standard_, F_DUPFD_CLOEXEC, 0)
                           : ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    while (standard_ < 0 && file_ >= 0 && ::flock(file_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;
  ~LockedFile() {
    if (file_ >= 0) ::close(file_);
  }

  bool is_open() const { return file_ >= 0; }
  /// Bytes; -1: it is no regular file, or not ours.
  off_t size() const {
    if (standard_ >= 0) return -1;
    struct stat status {};
    return ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode) ? status.st_size : -1;
  }
  bool holds(std::string_view text, off_t offset) const {
    std::string there(text.size(), '\0');
    return offset >= 0 && ::pread(file_, there.data(), there.size(), offset) == static_cast<ssize_t>(there.size()) &&
           there == text;
  }
  bool truncate(off_t size) { return ::ftruncate(file_, size) == 0; }
  /// At an offset; -1: to what cannot be sought (a terminal, a pipe), or where others write, too.
  bool write(std::string_view text, off_t offset) {
    while (!text.empty()) {
      const ssize_t written =
          offset < 0 ? ::write(file_, text.data(), text.size()) : ::pwrite(file_, text.data(), text.size(), offset);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(written));
      if (offset >= 0) offset += written;
    }
    return true;
  }

 private:
  int standard_, file_ = -1;
};

/// Where a document that grows ends; 0: the file is no such document.
off_t end_of_entries(const LockedFile& file, const ReportFrame& frame) {
  const off_t size = file.size(), closing = static_cast<off_t>(frame.closing.size());
  const bool ours = size >= static_cast<off_t>(frame.opening.size()) + closing && file.holds(frame.opening, 0) &&
                    file.holds(frame.closing, size - closing);
  return ours ? size - closing : 0;
}

}  // namespace

std::string report_path(std::string_view name) {
  std::string path;
  if (!name.starts_with('/')) {
    if (char* const folder = ::getcwd(nullptr, 0)) {
      (path = folder) += '/';
      std::free(folder);
    }
  }
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char next = name[i] == '%' && i + 1 < name.size() ? name[i + 1] : '\0';
    if (next == 'p')
      path += std::to_string(::getpid());
    else
      path += name[i];
    if (next == 'p' || next == '%') ++i;
  }
  return path;
}

ReportFile::ReportFile(std::string_view name)
    : path_(report_path(name)), format_(format_of(name)), frame_(report_frame(format_)) {
  write({});
}

void ReportFile::append(std::span<const Finding> findings) {
  const std::lock_guard lock(mutex_);
  if (good() && !findings.empty()) write(findings);
}

void ReportFile::write(std::span<const Finding> findings) {
  LockedFile file(path_);
  if (!file.is_open()) return fail(std::strerror(errno));
  if (file.size() < 0 && format_ != ReportFormat::kText) return fail("JSON and SARIF need a regular file");
  const off_t end = file.size() < 0 ? -1 : end_of_entries(file, frame_);
  const bool is_new = end == 0;
  std::string text = is_new ? frame_.opening : "";
  bool first = is_new || end == static_cast<off_t>(frame_.opening.size());
  for (const Finding& finding : findings) {
    if (!first) text += frame_.separator;
    text += report_entry(format_, finding);
    first = false;
  }
  text += frame_.closing;
  if (is_new && !file.truncate(0)) return fail(std::strerror(errno));
  if (file.write(text, end)) return;
  const int reason = errno;
  // What fits no more leaves the document as it was.
  if (end >= 0 && (!file.write(is_new ? "" : frame_.closing, end) ||
                   !file.truncate(is_new ? 0 : end + static_cast<off_t>(frame_.closing.size())))) {
    return fail("the disk is full and the report is cut off");
  }
  fail(std::strerror(reason));
}

void ReportFile::fail(std::string_view what) {
  error_ = "the report " + path_ + " cannot be written: " + std::string(what);
  complain(error_);
}

}  // namespace vitrine::glass
