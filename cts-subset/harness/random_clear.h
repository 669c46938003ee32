// Clear values of random numbers.
#pragma once

#include "harness/graphics.h"
#include "harness/random.h"

namespace vitrine::cts {

/// Of a color: components in [0, 1), of which the last is drawn first.
inline VkClearValue random_clear(Random& random, VkFormat format, float alpha) {
  const float b = random.unit(), g = random.unit();
  return clear_value(format, random.unit(), g, b, alpha);
}
inline VkClearValue random_clear(Random& random, VkFormat format) {
  const float alpha = random.unit();
  return random_clear(random, format, alpha);
}

}  // namespace vitrine::cts
