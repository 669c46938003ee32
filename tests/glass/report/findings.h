// Findings that the tests of reports share.
#pragma once

#include "glass/finding.h"

namespace vitrine::glass {

/// Everything is known: a store in a function that main calls.
inline Finding whole_finding() {
  Finding finding;
  finding.rule = &rule("out-of-bounds-store");
  finding.message = "store of 4 bytes at offset 4096 of storage buffer 'particles' (4096 bytes)";
  finding.count = 128;
  finding.address = {1,  3, "vkCmdDispatch", {"frame", "blur"}, "gauss", "main", VK_SHADER_STAGE_COMPUTE_BIT, {},
                     42, {}};
  finding.address.invocation = {Invocation::Kind::kCompute, {5, 0, 0}};
  finding.address.frames = {{"put", "shaders/blur.comp", 12, 3, "\t\xc3\xa4[i] = x;"},
                            {"main", "shaders/blur.comp", 30, 5, "    put(i);"}};
  return finding;
}

/// Two accesses.
inline Finding race_finding() {
  Finding finding;
  finding.rule = &rule("race-shared");
  finding.message = "load of 4 bytes races";
  finding.address.invocation = {Invocation::Kind::kCompute, {2, 0, 0}};
  finding.address.frames = {{"main", "a.comp", 9, 0, "x = s[i ^ 1];"}};
  RelatedAccess other{"store of 4 bytes", finding.address};
  other.address.invocation.id = {3, 0, 0};
  other.address.frames[0].line = 8;
  other.address.frames[0].text = "s[i] = i;";
  finding.related.push_back(std::move(other));
  finding.remedy = "barrier(); between them";
  return finding;
}

/// Nothing but the rule is known.
inline Finding bare_finding() {
  Finding finding;
  finding.rule = &rule("endless-shader");
  finding.message = "more than 1000 instructions";
  return finding;
}

inline Finding note_finding() {
  Finding finding;
  finding.rule = &rule("printf");
  finding.message = "x = 3";
  finding.address.frames = {{"main", "a.comp", 7, 0, ""}};
  return finding;
}

}  // namespace vitrine::glass
