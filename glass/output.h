// Files that tools write, where the person who asked for the tool said.
#pragma once

#include <string>
#include <string_view>

#include "spirv/source_info.h"

namespace vitrine::glass {

/// A line on stderr for somebody who has asked for a tool.
void complain(std::string_view text);

/// The file name that a variable of the environment gives, else `otherwise`; "%p" is the process's number.
std::string output_name(const char* variable, const char* otherwise);

/// Replaces that file by `text`. Complains where it cannot, once per file.
void write_output(const char* variable, const char* otherwise, std::string_view text);
/// The same with a name that stands already.
void write_named(const std::string& name, std::string_view text);

/// The path of a source file for reports: the file if it is there; else a copy of the text in the module, below the
/// folder VITRINE_SOURCES (default: vitrine-sources); empty: it has no name.
std::string name_of_source(const spirv::SourceFile& file);

}  // namespace vitrine::glass
