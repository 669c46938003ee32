// Files of the command: a folder for what the processes of an application write, whole files read and written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::glass::cli {

/// A folder that is gone when this is.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  /// Empty: none could be made.
  const std::filesystem::path& path() const { return path_; }
  /// Files whose names end so, by the numbers of the processes in their names.
  std::vector<std::filesystem::path> files(std::string_view extension) const;

 private:
  std::filesystem::path path_;
};

/// The whole file; nothing: it cannot be read.
std::optional<std::string> read_file(const std::filesystem::path& path);

/// Replaces the file, or says why not (and gives false).
bool write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace vitrine::glass::cli
