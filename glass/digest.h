// What device memory holds after every command, as one number an allocation: two runs are told apart at the command
// where their memory parts (docs/glass/shake.md). Commands are then done one after the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "glass/finding.h"

namespace vitrine::glass {

/// Whether somebody asked for digests.
bool has_digest();

/// An allocation has been made, or ends. Any thread.
void add_digested(const std::byte* data, std::uint64_t size) noexcept;
void remove_digested(const std::byte* data) noexcept;

/// Where memory differs from that of the run that this one is compared with.
struct Difference {
  const std::byte* at = nullptr;
  std::uint64_t offset = 0, differing = 0;  ///< in the allocation; bytes of it
  std::array<std::uint8_t, 4> here{}, there{};
};

/// Writes a line to VITRINE_DIGEST. If VITRINE_DIGEST_AT names this command ("SUBMISSION:COMMAND:ALLOCATION:OFFSET"),
/// the bytes of that allocation go to VITRINE_DIGEST_SAVE, or are compared with those in VITRINE_DIGEST_COMPARE.
/// `point`: the command that is done; number 0: the submission begins.
std::optional<Difference> digest_command(const Address& point);

/// The word that VITRINE_DIGEST_AT names, while that command runs; nothing: another one does.
struct DigestWord {
  const std::byte* at = nullptr;
};
std::optional<DigestWord> watched_word(std::uint64_t submission, std::uint32_t command);

/// A finding: `what` says what the byte belongs to.
void report_difference(const Address& point, const Difference& difference, const std::string& what);

}  // namespace vitrine::glass
