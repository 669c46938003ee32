// The one JSON shape of addresses (glass.md section 2), for the formats that contain it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "glass/finding.h"

namespace vitrine::glass {

/// Everything that is known of it; what is unknown is left out.
nlohmann::ordered_json to_json(const Address& address);

/// On one line; bytes that are not UTF-8 are replaced.
std::string to_line(const nlohmann::ordered_json& json);

/// How kinds of invocations are called, and how many of the numbers they have.
struct InvocationName {
  const char* name;
  std::size_t numbers;
};
InvocationName invocation_name(Invocation::Kind kind);

}  // namespace vitrine::glass
