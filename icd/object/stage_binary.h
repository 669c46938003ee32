// A stage as 32-bit words that applications keep and give back: binaries of shader objects and of pipelines. It is the
// stage as the application gave it, because compiling takes less than reading anything else would.
#pragma once

#include "icd/object/kept_stage.h"

namespace vitrine::icd {

/// Whose binary it is: none of another format is read.
struct BinaryFormat {
  const std::uint8_t* uuid;  ///< VK_UUID_SIZE bytes
  std::uint32_t version;
};

/// Equal for equal stages, in every process.
Vector<std::uint32_t> stage_binary(const KeptStage& stage, const BinaryFormat& format);
std::size_t stage_binary_bytes(const KeptStage& stage);

/// Reads such a binary again, which nobody has to have left as it was. Null, or why it is refused: "…it is damaged".
const char* read_stage_binary(const void* data, std::size_t bytes, const BinaryFormat& format, KeptStage& out);

}  // namespace vitrine::icd
