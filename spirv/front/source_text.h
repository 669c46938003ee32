// The texts of a module's source files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "spirv/front/debug_info.h"
#include "spirv/front/source_tables.h"

namespace vitrine::spirv::front {

/// Fills SourceFile::text from DebugSource and OpSource and their continuations.
void read_texts(const Module& module, SourceTables& tables, DebugInfo& debug);

struct Disassembly {
  std::string text;                  ///< as `spirv-dis --raw-id` prints it
  std::vector<std::uint32_t> lines;  ///< of each instruction; empty: there is no text
};
/// Of a module of `instructions` instructions.
Disassembly disassemble(std::span<const std::uint32_t> words, std::size_t instructions);

}  // namespace vitrine::spirv::front
