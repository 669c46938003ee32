// The registry of cases.
#include "harness/case.h"

namespace vitrine::cts {

std::vector<Case>& cases() {
  static std::vector<Case> list;
  return list;
}

std::vector<Generator>& generators() {
  static std::vector<Generator> list;
  return list;
}

AddCase::AddCase(const char* group, std::string name, std::function<void(Run&)> body) {
  cases().push_back({group, std::move(name), std::move(body), {}, {}, 0});
}

AddCase::AddCase(const char* group, std::string name, const char* deviation, DeviationCheck check,
                 std::function<void(Run&)> body) {
  cases().push_back({group, std::move(name), std::move(body), deviation, std::move(check), 0});
}

AddGenerator::AddGenerator(const char* group, const char* name, uint32_t count, std::function<void(Run&)> body) {
  generators().push_back({group, name, count, std::move(body)});
}

}  // namespace vitrine::cts
