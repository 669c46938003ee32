// What the command itself says: lines on stderr, so that the application's output stays as it is.
#pragma once

#include <cstdio>
#include <string>

namespace vitrine::glass::cli {

inline void say(const std::string& text) { std::fprintf(stderr, "vitrine: %s\n", text.c_str()); }

}  // namespace vitrine::glass::cli
