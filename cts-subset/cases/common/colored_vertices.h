// Random vertices for the harness's kColorVertex.
#pragma once

#include <cstdint>
#include <vector>

#include "harness/random.h"

namespace vitrine::cts {

/// `count` vertices of a position (x, y a little beyond the view volume, z inside it, w = 1) and a colour in [0, 1].
inline std::vector<float> random_colored_vertices(Random& random, uint32_t count) {
  std::vector<float> values;
  values.reserve(size_t{count} * 8);
  for (uint32_t i = 0; i < count; ++i) {
    for (const float v : {random.real(-1.2f, 1.2f), random.real(-1.2f, 1.2f), random.unit(), 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  return values;
}

}  // namespace vitrine::cts
