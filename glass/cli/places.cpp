// See places.h.
#include "glass/cli/places.h"

#include <algorithm>

namespace vitrine::glass::cli {
namespace fs = std::filesystem;
namespace {

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Without the steps upwards that it begins with.
fs::path without_steps(const fs::path& path) {
  fs::path rest;
  for (const fs::path& part : path) {
    if (!rest.empty() || part != "..") rest /= part;
  }
  return rest;
}

/// Empty: it does not lie below the root.
std::string below(const fs::path& root, const fs::path& path) {
  const fs::path relative = path.lexically_normal().lexically_relative(root);
  return relative.empty() || *relative.begin() == ".." ? "" : relative.string();
}

}  // namespace

fs::path repository_root(const fs::path& folder) {
  std::error_code error;
  for (fs::path root = folder;; root = root.parent_path()) {
    if (fs::exists(root / ".git", error)) return root;
    if (root == root.parent_path()) return folder;
  }
}

std::string path_in_repository(const std::string& file, const fs::path& root, const fs::path& folder) {
  const fs::path path = fs::path(file).lexically_normal();
  if (file.empty()) return file;
  fs::path found = path;
  if (path.is_relative()) {
    const fs::path rest = without_steps(path);
    const fs::path places[] = {folder / path, root / rest, folder / rest};
    const auto place = std::find_if(std::begin(places), std::end(places), is_file);
    if (place == std::end(places)) return file;
    found = *place;
  }
  const std::string inside = below(root, found);
  return inside.empty() ? file : inside;
}

std::vector<Finding> in_repository(std::vector<Finding> findings) {
  std::error_code error;
  const fs::path folder = fs::current_path(error), root = repository_root(folder);
  const auto place = [&](Address& address) {
    for (Frame& frame : address.frames) frame.file = path_in_repository(frame.file, root, folder);
  };
  for (Finding& finding : findings) {
    place(finding.address);
    for (RelatedAccess& other : finding.related) place(other.address);
  }
  return findings;
}

bool any_in_disassembly(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    if (finding.address.frames.empty()) return false;
    const std::string& file = finding.address.frames[0].file;
    return file.ends_with(".spvasm") && !is_file(file);
  });
}

}  // namespace vitrine::glass::cli
