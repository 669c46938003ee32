// The registry of cases.
#include "harness/case.h"

namespace vitrine::cts {
namespace {

/// The compiler names a file from the build folder on, or from "/" on.
std::string file_of(const std::string& path) {
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

AddCase::AddCase(const char* group, std::string name, std::function<void(Run&)> body, const char* file) {
  cases().push_back({group, std::move(name), std::move(body), {}, {}, 0, file_of(file)});
}

AddCase::AddCase(const char* group, std::string name, const char* deviation, DeviationCheck check,
                 std::function<void(Run&)> body, const char* file) {
  cases().push_back({group, std::move(name), std::move(body), deviation, std::move(check), 0, file_of(file)});
}

AddGenerator::AddGenerator(const char* group, const char* name, uint32_t count, std::function<void(Run&)> body,
                           const char* file) {
  generators().push_back({group, name, count, std::move(body), file_of(file)});
}

}  // namespace vitrine::cts
