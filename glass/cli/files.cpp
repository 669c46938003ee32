// Files of the command.
#include "glass/cli/files.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  std::string name = (error ? fs::path("/tmp") : parent) / "vitrine-XXXXXX";
  if (::mkdtemp(name.data()))
    path_ = name;
  else
    say("no temporary folder can be made: " + name + ": " + std::strerror(errno));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
}

std::vector<fs::path> TemporaryFolder::files(std::string_view extension) const {
  std::vector<fs::path> result;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, error)) {
    if (entry.path().extension() == extension) result.push_back(entry.path());
  }
  const auto key = [](const fs::path& path) {
    return std::pair(std::strtoull(path.stem().c_str(), nullptr, 10), path.string());
  };
  std::sort(result.begin(), result.end(), [&](const fs::path& a, const fs::path& b) { return key(a) < key(b); });
  return result;
}

std::optional<std::string> read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::string text{std::istreambuf_iterator<char>(file), {}};
  return file.bad() ? std::nullopt : std::optional(std::move(text));
}

bool write_file(const fs::path& path, std::string_view text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (file) return true;
  say(path.string() + " cannot be written: " + std::strerror(errno));
  return false;
}

}  // namespace vitrine::glass::cli
