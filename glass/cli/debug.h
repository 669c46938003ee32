// What the two faces of vitrine debug share.
#pragma once

#include <filesystem>
#include <functional>
#include <thread>

#include "glass/cli/commands.h"
#include "glass/cli/process.h"

namespace vitrine::glass::cli {

/// A thread that gets no signals.
std::thread quiet_thread(std::function<void()> work);
/// Of an application whose driver connects to this socket. One thread draws, so that every run is the same.
Environment debug_environment(const std::filesystem::path& socket, const DebugOptions& options);
/// The face for editors (debug_adapter.cpp).
int debug_with_editor(const DebugOptions& options);

}  // namespace vitrine::glass::cli
