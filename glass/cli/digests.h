// Digests of device memory (glass/digest.h) of two runs of an application.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::glass::cli {

/// A command, and the allocations whose digests are others than before it.
struct DigestLine {
  std::uint64_t submission = 0;
  std::uint32_t command = 0;  ///< 0: what a submission begins with
  std::string name;
  std::vector<std::string> labels;
  std::string pipeline;
  std::map<std::uint64_t, std::string> memory;  ///< by number of the allocation
  std::optional<std::uint64_t> differs;         ///< the first byte that is another one in the run compared with
};
using Digests = std::vector<DigestLine>;

/// Nothing: it is no file of digests.
std::optional<Digests> read_digests(std::string_view text);

/// Where memory is first another one.
struct Parting {
  DigestLine point;
  std::uint64_t allocation = 0;
};
/// Commands are the same by their numbers; behind the end of the shorter run nothing is compared.
std::optional<Parting> first_parting(const Digests& before, const Digests& after);

}  // namespace vitrine::glass::cli
