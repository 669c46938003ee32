// Where the reference contradicts the specification this device follows the specification (design.md section 8), unless
// somebody who has pictures of the reference asks for its way, row by row of cts-subset/deviations.md:
// VITRINE_AS_REFERENCE=point-clipping,multiview-layers, or all. What follows from neighbours or from memory that nobody
// has written cannot be asked for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::base {

/// The rows that can be asked for.
enum class Deviation : std::uint8_t {
#define VITRINE_DEVIATION(name, row) k##name,
#include "base/as_reference.def"
#undef VITRINE_DEVIATION
};

/// What a list of rows asks for.
struct AskedRows {
  std::uint64_t rows = 0;            ///< a bit per Deviation
  std::vector<std::string> unknown;  ///< names of the list that are no row to be asked for
  bool has(Deviation row) const { return (rows >> static_cast<unsigned>(row) & 1) != 0; }
  /// By its name in the table; false for those that cannot be asked for.
  bool has(std::string_view row) const;
};

/// Reads names separated by commas; `all` is every row.
AskedRows parse_rows(std::string_view list);

/// What VITRINE_AS_REFERENCE asks for, read once in the process. Draws ask when they are planned, shaders when they are
/// compiled: never pixel by pixel.
const AskedRows& asked_rows();
inline bool as_reference(Deviation row) { return asked_rows().has(row); }

/// "point-clipping, …": what can be asked for.
std::string names_of_rows();

}  // namespace vitrine::base
