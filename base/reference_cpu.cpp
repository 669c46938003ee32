// Reads what the environment asks for, once.
#include "base/reference_cpu.h"

#include <cstdlib>
#include <string_view>

namespace vitrine::base {

bool reference_lacks_avx512() {
  static const bool lacks = [] {
    const char* value = std::getenv("VITRINE_REFERENCE_CPU");
    return value != nullptr && std::string_view(value) == "avx2";
  }();
  return lacks;
}

}  // namespace vitrine::base
