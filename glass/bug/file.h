// Bug files: a Bug as bytes and back. The bytes are a gzip stream of a magic line, the length of a header, the header
// (JSON: members by name, blobs by their place) and the blobs; docs/glass/bugfile.md section 4.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

/// The file's contents. Throws std::bad_alloc.
std::string to_file(const Bug& bug);

/// The Bug in these contents, checked: the stream's length and sum, every number that names an object, every piece
/// of memory. A message if it is no bug file, of another version, truncated or altered. Never more memory than a
/// thousand times the file.
base::Result<Bug> from_file(std::string_view contents);

/// What is wrong with the numbers in it; empty: nothing.
std::string fault_of(const Bug& bug);
/// Its part that looks at numbers with a meaning (check_values.cpp): formats, enumerations, ranges of images. What
/// names others is right already.
std::string fault_of_values(const Bug& bug);

/// The header as JSON with indentation, for people: blobs by their place in the file.
std::string describe(const Bug& bug);

}  // namespace vitrine::glass::bug
