// See output.h.
#include "glass/output.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

namespace vitrine::glass {
namespace {

/// Empty: done; else why not.
using Failure = std::string;

Failure write_file(const std::string& name, std::string_view text) {
  std::FILE* const file = std::fopen(name.c_str(), "wbe");
  if (file == nullptr) return std::strerror(errno);
  const bool whole = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const int reason = errno;
  const bool closed = std::fclose(file) == 0;  // writes what is left
  if (whole && closed) return {};
  return std::strerror(whole ? errno : reason);
}

/// Writes beside the file and renames, so that whoever reads it sees all or nothing. What is no file (a device, a pipe)
/// stays what it is: it is written to.
Failure replace_file(const std::string& name, std::string_view text) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(name, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return write_file(name, text);
  const std::string beside = name + ".part" + std::to_string(getpid());
  Failure failure = write_file(beside, text);
  if (failure.empty()) {
    std::filesystem::rename(beside, name, error);
    if (!error) return {};
    failure = error.message();
  }
  std::filesystem::remove(beside, error);
  return failure;
}

/// FNV-1a: different texts of one name go to different folders.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

void complain_once(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string>& said =
      *new std::set<std::string>;  // the session's destructor writes, and is among the last
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
  const Failure failure = replace_file(name, text);
  if (!failure.empty()) complain_once(std::string(variable) + ": '" + name + "' cannot be written: " + failure);
}

void write_named(const std::string& name, std::string_view text) {
  const Failure failure = replace_file(name, text);
  if (!failure.empty()) complain_once("'" + name + "' cannot be written: " + failure);
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
  return replace_file(name, file.text).empty() ? name : file.name;
}

}  // namespace vitrine::glass
