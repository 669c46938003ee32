// Which source place each instruction of a module has, and the texts of its files.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "spirv/front/module.h"

namespace vitrine::spirv::front {

/// Whether somebody looks at the sources: then their texts are kept, and a module that tells of no line has its
/// disassembly as its source.
enum class SourceTexts : bool { kDrop, kKeep };

/// Fills module.sources and the place and line of every instruction, from OpLine or NonSemantic.Shader.DebugInfo.100.
/// `words`: the module. Never fails: debug instructions that make no sense leave places unknown.
void read_sources(Module& module, std::span<const std::uint32_t> words, const std::string& entry_point,
                  SourceTexts texts);

}  // namespace vitrine::spirv::front
