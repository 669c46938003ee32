// What a wave writes to memory and images, before it does so: to be taken back, and compared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/function_ref.h"
#include "spirv/program.h"

namespace vitrine::glass::debug {

/// Bytes that one lane writes, or several whose numbers follow each other, `lane_bytes` each, the last one perhaps
/// less.
struct Written {
  std::byte* at = nullptr;
  std::uint32_t bytes = 0;
  std::uint32_t lane = 0, lane_bytes = 1;
};

/// Calls f for the memory that an instruction of Interest::accesses is about to write. Nothing where it only reads.
/// Texels of compressed or planar images are left out: nothing stores to them.
void for_each_written(const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note,
                      base::FunctionRef<void(const Written&)> f);

/// Writes of one run of a wave.
class StoreLog {
 public:
  /// These bytes are about to be written.
  void keep(std::byte* at, std::uint32_t bytes);
  /// Memory is as it was before all of them; what they left there is kept.
  void take_back();
  /// Behind take_back(), when somebody else has written the same: words that are not what they were.
  struct Difference {
    std::size_t words = 0;
    std::uint32_t there = 0, kept = 0;  ///< of the first of them
  };
  std::optional<Difference> compare() const;
  void clear();

 private:
  struct Piece {
    std::byte* at = nullptr;
    std::uint32_t bytes = 0;
    std::size_t first = 0;  ///< in the vectors
  };
  std::vector<Piece> pieces_;
  std::vector<std::byte> before_, after_;
};

}  // namespace vitrine::glass::debug
