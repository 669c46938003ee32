// Reads what the environment asks for, once.
#include "base/as_reference.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "base/lasting.h"
#include "base/words.h"

namespace vitrine::base {
namespace {

constexpr std::string_view kRows[] = {
#define VITRINE_DEVIATION(name, row) row,
#include "base/as_reference.def"
#undef VITRINE_DEVIATION
};
static_assert(std::size(kRows) <= 64);

}  // namespace

bool AskedRows::has(std::string_view row) const {
  const auto* const found = std::find(std::begin(kRows), std::end(kRows), row);
  return found != std::end(kRows) && (rows >> (found - kRows) & 1) != 0;
}

AskedRows parse_rows(std::string_view list) {
  AskedRows asked;
  for_each_word(list, [&](std::string_view name) {
    const auto* const found = std::find(std::begin(kRows), std::end(kRows), name);
    if (name == "all")
      asked.rows = ~std::uint64_t{0} >> (64 - std::size(kRows));
    else if (found != std::end(kRows))
      asked.rows |= std::uint64_t{1} << (found - kRows);
    else
      asked.unknown.emplace_back(name);
  });
  return asked;
}

const AskedRows& asked_rows() {
  static const AskedRows& asked = lasting([] {
    const char* value = std::getenv("VITRINE_AS_REFERENCE");
    return parse_rows(value != nullptr ? value : "");
  });
  return asked;
}

std::string names_of_rows() {
  std::string names;
  for (const std::string_view row : kRows) names.append(names.empty() ? "" : ", ").append(row);
  return names;
}

}  // namespace vitrine::base
