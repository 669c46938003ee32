// Mutation of what readers read.
#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/random.h"

namespace vitrine::fuzz {

/// Changes the text in one to four places: bytes, pieces that are lost, repeated, or of a text of the pool, what
/// readers look for, and numbers that they do not expect. An empty text stays.
void mutate_text(std::string& text, const std::vector<std::string>& pool, Random& random);

}  // namespace vitrine::fuzz
