// Modules of others: every .spv file below the folder that CTS_MODULES names becomes a case (run_module.cpp).
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "cases/modules/run_module.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

const bool kCases = [] {
  const char* const folder = std::getenv("CTS_MODULES");
  if (folder == nullptr) return false;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".spv") continue;
    std::string name = std::filesystem::relative(entry.path(), folder).string();
    for (char& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    AddCase("modules", name, [path = entry.path()](Run& run) { run_module(run, path); });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
