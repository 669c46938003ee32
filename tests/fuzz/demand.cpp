// See demand.h.
#include "tests/fuzz/demand.h"

#include <cstdio>
#include <cstdlib>

namespace vitrine::fuzz {

void demand(bool condition, const std::string& what) {
  if (condition) return;
  std::fprintf(stderr, "failed: %s\n", what.c_str());
  std::abort();
}

}  // namespace vitrine::fuzz
