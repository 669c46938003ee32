// The registry of cases.
#include "harness/case.h"

namespace vitrine::cts {
namespace {

/// The compiler names a file from the build folder on, or from "/" on.
std::string file_of(const std::source_location& where) {
  const std::string path = where.file_name();
  const size_t start = path.rfind("cts-subset/");
  return start == std::string::npos ? path : path.substr(start);
}

}  // namespace

std::vector<Case>& cases() {
  static std::vector<Case> list;
  return list;
}

std::vector<Generator>& generators() {
  static std::vector<Generator> list;
  return list;
}

AddCase::AddCase(const char* group, std::string name, std::function<void(Run&)> body, std::source_location where) {
  cases().push_back({group, std::move(name), std::move(body), {}, {}, 0, file_of(where)});
}

AddCase::AddCase(const char* group, std::string name, const char* deviation, DeviationCheck check,
                 std::function<void(Run&)> body, std::source_location where) {
  cases().push_back({group, std::move(name), std::move(body), deviation, std::move(check), 0, file_of(where)});
}

AddGenerator::AddGenerator(const char* group, const char* name, uint32_t count, std::function<void(Run&)> body,
                           std::source_location where) {
  generators().push_back({group, name, count, std::move(body), file_of(where)});
}

}  // namespace vitrine::cts
