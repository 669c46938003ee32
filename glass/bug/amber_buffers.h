// Buffers in AmberScript: those of the file by their numbers, inline uniform blocks, push constants, and views of texel
// buffers that show a part of a buffer or show it in one of several formats, which are buffers of their own.
#pragma once

#include <ostream>
#include <string>

#include "glass/bug/amber_images.h"

namespace vitrine::glass::bug {

/// BUFFER lines, with what is expected behind the command. Throws Unspeakable.
void write_buffers(std::ostream& out, const Bug& bug);
/// EXPECT lines.
void write_expectations_of_buffers(std::ostream& out, const Bug& bug);
/// What a descriptor binds; empty: it is no buffer.
std::string buffer_name(const Bug& bug, const Descriptor& descriptor);

}  // namespace vitrine::glass::bug
