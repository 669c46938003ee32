// What SARIF demands of names, columns and addresses of files.
#pragma once

#include <string>

#include "glass/finding.h"

namespace vitrine::glass {

/// "vitrine/out-of-bounds-store".
std::string sarif_rule_id(const Rule& rule);
/// "OutOfBoundsStore".
std::string sarif_rule_name(const Rule& rule);

/// The file as a reference (RFC 3986): relative names stay relative, absolute ones become file:///...
std::string sarif_uri(std::string_view file);

/// The column in code points where the line is known (compilers of shaders count bytes); 0: unknown.
std::size_t sarif_column(const Frame& frame);

/// Says whether two results of different runs are the same one: rule, shader, file, function and the text of the line,
/// so that lines which move do not matter; their number where the text is unknown.
std::string sarif_fingerprint(const Finding& finding);

}  // namespace vitrine::glass
