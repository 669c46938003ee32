// See output.h.
#include "glass/output.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>

#include "base/lasting.h"

namespace vitrine::glass {
namespace {

/// Writes beside the file and renames, so that whoever reads it sees all or nothing.
bool replace_file(const std::string& name, std::string_view text) {
  const std::string beside = name + ".part" + std::to_string(getpid());
  {
    std::ofstream file(beside, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.flush();
    if (!file) return false;
  }
  std::error_code error;
  std::filesystem::rename(beside, name, error);
  return !error;
}

/// FNV-1a: different texts of one name go to different folders.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

void complain_once(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string>& said = base::lasting([] { return std::set<std::string>(); });
  const std::lock_guard lock(mutex);
  if (said.insert(text).second) complain(text);
}

}  // namespace

void complain(std::string_view text) {
  std::fprintf(stderr, "vitrine: %.*s\n", static_cast<int>(text.size()), text.data());
}

std::string output_name(const char* variable, const char* otherwise) {
  const char* value = std::getenv(variable);
  std::string name = value != nullptr && *value != 0 ? value : otherwise;
  const std::size_t at = name.find("%p");
  if (at != std::string::npos) name.replace(at, 2, std::to_string(getpid()));
  return name;
}

void write_output(const char* variable, const char* otherwise, std::string_view text) {
  const std::string name = output_name(variable, otherwise);
  if (!replace_file(name, text)) complain_once(std::string(variable) + ": '" + name + "' cannot be written");
}

std::string name_of_source(const spirv::SourceFile& file) {
  std::error_code error;
  if (file.name.empty() || std::filesystem::exists(file.name, error)) return file.name;
  if (file.text.empty()) return file.name;
  char number[20];
  std::snprintf(number, sizeof number, "%016llx", static_cast<unsigned long long>(hash_of(file.text)));
  const std::filesystem::path folder =
      std::filesystem::path(output_name("VITRINE_SOURCES", "vitrine-sources")) / number;
  const std::string name = (folder / std::filesystem::path(file.name).filename()).string();
  if (std::filesystem::exists(name, error)) return name;
  std::filesystem::create_directories(folder, error);
  return replace_file(name, file.text) ? name : file.name;
}

}  // namespace vitrine::glass
