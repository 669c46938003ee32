// The registry of cases: a case is a function that runs once per device, and what it puts out is compared.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vitrine::cts {

class Run;
struct Output;

/// Judges a listed deviation: both devices' outputs in, a message out; empty = they differ exactly as the row says.
using DeviationCheck =
    std::function<std::string(const std::vector<Output>& device, const std::vector<Output>& reference)>;

struct Case {
  std::string group;  ///< the CTS's name of the group
  std::string name;   ///< unique in the group
  std::function<void(Run&)> body;
  std::string deviation;  ///< row id in deviations.md; empty for a case that must be identical
  DeviationCheck check;   ///< only with a deviation
  uint32_t index = 0;     ///< number within its random generator
  std::string file = {};  ///< that defines it, from the root of the tree on
};

/// A family of random cases: `body` is run `count` times with seeds derived from the suite's seed, name and number.
struct Generator {
  std::string group, name;
  uint32_t count;
  std::function<void(Run&)> body;
  std::string file;
};

std::vector<Case>& cases();
std::vector<Generator>& generators();

/// Static registration objects; a case file defines one per case. (Clang 14, Debian 12's, has no std::source_location.)
struct AddCase {
  AddCase(const char* group, std::string name, std::function<void(Run&)> body, const char* file = __builtin_FILE());
  /// A listed deviation: the outputs must differ, exactly as `check` says.
  AddCase(const char* group, std::string name, const char* deviation, DeviationCheck check,
          std::function<void(Run&)> body, const char* file = __builtin_FILE());
};
struct AddGenerator {
  AddGenerator(const char* group, const char* name, uint32_t count, std::function<void(Run&)> body,
               const char* file = __builtin_FILE());
};

}  // namespace vitrine::cts

#define CTS_CONCAT_(a, b) a##b
#define CTS_CONCAT(a, b) CTS_CONCAT_(a, b)
/// CTS_CASE("draw", "triangle_list") { ...uses run... }
#define CTS_CASE(group, name)                                                                                      \
  static void CTS_CONCAT(case_body_, __LINE__)(::vitrine::cts::Run & run);                                         \
  static const ::vitrine::cts::AddCase CTS_CONCAT(case_, __LINE__)(group, name, CTS_CONCAT(case_body_, __LINE__)); \
  static void CTS_CONCAT(case_body_, __LINE__)(::vitrine::cts::Run & run)
/// CTS_RANDOM("rasterization", "random_triangles", 300) { ...uses run.random... }
#define CTS_RANDOM(group, name, count)                                                                     \
  static void CTS_CONCAT(case_body_, __LINE__)(::vitrine::cts::Run & run);                                 \
  static const ::vitrine::cts::AddGenerator CTS_CONCAT(case_, __LINE__)(group, name, count,                \
                                                                        CTS_CONCAT(case_body_, __LINE__)); \
  static void CTS_CONCAT(case_body_, __LINE__)(::vitrine::cts::Run & run)
