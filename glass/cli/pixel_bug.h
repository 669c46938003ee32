// A pixel's value as a bug file.
#pragma once

#include <string>

#include "glass/cli/commands.h"
#include "glass/cli/pixel_history.h"

namespace vitrine::glass::cli {

/// Runs the application once more and writes what made the value of the story's pixel. False, after saying why: it
/// cannot.
bool write_maker(const PixelStory& story, const CommandLine& application, const std::string& file);

}  // namespace vitrine::glass::cli
