// Bytes as a gzip stream, through zlib.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace vitrine::glass::bug {

std::string pack(std::string_view bytes);
/// A message where it is none, ends early, goes on behind its end, or does not have the sum that it says.
base::Result<std::string> unpack(std::string_view stream);

}  // namespace vitrine::glass::bug
